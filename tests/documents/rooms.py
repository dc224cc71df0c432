"""The rooms of the source: ``PYTHONPATH=tests python -m documents.rooms`` writes their table into the map."""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from roadproof.extension import installed

ROOT = Path(__file__).parents[2]
MAP = ROOT / "docs/explanation/map.md"
SOURCE = ROOT / "src/roadproof"
CORE = ("logic", "library", "world", "semantics", "engines", "evidence", "questions", "runtime", "frontends")
_TABLE = re.compile(r"(?<=<!-- rooms -->\n)[\s\S]*?(?=<!-- end -->)")


class Room(NamedTuple):
    """A folder of the source: how many lines it has, its label, and for whom it is."""

    folder: str
    lines: int
    label: str
    audience: str


def rooms() -> Iterator[Room]:
    """Yield the folders of the core, then the extensions."""
    for name in CORE:
        yield Room(f"{name}/", _lines(SOURCE / name), "core", "everybody")
    for name, x in installed().items():
        record = x.record
        label = record.label + "".join(f"; incubating: {part}" for part in record.incubating)
        yield Room(f"extensions/{name}/", _lines(Path(x.folder)), label, record.audience)


def _lines(folder: Path) -> int:
    return sum(len(x.read_text("utf-8").splitlines()) for x in folder.rglob("*.py"))


def table() -> str:
    """The table in Markdown, with lines in hundreds."""
    found = [*rooms()]
    core = sum(x.lines for x in found if x.label == "core")
    lines = ["| folder | lines | label | for |", "|---|--:|---|---|"]
    lines += [f"| `{x.folder}` | {x.lines:,} | {x.label} | {x.audience} |" for x in found]
    total = sum(x.lines for x in found)
    return "\n".join([*lines, "", f"The core has {core:,} of {total:,} lines.", ""])


def with_table(text: str) -> str:
    """A map with the table of today."""
    return _TABLE.sub(lambda _: table(), text)


if __name__ == "__main__":
    MAP.write_text(with_table(MAP.read_text("utf-8")), "utf-8")
