"""Python sessions in Markdown: a page shows what is typed and what Python prints, and both are run again.

In ```` ```pycon ```` blocks of a page, which share their names, ``…`` inside a line stands for any text, and
a line that is ``…`` for any lines, as in ``console``. Of an error its last lines are shown.
"""

import contextlib
import io
import re
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

_BLOCK = re.compile(r"^```pycon\n(.*?)^```$", re.M | re.S)


@dataclass(frozen=True)
class Example:
    """What is typed on a page, what the page says is printed, and the line where it begins."""

    source: str
    expected: tuple[str, ...]
    line: int


def examples_of(page: str) -> Iterator[Example]:
    for block in _BLOCK.finditer(page):
        begin = page.count("\n", 0, block.start(1)) + 1
        typed: list[str] = []
        printed: list[str] = []
        at = begin
        for number, line in enumerate([*block[1].splitlines(), ">>>"], start=begin):
            if line.startswith("... ") or line == "...":
                typed.append(line[4:])
            elif line.startswith(">>>"):
                if typed:
                    yield Example("\n".join(typed) + "\n", tuple(printed), at)
                typed, printed, at = [line[4:]], [], number
            else:
                printed.append(line)


def run(example: Example, names: dict[str, Any]) -> list[str]:
    """What Python prints, line by line."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        try:
            exec(compile(example.source, f"line {example.line}", "single"), names)
        except Exception as error:
            print("".join(traceback.format_exception_only(error)).strip())
    return out.getvalue().splitlines()


def rewritten(page: str) -> str:
    """The page with what is printed in place of what it shows."""
    names: dict[str, Any] = {}
    lines = page.splitlines()
    found = [(x, run(x, names)) for x in examples_of(page)]
    for example, printed in reversed(found):
        end = example.line - 1 + example.source.count("\n")
        lines[end : end + len(example.expected)] = printed
    return "\n".join(lines) + "\n"
