"""How many random examples a property is tried on: a quarter in ``make test``, all in ``make long``.

Faults are tried on all (``make mutants``), as is whatever runs with ``ROADPROOF_EXAMPLES=full``. Changes of
evidence and of questions are a sample in both; ``ROADPROOF_CHANGES=all`` makes all, which takes hours.
"""

import os

EVERY_CHANGE = os.environ.get("ROADPROOF_CHANGES") == "all"


def some(count: int, least: int = 25) -> int:
    """So many of ``count`` examples as this run tries, ``least`` at least."""
    return count if os.environ.get("ROADPROOF_EXAMPLES") == "full" else max(least, count // 4)
