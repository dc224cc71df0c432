"""What the cells of highD files must not say, together: limits, the edges of boxes, contradictions."""

from collections.abc import Sequence

import numpy as np

from roadproof.errors import InputError
from roadproof.signals import SignalName, SizeName
from roadproof.traffic.plausible import (
    LARGEST_ACCELERATION,
    LARGEST_SIZE,
    LARGEST_SPEED,
    OFF_CENTRE,
    find_doubts,
)
from roadproof.traffic.recording import Recording
from roadproof.traffic.table import Table, sample_rows

LARGEST_PLACE = 10_000.0
"""x and y (m) of a section that one camera sees."""


def check_limits(tracks: Table) -> None:
    """No cell may say what no vehicle does; one of them would decide the pairs that are looked at."""
    limits = {
        "x": LARGEST_PLACE,
        "y": LARGEST_PLACE,
        "xVelocity": LARGEST_SPEED,
        "yVelocity": LARGEST_SPEED,
        "xAcceleration": LARGEST_ACCELERATION,
        "yAcceleration": LARGEST_ACCELERATION,
        "width": LARGEST_SIZE,
        "height": LARGEST_SIZE,
    }
    for column, most in limits.items():
        values = tracks[column]
        if max(-values.min(), values.max()) > most:
            tracks.require(np.abs(values) <= most, column, f"must lie between {-most:g} and {most:g}")


def check_sight(meta: Table, tracks: Table, header: Sequence[str], upper: int) -> tuple[str, ...]:
    """x against the distance to the end of the section, which the format counts from the box's centre.

    ``header`` names the columns of the tracks, ``upper`` is the direction towards -x.
    x + width/2 less that distance is one number for short and long vehicles, unless x is not the left edge.
    """
    names = ("id", "x", "width", "frontSightDistance", "backSightDistance")
    rows = np.array(sample_rows(tracks.path, header, names, 400)).reshape(-1, len(names))
    rows = rows[(rows[:, 3] > 0) & (rows[:, 4] > 0)]
    rows = rows[np.argsort(rows[:, 2], kind="stable")]
    third = len(rows) // 3
    if third < 15:
        return ()
    spread = float(np.median(rows[-third:, 2]) - np.median(rows[:third, 2])) / 2
    if spread < 0.2:
        return ()
    up = meta["drivingDirection"][np.searchsorted(meta["id"], rows[:, 0])] == upper
    west = rows[:, 1] + rows[:, 2] / 2 - np.where(up, rows[:, 3], rows[:, 4])
    slope = float(np.median(west[-third:]) - np.median(west[:third])) / spread
    if abs(slope) <= OFF_CENTRE[0]:
        return ()
    told = (
        f"column x: x + width/2 and the distances to the ends of the section differ by {slope:.2f} half "
        "lengths: is x the left edge of the box?"
    )
    if abs(slope) > OFF_CENTRE[1]:
        raise InputError(f"{tracks.path}, {told}")
    return (f"{tracks.path.name}, {told}",)


def _column_of(name: SignalName | SizeName) -> str:
    match name:
        case "s":
            return "x"
        case "d":
            return "y"
        case "v_lon":
            return "xVelocity"
        case "v_lat":
            return "yVelocity"
        case "a_lon":
            return "xAcceleration"
        case "length":
            return "width"
        case "width":
            return "height"
        case _:
            raise ValueError(f"no rule of traffic.plausible is about {name}")


def check_plausible(recording: Recording, tracks: Table) -> tuple[str, ...]:
    """Notes on what the recording contradicts itself in. Raises ``InputError`` where that is too much."""
    notes = []
    for doubt in find_doubts(recording):
        cell = f"{tracks.cell(doubt.row, _column_of(doubt.signal))} of vehicle {tracks['id'][doubt.row]}"
        if doubt.refused:
            raise InputError(f"{tracks.path}, {cell}: {doubt.told}")
        notes.append(f"{tracks.path.name}, {cell}: {doubt.told}")
    return tuple(notes)
