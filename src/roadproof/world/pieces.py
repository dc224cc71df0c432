"""The pieces of a motion, put together from what happens along the road and what happens across it."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import accumulate
from typing import TypeAlias

from roadproof.world.drive import Motion, Piece

# Duration (s), acceleration at its start (m/s²), jerk (m/s³).
Along: TypeAlias = tuple[Fraction, Fraction, Fraction]
# Duration (s), acceleration (m/s²).
Across: TypeAlias = tuple[Fraction, Fraction]


def pieces_of(along: Sequence[Along], across: Sequence[Across] = ()) -> tuple[Piece, ...]:
    """The pieces of a motion; after the last duration of each direction there is no acceleration in it.

    Accelerations may jump from one entry to the next. Raises ``ValueError`` for a duration that is not > 0.
    """
    for duration in (entry[0] for entry in (*along, *across)):
        if duration <= 0:
            raise ValueError(f"duration={duration} s: every duration is above 0")
    ends_along = list(accumulate(duration for duration, _, _ in along))
    ends_across = list(accumulate(duration for duration, _ in across))
    times = sorted({Fraction(0), *ends_along, *ends_across})
    made: list[Piece] = []
    for time, end in zip(times, [*times[1:], None], strict=True):
        a_lon, j_lon, a_lat = (Fraction(0),) * 3
        place = sum(x <= time for x in ends_along)
        if place < len(along):
            duration, begun, j_lon = along[place]
            a_lon = begun + j_lon * (time - ends_along[place] + duration)
        place = sum(x <= time for x in ends_across)
        if place < len(across):
            a_lat = across[place][1]
        made.append(Piece(None if end is None else end - time, a_lon, a_lat, j_lon))
    return tuple(made)


def motion_of(
    box: tuple[Fraction, Fraction],
    place: tuple[Fraction, Fraction],
    speed: tuple[Fraction, Fraction],
    along: Sequence[Along],
    across: Sequence[Across] = (),
) -> Motion:
    """A motion from its box (length, width; m), its place (s, d; m) and speed (v_lon, v_lat; m/s) at time 0.

    ``along``, ``across``: as in ``pieces_of``. Raises ``ValueError`` as that does, and for an empty box.
    """
    return Motion(*box, *place, *speed, pieces_of(along, across))
