"""The bracket around an extreme: the best value reached, and the nearest values not reached."""

from collections.abc import Mapping
from fractions import Fraction
from itertools import product
from typing import TypeAlias, assert_never

from roadproof.engines.encode.place import road_edges
from roadproof.engines.search.question import SearchProblem
from roadproof.extensions.surveys.extremes.measure import between
from roadproof.extensions.surveys.extremes.points import PointFinding
from roadproof.logic import terms as t
from roadproof.logic.terms import Term
from roadproof.verdict import Verdict
from roadproof.world.signals import LIMITED

PATIENCE = 2  # doubts in a row before one is taken for the end


class Bracket:
    """The best value so far, the nearest ``excluded`` one, and ``undecided`` ones between.

    An undecided search says little about values beyond. So a few of them are tried before an undecided value
    ends the bracket.
    """

    def __init__(self, sign: int, precision: Fraction, best: Fraction, end: Fraction | None) -> None:
        self.sign = sign
        self.precision = precision
        self.best = best
        self.excluded: PointFinding | None = None
        self.undecided: list[PointFinding] = []
        self.end = end
        self.leap = max(precision, Fraction(1))
        self.patience = PATIENCE

    @property
    def outside(self) -> PointFinding | None:
        """The nearest value that was not reached."""
        known = [*self.undecided, *([self.excluded] if self.excluded is not None else [])]
        return min(known, key=lambda finding: self.distance(finding.at[0]), default=None)

    @property
    def narrow(self) -> bool:
        return self.outside is not None and self.distance(self.outside.at[0]) <= self.precision

    def distance(self, value: Fraction) -> Fraction:
        """Return how far ``value`` is beyond the best one."""
        return (self.best - value) * self.sign

    def reached(self, reached: Fraction, value: Fraction) -> bool:
        """Return whether a reached value is as good as the one asked for."""
        return (reached - value) * self.sign <= 0

    def hold(self, value: Fraction) -> None:
        self.best = value
        self.leap *= 2
        self.patience = PATIENCE
        self.undecided = [x for x in self.undecided if self.distance(x.at[0]) > 0]
        if self.excluded is not None and self.distance(self.excluded.at[0]) <= 0:
            self.excluded = None  # there was none on that grid, but there is one on a finer one

    def miss(self, finding: PointFinding) -> None:
        if finding.verdict is Verdict.UNKNOWN or self.undecided:
            self.patience -= 1
        if finding.verdict is Verdict.UNKNOWN:
            self.undecided.append(finding)
        elif self.excluded is None or self.distance(finding.at[0]) < self.distance(self.excluded.at[0]):
            self.excluded = finding
            self.undecided = [
                x for x in self.undecided if self.distance(x.at[0]) < self.distance(finding.at[0])
            ]

    def next(self) -> Fraction:
        """Return the next value to ask for."""
        ahead = self.sign * self.precision
        if self.end is not None and self.excluded is None:
            end, self.end = self.end, None
            return end if self.distance(end) > 0 else self.best - ahead
        farthest = max([self.best, *(x.at[0] for x in self.undecided)], key=self.distance)
        room = None if self.excluded is None else abs(self.excluded.at[0] - farthest)
        if self.undecided and (self.patience <= 0 or (room is not None and room <= self.precision)):
            assert self.outside is not None
            return between(self.best, self.outside.at[0])
        if self.excluded is not None:
            return between(farthest, self.excluded.at[0])
        leap = farthest - self.sign * self.leap
        return between(leap, leap - ahead)


# --- ends of a range -------------------------------------------------------------------------------

Range: TypeAlias = tuple[Fraction, Fraction]
Ranges: TypeAlias = Mapping[tuple[str, str], Range]


def starting_ranges(question: SearchProblem) -> dict[tuple[str, str], Range]:
    """Return the ranges of signals and sizes at time 0, by vehicle and signal.

    Positions along the road are relative to the front of the first vehicle. So these ranges do not apply to a
    term that names places (``encode.shift_invariance``).
    """
    right, left = road_edges(question.road)
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
    """Return a range that contains every value of ``term``; the narrowest if no signal occurs twice.

    ``term`` has no parameters. Raises ``ValueError`` for 1/x, and for a divisor that is no number.
    """
    match term:
        case t.Number(value, _):
            return value, value
        case t.Signal(name, vehicle) | t.Size(name, vehicle):
            return ranges[vehicle, name]
        case t.CustomSignal() as own:
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
