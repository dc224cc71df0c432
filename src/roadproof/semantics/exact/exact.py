"""The exact judge: whether a formula holds on a drive, in dense and unbounded time (semantics §1).

Nothing is sampled: each comparison becomes the set of times at which it is true, by the roots of
its polynomials, and every operator is an operation on such sets.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from types import MappingProxyType
from typing import assert_never

from roadproof.errors import InputError, UsageError
from roadproof.logic import formula as f
from roadproof.logic.formula import Application, Formula, Interval, subformulas
from roadproof.logic.rewrite import bounds_of
from roadproof.semantics.exact.comparison import compare_truth
from roadproof.semantics.exact.signals import AbstractSignals, Courses, DriveSignals, Signals
from roadproof.semantics.exact.truth import (
    ALWAYS,
    NEVER,
    TruthSet,
    always,
    complement,
    eventually,
    intersection,
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
    formula: Formula,
    drive: Drive | Signals | None = None,
    given: Mapping[Formula, TruthSet] = NOTHING_GIVEN,
) -> Judgement:
    """Judge a bound formula (comparisons of signals and sizes only) on ``drive``.

    ``given`` holds truth sets that are taken as they are for the sub-formulas equal to its keys, at
    any depth; then ``drive`` may be None where nothing else is compared. Raises ``InputError`` for a
    formula that is not bound, ``UsageError`` for a vehicle that the drive does not have.
    """
    signals = DriveSignals(drive) if isinstance(drive, Drive) else drive
    judging = _Judge(Courses(signals or AbstractSignals({}, {})), given)
    judging.visit(formula)
    return Judgement(formula, judging.truths)


@dataclass(frozen=True)
class _Judge:
    courses: Courses
    given: Mapping[Formula, TruthSet]
    truths: dict[Formula, TruthSet] = field(default_factory=dict)

    def visit(self, formula: Formula) -> TruthSet:
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


def seconds(interval: Interval) -> tuple[Fraction, Fraction | None]:
    """Both bounds of an interval; None is unbounded. Raises ``InputError`` where they make no sense."""
    try:
        low, high = bounds_of(interval)
    except ValueError as error:
        raise InputError(str(error)) from None
    if low < 0 or (high is not None and high < low):
        raise InputError(f"an interval needs 0 <= low <= high, but low={low}, high={high}")
    return low, high
