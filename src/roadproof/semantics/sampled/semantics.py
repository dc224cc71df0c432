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
    ``states`` are the formulas without temporal operators, whose values no view changes.
    """

    lattice: Lattice
    leaves: Mapping[Formula, Array]
    inside: Array | None
    dt: Fraction
    shape: tuple[int, int]
    states: frozenset[Formula]
    known: dict[Key, Array] = field(default_factory=dict)

    def value(self, formula: Formula, view: View) -> Array:
        """Values of ``formula`` at every sample; those after the end of a trace mean nothing."""
        found = self.leaves.get(formula)
        if found is None:
            key = (formula, View.CLIP if formula in self.states else view)
            found = self.known.get(key)
            if found is None:
                found = self.known[key] = self._value(formula, view)
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
        values = self.value(formula, view)
        if self.inside is None:
            return values
        made: Array
        if padding == self.lattice.bottom:
            made = self.lattice.meet(values, self.inside)
        else:
            made = self.lattice.join(values, self.lattice.complement(self.inside))
        return made

    def _steps(self, interval: f.Interval) -> tuple[int, int | None]:
        return interval_steps(interval, self.dt)


def interval_steps(interval: f.Interval, dt: Fraction) -> tuple[int, int | None]:
    """Both bounds in steps; None is unbounded. Raises ``InputError`` where they are no multiple of dt."""
    low, high = bounds_of(interval)
    return steps_of(low, dt), None if high is None else steps_of(high, dt)


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
