"""What a file contradicts itself in: a note where it happens seldom, and refused where it happens often."""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.recordings.formats.plausible import SHARE, Implausible, OffRoad, find_doubts, off_road
from roadproof.recordings.formats.recording import Bools, Integers, Recording
from roadproof.recordings.formats.table import Table


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


def contradictions(path: Path, recording: Recording, at: Callable[[Implausible], str]) -> Iterator[str]:
    """Notes on what ``plausible`` finds; ``at`` says where in the file that is.

    Raises ``InputError`` where it is too much.
    """
    return noted_doubts(path, find_doubts(recording), at)


def noted_doubts(
    path: Path, doubts: Iterable[Implausible], at: Callable[[Implausible], str]
) -> Iterator[str]:
    """As ``contradictions``, of what was found already."""
    for doubt in doubts:
        yield _noted(path, at(doubt), doubt.told, doubt.refused)


def nowhere(
    path: Path, recording: Recording, at: Callable[[int], str], lanelets: str, advice: str = ""
) -> Iterator[str]:
    """A note on vehicles that are on no lane; ``at`` says where in the file a sample is.

    ``lanelets``: what they are on none of, in words. Raises ``InputError``, which ends with ``advice``, where
    they are too many.
    """
    return noted_nowhere(path, off_road(recording), recording.start, at, lanelets, advice)


def noted_nowhere(
    path: Path,
    off: OffRoad | None,
    start: Integers,
    at: Callable[[int], str],
    lanelets: str,
    advice: str = "",
) -> Iterator[str]:
    """As ``nowhere``, of what was found already; ``start``: the first sample of each vehicle."""
    if off is not None:
        told = f"on no {lanelets} at any time, like {off.count} vehicles"
        told += f"; {advice}" if advice and off.refused else ""
        yield _noted(path, at(int(start[off.vehicle])), told, off.refused)


def _noted(path: Path, where: str, told: str, refused: bool) -> str:
    if refused:
        raise InputError(f"{path}, {where}: {told}")
    return f"{path.name}, {where}: {told}"
