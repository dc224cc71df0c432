"""The bracket around an extreme: the best value that was reached, and the nearest that were not."""

from fractions import Fraction

from roadproof.analysis.explore.answer import PointFinding
from roadproof.analysis.explore.knobs import between
from roadproof.verdict import Verdict

PATIENCE = 2  # doubts in a row before one is taken for the end


class Bracket:
    """The best value so far, and those that were not found: the nearest sure one, and doubts before it.

    A search that ends in doubt says little of the values beyond: a few of them are tried before the doubt
    is taken for the end.
    """

    def __init__(self, sign: int, precision: Fraction, best: PointFinding, end: Fraction | None) -> None:
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
        return (self.best.at[0] - value) * self.sign

    def reached(self, found: PointFinding, value: Fraction) -> bool:
        return (found.at[0] - value) * self.sign <= 0

    def hold(self, found: PointFinding) -> None:
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
            return end if self.distance(end) > 0 else self.best.at[0] - ahead
        farthest = max([self.best, *self.doubts], key=lambda finding: self.distance(finding.at[0]))
        room = None if self.sure is None else abs(self.sure.at[0] - farthest.at[0])
        if self.doubts and (self.patience <= 0 or (room is not None and room <= self.precision)):
            assert self.missed is not None
            return between(self.best.at[0], self.missed.at[0])
        if self.sure is not None:
            return between(farthest.at[0], self.sure.at[0])
        leap = farthest.at[0] - self.sign * self.leap
        return between(leap, leap - ahead)
