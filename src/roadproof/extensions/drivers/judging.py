"""The exact judge on a stretch of time, for formulas without temporal operators."""

from dataclasses import dataclass
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.terms import CustomSignal, Signal, Size
from roadproof.semantics.exact.judging import NOTHING_GIVEN, LazyJudge
from roadproof.semantics.exact.piecewise import Pieces
from roadproof.semantics.exact.polynomial import ZERO
from roadproof.semantics.exact.signals import Signals, TermPieces
from roadproof.semantics.exact.truth import TruthSet, intersection, interval


def truth_within(formula: Formula, signals: Signals, low: Fraction, high: Fraction) -> TruthSet:
    """Return the exact part of [low, high] in which a bound formula is true.

    Raises ``InputError`` for a formula with temporal operators, or one that is not bound.
    """
    courses = TermPieces(_EndedSignals(signals, high + 1))
    return _RestrictedJudge(courses, NOTHING_GIVEN, within=interval(low, high)).visit(formula)


@dataclass(frozen=True)
class _EndedSignals:
    """Signals that are 0 from ``end`` on, which is after all times in question."""

    signals: Signals
    end: Fraction

    def signal(self, signal: Signal | CustomSignal) -> Pieces:
        return (*(x for x in self.signals.signal(signal) if x[0] < self.end), (self.end, ZERO))

    def size(self, size: Size) -> Fraction:
        return self.signals.size(size)


@dataclass(frozen=True)
class _RestrictedJudge(LazyJudge):
    """A judge of formulas without temporal operators, restricted to a set of times."""

    def _visit(self, formula: Formula) -> TruthSet:
        if isinstance(formula, f.Temporal | f.Occupies | f.Some | f.Every):
            raise InputError("only a bound formula without temporal operators is judged within a set")
        truth = LazyJudge._visit(self, formula)
        is_inside = isinstance(formula, f.And | f.Or | f.Application)
        return truth if is_inside else intersection([self.within, truth])
