"""How the vehicles of a test move, sampled to be drawn."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from roadproof.analysis.catalogue.entries import Concrete
from roadproof.analysis.catalogue.playing import play_drive, roles_of
from roadproof.analysis.catalogue.traces import first_trace
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile, load_drive
from roadproof.library.scenarios import PAIR, SUBJECT, TRIPLE
from roadproof.recordings.evaluate.one_trace import OneTrace, is_pair
from roadproof.world.motion import state_at
from roadproof.world.road import Road

GRAIN = Fraction(1, 10)
"""Seconds between the points of a curve of a drive."""


@dataclass(frozen=True)
class Course:
    """Of one vehicle: where its front is along (m), and where its right and left edges are across (m)."""

    along: Sequence[float]
    right: Sequence[float]
    left: Sequence[float]


@dataclass(frozen=True)
class Courses:
    """All vehicles of a test, SV or the first one first, at the same ``times`` (s).

    ``markings``: where lanes of its road end across (m).
    """

    times: Sequence[float]
    vehicles: Mapping[str, Course]
    markings: tuple[float, ...]


def courses_of(entry: Concrete) -> Courses | None:
    """How the vehicles of a test move; None where it cannot be read."""
    if entry.fault:
        return None
    try:
        if entry.place.endswith(".json") and not is_pair(entry.place):
            file = load_drive(Path(entry.place))
            known = {*PAIR, *TRIPLE, *entry.roles}
            return of_drive(play_drive(file, roles_of(entry, tuple(file.drive.vehicles), known)))
        trace = first_trace(entry)
        return None if trace is None else _of_trace(trace)
    except InputError:
        return None


def of_drive(file: DriveFile) -> Courses:
    """How the vehicles of a drive move up to its horizon."""
    times = [k * GRAIN for k in range(int(file.horizon / GRAIN) + 1)]
    found = {}
    for name, motion in file.drive.vehicles.items():
        states = [state_at(motion, time) for time in times]
        left = [float(x.d) for x in states]
        right = [x - float(motion.width) for x in left]
        found[name] = Course([float(x.s) for x in states], right, left)
    return Courses([*map(float, times)], _in_order(found), _markings(file.road))


def _of_trace(trace: OneTrace) -> Courses:
    batch, count = trace.batch, int(trace.batch.lengths[0])
    found = {}
    for name in trace.lanes:
        left = batch.signals["d", name][:count, 0]
        right = left - batch.sizes["width", name][0]
        found[name] = Course(batch.signals["s", name][:count, 0].tolist(), right.tolist(), left.tolist())
    times = [float(k * batch.dt) for k in range(count)]
    return Courses(times, _in_order(found), _markings(trace.road))


def _in_order(found: Mapping[str, Course]) -> dict[str, Course]:
    return {name: found[name] for name in sorted(found, key=lambda name: (name != SUBJECT, name))}


def _markings(road: Road) -> tuple[float, ...]:
    return tuple(sorted({float(end) for lanelet in road.lanelets for end in lanelet.d}))
