"""What the C library does with memory that is freed, and how often Python looks for cycles."""

import contextlib
import ctypes
import gc

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
_LARGEST_MAPPED = 32 << 20
_KEPT = 256 << 20


_THRESHOLDS = 5000, 20, 50


def collect_rarely() -> None:
    """Have Python look for cycles less often: trees of formulas have none, and a look walks through all."""
    gc.set_threshold(*_THRESHOLDS)


def keep_freed_memory() -> None:
    """Have memory that is freed kept for the next array, in a process that does nothing but work on arrays.

    Otherwise each array of a megabyte is given back to the system and asked for again, page by page. Nothing
    happens where the C library is not glibc.
    """
    with contextlib.suppress(OSError, AttributeError, TypeError):
        library = ctypes.CDLL(None)
        library.mallopt(_MMAP_THRESHOLD, _LARGEST_MAPPED)
        library.mallopt(_TRIM_THRESHOLD, _KEPT)
