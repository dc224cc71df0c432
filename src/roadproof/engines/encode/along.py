"""Does it matter where along the road a question is asked? Where not, one start stands for all.

A drive moved along the road by some distance has the same speeds, accelerations and places across,
and the same differences of s. So where a formula compares such things only, and no lanelet begins or
ends, the moved drive is a drive of the same question: the first vehicle may start at s = 0.
"""

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from typing import Literal, TypeAlias, assert_never

from roadproof.engines.encode.inequalities import Quantity, inequalities_of, sizes_of
from roadproof.engines.encode.problem import Leaf, nodes
from roadproof.engines.encode.unroll import Grid
from roadproof.logic.formula import Compare, Formula, subformulas
from roadproof.world.polynomial import Polynomial
from roadproof.world.road import Road
from roadproof.world.signals import OwnName, SignalName
from roadproof.world.vehicle import Range, Vehicle

Place: TypeAlias = Literal["s", "d"]
# Places farther from s = 0 are no places to start from: numbers of that size drown those of a drive.
FARTHEST = Fraction(10_000)
# Starts are looked at this far around what is named, or as far as vehicles may be apart, in m.
AROUND = Fraction(1000)


def is_same_everywhere(formula: Formula, road: Road, vehicles: Mapping[str, Vehicle]) -> bool:
    """Whether a drive moved along ``road`` satisfies the bound ``formula`` exactly where it did unmoved."""
    endless = all(bound is None for lanelet in road.lanelets for bound in lanelet.s)
    return endless and not names_places(formula, vehicles)


def names_places(formula: Formula, vehicles: Mapping[str, Vehicle], place: Place = "s") -> bool:
    """Whether a comparison of the bound ``formula`` changes when all vehicles are moved along, or across."""
    return any(slope_along(p, place).terms for p in _polynomials(formula, vehicles))


def slope_along(polynomial: Polynomial[Quantity], place: Place = "s") -> Polynomial[Quantity]:
    """By how much a polynomial grows for each metre that all vehicles are moved along, or across (``d``)."""
    total: Polynomial[Quantity] = Polynomial({})
    for monomial, factor in polynomial.terms.items():
        for k, (_, signal) in enumerate(monomial):
            if _is_moved(signal, place):
                total = total + Polynomial({monomial[:k] + monomial[k + 1 :]: factor})
    return total


def _is_moved(signal: SignalName | OwnName, place: Place) -> bool:
    """Whether a signal grows by a metre for each metre that its vehicle is moved; else it stays.

    An own signal is any function of time, of which a moved drive has the same.
    """
    if isinstance(signal, OwnName):
        return False
    match signal:
        case "s":
            return place == "s"
        case "d":
            return place == "d"
        case "v_lon" | "v_lat" | "a_lon" | "a_lat" | "j_lon":
            return False
        case _:
            assert_never(signal)


def starting_range(
    formulas: Iterable[Formula], road: Road, vehicles: Mapping[str, Vehicle], grid: Grid, reach: Fraction
) -> Range | None:
    """Where fronts may be at time 0 (m along ``road``); None where every start is as good as another.

    From where all that road and formulas name along the road is still ahead throughout the horizon, to
    where it is behind, and a kilometre more on both sides, or ``reach`` where that is more.
    """
    asked = tuple(formulas)
    if all(is_same_everywhere(formula, road, vehicles) for formula in asked):
        return None
    named = [bound for lanelet in road.lanelets for bound in lanelet.s if bound is not None]
    named += [place for formula in asked for place in _places(formula, vehicles)]
    near = [Fraction(0), *(place for place in named if abs(place) <= FARTHEST)]
    driven = max(v.v_lon[1] for v in vehicles.values()) * grid.horizon
    longest = max(v.length for v in vehicles.values())
    around = max(AROUND, reach)
    return min(near) - driven - around, max(near) + longest + around


def _places(formula: Formula, vehicles: Mapping[str, Vehicle]) -> Iterator[Fraction]:
    """Where comparisons that are affine in s and in nothing else of a place change their truth."""
    for polynomial in _polynomials(formula, vehicles):
        slope = slope_along(polynomial)
        if polynomial.degree == 1 and slope.constant:
            yield -polynomial.constant / slope.constant


def _polynomials(formula: Formula, vehicles: Mapping[str, Vehicle]) -> Iterator[Polynomial[Quantity]]:
    sizes = sizes_of(vehicles)
    for part in subformulas(formula):
        if isinstance(part, Compare):
            for node in nodes(inequalities_of(part, sizes)):
                if isinstance(node, Leaf):
                    yield node.content.polynomial
