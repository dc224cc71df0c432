"""Reads an assurance case from TOML; each error message names the file, the line and the rule.

The file has a ``title`` and a table for each element, whose name is the element's id. The kind of an element
is the field with its text: ``goal``, ``strategy``, ``solution``, ``context``, ``assumption`` or
``justification``. Goals and strategies have ``supported-by`` and ``in-context-of`` (ids), or ``undeveloped =
true``. Solutions have ``evidence`` (a path from the folder of the case) with ``expect`` (verdicts),
``select`` (patterns of labels), ``entries`` (how many entries are selected) and ``sha256``.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.assurance.case.case import AssuranceCase, CaseElement, ElementKind, Evidence
from roadproof.extensions.assurance.case.rules import top_goal
from roadproof.library.specification import unknown_name
from roadproof.runtime.files import read_text
from roadproof.verdict import Verdict
from roadproof.world.models import LARGEST_MODEL, read_toml

_HEADER = re.compile(r"\s*\[\s*(\"?)([^\"\]]+?)\1\s*\]")
_KEY = re.compile(r"\s*(\"?)([A-Za-z0-9_-]+)\1\s*=")
_ID = re.compile(r"[A-Za-z][A-Za-z0-9_.-]{0,30}")
_DIGEST = re.compile("[0-9a-f]{64}")
_KINDS = tuple(map(str, ElementKind))
_ARGUING, _OF_SOLUTIONS = (
    ("supported-by", "in-context-of", "undeveloped"),
    ("evidence", "expect", "select", "entries", "sha256"),
)
FIELDS = (*_KINDS, *_ARGUING, *_OF_SOLUTIONS)
LONGEST = 1000  # characters of a text


def read_case(path: Path) -> AssuranceCase:
    """Return the case of a TOML file. Raises ``InputError`` for a file that is no case or is not
    well-formed.
    """
    content = read_toml(path)
    place = _Place(str(path), _lines_of(read_text(path, LARGEST_MODEL, "")))
    title = content.get("title", path.stem)
    if not isinstance(title, str):
        raise place.error("title", "", "the title must be a text")
    tables = {name: x for name, x in content.items() if name != "title"}
    elements = {name: _element(name, table, place) for name, table in tables.items()}
    if not elements:
        raise InputError(f'{path}: there is no element: write a table such as [G1] with goal = "…"')
    top = top_goal(elements, str(path))
    return AssuranceCase(path, title, elements, top)


@dataclass(frozen=True)
class _Place:
    """The path of a file, and the line of each table and field."""

    path: str
    lines: Mapping[tuple[str, str], int]

    def line(self, table: str, field: str = "") -> int:
        """Return the line of a field, or of its table where the field has none."""
        return self.lines.get((table, field)) or self.lines.get((table, ""), 0)

    def error(self, table: str, field: str, message: str) -> InputError:
        """Return an error whose message names the place of a field."""
        line = self.line(table, field)
        where = f"{self.path}, line {line}" if line else self.path
        return InputError(f"{where}: {message}")


def _lines_of(text: str) -> dict[tuple[str, str], int]:
    """Return the line of each table and field, by their names; the field of a table itself is ""."""
    lines: dict[tuple[str, str], int] = {}
    table, closing = "", ""
    for number, line in enumerate(text.splitlines(), 1):
        if closing:
            closing = "" if closing in line else closing
            continue
        if header := _HEADER.match(line):
            table = header[2]
            lines.setdefault((table, ""), number)
        elif key := _KEY.match(line):
            lines.setdefault((table, key[2]) if table else (key[2], ""), number)
            closing = next((x for x in ('"""', "'''") if line.count(x) == 1), "")
    return lines


def _element(name: str, table: object, place: _Place) -> CaseElement:
    if not isinstance(table, Mapping):
        raise place.error(
            name, "", f"unknown field '{name[:60]}': a case has a title and a table per element"
        )
    if not _ID.fullmatch(name):
        rule = "an id begins with a letter and has up to 31 letters, digits, '.', '-' and '_'"
        raise place.error(name, "", f"'{name[:60]}' is no id: {rule}")
    for field in table:
        if field not in FIELDS:
            raise place.error(name, field, unknown_name("field", field, FIELDS))
    kinds = [x for x in _KINDS if x in table]
    if len(kinds) != 1:
        problem = f"{name} is {' and '.join(kinds)} at once" if kinds else f"{name} has no kind"
        raise place.error(name, "", f"{problem}: write one of {', '.join(_KINDS)} with its text")
    kind = ElementKind(kinds[0])
    for field in table:
        allowed = _OF_SOLUTIONS if kind is ElementKind.SOLUTION else () if kind.is_contextual else _ARGUING
        if field != kinds[0] and field not in allowed:
            raise place.error(name, field, f"{name} is a {kind}, and a {kind} has no '{field}'")
    return CaseElement(
        name,
        kind,
        _text(table, kinds[0], name, place),
        _texts(table, "supported-by", name, place),
        _texts(table, "in-context-of", name, place),
        _flag(table, "undeveloped", name, place),
        _evidence(table, name, place) if kind is ElementKind.SOLUTION else None,
        place.line(name),
    )


def _evidence(table: Mapping[str, object], name: str, place: _Place) -> Evidence:
    if "evidence" not in table:
        raise place.error(name, "", f'solution {name} has no evidence: add evidence = "PATH"')
    evidence = Evidence(
        _text(table, "evidence", name, place),
        _texts(table, "expect", name, place),
        _texts(table, "select", name, place),
        _text(table, "sha256", name, place) if "sha256" in table else "",
        _count(table, "entries", name, place),
    )
    if Path(evidence.path).is_absolute():
        raise place.error(name, "evidence", f"evidence of {name}: write the path from the folder of the case")
    for word in evidence.expect:
        if word not in [*map(str, Verdict)]:
            raise place.error(name, "expect", unknown_name("verdict", word, [*map(str, Verdict)]))
    if evidence.sha256 and not _DIGEST.fullmatch(evidence.sha256):
        raise place.error(name, "sha256", f"sha256 of {name}: write 64 digits from 0 to f")
    if not evidence.expect and not evidence.sha256:
        remedy = 'add expect = "VERDICT", or sha256 of a file that roadproof cannot check'
        raise place.error(name, "", f"solution {name} expects nothing of its evidence: {remedy}")
    for field in ("select", "entries"):
        if field in table and not evidence.expect:
            raise place.error(name, field, f"{field} of {name} requires expect")
    return evidence


def _text(table: Mapping[str, object], field: str, name: str, place: _Place) -> str:
    value = table[field]
    if not isinstance(value, str) or not value.strip():
        raise place.error(name, field, f"{field} of {name} must be a text")
    if len(value) > LONGEST:
        raise place.error(name, field, f"{field} of {name} has {len(value)} characters (limit {LONGEST})")
    return " ".join(value.split())


def _texts(table: Mapping[str, object], field: str, name: str, place: _Place) -> tuple[str, ...]:
    """Return a field that has a list of texts or a single text."""
    value = table.get(field, [])
    items = [value] if isinstance(value, str) else value
    if not isinstance(items, list) or not all(isinstance(x, str) and x for x in items):
        raise place.error(name, field, f"{field} of {name} must be a text or a list of texts")
    if twice := next((x for k, x in enumerate(items) if x in items[:k]), None):
        raise place.error(name, field, f"{field} of {name} names '{twice}' twice")
    return tuple(items)


def _count(table: Mapping[str, object], field: str, name: str, place: _Place) -> int | None:
    value = table.get(field)
    if value is not None and (type(value) is not int or value < 1):
        raise place.error(name, field, f"{field} of {name} must be a whole number greater than 0")
    return value if isinstance(value, int) else None


def _flag(table: Mapping[str, object], field: str, name: str, place: _Place) -> bool:
    value = table.get(field, False)
    if not isinstance(value, bool):
        raise place.error(name, field, f"{field} of {name} must be true or false")
    return value
