"""Sparse matrices for HiGHS and Clarabel, both of which read arrays by columns.

``scipy.sparse`` makes the same arrays, but its import takes longer than most searches.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from roadproof.runtime.records import dataclass

Numbers = NDArray[np.float64]
Places = NDArray[np.intp]


@dataclass(frozen=True)
class Columns:
    """A matrix by columns (CSC), rows sorted and unique, with the field names of scipy's ``csc_array``."""

    data: Numbers
    indices: NDArray[np.int32]
    indptr: NDArray[np.int32]
    shape: tuple[int, int]
    has_canonical_format: bool = True  # Clarabel reads it


def by_columns(rows: Places, columns: Places, values: Numbers, shape: tuple[int, int]) -> Columns:
    """Return the matrix of these entries; values at the same place are added in their order."""
    order = np.lexsort((rows, columns))
    rows, columns, values = rows[order], columns[order], values[order]
    first = np.ones(len(order), dtype=bool)
    first[1:] = (np.diff(rows) != 0) | (np.diff(columns) != 0)
    data = values[first]
    np.add.at(data, (np.cumsum(first) - 1)[~first], values[~first])
    counts = np.bincount(columns[first], minlength=shape[1])
    ends = np.concatenate([[0], np.cumsum(counts)])
    return Columns(data, rows[first].astype(np.int32), ends.astype(np.int32), shape)


def _without_zeros(matrix: Columns) -> Columns:
    """The matrix without entries that are 0, whose places change how Clarabel orders the columns."""
    nonzero = matrix.data != 0
    ends = np.concatenate([[0], np.cumsum(nonzero)])[matrix.indptr].astype(np.int32)
    return Columns(matrix.data[nonzero], matrix.indices[nonzero], ends, matrix.shape)


class Triplets:
    """The entries of a sparse matrix, row by row, and a right-hand side for each row."""

    def __init__(self) -> None:
        self.rows: list[int] = []
        self.columns: list[int] = []
        self.values: list[float] = []
        self.right: list[float] = []

    def add(self, terms: Iterable[tuple[int, float]], right: float) -> None:
        """Append a row of (column, value) entries with its right-hand side."""
        for column, factor in terms:
            self.rows.append(len(self.right))
            self.columns.append(column)
            self.values.append(factor)
        self.right.append(right)

    def arrays(self) -> tuple[Places, Places, Numbers]:
        """Return rows, columns and values of the entries."""
        return np.array(self.rows, np.intp), np.array(self.columns, np.intp), np.array(self.values, float)

    def stacked(self, other: "Triplets", count: int) -> Columns:
        """Return the rows of this and then of the other, with ``count`` columns."""
        shift = len(self.right)
        parts = zip(self.arrays(), other.arrays(), strict=True)
        rows, columns, values = (np.concatenate(pair) for pair in parts)
        rows[len(self.rows) :] += shift
        return by_columns(rows, columns, values, (shift + len(other.right), count))

    def squared(self, weights: Numbers, count: int) -> Columns:
        """Return Σ weight · row · rowᵀ, with ``count`` rows and columns."""
        rows, columns, values = self.arrays()
        sizes = np.bincount(rows, minlength=len(self.right))
        repeats = sizes[rows]
        left = np.repeat(np.arange(len(rows)), repeats)
        begins = np.cumsum(sizes) - sizes
        within = np.arange(len(left)) - np.repeat(np.cumsum(repeats) - repeats, repeats)
        right = begins[rows[left]] + within
        products = (values * weights[rows])[left] * values[right]
        left, right, products = left[::-1], right[::-1], products[::-1]  # sums round as in the shipped drives
        return _without_zeros(by_columns(columns[left], columns[right], products, (count, count)))

    def weighted(self, weights: Numbers, count: int) -> Numbers:
        """Return Σ weight · row · right-hand side, with ``count`` entries."""
        rows, columns, values = self.arrays()
        given = (weights * np.array(self.right, float))[rows] * values
        return np.asarray(np.bincount(columns, weights=given, minlength=count), float)
