"""Robustness of a formula on a drive: margins at the samples k·dt, by min and max (grid view).

Comparisons are sampled exactly and rounded once (``semantics.exact.samples``).
Bounded windows are always covered: sampling goes on past the horizon as far as windows reach. An unbounded
window ends with the last sample.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from math import inf
from typing import Any, TypeAlias, assert_never

import numpy as np

from roadproof.errors import InputError, UsageError
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula, Interval
from roadproof.semantics.exact.judging import interval_seconds
from roadproof.semantics.exact.samples import sample_margin
from roadproof.semantics.exact.signals import DriveSignals, TermPieces
from roadproof.world.drive import Drive

MOST_SAMPLES = 1_000_000
Array: TypeAlias = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Robustness:
    """Margins of a formula and its sub-formulas at times 0, dt, …, horizon, in units of each atom.

    ``sampled_until`` (s) is the last sample that was looked at: the horizon and the reach of bounded
    windows; those without end are cut there.
    """

    formula: Formula
    dt: Fraction
    horizon: Fraction
    sampled_until: Fraction
    margins: Mapping[Formula, Array]

    @property
    def value(self) -> float:
        """The margin of the whole formula at time 0."""
        return float(self.margins[self.formula][0])


def robustness(formula: Formula, drive: Drive, dt: Fraction, horizon: Fraction) -> Robustness:
    """Return margins of a bound formula on a drive, sampled every ``dt`` s over [0, horizon].

    Raises ``InputError`` for a bound or horizon that is no multiple of dt and for formulas that are
    not bound, ``UsageError`` for dt <= 0, a negative horizon or a vehicle that the drive lacks.
    """
    if dt <= 0 or horizon < 0:
        raise UsageError(f"dt={dt}, horizon={horizon}: a grid needs dt > 0 and horizon >= 0, in seconds")
    requested = steps(horizon, dt, "horizon")
    last = requested + _reach(formula, dt)
    if last >= MOST_SAMPLES:
        raise UsageError(
            f"dt={dt}, horizon={horizon}: that makes {last + 1} samples, above {MOST_SAMPLES}: "
            "choose a larger dt"
        )
    sampling = _Sampler(TermPieces(DriveSignals(drive)), dt, last + 1)
    sampling.visit(formula)
    margins = {part: values[: requested + 1] for part, values in sampling.known.items()}
    return Robustness(formula, dt, horizon, last * dt, margins)


def steps(time: Fraction, dt: Fraction, what: str = "interval bound") -> int:
    """Return ``time`` as a number of samples. Raises ``InputError`` where it is no multiple of ``dt``."""
    count = time / dt
    if count.denominator != 1:
        raise InputError(
            f"{what}={time} s is no multiple of dt={dt} s: choose a dt that divides it, or another {what}"
        )
    return int(count)


def _reach(formula: Formula, dt: Fraction) -> int:
    """Return the samples past an instant that its margin needs; unbounded windows count their low."""
    within = max((_reach(child, dt) for child in f.children(formula)), default=0)
    for interval in f.intervals(formula):
        low, high = interval_seconds(interval)
        steps(low, dt)
        if isinstance(formula, f.Since):
            steps(low if high is None else high, dt)
            continue
        within += steps(low if high is None else high, dt)
    return within


@dataclass(frozen=True)
class _Sampler:
    """Margins by sample; an array is as long as its values are known, so windows never dangle."""

    courses: TermPieces
    dt: Fraction
    count: int
    known: dict[Formula, Array] = field(default_factory=dict)

    def visit(self, formula: Formula) -> Array:
        if formula not in self.known:
            self.known[formula] = self._visit(formula)
        return self.known[formula]

    def _visit(self, formula: Formula) -> Array:
        match formula:
            case f.Truth(value):
                return np.full(self.count, inf if value else -inf)
            case f.Compare():
                return np.array(sample_margin(formula, self.courses, self.dt, self.count))
            case f.Not(body):
                return -self.visit(body)
            case f.And(parts):
                return _fold(np.minimum, [self.visit(part) for part in parts])
            case f.Or(parts):
                return _fold(np.maximum, [self.visit(part) for part in parts])
            case f.Application(_, _, body):
                return self.visit(body)
            case f.Eventually(interval, body):
                return _greatest_ahead(self.visit(body), *self._steps(interval))
            case f.Always(interval, body):
                return -_greatest_ahead(-self.visit(body), *self._steps(interval))
            case f.Until(left, interval, right):
                return _until(self.visit(left), *self._steps(interval), self.visit(right))
            case f.Since(left, interval, right):
                return _since(self.visit(left), *self._steps(interval), self.visit(right))
            case f.Occupies() | f.Some() | f.Every():
                raise InputError("a formula over a road's lanes is sampled after it is bound to a road")
            case _:
                assert_never(formula)

    def _steps(self, interval: Interval) -> tuple[int, int | None]:
        low, high = interval_seconds(interval)
        return steps(low, self.dt), None if high is None else steps(high, self.dt)


def _fold(join: np.ufunc, arrays: list[Array]) -> Array:
    shortest = min(len(array) for array in arrays)
    result: Array = join.reduce([array[:shortest] for array in arrays])
    return result


def _greatest_ahead(body: Array, low: int, high: int | None) -> Array:
    """max of body[k+low .. k+high], or to the last sample."""
    if high is None:
        return np.maximum.accumulate(body[low:][::-1])[::-1]
    windows = np.lib.stride_tricks.sliding_window_view(body[low:], high - low + 1)
    result: Array = windows.max(axis=1)
    return result


def _until(left: Array, low: int, high: int | None, right: Array) -> Array:
    """max over j in [low, high] of min(right[k+j], left[k+low .. k+j-1]) (semantics §1)."""
    length = min(len(left), len(right)) - low
    left, right = left[low : low + length], right[low : low + length]
    if high is None:
        best = right.copy()
        for k in range(length - 2, -1, -1):
            best[k] = max(best[k], min(left[k], best[k + 1]))
        return best
    count = length - (high - low)
    best, left_least = right[:count].copy(), np.full(count, inf)
    for j in range(1, high - low + 1):
        left_least = np.minimum(left_least, left[j - 1 : j - 1 + count])
        best = np.maximum(best, np.minimum(right[j : j + count], left_least))
    return best


def _since(left: Array, low: int, high: int | None, right: Array) -> Array:
    """max over j in [low, high], j <= k, of min(right[k-j], left[k-low .. k-j+1]); else -inf."""
    length = min(len(left), len(right))
    best, left_least = right[:length].copy(), np.full(length, inf)
    if high is None:
        for k in range(1, length):
            best[k] = max(best[k], min(left[k], best[k - 1]))
    for j in range(1, 0 if high is None else min(high - low + 1, length)):
        left_least[j:] = np.minimum(left_least[j:], left[1 : length - j + 1])
        best[j:] = np.maximum(best[j:], np.minimum(right[: length - j], left_least[j:]))
    seen = np.full(length, -inf)
    seen[low:] = best[: max(0, length - low)]
    return seen


def clamped_to_verdict(margin: float, holds: bool) -> float:
    """Return a sampled margin, cut off at 0 where the judge contradicts its sign.

    In dense time the margin of a true formula is not below 0, and that of a false one not above: samples miss
    events between them, and the first instant that an open condition lacks.
    """
    return max(margin, 0.0) if holds else min(margin, 0.0)
