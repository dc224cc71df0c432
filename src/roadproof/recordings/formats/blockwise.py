"""Work on long columns block by block, so that what comes in between stays in the cache."""

from collections.abc import Callable, Iterator
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Column: TypeAlias = npt.NDArray[Any]

ROWS = 1 << 14
"""So many rows of a few columns of doubles fit the cache of a core."""


def blocks_of(rows: int, overlap: int = 0) -> Iterator[slice]:
    """Slices that cover so many rows; each begins ``overlap`` rows before the end of the one before."""
    for begin in range(0, max(1, rows - overlap), ROWS):
        yield slice(begin, min(begin + ROWS + overlap, rows))


def blockwise(function: Callable[..., Column], *columns: Column) -> Column:
    """What ``function`` makes of columns of equal length, where row k of it depends on rows k alone.

    >>> blockwise(np.add, np.array([1, 2]), np.array([10, 20])).tolist()
    [11, 22]
    """
    rows = len(columns[0])
    first = function(*(x[:ROWS] for x in columns))
    if rows <= ROWS:
        return first
    made = np.empty((rows, *first.shape[1:]), first.dtype)
    made[:ROWS] = first
    for begin in range(ROWS, rows, ROWS):
        part = slice(begin, begin + ROWS)
        made[part] = function(*(x[part] for x in columns))
    return made
