"""Drives with rational initial states, and rational accelerations and jerks in pieces.

Along the road the jerk is constant on each piece, across it the acceleration is. At a knot, acceleration and
jerk are those of the piece that begins there, so an acceleration may jump; the last piece lasts for ever.
"""

from bisect import bisect_right
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field, replace
from fractions import Fraction
from itertools import accumulate
from typing import TypeAlias

from roadproof.runtime.records import dataclass
from roadproof.world.signals import Kind

# A step function of time: pairs of a start (s) and the value from then on.
Course: TypeAlias = tuple[tuple[Fraction, Fraction], ...]
# Motion along the road: duration (s), acceleration at its start (m/s²), jerk (m/s³).
Along: TypeAlias = tuple[Fraction, Fraction, Fraction]
# Motion across the road: duration (s), acceleration (m/s²).
Across: TypeAlias = tuple[Fraction, Fraction]

FAR = Fraction(2000)
"""The distance in metres of an unconstrained vehicle behind all others."""


def value_at(course: Course, time: Fraction) -> Fraction:
    """Return the value of a custom signal at ``time`` >= 0."""
    return max((start, value) for start, value in course if start <= time)[1]


@dataclass(frozen=True)
class Piece:
    """Accelerations in m/s² for ``duration`` seconds; None is for ever (the last piece).

    ``a_lon`` is the value at the start of the piece, and grows by ``j_lon`` (m/s³); ``a_lat`` is constant.
    """

    duration: Fraction | None
    a_lon: Fraction
    a_lat: Fraction
    j_lon: Fraction = Fraction(0)


@dataclass(frozen=True)
class Motion:
    """The motion of one vehicle: its box (m), state at time 0 (m, m/s; front-left corner), and pieces.

    ``kind``: None if it is unknown.
    """

    length: Fraction
    width: Fraction
    s: Fraction
    d: Fraction
    v_lon: Fraction
    v_lat: Fraction
    pieces: tuple[Piece, ...]
    kind: Kind | None = None

    def __post_init__(self) -> None:
        if self.length <= 0 or self.width <= 0:
            raise ValueError(f"a box needs length={self.length} > 0 and width={self.width} > 0")
        *before, last = self.pieces or (None,)
        if last is None or last.duration is not None:
            raise ValueError("the last piece must last for ever: duration None")
        if any(p is None or p.duration is None or p.duration <= 0 for p in before):
            raise ValueError("every piece but the last needs a duration > 0")
        if last.j_lon != 0:
            raise ValueError(
                f"the last piece has j_lon={last.j_lon} m/s^3, but it lasts for ever, and no acceleration "
                "grows for ever: give it a duration, and let a piece with j_lon=0 follow"
            )

    @property
    def has_jerk(self) -> bool:
        """Return whether the acceleration changes inside a piece."""
        return any(piece.j_lon != 0 for piece in self.pieces)


@dataclass(frozen=True)
class Drive:
    """The motions of all vehicles by name, on one clock.

    ``custom_signals``: values by name and vehicle ('' for none): pairs of a start time and the value from
    then on (SI; 0 and 1 are false and true). The first start is 0; the last value holds for ever.
    """

    vehicles: Mapping[str, Motion]
    custom_signals: Mapping[tuple[str, str], Course] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for (name, vehicle), course in self.custom_signals.items():
            starts = [start for start, _ in course]
            if not starts or starts[0] != 0 or starts != sorted(set(starts)):
                raise ValueError(f"the values of {name} {vehicle}: their times must ascend from 0")
            if vehicle and vehicle not in self.vehicles:
                raise ValueError(f"{name} is said of {vehicle}, which the drive does not have")

    def cast(self, roles: Mapping[str, str]) -> "Drive":
        """Return the drive with other names: ``roles`` maps each new name to the vehicle that gets it."""
        signals = self.custom_signals.items()
        renamed = {(name, ""): course for (name, vehicle), course in signals if not vehicle}
        for new, old in roles.items():
            renamed |= {(name, new): course for (name, vehicle), course in signals if vehicle == old}
        return Drive({new: self.vehicles[old] for new, old in roles.items()}, renamed)

    def followed_by(self, names: Iterable[str]) -> "Drive":
        """Return the drive with further vehicles, each far behind the last one and moving as it does."""
        vehicles, roles = dict(self.vehicles), {name: name for name in self.vehicles}
        for name in names:
            last = min(vehicles, key=lambda known: vehicles[known].s)
            vehicles[name] = replace(vehicles[last], s=vehicles[last].s - FAR)
            roles[name] = roles[last]
        return Drive(vehicles, self.cast(roles).custom_signals)


def pieces_of(along: Sequence[Along], across: Sequence[Across] = ()) -> tuple[Piece, ...]:
    """Return the pieces of a motion from accelerations along and across the road, which end in 0.

    Accelerations may jump from one entry to the next. Raises ``ValueError`` for a duration that is not > 0.
    """
    for duration in (entry[0] for entry in (*along, *across)):
        if duration <= 0:
            raise ValueError(f"duration={duration} s: every duration is above 0")
    ends_along = list(accumulate(duration for duration, _, _ in along))
    ends_across = list(accumulate(duration for duration, _ in across))
    times = sorted({Fraction(0), *ends_along, *ends_across})
    pieces: list[Piece] = []
    for time, end in zip(times, [*times[1:], None], strict=True):
        a_lon, j_lon, a_lat = (Fraction(0),) * 3
        place = bisect_right(ends_along, time)
        if place < len(along):
            duration, initial, j_lon = along[place]
            a_lon = initial + j_lon * (time - ends_along[place] + duration)
        place = bisect_right(ends_across, time)
        if place < len(across):
            a_lat = across[place][1]
        pieces.append(Piece(None if end is None else end - time, a_lon, a_lat, j_lon))
    return tuple(pieces)


def motion_of(
    box: tuple[Fraction, Fraction],
    place: tuple[Fraction, Fraction],
    speed: tuple[Fraction, Fraction],
    along: Sequence[Along],
    across: Sequence[Across] = (),
) -> Motion:
    """Return a motion.

    Args:
        box: Length and width in m.
        place: s and d at time 0, in m.
        speed: v_lon and v_lat at time 0, in m/s.
        along, across: As in ``pieces_of``, which may raise ``ValueError``; so does an empty box.
    """
    return Motion(*box, *place, *speed, pieces_of(along, across))
