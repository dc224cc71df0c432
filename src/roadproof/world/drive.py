"""A synthesised drive: rational initial states, and accelerations and jerks in pieces, rational too.

Along the road the jerk is constant on each piece, across it the acceleration is. At a knot acceleration and
jerk are those of the piece which begins there, so an acceleration may jump; the last piece lasts for ever.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field, replace
from fractions import Fraction
from itertools import accumulate
from typing import TypeAlias

from roadproof.runtime.records import dataclass
from roadproof.world.signals import Kind

# Values that are constant from one start to the next.
Course: TypeAlias = tuple[tuple[Fraction, Fraction], ...]
# Duration (s), acceleration at its start (m/s²), jerk (m/s³).
Along: TypeAlias = tuple[Fraction, Fraction, Fraction]
# Duration (s), acceleration (m/s²).
Across: TypeAlias = tuple[Fraction, Fraction]

FAR = Fraction(2000)
"""So many metres behind all others is a vehicle that nothing is said of."""


def value_at(course: Course, time: Fraction) -> Fraction:
    """What an own signal is at ``time`` >= 0."""
    return max((start, value) for start, value in course if start <= time)[1]


@dataclass(frozen=True)
class Piece:
    """Accelerations in m/s² for ``duration`` seconds; None is for ever (the last piece).

    ``a_lon`` is that at the start of the piece, and grows by ``j_lon`` (m/s³); ``a_lat`` is constant.
    """

    duration: Fraction | None
    a_lon: Fraction
    a_lat: Fraction
    j_lon: Fraction = Fraction(0)


@dataclass(frozen=True)
class Motion:
    """One vehicle: its box in m, its state at time 0 (m, m/s; front-left corner), and its pieces.

    ``kind`` None: nothing says what it is.
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
        """Whether the acceleration is not constant on some piece."""
        return any(piece.j_lon != 0 for piece in self.pieces)


@dataclass(frozen=True)
class Drive:
    """The motions of all vehicles by name, on one clock.

    ``own``: the courses of own signals by name and vehicle ('' for none), each a value from every start on
    (SI; 0 and 1 are false and true), the first at 0, the last for ever.
    """

    vehicles: Mapping[str, Motion]
    own: Mapping[tuple[str, str], Course] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for (name, vehicle), course in self.own.items():
            starts = [start for start, _ in course]
            if not starts or starts[0] != 0 or starts != sorted(set(starts)):
                raise ValueError(f"the values of {name} {vehicle}: their times must ascend from 0")
            if vehicle and vehicle not in self.vehicles:
                raise ValueError(f"{name} is said of {vehicle}, which the drive does not have")

    def cast(self, roles: Mapping[str, str]) -> "Drive":
        """The drive with other names: for each new one the vehicle that has it, with its own signals."""
        own = {(name, ""): course for (name, vehicle), course in self.own.items() if not vehicle}
        for new, old in roles.items():
            own |= {(name, new): course for (name, vehicle), course in self.own.items() if vehicle == old}
        return Drive({new: self.vehicles[old] for new, old in roles.items()}, own)

    def followed_by(self, names: Iterable[str]) -> "Drive":
        """The drive with further vehicles, each of which moves as the last one does, far behind it."""
        vehicles, roles = dict(self.vehicles), {name: name for name in self.vehicles}
        for name in names:
            last = min(vehicles, key=lambda known: vehicles[known].s)
            vehicles[name] = replace(vehicles[last], s=vehicles[last].s - FAR)
            roles[name] = roles[last]
        return Drive(vehicles, self.cast(roles).own)


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
