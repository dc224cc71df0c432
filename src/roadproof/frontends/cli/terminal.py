"""Results on a terminal: coloured verdicts, and lines that fit its width. Text in pipes is left as it is."""

import os
import re
import sys
from collections.abc import Mapping
from typing import Any, TextIO, cast

from roadproof.verdict import Verdict

_RED, _GREEN, _YELLOW = 31, 32, 33
_COLOURS: Mapping[Verdict, int] = {
    Verdict.PROVED: _GREEN,
    Verdict.WITNESSED: _GREEN,
    Verdict.COVERED: _GREEN,
    Verdict.DERIVED: _GREEN,
    Verdict.REFUTED: _RED,
    Verdict.VACUOUS: _RED,
    Verdict.IMPOSSIBLE: _RED,
    Verdict.GAPS: _RED,
    Verdict.CROSSCHECK_FAILED: _RED,
    Verdict.PROVED_BOUNDED: _YELLOW,
    Verdict.NONE_WITHIN: _YELLOW,
    Verdict.UNKNOWN: _YELLOW,
}
_OF_CHECK = {"rejected": _RED, "unreadable": _RED, "unknown": _YELLOW}
_WORD = re.compile(
    r"^(?:rejected(?=  )|unreadable(?= )|unknown(?=   ))"  # as lines of ``check`` begin
    rf"|(?<![\w-])(?:{'|'.join(sorted(_COLOURS, reverse=True))})(?![\w-])"
)
_GAP = re.compile(r"(?<=\S) {2,}(?=\S)")
_TABLE = 5
"""A line with so many gaps is a row of a table of short cells, which is cut and not wrapped."""


def width_of_terminal() -> int | None:
    """The columns of the terminal that stdout is; None where it is none."""
    if sys.stdout is None or not sys.stdout.isatty():
        return None
    import shutil

    return max(20, shutil.get_terminal_size().columns)


def wants_colour() -> bool:
    """Return whether stdout takes colours, by ``NO_COLOR``, ``FORCE_COLOR`` and ``TERM``, in this order."""
    if os.environ.get("NO_COLOR"):
        return False
    if os.environ.get("FORCE_COLOR"):
        return True
    return os.environ.get("TERM") != "dumb" and width_of_terminal() is not None


def dress_output() -> None:
    """Print results on stdout with colours, and in the width of the terminal."""
    width, colour = width_of_terminal(), wants_colour()
    plain = sys.stdout is not None and not isinstance(sys.stdout, _Dressed)
    if plain and (width is not None or colour):
        sys.stdout = cast(TextIO, _Dressed(sys.stdout, width, colour))


def fit(line: str, width: int) -> str:
    """A line as lines of at most ``width`` columns: rows of tables are cut, others wrapped below a column.

    Words that are longer than a line stay whole.
    """
    if len(line) <= width:
        return line
    gaps = [gap.end() for gap in _GAP.finditer(line)]
    if len(gaps) >= _TABLE:
        return f"{line[: width - 1]}…"
    columns = [end for end in gaps if end <= width * 2 // 3]
    hang = columns[-1] if columns else len(line) - len(line.lstrip()) + 2
    indent = "# " if line.startswith("# ") else " " * hang
    import textwrap

    return textwrap.fill(
        line, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


def paint(text: str) -> str:
    """The text with its verdicts in colour."""
    return _WORD.sub(_painted, text)


def _painted(word: re.Match[str]) -> str:
    colour = _OF_CHECK.get(word[0]) or _COLOURS[Verdict(word[0])]
    return f"\033[{colour}m{word[0]}\033[0m"


class _Dressed:
    """A stream that dresses whole lines; in all else it is the stream behind it."""

    def __init__(self, stream: TextIO, width: int | None, colour: bool) -> None:
        self._stream, self._width, self._colour = stream, width, colour
        self._rest = ""

    def write(self, text: str) -> int:
        """Write text with its verdicts in colour, whole lines at a time."""
        *lines, self._rest = (self._rest + text).split("\n")
        for line in lines:
            self._stream.write(self._dress(line) + "\n")
        return len(text)

    def flush(self) -> None:
        rest, self._rest = self._rest, ""
        self._stream.write(self._dress(rest))
        self._stream.flush()

    def _dress(self, line: str) -> str:
        fitted = line if self._width is None else fit(line, self._width)
        return paint(fitted) if self._colour else fitted

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)
