"""When a formula is true on a trace that repeats itself for ever, exactly, from one round of it.

A truth set of such a trace is known by what it is before the end of the first round. Each operator looks
ahead into as many rounds as can matter: a witness that comes later than the end of the first round, and
a whole round later than it is asked for, also came one round earlier.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from typing import assert_never

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.algebraic import moved
from roadproof.semantics.exact.exact import seconds
from roadproof.semantics.exact.truth import (
    ALWAYS,
    NEVER,
    Cut,
    TruthSet,
    complement,
    eventually,
    intersection,
    interval,
    union,
    until,
)

MOST_ROUNDS = 2000


@dataclass(frozen=True)
class Loop:
    """From ``start`` (s) on, each ``period`` seconds are like the ones before."""

    start: Fraction
    period: Fraction

    @property
    def end(self) -> Fraction:
        """When the first round ends."""
        return self.start + self.period


def judge_periodic(formula: Formula, given: Mapping[Formula, TruthSet], loop: Loop) -> TruthSet:
    """When a bound formula is true before the end of the first round of ``loop``.

    ``given``: the truth of its comparisons there. Raises ``InputError`` for one that is not given, and for
    intervals that reach over too many rounds.
    """
    inside = interval(Fraction(0), loop.end, "[)")
    done: dict[Formula, TruthSet] = {}

    def visit(current: Formula) -> TruthSet:
        if current not in done:
            known = given.get(current)
            done[current] = intersection([_visit(current) if known is None else known, inside])
        return done[current]

    def ahead(body: Formula, low: Fraction, negated: bool = False) -> TruthSet:
        truth = intersection([complement(visit(body)), inside]) if negated else visit(body)
        return unrolled(truth, loop, low + 2 * loop.end + loop.period)

    def _visit(current: Formula) -> TruthSet:
        match current:
            case f.Truth(value):
                return ALWAYS if value else NEVER
            case f.Not(body):
                return complement(visit(body))
            case f.And(parts):
                return intersection([visit(part) for part in parts])
            case f.Or(parts):
                return union([visit(part) for part in parts])
            case f.Application(_, _, body):
                return visit(body)
            case f.Eventually(window, body):
                low, high = _within(window, loop)
                return eventually(low, high, ahead(body, low))
            case f.Always(window, body):
                low, high = _within(window, loop)
                return complement(eventually(low, high, ahead(body, low, negated=True)))
            case f.Until(left, window, right):
                low, high = _within(window, loop)
                return until(ahead(left, low), low, high, ahead(right, low))
            case f.Compare() | f.Occupies() | f.Some() | f.Every():
                raise InputError("a part of the formula is neither given nor combined from what is")
            case _:
                assert_never(current)

    return visit(formula)


def unrolled(truth: TruthSet, loop: Loop, horizon: Fraction) -> TruthSet:
    """A truth set of the first round in all rounds up to ``horizon`` (s), and false later."""
    rounds = max(1, ceil((horizon - loop.start) / loop.period))
    if rounds > MOST_ROUNDS:
        raise InputError(f"an interval reaches over {rounds} rounds of the trace; at most {MOST_ROUNDS}")
    parts = [intersection([truth, interval(Fraction(0), loop.end, "[)")])]
    again = intersection([truth, interval(loop.start, loop.end, "[)")])
    for k in range(1, rounds):
        later = (Cut(moved(cut.point, k * loop.period), cut.after) for cut in again.cuts)
        parts.append(TruthSet(tuple(later)))
    return union(parts)


def _within(window: f.Interval, loop: Loop) -> tuple[Fraction, Fraction]:
    """An interval without what lies so late in it that it came before."""
    low, high = seconds(window)
    return low, low + loop.end if high is None else min(high, low + loop.end)
