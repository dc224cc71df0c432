"""Boxes [s-length, s] × [d-width, d] as formulas."""

from roadproof.logic.formula import Compare, Formula, conjunction
from roadproof.logic.terms import Signal, Size, subtract


def boxes_overlap(a: str, b: str) -> Formula:
    """The boxes of ``a`` and ``b`` overlap with positive area."""
    parts: list[Formula] = []
    for one, other in ((a, b), (b, a)):
        parts.append(Compare(subtract(Signal("s", one), Size("length", one)), "<", Signal("s", other)))
        parts.append(Compare(subtract(Signal("d", one), Size("width", one)), "<", Signal("d", other)))
    return conjunction(*parts)
