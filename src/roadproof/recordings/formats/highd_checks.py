"""What the cells of highD files must not say, together: limits, the edges of boxes, contradictions."""

from collections.abc import Iterator, Sequence

import numpy as np

from roadproof.errors import InputError
from roadproof.recordings.formats.contradictions import contradictions, nowhere, seldom
from roadproof.recordings.formats.plausible import (
    LARGEST_ACCELERATION,
    LARGEST_SIZE,
    LARGEST_SPEED,
    OFF_CENTRE,
    Implausible,
)
from roadproof.recordings.formats.recording import Bools, Floats, Integers, Recording
from roadproof.recordings.formats.table import Table, sample_rows
from roadproof.world.signals import SignalName, SizeName

LARGEST_PLACE = 10_000.0
"""x and y (m) of a section that one camera sees."""


def check_limits(tracks: Table) -> None:
    """No cell may say what no vehicle does; one of them would decide the pairs that are looked at."""
    tracks.require_within(LARGEST_PLACE, "x", "y")
    tracks.require_within(LARGEST_SPEED, "xVelocity", "yVelocity")
    tracks.require_within(LARGEST_ACCELERATION, "xAcceleration", "yAcceleration")
    tracks.require_within(LARGEST_SIZE, "width", "height")


def check_boxes(meta: Table, tracks: Table, start: Integers) -> None:
    """Both files must say the same of the size of a vehicle. Raises ``InputError``."""
    for column in ("width", "height"):
        expected = np.repeat(meta[column], np.diff(start))
        tracks.require(tracks[column] > 0, column, "the size of a vehicle is greater than zero")
        same = np.abs(tracks[column] - expected) < 0.015  # both files round to hundredths
        tracks.require(same, column, f"{meta.path.name} has another size for the vehicle")


def check_direction(meta: Table, tracks: Table, s: Floats, start: Integers) -> None:
    """No vehicle may end further back than its own length from where it began. Raises ``InputError``."""
    backwards = s[start[1:] - 1] - s[start[:-1]] < -meta["width"]
    if backwards.any():
        k = int(np.argmax(backwards))
        where = (
            f"{meta.path}, vehicle id={meta['id'][k]}, column drivingDirection={meta['drivingDirection'][k]}"
        )
        raise InputError(f"{where}: in {tracks.path.name} the vehicle moves the other way")


def check_lanes(tracks: Table, recording: Recording, marked: Bools) -> Iterator[str]:
    """Lanes must fit most vehicles: each is at least once on one, and laneId is the lane of the centre.

    ``marked``: the samples whose lanes come from the markings, which laneId counts. Raises ``InputError``.
    """

    def at(row: int) -> str:
        return f"vehicle id={tracks['id'][row]}, column y={tracks['y'][row]}"

    yield from nowhere(tracks.path, recording, at, "lane of its direction", "the markings do not fit")
    names = np.array([int(x.name) if x.name.isdecimal() else 0 for x in recording.lanes] + [0])
    other = marked & (names[recording.lane] != tracks["laneId"])
    rule = "laneId is not the lane of the box's centre"
    yield from seldom(tracks, other, "laneId", rule, "do markings and positions fit?")


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


def check_plausible(recording: Recording, tracks: Table) -> Iterator[str]:
    """Notes on what the recording contradicts itself in. Raises ``InputError`` where that is too much."""

    def at(doubt: Implausible) -> str:
        return f"{tracks.cell(doubt.row, _column_of(doubt.signal))} of vehicle {tracks['id'][doubt.row]}"

    return contradictions(tracks.path, recording, at)
