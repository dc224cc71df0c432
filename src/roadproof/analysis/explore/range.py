"""Between which values a term can be at the start of a drive, whatever drive it is: interval arithmetic."""

from collections.abc import Mapping
from fractions import Fraction
from itertools import product
from typing import TypeAlias, assert_never

from roadproof.engines.encode.place import span
from roadproof.engines.search.question import SearchProblem
from roadproof.logic import terms as t
from roadproof.logic.terms import Term
from roadproof.world.signals import LIMITED

Range: TypeAlias = tuple[Fraction, Fraction]
Ranges: TypeAlias = Mapping[tuple[str, str], Range]


def starting_ranges(question: SearchProblem) -> dict[tuple[str, str], Range]:
    """What the signals of every vehicle can be at time 0, by vehicle and signal; sizes too.

    Places along the road are told from the front of the first vehicle, so for a term that names places
    (``encode.along``) they are none.
    """
    right, left = span(question.road)
    reach = question.assumptions.reach
    ranges: dict[tuple[str, str], Range] = {}
    for k, (name, vehicle) in enumerate(question.vehicles.items()):
        ranges[name, "s"] = (-reach, reach) if k else (Fraction(0), Fraction(0))
        ranges[name, "d"] = (right + vehicle.width, left)
        for signal in LIMITED:
            ranges[name, signal] = getattr(vehicle, signal)
        ranges[name, "length"] = (vehicle.length, vehicle.length)
        ranges[name, "width"] = (vehicle.width, vehicle.width)
    return ranges


def range_of(term: Term, ranges: Ranges) -> Range:
    """A range that holds every value of ``term``; the narrowest where no signal occurs twice.

    ``term`` has no parameters. Raises ``ValueError`` for 1/x, and for a divisor that is no number.
    """
    match term:
        case t.Number(value, _):
            return value, value
        case t.Signal(name, vehicle) | t.Size(name, vehicle):
            return ranges[vehicle, name]
        case t.Own() as own:
            if own.low is None or own.high is None:
                raise ValueError("no finite value is known")
            return own.low, own.high
        case t.Sum(terms):
            parts = [range_of(x, ranges) for x in terms]
            return sum((low for low, _ in parts), Fraction(0)), sum((high for _, high in parts), Fraction(0))
        case t.Product(factors):
            whole: Range = (Fraction(1), Fraction(1))
            for factor in factors:
                whole = _times(whole, range_of(factor, ranges))
            return whole
        case t.Power(base, exponent):
            return _power(range_of(base, ranges), exponent)
        case t.Quotient(numerator, denominator):
            divisor = t.constant_value(denominator)
            if not divisor:
                raise ValueError("the divisor is no number other than 0")
            return _times(range_of(numerator, ranges), (1 / divisor, 1 / divisor))
        case t.Maximum(terms):
            parts = [range_of(x, ranges) for x in terms]
            return max(low for low, _ in parts), max(high for _, high in parts)
        case t.Minimum(terms):
            parts = [range_of(x, ranges) for x in terms]
            return min(low for low, _ in parts), min(high for _, high in parts)
        case t.Inverse() | t.Parameter() | t.Variable():
            raise ValueError("no finite value is known")
        case _:
            assert_never(term)


def _times(one: Range, other: Range) -> Range:
    ends = [a * b for a, b in product(one, other)]
    return min(ends), max(ends)


def _power(base: Range, exponent: int) -> Range:
    ends = [end**exponent for end in base]
    low = Fraction(0) if exponent and exponent % 2 == 0 and base[0] < 0 < base[1] else min(ends)
    return low, max(ends)
