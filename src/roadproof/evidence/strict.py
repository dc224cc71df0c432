"""The strict JSON reader of all evidence: each field occurs once, is known and has the right type.

A file that two readers may understand differently is no evidence. The reader rejects: text that is not UTF-8,
duplicate or unknown keys, NaN and Infinity, long numbers, wrong types, a NUL in a text, deep nesting, large
files.
"""

import json
import math
import re
from collections.abc import Collection
from fractions import Fraction
from pathlib import Path
from typing import NoReturn, TypeAlias

from roadproof.errors import InputError
from roadproof.runtime.files import read_text

Json: TypeAlias = "bool | int | float | str | list[Json] | dict[str, Json] | None"
JsonObject: TypeAlias = dict[str, Json]

LARGEST_EVIDENCE = 5_000_000  # bytes of a certificate or a drive file
LARGEST_INDEX = 50_000_000  # bytes of an index, and of a journal
DEEPEST = 40
LONGEST_NUMBER = 30  # characters of a number in JSON; rationals are texts
_RATIONAL = re.compile(r"-?[0-9]{1,40}(/[0-9]{1,40})?")
_FORBIDDEN = re.compile("[\x00\ud800-\udfff]")


def read_json(path: Path, max_bytes: int = LARGEST_EVIDENCE) -> Json:
    """Return the parsed content of a file. Raises ``InputError`` with the file and the rule.

    ``max_bytes``: the greatest size in bytes.
    """
    return parse_json(read_text(path, max_bytes, "roadproof reads no larger evidence"), str(path))


def parse_json(text: str, where: str) -> Json:
    """Return the parsed content of a text. Raises ``InputError`` with ``where`` in front."""
    try:
        content: Json = json.loads(
            text,
            object_pairs_hook=lambda pairs: _object(pairs, where),
            parse_int=lambda digits: int(_check_length(digits, where)),
            parse_float=lambda digits: _finite(digits, where),
            parse_constant=lambda name: _refuse(f"{where}: {name} is no number"),
        )
    except json.JSONDecodeError as error:
        raise InputError(f"{where}: this is no JSON text: {error}") from None
    except RecursionError:
        raise InputError(f"{where}: it is nested deeper than {DEEPEST}") from None
    _check(content, where)
    return content


def _object(pairs: list[tuple[str, Json]], where: str) -> JsonObject:
    fields: JsonObject = {}
    for key, value in pairs:
        if key in fields:
            raise InputError(f"{where}: the key '{key[:60]}' is given twice in one object")
        fields[key] = value
    return fields


def _check_length(digits: str, where: str) -> str:
    if len(digits) > LONGEST_NUMBER:
        raise InputError(f"{where}: a number of {len(digits)} characters; at most {LONGEST_NUMBER} are read")
    return digits


def _finite(digits: str, where: str) -> float:
    value = float(_check_length(digits, where))
    return value if math.isfinite(value) else _refuse(f"{where}: {digits} is no finite number")


def _refuse(message: str) -> NoReturn:
    raise InputError(message)


def _check(content: object, where: str) -> None:
    """Reject deep nesting and forbidden characters."""
    level: list[object] = [content]
    for _ in range(DEEPEST):
        below: list[object] = []
        for value in level:
            if isinstance(value, dict):
                below += value
                below += value.values()
            elif isinstance(value, list):
                below += value
            elif isinstance(value, str) and (match := _FORBIDDEN.search(value)):
                raise InputError(f"{where}: a text holds the character U+{ord(match[0]):04X}")
        if not below:
            return
        level = below
    raise InputError(f"{where}: it is nested deeper than {DEEPEST}")


class Fields:
    """The fields of a JSON object, each read as one type; every error is an ``InputError``.

    ``known``: all allowed fields; None allows any.
    """

    def __init__(self, content: object, where: str, known: Collection[str] | None = None) -> None:
        if not isinstance(content, dict):
            raise InputError(f"{where}: a JSON object is expected here")
        unknown = [] if known is None else [key for key in content if key not in known]
        if unknown:
            raise InputError(f"{where}: unknown field '{unknown[0][:60]}': remove it, or correct its name")
        self.content: JsonObject = content
        self.where = where

    def has(self, field: str) -> bool:
        """Return whether the field exists and is not null."""
        return self.content.get(field) is not None

    def get(self, field: str) -> Json:
        """Return the raw value of a field."""
        if field not in self.content:
            raise InputError(f"{self.where}: '{field}' is missing")
        return self.content[field]

    def text(self, field: str) -> str:
        """Return a field that must be a text."""
        return text(self.get(field), f"{self.where}, {field}")

    def texts(self, field: str) -> tuple[str, ...]:
        """Return a field that must be a list of texts."""
        return tuple(text(item, f"{self.where}, {field}") for item in self.items(field))

    def flag(self, field: str) -> bool:
        """Return a field that must be true or false."""
        value = self.get(field)
        if type(value) is not bool:
            raise InputError(f"{self.where}: {field}={_shown(value)}; write true or false")
        return value

    def whole(self, field: str) -> int:
        """Return a field that must be a whole number."""
        value = self.get(field)
        if type(value) is not int:
            raise InputError(f"{self.where}: {field}={_shown(value)} is not a whole number")
        return value

    def mapping(self, field: str) -> JsonObject:
        """Return a field that must be an object."""
        value = self.get(field)
        if not isinstance(value, dict):
            raise InputError(f"{self.where}: '{field}' is no object")
        return value

    def items(self, field: str) -> list[Json]:
        """Return a field that must be a list."""
        value = self.get(field)
        if not isinstance(value, list):
            raise InputError(f"{self.where}: '{field}' is no list")
        return value

    def rational(self, field: str) -> Fraction:
        """Return a field that must be a rational as text, such as "3/5"."""
        return rational(self.get(field), f"{self.where}, {field}")


def text(value: object, where: str) -> str:
    """Return the value, which must be a text. Raises ``InputError``."""
    if not isinstance(value, str):
        raise InputError(f"{where}: {_shown(value)} is no text")
    return value


def is_rational(value: object) -> bool:
    """Return whether a value is a rational as text, such as "3/5"."""
    return isinstance(value, str) and _RATIONAL.fullmatch(value) is not None


def rational(value: object, where: str) -> Fraction:
    """Return the number of a rational as text, such as "3/5". Raises ``InputError``."""
    if not isinstance(value, str) or not is_rational(value):
        raise InputError(f'{where}: {_shown(value)} is no rational as text, such as "3/5"')
    top, _, bottom = value.partition("/")
    if bottom and int(bottom) == 0:
        raise InputError(f"{where}: {value!r} divides by zero")
    return Fraction(int(top), int(bottom or 1))


def _shown(value: object) -> str:
    return repr(value)[:60]
