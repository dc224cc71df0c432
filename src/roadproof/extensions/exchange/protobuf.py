"""Fields of messages in the wire format of Protocol Buffers, without their definitions.

A message is a sequence of fields, each a number and a value: a variable-length integer, 4 or 8 bytes, or
bytes that stand for a text or for another message.
"""

import struct
from collections.abc import Iterator
from typing import TypeAlias

Value: TypeAlias = int | bytes
_VARINT, _EIGHT, _BYTES, _FOUR = 0, 1, 2, 5
_LONGEST = 10
"""Bytes of a variable-length integer of 64 bits."""


class WireError(ValueError):
    """Bytes are no message."""


def fields_of(message: bytes) -> Iterator[tuple[int, Value]]:
    """The number and the value of each field, in order. Raises ``WireError``."""
    place = 0
    while place < len(message):
        key, place = _varint(message, place)
        number, kind = key >> 3, key & 7
        if kind == _VARINT:
            value, place = _varint(message, place)
            yield number, value
            continue
        if kind == _BYTES:
            size, place = _varint(message, place)
        elif kind in (_EIGHT, _FOUR):
            size = 8 if kind == _EIGHT else 4
        else:
            raise WireError(f"a field has the unknown wire type {kind}")
        if place + size > len(message):
            raise WireError(f"field {number} is longer than its message")
        yield number, message[place : place + size]
        place += size


def _varint(message: bytes, place: int) -> tuple[int, int]:
    """The integer at a place, and where it ends."""
    value = 0
    for k in range(_LONGEST):
        if place + k >= len(message):
            break
        byte = message[place + k]
        value |= (byte & 0x7F) << (7 * k)
        if byte < 0x80:
            return value, place + k + 1
    raise WireError("an integer has no end")


def message_in(message: bytes, number: int) -> bytes | None:
    """The last message that is field ``number``; None where there is none. Raises ``WireError``."""
    inner = None
    for each, value in fields_of(message):
        if each == number:
            if not isinstance(value, bytes):
                raise WireError(f"field {number} is no message")
            inner = value
    return inner


def integer_in(message: bytes, number: int) -> int:
    """The signed integer that is field ``number``; 0 where there is none. Raises ``WireError``."""
    integer = 0
    for each, value in fields_of(message):
        if each == number:
            if not isinstance(value, int):
                raise WireError(f"field {number} is no integer")
            integer = value - (1 << 64) if value >= 1 << 63 else value
    return integer


def doubles_in(message: bytes, count: int) -> tuple[float, ...]:
    """The doubles that are the fields 1 to ``count``, 0 where there is none. Raises ``WireError``."""
    doubles = [0.0] * count
    for number, value in fields_of(message):
        if number <= count:
            if not isinstance(value, bytes) or len(value) != 8:
                raise WireError(f"field {number} is no double")
            (doubles[number - 1],) = struct.unpack("<d", value)
    return tuple(doubles)
