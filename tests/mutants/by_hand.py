"""Faults that were thought of: one text of a file for another, and the room whose tests have to notice."""

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from mutants.trial import copy_project, run_tests

LISTED = Path(__file__).parent / "by_hand.toml"
SECONDS = 300.0
"""Processor time for the tests of a room; beyond that a fault hangs."""


@dataclass(frozen=True)
class Fault:
    """``before`` occurs once in ``file``, which is relative to the package. ``tests``: those of its room."""

    room: str
    file: str
    before: str
    after: str
    tests: tuple[str, ...]


def listed(path: Path = LISTED) -> list[Fault]:
    """The faults in the order of the list."""
    data = tomllib.loads(path.read_text("utf-8"))
    return [Fault(**entry, tests=tuple(data["rooms"][entry["room"]])) for entry in data["fault"]]


def plant(faults: list[Fault], root: Path, folder: Path) -> Iterator[tuple[Fault, str]]:
    """Each fault with ``caught``, ``survived`` or ``hung``, made one at a time in a copy of the project.

    Tests that the project does not have are left out. Raises ``ValueError`` for a fault that does not fit.
    """
    copy_project(root, folder)
    for fault in faults:
        file = folder / "src/roadproof" / fault.file
        text = file.read_text("utf-8")
        if text.count(fault.before) != 1:
            raise ValueError(f"{fault.file} has {fault.before!r} {text.count(fault.before)} times")
        file.write_text(text.replace(fault.before, fault.after), "utf-8")
        tests = [test for test in fault.tests if (folder / test).exists()]
        code, _ = run_tests(folder, tests, SECONDS)
        file.write_text(text, "utf-8")
        yield fault, "hung" if code is None else "caught" if code else "survived"
