"""Unrolls temporal operators over a grid: a bound formula becomes a circuit over atoms at samples.

Negation disappears: it is pushed to the comparisons, where it turns ``<`` into ``>=``. Grid semantics:
an operator ranges over samples k·dt; the last sample stands for every later one, so a window that
reaches past the horizon ends on it (without acceleration from there on, see ``encode.build``). Until is
the paper's (semantics §1): its left side must hold from the start of the interval on, not before. A formula
that looks back may change its truth for some time after the last sample; windows end when it no longer does.
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
        self.last = cache(self._last)

    def _at(self, formula: Formula, positive: bool, step: int) -> Circuit[TimedAtom]:
        """Return the circuit of ``formula`` at a sample, or of its negation where not ``positive``."""
        both, either = (all_of, any_of) if positive else (any_of, all_of)
        match formula:
            case f.Truth(value):
                return All(()) if value == positive else AnyOf(())
            case Compare(left, op, right):
                atom = formula if positive else Compare(left, NEGATED[op], right)
                return Leaf(TimedAtom(atom, min(step, self.grid.steps)))
            case f.Not(body):
                return self.at(body, not positive, step)
            case f.And(parts):
                return both(self.at(p, positive, step) for p in parts)
            case f.Or(parts):
                return either(self.at(p, positive, step) for p in parts)
            case f.Application(_, _, body):
                return self.at(body, positive, step)
            case f.Eventually(interval, body):
                return either(self.at(body, positive, k) for k in self._samples(formula, interval, step))
            case f.Always(interval, body):
                return both(self.at(body, positive, k) for k in self._samples(formula, interval, step))
            case f.Until(left, interval, right):
                samples = self._samples(formula, interval, step)
                return self._until(left, samples, right, positive, both, either)
            case f.Since(left, interval, right):
                earlier = self._earlier(interval, step)
                if not earlier:
                    return self.at(f.FALSE, positive, step)
                return self._until(left, earlier, right, positive, both, either)
            case f.Occupies() | f.Some() | f.Every():
                raise ValueError(f"bind the formula to a road first: {type(formula).__name__}")
            case _:
                assert_never(formula)

    def _last(self, formula: Formula) -> int:
        """Return the sample from which on the truth of ``formula`` is the same."""
        last = max((self.last(part) for part in f.children(formula)), default=self.grid.steps)
        if isinstance(formula, f.Since):
            low, high = self.grid.window(formula.interval)
            return last + (low if high is None else high)
        return last

    def _earlier(self, interval: Interval, step: int) -> range:
        """Return the samples of a window that looks back, the latest first."""
        low, high = self.grid.window(interval)
        return range(step - low, -1 if high is None else max(-1, step - high - 1), -1)

    def _samples(self, formula: f.Temporal, interval: Interval, step: int) -> range:
        low, high = self.grid.window(interval)
        last = self.last(formula)
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
        """Build until, or since, from the end: ψ at a sample, or φ at it and the same from the next on."""
        result = self.at(right, positive, samples[-1])
        for k in reversed(samples[:-1]):
            result = either([self.at(right, positive, k), both([self.at(left, positive, k), result])])
        return result
