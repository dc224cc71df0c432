"""The bracket around an extreme: the best value that was reached, and the nearest that were not."""

from collections.abc import Mapping
from fractions import Fraction
from itertools import product
from typing import TypeAlias, assert_never

from roadproof.engines.encode.place import span
from roadproof.engines.search.question import SearchProblem
from roadproof.extensions.surveys.extremes.measure import between
from roadproof.extensions.surveys.extremes.points import PointFinding
from roadproof.logic import terms as t
from roadproof.logic.terms import Term
from roadproof.verdict import Verdict
from roadproof.world.signals import LIMITED

PATIENCE = 2  # doubts in a row before one is taken for the end


class Bracket:
    """The best value so far, and those that were not found: the nearest sure one, and doubts before it.

    A search that ends in doubt says little of the values beyond: a few of them are tried before the doubt
    is taken for the end.
    """

    def __init__(self, sign: int, precision: Fraction, best: Fraction, end: Fraction | None) -> None:
        self.sign = sign
        self.precision = precision
        self.best = best
        self.sure: PointFinding | None = None
        self.doubts: list[PointFinding] = []
        self.end = end
        self.leap = max(precision, Fraction(1))
        self.patience = PATIENCE

    @property
    def missed(self) -> PointFinding | None:
        """The nearest value that was not found."""
        known = [*self.doubts, *([self.sure] if self.sure is not None else [])]
        return min(known, key=lambda finding: self.distance(finding.at[0]), default=None)

    @property
    def narrow(self) -> bool:
        return self.missed is not None and self.distance(self.missed.at[0]) <= self.precision

    def distance(self, value: Fraction) -> Fraction:
        """How far ``value`` is beyond the best one."""
        return (self.best - value) * self.sign

    def reached(self, found: Fraction, value: Fraction) -> bool:
        """Return whether a value that was found is as good as the one that was asked for."""
        return (found - value) * self.sign <= 0

    def hold(self, found: Fraction) -> None:
        self.best = found
        self.leap *= 2
        self.patience = PATIENCE
        self.doubts = [x for x in self.doubts if self.distance(x.at[0]) > 0]
        if self.sure is not None and self.distance(self.sure.at[0]) <= 0:
            self.sure = None  # there was none on that grid, but there is one on a finer one

    def miss(self, missed: PointFinding) -> None:
        if missed.verdict is Verdict.UNKNOWN or self.doubts:
            self.patience -= 1
        if missed.verdict is Verdict.UNKNOWN:
            self.doubts.append(missed)
        elif self.sure is None or self.distance(missed.at[0]) < self.distance(self.sure.at[0]):
            self.sure = missed
            self.doubts = [x for x in self.doubts if self.distance(x.at[0]) < self.distance(missed.at[0])]

    def next(self) -> Fraction:
        """The next value to ask for."""
        ahead = self.sign * self.precision
        if self.end is not None and self.sure is None:
            end, self.end = self.end, None
            return end if self.distance(end) > 0 else self.best - ahead
        farthest = max([self.best, *(x.at[0] for x in self.doubts)], key=self.distance)
        room = None if self.sure is None else abs(self.sure.at[0] - farthest)
        if self.doubts and (self.patience <= 0 or (room is not None and room <= self.precision)):
            assert self.missed is not None
            return between(self.best, self.missed.at[0])
        if self.sure is not None:
            return between(farthest, self.sure.at[0])
        leap = farthest - self.sign * self.leap
        return between(leap, leap - ahead)


# --- ends of a range -------------------------------------------------------------------------------

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
