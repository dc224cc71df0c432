"""When a formula is true on a trace that repeats itself for ever, exactly, from one round of it.

A truth set of such a trace is known by what it is before the end of the first round. Each operator looks
ahead into as many rounds as can matter: a witness that comes later than the end of the first round, and
a whole round later than it is asked for, also came one round earlier.
"""

from collections.abc import Mapping
from fractions import Fraction
from math import ceil
from typing import assert_never

from roadproof.errors import InputError
from roadproof.evidence.countermodel import Loop
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact import truth as sets
from roadproof.semantics.exact.algebraic import moved
from roadproof.semantics.exact.exact import Judge, seconds
from roadproof.semantics.exact.signals import AbstractSignals, Courses

MOST_ROUNDS = 2000


def judge_periodic(formula: Formula, given: Mapping[Formula, sets.TruthSet], loop: Loop) -> sets.TruthSet:
    """When a bound formula is true before the end of the first round of ``loop``.

    ``given``: the truth of its comparisons there. Raises ``InputError`` for one that is not given, and for
    intervals that reach over too many rounds.
    """
    return _PeriodicJudge(Courses(AbstractSignals({}, {})), given, loop=loop).visit(formula)


@dataclass(frozen=True, kw_only=True)
class _PeriodicJudge(Judge):
    """A judge who says of each part when it is true before the end of the first round."""

    loop: Loop

    def visit(self, formula: Formula) -> sets.TruthSet:
        if formula not in self.truths:
            self.truths[formula] = self._inside(Judge.visit(self, formula))
        return self.truths[formula]

    def _visit(self, formula: Formula) -> sets.TruthSet:
        match formula:
            case f.Eventually(window, body):
                low, high = _within(window, self.loop)
                return sets.eventually(low, high, self._ahead(self.visit(body), low))
            case f.Always(window, body):
                low, high = _within(window, self.loop)
                failing = self._inside(sets.complement(self.visit(body)))
                return sets.complement(sets.eventually(low, high, self._ahead(failing, low)))
            case f.Until(left, window, right):
                low, high = _within(window, self.loop)
                held, reached = (self._ahead(self.visit(x), low) for x in (left, right))
                return sets.until(held, low, high, reached)
            case f.Truth() | f.Not() | f.And() | f.Or() | f.Application():
                return Judge._visit(self, formula)
            case f.Compare() | f.Occupies() | f.Some() | f.Every():
                raise InputError("a part of the formula is neither given nor combined from what is")
            case _:
                assert_never(formula)

    def _inside(self, truth: sets.TruthSet) -> sets.TruthSet:
        return sets.intersection([truth, sets.interval(Fraction(0), self.loop.end, "[)")])

    def _ahead(self, truth: sets.TruthSet, low: Fraction) -> sets.TruthSet:
        return unrolled(truth, self.loop, low + 2 * self.loop.end + self.loop.period)


def unrolled(truth: sets.TruthSet, loop: Loop, horizon: Fraction) -> sets.TruthSet:
    """A truth set of the first round in all rounds up to ``horizon`` (s), and false later."""
    rounds = max(1, ceil((horizon - loop.start) / loop.period))
    if rounds > MOST_ROUNDS:
        raise InputError(f"an interval reaches over {rounds} rounds of the trace; at most {MOST_ROUNDS}")
    parts = [sets.intersection([truth, sets.interval(Fraction(0), loop.end, "[)")])]
    again = sets.intersection([truth, sets.interval(loop.start, loop.end, "[)")])
    for k in range(1, rounds):
        later = (sets.Cut(moved(cut.point, k * loop.period), cut.after) for cut in again.cuts)
        parts.append(sets.TruthSet(tuple(later)))
    return sets.union(parts)


def _within(window: f.Interval, loop: Loop) -> tuple[Fraction, Fraction]:
    """An interval without what lies so late in it that it came before."""
    low, high = seconds(window)
    return low, low + loop.end if high is None else min(high, low + loop.end)
