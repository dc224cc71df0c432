"""A synthesised drive: rational initial states, and accelerations and jerks in pieces, rational too.

Along the road the jerk is constant on each piece, across it the acceleration is. At a knot acceleration and
jerk are those of the piece which begins there, so an acceleration may jump; the last piece lasts for ever.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeAlias

from roadproof.world.signals import Kind

# Values that are constant from one start to the next.
Course: TypeAlias = tuple[tuple[Fraction, Fraction], ...]


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
