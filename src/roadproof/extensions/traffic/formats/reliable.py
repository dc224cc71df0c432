"""The part of a recording that does not contradict itself: bad vehicles are left out, and the answer says so.

Vehicles that are on no lane at any time are left out. Nothing else is left out of a recording that stands as
a whole. Where too much contradicts itself, each vehicle is asked alone: those that break a rule above the
share that a recording may are left out. Two signals are repaired instead. Accelerations along the road that
contradict the velocities are computed from these, since places confirm the velocities; a known factor by
which most of a recording is off, such as a turned sign, is undone for all vehicles. Velocities across the
road that contradict the places are computed from these, where velocities along the road agree with places:
then boxes are turned against the way that they move, such as by another grid of the map.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.plausible import (
    SHARE,
    SHARE_OF_JUMPS,
    Contradiction,
    ContradictionChecks,
    contradiction_checks,
)
from roadproof.extensions.traffic.formats.recording import (
    Bools,
    Floats,
    Integers,
    Recording,
    keep_vehicles,
    one_vehicle,
    with_notes,
)
from roadproof.reasons import Reason, ReasonKind
from roadproof.world.not_read import LEFT_OUT, left_out_in
from roadproof.world.signals import SignalName

MOST_LEFT_OUT = 0.5
"""Above this share of vehicles that would be left out, a recording is rejected as a whole."""
SHOWN = 50
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

    reason: Reason
    vehicles: tuple[int, ...]


def left_out_note(vehicles: Sequence[object], of: int, reason: Reason) -> str:
    """A note that so many ``of`` vehicles were left out, with the first of them."""
    return f"{LEFT_OUT} {len(vehicles)} of {of} vehicles ({first_names(vehicles)}): {reason}"


def left_out_notes(recording: Recording) -> list[str]:
    """The notes of a recording on vehicles and parts that it was read without, with its name."""
    return [f"recording {recording.name}: {x}" for x in left_out_in(recording.notes)]


def first_names(vehicles: Sequence[object]) -> str:
    """The first vehicles of some."""
    return ", ".join(map(str, vehicles[:SHOWN])) + (", …" if len(vehicles) > SHOWN else "")


def reliable_part(
    recording: Recording, strict: bool, notes_on: Callable[[ContradictionChecks, Integers], Iterable[str]]
) -> Recording:
    """The part of a recording that stands, with notes on what was left out and on ``notes_on``.

    ``notes_on`` gets the checks of a part and its rows of the whole, and gives notes; it raises
    ``InputError`` where the part contradicts itself too much. ``strict``: leave nothing out.
    """
    rows = np.arange(len(recording.s))
    if strict:
        return with_notes(recording, notes_on(contradiction_checks(recording), rows))
    selection = selection_of(lambda: iter((recording,)))
    out = len(selection.lost)
    if out > MOST_LEFT_OUT * recording.vehicles:
        return with_notes(recording, _notes_of_rejected(recording, rows, out, notes_on))
    if selection.lost:
        rows = rows[np.repeat(~np.isin(recording.vehicle_id, selection.lost), np.diff(recording.start))]
    part = with_notes(selection.of(recording), selection.notes)
    return with_notes(part, notes_on(selection.checks or contradiction_checks(part), rows))


def _notes_of_rejected(
    recording: Recording,
    rows: Integers,
    out: int,
    notes_on: Callable[[ContradictionChecks, Integers], Iterable[str]],
) -> list[str]:
    try:
        return [*notes_on(contradiction_checks(recording), rows)]
    except InputError as error:
        raise too_many(error, out, recording.vehicles) from None


def too_many(error: InputError, out: int, of: int) -> InputError:
    """The error of a recording of which too many vehicles would be left out; of all: it is a common fault."""
    if out == of:
        return error
    return InputError(f"{error}; {out} of {of} vehicles would be left out, more than half")


@dataclass
class VehicleSelection:
    """The vehicles to leave out (``lost``: ids) and to repair (``repaired``: ids by the computed signal).

    ``factor``: by which accelerations along the road of all vehicles are off.
    ``vehicles``: how many there are; ``checks``: those of the part that it is read as, where they were made.
    """

    vehicles: int = 0
    checks: ContradictionChecks | None = None
    lost: list[int] = field(default_factory=list)
    found: list[LeftOut] = field(default_factory=list)
    repaired: dict[SignalName, list[int]] = field(default_factory=dict)
    factor: float | None = None
    repairs: list[str] = field(default_factory=list)

    @property
    def notes(self) -> tuple[str, ...]:
        """Return notes on computed values and on omitted vehicles."""
        return (*self.repairs, *(left_out_note(x.vehicles, self.vehicles, x.reason) for x in self.found))

    def of(self, part: Recording) -> Recording:
        """A recording, or some vehicles of it, without what is left out and with what is computed."""
        made = keep_vehicles(part, ~np.isin(part.vehicle_id, self.lost)) if self.lost else part
        if self.factor is not None:
            made = _without_factor(made, self.factor)
        for signal, ids in self.repaired.items():
            made = _repaired(made, signal, np.isin(made.vehicle_id, ids))
        return made


def stands(checks: ContradictionChecks) -> bool:
    """Return whether nothing has to be left out of a recording with these checks."""
    return checks.off_road() is None and not any(x.refused for x in checks.contradictions())


def selection_of(parts: Callable[[], Iterator[Recording]]) -> VehicleSelection:
    """Return the vehicles to leave out of a recording that comes in ``parts``, the same at each call."""
    chosen = VehicleSelection()
    while True:
        checks: ContradictionChecks | None = None
        count = 0
        for part in map(chosen.of, parts()):
            count += part.vehicles
            checks = checks or ContradictionChecks(part.rate, part.lanes)
            checks.add(part)
        chosen.vehicles, chosen.checks = chosen.vehicles or count, checks
        if checks is None or not count or stands(checks):
            return chosen
        rules = {x.rule: x for x in checks.contradictions() if x.refused}
        rule = next(iter(rules)) if checks.off_road() is None else None
        broken = [int(x) for part in map(chosen.of, parts()) for x in part.vehicle_id[_broken(part, rule)]]
        signal = None if rule is None else _computable_signal(rules[rule])
        factor = None if rule is None else rules[rule].factor
        if signal == "a_lon" and factor is not None and chosen.factor is None:
            _choose_factor(chosen, factor)
            continue
        if signal is not None and signal not in chosen.repaired:
            _choose_repair(chosen, parts, signal, broken)
            continue
        if not broken:
            return chosen  # it is a fault of all together, and the recording is rejected for it
        chosen.found.append(
            LeftOut(ReasonKind.OFF_ROAD() if rule is None else ReasonKind.TOLD(rule), tuple(broken))
        )
        chosen.lost += broken


def _broken(part: Recording, rule: str | None) -> Bools:
    """Return which vehicles of a part break a rule, each looked at alone; None: that each is on the road."""
    if not part.vehicles:
        return np.zeros(0, np.bool_)
    if rule is None:
        nowhere: Bools = np.logical_or.reduceat(part.occupancy != 0, part.start[:-1]) == 0
        return nowhere
    return np.array([_breaks(part, k, rule) for k in range(part.vehicles)], np.bool_)


def _computable_signal(rule: Contradiction) -> SignalName | None:
    """The signal that is computed from others where it breaks a rule; None where there is none."""
    moving = rule.unit == "moving seconds"
    return next((x for x in _REPAIRED if moving and x == rule.signal), None)


def _choose_repair(
    chosen: VehicleSelection, parts: Callable[[], Iterator[Recording]], signal: SignalName, broken: list[int]
) -> None:
    """Choose a signal of some vehicles to be computed.

    Velocities across the road are not computed for vehicles that do not head along it.
    """
    ids = broken
    if signal == "v_lat":
        along = {int(x) for part in map(chosen.of, parts()) for x in part.vehicle_id[_heads_along(part)]}
        ids = [x for x in broken if x in along]
    chosen.repaired[signal] = ids
    of = chosen.vehicles - len(chosen.lost)
    if ids:
        chosen.repairs.append(_REPAIRED[signal].format(f"{len(ids)} of {of} vehicles ({first_names(ids)})"))


def _choose_factor(chosen: VehicleSelection, factor: float) -> None:
    """Choose to undo a factor of the accelerations along the road of all vehicles."""
    chosen.factor = factor
    made = f"divided by {factor:g}" if factor else "computed from the velocities"
    chosen.repairs.append(
        f"accelerations along the road contradict the velocities by a factor of {factor:g} in most of the "
        f"recording; those of all {chosen.vehicles - len(chosen.lost)} vehicles were {made}"
    )


def _without_factor(recording: Recording, factor: float) -> Recording:
    """The recording with accelerations along the road divided by a factor; 0: computed from velocities."""
    if factor:
        return replace(recording, a_lon=recording.a_lon / factor)
    return _repaired(recording, "a_lon", np.ones(recording.vehicles, np.bool_))


def _breaks(recording: Recording, vehicle: int, rule: str) -> bool:
    """Return whether a vehicle alone breaks a rule, above the share that a recording may."""
    for contradiction in contradiction_checks(one_vehicle(recording, vehicle)).contradictions():
        if contradiction.rule == rule:
            share = {"moving seconds": SHARE, "steps": SHARE_OF_JUMPS}.get(contradiction.unit, 0.0)
            return contradiction.refused or contradiction.broken > share * contradiction.asked
    return False


def contradicts_motion(recording: Recording, vehicle: int) -> bool:
    """Return whether the places of a vehicle contradict its velocities, above the share that a recording
    may.
    """
    limits = {"moving seconds": SHARE, "steps": SHARE_OF_JUMPS}
    contradictions = contradiction_checks(one_vehicle(recording, vehicle)).contradictions()
    return any(x.unit in limits and x.broken > limits[x.unit] * x.asked for x in contradictions)


def _repaired(recording: Recording, signal: SignalName, vehicles: Bools) -> Recording:
    """The recording with a signal of some vehicles computed from others."""
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
    return replace(recording, **made)


def _heads_along(recording: Recording) -> Bools:
    """Return which boxes have a heading, and head along the road in all but a share of their samples."""
    if recording.slack is None or not recording.vehicles:
        return np.zeros(recording.vehicles, np.bool_)
    beside = np.add.reduceat(~np.isfinite(recording.slack.along), recording.start[:-1])
    along: Bools = beside <= SHARE * np.diff(recording.start)
    return along


def rate_of_change(values: Floats, rate: Rate) -> Floats:
    """Return the change of values per second, by central differences; zero for a single value."""
    if len(values) < 2:
        return np.zeros(len(values))
    changes: Floats = np.gradient(values) * float(rate)
    return changes
