"""Weave a drive into recorded or simulated traffic, so that what must be found is known."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from roadproof.errors import UsageError
from roadproof.recordings.formats.recording import (
    Bools,
    Floats,
    Recording,
    join_vehicles,
    keep_vehicles,
    occupy_bands,
)
from roadproof.world.drive import Drive
from roadproof.world.motion import state_at
from roadproof.world.signals import RECORDED


@dataclass(frozen=True)
class Place:
    """Where a drive goes: its time 0 is at ``start_frame``, its (0, 0) at (``s``, ``d``) of the recording.

    ``seconds`` of the drive are planted; vehicles that come nearer to it than ``clear_along`` and
    ``clear_across`` (m, between boxes) are taken out of the recording.
    """

    direction: int
    start_frame: int
    seconds: Fraction
    s: float
    d: float
    clear_along: float = 8.0
    clear_across: float = 0.5


@dataclass(frozen=True)
class PlantedDrive:
    """The ground truth of a planted drive: who (id by the drive's name) and when."""

    recording: str
    vehicles: Mapping[str, int]
    first_frame: int
    last_frame: int
    removed: tuple[int, ...]


def plant(recording: Recording, drive: Drive, place: Place) -> tuple[Recording, PlantedDrive]:
    """``recording`` with ``drive`` in it, sampled exactly and rounded to hundredths, and who is who.

    The drive's vehicles are cars that are seen in the same frames, from its time 0 on, so that the
    trace of the planted vehicles starts where the drive does. Raises ``UsageError`` where the drive
    does not fit into the section, the time or the lanes that the recording shows.
    """
    frames = int(place.seconds * recording.rate) + 1
    last = place.start_frame + frames - 1
    _check_time(recording, place, last)
    names = sorted(drive.vehicles)
    samples = [_sample(drive, name, frames, place, recording.rate) for name in names]
    columns: dict[str, Any] = {
        x: np.concatenate([sampled[k] for sampled in samples]) for k, x in enumerate(RECORDED)
    }
    length, width = (
        np.array([round(float(getattr(drive.vehicles[n], x)), 2) for n in names]) for x in ("length", "width")
    )
    direction = np.full(len(names), place.direction)
    occupancy, lane = occupy_bands(
        recording.lanes, np.repeat(direction, frames), columns["d"], np.repeat(width, frames)
    )
    ids = int(recording.vehicle_id.max(initial=0)) + 1 + np.arange(len(names))
    guests = Recording(
        name=recording.name,
        rate=recording.rate,
        lanes=recording.lanes,
        beside=recording.beside,
        vehicle_id=ids,
        direction=direction,
        kind=np.full(len(names), "Car"),
        length=length,
        width=width,
        first_frame=np.full(len(names), place.start_frame),
        start=np.arange(len(names) + 1) * frames,
        **columns,
        occupancy=occupancy,
        lane=lane,
        zones=(occupancy != 0).astype(np.uint32),
    )
    _check_section(recording, guests, names)
    in_the_way = _in_the_way(recording, guests, place)
    merged = join_vehicles(keep_vehicles(recording, ~in_the_way), guests)
    who = dict(zip(names, ids.tolist(), strict=True))
    removed = tuple(recording.vehicle_id[in_the_way].tolist())
    return merged, PlantedDrive(recording.name, who, place.start_frame, last, removed)


def _sample(drive: Drive, name: str, frames: int, place: Place, rate: int) -> list[Floats]:
    motion = drive.vehicles[name]
    states = [state_at(motion, Fraction(k, rate)) for k in range(frames)]
    shifts = {"s": place.s, "d": place.d}
    return [
        np.round([float(getattr(x, signal)) + shifts.get(signal, 0.0) for x in states], 2) + 0.0
        for signal in RECORDED
    ]


def _check_time(recording: Recording, place: Place, last: int) -> None:
    first, end = int(recording.first_frame.min()), int(recording.last_frame.max())
    if not (place.seconds > 0 and first <= place.start_frame and last <= end):
        raise UsageError(
            f"plant: start_frame={place.start_frame}, seconds={float(place.seconds):g}: the drive must lie "
            f"within the frames {first} to {end} of recording {recording.name}"
        )


def _check_section(recording: Recording, guests: Recording, names: list[str]) -> None:
    """The guests must stay where the recording's own vehicles are seen, and on its lanes."""
    ours = np.repeat(recording.direction == guests.direction[0], np.diff(recording.start))
    if not ours.any():
        way = guests.direction[0]
        raise UsageError(f"plant: direction={way} has no vehicles in recording {recording.name}")
    rear = recording.s - recording.length[recording.row_vehicle]
    low, high = float(rear[ours].min()), float(recording.s[ours].max())
    vehicle = guests.row_vehicle
    outside = (guests.s > high) | (guests.s - guests.length[vehicle] < low) | (guests.occupancy == 0)
    if outside.any():
        row = int(np.argmax(outside))
        raise UsageError(
            f"plant: vehicle {names[vehicle[row]]} is at s={guests.s[row]:g}, d={guests.d[row]:g} in frame "
            f"{guests.row_frame[row]}: it must stay within s={low:g} to {high:g} and on the lanes of "
            f"recording {recording.name}; move the drive or plant fewer seconds"
        )


def _in_the_way(recording: Recording, guests: Recording, place: Place) -> Bools:
    """Which vehicles of the recording come too near to a guest at any time."""
    vehicle, frame = recording.row_vehicle, recording.row_frame
    first, counts = place.start_frame, int(guests.start[1])
    rows = np.flatnonzero(
        (recording.direction[vehicle] == place.direction) & (frame >= first) & (frame < first + counts)
    )
    found = np.zeros(recording.vehicles, bool)
    who, when = vehicle[rows], frame[rows] - first
    for k in range(guests.vehicles):
        at = guests.start[k] + when
        near = np.ones(len(rows), bool)
        for mine, theirs, size, own, margin in (
            (recording.s, guests.s, recording.length, guests.length[k], place.clear_along),
            (recording.d, guests.d, recording.width, guests.width[k], place.clear_across),
        ):
            near &= mine[rows] > theirs[at] - own - margin
            near &= mine[rows] - size[who] < theirs[at] + margin
        found[who[near]] = True
    return found
