"""The horizon of a formula: how far after an instant its truth depends on a trace."""

from fractions import Fraction
from functools import cache
from typing import TypeAlias, assert_never

from roadproof.logic import formula as f
from roadproof.logic.rewrite import bounds_of

Seconds: TypeAlias = Fraction


def horizon(formula: f.Formula) -> Seconds | None:
    """Return how many seconds after an instant the truth of ``formula`` may depend on; None for no limit.

    Raises ``ValueError`` if an interval bound still has a parameter.
    """

    @cache
    def visit(current: f.Formula) -> Seconds | None:
        return _horizon_of(current, [visit(child) for child in f.children(current)])

    return visit(formula)


def _horizon_of(formula: f.Formula, below: list[Seconds | None]) -> Seconds | None:
    farthest = _latest(below)
    match formula:
        case f.Until(_, interval, _) | f.Eventually(interval, _) | f.Always(interval, _):
            high = bounds_of(interval)[1]
            return None if high is None or farthest is None else high + farthest
        case f.Since():
            return farthest
        case f.Truth() | f.Compare() | f.Occupies() | f.Some() | f.Every() | f.Not() | f.And() | f.Or():
            return farthest
        case f.Application():
            return farthest
        case _:
            assert_never(formula)


def _latest(times: list[Seconds | None]) -> Seconds | None:
    latest = Fraction(0)
    for time in times:
        if time is None:
            return None
        latest = max(latest, time)
    return latest
