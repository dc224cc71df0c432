"""Faults that were thought of: one text of a file for another, and the tests that have to notice.

``by_hand.toml`` lists them by rooms of tests. The tables of ``rim/`` begin with a condition: under which a
verdict, a count or an exit code may be given. Each condition has the faults that break it. The results are in
``by_hand.jsonl``, a line for each fault: one that was caught is not planted again while its texts stay.
"""

import json
import tomllib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mutants.trial import copy_project, run_tests

LISTED = Path(__file__).parent / "by_hand.toml"
RIM = Path(__file__).parent / "rim"
RESULTS = Path(__file__).parent / "by_hand.jsonl"
SECONDS = 300.0
"""Processor time for the tests of a room; beyond that a fault hangs."""


@dataclass(frozen=True)
class Fault:
    """``before`` occurs once in ``file``, which is relative to the package. ``tests``: those of its room.

    ``equivalent``: why nobody can observe it; empty where tests have to notice.
    """

    room: str
    file: str
    before: str
    after: str
    tests: tuple[str, ...]
    equivalent: str = ""

    @property
    def key(self) -> tuple[str, str, str]:
        """The texts by which its result is found: another place in the file, or another room, is the same."""
        return self.file, self.before, self.after


@dataclass(frozen=True)
class Condition:
    """What is ``given``, such as an exit code, and ``when`` it may be; ``faults`` break that in one file."""

    given: str
    when: str
    file: str
    faults: tuple[Fault, ...]


def listed(path: Path = LISTED, rim: Path = RIM) -> list[Fault]:
    """The faults in the order of the lists, those of conditions last; not those that are equivalent."""
    data = tomllib.loads(path.read_text("utf-8"))
    found = [Fault(**entry, tests=tuple(data["rooms"][entry["room"]])) for entry in data["fault"]]
    return found + [x for each in conditions(rim) for x in each.faults if not x.equivalent]


def conditions(rim: Path = RIM) -> list[Condition]:
    """The conditions of all tables of a folder, each of which is a room."""
    return [
        _condition(room.stem, entry)
        for room in sorted(rim.glob("*.toml"))
        for entry in tomllib.loads(room.read_text("utf-8"))["condition"]
    ]


def _condition(room: str, entry: dict[str, Any]) -> Condition:
    """A fault is a list: before, after, and where it is equivalent, why."""
    file, tests = entry["file"], tuple(entry["tests"])
    faults = []
    for before, after, *why in entry["faults"]:
        faults.append(Fault(room, file, before, after, tests, *why))
    return Condition(entry["given"], entry["when"], file, tuple(faults))


def planted(fault: Fault, package: Path) -> tuple[str, str]:
    """The text of the file as it is and with the fault. Raises ``ValueError`` for one that does not fit."""
    text = (package / fault.file).read_text("utf-8")
    if text.count(fault.before) != 1:
        raise ValueError(f"{fault.file} has {fault.before!r} {text.count(fault.before)} times, not once")
    return text, text.replace(fault.before, fault.after)


def read_results(path: Path = RESULTS) -> dict[tuple[str, str, str], str]:
    """The verdict for each fault that was planted, by its key; the last of a key counts."""
    if not path.exists():
        return {}
    lines = map(json.loads, path.read_text("utf-8").splitlines())
    return {(file, before, after): verdict for file, before, after, verdict in lines}


def write_results(results: Iterable[tuple[tuple[str, str, str], str]], path: Path = RESULTS) -> None:
    """Write a line for each fault, in the order of their texts."""
    lines = (json.dumps([*key, verdict], ensure_ascii=False) for key, verdict in sorted(results))
    path.write_text("".join(f"{line}\n" for line in lines), "utf-8")


def plant(faults: list[Fault], root: Path, folder: Path) -> Iterator[tuple[Fault, str]]:
    """Each fault with ``caught``, ``survived`` or ``hung``, made one at a time in a copy of the project.

    Tests that the project does not have are left out. Raises ``ValueError`` for a fault that does not fit,
    before any is planted.
    """
    for fault in faults:
        planted(fault, root / "src/roadproof")
    copy_project(root, folder)
    for fault in faults:
        file = folder / "src/roadproof" / fault.file
        text, wrong = planted(fault, folder / "src/roadproof")
        file.write_text(wrong, "utf-8")
        tests = [test for test in fault.tests if (folder / test).exists()]
        code, _ = run_tests(folder, tests, SECONDS)
        file.write_text(text, "utf-8")
        yield fault, "hung" if code is None else "caught" if code else "survived"
