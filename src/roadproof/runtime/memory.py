"""Memory settings of worker processes: when freed memory is returned to the system."""

import contextlib
import ctypes

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3
_LARGEST_MAPPED = 32 << 20
_KEPT = 256 << 20


def keep_freed_memory() -> None:
    """Make the C library keep freed memory for the next array, in a process that only works on arrays.

    Otherwise each array of a megabyte is returned to the system and requested again, page by page. Does
    nothing where the C library is not glibc.
    """
    with contextlib.suppress(OSError, AttributeError, TypeError):
        library = ctypes.CDLL(None)
        library.mallopt(_MMAP_THRESHOLD, _LARGEST_MAPPED)
        library.mallopt(_TRIM_THRESHOLD, _KEPT)
