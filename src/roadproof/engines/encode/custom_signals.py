"""Own signals on a grid: each has an unknown for every sample, and keeps its value up to the next."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from roadproof.logic import terms as t
from roadproof.logic.custom_names import own_of
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import terms_of
from roadproof.world.vehicle import Range

WIDEST = Fraction(1000)
"""Where a signal has no bound, values are looked for up to this, or twice the largest number beside it."""


@dataclass(frozen=True)
class OwnColumns:
    """An own signal, and between which values it is looked for (SI)."""

    signal: t.Own
    range: Range


def own_columns(formula: Formula) -> tuple[OwnColumns, ...]:
    """The own signals of a bound formula, by name and vehicle."""
    numbers = [abs(x.value) for side in terms_of(formula) for x in t.leaves(side) if isinstance(x, t.Number)]
    widest = max(WIDEST, 2 * max(numbers, default=Fraction(0)))
    return tuple(OwnColumns(signal, range_of(signal, widest)) for signal in own_of([formula]))


def range_of(signal: t.Own, widest: Fraction) -> Range:
    """Its declared bounds; where one is missing, ``widest`` beyond 0 and beyond the other."""
    if signal.truth:
        return Fraction(0), Fraction(1)
    low, high = signal.low, signal.high
    return (
        min(-widest, Fraction(0) if high is None else high - widest) if low is None else low,
        max(widest, Fraction(0) if low is None else low + widest) if high is None else high,
    )


def index_of(own: Sequence[OwnColumns], name: str, vehicle: str) -> int:
    """Which of ``own`` is the signal of that name and vehicle."""
    return next(k for k, x in enumerate(own) if (x.signal.name, x.signal.vehicle) == (name, vehicle))
