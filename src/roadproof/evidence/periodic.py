"""When a formula is true on a trace that repeats itself for ever, exactly, from one round of it.

A truth set of such a trace is known by what it is before the end of the first round. Each operator looks
ahead into as many rounds as can matter: a witness that comes later than the end of the first round, and
a whole round later than it is asked for, also came one round earlier.
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
from roadproof.semantics.exact.exact import Judge, seconds
from roadproof.semantics.exact.signals import AbstractSignals, Courses

MOST_ROUNDS = 2000
Window: TypeAlias = tuple[Fraction, Fraction | None]


def judge_periodic(formula: Formula, given: Mapping[Formula, sets.TruthSet], loop: Loop) -> sets.TruthSet:
    """When a bound formula is true before the end of the first round of ``loop``.

    ``given``: the truth of its comparisons there. Raises ``InputError`` for one that is not given, and for
    intervals that reach over too many rounds.
    """
    return PeriodicJudge(Courses(AbstractSignals({}, {})), given, loop=loop).visit(formula)


@dataclass(frozen=True, kw_only=True)
class PeriodicJudge(Judge):
    """A judge who says of each part when it is true before the end of the first round.

    Where there is no ``loop``: when it is true at all.
    """

    loop: Loop | None

    def visit(self, formula: Formula) -> sets.TruthSet:
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
                low, high = clipped(seconds(window), loop)
                return sets.eventually(low, high, ahead(self.visit(body), low, loop))
            case f.Always(window, body):
                low, high = clipped(seconds(window), loop)
                failing = first_round(sets.complement(self.visit(body)), loop)
                return sets.complement(sets.eventually(low, high, ahead(failing, low, loop)))
            case f.Until(left, window, right):
                low, high = clipped(seconds(window), loop)
                held, reached = (ahead(self.visit(x), low, loop) for x in (left, right))
                return sets.until(held, low, high, reached)
            case f.Truth() | f.Not() | f.And() | f.Or() | f.Application():
                return Judge._visit(self, formula)
            case f.Compare() | f.Occupies() | f.Some() | f.Every():
                raise InputError("a part of the formula is neither given nor combined from what is")
            case _:
                assert_never(formula)


def first_round(truth: sets.TruthSet, loop: Loop) -> sets.TruthSet:
    """The part of a truth set before the end of the first round."""
    return sets.intersection([truth, sets.interval(Fraction(0), loop.end, "[)")])


def ahead(truth: sets.TruthSet, low: Fraction, loop: Loop) -> sets.TruthSet:
    """A truth set of the first round in as many rounds as matter to intervals from ``low`` on."""
    return unrolled(truth, loop, low + 2 * loop.end + loop.period)


def unrolled(truth: sets.TruthSet, loop: Loop, horizon: Fraction) -> sets.TruthSet:
    """A truth set of the first round in all rounds up to ``horizon`` (s), and false later."""
    rounds = max(1, ceil((horizon - loop.start) / loop.period))
    if rounds > MOST_ROUNDS:
        raise InputError(f"an interval reaches over {rounds} rounds of the trace; at most {MOST_ROUNDS}")
    parts = [first_round(truth, loop)]
    again = sets.intersection([truth, sets.interval(loop.start, loop.end, "[)")])
    for k in range(1, rounds):
        later = (sets.Cut(moved(cut.point, k * loop.period), cut.after) for cut in again.cuts)
        parts.append(sets.TruthSet(tuple(later)))
    return sets.union(parts)


def clipped(window: Window, loop: Loop) -> tuple[Fraction, Fraction]:
    """An interval without what lies so late in it that it came before."""
    low, high = window
    return low, low + loop.end if high is None else min(high, low + loop.end)
