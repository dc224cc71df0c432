"""A synthesised drive: rational initial states and piecewise constant rational accelerations.

At a knot the acceleration is that of the piece which begins there; the last piece lasts for ever.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class Piece:
    """Constant accelerations in m/s² for ``duration`` seconds; None is for ever (the last piece)."""

    duration: Fraction | None
    a_lon: Fraction
    a_lat: Fraction


@dataclass(frozen=True)
class Motion:
    """One vehicle: its box in m, its state at time 0 (m, m/s; front-left corner), and its pieces."""

    length: Fraction
    width: Fraction
    s: Fraction
    d: Fraction
    v_lon: Fraction
    v_lat: Fraction
    pieces: tuple[Piece, ...]

    def __post_init__(self) -> None:
        if self.length <= 0 or self.width <= 0:
            raise ValueError(f"a box needs length={self.length} > 0 and width={self.width} > 0")
        *before, last = self.pieces or (None,)
        if last is None or last.duration is not None:
            raise ValueError("the last piece must last for ever: duration None")
        if any(p is None or p.duration is None or p.duration <= 0 for p in before):
            raise ValueError("every piece but the last needs a duration > 0")


@dataclass(frozen=True)
class Drive:
    """The motions of all vehicles by name, on one clock."""

    vehicles: Mapping[str, Motion]
