"""Tests whether a question depends on the place along the road; if not, one start at s = 0 stands for all.

A drive moved along the road by some distance has the same speeds, accelerations and lateral positions,
and the same differences of s. So where a formula compares only these, and no lanelet begins or ends,
the moved drive answers the question, too: the first vehicle may start at s = 0 without loss.
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
from roadproof.world.signals import CustomSignalName, SignalName
from roadproof.world.vehicle import Range, Vehicle

Place: TypeAlias = Literal["s", "d"]
# Places farther from s = 0 are no places to start from: numbers of that size drown those of a drive.
FARTHEST = Fraction(10_000)
# Starts are looked at this far around what is named, or as far as vehicles may be apart, in m.
SEARCHED_AROUND = Fraction(1000)


def is_shift_invariant(formula: Formula, road: Road, vehicles: Mapping[str, Vehicle]) -> bool:
    """Return whether moving a drive along ``road`` never changes the truth of the bound ``formula``."""
    endless = all(bound is None for lanelet in road.lanelets for bound in lanelet.s)
    return endless and not depends_on_place(formula, vehicles)


def depends_on_place(formula: Formula, vehicles: Mapping[str, Vehicle], place: Place = "s") -> bool:
    """Return whether some comparison changes when all vehicles move along the road (``d``: across it)."""
    return any(growth_along(p, place).terms for p in _polynomials(formula, vehicles))


def growth_along(polynomial: Polynomial[Quantity], place: Place = "s") -> Polynomial[Quantity]:
    """Return the growth of a polynomial per metre that all vehicles move along (``d``: across) the road."""
    total: Polynomial[Quantity] = Polynomial({})
    for monomial, factor in polynomial.terms.items():
        for k, (_, signal) in enumerate(monomial):
            if _is_moved(signal, place):
                total = total + Polynomial({monomial[:k] + monomial[k + 1 :]: factor})
    return total


def _is_moved(signal: SignalName | CustomSignalName, place: Place) -> bool:
    """Return whether a signal grows by a metre for each metre that its vehicle is moved; else it stays.

    A custom signal is an arbitrary function of time, so a moved drive has the same one.
    """
    if isinstance(signal, CustomSignalName):
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
    """Return the range (m) of fronts at time 0, or None where s = 0 stands for every start.

    Places are s = 0, ends of lanelets, and values of s at which affine comparisons change, all within 10 km.
    The range begins a drive at top speed before the first place, and ends a vehicle length after the last. On
    both sides it is wider by a kilometre, or by ``reach`` (largest distance between two starts) if greater.
    """
    bound_formulas = tuple(formulas)
    if all(is_shift_invariant(formula, road, vehicles) for formula in bound_formulas):
        return None
    named = [bound for lanelet in road.lanelets for bound in lanelet.s if bound is not None]
    named += [place for formula in bound_formulas for place in _places(formula, vehicles)]
    near = [Fraction(0), *(place for place in named if abs(place) <= FARTHEST)]
    driven = max(v.v_lon[1] for v in vehicles.values()) * grid.horizon
    longest = max(v.length for v in vehicles.values())
    around = max(SEARCHED_AROUND, reach)
    return min(near) - driven - around, max(near) + longest + around


def _places(formula: Formula, vehicles: Mapping[str, Vehicle]) -> Iterator[Fraction]:
    """Yield the values of s at which comparisons that are affine in s alone change their truth."""
    for polynomial in _polynomials(formula, vehicles):
        slope = growth_along(polynomial)
        if polynomial.degree == 1 and slope.constant:
            yield -polynomial.constant / slope.constant


def _polynomials(formula: Formula, vehicles: Mapping[str, Vehicle]) -> Iterator[Polynomial[Quantity]]:
    sizes = sizes_of(vehicles)
    for part in subformulas(formula):
        if isinstance(part, Compare):
            for node in nodes(inequalities_of(part, sizes)):
                if isinstance(node, Leaf):
                    yield node.content.polynomial
