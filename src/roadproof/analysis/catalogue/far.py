"""How far apart drives begin, and what holds of drives that begin far from others."""

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction

from roadproof.engines.search.variety import CLEARLY
from roadproof.library.compose import both
from roadproof.library.elaborate import read_claim, read_term
from roadproof.library.query import Query
from roadproof.library.specification import Specification
from roadproof.world.units import unit_text

FACTORS = (Fraction(6), Fraction(3), Fraction(3, 2), Fraction(3, 4))
"""How far is tried, from the farthest on."""
MOST_POINTS = 8
"""From so many drives, those that are farthest apart, a search is told to keep away."""


def distance(one: Mapping[str, float], other: Mapping[str, float]) -> float:
    """How far apart two drives begin: 1 for 15 m along, 2.5 m across or 4 m/s in one of the numbers.

    Numbers that only one of them has do not count. Infinite where they have none in common.
    """
    apart = (abs(one[n] - other[n]) / float(_clearly(n)) for n in one if n in other)
    return max(apart, default=float("inf"))


def nearest(begins: Mapping[str, float], points: Iterable[Mapping[str, float]]) -> float:
    """How far a drive begins from the nearest of others."""
    return min((distance(begins, point) for point in points), default=float("inf"))


def far_from(
    points: Sequence[Mapping[str, float]], factor: Fraction, specification: Specification
) -> Query | None:
    """That a drive begins ``factor`` or more from each of the points; None where there are none."""
    parts = [read_claim(specification, _apart(specification, point, factor)) for point in _spread(points)]
    return both(*parts) if parts else None


def _apart(specification: Specification, point: Mapping[str, float], factor: Fraction) -> str:
    """That one of the numbers differs by ``factor`` times what is clearly different, as text."""
    either_side = []
    for name, value in point.items():
        by, unit = factor * _clearly(name), unit_text(read_term(specification, name)[1])
        middle = Fraction(value).limit_denominator(1000)
        either_side.append(f"{name} - ({_number(middle + by)}) * 1 {unit} >= 0 {unit}")
        either_side.append(f"({_number(middle - by)}) * 1 {unit} - ({name}) >= 0 {unit}")
    return " or ".join(either_side)


def _number(value: Fraction) -> str:
    return str(value) if value >= 0 else f"0 - {-value}"


def _spread(points: Sequence[Mapping[str, float]]) -> list[Mapping[str, float]]:
    """At most ``MOST_POINTS`` of the points: the first, and in turn the one that is farthest from these."""
    chosen, left = [*points[:1]], [*points[1:]]
    while left and len(chosen) < MOST_POINTS:
        farthest = max(left, key=lambda point: nearest(point, chosen))
        left.remove(farthest)
        chosen.append(farthest)
    return chosen


def _clearly(name: str) -> Fraction:
    """What is clearly different in a number of a beginning, by its signal: ``s`` of ``s(POV) - s(SV)``."""
    return next(far for signal, far in CLEARLY.items() if name.startswith(f"{signal}("))
