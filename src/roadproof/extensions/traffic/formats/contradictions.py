"""Contradictions within a file: a note where they are rare, an ``InputError`` where they are frequent."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.plausible import SHARE, ContradictionChecks
from roadproof.extensions.traffic.formats.recording import Bools
from roadproof.extensions.traffic.formats.table import ColumnTable
from roadproof.world.signals import SignalName, SizeName


def note_if_rare(table: ColumnTable, wrong: Bools, column: str, rule: str, advice: str) -> Iterator[str]:
    """A note where some rows are ``wrong``, with the first cell; ``rule`` says how they are, in words.

    Raises ``InputError``, which ends with ``advice``, where more than SHARE of the rows are.
    """
    count = int(np.count_nonzero(wrong))
    if not count:
        return
    refused = count > SHARE * table.rows
    text = f"{rule} in {count} rows of {table.rows}" + (f"; {advice}" if refused else "")
    yield _note_or_raise(table.path, table.cell(int(np.argmax(wrong)), column), text, refused)


def contradiction_notes(
    path: Path,
    checks: ContradictionChecks,
    at: Callable[[int, SignalName | SizeName], str],
    vehicle_at: Callable[[int], str],
    lanelets: str,
    advice: str = "",
) -> Iterator[str]:
    """Notes on what ``checks`` found, and on vehicles that are on none of the ``lanelets``, so in words.

    ``at`` says where in the file the signal of a sample is, ``vehicle_at`` the vehicle of a sample. Raises
    ``InputError`` where it is too much, for vehicles on no lanelet with ``advice``.
    """
    for contradiction in checks.contradictions():
        yield _note_or_raise(
            path, at(contradiction.row, contradiction.signal), contradiction.text, contradiction.refused
        )
    off = checks.off_road()
    if off is not None:
        text = f"on no {lanelets} at any time, like {off.count} vehicles"
        text += f"; {advice}" if advice and off.refused else ""
        yield _note_or_raise(path, vehicle_at(off.row), text, off.refused)


def _note_or_raise(path: Path, where: str, text: str, refused: bool) -> str:
    if refused:
        raise InputError(f"{path}, {where}: {text}")
    return f"{path.name}, {where}: {text}"
