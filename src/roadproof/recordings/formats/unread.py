"""Parts of recordings and maps that a reader passed over, and that no rule declares harmless."""

from collections.abc import Iterable, Mapping
from pathlib import Path

from roadproof.errors import InputError
from roadproof.recordings.formats.reliable import LEFT_OUT


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
