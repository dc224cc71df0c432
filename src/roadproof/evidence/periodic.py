"""The exact truth of formulas on traces that repeat for ever, computed from the first round alone.

The truth set of such a trace is determined by its part before the end of the first round. Each operator looks
ahead into as many rounds as can matter. A witness that comes after the first round, and a whole round later
than required, also came one round earlier.
"""

from collections.abc import Mapping
from fractions import Fraction
from math import ceil
from typing import TypeAlias, assert_never

from roadproof.errors import InputError
from roadproof.evidence.countermodel import Loop
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact import truth as sets
from roadproof.semantics.exact.algebraic import moved
from roadproof.semantics.exact.judging import Judge, interval_seconds
from roadproof.semantics.exact.signals import AbstractSignals, TermPieces

MOST_ROUNDS = 2000
Window: TypeAlias = tuple[Fraction, Fraction | None]


def judge_periodic(
    formula: Formula, comparisons: Mapping[Formula, sets.TruthSet], loop: Loop
) -> sets.TruthSet:
    """Return the set of times before the end of the first round at which a bound formula is true.

    ``comparisons``: their truth sets there. Raises ``InputError`` for a missing comparison, and for intervals
    that reach over too many rounds.
    """
    return PeriodicJudge(TermPieces(AbstractSignals({}, {})), comparisons, loop=loop).visit(formula)


@dataclass(frozen=True, kw_only=True)
class PeriodicJudge(Judge):
    """A judge of each part up to the end of the first round; without ``loop``, an ordinary judge."""

    loop: Loop | None

    def visit(self, formula: Formula) -> sets.TruthSet:
        """Return the truth set of a formula, up to the end of the first round if there is a loop."""
        if self.loop is None:
            return Judge.visit(self, formula)
        if formula not in self.truths:
            self.truths[formula] = first_round(Judge.visit(self, formula), self.loop)
        return self.truths[formula]

    def _visit(self, formula: Formula) -> sets.TruthSet:
        loop = self.loop
        if loop is None:
            return Judge._visit(self, formula)
        match formula:
            case f.Eventually(window, body):
                low, high = clip(interval_seconds(window), loop)
                return sets.eventually(low, high, unroll_ahead(self.visit(body), low, loop))
            case f.Always(window, body):
                low, high = clip(interval_seconds(window), loop)
                failing = first_round(sets.complement(self.visit(body)), loop)
                return sets.complement(sets.eventually(low, high, unroll_ahead(failing, low, loop)))
            case f.Until(left, window, right):
                low, high = clip(interval_seconds(window), loop)
                left_holds, reached = (unroll_ahead(self.visit(x), low, loop) for x in (left, right))
                return sets.until(left_holds, low, high, reached)
            case f.Since():
                raise InputError("a formula that looks back (O, H, S) is not judged on a trace that repeats")
            case f.Truth() | f.Not() | f.And() | f.Or() | f.Application():
                return Judge._visit(self, formula)
            case f.Compare() | f.Occupies() | f.Some() | f.Every():
                raise InputError("a part of the formula is neither given nor combined from what is")
            case _:
                assert_never(formula)


def first_round(truth: sets.TruthSet, loop: Loop) -> sets.TruthSet:
    """Return the part of a truth set before the end of the first round."""
    return sets.intersection([truth, sets.interval(Fraction(0), loop.end, "[)")])


def unroll_ahead(truth: sets.TruthSet, low: Fraction, loop: Loop) -> sets.TruthSet:
    """Return a truth set of the first round, unrolled as far as intervals that begin at ``low`` can reach."""
    return unroll(truth, loop, low + 2 * loop.end + loop.period)


def unroll(truth: sets.TruthSet, loop: Loop, horizon: Fraction) -> sets.TruthSet:
    """Return a truth set of the first round, repeated up to ``horizon`` (s), and false later."""
    rounds = max(1, ceil((horizon - loop.start) / loop.period))
    if rounds > MOST_ROUNDS:
        raise InputError(f"an interval reaches over {rounds} rounds of the trace; at most {MOST_ROUNDS}")
    parts = [first_round(truth, loop)]
    repeated = sets.intersection([truth, sets.interval(loop.start, loop.end, "[)")])
    for k in range(1, rounds):
        later = (sets.Cut(moved(cut.point, k * loop.period), cut.after) for cut in repeated.cuts)
        parts.append(sets.TruthSet(tuple(later)))
    return sets.union(parts)


def clip(window: Window, loop: Loop) -> tuple[Fraction, Fraction]:
    """Return the interval without its part so late that the same states also occur earlier in it."""
    low, high = window
    return low, low + loop.end if high is None else min(high, low + loop.end)
