"""A digest of plain data that is the same in every process and on every machine.

It depends on types, field names and values alone. The order of mappings and sets, shared parts, Python's hash
seed and fields that are not compared (such as places in texts) have no influence. A path has no digest, since
it says where a file is and not what it contains.
"""

import hashlib
from collections.abc import Mapping, Sequence, Set
from dataclasses import fields, is_dataclass
from enum import Enum
from fractions import Fraction
from functools import cache
from typing import Any

_REMEMBERED = "_content"


def digest(*values: object) -> str:
    """Return the SHA-256 of the values in 64 hexadecimal digits. Raises ``TypeError`` for other than plain
    data.
    """
    return hashlib.sha256(encoded(values)).hexdigest()


def encoded(value: object) -> bytes:
    """Return the canonical encoding of a value, which no other value has. Raises ``TypeError``."""
    match value:
        case None:
            return b"N"
        case Enum():
            return b"e" + _text(type(value).__qualname__) + _text(value.name)
        case bool():
            return b"T" if value else b"F"
        case int():
            return b"i%d;" % value
        case float():
            return b"f" + _text(value.hex())
        case Fraction():
            return b"q%d/%d;" % (value.numerator, value.denominator)
        case str():
            return b"s" + _text(value)
        case bytes():
            return b"b%d:" % len(value) + value
        case tuple() | list():
            return _sequence(value)
        case Mapping():
            return b"m%d:" % len(value) + b"".join(sorted(encoded(pair) for pair in value.items()))
        case Set():
            return b"u%d:" % len(value) + b"".join(sorted(map(encoded, value)))
        case _:  # open: any dataclass
            return _object(value)


def _text(text: str) -> bytes:
    data = text.encode("utf-8", "surrogatepass")
    return b"%d:" % len(data) + data


def _sequence(values: Sequence[object]) -> bytes:
    return b"t%d:" % len(values) + b"".join(map(encoded, values))


def _object(value: object) -> bytes:
    """Return the digest of a dataclass, which nodes of trees cache."""
    if not is_dataclass(value) or isinstance(value, type):
        raise TypeError(f"{type(value).__qualname__} has no digest: it is no plain data ({str(value)[:60]})")
    known: bytes | None = vars(value).get(_REMEMBERED)
    if known is None:
        head, names = _head_of(type(value))
        content = head + b"".join(encoded(getattr(value, name)) for name in names)
        known = b"o" + hashlib.sha256(content).digest()
        if getattr(type(value), "REMEMBERS", False):
            object.__setattr__(value, _REMEMBERED, known)
    return known


@cache
def _head_of(kind: Any) -> tuple[bytes, tuple[str, ...]]:
    """Return how the encoding of a class begins, and the names of its compared fields."""
    names = tuple(field.name for field in fields(kind) if field.compare)
    return b"o" + _text(kind.__qualname__) + _sequence(names), names
