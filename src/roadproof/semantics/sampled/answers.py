"""Verdicts and margins of a monitor, and how they are read from the values of a formula."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass
from typing import Generic, Literal, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from roadproof.errors import InputError
from roadproof.logic.formula import Application, Formula
from roadproof.semantics.sampled.batch import Array, Batch, Integers, inside
from roadproof.semantics.sampled.boolean import BITS, unpack
from roadproof.semantics.sampled.lattice import LatticeEvaluation, View

Convention: TypeAlias = Literal["truncated", "clip"]
When: TypeAlias = Literal["start", "all"]
# What the caller calls a question: a text, or a value that says what is asked.
Key = TypeVar("Key", bound=Hashable)


@dataclass(frozen=True)
class TruthArrays:
    """The three-valued truth of a formula: ``true`` or ``false`` for every continuation, or neither.

    Shape (traces,) at the start of each trace, or (time, traces), where neither holds after the end.
    """

    true: NDArray[np.bool_]
    false: NDArray[np.bool_]

    @property
    def undecided(self) -> NDArray[np.bool_]:
        return ~(self.true | self.false)


@dataclass(frozen=True)
class Verdicts(Generic[Key]):
    """The answer to each question; on request also of named sub-formulas, at all samples."""

    convention: Convention
    answers: Mapping[Key, TruthArrays]
    named: Mapping[Application, TruthArrays]


@dataclass(frozen=True)
class Margin:
    """The bounds [low, high] of a margin over all continuations of a trace; with ``clip`` they are equal.

    Shape as in ``TruthArrays``; NaN after the end of a trace.
    """

    low: NDArray[np.float64]
    high: NDArray[np.float64]


@dataclass(frozen=True)
class Margins(Generic[Key]):
    """The margin of each question, and of named sub-formulas."""

    convention: Convention
    margins: Mapping[Key, Margin]
    named: Mapping[Application, Margin]


def views(convention: Convention) -> tuple[View, View]:
    """Return the view in which a true formula is certain, and the one in which a false formula is."""
    return (View.CLIP, View.CLIP) if convention == "clip" else (View.STRONG, View.WEAK)


def check_starts(starts: Integers | None, lengths: Integers) -> None:
    """Raise ``InputError`` unless each of ``starts`` is a sample of its trace."""
    if starts is None:
        return
    if starts.shape != lengths.shape or (starts < 0).any() or (starts >= lengths).any():
        raise InputError("starts must name one sample inside each trace")


def read_bits(words: Array, end: Array | None, traces: int, starts: Integers | None) -> NDArray[np.bool_]:
    """Return truth at ``starts``, or at all samples, false after the ``end`` (from ``packed_inside``)."""
    if starts is None:
        return unpack(words if end is None else words & end, traces)
    index = np.arange(traces)
    bits = words[starts, index // BITS] >> (index % BITS).astype(np.uint64)
    return np.asarray(bits & np.uint64(1), dtype=np.bool_)


def no_margin(batch: Batch, when: When) -> Margin:
    """Return arrays for the margins of one formula, filled with NaN."""
    shape = (batch.traces,) if when == "start" else (batch.samples, batch.traces)
    return Margin(np.full(shape, np.nan), np.full(shape, np.nan))


def store_margin(
    margin: Margin,
    evaluation: LatticeEvaluation,
    formula: Formula,
    convention: Convention,
    batch: Batch,
    columns: slice,
    when: When,
    starts: Integers | None,
) -> None:
    """Store the margins of the traces in ``columns``."""
    for view, made in zip(views(convention), (margin.low, margin.high), strict=True):
        if when == "start" and starts is None:
            made[columns] = evaluation.first(formula, view)
            continue
        values = evaluation.value(formula, view)
        if starts is None or when == "all":
            belongs = inside(batch.lengths[columns], len(values))
            made[: len(values), columns] = np.where(belongs, values, np.nan)
        else:
            made[columns] = values[starts, np.arange(values.shape[1])]
