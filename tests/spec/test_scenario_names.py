"""Names of the library's definitions stand in ``library/scenarios.py`` and nowhere else in Python.

A string that has such a name followed by ``(``, is one, or has the part of one before its number
(``scenario_``), is read, matched or put together somewhere; so is one that is the name of a role. Words for
people are left out: docstrings, ``_EXAMPLES`` and the ``help`` of options.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from roadproof.library.loading import bundled_library
from roadproof.library.scenarios import PAIR, TRIPLE

SOURCE = Path(__file__).parents[2] / "src" / "roadproof"
HOME = "library/scenarios.py"
ROLES = {*PAIR, *TRIPLE}
WORDS = {
    "__init__.py",
    "frontends/api/recordings.py",
}  # what is exported from Python is named; so are columns of frames
ROWS = 8
"""How many rows the table of formulas has, which other scenarios repeat."""


def said_to_people(tree: ast.Module) -> set[int]:
    """The nodes of strings that are docstrings, examples or help, by identity."""
    found: list[ast.AST] = []
    for node in ast.walk(tree):
        match node:
            case ast.Expr(ast.Constant(str()) as text):
                found.append(text)
            case ast.Assign([ast.Name("_EXAMPLES")], value):
                found.append(value)
            case ast.keyword("help", value):
                found.append(value)
            case _:
                pass
    return {id(inner) for node in found for inner in ast.walk(node)}


def is_name(text: str) -> bool:
    return text in ROLES or bool(NAME.search(text)) or text in bundled_library().definitions


def _pattern() -> re.Pattern[str]:
    names = set(bundled_library().definitions)
    stems = {found[1] for name in names if (found := re.fullmatch(r"(.*_)\d+", name))}
    calls = "|".join(sorted(map(re.escape, names)))
    return re.compile(rf"\b(?:(?:{calls})\(|(?:{'|'.join(sorted(map(re.escape, stems)))}))")


NAME = _pattern()


def offences(text: str) -> Iterator[str]:
    """Lines of a module that name a definition, or count rows of the table of formulas."""
    tree = ast.parse(text)
    people = said_to_people(tree)
    for node in ast.walk(tree):
        match node:
            case ast.Constant(str() as value) if id(node) not in people and is_name(value):
                yield f"{node.lineno}: {value[:60]!r}"
            case ast.BinOp(_, ast.Mod(), ast.Constant(value)) if value == ROWS:
                yield f"{node.lineno}: % {ROWS}"
            case _:
                pass


@pytest.mark.parametrize(
    "line",
    [
        'read_claim(spec, "danger(SV, POV)")',
        'f"{x} and initSafe({a}, {b})"',
        'f"scenario_{number}"',
        'f"scenario_{number}@{set_name}({vehicles})"',
        're.compile(r"roadSector_(\\d+)")',
        'name == "rssViolation"',
        'definitions["initialCondition_12"]',
        "number % 8 == 7",
        'applied(spec, 4, ("SV", other))',
    ],
)
def test_names_and_rows_are_found(line: str) -> None:
    assert list(offences(line))


@pytest.mark.parametrize(
    "line",
    [
        '"""As ``danger(SV, POV)``."""',
        'def go():\n    """As scenario_4."""',
        '_EXAMPLES = """\\\n  roadproof show \'danger(SV,POV)\'\n"""',
        'parser.add_argument("--x", help="such as scenario_4")',
        'print("there is danger", f"scenario {number}")',
        "'no danger within the section'",
        "number % 7",
    ],
)
def test_words_for_people_are_not(line: str) -> None:
    assert not list(offences(line))


def test_words_are_only_roles() -> None:
    for name in WORDS:
        found = [line.partition(": ")[2] for line in offences((SOURCE / name).read_text())]
        assert found
        assert {*found} <= {repr(role) for role in ROLES}, name


def test_no_other_file_knows_a_definition_by_name() -> None:
    found: dict[str, list[str]] = {}
    for path in sorted(SOURCE.rglob("*.py")):
        name = path.relative_to(SOURCE).as_posix()
        if name not in (HOME, *WORDS):
            found[name] = list(offences(path.read_text()))
    assert {name: lines for name, lines in found.items() if lines} == {}
    assert list(offences((SOURCE / HOME).read_text()))
