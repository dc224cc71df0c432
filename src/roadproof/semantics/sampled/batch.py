"""A ragged batch of recorded traces, time-major: row k of every array holds sample k of all traces."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from roadproof.errors import InputError
from roadproof.logic.formula import Formula, is_state
from roadproof.logic.terms import SizeName
from roadproof.world.signals import SIGNALS

Array: TypeAlias = NDArray[Any]
Integers: TypeAlias = NDArray[np.int64]


@dataclass(frozen=True)
class Batch:
    """Measured traces on a common step ``dt`` (s); sample k of a trace is at time k·dt.

    ``signals`` and ``given`` are of shape (time, traces), ``sizes`` and ``lengths`` of shape (traces,).
    Trace i has the samples 0 … lengths[i]-1; what the arrays hold after them is never read into an
    answer. Custom signals are among ``signals``, with the vehicle '' where they are of none. ``given`` holds
    the truth of state formulas that the monitor need not compute, found by structure (names of definitions
    do not matter): lane predicates on a measured road, above all.
    ``source``: where the traces are from, for messages. Units are SI; float32 signals are widened to float64
    before any arithmetic.

    Raises ``InputError`` for arrays that do not fit together, for NaN and infinities inside a trace,
    and for sizes that are not greater than zero.
    """

    dt: Fraction
    lengths: Integers
    signals: Mapping[tuple[str, str], Array] = field(default_factory=dict)
    sizes: Mapping[tuple[SizeName, str], Array] = field(default_factory=dict)
    given: Mapping[Formula, Array] = field(default_factory=dict)
    source: str = ""

    def __post_init__(self) -> None:
        if self.dt <= 0:
            raise InputError(f"a batch needs a time step above zero, but dt={self.dt} s")
        _check_lengths(self.lengths)
        for (name, vehicle), values in self.signals.items():
            _check_signal(f"{name}({vehicle})", values, self.lengths, name in SIGNALS)
        for (size, vehicle), values in self.sizes.items():
            _check_size(f"{size}({vehicle})", values, self.lengths)
        for formula, truth in self.given.items():
            _check_shape(f"the given truth of {type(formula).__name__}", truth, self.lengths)
            if truth.dtype != np.bool_:
                raise InputError(f"given truth must be an array of bool, not of {truth.dtype}")
            if not is_state(formula):
                raise InputError("only the truth of formulas without temporal operators can be given")

    @property
    def samples(self) -> int:
        """Number of samples of the longest trace."""
        return int(self.lengths.max())

    @property
    def traces(self) -> int:
        return len(self.lengths)

    def from_starts(self, starts: Integers) -> "Batch":
        """Return the batch without the samples before those at which each trace ``starts``."""
        return Batch(
            self.dt,
            self.lengths - starts,
            {key: rows_from(values, starts) for key, values in self.signals.items()},
            self.sizes,
            {formula: rows_from(values, starts) for formula, values in self.given.items()},
            self.source,
        )


def rows_from(values: Array, starts: Integers) -> Array:
    """Return ``values``, shape (time, traces), with row ``starts[i]`` of trace i as its first.

    The last row fills what is then left.
    """
    rows = np.minimum(np.arange(len(values))[:, None] + starts[None, :], len(values) - 1)
    return np.take_along_axis(values, rows, axis=0)


def inside(lengths: Integers, samples: int) -> NDArray[np.bool_]:
    """Return which samples belong to their traces, shape (samples, traces)."""
    return np.arange(samples)[:, None] < lengths[None, :]


def steps_of(bound: Fraction, dt: Fraction) -> int:
    """Return an interval bound (s) as a number of steps of ``dt``.

    Raises ``InputError`` where the bound is no multiple of ``dt``: 0.5 s at 25 Hz is 12.5 steps.
    """
    quotient = bound / dt
    if quotient.denominator != 1:
        below = quotient.numerator // quotient.denominator
        raise InputError(
            f"the interval bound {float(bound):g} s is no multiple of the time step "
            f"dt={float(dt):g} s ({bound} / {dt} = {quotient} steps); "
            f"use {float(below * dt):g} s or {float((below + 1) * dt):g} s"
        )
    return quotient.numerator


def _check_lengths(lengths: Array) -> None:
    if lengths.ndim != 1 or len(lengths) == 0 or lengths.dtype.kind not in "iu":
        raise InputError(
            f"lengths must hold one whole number a trace, but its shape is {lengths.shape} "
            f"and its type {lengths.dtype}"
        )
    if lengths.min() < 1:
        trace = int(lengths.argmin())
        raise InputError(f"trace {trace} has length={lengths[trace]}: a trace needs at least one sample")


def _check_shape(what: str, values: Array, lengths: Integers) -> None:
    samples = int(lengths.max())
    if values.ndim != 2 or values.shape[1] != len(lengths) or values.shape[0] < samples:
        raise InputError(
            f"{what} has shape {values.shape}, but {len(lengths)} traces of up to {samples} samples "
            f"need (time, traces) = ({samples}, {len(lengths)})"
        )


def _check_signal(what: str, values: Array, lengths: Integers, finite: bool) -> None:
    _check_shape(what, values, lengths)
    if values.dtype not in (np.dtype(np.float64), np.dtype(np.float32)):
        raise InputError(f"{what} must be an array of float64 or float32, not of {values.dtype}")
    if not finite:
        return  # a custom signal, of which more is known where a formula speaks of it
    rows = max(1, 65536 // len(lengths))  # small blocks stay in the cache
    for start in range(0, int(lengths.max()), rows):
        block = values[start : start + rows]
        if np.isfinite(block).all():
            continue
        belongs = np.arange(start, start + len(block))[:, None] < lengths[None, :]
        wrong = np.argwhere(belongs & ~np.isfinite(block))
        if len(wrong):
            sample, trace = int(wrong[0, 0]), int(wrong[0, 1])
            raise InputError(
                f"{what} is {block[sample, trace]} in trace {trace} at sample {start + sample}: "
                "every sample must be a finite number; fill the gap or cut the trace before it"
            )


def _check_size(what: str, values: Array, lengths: Integers) -> None:
    if values.shape != lengths.shape:
        raise InputError(f"{what} has shape {values.shape}, but there are {len(lengths)} traces")
    if values.min() > 0 and values.max() < np.inf:
        return  # neither is so where one is no number
    wrong = np.flatnonzero(~(np.isfinite(values) & (values > 0)))
    if len(wrong):
        raise InputError(f"{what}={values[wrong[0]]} in trace {wrong[0]}: a size must be greater than zero")
