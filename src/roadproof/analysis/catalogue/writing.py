"""A ``catalogue.toml`` for drives that complete a catalogue."""

import json
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class CatalogueEntry:
    """An entry: a concrete test in ``file``; ``copy_of``: the test of which it is the same drive, if any."""

    id: str
    title: str
    file: str
    claims: tuple[str, ...]
    copy_of: str = ""


def catalogue_text(entries: Iterable[CatalogueEntry]) -> str:
    """The entries as TOML."""
    return "\n".join(map(_entry, entries))


def _entry(entry: CatalogueEntry) -> str:
    said: dict[str, str | list[str]] = {
        "id": entry.id,
        "title": entry.title,
        "file": entry.file,
        "claims": [*entry.claims],
    }
    said |= {"copy_of": entry.copy_of} if entry.copy_of else {}
    return "[[test]]\n" + "".join(f"{field} = {_written(value)}\n" for field, value in said.items())


def _written(value: str | list[str]) -> str:
    """A basic string of TOML, or an array of some, which are written as in JSON."""
    return json.dumps(value, ensure_ascii=False)
