"""Temporal logic over time-major arrays of values from a lattice: truth bits or margins.

One walk serves both: ``and`` is meet, ``or`` is join, ``not`` the order-reversing complement. Row k
is sample k; the values after the last sample of a trace are *padding*, a bottom or a top:

- strong view: bottom. A witness must lie inside, and so must the whole window of an ``Always``;
- weak view: top, the dual; ``Not`` swaps the two (Eisner et al., *Reasoning with temporal logic on
  truncated paths*, CAV 2003; semantics §1, end of a recorded trace);
- clip: the identity of the operator (bottom for ``Eventually`` and ``Until``, top for ``Always``), so
  windows are cut at the last sample. On an empty window ``Eventually`` and ``Until`` fail and ``Always``
  holds.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from fractions import Fraction
from functools import lru_cache
from typing import Any, TypeAlias, assert_never

import numpy as np

from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import bounds_of
from roadproof.semantics.sampled.batch import Array, steps_of


class View(Enum):
    """The padding after the end of a trace: strong, weak or clip."""

    STRONG = "strong"
    WEAK = "weak"
    CLIP = "clip"
    __hash__ = object.__hash__  # of an enumeration it is slow, and asked for at each look-up


OPPOSITE: Mapping[View, View] = {View.STRONG: View.WEAK, View.WEAK: View.STRONG, View.CLIP: View.CLIP}


@dataclass(frozen=True)
class Lattice:
    """The operations on values; ``complement`` maps ``bottom`` to ``top`` and reverses the order."""

    join: np.ufunc
    meet: np.ufunc
    complement: np.ufunc
    bottom: Any
    top: Any


Key: TypeAlias = tuple[Formula, View]


@dataclass
class LatticeEvaluation:
    """Values of formulas over one block of traces, each computed once per view.

    ``leaves`` holds the values of atoms and of given state formulas, shape (time, …); ``inside`` is
    top at the samples of a trace and bottom after its end, or None where all traces fill all rows.
    ``states`` are the formulas without temporal operators, whose values no view changes; ``composites``
    takes those that are no leaves, and may be shared by evaluations of the same leaves.
    """

    lattice: Lattice
    leaves: Mapping[Formula, Array]
    inside: Array | None
    dt: Fraction
    shape: tuple[int, int]
    states: frozenset[Formula]
    composites: dict[Formula, Array] = field(default_factory=dict)
    known: dict[Key, Array] = field(default_factory=dict)
    firsts: dict[Key, Array] = field(default_factory=dict)
    padded: dict[tuple[Formula, View, bool], Array] = field(default_factory=dict)

    def value(self, formula: Formula, view: View) -> Array:
        """Return values of ``formula`` at every sample; those after the end of a trace mean nothing."""
        values = self.leaves.get(formula)
        if values is not None:
            return values
        if formula in self.states:
            values = self.composites.get(formula)
            if values is None:
                values = self.composites[formula] = self._value(formula, view)
            return values
        values = self.known.get((formula, view))
        if values is None:
            values = self.known[formula, view] = self._value(formula, view)
        return values

    def first(self, formula: Formula, view: View) -> Array:
        """Return values of ``formula`` at the first sample: the first row of ``value``, in fewer steps.

        Sub-formulas needed at the first sample alone are not evaluated at the others.
        """
        if formula in self.leaves:
            leaf: Array = self.leaves[formula][0]
            return leaf
        key = (formula, View.CLIP if formula in self.states else view)
        row = self.firsts.get(key)
        if row is None:
            row = self.firsts[key] = self._first(formula, view)
        return row

    def _value(self, formula: Formula, view: View) -> Array:
        match formula:
            case f.Truth(value):
                top = self.lattice.top if value else self.lattice.bottom
                return np.full(self.shape, top)
            case f.Application(_, _, body):
                return self.value(body, view)
            case f.Not(body):
                made: Array = self.lattice.complement(self.value(body, OPPOSITE[view]))
                return made
            case f.And(parts):
                return self._fold(self.lattice.meet, parts, view)
            case f.Or(parts):
                return self._fold(self.lattice.join, parts, view)
            case f.Eventually(interval, body):
                padding = self._padding(view, universal=False)
                low, high = self._steps(interval)
                return extremum(self.lattice.join, self._padded(body, view, padding), low, high, padding)
            case f.Always(interval, body):
                padding = self._padding(view, universal=True)
                low, high = self._steps(interval)
                return extremum(self.lattice.meet, self._padded(body, view, padding), low, high, padding)
            case f.Until(left, interval, right):
                padding = self._padding(view, universal=False)
                low, high = self._steps(interval)
                left_values, reached = self._padded(left, view, padding), self._padded(right, view, padding)
                return until(self.lattice, left_values, reached, low, high, padding)
            case f.Since(left, interval, right):
                return since(
                    self.lattice, self.value(left, view), self.value(right, view), *self._steps(interval)
                )
            case f.Compare() | f.Occupies() | f.Some() | f.Every():
                raise AssertionError(f"{type(formula).__name__} is a leaf: compile() collects them")
            case _:
                assert_never(formula)

    def _first(self, formula: Formula, view: View) -> Array:
        match formula:
            case f.Truth(value):
                return np.full(self.shape[1], self.lattice.top if value else self.lattice.bottom)
            case f.Application(_, _, body):
                return self.first(body, view)
            case f.Not(body):
                made: Array = self.lattice.complement(self.first(body, OPPOSITE[view]))
                return made
            case f.And(parts) | f.Or(parts):
                operation = self.lattice.meet if isinstance(formula, f.And) else self.lattice.join
                total = self.first(parts[0], view)
                for part in parts[1:]:
                    total = operation(total, self.first(part, view))
                return total
            case f.Eventually(interval, body) | f.Always(interval, body):
                universal = isinstance(formula, f.Always)
                operation = self.lattice.meet if universal else self.lattice.join
                padding = self._padding(view, universal)
                values = self._padded(body, view, padding)
                return first_extremum(operation, values, *self._steps(interval), padding)
            case f.Until(left, interval, right):
                padding = self._padding(view, universal=False)
                left_values, reached = self._padded(left, view, padding), self._padded(right, view, padding)
                return first_until(self.lattice, left_values, reached, *self._steps(interval), padding)
            case f.Since(_, interval, right):
                low, _ = self._steps(interval)
                return self.first(right, view) if low == 0 else np.full(self.shape[1], self.lattice.bottom)
            case f.Compare() | f.Occupies() | f.Some() | f.Every():
                raise AssertionError(f"{type(formula).__name__} is a leaf: compile() collects them")

    def _fold(self, operation: np.ufunc, parts: tuple[Formula, ...], view: View) -> Array:
        total = self.value(parts[0], view)
        for part in parts[1:]:
            total = operation(total, self.value(part, view))
        return total

    def _padding(self, view: View, universal: bool) -> Any:
        match view:
            case View.STRONG:
                return self.lattice.bottom
            case View.WEAK:
                return self.lattice.top
            case View.CLIP:
                return self.lattice.top if universal else self.lattice.bottom
            case _:
                assert_never(view)

    def _padded(self, formula: Formula, view: View, padding: Any) -> Array:
        """Return values with ``padding`` after the end of each trace."""
        if self.inside is None:
            return self.value(formula, view)
        low = bool(padding == self.lattice.bottom)
        made = self.padded.get((formula, view, low))
        if made is None:
            values = self.value(formula, view)
            made = (
                self.lattice.meet(values, self.inside)
                if low
                else self.lattice.join(values, self.lattice.complement(self.inside))
            )
            self.padded[formula, view, low] = made
        return made

    def _steps(self, interval: f.Interval) -> tuple[int, int | None]:
        return interval_steps(interval, self.dt)


def interval_steps(interval: f.Interval, dt: Fraction) -> tuple[int, int | None]:
    """Return both bounds in steps; None is unbounded. Raises ``InputError`` for no multiple of dt."""
    return _interval_steps(interval, dt.numerator, dt.denominator)


@lru_cache(1000)
def _interval_steps(interval: f.Interval, *dt: int) -> tuple[int, int | None]:
    low, high = bounds_of(interval)
    return steps_of(low, Fraction(*dt)), None if high is None else steps_of(high, Fraction(*dt))


def shift(values: Array, steps: int, padding: Any) -> Array:
    """Return ``values`` moved up: row k is row k + steps, and ``padding`` beyond the last."""
    if steps == 0:
        return values
    shifted = np.empty_like(values)
    remaining = max(0, len(values) - steps)
    shifted[:remaining] = values[steps:]
    shifted[remaining:] = padding
    return shifted


def join_shifted(operation: np.ufunc, values: Array, other: Array, steps: int, padding: Any) -> Array:
    """Return ``operation(values, shift(other, steps, padding))`` in one pass."""
    made = np.empty_like(values)
    remaining = max(0, len(values) - steps)
    operation(values[:remaining], other[steps:], out=made[:remaining])
    operation(values[remaining:], padding, out=made[remaining:])
    return made


def extremum(operation: np.ufunc, values: Array, low: int, high: int | None, padding: Any) -> Array:
    """Return join or meet of rows k+low … k+high for every row k, in log(high-low) doubling steps.

    Windows that reach beyond the last row take all rows from k+low on and the padding.
    """
    width, target = 1, _samples_in_window(low, high, len(values))
    if target > len(values):
        return shift(operation(operation.accumulate(values[::-1])[::-1], padding), low, padding)
    window = values
    while width < target:
        step = min(width, target - width)
        window = join_shifted(operation, window, window, step, padding)
        width += step
    return shift(window, low, padding)


def first_extremum(operation: np.ufunc, values: Array, low: int, high: int | None, padding: Any) -> Array:
    """Return the first row of ``extremum``."""
    end = len(values) + 1 if high is None else high + 1
    window = values[low:end]
    if not len(window):
        return np.full_like(values[0], padding)
    row: Array = operation.reduce(window, axis=0)
    return row if end <= len(values) else operation(row, padding, out=row)


def first_until(
    lattice: Lattice, left: Array, reached: Array, low: int, high: int | None, padding: Any
) -> Array:
    """Return the first row of ``until``."""
    end = len(left) + 1 if high is None else high + 1
    beyond = end > len(left)
    rights, lefts = reached[low:end].copy(), lattice.meet.accumulate(left[low:end], axis=0)
    if not len(rights):
        return np.full_like(left[0], padding)
    lattice.meet(lefts[:-1], rights[1:], out=rights[1:])
    first: Array = lattice.join.reduce(rights, axis=0)
    return lattice.join(first, lattice.meet(lefts[-1], padding), out=first) if beyond else first


def until(lattice: Lattice, left: Array, reached: Array, low: int, high: int | None, padding: Any) -> Array:
    """Return the join over j in [low, high] of ``reached[k+j]`` met with ``left[k+i]`` for all i in [low, j).

    The paper's reading: ``left`` must hold from ``low`` on, so the operator is one that starts at 0, shifted.
    Both arrays are padded. With U(n) and G(n) the operators over n samples and m <= n, U(n+m)[k] is the join
    of U(n)[k] with the meet of G(m)[k] and U(n)[k+m].
    """
    width, target = 1, _samples_in_window(low, high, len(left))
    best, lefts = reached, left
    while width < target:
        step = min(width, target - width)
        start = lefts if step == width else extremum(lattice.meet, left, 0, step - 1, padding)
        later = join_shifted(lattice.meet, start, best, step, padding)
        best = lattice.join(best, later, out=later)
        width += step
        if target - width >= width:
            lefts = join_shifted(lattice.meet, lefts, lefts, step, padding)
    return shift(best, low, padding)


def since(lattice: Lattice, left: Array, reached: Array, low: int, high: int | None) -> Array:
    """Return the join over j in [low, high] of ``reached[k-j]`` met with ``left[k-i]`` for all i in [low, j).

    It is the mirror image of ``until``; no sample is before the first. Row k depends on no later row, so the
    values after the end of a trace do no harm.
    """
    return until(lattice, left[::-1], reached[::-1], low, high, lattice.bottom)[::-1]


def _samples_in_window(low: int, high: int | None, samples: int) -> int:
    """Return the number of samples in an interval of steps.

    More than ``samples`` + 1, the padding included, change nothing: then it is the next power of two, which
    doubling reaches without a remainder.
    """
    if high is None or high - low >= samples:
        return 1 << samples.bit_length()
    return high - low + 1
