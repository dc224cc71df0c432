"""Margins over recorded traces: by how much a formula holds (> 0) or fails (< 0).

The usual quantitative semantics (Fainekos and Pappas 2009; Donzé and Maler 2010): a comparison is
the difference of its sides, ``and`` a minimum, ``or`` a maximum. A state formula given as truth
counts as ±∞: its truth is known, its distance is not. The padding after the end of a trace is -∞
in the strong view and ∞ in the weak one.
"""

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from roadproof.logic.formula import Compare, Formula
from roadproof.semantics.sampled.arithmetic import Bytecode, run
from roadproof.semantics.sampled.batch import Array, Batch, inside
from roadproof.semantics.sampled.lattice import Lattice

MARGIN = Lattice(join=np.maximum, meet=np.minimum, complement=np.negative, bottom=-np.inf, top=np.inf)


def as_margin(truth: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return ∞ for true, -∞ for false."""
    return np.where(truth, np.inf, -np.inf)


def margin_inside(batch: Batch, columns: slice) -> NDArray[np.float64] | None:
    """Return ∞ at the samples of the traces in ``columns``, else -∞; None where that is every sample."""
    lengths = batch.lengths[columns]
    samples = int(lengths.max())
    return None if (lengths == samples).all() else as_margin(inside(lengths, samples))


def observe_margins(
    comparisons: Sequence[Compare], program: Bytecode, batch: Batch, columns: slice
) -> dict[Formula, Array]:
    """Return margins of the comparisons for some traces, shape (samples of the longest, traces)."""
    samples = int(batch.lengths[columns].max())
    margins = [np.empty((samples, columns.stop - columns.start)) for _ in comparisons]
    height = max(1, 32768 // (columns.stop - columns.start))
    for start in range(0, samples, height):
        rows = slice(start, min(start + height, samples))
        for all_rows, values in zip(margins, run(program, batch, rows, columns), strict=True):
            all_rows[rows] = values
    lengths = batch.lengths[columns]
    if (lengths < samples).any():  # NaN after the end of a trace would survive minimum and maximum
        after = ~inside(lengths, samples)
        for all_rows in margins:
            all_rows[after] = 0.0
    return dict(zip(comparisons, margins, strict=True))


def trace_blocks(batch: Batch, samples_in_block: int) -> Iterator[slice]:
    """Yield slices of neighbouring traces with about ``samples_in_block`` samples together."""
    width = max(1, samples_in_block // batch.samples)
    for start in range(0, batch.traces, width):
        yield slice(start, min(start + width, batch.traces))
