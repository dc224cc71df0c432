"""Reader of ``catalogue.toml``; an entry that cannot be read becomes a test with a fault.

Each ``[[test]]`` has an ``id``, and either a ``file`` (a concrete test; beside the TOML, or vehicles of a
recording as ``01_tracks.csv:12,15``) or a ``formula`` (an abstract one). ``claims`` are numbers of scenarios
and names of classes that the test is meant to show; ``copy_of`` is the id of a test of which the file is the
same drive in another format; ``roles`` names the vehicle of the file for each role.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

from roadproof.errors import InputError, RoadproofError
from roadproof.extensions.catalogue.entries import AbstractTest, ConcreteTest, Entry
from roadproof.library import scenarios
from roadproof.library.compose import always, both
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import split_claim
from roadproof.library.scenario_references import numbers_by_name, read_numbers
from roadproof.library.specification import Query, Specification, unknown_name
from roadproof.runtime.files import read_text
from roadproof.world.models import LARGEST_MODEL, load_road, load_vehicle, read_toml

_BEGIN = re.compile(r"\s*\[\[|\s*\[\s*test\s*\]")
_NO_LIST = "a catalogue is a list of [[test]]"
_ONE_LINE = ("id", "title", "file")
"""The fields that are still read from an entry that is no TOML, each where its line is TOML."""


@dataclass(frozen=True)
class Fragment:
    """The entry of a test as written: its ``number`` in the file, and its ``fields``.

    ``fault``: why it is no table of TOML; ``fields`` are then those whose line can be read.
    """

    number: int
    fields: Mapping[str, object] = field(default_factory=dict)
    fault: str = ""


def fragments(path: Path) -> tuple[Fragment, ...]:
    """Return the entries of a file in order. Raises ``InputError`` where none of them is TOML."""
    try:
        return _of_content(read_toml(path), path)
    except InputError as error:
        entries = _fragments_alone(path)
        if all(x.fault for x in entries):
            raise error from None
        return entries


def _of_content(content: Mapping[str, object], path: Path) -> tuple[Fragment, ...]:
    tests = content.get("test", [])
    strange = sorted(set(content) - {"test"})
    if not isinstance(tests, list) or not tests:
        message = f"'{strange[0]}' is not known" if strange else "there is no [[test]]"
        raise InputError(f"{path}: {message}; {_NO_LIST}")
    entries = [
        Fragment(k, x) if isinstance(x, Mapping) else Fragment(k, fault="a test is a table, [[test]]")
        for k, x in enumerate(tests, 1)
    ]
    for name in strange:
        fault = f"'{name}' is not known; {_NO_LIST}"
        inside = content[name]
        tables = inside if isinstance(inside, list) else [inside]
        for table in tables:
            fields = table if isinstance(table, Mapping) else {}
            entries.append(Fragment(len(entries) + 1, fields, fault))
    return tuple(entries)


def _fragments_alone(path: Path) -> tuple[Fragment, ...]:
    """Return the entries of a file that is no TOML, each read alone; none if texts may have several lines."""
    try:
        text = read_text(path, LARGEST_MODEL, "")
    except InputError:
        return ()
    if '"""' in text or "'''" in text:
        return ()
    lines = text.split("\n")
    begins = [k for k, line in enumerate(lines) if _BEGIN.match(line)]
    pieces = [(begin, lines[begin:end]) for begin, end in pairwise([*begins, len(lines)])]
    before = lines[: begins[0]] if begins else []
    pieces = [(0, before), *pieces] if any(_is_content(x) for x in before) else pieces
    return tuple(_fragment_alone(number, *piece) for number, piece in enumerate(pieces, 1))


def _is_content(line: str) -> bool:
    return bool(line.strip()) and not line.lstrip().startswith("#")


def _fragment_alone(number: int, begin: int, lines: Sequence[str]) -> Fragment:
    """Return the entry in some lines, of which the first follows ``begin`` other lines of the file."""
    try:
        content = tomllib.loads("\n" * begin + "\n".join(lines))
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        fault = f"from line {begin + 1} on this is no TOML: {error}"
        return Fragment(number, dict(_fields_of_lines(lines)), fault)
    match content:
        case {"test": [dict() as fields]} if len(content) == 1:
            return Fragment(number, fields)
        case _:  # open: content of a file
            fault = f"line {begin + 1} is not [[test]]; {_NO_LIST}"
            return Fragment(number, dict(_fields_of_lines(lines)), fault)


def _fields_of_lines(lines: Sequence[str]) -> Iterator[tuple[str, Any]]:
    """Yield the fields of an entry whose lines can be read, though the whole cannot."""
    for line in lines:
        try:
            field = tomllib.loads(line)
        except (tomllib.TOMLDecodeError, RecursionError):
            continue
        yield from ((name, field[name]) for name in _ONE_LINE if isinstance(field.get(name), str))


FILE_NAME = "catalogue.toml"
_FIELDS = (
    *("id", "title", "file", "copy_of", "roles", "formula", "claims", "road", "vehicles", "at_start"),
    "always",
)
_OF_FORMULAS = ("road", "vehicles", "at_start", "always")
_OF_FILES = ("copy_of", "roles")
_RANGE = re.compile(r"\s*(.+?)\s*\.\.\s*(.+?)\s*")


def read_catalogue_file(path: Path, specification: Specification) -> Iterator[Entry]:
    """Yield the tests of a file in order. Raises ``InputError`` where it is no list of tests at all."""
    for fragment in fragments(path):
        own_id = _text_or_empty(fragment.fields, "id")
        where = f"{path}, test {own_id or fragment.number}"
        try:
            if fragment.fault:
                raise InputError(f"{where}: {fragment.fault}")
            yield _entry(path, fragment.fields, where, specification)
        except RoadproofError as error:
            message = str(error)
            fault = message if str(path) in message else f"{where}: {message}"
            yield _unreadable(path, fragment, own_id or where, fault)


def _unreadable(path: Path, fragment: Fragment, own_id: str, fault: str) -> ConcreteTest:
    """Return a test that cannot be read, with its file, which is no test by itself."""
    file = _text_or_empty(fragment.fields, "file")
    place = str(path.parent / file) if file else str(path)
    return ConcreteTest(own_id, place, _text_or_empty(fragment.fields, "title"), fault=fault)


def _text_or_empty(fields: Mapping[str, object], name: str) -> str:
    """Return a text of an entry; empty where it has none."""
    value = fields.get(name)
    return value.strip() if isinstance(value, str) else ""


def _entry(path: Path, test: Mapping[str, object], where: str, specification: Specification) -> Entry:
    """Return the test of an entry; ``where``: its place in messages. Raises ``InputError``."""
    for name in test:
        if name not in _FIELDS:
            near = unknown_name("key", name, _FIELDS).partition("; ")[2]
            remedy = near if near.startswith("did you mean") else f"a test has {', '.join(_FIELDS)}"
            raise InputError(f"{where}: '{name}' is not known; {remedy}")
    own_id = _text(test, "id", where)
    if ("file" in test) == ("formula" in test):
        raise InputError(f"{where}: a test has either a file or a formula")
    title = _text(test, "title", where) if "title" in test else ""
    claims = tuple(_claims(test.get("claims", []), f"{where}, claims", specification))
    if "file" in test:
        for name in _OF_FORMULAS:
            if name in test:
                raise InputError(f"{where}: {name} is for tests with a formula")
        original = _text(test, "copy_of", where) if "copy_of" in test else ""
        file = str(path.parent / _text(test, "file", where))
        return ConcreteTest(own_id, file, title, claims, original, _roles(test, where))
    for name in _OF_FILES:
        if name in test:
            raise InputError(f"{where}: {name} is for tests with a file")
    query = both(*_parts(test, where, specification))
    road = None if "road" not in test else load_road(_beside(path, _text(test, "road", where)))
    models = _table(test, "vehicles", where)
    vehicles = {name: load_vehicle(_beside(path, model)) for name, model in models.items()}
    return AbstractTest(own_id, query, title, claims, road, vehicles)


def _roles(test: Mapping[str, object], where: str) -> dict[str, str]:
    """Return the vehicle of each role: its name, or its number in a recording."""
    table = test.get("roles", {})
    if not isinstance(table, Mapping):
        raise InputError(f"{where}: roles={table!r}; write a table, such as {{ SV = 'ego' }}")
    for role, vehicle in table.items():
        if isinstance(vehicle, bool) or not isinstance(vehicle, str | int) or not str(vehicle).strip():
            raise InputError(f"{where}, roles: {role} = {vehicle!r}; write the name of a vehicle of the file")
    roles = {role: str(vehicle).strip() for role, vehicle in table.items()}
    for vehicle in roles.values():
        those = [role for role, other in roles.items() if other == vehicle]
        if len(those) > 1:
            raise InputError(f"{where}, roles: {vehicle} is {' and '.join(those)}; it can play one role")
    return roles


def _parts(test: Mapping[str, object], where: str, specification: Specification) -> Iterator[Query]:
    """Yield the formula, and each of its ranges as a formula."""
    assumptions, claim = split_claim(_text(test, "formula", where), f"{where}, formula")
    if assumptions:
        prefix = f"assuming {', '.join(assumptions)}"
        raise InputError(
            f"{where}, formula: leave '{prefix}:' out; the drives of a test are motions as it is"
        )
    yield read_claim(specification, claim, f"{where}, formula")
    for name, put in (("at_start", both), ("always", always)):
        for term, bounds in _table(test, name, where).items():
            match = _RANGE.fullmatch(bounds)
            if match is None:
                raise InputError(
                    f"{where}, {name}: '{term}' = {bounds!r}; write a range, as 20 m/s .. 30 m/s"
                )
            low, high = match.groups()
            within = f"{low} <= {term} and {term} <= {high}"
            yield put(read_claim(specification, within, f"{where}, {name}"))


def _claims(claims: object, where: str, specification: Specification) -> Iterator[str]:
    """Yield the definition of each claimed scenario and class. Raises ``InputError``."""
    if not isinstance(claims, list):
        raise InputError(f"{where}={claims!r}: write a list, such as [4] or ['class_4_main']")
    for one in claims:
        if isinstance(one, bool) or not isinstance(one, int | str):
            raise InputError(f"{where}: {one!r} is no number of a scenario and no name of a class")
        yield claimed_definition(specification, one, where)


def _text(test: Mapping[str, object], field: str, where: str) -> str:
    """Return a text of an entry. Raises ``InputError`` where it has none."""
    value = test.get(field)
    if not isinstance(value, str) or not value.strip():
        message = f"{field}={value!r}; write a text" if field in test else f"there is no {field}; write one"
        raise InputError(f"{where}: {message}")
    return value.strip()


def _table(test: Mapping[str, object], field: str, where: str) -> dict[str, str]:
    """Return a table of texts of an entry; empty where it has none. Raises ``InputError``."""
    table = test.get(field, {})
    if not isinstance(table, Mapping) or not all(isinstance(x, str) for x in table.values()):
        raise InputError(f"{where}: {field}={table!r}; write a table of texts")
    return dict(table)


def _beside(path: Path, name: str) -> str:
    """Return the name of a model, or the path of its file beside the catalogue."""
    return str(path.parent / name) if Path(name).suffix else name


def claimed_definition(specification: Specification, name: int | str, where: str) -> str:
    """Return the name of the definition that a test claims to show: a scenario by number or name, or a name.

    Raises ``InputError`` for an unknown scenario, for several, and for text that is no name.
    """
    text = str(name).strip()
    numbers = numbers_by_name(specification, text)
    if numbers or scenarios.are_numbers(text):
        numbers = numbers or read_numbers(specification, text)
        if len(numbers) != 1:
            raise InputError(f"{where}: '{text}' names {len(numbers)} scenarios; name each by itself")
        return scenarios.name_of(numbers[0])
    if not text.isidentifier():
        raise InputError(f"{where}: '{text[:40]}' is no number of a scenario and no name")
    return text
