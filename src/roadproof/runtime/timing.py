"""The duration of an answer, rounded once to a tenth of a millisecond.

A duration that is rounded for a file, and again for a page, could differ when it is read back.
"""

import time


def now() -> float:
    """Return an instant to count from, in seconds."""
    return time.monotonic()


def seconds_since(start: float) -> float:
    """Return the seconds since ``start``, an instant that ``now`` gave."""
    return round(time.monotonic() - start, 4)
