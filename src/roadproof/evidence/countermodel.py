"""Traces over points in time, on a road of rectangles, that refute claims; and their JSON."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Literal

from roadproof.evidence.answers import drive as json_types
from roadproof.evidence.codec import read, write
from roadproof.evidence.drive_file import road_data, road_of
from roadproof.evidence.strict import JsonObject
from roadproof.runtime.records import dataclass
from roadproof.world.road import Road
from roadproof.world.signals import FIXED

Interpolation = Literal["before", "after"]
_BETWEEN: Mapping[Interpolation, json_types.Between] = {
    "before": "the state of the instant before",
    "after": "the state of the instant after",
}
NOWHERE = Road("no road", (), frozenset())


@dataclass(frozen=True)
class Instant:
    """A state at a time (s): signals, sizes and variables, ``s(SV)``, ``length(SV)``, ``v``, in SI units.

    ``atoms`` tells a reader which predicates are true; no check uses it. ``after``: the state between this
    instant and the next, if it differs from ``values``.
    """

    time: Fraction
    values: Mapping[str, Fraction]
    atoms: Mapping[str, bool]
    after: Mapping[str, Fraction] | None = None


@dataclass(frozen=True)
class Loop:
    """The repetition of a trace: from ``start`` (s) on, every ``period`` seconds equal the ones before."""

    start: Fraction
    period: Fraction

    @property
    def end(self) -> Fraction:
        """The time at which the first round ends (s)."""
        return self.start + self.period


@dataclass(frozen=True)
class Countermodel:
    """A trace on which a claim is false at time 0.

    ``interpolation``: whether the state ``before`` or ``after`` fills the time between two instants, unless
    the first has a state ``after`` of its own. ``road``: None if the claim mentions none; its lanes and
    lanelets have the names that are free in the claim. ``loop``: how the trace repeats for ever, if it does.
    """

    instants: tuple[Instant, ...]
    parameters: Mapping[str, Fraction]
    interpolation: Interpolation
    road: Road | None = None
    loop: Loop | None = None


def trace_data(countermodel: Countermodel) -> JsonObject:
    """Return the JSON of a countermodel."""
    road, loop = countermodel.road, countermodel.loop
    return write(
        json_types.RefutingTraceData(
            kind="trace",
            between=_BETWEEN[countermodel.interpolation],
            parameters=_sorted(countermodel.parameters),
            road=None if road is None else road_data(road),
            repeats=None if loop is None else json_types.RepeatsData(start=loop.start, period=loop.period),
            instants=tuple(
                json_types.InstantData(
                    time=x.time,
                    true=tuple(sorted(name for name, true in x.atoms.items() if true)),
                    values=_sorted(x.values),
                    after=None if x.after is None else _sorted(x.after),
                )
                for x in countermodel.instants
            ),
        )
    )


def _sorted(values: Mapping[str, Fraction]) -> dict[str, Fraction]:
    return dict(sorted(values.items()))


def read_trace(content: object, where: str) -> Countermodel:
    """Return the countermodel in parsed JSON, the inverse of ``trace_data``. Raises ``InputError``."""
    place = f"{where}, trace"
    stored = read(json_types.RefutingTraceData, content, place)
    return Countermodel(
        tuple(Instant(x.time, x.values, dict.fromkeys(x.true, True), x.after) for x in stored.instants),
        stored.parameters,
        "before" if stored.between == "the state of the instant before" else "after",
        None if stored.road is None else road_of(stored.road, f"{place}, road"),
        None if stored.repeats is None else Loop(stored.repeats.start, stored.repeats.period),
    )


def fault_of_states(countermodel: Countermodel) -> str | None:
    """Return why instants, loop and sizes form no trace, whatever the claim; None if they do."""
    times = [instant.time for instant in countermodel.instants]
    if not times or times[0] != 0 or times != sorted(set(times)):
        return f"its instants are {', '.join(map(str, times))}, but must ascend from 0"
    loop = countermodel.loop
    if loop is not None:
        if loop.start not in times or loop.period <= 0 or loop.end <= times[-1]:
            return f"it repeats itself from {loop.start} s each {loop.period} s, which fits no instants of it"
        if countermodel.interpolation != "before":
            return "it repeats itself, so between instants it must keep the state of the one before"
    sizes = [_sizes(values) for instant in countermodel.instants for values in _states(instant)]
    if any(other != sizes[0] for other in sizes) or any(value <= 0 for value in sizes[0].values()):
        return "a length, width or kind changes or is not greater than 0"
    return None


def _states(instant: Instant) -> Sequence[Mapping[str, Fraction]]:
    return (instant.values,) if instant.after is None else (instant.values, instant.after)


def _sizes(values: Mapping[str, Fraction]) -> dict[str, Fraction]:
    return {name: value for name, value in values.items() if name.partition("(")[0] in FIXED}
