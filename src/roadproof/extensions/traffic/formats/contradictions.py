"""What a file contradicts itself in: a note where it happens seldom, and refused where it happens often."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.plausible import SHARE, ContradictionChecks
from roadproof.extensions.traffic.formats.recording import Bools
from roadproof.extensions.traffic.formats.table import Table
from roadproof.world.signals import SignalName, SizeName


def seldom(table: Table, wrong: Bools, column: str, rule: str, advice: str) -> Iterator[str]:
    """A note where some rows are ``wrong``, with the first cell; ``rule`` says how they are, in words.

    Raises ``InputError``, which ends with ``advice``, where more than SHARE of the rows are.
    """
    count = int(np.count_nonzero(wrong))
    if not count:
        return
    refused = count > SHARE * table.rows
    told = f"{rule} in {count} rows of {table.rows}" + (f"; {advice}" if refused else "")
    yield _noted(table.path, table.cell(int(np.argmax(wrong)), column), told, refused)


def contradictions(
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
    for doubt in checks.doubts():
        yield _noted(path, at(doubt.row, doubt.signal), doubt.told, doubt.refused)
    off = checks.off_road()
    if off is not None:
        told = f"on no {lanelets} at any time, like {off.count} vehicles"
        told += f"; {advice}" if advice and off.refused else ""
        yield _noted(path, vehicle_at(off.row), told, off.refused)


def _noted(path: Path, where: str, told: str, refused: bool) -> str:
    if refused:
        raise InputError(f"{path}, {where}: {told}")
    return f"{path.name}, {where}: {told}"
