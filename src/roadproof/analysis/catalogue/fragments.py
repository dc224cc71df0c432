"""The parts of a ``catalogue.toml``, one a test, each read by itself where the whole is no TOML."""

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

from roadproof.errors import InputError
from roadproof.world.models import LARGEST_MODEL, read_toml

_BEGIN = re.compile(r"\s*\[\[|\s*\[\s*test\s*\]")
_NO_LIST = "a catalogue is a list of [[test]]"
_ONE_LINE = ("id", "title", "file")
"""Fields of a test that is no TOML, which are still read where their line is."""


@dataclass(frozen=True)
class Fragment:
    """A test as it is written: its ``number`` in the file, and its ``fields``.

    ``fault``: why it is no table of TOML; its fields are then those whose line can be read.
    """

    number: int
    fields: Mapping[str, Any] = field(default_factory=dict)
    fault: str = ""


def fragments(path: Path) -> tuple[Fragment, ...]:
    """The tests of a file, in order. Raises ``InputError`` where there is none that can be read as TOML."""
    try:
        return _of_content(read_toml(path), path)
    except InputError as error:
        found = _by_itself(path)
        if all(x.fault for x in found):
            raise error from None
        return found


def _of_content(content: Mapping[str, Any], path: Path) -> tuple[Fragment, ...]:
    tests = content.get("test", [])
    strange = sorted(set(content) - {"test"})
    if not isinstance(tests, list) or not tests:
        told = f"'{strange[0]}' is not known" if strange else "there is no [[test]]"
        raise InputError(f"{path}: {told}; {_NO_LIST}")
    found = [
        Fragment(k, x) if isinstance(x, Mapping) else Fragment(k, fault="a test is a table, [[test]]")
        for k, x in enumerate(tests, 1)
    ]
    for name in strange:
        fault = f"'{name}' is not known; {_NO_LIST}"
        inside = content[name]
        tables = inside if isinstance(inside, list) else [inside]
        for table in tables:
            fields = table if isinstance(table, Mapping) else {}
            found.append(Fragment(len(found) + 1, fields, fault))
    return tuple(found)


def _by_itself(path: Path) -> tuple[Fragment, ...]:
    """The tests of a file that is no TOML, each read alone; none where texts may go over several lines."""
    try:
        text = path.read_bytes().decode("utf-8") if path.stat().st_size <= LARGEST_MODEL else ""
    except (OSError, UnicodeDecodeError):
        return ()
    if '"""' in text or "'''" in text:
        return ()
    lines = text.split("\n")
    begins = [k for k, line in enumerate(lines) if _BEGIN.match(line)]
    pieces = [(begin, lines[begin:end]) for begin, end in pairwise([*begins, len(lines)])]
    before = lines[: begins[0]] if begins else []
    pieces = [(0, before), *pieces] if any(_is_content(x) for x in before) else pieces
    return tuple(_alone(number, *piece) for number, piece in enumerate(pieces, 1))


def _is_content(line: str) -> bool:
    return bool(line.strip()) and not line.lstrip().startswith("#")


def _alone(number: int, begin: int, lines: Sequence[str]) -> Fragment:
    """The test in some lines, of which the first is that after ``begin`` others."""
    try:
        content = tomllib.loads("\n" * begin + "\n".join(lines))
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        told = f"from line {begin + 1} on this is no TOML: {error}"
        return Fragment(number, dict(_one_by_one(lines)), told)
    match content:
        case {"test": [dict() as fields]} if len(content) == 1:
            return Fragment(number, fields)
        case _:
            return Fragment(number, dict(_one_by_one(lines)), f"line {begin + 1} is not [[test]]; {_NO_LIST}")


def _one_by_one(lines: Sequence[str]) -> Iterator[tuple[str, Any]]:
    """Fields of a test whose lines can be read, though the whole cannot."""
    for line in lines:
        try:
            said = tomllib.loads(line)
        except (tomllib.TOMLDecodeError, RecursionError):
            continue
        yield from ((name, said[name]) for name in _ONE_LINE if isinstance(said.get(name), str))
