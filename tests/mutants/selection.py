"""Which tests run a faulty line, the fastest first, from the records that ``mutants.recording`` writes."""

import ast
import json
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path

from mutants.choose import FOLDERS, noticing_tests
from mutants.edits import Edit
from mutants.places import places_of

SLOWEST = 30.0
"""Seconds of processor time (with recording) above which a test is too slow to be run on every fault."""

BUDGET = 240.0
"""Seconds of tests, as recorded, that one fault is given: the fastest of those that run its line."""

LEFT_OUT = {
    "tests/cli/test_book.py": "whole pages in processes of their own",
    "tests/test_examples.py": "whole programs in processes of their own",
}
"""Test files that are never run on faults."""


def record_name(test_file: Path, root: Path) -> str:
    """The name of the record of a test file as it is now."""
    beside = test_file.with_suffix(".toml")
    content = test_file.read_bytes() + (beside.read_bytes() if beside.exists() else b"")
    digest = sha256(content).hexdigest()[:8]
    return f"{'.'.join(test_file.relative_to(root).with_suffix('').parts)}-{digest}.json"


def test_files(root: Path) -> list[Path]:
    """Every test file whose tests may be run on faults, those of the faulty folders first."""
    found = sorted(root.glob("tests/**/test_*.py"))
    own = ("tests/mutants/", "tests/fuzz/")
    named = [(path, str(path.relative_to(root))) for path in found]
    kept = [path for path, name in named if name not in LEFT_OUT and not name.startswith(own)]
    order = [*FOLDERS.values(), "spec"]
    names = {path: path.parent.relative_to(root / "tests").as_posix() for path in kept}
    return sorted(kept, key=lambda path: order.index(names[path]) if names[path] in order else 99)


@dataclass
class Records:
    """By place and by file: the tests that run it. ``seconds`` of each test."""

    seconds: dict[str, float] = field(default_factory=dict)
    by_place: dict[tuple[str, str], set[str]] = field(default_factory=dict)
    by_function: dict[tuple[str, str], set[str]] = field(default_factory=dict)
    missing: list[Path] = field(default_factory=list)

    def tests_for(self, edit: Edit, package: Path) -> list[str]:
        """Those that run the statement; where none is known to, those that run its function, or its file.

        A line that runs when its file is imported, or inside compiled code, is not recorded with a test.
        """
        if edit.file.endswith(".spec"):
            met = self._in_function("library/elaborate.py", "")
            return self._fastest(met, "spec")
        text = (package / edit.file).read_text("utf-8")
        places = places_of(ast.parse(text), text)
        function = edit.context.partition("|")[0]
        met = set()
        for line in range(edit.lines[0], edit.lines[1] + 1):
            met |= self.by_place.get((edit.file, places[line]), set())
        if not met or not function:
            met = met | self._in_function(edit.file, function)
        return self._fastest(met or self._in_function(edit.file, ""), noticing_tests(edit.file))

    def _in_function(self, file: str, function: str) -> set[str]:
        """Tests that run a function; all that run some function of the file where none is named."""
        found: set[str] = set()
        for (name, inner), tests in self.by_function.items():
            if name == file and inner and (not function or inner == function):
                found |= tests
        return found

    def _fastest(self, tests: set[str], folder: str) -> list[str]:
        """In the order of their seconds, the tests of the folder first, up to the budget."""

        def near(test: str) -> bool:
            return test.startswith(f"tests/{folder}/")

        usable = [test for test in tests if self.seconds[test] <= SLOWEST]
        chosen: list[str] = []
        spent = 0.0
        for test in sorted(usable, key=lambda test: (not near(test), self.seconds[test], test)):
            if spent + self.seconds[test] <= BUDGET:
                chosen.append(test)
                spent += self.seconds[test]
        return chosen


def load_records(folder: Path, root: Path) -> Records:
    """The records of the test files as they are; files without one are told as ``missing``."""
    records = Records()
    for path in test_files(root):
        record = folder / record_name(path, root)
        if not record.exists():
            records.missing.append(path)
            continue
        data = json.loads(record.read_text("utf-8"))
        places = [(file, place) for file, place in data["places"]]
        for test, run in data["tests"].items():
            records.seconds[test] = run["seconds"]
            for number in run["places"]:
                file, place = places[number]
                records.by_place.setdefault((file, place), set()).add(test)
                records.by_function.setdefault((file, place.partition("|")[0]), set()).add(test)
    return records
