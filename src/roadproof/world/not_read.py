"""Notes on parts of recordings and maps that a reader skipped and no rule declares harmless."""

from collections.abc import Iterable
from pathlib import Path
from typing import Final

from roadproof.errors import InputError
from roadproof.world.road import Road

LEFT_OUT: Final = "left out"
"""The beginning of notes on vehicles and parts of files that were not read."""


def not_read_note(path: Path, parts: Iterable[str], strict: bool) -> tuple[str, ...]:
    """Return a note on parts of a file that were not read and may have an effect; empty for no parts.

    Raises ``InputError`` instead if ``strict``.
    """
    listing = "; ".join(parts)
    if not listing:
        return ()
    note = f"{LEFT_OUT} of {path.name}, as it is not supported: {listing}"
    if strict:
        raise InputError(f"{path}: {note}; unless read strictly, the rest is read")
    return (note,)


def road_not_read_note(road: Road | None, strict: bool = False) -> tuple[str, ...]:
    """Return a note on the skipped parts of the map of a road; empty for a road without map.

    Raises ``InputError`` instead if ``strict``.
    """
    if road is None or road.map is None:
        return ()
    return not_read_note(Path(road.map.partition("#")[0]), road.unread, strict)


def left_out_in(notes: Iterable[str]) -> tuple[str, ...]:
    """Return the notes that name skipped vehicles and parts of files."""
    return tuple(x for x in notes if x.startswith(LEFT_OUT))
