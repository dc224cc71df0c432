"""Parts of recordings and maps that a reader passed over, and that no rule declares harmless."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Final

from roadproof.errors import InputError
from roadproof.world.road import Road

LEFT_OUT: Final = "left out"
"""How notes on vehicles and parts of files begin that were not read."""


def unread_note(path: Path, parts: Iterable[str], strict: bool) -> tuple[str, ...]:
    """A note on parts of a file that were not read and may have an effect; none where there are no parts.

    Raises ``InputError`` where it is ``strict``.
    """
    told = "; ".join(parts)
    if not told:
        return ()
    note = f"{LEFT_OUT} of {path.name}, as it is not supported: {told}"
    if strict:
        raise InputError(f"{path}: {note}; unless read strictly, the rest is read")
    return (note,)


def unread_columns(
    path: Path, names: Iterable[str], read: Iterable[str], harmless: Mapping[str, str], strict: bool
) -> tuple[str, ...]:
    """As ``unread_note``, of columns: ``names`` in a file that are neither ``read`` nor ``harmless``."""
    known = {*read, *harmless}
    return unread_note(path, [f"column {x}" for x in names if x not in known], strict)


def unread_of_road(road: Road | None, strict: bool = False) -> tuple[str, ...]:
    """As ``unread_note``, of the map that a road is from; none of a road that is from no map."""
    if road is None or road.map is None:
        return ()
    return unread_note(Path(road.map.partition("#")[0]), road.unread, strict)


def left_out_in(notes: Iterable[str]) -> tuple[str, ...]:
    """Those of the notes that say which vehicles and parts of files were left out."""
    return tuple(x for x in notes if x.startswith(LEFT_OUT))
