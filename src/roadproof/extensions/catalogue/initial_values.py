"""Initial values of drives by term, such as ``s(POV) - s(SV)``, and how far apart two drives begin."""

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from functools import cache
from typing import TypeAlias

from roadproof.engines.search.initial_conditions import CLEARLY
from roadproof.evidence.drive_file import DriveFile
from roadproof.library.compose import both
from roadproof.library.elaborate import read_claim, read_term
from roadproof.library.scenarios import SUBJECT
from roadproof.library.specification import Query, Specification
from roadproof.logic import syntax
from roadproof.logic.parse import parse_claim
from roadproof.world.signals import SignalName
from roadproof.world.units import unit_text

InitialValues: TypeAlias = Mapping[str, float]
"""Values at the start by term (m, m/s)."""
STATE: tuple[SignalName, ...] = ("s", "d", "v_lon")
"""The signals of which the initial values of a vehicle are made, in this order."""


def initial_values(file: DriveFile) -> dict[str, float]:
    """Return the initial values of a drive."""
    states = {name: (m.s, m.d, m.v_lon) for name, m in file.drive.vehicles.items()}
    return relative_values({name: tuple(map(float, state)) for name, state in states.items()})


def relative_values(states: Mapping[str, tuple[float, ...]]) -> dict[str, float]:
    """Return speeds (m/s), and how far each vehicle is ahead of and left of SV, or of the first one (m).

    ``states``: the values of ``STATE`` by vehicle.
    """
    first = SUBJECT if SUBJECT in states else next(iter(states))
    s, d, v_lon = states[first]
    values = {f"v_lon({first})": v_lon}
    for name, (other_s, other_d, speed) in sorted(states.items()):
        if name == first:
            continue
        values |= {
            f"v_lon({name})": speed,
            f"s({name}) - s({first})": other_s - s,
            f"d({name}) - d({first})": other_d - d,
        }
    return values


@cache
def signal_of(term: str) -> SignalName:
    """Return the signal of a term of ``initial_values``: ``s`` of ``s(POV) - s(SV)``."""
    called = {x.name for x in syntax.walk(parse_claim(term).body) if isinstance(x, syntax.Call)}
    return next(x for x in STATE if x in called)


# --- how far apart drives begin --------------------------------------------------------------------

FACTORS = (Fraction(6), Fraction(3), Fraction(3, 2), Fraction(3, 4))
"""The distances that are tried, from the farthest on."""
MOST_POINTS = 8
"""The number of drives, those that are farthest apart, from which a search keeps away."""


def distance(one: InitialValues, other: InitialValues) -> float:
    """Return how far apart two drives begin: 1 for 15 m along, 2.5 m across or 4 m/s in one of the values.

    Values that only one of them has do not count. Infinite where they have none in common.
    """
    apart = (abs(one[n] - other[n]) / float(_clear_difference(n)) for n in one if n in other)
    return max(apart, default=float("inf"))


def distance_to_nearest(values: InitialValues, points: Iterable[InitialValues]) -> float:
    """Return how far a drive begins from the nearest of others."""
    return min((distance(values, point) for point in points), default=float("inf"))


def far_from(points: Sequence[InitialValues], factor: Fraction, specification: Specification) -> Query | None:
    """Return the formula of a drive that begins ``factor`` or more from each point; None without points."""
    parts = [read_claim(specification, _apart(specification, point, factor)) for point in _spread(points)]
    return both(*parts) if parts else None


def _apart(specification: Specification, point: InitialValues, factor: Fraction) -> str:
    """Return the text that one value differs from the point by ``factor`` times a clear difference."""
    either_side = []
    for name, value in point.items():
        by, unit = factor * _clear_difference(name), unit_text(read_term(specification, name)[1])
        middle = Fraction(value).limit_denominator(1000)
        either_side.append(f"{name} - ({_number(middle + by)}) * 1 {unit} >= 0 {unit}")
        either_side.append(f"({_number(middle - by)}) * 1 {unit} - ({name}) >= 0 {unit}")
    return " or ".join(either_side)


def _number(value: Fraction) -> str:
    return str(value) if value >= 0 else f"0 - {-value}"


def _spread(points: Sequence[InitialValues]) -> list[InitialValues]:
    """Return at most ``MOST_POINTS`` points: the first, and in turn the one that is farthest from these."""
    chosen, left = [*points[:1]], [*points[1:]]
    while left and len(chosen) < MOST_POINTS:
        farthest = max(left, key=lambda point: distance_to_nearest(point, chosen))
        left.remove(farthest)
        chosen.append(farthest)
    return chosen


def _clear_difference(name: str) -> Fraction:
    """Return the least clear difference of an initial value."""
    return CLEARLY[signal_of(name)]
