"""Curves of the vehicles of a test, sampled to be drawn."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile, load_drive
from roadproof.extensions.catalogue.entries import ConcreteTest
from roadproof.extensions.catalogue.role_choices import drive_in_roles
from roadproof.extensions.catalogue.traces import roles_in, traces_of
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace, is_pair
from roadproof.library.roles import vehicle_order
from roadproof.library.scenarios import PAIR, TRIPLE
from roadproof.world.motion import state_at
from roadproof.world.road import Road

GRAIN = Fraction(1, 10)
"""Seconds between the points of a curve of a drive."""


@dataclass(frozen=True)
class VehicleCurve:
    """The places of one vehicle (m): of its front ``along`` the road, of its edges across."""

    along: Sequence[float]
    right: Sequence[float]
    left: Sequence[float]


@dataclass(frozen=True)
class DriveCurves:
    """The curves of all vehicles of a test, SV or the first one first, at the same ``times`` (s).

    ``markings``: the places across at which lanes of its road end (m).
    """

    times: Sequence[float]
    vehicles: Mapping[str, VehicleCurve]
    markings: tuple[float, ...]


def curves_of(entry: ConcreteTest) -> DriveCurves | None:
    """Return the curves of a test; None where it cannot be read."""
    if entry.fault:
        return None
    known = {*PAIR, *TRIPLE, *entry.roles}
    try:
        if entry.place.endswith(".json") and not is_pair(entry.place):
            file = load_drive(Path(entry.place))
            return curves_of_drive(drive_in_roles(file, roles_in(entry, tuple(file.drive.vehicles), known)))
        return next((_of_trace(trace) for trace, _ in traces_of(entry, known)), None)
    except InputError:
        return None


def curves_of_drive(file: DriveFile) -> DriveCurves:
    """Return the curves of a drive up to its horizon."""
    times = [k * GRAIN for k in range(int(file.horizon / GRAIN) + 1)]
    curves = {}
    for name, motion in file.drive.vehicles.items():
        states = [state_at(motion, time) for time in times]
        left = [float(x.d) for x in states]
        right = [x - float(motion.width) for x in left]
        curves[name] = VehicleCurve([float(x.s) for x in states], right, left)
    return DriveCurves([*map(float, times)], _in_order(curves), _markings(file.road))


def _of_trace(trace: OneTrace) -> DriveCurves:
    batch, count = trace.batch, int(trace.batch.lengths[0])
    curves = {}
    for name in trace.lanes:
        left = batch.signals["d", name][:count, 0]
        right = left - batch.sizes["width", name][0]
        curves[name] = VehicleCurve(
            batch.signals["s", name][:count, 0].tolist(), right.tolist(), left.tolist()
        )
    times = [float(k * batch.dt) for k in range(count)]
    return DriveCurves(times, _in_order(curves), _markings(trace.road))


def _in_order(curves: Mapping[str, VehicleCurve]) -> dict[str, VehicleCurve]:
    return {name: curves[name] for name in vehicle_order(curves)}


def _markings(road: Road) -> tuple[float, ...]:
    return tuple(sorted({float(end) for lanelet in road.lanelets for end in lanelet.d}))
