"""Relations as sets of pairs of names."""

from collections.abc import Set


def transitive_reduction(pairs: Set[tuple[str, str]]) -> set[tuple[str, str]]:
    """The pairs of a relation that do not follow from others by a chain."""
    kept = set(pairs)
    for above, below in sorted(pairs):
        rest = kept - {(above, below)}
        if below in reachable(above, rest):
            kept = rest
    return kept


def reachable(name: str, pairs: Set[tuple[str, str]]) -> set[str]:
    """All that a chain of pairs leads to from ``name``, and ``name``."""
    seen, waiting = {name}, [name]
    while waiting:
        current = waiting.pop()
        new = {below for above, below in pairs if above == current} - seen
        seen |= new
        waiting += new
    return seen
