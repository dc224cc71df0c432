"""Traces over points in time on a road of rectangles, which refute claims, as plain data."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Literal

from roadproof.evidence.answers import drive as kept
from roadproof.evidence.codec import read, write
from roadproof.evidence.drive_file import road_of, road_said
from roadproof.evidence.strict import JsonObject
from roadproof.runtime.records import dataclass
from roadproof.world.road import Road
from roadproof.world.signals import FIXED

Held = Literal["before", "after"]
_BETWEEN: Mapping[Held, kept.Between] = {
    "before": "the state of the instant before",
    "after": "the state of the instant after",
}
NOWHERE = Road("no road", (), frozenset())


@dataclass(frozen=True)
class Instant:
    """A state: signals, sizes and variables by name, ``s(SV)``, ``length(SV)``, ``v``, in SI units.

    ``atoms`` tells a reader which predicates are true; nothing rests on it. ``after``: the state from just
    after the instant up to the next, where it is one of its own.
    """

    time: Fraction
    values: Mapping[str, Fraction]
    atoms: Mapping[str, bool]
    after: Mapping[str, Fraction] | None = None


@dataclass(frozen=True)
class Loop:
    """From ``start`` (s) on, each ``period`` seconds are like the ones before."""

    start: Fraction
    period: Fraction

    @property
    def end(self) -> Fraction:
        """When the first round ends."""
        return self.start + self.period


@dataclass(frozen=True)
class Countermodel:
    """A trace on which a claim is false at time 0.

    ``held`` says which of two states fills the time between their instants, where the first has none of its
    own. ``road`` is None where the claim speaks of none; its lanes and lanelets have the names that are free
    in the claim. ``loop``: how the trace repeats itself for ever, where it does.
    """

    instants: tuple[Instant, ...]
    parameters: Mapping[str, Fraction]
    held: Held
    road: Road | None = None
    loop: Loop | None = None


def trace_data(countermodel: Countermodel) -> JsonObject:
    """A countermodel: its road, and what holds at each instant; how it repeats itself, where it does."""
    road, loop = countermodel.road, countermodel.loop
    return write(
        kept.Trace(
            kind="trace",
            between=_BETWEEN[countermodel.held],
            parameters=_sorted(countermodel.parameters),
            road=None if road is None else road_said(road),
            repeats=None if loop is None else kept.Repeats(start=loop.start, period=loop.period),
            instants=tuple(
                kept.Instant(
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
    """The inverse of ``trace_data``. Raises ``InputError``."""
    place = f"{where}, trace"
    said = read(kept.Trace, content, place)
    return Countermodel(
        tuple(Instant(x.time, x.values, dict.fromkeys(x.true, True), x.after) for x in said.instants),
        said.parameters,
        "before" if said.between == "the state of the instant before" else "after",
        None if said.road is None else road_of(said.road, f"{place}, road"),
        None if said.repeats is None else Loop(said.repeats.start, said.repeats.period),
    )


def fault_of_states(countermodel: Countermodel) -> str | None:
    """Why instants, rounds and sizes make no trace, whatever the claim is; None where they make one."""
    times = [instant.time for instant in countermodel.instants]
    if not times or times[0] != 0 or times != sorted(set(times)):
        return f"its instants are {', '.join(map(str, times))}, but must ascend from 0"
    loop = countermodel.loop
    if loop is not None:
        if loop.start not in times or loop.period <= 0 or loop.end <= times[-1]:
            return f"it repeats itself from {loop.start} s each {loop.period} s, which fits no instants of it"
        if countermodel.held != "before":
            return "it repeats itself, so between instants it must keep the state of the one before"
    sizes = [_sizes(values) for instant in countermodel.instants for values in _states(instant)]
    if any(other != sizes[0] for other in sizes) or any(value <= 0 for value in sizes[0].values()):
        return "a length, width or kind changes or is not greater than 0"
    return None


def _states(instant: Instant) -> Sequence[Mapping[str, Fraction]]:
    return (instant.values,) if instant.after is None else (instant.values, instant.after)


def _sizes(values: Mapping[str, Fraction]) -> dict[str, Fraction]:
    return {name: value for name, value in values.items() if name.partition("(")[0] in FIXED}
