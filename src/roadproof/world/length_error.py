"""The difference between lengths along the lanes of a bent road and lengths in s."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import TYPE_CHECKING

from roadproof.runtime.records import dataclass
from roadproof.world.road import Lanelet, Road

if TYPE_CHECKING:
    from roadproof.world.reference_line import ReferenceLine


@dataclass(frozen=True)
class LengthError:
    """The largest difference between lengths along lanes and lengths in s, in which formulas and RSS measure.

    ``share``: at one place, the greatest |κ·d|. ``metres``: along a whole lane, the greatest sum.
    """

    share: Fraction
    metres: Fraction

    def __str__(self) -> str:
        return f"{float(100 * self.share):.2g} %, {float(self.metres):.2g} m on the whole length"


def length_error_of(road: Road | None) -> LengthError | None:
    """Return the largest error of lengths on a road; None if it is straight."""
    if road is None or road.line is None:
        return None
    error = length_error(road.line, road.lanelets)
    return error if error.share else None


def bend_note(road: Road | None) -> str:
    """Return a note on the errors of lengths on a road; empty if it is straight."""
    error = length_error_of(road)
    if road is None or error is None:
        return ""
    return f"road {road.name} bends: lengths in its lanes differ from those in s by up to {error}"


def length_error(line: ReferenceLine, lanelets: Iterable[Lanelet]) -> LengthError:
    """Return the largest error of lengths on lanelets: an edge at d is 1 - κ·d times as long as the line."""
    share, metres = Fraction(0), dict[str, Fraction]()
    bends = [x for x in line.bends() if x.greatest]
    for lanelet in lanelets:
        across = max(map(abs, lanelet.d))
        for bend in bends:
            begin = bend.begin if lanelet.s[0] is None else max(bend.begin, lanelet.s[0])
            end = bend.end if lanelet.s[1] is None else min(bend.end, lanelet.s[1])
            if begin < end:
                share = max(share, bend.greatest * across)
                more = bend.greatest * across * (end - begin)
                metres[lanelet.lane] = metres.get(lanelet.lane, Fraction(0)) + more
    return LengthError(share, max(metres.values(), default=Fraction(0)))
