"""Every branch on a closed set is exhaustive, or says on its line why it is not.

mypy names the code that forgets a new signal, operator or verdict, if a match ends in ``assert_never`` and a
table by members of an enum is annotated. A ``case _`` that takes the rest, and a table that has only some
members, hide such code. They are allowed with a reason: ``# open: …`` and ``# partial: …``.
"""

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2] / "src/roadproof"
ENUMS = {"Enum", "IntEnum", "StrEnum", "Flag", "IntFlag"}
TABLES = {"Mapping", "dict", "MutableMapping"}


def parsed(root: Path) -> dict[Path, ast.Module]:
    """The syntax tree of every file below a folder."""
    return {path: ast.parse(path.read_text("utf-8")) for path in sorted(root.rglob("*.py"))}


def last_name(node: ast.AST | None) -> str:
    """``C`` of ``C``, ``module.C``, ``C[int]`` and ``"C"``."""
    match node:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name
        case ast.Subscript(value=value):
            return last_name(value)
        case ast.Constant(value=str() as text):
            return last_name(ast.parse(text, mode="eval").body)
        case _:  # open: any other syntax has no name
            return ""


def enums_of(trees: Mapping[Path, ast.Module]) -> dict[str, set[str]]:
    """The members of every enum, by its name."""
    found: dict[str, set[str]] = {}
    for node in (node for tree in trees.values() for node in ast.walk(tree)):
        if isinstance(node, ast.ClassDef) and ENUMS & {last_name(base) for base in node.bases}:
            names = (last_name(target) for x in node.body for target in getattr(x, "targets", ()))
            found[node.name] = {name for name in names if not name.startswith("_")}
    return found


def open_branches(tree: ast.Module) -> Iterator[int]:
    """The lines of every ``case _`` without ``assert_never``."""
    for node in ast.walk(tree):
        if isinstance(node, ast.match_case) and ast.unparse(node.pattern) == "_":
            calls = (x for part in node.body for x in ast.walk(part) if isinstance(x, ast.Call))
            if not any(last_name(call.func) == "assert_never" for call in calls):
                yield node.pattern.lineno


def members_in(table: ast.Dict, aliases: Mapping[str, str]) -> dict[str, set[str]]:
    """The enum members among the keys of a dict literal, by the name that may be that of an enum."""
    found: dict[str, set[str]] = {}
    for key in table.keys:
        if isinstance(key, ast.Attribute) and (name := last_name(key.value)):
            found.setdefault(aliases.get(name, name), set()).add(key.attr)
    return found


def is_table_of(annotation: ast.AST | None, enum: str, aliases: Mapping[str, str]) -> bool:
    """Whether an annotation has ``Mapping[Enum, …]`` or ``dict[Enum, …]`` in it."""
    for node in () if annotation is None else ast.walk(annotation):
        if isinstance(node, ast.Subscript) and last_name(node.value) in TABLES:
            keys = node.slice.elts[0] if isinstance(node.slice, ast.Tuple) else node.slice
            if enum in {aliases.get(last_name(x), last_name(x)) for x in ast.walk(keys)}:
                return True
    return False


def partial_tables(tree: ast.Module, enums: Mapping[str, set[str]]) -> Iterator[tuple[int, str]]:
    """The line of every table by an enum that lacks its annotation or a member, and what it lacks."""
    imports = (x for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) for x in node.names)
    aliases = {x.asname: x.name for x in imports if x.asname}
    annotated = {
        id(node.value): node.annotation for node in ast.walk(tree) if isinstance(node, ast.AnnAssign)
    }
    for table in (node for node in ast.walk(tree) if isinstance(node, ast.Dict)):
        for enum, members in members_in(table, aliases).items():
            missing = enums.get(enum, members) - members
            if missing:
                yield table.lineno, f"without {', '.join(sorted(missing))} of {enum}"
            elif enum in enums and not is_table_of(annotated.get(id(table)), enum, aliases):
                yield table.lineno, f"not annotated as Mapping[{enum}, …]"


def faults_below(root: Path) -> list[str]:
    """Every open branch and partial table without a reason on its line."""
    trees, faults = parsed(root), []
    enums = enums_of(trees)
    for path, tree in trees.items():
        lines = path.read_text("utf-8").splitlines()
        branches = [(line, "# open: ", "case _ without assert_never") for line in open_branches(tree)]
        tables = [(line, "# partial: ", f"table {lack}") for line, lack in partial_tables(tree, enums)]
        for line, mark, fault in sorted([*branches, *tables]):
            if not lines[line - 1].partition(mark)[2].strip():
                faults.append(f"{path.relative_to(root)}:{line} {fault}")
    return faults


def test_every_branch_on_a_closed_set_is_exhaustive_or_says_why_not() -> None:
    assert faults_below(ROOT) == []


CASE = "from typing import assert_never\nmatch x:\n    case 1:\n        pass\n    {}\n"
ENUM = "from enum import Enum\nclass Side(Enum):\n    LEFT = 1\n    RIGHT = 2\n"


@pytest.mark.parametrize(
    ("source", "faults"),
    [
        (CASE.format("case _:\n        pass"), ["a.py:5 case _ without assert_never"]),
        (CASE.format("case _:  # open:\n        pass"), ["a.py:5 case _ without assert_never"]),
        (CASE.format("case _:  # open: any number\n        pass"), []),
        (CASE.format("case _:\n        assert_never(x)"), []),
        (CASE.format("case _ if x:\n        pass"), ["a.py:5 case _ without assert_never"]),
        (f"{ENUM}x = {{Side.LEFT: 1}}\n", ["a.py:5 table without RIGHT of Side"]),
        (f"{ENUM}x = {{Side.LEFT: 1}}  # partial: cars keep left\n", []),
        (f"{ENUM}x = {{Side.LEFT: 1, Side.RIGHT: 2}}\n", ["a.py:5 table not annotated as Mapping[Side, …]"]),
        (f"{ENUM}x: Mapping[Side, int] = {{Side.LEFT: 1, Side.RIGHT: 2}}\n", []),
        (f"{ENUM}x: Final[dict[Side, int]] = {{Side.LEFT: 1, Side.RIGHT: 2}}\n", []),
        (
            f"{ENUM}x: Mapping[str, int] = {{Side.LEFT: 1, Side.RIGHT: 2}}\n",
            ["a.py:5 table not annotated as Mapping[Side, …]"],
        ),
        ("x = {module.NAME: 1}\n", []),
    ],
)
def test_the_search_finds_what_it_is_for(source: str, faults: list[str], tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text(source, "utf-8")
    assert faults_below(tmp_path) == faults
