"""The exact judge: whether a formula holds on a drive, in dense and unbounded time (semantics §1).

Nothing is sampled: each comparison becomes the set of times at which it is true, by the roots of
its polynomials, and every operator is an operation on such sets.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from types import MappingProxyType
from typing import Self, assert_never

from roadproof.errors import InputError, UsageError
from roadproof.logic import formula as f
from roadproof.logic.formula import Application, Formula, Interval, subformulas
from roadproof.logic.rewrite import bounds_of
from roadproof.logic.terms import Own, Signal, Size
from roadproof.semantics.exact.piecewise import Pieces
from roadproof.semantics.exact.polynomial import ZERO
from roadproof.semantics.exact.signals import AbstractSignals, Courses, DriveSignals, Signals, compare_truth
from roadproof.semantics.exact.truth import (
    ALWAYS,
    NEVER,
    TruthSet,
    always,
    complement,
    eventually,
    intersection,
    interval,
    union,
    until,
)
from roadproof.world.drive import Drive

NOTHING_GIVEN: Mapping[Formula, TruthSet] = MappingProxyType({})


@dataclass(frozen=True)
class Judgement:
    """When a formula and each of its sub-formulas is true; ``holds`` is its truth at time 0."""

    formula: Formula
    truths: Mapping[Formula, TruthSet]

    @property
    def holds(self) -> bool:
        return self.truth(self.formula).at(Fraction(0))

    def truth(self, formula: Formula) -> TruthSet:
        """When a sub-formula is true. Raises ``UsageError`` where it is none of the judged ones."""
        if formula not in self.truths:
            raise UsageError("this formula is no judged part of the formula: judge it for itself")
        return self.truths[formula]

    def named(self) -> tuple[tuple[Application, TruthSet], ...]:
        """The judged applications of definitions, outermost first, each once."""
        parts = (x for x in subformulas(self.formula) if isinstance(x, Application) and x in self.truths)
        return tuple((part, self.truths[part]) for part in parts)

    def __str__(self) -> str:
        """One line for each named part: when it is true, in seconds, as decimals with bounds."""
        return "\n".join(f"{x.name}({', '.join(x.arguments)}): {truth}" for x, truth in self.named())


def judge(
    formula: Formula, drive: Drive | Signals | None = None, given: Mapping[Formula, TruthSet] = NOTHING_GIVEN
) -> Judgement:
    """Judge a bound formula (comparisons of signals and sizes only) on ``drive``.

    ``given`` holds truth sets that are taken as they are for the sub-formulas equal to its keys, at
    any depth; then ``drive`` may be None where nothing else is compared. Raises ``InputError`` for a
    formula that is not bound, ``UsageError`` for a vehicle that the drive does not have.
    """
    return DriveJudge.on(drive, given).judgement(formula)


@dataclass(frozen=True)
class Judge:
    """Judges bound formulas on the same vehicles: each part that they share is judged once.

    ``truths``: when each part is true that was judged; ``given``: as of ``judge``.
    """

    courses: Courses
    given: Mapping[Formula, TruthSet]
    truths: dict[Formula, TruthSet] = field(default_factory=dict)

    @classmethod
    def on(cls, drive: Drive | Signals | None, given: Mapping[Formula, TruthSet] = NOTHING_GIVEN) -> Self:
        """The judge of a drive."""
        signals = DriveSignals(drive) if isinstance(drive, Drive) else drive
        return cls(Courses(signals or AbstractSignals({}, {})), given)

    def visit(self, formula: Formula) -> TruthSet:
        """When a formula is true. Raises as ``judge``, where a part is judged that cannot be."""
        if formula not in self.truths:
            known = self.given.get(formula)
            self.truths[formula] = self._visit(formula) if known is None else known
        return self.truths[formula]

    def _visit(self, formula: Formula) -> TruthSet:
        match formula:
            case f.Truth(value):
                return ALWAYS if value else NEVER
            case f.Compare(left, op, right):
                return compare_truth(self.courses, left, op, right)
            case f.Not(body):
                return complement(self.visit(body))
            case f.And(parts):
                return intersection([self.visit(part) for part in parts])
            case f.Or(parts):
                return union([self.visit(part) for part in parts])
            case f.Application(_, _, body):
                return self.visit(body)
            case f.Eventually(interval, body):
                return eventually(*seconds(interval), self.visit(body))
            case f.Always(interval, body):
                return always(*seconds(interval), self.visit(body))
            case f.Until(left, interval, right):
                return until(self.visit(left), *seconds(interval), self.visit(right))
            case f.Occupies() | f.Some() | f.Every():
                raise InputError("a formula over a road's lanes is judged after it is bound to a road")
            case _:
                assert_never(formula)


class DriveJudge(Judge):
    """A judge who judges all parts of each formula."""

    def judgement(self, formula: Formula) -> Judgement:
        """When a formula and each of its parts is true. Raises as ``judge``."""
        self.visit(formula)
        return Judgement(formula, self.truths)

    def holds(self, formula: Formula) -> bool:
        """Whether a formula is true at time 0."""
        return self.visit(formula).at(Fraction(0))


@dataclass(frozen=True)
class LazyJudge(Judge):
    """A judge who comes to the same truth, and judges no part that decides nothing.

    So a part that cannot be judged may raise no error. ``within``: all that matters.
    """

    within: TruthSet = ALWAYS

    def holds(self, formula: Formula) -> bool:
        """Whether a formula is true at time 0."""
        if formula in self.truths or formula in self.given:
            return self.visit(formula).at(Fraction(0))
        match formula:
            case f.Not(body):
                return not self.holds(body)
            case f.And(parts):
                return all(map(self.holds, parts))
            case f.Or(parts):
                return any(map(self.holds, parts))
            case f.Application(_, _, body):
                return self.holds(body)
            case _:
                return self.visit(formula).at(Fraction(0))

    def _visit(self, formula: Formula) -> TruthSet:
        match formula:
            case f.And(parts):
                found = self.within
                for part in parts:
                    if found == NEVER:
                        break
                    found = intersection([found, self.visit(part)])
                return found
            case f.Or(parts):
                found = NEVER
                for part in parts:
                    if found == self.within:
                        break
                    found = union([found, self.visit(part)])
                return found
            case f.Until(left, interval, right):
                end = self.visit(right)
                return until(self.visit(left), *seconds(interval), end) if end != NEVER else NEVER
            case _:
                return Judge._visit(self, formula)


def seconds(interval: Interval) -> tuple[Fraction, Fraction | None]:
    """Both bounds of an interval; None is unbounded. Raises ``InputError`` where they make no sense."""
    try:
        low, high = bounds_of(interval)
    except ValueError as error:
        raise InputError(str(error)) from None
    if low < 0 or (high is not None and high < low):
        raise InputError(f"an interval needs 0 <= low <= high, but low={low}, high={high}")
    return low, high


def truth_within(formula: Formula, signals: Signals, low: Fraction, high: Fraction) -> TruthSet:
    """The part of [low, high] in which a bound formula is true, as ``judge`` says it; exact.

    Raises ``InputError`` for a formula with temporal operators, or one that is not bound.
    """
    courses = Courses(_EndedSignals(signals, high + 1))
    return _RestrictedJudge(courses, NOTHING_GIVEN, within=interval(low, high)).visit(formula)


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
class _RestrictedJudge(LazyJudge):
    """A judge of formulas without temporal operators, who looks at nothing outside of a set."""

    def _visit(self, formula: Formula) -> TruthSet:
        if isinstance(formula, f.Temporal | f.Occupies | f.Some | f.Every):
            raise InputError("only a bound formula without temporal operators is judged within a set")
        found = LazyJudge._visit(self, formula)
        is_inside = isinstance(formula, f.And | f.Or | f.Application)
        return found if is_inside else intersection([self.within, found])
