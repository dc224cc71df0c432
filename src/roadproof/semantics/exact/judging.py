"""The exact judge: whether a formula holds on a drive, in dense and unbounded time (semantics §1).

Nothing is sampled: each comparison becomes the set of times at which it is true, by the roots of its
polynomials, and every operator is an operation on such sets.
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
from roadproof.semantics.exact.signals import (
    AbstractSignals,
    DriveSignals,
    Signals,
    TermPieces,
    compare_truth,
)
from roadproof.semantics.exact.truth import (
    ALWAYS,
    NEVER,
    TruthSet,
    always,
    complement,
    eventually,
    intersection,
    since,
    union,
    until,
)
from roadproof.world.drive import Drive

NOTHING_GIVEN: Mapping[Formula, TruthSet] = MappingProxyType({})


@dataclass(frozen=True)
class Judgement:
    """The truth sets of a formula and of its sub-formulas; ``holds`` is its truth at time 0."""

    formula: Formula
    truths: Mapping[Formula, TruthSet]

    @property
    def holds(self) -> bool:
        return self.truth(self.formula).at(Fraction(0))

    def truth(self, formula: Formula) -> TruthSet:
        """Return the truth set of a sub-formula. Raises ``UsageError`` for any other formula."""
        if formula not in self.truths:
            raise UsageError("this formula is no judged part of the formula: judge it for itself")
        return self.truths[formula]

    def named(self) -> tuple[tuple[Application, TruthSet], ...]:
        """Return the judged applications of definitions, outermost first, each once."""
        parts = (x for x in subformulas(self.formula) if isinstance(x, Application) and x in self.truths)
        return tuple((part, self.truths[part]) for part in parts)

    def __str__(self) -> str:
        """One line for each named part: when it is true, in seconds, as decimals with bounds."""
        return "\n".join(f"{x.name}({', '.join(x.arguments)}): {truth}" for x, truth in self.named())


def judge(
    formula: Formula, drive: Drive | Signals | None = None, given: Mapping[Formula, TruthSet] = NOTHING_GIVEN
) -> Judgement:
    """Judge a bound formula (comparisons of signals and sizes only) on ``drive``.

    ``given``: truth sets of sub-formulas, taken as they are at any depth; ``drive`` may be None where nothing
    else is compared. Raises ``InputError`` for a formula that is not bound, ``UsageError`` for a vehicle that
    the drive does not have.
    """
    return DriveJudge.on(drive, given).judgement(formula)


@dataclass(frozen=True)
class Judge:
    """A judge of bound formulas on one drive; parts that formulas share are judged once.

    ``truths``: truth sets of the parts judged so far; ``given``: as in ``judge``.
    """

    courses: TermPieces
    given: Mapping[Formula, TruthSet]
    truths: dict[Formula, TruthSet] = field(default_factory=dict)

    @classmethod
    def on(cls, drive: Drive | Signals | None, given: Mapping[Formula, TruthSet] = NOTHING_GIVEN) -> Self:
        """Return the judge of a drive."""
        signals = DriveSignals(drive) if isinstance(drive, Drive) else drive
        return cls(TermPieces(signals or AbstractSignals({}, {})), given)

    def visit(self, formula: Formula) -> TruthSet:
        """Return the truth set of a formula. Raises as ``judge``, if a part cannot be judged."""
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
                return eventually(*interval_seconds(interval), self.visit(body))
            case f.Always(interval, body):
                return always(*interval_seconds(interval), self.visit(body))
            case f.Until(left, interval, right):
                return until(self.visit(left), *interval_seconds(interval), self.visit(right))
            case f.Since(left, interval, right):
                return since(self.visit(left), *interval_seconds(interval), self.visit(right))
            case f.Occupies() | f.Some() | f.Every():
                raise InputError("a formula over a road's lanes is judged after it is bound to a road")
            case _:
                assert_never(formula)


class DriveJudge(Judge):
    """A judge that judges all parts of each formula."""

    def judgement(self, formula: Formula) -> Judgement:
        """Return the truth sets of a formula and of each of its parts. Raises as ``judge``."""
        self.visit(formula)
        return Judgement(formula, self.truths)

    def holds(self, formula: Formula) -> bool:
        """Return whether a formula is true at time 0."""
        return self.visit(formula).at(Fraction(0))


@dataclass(frozen=True)
class LazyJudge(Judge):
    """A judge that comes to the same truth but skips parts that decide nothing.

    So a part that cannot be judged need not raise an error. ``within``: the times that matter.
    """

    within: TruthSet = ALWAYS

    def holds(self, formula: Formula) -> bool:
        """Return whether a formula is true at time 0."""
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
            case f.Truth() | f.Compare() | f.Occupies() | f.Some() | f.Every():
                return self.visit(formula).at(Fraction(0))
            case f.Until() | f.Since() | f.Eventually() | f.Always():
                return self.visit(formula).at(Fraction(0))

    def _visit(self, formula: Formula) -> TruthSet:
        match formula:
            case f.And(parts):
                truth = self.within
                for part in parts:
                    if truth == NEVER:
                        break
                    truth = intersection([truth, self.visit(part)])
                return truth
            case f.Or(parts):
                truth = NEVER
                for part in parts:
                    if truth == self.within:
                        break
                    truth = union([truth, self.visit(part)])
                return truth
            case f.Until(left, interval, right):
                end = self.visit(right)
                return until(self.visit(left), *interval_seconds(interval), end) if end != NEVER else NEVER
            case f.Truth() | f.Compare() | f.Occupies() | f.Some() | f.Every() | f.Not() | f.Application():
                return Judge._visit(self, formula)
            case f.Eventually() | f.Always() | f.Since():
                return Judge._visit(self, formula)


def interval_seconds(interval: Interval) -> tuple[Fraction, Fraction | None]:
    """Return both bounds of an interval (s); None is unbounded. Raises ``InputError`` for invalid bounds."""
    try:
        low, high = bounds_of(interval)
    except ValueError as error:
        raise InputError(str(error)) from None
    if low < 0 or (high is not None and high < low):
        raise InputError(f"an interval needs 0 <= low <= high, but low={low}, high={high}")
    return low, high
