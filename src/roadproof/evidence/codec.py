"""Reads and writes frozen dataclasses as JSON: one definition of an answer gives both, and its JSON Schema.

A field is declared as ``name: Annotated[type, Doc("one sentence"), …]``. Types are ``str``, ``int``,
``float``, ``bool``, ``Fraction`` (a rational as text), ``Reason`` (its words), ``Literal``, enumerations of
texts, ``tuple[T, ...]``, ``Mapping[str, T]``, other dataclasses, unions of these or with ``None``, and
``object`` (plain JSON). ``tuple[A, B]`` has one item of each type; a rule for the keys of a mapping stands at
their type. A field with a default may be missing, as in evidence of earlier versions; it is written all the
same, but where it is marked ``LEFT_OUT``.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields, is_dataclass
from enum import Enum, StrEnum
from fractions import Fraction
from functools import cache
from types import NoneType, UnionType
from typing import (
    Annotated,
    Final,
    Literal,
    TypeAlias,
    TypeVar,
    Union,
    cast,
    get_args,
    get_origin,
    get_type_hints,
)

from roadproof.errors import InputError
from roadproof.evidence.strict import Fields, Json, JsonObject, rational, text
from roadproof.reasons import Reason, Why
from roadproof.runtime.records import dataclass

T = TypeVar("T")
Read: TypeAlias = Callable[[object, str], object]


@dataclass(frozen=True)
class Doc:
    """What a field or a type means, in one sentence."""

    text: str


@dataclass(frozen=True)
class Key:
    """The name of a field in JSON, where Python does not allow it."""

    name: str


@dataclass(frozen=True)
class Rule:
    """What values of a type have to be: texts match ``pattern`` and have ``least`` characters, numbers are at
    least ``minimum``, lists have ``least`` to ``most`` items; with ``unique`` they have none twice.
    ``called``: what a text that does not match is not.
    """

    pattern: str = ""
    called: str = ""
    minimum: int | None = None
    least: int = 0
    most: int | None = None
    unique: bool = False


@dataclass(frozen=True)
class Remedy:
    """What a message says in addition, where a value of the type is refused."""

    text: str


@dataclass(frozen=True)
class Mark:
    """A property of a field that is not part of its value."""

    name: str


LEFT_OUT = Mark("left out")
"""The field is left out where it has its default."""
TIMED = Mark("timed")
"""A duration: answers have it, and files of evidence leave it out, so that two runs write the same files."""
LACKING = Mark("lacking")
"""The field is always written, and files that earlier versions shipped lack it."""


class Absent(Enum):
    """What a field has that an answer leaves out, where null says something else."""

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
        """Whether each answer that is written has it."""
        return not self.has(LEFT_OUT) and not self.has(TIMED)

    def has(self, mark: Mark) -> bool:
        """Whether the field has a mark."""
        return mark in self.notes


@cache
def fields_of(kind: type) -> tuple[Field, ...]:
    """The fields of a definition, in the order of its JSON."""
    hints = get_type_hints(kind, include_extras=True)
    found = []
    for x in fields(kind):
        notes = notes_of(hints[x.name])
        key = next((note.name for note in notes if isinstance(note, Key)), x.name)
        made = x.default if x.default_factory is MISSING else x.default_factory()
        found.append(Field(x.name, key, hints[x.name], notes, made))
    return tuple(found)


def notes_of(kind: object) -> tuple[object, ...]:
    """What the annotation of a type says beside it."""
    found: tuple[object, ...] = getattr(kind, "__metadata__", ())
    return found


def bare(kind: object) -> object:
    """A type without its annotation."""
    return get_args(kind)[0] if get_origin(kind) is Annotated else kind


# --- write ---------------------------------------------------------------------------------------


def write(value: object, timed: bool = True) -> JsonObject:
    """Return the JSON object of a value of a definition.

    Without ``timed`` it has no field marked ``TIMED``, at any depth, as in files of evidence. Raises
    ``TypeError`` for a value that is no definition.
    """
    found = _plain(value, timed)
    assert isinstance(found, dict)
    return found


def _plain(value: object, timed: bool) -> Json:
    match value:
        case StrEnum() | Fraction() | Reason():
            return str(value)
        case None | bool() | int() | float() | str():
            return value
        case Mapping():
            return {key: _plain(x, timed) for key, x in value.items()}
        case tuple() | list():
            return [_plain(x, timed) for x in value]
    if not is_dataclass(value) or isinstance(value, type):
        raise TypeError(f"{type(value).__name__} has no place in JSON")
    found = ((x, getattr(value, x.name)) for x in fields_of(type(value)))
    return {
        x.key: _plain(y, timed)
        for x, y in found
        if (y != x.default or not x.has(LEFT_OUT)) and (timed or not x.has(TIMED))
    }


# --- read ----------------------------------------------------------------------------------------


def read(kind: type[T], content: object, where: str) -> T:
    """The value that JSON data say. Raises ``InputError`` for unknown, missing and mistaken fields."""
    return cast(T, _reader(kind)(content, where))


def _reader(kind: object) -> Read:
    """The function that reads a type from plain data and the place where they stand."""
    if kind not in _READERS:
        made = _unruled(bare(kind))
        for note in notes_of(kind):
            made = _ruled(made, note) if isinstance(note, Rule) else made
            made = _helped(made, note) if isinstance(note, Remedy) else made
        _READERS[kind] = made
    return _READERS[kind]


_READERS: dict[object, Read] = {}


def _helped(inner: Read, remedy: Remedy) -> Read:
    def make(content: object, where: str) -> object:
        try:
            return inner(content, where)
        except InputError as error:
            raise InputError(f"{error}; {remedy.text}") from None

    return make


def _ruled(inner: Read, rule: Rule) -> Read:
    pattern = re.compile(rule.pattern)

    def make(content: object, where: str) -> object:
        if rule.most is not None and isinstance(content, list | dict) and len(content) > rule.most:
            what = where.rpartition(", ")[2]
            raise InputError(f"{where}: {len(content)} {what}, at most {rule.most} are read")
        found = inner(content, where)
        if isinstance(found, str) and len(found) < rule.least:
            raise InputError(f"{where}: the text is empty")
        if isinstance(found, str) and not pattern.search(found):
            raise InputError(f"{where}: {_shown(content)} is no {rule.called or f'text like {rule.pattern}'}")
        if rule.minimum is not None and isinstance(found, int | float) and found < rule.minimum:
            raise InputError(f"{where}: {_shown(content)} is below {rule.minimum}")
        if isinstance(found, tuple | dict) and len(found) < rule.least:
            raise InputError(f"{where}: it has {len(found)} entries, and needs {rule.least}")
        if rule.unique and isinstance(found, tuple) and len({*found}) < len(found):
            raise InputError(f"{where}: {_shown(content)} names something twice")
        return found

    return make


def _unruled(kind: object) -> Read:
    if is_dataclass(kind) and isinstance(kind, type):
        return _object(kind)
    origin, inside = get_origin(kind), get_args(kind)
    if origin in (Union, UnionType):
        several = [x for x in inside if x is not NoneType]
        if all(get_origin(x) is tuple for x in several[1:]) and len(several) > 1:
            return _by_length({len(get_args(x)): _reader(x) for x in several})
        made = _either([bare(x) for x in several]) if len(several) > 1 else _reader(several[0])
        return _optional(made) if NoneType in inside else made
    if origin is Literal:
        return _one_of(inside)
    if origin is tuple:
        return _items(inside[0]) if Ellipsis in inside else _each(tuple(map(_reader, inside)))
    if origin is not None and issubclass(origin, Mapping):
        return _named(_reader(inside[0]), _reader(inside[1]))
    if isinstance(kind, type) and issubclass(kind, StrEnum):
        return _word(kind)
    return _SIMPLE[kind]


def _object(kind: type) -> Read:
    every = fields_of(kind)
    keys = tuple(x.key for x in every)
    readers: dict[str, Read] = {}

    def make(content: object, where: str) -> object:
        if not readers:
            readers.update((x.key, _reader(x.type)) for x in every)
        data = Fields(content, where, keys)
        return kind(
            **{
                x.name: readers[x.key](data.get(x.key), f"{where}, {x.key}")
                for x in every
                if x.is_required or x.key in data.content
            }
        )

    return make


def _optional(inner: Read) -> Read:
    return lambda content, where: None if content is None else inner(content, where)


def _either(kinds: list[object]) -> Read:
    """``kinds``: definitions, of which the one is read that has most of the fields that there are."""

    def make(content: object, where: str) -> object:
        if not isinstance(content, dict):
            raise InputError(f"{where}: {_shown(content)} is no object")
        best = max(kinds, key=lambda kind: len(content.keys() & {x.key for x in fields_of(kind)}))
        return _reader(best)(content, where)

    return make


def _by_length(readers: Mapping[int, Read]) -> Read:
    """``readers``: one for each number of items."""

    def make(content: object, where: str) -> object:
        if not isinstance(content, list) or len(content) not in readers:
            raise InputError(
                f"{where}: {_shown(content)} is no list of {' or '.join(map(str, readers))} items"
            )
        return readers[len(content)](content, where)

    return make


def _one_of(words: tuple[object, ...]) -> Read:
    def make(content: object, where: str) -> object:
        for word in words:
            if content == word and type(content) is (str if isinstance(word, str) else type(word)):
                return word
        raise InputError(f"{where}: {_shown(content)} is none of {', '.join(map(str, words))}")

    return make


def _word(kind: type[StrEnum]) -> Read:
    def make(content: object, where: str) -> object:
        try:
            return kind(text(content, where))
        except ValueError:
            raise InputError(f"{where}: there is no {kind.__name__.lower()} {_shown(content)}") from None

    return make


def _items(kind: object) -> Read:
    """``kind``: the type of the items; an item of a definition is called by its name."""
    inner = bare(kind)
    name = _told(inner) if is_dataclass(inner) and isinstance(inner, type) else "item"
    readers: list[Read] = []

    def make(content: object, where: str) -> object:
        if not isinstance(content, list):
            raise InputError(f"{where}: {_shown(content)} is no list")
        if not readers:
            readers.append(_reader(kind))
        return tuple(readers[0](x, f"{where}, {name} {number}") for number, x in enumerate(content, 1))

    return make


def _told(kind: type) -> str:
    """``settled claim`` of ClaimAnswer."""
    return re.sub("(?<=.)(?=[A-Z])", " ", kind.__name__).lower()


def _each(readers: tuple[Read, ...]) -> Read:
    """``readers``: one for each item."""

    def make(content: object, where: str) -> object:
        if not isinstance(content, list) or len(content) != len(readers):
            raise InputError(f"{where}: {_shown(content)} is no list of {len(readers)} items")
        every = zip(readers, content, strict=True)
        return tuple(inner(x, f"{where}, item {number}") for number, (inner, x) in enumerate(every, 1))

    return make


def _named(key: Read, inner: Read) -> Read:
    def make(content: object, where: str) -> object:
        if not isinstance(content, dict):
            raise InputError(f"{where}: {_shown(content)} is no object")
        return {key(name, where): inner(x, f"{where}.{name}") for name, x in content.items()}

    return make


def _flag(content: object, where: str) -> bool:
    if not isinstance(content, bool):
        raise InputError(f"{where}: {_shown(content)}; write true or false")
    return content


def _whole(content: object, where: str) -> int:
    if type(content) is not int:
        raise InputError(f"{where}: {_shown(content)} is not a whole number")
    return content


def _number(content: object, where: str) -> float:
    if isinstance(content, bool) or not isinstance(content, int | float):
        raise InputError(f"{where}: {_shown(content)} is no number")
    return content


def _shown(value: object) -> str:
    return repr(value)[:60]


_SIMPLE: Mapping[object, Read] = {
    str: text,
    Reason: lambda content, where: Why.TOLD(text(content, where)),
    int: _whole,
    float: _number,
    bool: _flag,
    Fraction: rational,
    object: lambda content, where: content,
}
