"""Readers of JSON values, from which ``codec`` puts together the reader of a type.

A reader takes parsed JSON and its place, for messages, and raises ``InputError`` for another value.
"""

from collections.abc import Callable, Mapping
from enum import StrEnum
from fractions import Fraction
from typing import TypeAlias

from roadproof.errors import InputError
from roadproof.evidence.strict import rational, text
from roadproof.reasons import Reason, ReasonKind

Read: TypeAlias = Callable[[object, str], object]


def optional(inner: Read) -> Read:
    """Return a reader that also reads null, as None."""
    return lambda content, where: None if content is None else inner(content, where)


def by_length(readers: Mapping[int, Read]) -> Read:
    """Return a reader that chooses among ``readers`` by the number of items."""

    def _read_value(content: object, where: str) -> object:
        if not isinstance(content, list) or len(content) not in readers:
            raise InputError(
                f"{where}: {shown(content)} is no list of {' or '.join(map(str, readers))} items"
            )
        return readers[len(content)](content, where)

    return _read_value


def one_of(words: tuple[object, ...]) -> Read:
    """Return a reader of these values; 1 is not true, and 1.0 is not 1."""

    def _read_value(content: object, where: str) -> object:
        for word in words:
            if content == word and type(content) is (str if isinstance(word, str) else type(word)):
                return word
        raise InputError(f"{where}: {shown(content)} is none of {', '.join(map(str, words))}")

    return _read_value


def enumeration(kind: type[StrEnum]) -> Read:
    """Return a reader of the members of an enumeration."""

    def _read_value(content: object, where: str) -> object:
        try:
            return kind(text(content, where))
        except ValueError:
            raise InputError(f"{where}: there is no {kind.__name__.lower()} {shown(content)}") from None

    return _read_value


def items_of(readers: tuple[Read, ...]) -> Read:
    """Return a reader of lists with one item for each of ``readers``."""

    def _read_value(content: object, where: str) -> object:
        if not isinstance(content, list) or len(content) != len(readers):
            raise InputError(f"{where}: {shown(content)} is no list of {len(readers)} items")
        every = zip(readers, content, strict=True)
        return tuple(inner(x, f"{where}, item {number}") for number, (inner, x) in enumerate(every, 1))

    return _read_value


def mapping(key: Read, inner: Read) -> Read:
    """Return a reader of objects with any names; ``key`` reads each name, ``inner`` each value."""

    def _read_value(content: object, where: str) -> object:
        if not isinstance(content, dict):
            raise InputError(f"{where}: {shown(content)} is no object")
        return {key(name, where): inner(x, f"{where}.{name}") for name, x in content.items()}

    return _read_value


def _flag(content: object, where: str) -> bool:
    if not isinstance(content, bool):
        raise InputError(f"{where}: {shown(content)}; write true or false")
    return content


def _whole(content: object, where: str) -> int:
    if type(content) is not int:
        raise InputError(f"{where}: {shown(content)} is not a whole number")
    return content


def _number(content: object, where: str) -> float:
    if isinstance(content, bool) or not isinstance(content, int | float):
        raise InputError(f"{where}: {shown(content)} is no number")
    return content


def shown(value: object) -> str:
    """Return a value for a message, cut after 60 characters."""
    return repr(value)[:60]


SIMPLE: Mapping[object, Read] = {
    str: text,
    Reason: lambda content, where: ReasonKind.TOLD(text(content, where)),
    int: _whole,
    float: _number,
    bool: _flag,
    Fraction: rational,
    object: lambda content, where: content,
}
