"""How many random examples a property is tried on: a quarter in ``make test``, all in ``make long``.

Faults are tried on all (``make mutants``), as is whatever runs with ``ROADPROOF_EXAMPLES=full``.
"""

import os


def some(count: int) -> int:
    """So many of ``count`` examples as this run tries."""
    return count if os.environ.get("ROADPROOF_EXAMPLES") == "full" else max(25, count // 4)
