"""A codec between frozen dataclasses and JSON: one definition gives writer, strict reader and schema.

A field is declared as ``name: Annotated[type, Doc("one sentence"), …]``. Types are ``str``, ``int``,
``float``, ``bool``, ``Fraction`` (a rational as text), ``Reason`` (its text), ``Literal``, ``StrEnum``,
``tuple[T, ...]``, ``Mapping[str, T]``, other dataclasses, unions of these or with ``None``, and ``object``
(plain JSON). ``tuple[A, B]`` has one item of each type; a rule for the keys of a mapping is an annotation of
their type. A field with a default may be missing, as in files of earlier versions; it is always written,
unless it is marked ``LEFT_OUT``.
"""

import re
from collections.abc import Mapping
from dataclasses import MISSING, fields, is_dataclass
from enum import Enum, StrEnum
from fractions import Fraction
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Final, Literal, TypeVar, Union, cast, get_args, get_origin, get_type_hints

from roadproof.errors import InputError
from roadproof.evidence.json_readers import (
    SIMPLE,
    Read,
    by_length,
    enumeration,
    items_of,
    mapping,
    one_of,
    optional,
    shown,
)
from roadproof.evidence.strict import Fields, Json, JsonObject
from roadproof.reasons import Reason
from roadproof.runtime.records import dataclass

T = TypeVar("T")


@dataclass(frozen=True)
class Doc:
    """The meaning of a field or a type, in one sentence."""

    text: str


@dataclass(frozen=True)
class Key:
    """The name of a field in JSON, if it is no name in Python."""

    name: str


@dataclass(frozen=True)
class Rule:
    """The constraints on values of a type.

    Texts match ``pattern`` and have at least ``least`` characters. Numbers are at least ``minimum``. Lists
    have ``least`` to ``most`` items, without duplicates if ``unique``. ``called``: the noun for texts that
    match, for messages.
    """

    pattern: str = ""
    called: str = ""
    minimum: int | None = None
    least: int = 0
    most: int | None = None
    unique: bool = False


@dataclass(frozen=True)
class ErrorHint:
    """A text that is added to the message if a value of the type is rejected."""

    text: str


@dataclass(frozen=True)
class Mark:
    """A property of a field beside its type, such as ``LEFT_OUT``."""

    name: str


LEFT_OUT = Mark("left out")
"""The field is not written if it has its default."""
TIMED = Mark("timed")
"""A duration: answers have it; files of evidence leave it out, so two runs write the same files."""
LACKING = Mark("lacking")
"""The field is always written, but files of earlier versions may lack it."""


class Absent(Enum):
    """The value of a field that an answer leaves out, if null has a meaning of its own."""

    FIELD = "absent"


ABSENT: Final = Absent.FIELD


@dataclass(frozen=True)
class Field:
    """A field of a definition: ``name`` in Python, ``key`` in JSON, ``notes`` from its annotation."""

    name: str
    key: str
    type: object
    notes: tuple[object, ...]
    default: object

    @property
    def is_required(self) -> bool:
        return self.default is MISSING

    @property
    def is_written(self) -> bool:
        """Return whether every written answer has the field."""
        return not self.has(LEFT_OUT) and not self.has(TIMED)

    def has(self, mark: Mark) -> bool:
        """Return whether the field has a mark."""
        return mark in self.notes


@cache
def fields_of(kind: type) -> tuple[Field, ...]:
    """Return the fields of a definition, in the order of its JSON."""
    hints = get_type_hints(kind, include_extras=True)
    result = []
    for field in fields(kind):
        notes = notes_of(hints[field.name])
        key = next((note.name for note in notes if isinstance(note, Key)), field.name)
        default = field.default if field.default_factory is MISSING else field.default_factory()
        result.append(Field(field.name, key, hints[field.name], notes, default))
    return tuple(result)


def notes_of(kind: object) -> tuple[object, ...]:
    """Return the annotations of a type."""
    notes: tuple[object, ...] = getattr(kind, "__metadata__", ())
    return notes


def bare(kind: object) -> object:
    """Return a type without its annotations."""
    return get_args(kind)[0] if get_origin(kind) is Annotated else kind


# --- write ---------------------------------------------------------------------------------------


def write(value: object, timed: bool = True) -> JsonObject:
    """Return the JSON object of an instance of a definition.

    ``timed`` false: without fields marked ``TIMED``, at any depth, as in files of evidence. Raises
    ``TypeError`` for a value that is no instance of a definition.
    """
    data = _to_json(value, timed)
    assert isinstance(data, dict)
    return data


def _to_json(value: object, timed: bool) -> Json:
    match value:
        case StrEnum() | Fraction() | Reason():
            return str(value)
        case None | bool() | int() | float() | str():
            return value
        case Mapping():
            return {key: _to_json(x, timed) for key, x in value.items()}
        case tuple() | list():
            return [_to_json(x, timed) for x in value]
    if not is_dataclass(value) or isinstance(value, type):
        raise TypeError(f"{type(value).__name__} has no place in JSON")
    values = ((x, getattr(value, x.name)) for x in fields_of(type(value)))
    return {
        x.key: _to_json(y, timed)
        for x, y in values
        if (y != x.default or not x.has(LEFT_OUT)) and (timed or not x.has(TIMED))
    }


# --- read ----------------------------------------------------------------------------------------


def read(kind: type[T], content: object, where: str) -> T:
    """Return the value of a type from parsed JSON; ``where``: its place, for messages.

    Raises ``InputError`` for unknown, missing and wrong fields.
    """
    return cast(T, _reader(kind)(content, where))


def _reader(kind: object) -> Read:
    """Return the function that reads a type from parsed JSON and its place; readers are memoised."""
    if kind not in _READERS:
        reader = _plain_reader(bare(kind))
        for note in notes_of(kind):
            reader = _with_rule(reader, note) if isinstance(note, Rule) else reader
            reader = _with_hint(reader, note) if isinstance(note, ErrorHint) else reader
        _READERS[kind] = reader
    return _READERS[kind]


_READERS: dict[object, Read] = {}


def _with_hint(inner: Read, hint: ErrorHint) -> Read:
    def _read_value(content: object, where: str) -> object:
        try:
            return inner(content, where)
        except InputError as error:
            raise InputError(f"{error}; {hint.text}") from None

    return _read_value


def _with_rule(inner: Read, rule: Rule) -> Read:
    pattern = re.compile(rule.pattern)

    def _read_value(content: object, where: str) -> object:
        if rule.most is not None and isinstance(content, list | dict) and len(content) > rule.most:
            items = where.rpartition(", ")[2]
            raise InputError(f"{where}: {len(content)} {items}, at most {rule.most} are read")
        value = inner(content, where)
        if isinstance(value, str) and len(value) < rule.least:
            raise InputError(f"{where}: the text is empty")
        if isinstance(value, str) and not pattern.search(value):
            raise InputError(f"{where}: {shown(content)} is no {rule.called or f'text like {rule.pattern}'}")
        if rule.minimum is not None and isinstance(value, int | float) and value < rule.minimum:
            raise InputError(f"{where}: {shown(content)} is below {rule.minimum}")
        if isinstance(value, tuple | dict) and len(value) < rule.least:
            raise InputError(f"{where}: it has {len(value)} entries, and needs {rule.least}")
        if rule.unique and isinstance(value, tuple) and len({*value}) < len(value):
            raise InputError(f"{where}: {shown(content)} names something twice")
        return value

    return _read_value


def _plain_reader(kind: object) -> Read:
    if is_dataclass(kind) and isinstance(kind, type):
        return _object(kind)
    origin, arguments = get_origin(kind), get_args(kind)
    if origin in (Union, UnionType):
        members = [x for x in arguments if x is not NoneType]
        if all(get_origin(x) is tuple for x in members[1:]) and len(members) > 1:
            return by_length({len(get_args(x)): _reader(x) for x in members})
        reader = _either([bare(x) for x in members]) if len(members) > 1 else _reader(members[0])
        return optional(reader) if NoneType in arguments else reader
    if origin is Literal:
        return one_of(arguments)
    if origin is tuple:
        return _items(arguments[0]) if Ellipsis in arguments else items_of(tuple(map(_reader, arguments)))
    if origin is not None and issubclass(origin, Mapping):
        return mapping(_reader(arguments[0]), _reader(arguments[1]))
    if isinstance(kind, type) and issubclass(kind, StrEnum):
        return enumeration(kind)
    return SIMPLE[kind]


def _object(kind: type) -> Read:
    fields_of_kind = fields_of(kind)
    keys = tuple(x.key for x in fields_of_kind)
    readers: dict[str, Read] = {}

    def _read_value(content: object, where: str) -> object:
        if not readers:
            readers.update((x.key, _reader(x.type)) for x in fields_of_kind)
        data = Fields(content, where, keys)
        return kind(
            **{
                x.name: readers[x.key](data.get(x.key), f"{where}, {x.key}")
                for x in fields_of_kind
                if x.is_required or x.key in data.content
            }
        )

    return _read_value


def _either(kinds: list[object]) -> Read:
    """Return a reader that chooses the definition with the most fields of the object."""

    def _read_value(content: object, where: str) -> object:
        if not isinstance(content, dict):
            raise InputError(f"{where}: {shown(content)} is no object")
        best = max(kinds, key=lambda kind: len(content.keys() & {x.key for x in fields_of(kind)}))
        return _reader(best)(content, where)

    return _read_value


def _items(kind: object) -> Read:
    """Return a reader of lists; messages call an item of a definition by the name of its class."""
    inner = bare(kind)
    name = _item_name(inner) if is_dataclass(inner) and isinstance(inner, type) else "item"
    readers: list[Read] = []

    def _read_value(content: object, where: str) -> object:
        if not isinstance(content, list):
            raise InputError(f"{where}: {shown(content)} is no list")
        if not readers:
            readers.append(_reader(kind))
        return tuple(readers[0](x, f"{where}, {name} {number}") for number, x in enumerate(content, 1))

    return _read_value


def _item_name(kind: type) -> str:
    """Return ``"signal value"`` for a class ``SignalValueData``."""
    return re.sub("(?<=.)(?=[A-Z])", " ", kind.__name__.removesuffix("Data")).lower()
