"""Truth over recorded traces, bit-parallel: one machine word holds one sample of 64 traces.

Words are time-major, of shape (time, words); bit b of a row belongs to trace b, in little-endian
order of bits and bytes. Unused bits of the last word mean nothing.
"""

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from roadproof.logic.formula import Compare, Formula
from roadproof.semantics.sampled.arithmetic import Bytecode, run
from roadproof.semantics.sampled.batch import Array, Batch, Integers, inside
from roadproof.semantics.sampled.lattice import Lattice

BITS = 64
TRUTH = Lattice(
    join=np.bitwise_or,
    meet=np.bitwise_and,
    complement=np.invert,
    bottom=np.uint64(0),
    top=np.uint64(2**64 - 1),
)


def pack(truth: NDArray[np.bool_]) -> NDArray[np.uint64]:
    """Return truth of shape (time, traces) as words of shape (time, words)."""
    words = np.zeros((len(truth), words_for(truth.shape[1])), dtype="<u8")
    packed = np.packbits(truth, axis=1, bitorder="little")
    words.view(np.uint8)[:, : packed.shape[1]] = packed
    return words


def unpack(words: Array, traces: int) -> NDArray[np.bool_]:
    """Return words of shape (time, words) as truth of shape (time, traces)."""
    unpacked = np.unpackbits(np.ascontiguousarray(words).view(np.uint8), axis=1, bitorder="little")
    return unpacked[:, :traces].view(np.bool_)


def words_for(traces: int) -> int:
    """Return the number of words for the bits of so many traces."""
    return -(-traces // BITS)


def packed_inside(lengths: Integers, samples: int) -> NDArray[np.uint64] | None:
    """Return the bits of the samples that belong to their traces; None where that is every sample."""
    return None if (lengths == samples).all() else pack(inside(lengths, samples))


def observe_truth(
    comparisons: Sequence[Compare], program: Bytecode, batch: Batch, threads: int
) -> dict[Formula, NDArray[np.uint64]]:
    """Return the packed truth of every comparison at every sample of ``batch``; ``program`` computes them."""
    words = [np.zeros((batch.samples, words_for(batch.traces)), dtype="<u8") for _ in comparisons]
    blocks = list(_blocks(batch))
    if comparisons and threads > 1:
        with ThreadPoolExecutor(threads) as pool:
            for _ in pool.map(lambda block: _observe_block(program, batch, words, *block), blocks):
                pass
    elif comparisons:
        for block in blocks:
            _observe_block(program, batch, words, *block)
    return dict(zip(comparisons, words, strict=True))


def _observe_block(
    program: Bytecode, batch: Batch, words: list[NDArray[np.uint64]], rows: slice, columns: slice
) -> None:
    first = columns.start // 8
    for all_bits, truth in zip(words, run(program, batch, rows, columns), strict=True):
        packed = np.packbits(truth, axis=1, bitorder="little")
        all_bits.view(np.uint8)[rows, first : first + packed.shape[1]] = packed


def _blocks(batch: Batch, samples_in_block: int = 32768) -> Iterator[tuple[slice, slice]]:
    """Blocks whose operands fit the cache, without rows and last columns that are after the end of traces."""
    width = min(batch.traces, samples_in_block)  # a multiple of 64, or everything
    height = max(1, samples_in_block // width)
    for start in range(0, batch.traces, width):
        columns = slice(start, min(start + width, batch.traces))
        lengths = batch.lengths[columns]
        end = int(lengths.max())
        for row in range(0, end, height):
            stop = start + int(np.flatnonzero(lengths > row)[-1]) + 1
            yield slice(row, min(row + height, end)), slice(start, stop)
