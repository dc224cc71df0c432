"""Console sessions in Markdown: a page shows commands and what they print, and both are run again.

In ```` ```console ```` blocks each line after ``$`` is given to bash, and what follows is what it prints
(stdout and stderr together), with ``[exit N]`` where N is not 0. ``…`` inside a line stands for any
text, and a line that is ``…`` for any lines. ```` ```file NAME ```` blocks are files that are there first.
"""

import os
import re
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from itertools import pairwise
from pathlib import Path

GAP = "…"
HANGS = 1800.0  # seconds after which a command is said to hang; no page depends on how fast it is

PROGRESS = re.compile(r"roadproof: .* \(after \d+ (s|min|h)\)")  # said every 30 s, so by the clock


@dataclass(frozen=True)
class Session:
    """A command on a page, what the page says it prints, and the line of the command."""

    command: str
    expected: tuple[str, ...]
    line: int


def files_of(page: str) -> dict[str, str]:
    return dict(re.findall(r"^```file (\S+)\n(.*?)^```$", page, re.M | re.S))


def sessions_of(page: str) -> list[Session]:
    sessions: list[Session] = []
    inside = False
    for number, line in enumerate(page.splitlines(), start=1):
        if line.startswith("```"):
            inside = line == "```console"
        elif inside and line.startswith("$ "):
            sessions.append(Session(line[2:], (), number))
        elif inside:
            last = sessions[-1]
            sessions[-1] = Session(last.command, (*last.expected, line), last.line)
    return sessions


def environment() -> dict[str, str]:
    """That of a reader with a terminal of 100 columns, and with ``roadproof`` on the path."""
    return {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "COLUMNS": "100",
        "PYTHONIOENCODING": "utf-8",
        "ROADPROOF_KNOWN": "off",  # what the documents show is computed
        "ROADPROOF_QUIET": "1",  # what is said every half minute depends on the machine
        "LC_ALL": "C.UTF-8",
    }


def run(command: str, folder: Path) -> list[str]:
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=HANGS,
    )
    printed = [x for x in done.stdout.decode("utf-8").splitlines() if not PROGRESS.fullmatch(x)]
    return [*printed, f"[exit {done.returncode}]"] if done.returncode else printed


def matches(printed: str, expected: str) -> bool:
    """Whether a printed line is the one on the page."""
    if GAP not in expected:
        return printed.rstrip() == expected.rstrip()
    return re.fullmatch(".*".join(map(re.escape, expected.split(GAP))), printed) is not None


def agree(printed: Sequence[str], expected: Sequence[str]) -> bool:
    """Whether all that was printed is what the page shows."""
    blocks = _blocks(expected)
    if len(blocks) == 1:
        return _same(printed, blocks[0])
    first, *middle, last = blocks
    if not _same(printed[: len(first)], first):
        return False
    at = len(first)
    for block in middle:
        while at + len(block) <= len(printed) and not _same(printed[at : at + len(block)], block):
            at += 1
        at += len(block)
    return at + len(last) <= len(printed) and _same(printed[len(printed) - len(last) :], last)


def rewritten(page: str, printed: Mapping[int, Sequence[str]]) -> str:
    """The page with what was printed, by the line of the command; what was cut stays cut."""
    lines = page.splitlines()
    for session in reversed(sessions_of(page)):
        if session.line in printed and not agree(printed[session.line], session.expected):
            end = session.line + len(session.expected)
            lines[session.line : end] = cut_alike(printed[session.line], session.expected)
    return "\n".join(lines) + "\n"


def cut_alike(printed: Sequence[str], expected: Sequence[str]) -> list[str]:
    """What was printed, with ``…`` where ``expected`` has it: the same lines are cut, or the same ends."""
    wanted = [i for i, line in enumerate(expected) if line != GAP]
    found = _alignment(printed, [expected[i] for i in wanted])
    anchors = [(-1, -1), *((a, wanted[b]) for a, b in found), (len(printed), len(expected))]
    result: list[str] = []
    for (before, above), (after, below) in pairwise(anchors):
        new, old = [line.rstrip() for line in printed[before + 1 : after]], expected[above + 1 : below]
        if GAP in old:
            head, tail = old.index(GAP), len(old) - 1 - old[::-1].index(GAP)
            shown_last = len(old) - 1 - tail
            if head + shown_last < len(new):
                new = [*new[:head], GAP, *new[len(new) - shown_last :]]
        result += new
        if below < len(expected):
            result.append(expected[below])
    return result


def _alignment(printed: Sequence[str], expected: Sequence[str]) -> list[tuple[int, int]]:
    """Pairs of indices, rising in both, of printed lines that are expected ones."""
    names = [next((e for e in expected if matches(line, e)), line) for line in printed]
    blocks = SequenceMatcher(None, names, list(expected), autojunk=False).get_matching_blocks()
    return [(block.a + k, block.b + k) for block in blocks for k in range(block.size)]


def _blocks(expected: Sequence[str]) -> list[list[str]]:
    blocks: list[list[str]] = [[]]
    for line in expected:
        if line == GAP:
            blocks.append([])
        else:
            blocks[-1].append(line)
    return blocks


def _same(printed: Sequence[str], expected: Sequence[str]) -> bool:
    return len(printed) == len(expected) and all(map(matches, printed, expected))
