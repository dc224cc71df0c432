"""The book of console sessions, and the attacks: every page is run as it stands, in a folder of its own.

A page is Markdown. ```` ```file NAME ```` blocks are written first; in ```` ```console ```` blocks each
line after ``$`` is given to bash, and what follows is what it prints (stdout and stderr together),
with ``[exit N]`` where N is not 0. A printed line that ends in … may go on.
"""

import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGES = [
    *sorted(Path(__file__).parent.joinpath("book").glob("*.md")),
    *sorted(ROOT.joinpath("tests/attacks").glob("*.md")),
    ROOT / "README.md",
    ROOT / "docs/language.md",
]
HANGS = 600.0  # seconds after which a command is said to hang; no page depends on how fast it is


@dataclass(frozen=True)
class Session:
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


def run(command: str, folder: Path) -> list[str]:
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "COLUMNS": "100",
        "PYTHONIOENCODING": "utf-8",
        "LC_ALL": "C.UTF-8",
    }
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=HANGS,
    )
    printed = done.stdout.decode("utf-8").splitlines()
    return [*printed, f"[exit {done.returncode}]"] if done.returncode else printed


def matches(printed: str, expected: str) -> bool:
    return printed.startswith(expected[:-1]) if expected.endswith("…") else printed.rstrip() == expected


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_page(path: Path, tmp_path: Path) -> None:
    page = path.read_text("utf-8")
    for name, text in files_of(page).items():
        (tmp_path / name).write_text(text, "utf-8")
    sessions = sessions_of(page)
    assert sessions, f"{path.name} has no sessions"
    for session in sessions:
        printed = run(session.command, tmp_path)
        expected = list(session.expected)
        same = len(printed) == len(expected) and all(map(matches, printed, expected))
        assert same, f"{path.name}:{session.line}: $ {session.command}\n" + "\n".join(printed)
        assert not any("Traceback" in line for line in printed)


def test_the_book_notices_a_difference(tmp_path: Path) -> None:
    [session] = sessions_of("```console\n$ echo one; exit 3\none\n[exit 3]\n```\n")
    assert run(session.command, tmp_path) == list(session.expected) == ["one", "[exit 3]"]
    assert not matches("two", "one")
    assert not matches("one more", "one")
    assert matches("one more", "one…")
