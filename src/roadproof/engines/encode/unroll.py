"""Unrolls temporal operators over a grid: a bound formula becomes a circuit over atoms at samples.

Negation disappears: it is pushed to the comparisons, where it turns ``<`` into ``>=``. Grid semantics:
an operator ranges over samples k·dt; the last sample stands for every later one, so a window that
reaches past the horizon ends on it (without acceleration from there on, see ``encode.build``). Until is
the paper's (semantics §1): its left side must hold from the start of the interval on, not before.
"""

from collections.abc import Callable
from fractions import Fraction
from functools import cache
from math import gcd
from typing import assert_never

from roadproof.engines.encode.problem import All, AnyOf, Circuit, Leaf, all_of, any_of
from roadproof.errors import UsageError
from roadproof.logic import formula as f
from roadproof.logic.formula import NEGATED, Compare, Formula, Interval
from roadproof.logic.rewrite import bounds_of
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Grid:
    """Sample times 0, dt, …, steps·dt (seconds)."""

    dt: Fraction
    steps: int

    @property
    def horizon(self) -> Fraction:
        return self.dt * self.steps

    def finer(self, factor: int) -> "Grid":
        """Return the grid with ``factor`` times as many steps up to the same horizon."""
        return Grid(self.dt / factor, self.steps * factor)

    def window(self, interval: Interval) -> tuple[int, int | None]:
        """Return an interval in steps; None is unbounded. Raises ``UsageError`` for no multiple of dt."""
        low, high = bounds_of(interval)
        return self._steps(low), None if high is None else self._steps(high)

    def _steps(self, bound: Fraction) -> int:
        steps = bound / self.dt
        if steps.denominator != 1:
            raise UsageError(
                f"the interval bound {float(bound):g} s is no multiple of dt={float(self.dt):g} s: "
                f"choose a dt that divides both, such as dt={common_step(bound, self.dt)}"
            )
        return int(steps)


def common_step(a: Fraction, b: Fraction) -> Fraction:
    """Return the greatest common divisor of two rationals; of 0 and b it is b."""
    return Fraction(
        gcd(a.numerator * b.denominator, b.numerator * a.denominator), a.denominator * b.denominator
    )


@dataclass(frozen=True)
class TimedAtom:
    """A comparison at step ``step``.

    The last step stands for every later time, unless ``Assumptions.last_sample_persists`` is False.
    """

    atom: Compare
    step: int


def unroll(formula: Formula, grid: Grid) -> Circuit[TimedAtom]:
    """Return the circuit that is true exactly where ``formula`` holds at sample 0 of the grid.

    ``formula`` is bound: it has no parameters, quantifiers or lane atoms.
    """
    return unroll_at(formula, grid, 0)


def unroll_at(formula: Formula, grid: Grid, step: int) -> Circuit[TimedAtom]:
    """Return the circuit that is true exactly where ``formula`` holds at sample ``step`` of the grid."""
    return _Unroller(grid).at(formula, True, step)


class _Unroller:
    def __init__(self, grid: Grid) -> None:
        self.grid = grid
        self.at = cache(self._at)

    def _at(self, formula: Formula, positive: bool, step: int) -> Circuit[TimedAtom]:
        """Return the circuit of ``formula`` at a sample, or of its negation where not ``positive``."""
        both, either = (all_of, any_of) if positive else (any_of, all_of)
        match formula:
            case f.Truth(value):
                return All(()) if value == positive else AnyOf(())
            case Compare(left, op, right):
                return Leaf(TimedAtom(formula if positive else Compare(left, NEGATED[op], right), step))
            case f.Not(body):
                return self.at(body, not positive, step)
            case f.And(parts):
                return both(self.at(p, positive, step) for p in parts)
            case f.Or(parts):
                return either(self.at(p, positive, step) for p in parts)
            case f.Application(_, _, body):
                return self.at(body, positive, step)
            case f.Eventually(interval, body):
                return either(self.at(body, positive, k) for k in self._samples(interval, step))
            case f.Always(interval, body):
                return both(self.at(body, positive, k) for k in self._samples(interval, step))
            case f.Until(left, interval, right):
                return self._until(left, self._samples(interval, step), right, positive, both, either)
            case f.Occupies() | f.Some() | f.Every():
                raise ValueError(f"bind the formula to a road first: {type(formula).__name__}")
            case _:
                assert_never(formula)

    def _samples(self, interval: Interval, step: int) -> range:
        low, high = self.grid.window(interval)
        last = self.grid.steps
        first = min(step + low, last)
        return range(first, 1 + (last if high is None else min(step + high, last)))

    def _until(
        self,
        left: Formula,
        samples: range,
        right: Formula,
        positive: bool,
        both: Callable[[list[Circuit[TimedAtom]]], Circuit[TimedAtom]],
        either: Callable[[list[Circuit[TimedAtom]]], Circuit[TimedAtom]],
    ) -> Circuit[TimedAtom]:
        """Build until from the last sample back: ψ now, or φ now and the until from the next sample on."""
        result = self.at(right, positive, samples[-1])
        for k in reversed(samples[:-1]):
            result = either([self.at(right, positive, k), both([self.at(left, positive, k), result])])
        return result
