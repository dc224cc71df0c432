"""A drive or a trace as a term of proofs/kernel/Drive.v. Trusted: it is part of the theorem."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeAlias

from roadproof.evidence.countermodel import Loop
from roadproof.extensions.kernel.derivation import rational
from roadproof.extensions.kernel.names import literal, quoted
from roadproof.logic import terms as t
from roadproof.world.drive import Motion
from roadproof.world.road import Lanelet, Road
from roadproof.world.signals import SIGNALS, SignalName
from roadproof.world.units import UNITS

# Times in their order, each with the value at it and the value after it, before the next.
Steps: TypeAlias = tuple[tuple[Fraction, Fraction, Fraction], ...]
# By how often the place is differentiated.
_WORDS = ("Place", "Speed", "Acceleration", "Jerk")
WORDS_OF_SIGNALS: Mapping[SignalName, str] = {
    name: f"{_WORDS[-UNITS[about.unit][1][1]]}_{'lon' if about.where.startswith('along') else 'lat'}"
    for name, about in SIGNALS.items()
}
"""What Meaning.v calls each signal."""


ANYWHERE = Road(
    "any",
    (Lanelet("any", "any", "main", "main", (None, None), (Fraction(0), Fraction(1))),),
    frozenset(),
)
"""Every road has a lanelet; a claim that is made of none may be about any road."""


def road_with_lanelets(road: Road | None) -> Road:
    """Return the road, or a road of one lanelet if it has none."""
    return road if road is not None and road.lanelets else ANYWHERE


@dataclass(frozen=True)
class AxisTrajectory:
    """A motion along one axis (``course`` of Drive.v): ``pieces`` have duration, acceleration and jerk.

    ``last`` is the acceleration after them, for ever.
    """

    place: Fraction
    speed: Fraction
    pieces: tuple[tuple[Fraction, Fraction, Fraction], ...]
    last: Fraction


@dataclass(frozen=True)
class World:
    """Vehicles on a road with lanelets, and signals in steps; all other signals are those of the motions.

    ``lanes``: the lane of the road for each lane name of the claim. ``values``: of parameters. ``numbers``:
    of variables. ``repeats``: the loop of the signals, if they repeat.
    """

    vehicles: Mapping[str, Motion]
    road: Road
    lanes: Mapping[str, str]
    values: Mapping[str, Fraction]
    steps: Mapping[t.Varying, Steps]
    numbers: Mapping[str, Fraction] = field(default_factory=dict)
    repeats: Loop | None = None


def world_lines(world: World) -> Iterator[str]:
    """Yield the lines of a world. Raises ``InputError`` for names that cannot be printed."""
    yield "{|"
    yield from _field("bodies", [_body(name, motion) for name, motion in world.vehicles.items()])
    first, *others = map(_rectangle, world.road.lanelets)
    yield f"  first_rectangle := {first};"
    yield from _field("other_rectangles", others)
    yield from _field("beside", [_pair(quoted(a), quoted(b)) for a, b in adjacent_pairs(world.road)])
    yield from _field("lanes_named", [_pair(literal(a), quoted(b)) for a, b in sorted(world.lanes.items())])
    yield from _field("values", _numbers(world.values))
    yield from _field("signals", [_signal(*x) for x in world.steps.items()])
    yield from _field("numbers", _numbers(world.numbers))
    yield f"  repeats := {_repetition(world.repeats)}"
    yield "|}"


def _repetition(loop: Loop | None) -> str:
    return "None" if loop is None else f"Some {_pair(rational(loop.start), rational(loop.period))}"


def _numbers(values: Mapping[str, Fraction]) -> list[str]:
    return [_pair(literal(name), rational(x)) for name, x in sorted(values.items())]


def _field(name: str, items: Sequence[str]) -> Iterator[str]:
    if not items:
        yield f"  {name} := [];"
        return
    yield f"  {name} := ["
    for place, item in enumerate(items):
        yield f"    {item}{';' if place + 1 < len(items) else ''}"
    yield "  ];"


def _pair(one: str, other: str) -> str:
    return f"({one}, {other})"


def adjacent_pairs(road: Road) -> list[tuple[str, str]]:
    """Return the pairs of adjacent lanes, sorted."""
    ordered = sorted(tuple(sorted(pair)) for pair in road.adjacent)
    return [(a, b) for a, b in ordered]


def _rectangle(x: Lanelet) -> str:
    low, high = ("None" if y is None else f"Some {rational(y)}" for y in x.s)
    return (
        f"{{| lane := {quoted(x.lane)}; lies_in := {x.zone}; from_s := {low}; to_s := {high}; "
        f"right_d := {rational(x.d[0])}; left_d := {rational(x.d[1])} |}}"
    )


def _signal(signal: t.Varying, steps: Steps) -> str:
    word = (
        f"Own {literal(signal.name)}" if isinstance(signal, t.CustomSignal) else WORDS_OF_SIGNALS[signal.name]
    )
    shown = "; ".join(f"({', '.join(map(rational, step))})" for step in steps)
    return f"({word}, {quoted(signal.vehicle)}, [{shown}])"


def _body(name: str, motion: Motion) -> str:
    along, across = map(_course, axis_trajectories(motion))
    return (
        f"({literal(name)}, {{| is_a := {motion.kind or 'other'};\n"
        f"      long := {rational(motion.length)}; wide := {rational(motion.width)};\n"
        f"      long_above_0 := eq_refl; wide_above_0 := eq_refl;\n"
        f"      along := {along};\n      across := {across} |}})"
    )


def _course(course: AxisTrajectory) -> str:
    shown = [f"({', '.join(map(rational, piece))})" for piece in course.pieces]
    return (
        f"{{| starts_at := {rational(course.place)}; starts_with := {rational(course.speed)};\n"
        f"        pieces := [{'; '.join(shown)}]; finally := {rational(course.last)} |}}"
    )


def axis_trajectories(motion: Motion) -> tuple[AxisTrajectory, AxisTrajectory]:
    """Return the motion of a vehicle along the road, and across it."""
    *before, last = motion.pieces
    timed = [(x.duration, x) for x in before if x.duration is not None]
    along = tuple((time, x.a_lon, x.j_lon) for time, x in timed)
    across = tuple((time, x.a_lat, Fraction(0)) for time, x in timed)
    return (
        AxisTrajectory(motion.s, motion.v_lon, along, last.a_lon),
        AxisTrajectory(motion.d, motion.v_lat, across, last.a_lat),
    )
