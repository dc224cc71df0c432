"""The folders of the source; ``make generated`` writes their table, which the map shows.

A number of lines stays while it is about right, so most changes of the source leave the table as it is.
"""

import csv
import io
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

from roadproof.extension import installed_extensions

ROOT = Path(__file__).parents[2]
TABLE = ROOT / "docs/data/rooms.csv"
SOURCE = ROOT / "src/roadproof"
CORE = {
    "frontends": "Python (`api/`), commands (`cli/`), options (`settings/`), text",
    "questions": "a question lists claims and shows their answers; one loop decides them",
    "engines": "`prove/`, `search/`, `encode/` (time in steps), `solve/` (a file for each solver)",
    "evidence": "claims, certificates, drive files, their check; `answers/` defines JSON",
    "semantics": "`exact/`: the judge of drives; `sampled/`: the monitor of samples",
    "library": "scenarios and spec sets (`sets/*.spec`); elaboration; binding to a road",
    "logic": "formulas and terms: parse, print, rewrite",
    "world": "signals, units, vehicles, roads, drives",
    "runtime": "budget, executors, caches, files, package data",
}
"""The folders of the core, each above those that it may import, and their contents."""
_ROW = re.compile(r"^`([\w/]+/)`,\"?([\d,]+?)\"?,(?=[a-z])", re.MULTILINE)


class Room(NamedTuple):
    """A folder of the source: how many lines it has, its label, for whom it is, and its contents."""

    folder: str
    lines: int
    label: str
    audience: str
    contents: str


def rooms() -> Iterator[Room]:
    """Yield the folders of the core, then the extensions."""
    for name, contents in CORE.items():
        yield Room(f"{name}/", _lines(SOURCE / name), "core", "everyone", contents)
    for name, x in installed_extensions().items():
        record = x.record
        yield Room(f"extensions/{name}/", _lines(Path(x.folder)), record.label, record.audience, record.title)


def _lines(folder: Path) -> int:
    return sum(len(x.read_text("utf-8").splitlines()) for x in folder.rglob("*.py"))


def lines_in(text: str) -> dict[str, int]:
    """Return the lines of each folder as the table has them."""
    return {folder: int(number.replace(",", "")) for folder, number in _ROW.findall(text)}


def is_about(known: int, lines: int) -> bool:
    """Return whether a number of lines in the table is still about right."""
    return abs(known - lines) <= 50 + lines // 20


def table(known: Mapping[str, int]) -> str:
    """Return the table as CSV; ``known``: the lines of each folder as the table has them."""
    found = [
        x._replace(lines=known[x.folder]) if is_about(known.get(x.folder, 0), x.lines) else x for x in rooms()
    ]
    core = sum(x.lines for x in found if x.label == "core")
    file = io.StringIO()
    lines = csv.writer(file, lineterminator="\n")
    lines.writerow(("folder", "lines", "label", "for", "contents"))
    lines.writerows((f"`{x.folder}`", f"{x.lines:,}", *x[2:]) for x in found)
    lines.writerow(("core", f"{core:,}", "", "", ""))
    lines.writerow(("all", f"{sum(x.lines for x in found):,}", "", "", ""))
    return file.getvalue()
