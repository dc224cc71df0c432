"""The lines of code to trust, counted with all that they import: the tables of docs/explanation/trust.md.

``make generated`` counts again and writes the tables. A number stays while it is about right, so most changes
of the source leave the page as it is.
"""

import ast
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from roadproof.extension import entries

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "roadproof"
THEORIES = ROOT / "proofs" / "kernel"
PAGE = ROOT / "docs" / "explanation" / "trust.md"
PART = re.compile(r"^(\| \((\d)\) \| [^|]+ \| ([^|]+) \|) ([\d,]+) \| ([\d,]+) \|$", re.MULTILINE)
ANSWER = re.compile(r"^(\| [^|(]+ \| ((?:\(\d\) ?)+)\|) ([\d,]+) \|$", re.MULTILINE)
CLOSE = 0.03
"""The share by which a count of the page may be out of date."""
REQUIRED = re.compile(r"^From Roadproof Require (?:Import )?([^.]+)\.$", re.MULTILINE)


def modules() -> dict[str, Path]:
    """Each module of roadproof by its dotted name."""
    return {".".join(x.relative_to(SOURCE.parent).with_suffix("").parts): x for x in SOURCE.rglob("*.py")}


def imported(path: Path, known: dict[str, Path]) -> Iterator[Path]:
    """The files of roadproof that a file imports, in functions too; what only mypy imports is left out."""
    if path.suffix == ".v":
        names = (x for said in REQUIRED.findall(path.read_text("ascii")) for x in said.split())
        yield from (THEORIES / f"{name}.v" for name in names)
    elif path.suffix == ".py":
        yield from (x / "__init__.py" for x in path.parents if SOURCE in (x, *x.parents))
        yield from _imported_by_python(ast.parse(path.read_text("utf-8")), known)
        if path == SOURCE / "extension.py":  # it reads the record of every extension
            yield SOURCE / "extensions/__init__.py"
            yield from (SOURCE / "extensions").glob("*/__init__.py")
        if path == SOURCE / "evidence/answers/shared.py":  # it imports the headings of every extension
            yield from (known[x.partition(":")[0]] for x in entries("headings").values())


def _imported_by_python(tree: ast.AST, known: dict[str, Path]) -> Iterator[Path]:
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING":
            waiting += node.orelse
            continue
        waiting += ast.iter_child_nodes(node)
        if isinstance(node, ast.Import):
            names = [x.name for x in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = [node.module, *(f"{node.module}.{x.name}" for x in node.names)]
        else:
            continue
        yield from (known[x] for name in names for x in (name, f"{name}.__init__") if x in known)


def closure(files: Iterable[Path]) -> frozenset[Path]:
    """The files, and all files of roadproof that they import, at any depth."""
    known, reached, waiting = modules(), set[Path](), list(files)
    while waiting:
        path = waiting.pop()
        if path not in reached:
            reached.add(path)
            waiting += imported(path, known)
    return frozenset(reached)


def named(cell: str) -> tuple[Path, ...]:
    """The files that a cell of the table names."""
    found: list[Path] = []
    for name in re.findall(r"`([^`]+)`", cell):
        paths = sorted((ROOT if name.startswith("proofs") else SOURCE).glob(name))
        assert paths, name
        found += paths
    return tuple(found)


def lines(files: Iterable[Path]) -> int:
    return sum(len(x.read_text("utf-8").splitlines()) for x in files)


def parts(page: str) -> dict[str, tuple[Path, ...]]:
    """The files named in each row of the first table."""
    return {number: named(cell) for _, number, cell, _, _ in PART.findall(page)}


def is_close(known: int, count: int) -> bool:
    """Return whether a count of the page is still about right."""
    return abs(known - count) <= CLOSE * count


def counted(page: str) -> str:
    """Return the page with each count of its tables that is no longer about right counted again."""
    files = parts(page)
    whole = {number: closure(x) for number, x in files.items()}

    def about(known: str, files: Iterable[Path]) -> str:
        count = lines(files)
        return known if is_close(int(known.replace(",", "")), count) else f"{count:,}"

    def part(row: re.Match[str]) -> str:
        return f"{row[1]} {about(row[4], files[row[2]])} | {about(row[5], whole[row[2]])} |"

    def answer(row: re.Match[str]) -> str:
        every = frozenset[Path]().union(*(whole[number] for number in re.findall(r"\d", row[2])))
        return f"{row[1]} {about(row[3], every)} |"

    return ANSWER.sub(answer, PART.sub(part, page))
