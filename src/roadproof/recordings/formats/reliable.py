"""The part of a recording that does not contradict itself: bad vehicles are left out, and the answer says so.

Vehicles that are on no lane at any time are left out. Nothing else is left out of a recording that stands as
a whole. Where too much contradicts itself, each vehicle is asked alone: those that break a rule above the
share that a recording may are left out. Two signals are repaired instead. Accelerations along the road that
contradict the velocities are computed from these, since places confirm the velocities. Velocities across the
road that contradict the places are computed from these, where velocities along the road agree with places:
then boxes are turned against the way that they move, such as by another grid of the map.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from roadproof.errors import InputError
from roadproof.recordings.formats.plausible import SHARE, SHARE_OF_JUMPS, Implausible, check
from roadproof.recordings.formats.recording import (
    Bools,
    Floats,
    Integers,
    Recording,
    keep_vehicles,
    one_vehicle,
    with_notes,
)
from roadproof.world.signals import SignalName

MOST_LEFT_OUT = 0.5
"""Above this share of vehicles that would be left out, a recording is rejected as a whole."""
SHOWN = 50
LEFT_OUT = "left out"
"""How notes on that begin."""
_OFF_ROAD = "on no lane at any time"
_REPAIRED: Mapping[SignalName, str] = {
    "a_lon": "accelerations along the road of {} contradict their velocities; they were computed from the "
    "velocities",
    "v_lat": "velocities across the road of {} contradict their places, as boxes are turned against the way "
    "that they move; velocities and accelerations across were computed from the places",
}
"""Signals that are computed from others where these contradict them, and the note on that."""


@dataclass(frozen=True)
class LeftOut:
    """Vehicles by id that a recording is read without, and why."""

    reason: str
    vehicles: tuple[int, ...]


def left_out_note(vehicles: Sequence[object], of: int, reason: str) -> str:
    """A note that so many ``of`` vehicles were left out, with the first of them."""
    return f"{LEFT_OUT} {len(vehicles)} of {of} vehicles ({named(vehicles)}): {reason}"


def named(vehicles: Sequence[object]) -> str:
    """The first vehicles of some."""
    return ", ".join(map(str, vehicles[:SHOWN])) + (", …" if len(vehicles) > SHOWN else "")


def reliable(
    recording: Recording, strict: bool, doubts: Callable[[Recording, Integers], Iterable[str]]
) -> Recording:
    """The part of a recording that stands, with notes on what was left out and on ``doubts``.

    ``doubts`` gets a recording and the rows of the whole that it has, and gives notes; it raises
    ``InputError`` where the recording contradicts itself too much. ``strict``: leave nothing out.
    """
    rows = np.arange(len(recording.s))
    if strict:
        return with_notes(recording, doubts(recording, rows))
    part, wanted, found = _believable(recording)
    out = recording.vehicles - int(np.count_nonzero(wanted))
    if out > MOST_LEFT_OUT * recording.vehicles:
        return with_notes(recording, _rejecting(recording, rows, out, doubts))
    notes = [left_out_note(x.vehicles, recording.vehicles, x.reason) for x in found]
    kept = np.repeat(wanted, np.diff(recording.start))
    return with_notes(part, (*notes, *doubts(part, rows[kept])))


def _rejecting(
    recording: Recording, rows: Integers, out: int, doubts: Callable[[Recording, Integers], Iterable[str]]
) -> list[str]:
    try:
        return [*doubts(recording, rows)]
    except InputError as error:
        if out == recording.vehicles:
            raise  # it is a fault of all together
        told = f"{out} of {recording.vehicles} vehicles would be left out, more than half"
        raise InputError(f"{error}; {told}") from None


def _believable(recording: Recording) -> tuple[Recording, Bools, list[LeftOut]]:
    """The part without vehicles that contradict themselves, which vehicles it has, and who was left out."""
    part, wanted, found = recording, np.ones(recording.vehicles, np.bool_), list[LeftOut]()
    repaired = set[SignalName]()
    while part.vehicles:
        checks = check(part)
        rules = {_rule_of(x): x for x in checks.doubts() if x.refused}
        off = checks.off_road()
        if off is not None:
            broken = np.logical_or.reduceat(part.occupancy != 0, part.start[:-1]) == 0
            reason = _OFF_ROAD
        elif rules:
            reason, rule = next(iter(rules.items()))
            broken = np.array([_breaks(part, k, reason) for k in range(part.vehicles)], np.bool_)
            if rule.unit == "moving seconds" and rule.signal in _REPAIRED.keys() - repaired:
                repaired.add(rule.signal)
                part = _repaired(part, rule.signal, broken)
                continue
        else:
            break
        if not broken.any():
            break  # it is a fault of all together, and the recording is rejected for it
        found.append(LeftOut(reason, tuple(part.vehicle_id[broken].tolist())))
        wanted[np.flatnonzero(wanted)[broken]] = False
        part = keep_vehicles(part, ~broken)
    return part, wanted, found


def _rule_of(doubt: Implausible) -> str:
    """The rule without what is said of all that break it."""
    return doubt.rule.partition(", by a factor")[0]


def _breaks(recording: Recording, vehicle: int, rule: str) -> bool:
    """Whether a vehicle alone breaks a rule, above the share that a recording may."""
    for doubt in check(one_vehicle(recording, vehicle)).doubts():
        if _rule_of(doubt) == rule:
            share = {"moving seconds": SHARE, "steps": SHARE_OF_JUMPS}.get(doubt.unit, 0.0)
            return doubt.broken > share * doubt.asked
    return False


def contradicts_motion(recording: Recording, vehicle: int) -> bool:
    """Whether the places of a vehicle contradict its velocities, above the share that a recording may."""
    limits = {"moving seconds": SHARE, "steps": SHARE_OF_JUMPS}
    doubts = check(one_vehicle(recording, vehicle)).doubts()
    return any(x.unit in limits and x.broken > limits[x.unit] * x.asked for x in doubts)


def _repaired(recording: Recording, signal: SignalName, broken: Bools) -> Recording:
    """The recording with a signal of some vehicles computed from others, and a note on that.

    Velocities across are computed where they follow from headings, for vehicles that head along the road.
    """
    vehicles = broken & _heads_along(recording) if signal == "v_lat" else broken
    if not vehicles.any():
        return recording
    made = {x: getattr(recording, x).copy() for x in ("a_lon", "v_lat", "a_lat")}
    for v in np.flatnonzero(vehicles):
        rows = slice(recording.start[v], recording.start[v + 1])
        if signal == "v_lat":
            made["v_lat"][rows] = rate_of_change(recording.d[rows], recording.rate)
            made["a_lat"][rows] = rate_of_change(made["v_lat"][rows], recording.rate)
        else:
            made["a_lon"][rows] = rate_of_change(recording.v_lon[rows], recording.rate)
    ids = recording.vehicle_id[vehicles].tolist()
    told = _REPAIRED[signal].format(f"{len(ids)} of {recording.vehicles} vehicles ({named(ids)})")
    return with_notes(replace(recording, **made), [told])


def _heads_along(recording: Recording) -> Bools:
    """Which boxes are turned in the plane, and head along the road but for a share of their samples."""
    if recording.slack is None:
        return np.zeros(recording.vehicles, np.bool_)
    beside = np.add.reduceat(~np.isfinite(recording.slack.along), recording.start[:-1])
    along: Bools = beside <= SHARE * np.diff(recording.start)
    return along


def rate_of_change(values: Floats, rate: int) -> Floats:
    """What values change by in a second, by central differences; zero for a single value."""
    if len(values) < 2:
        return np.zeros(len(values))
    changes: Floats = np.gradient(values) * rate
    return changes
