"""The lines of code to trust, counted with all that they import: the tables of docs/explanation/trust.md.

``PYTHONPATH=tests python -m documents.trusted`` counts again and writes the tables.
"""

import ast
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "roadproof"
THEORIES = ROOT / "proofs" / "kernel"
PAGE = ROOT / "docs" / "explanation" / "trust.md"
PART = re.compile(r"^(\| \((\d)\) \| [^|]+ \| ([^|]+) \|) ([\d,]+) \| ([\d,]+) \|$", re.MULTILINE)
ANSWER = re.compile(r"^(\| [^|(]+ \| ((?:\(\d\) ?)+)\|) ([\d,]+) \|$", re.MULTILINE)
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


def counted(page: str) -> str:
    """The page with the tables counted again."""
    files = parts(page)

    def part(row: re.Match[str]) -> str:
        return f"{row[1]} {lines(files[row[2]]):,} | {lines(closure(files[row[2]])):,} |"

    def answer(row: re.Match[str]) -> str:
        whole = closure(x for number in re.findall(r"\d", row[2]) for x in files[number])
        return f"{row[1]} {lines(whole):,} |"

    return ANSWER.sub(answer, PART.sub(part, page))


if __name__ == "__main__":
    PAGE.write_text(counted(PAGE.read_text("utf-8")), "utf-8")
