"""Counts the figures of docs/explanation/tests.md in the repository, each a table of docs/data/tests.

``make generated`` writes those that are counted from files. ``python -m tally`` also writes the number of
planted faults, for which pytest collects all tests.
"""

import ast
import csv
import io
import json
import re
import subprocess
import sys
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from console import sessions_of
from mutants import journal
from mutants.by_hand import Condition, conditions, read_results
from mutants.choose import folder_of

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / "docs/data/tests"
PACKAGE = ROOT / "src/roadproof"
PLANTED = ("fault", "planted", "mutant", "noticed")
"""A test case with one of these words in its name plants a fault in the program and asks to be told of it."""


Table = list[list[str]]
"""Rows of cells, the heading first."""


def main() -> int:
    for name, table in {**TABLES, "planted": planted}.items():
        (FOLDER / f"{name}.csv").write_text(text(table()), "utf-8")
    return 0


def text(table: Table) -> str:
    """Return a table as CSV."""
    file = io.StringIO()
    csv.writer(file, lineterminator="\n").writerows(table)
    return file.getvalue()


def read(path: Path) -> Table:
    with path.open(encoding="utf-8", newline="") as file:
        return [*csv.reader(file)]


def rows(head: Iterable[object], body: Iterable[Iterable[object]]) -> Table:
    return [[*map(str, line)] for line in (head, *body)]


def attacks() -> Table:
    """A row for each page of attacks: questions, and commands that are run."""
    found = []
    for path in sorted((ROOT / "tests/attacks").glob("*.md")):
        page = path.read_text("utf-8")
        if path.name != "README.md":
            title = page.partition("\n")[0].removeprefix("# ")
            asked = len(re.findall(r"^## ", page, re.M))
            found.append((f"[{title}](../../tests/attacks/{path.name})", asked, len(sessions_of(page))))
    total = ("all", sum(row[1] for row in found), sum(row[2] for row in found))
    return rows(("page", "questions", "commands run by the tests"), [*found, total])


def fuzz() -> Table:
    """A row for each reader: pairs, seeds, disagreements."""
    kept = json.loads((ROOT / "tests/fuzz/results.json").read_text("utf-8"))
    by_reader: dict[str, list[dict[str, int]]] = {}
    for entry in kept:
        by_reader.setdefault(entry["reader"], []).append(entry)
    found = []
    for reader, entries in by_reader.items():
        module = ast.parse((ROOT / f"tests/fuzz/{reader}.py").read_text("utf-8"))
        what = (ast.get_docstring(module) or "").partition("\n")[0].rstrip(".")
        seeds = ", ".join(str(entry["seed"]) for entry in entries)
        counts = (sum(entry[key] for entry in entries) for key in ("pairs", "disagreements"))
        found.append((f"`{reader}`: {what[0].lower()}{what[1:]}", *counts, seeds))
    total = ("all", sum(row[1] for row in found), sum(row[2] for row in found), "")
    body = [(row[0], f"{row[1]:,}", row[2], row[3]) for row in [*found, total]]
    return rows(("reader", "pairs", "disagreements", "seeds"), body)


def mutants() -> Table:
    """A row for each folder: faults tried in functions that are as they were, and what became of them."""
    counted: dict[str, Counter[str]] = {}
    equivalent = journal.equivalents()
    for line in journal.of_present_source(journal.read().values(), PACKAGE):
        verdict = "equivalent" if line.key in equivalent else line.verdict
        counted.setdefault(folder_of(line.file), Counter())[verdict] += 1
    counted["all"] = sum(counted.values(), Counter())
    columns = ("caught", "hung", "equivalent", "survived", "unreached")
    body = [(name, found.total(), *(found[c] for c in columns)) for name, found in counted.items()]
    return rows(("folder", "tried", "caught", "by hanging", "equivalent", "survived", "run by no test"), body)


def rim() -> Table:
    """A row for each room of conditions: conditions, faults planted against them, and what came out."""
    by_room: dict[str, list[Condition]] = {}
    for each in conditions():
        by_room.setdefault(each.faults[0].room, []).append(each)
    by_room["all"] = conditions()
    body, results = [], read_results()
    for room, those in by_room.items():
        faults = [x for each in those for x in each.faults if not x.equivalent]
        equivalent = sum(len(each.faults) for each in those) - len(faults)
        verdicts = Counter(results.get(x.key, "") for x in faults)
        counts = verdicts["caught"] + verdicts["hung"], verdicts["survived"], verdicts[""]
        body.append((room.replace("_", " "), len(those), len(faults), equivalent, *counts))
    head = ("room", "conditions", "faults", "equivalent", "caught", "survived", "not tried")
    return rows(head, body)


def planted() -> Table:
    """A row for each folder: test cases that plant a fault."""
    command = [sys.executable, "-m", "pytest", "tests", "--collect-only", "-q", "-p", "no:xdist"]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, check=True)
    cases = [line for line in done.stdout.decode().splitlines() if line.startswith("tests/")]
    counted = Counter(case.split("/")[1] for case in cases if is_planted(case))
    body = [*sorted(counted.items()), ("all", counted.total())]
    return rows(("folder", "planted faults"), body)


def is_planted(case: str) -> bool:
    """By the name of the test, its parameters and its file, not of its folder; not what counts them."""
    file, _, name = case.partition("::")
    return file.count("/") > 1 and any(word in f"{Path(file).name} {name}".lower() for word in PLANTED)


TABLES = {"attacks": attacks, "fuzz": fuzz, "mutants": mutants, "conditions": rim}
"""Those that are counted from files alone, so that a test can compare them."""

if __name__ == "__main__":
    raise SystemExit(main())
