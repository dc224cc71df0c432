"""Where in an interval a formula without temporal operators is true; only what matters there is looked at.

Such formulas are cases: where the condition of a case is false, the case need not be judged. Nor do roots
matter that lie behind the interval.
"""

from dataclasses import dataclass, field
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.terms import Own, Signal, Size
from roadproof.semantics.exact.comparison import compare_truth
from roadproof.semantics.exact.piecewise import Pieces
from roadproof.semantics.exact.polynomial import ZERO
from roadproof.semantics.exact.signals import Courses, Signals
from roadproof.semantics.exact.truth import NEVER, TruthSet, complement, intersection, interval, union


def truth_within(formula: Formula, signals: Signals, low: Fraction, high: Fraction) -> TruthSet:
    """The part of [low, high] in which a bound formula is true, as ``judge`` says it; exact.

    Raises ``InputError`` for a formula with temporal operators, or one that is not bound.
    """
    return _RestrictedTruth(Courses(_EndedSignals(signals, high + 1)), interval(low, high)).visit(formula)


@dataclass(frozen=True)
class _EndedSignals:
    """Signals that are 0 from ``end`` on, which is behind all that is asked about."""

    signals: Signals
    end: Fraction

    def signal(self, signal: Signal | Own) -> Pieces:
        return (*(x for x in self.signals.signal(signal) if x[0] < self.end), (self.end, ZERO))

    def size(self, size: Size) -> Fraction:
        return self.signals.size(size)


@dataclass(frozen=True)
class _RestrictedTruth:
    courses: Courses
    within: TruthSet
    truths: dict[Formula, TruthSet] = field(default_factory=dict)

    def visit(self, formula: Formula) -> TruthSet:
        found = self.truths.get(formula)
        if found is None:
            found = self.truths[formula] = self._visit(formula)
        return found

    def _visit(self, formula: Formula) -> TruthSet:
        match formula:
            case f.Truth(value):
                return self.within if value else NEVER
            case f.Compare(left, op, right):
                return intersection([self.within, compare_truth(self.courses, left, op, right)])
            case f.Not(body):
                return intersection([self.within, complement(self.visit(body))])
            case f.And(parts):
                kept = self.within
                for part in parts:
                    if kept == NEVER:
                        break
                    kept = intersection([kept, self.visit(part)])
                return kept
            case f.Or(parts):
                found = NEVER
                for part in parts:
                    if found == self.within:
                        break
                    found = union([found, self.visit(part)])
                return found
            case f.Application(_, _, body):
                return self.visit(body)
            case _:
                raise InputError("only a bound formula without temporal operators is judged within a set")
