"""How long an answer took, as it is told and kept: to a tenth of a millisecond, rounded once.

A figure that is rounded for a file and again for a page may be told differently when it is read back.
"""

import time


def now() -> float:
    """An instant to count from, in seconds."""
    return time.monotonic()


def since(begun: float) -> float:
    """Seconds since ``begun``, an instant that ``now`` gave."""
    return round(time.monotonic() - begun, 4)
