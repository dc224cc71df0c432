"""Temporal logic over time-major arrays of values from a lattice: truth bits or margins.

One walk serves both: ``and`` is meet, ``or`` is join, ``not`` the order-reversing complement. Row k
is sample k; what lies after the last sample of a trace is *padding*, a bottom or a top:

- strong view: bottom. A witness must lie inside, and so must the whole window of an ``Always``;
- weak view: top, the dual; ``Not`` swaps the two (Eisner et al., *Reasoning with temporal logic on
  truncated paths*, CAV 2003; semantics §1, end of a recorded trace);
- clip: the padding that never matters, so windows are cut at the last sample. Nothing is in an empty
  window: ``Eventually`` and ``Until`` fail there, ``Always`` holds.
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
    STRONG = "strong"
    WEAK = "weak"
    CLIP = "clip"
    __hash__ = object.__hash__  # of an enumeration it is slow, and asked for at each look-up


OPPOSITE = {View.STRONG: View.WEAK, View.WEAK: View.STRONG, View.CLIP: View.CLIP}


@dataclass(frozen=True)
class Lattice:
    """How values are joined; ``complement`` maps ``bottom`` to ``top`` and reverses the order."""

    join: np.ufunc
    meet: np.ufunc
    complement: np.ufunc
    bottom: Any
    top: Any


Key: TypeAlias = tuple[Formula, View]


@dataclass
class Evaluation:
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
        """Values of ``formula`` at every sample; those after the end of a trace mean nothing."""
        found = self.leaves.get(formula)
        if found is not None:
            return found
        if formula in self.states:
            found = self.composites.get(formula)
            if found is None:
                found = self.composites[formula] = self._value(formula, view)
            return found
        found = self.known.get((formula, view))
        if found is None:
            found = self.known[formula, view] = self._value(formula, view)
        return found

    def first(self, formula: Formula, view: View) -> Array:
        """Values of ``formula`` at the first sample: the first row of ``value``, in fewer steps.

        What is asked of the first sample alone has no value at the others.
        """
        if formula in self.leaves:
            leaf: Array = self.leaves[formula][0]
            return leaf
        key = (formula, View.CLIP if formula in self.states else view)
        found = self.firsts.get(key)
        if found is None:
            found = self.firsts[key] = self._first(formula, view)
        return found

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
                held, reached = self._padded(left, view, padding), self._padded(right, view, padding)
                return until(self.lattice, held, reached, low, high, padding)
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
                held, reached = self._padded(left, view, padding), self._padded(right, view, padding)
                return first_until(self.lattice, held, reached, *self._steps(interval), padding)
            case _:
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
        """Values with ``padding`` after the end of each trace."""
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
    """Both bounds in steps; None is unbounded. Raises ``InputError`` where they are no multiple of dt."""
    return _interval_steps(interval, dt.numerator, dt.denominator)


@lru_cache(1000)
def _interval_steps(interval: f.Interval, *dt: int) -> tuple[int, int | None]:
    low, high = bounds_of(interval)
    return steps_of(low, Fraction(*dt)), None if high is None else steps_of(high, Fraction(*dt))


def shift(values: Array, steps: int, padding: Any) -> Array:
    """Row k of the result is row k + steps of ``values``, and ``padding`` beyond the last."""
    if steps == 0:
        return values
    shifted = np.empty_like(values)
    kept = max(0, len(values) - steps)
    shifted[:kept] = values[steps:]
    shifted[kept:] = padding
    return shifted


def join_shifted(operation: np.ufunc, values: Array, other: Array, steps: int, padding: Any) -> Array:
    """``operation(values, shift(other, steps, padding))`` in one pass."""
    made = np.empty_like(values)
    kept = max(0, len(values) - steps)
    operation(values[:kept], other[steps:], out=made[:kept])
    operation(values[kept:], padding, out=made[kept:])
    return made


def extremum(operation: np.ufunc, values: Array, low: int, high: int | None, padding: Any) -> Array:
    """Join or meet of rows k+low … k+high for every row k, in log(high-low) doubling steps.

    Where windows reach beyond the last row, all rows from k on and the padding are joined.
    """
    width, wanted = 1, _samples_in_window(low, high, len(values))
    if wanted > len(values):
        return shift(operation(operation.accumulate(values[::-1])[::-1], padding), low, padding)
    window = values
    while width < wanted:
        step = min(width, wanted - width)
        window = join_shifted(operation, window, window, step, padding)
        width += step
    return shift(window, low, padding)


def first_extremum(operation: np.ufunc, values: Array, low: int, high: int | None, padding: Any) -> Array:
    """The first row of ``extremum``."""
    end = len(values) + 1 if high is None else high + 1
    window = values[low:end]
    if not len(window):
        return np.full_like(values[0], padding)
    found: Array = operation.reduce(window, axis=0)
    return found if end <= len(values) else operation(found, padding, out=found)


def first_until(
    lattice: Lattice, held: Array, reached: Array, low: int, high: int | None, padding: Any
) -> Array:
    """The first row of ``until``."""
    end = len(held) + 1 if high is None else high + 1
    beyond = end > len(held)
    found, kept = reached[low:end].copy(), lattice.meet.accumulate(held[low:end], axis=0)
    if not len(found):
        return np.full_like(held[0], padding)
    lattice.meet(kept[:-1], found[1:], out=found[1:])
    first: Array = lattice.join.reduce(found, axis=0)
    return lattice.join(first, lattice.meet(kept[-1], padding), out=first) if beyond else first


def until(lattice: Lattice, held: Array, reached: Array, low: int, high: int | None, padding: Any) -> Array:
    """Join over j in [low, high] of ``reached[k+j]`` met with ``held[k+i]`` for all i in [low, j).

    The paper's reading: ``held`` is asked for from ``low`` on, so the operator is one that starts at
    0, shifted. Both arrays are padded. With U(n) and G(n) the operators over n samples and m <= n,
    U(n+m)[k] is the join of U(n)[k] with the meet of G(m)[k] and U(n)[k+m].
    """
    width, wanted = 1, _samples_in_window(low, high, len(held))
    found, kept = reached, held
    while width < wanted:
        step = min(width, wanted - width)
        start = kept if step == width else extremum(lattice.meet, held, 0, step - 1, padding)
        later = join_shifted(lattice.meet, start, found, step, padding)
        found = lattice.join(found, later, out=later)
        width += step
        if wanted - width >= width:
            kept = join_shifted(lattice.meet, kept, kept, step, padding)
    return shift(found, low, padding)


def _samples_in_window(low: int, high: int | None, samples: int) -> int:
    """Of an interval in steps.

    More than ``samples`` + 1, the padding included, change nothing: then it is the next power of two, which
    doubling reaches without a remainder.
    """
    if high is None or high - low >= samples:
        return 1 << samples.bit_length()
    return high - low + 1
