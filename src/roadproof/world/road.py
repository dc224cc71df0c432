"""Roads of lanelets, which are rectangles in s and d (semantics §4; paper, appendix *Road Network*).

Coordinates: s along the road in driving direction, d across it to the left, in metres. They are those of a
straight road, or follow a reference line in the plane.
"""

from collections.abc import Iterable
from dataclasses import field
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.runtime.records import dataclass
from roadproof.world.reference_line import ReferenceLine

Zone: TypeAlias = Literal["main", "merge", "depart"]
Attribute: TypeAlias = Literal["main", "merge", "departure"]


@dataclass(frozen=True)
class Lanelet:
    """[s_low, s_high] × [d_right, d_left]; None in ``s`` is without bound."""

    id: str
    lane: str
    zone: Zone
    attribute: Attribute
    s: tuple[Fraction | None, Fraction | None]
    d: tuple[Fraction, Fraction]


@dataclass(frozen=True)
class Road:
    """Lanelets and which lanes lie side by side (unordered pairs).

    ``line`` None: the road is straight, with s and d as coordinates of the plane. ``map``: the map that it is
    from, and which stretch of it. ``unread``: kinds of parts of the map that were not read.
    """

    name: str
    lanelets: tuple[Lanelet, ...]
    adjacent: frozenset[frozenset[str]]
    line: ReferenceLine | None = None
    map: str | None = None
    unread: tuple[str, ...] = field(default=(), compare=False)

    def __repr__(self) -> str:
        """The same in every process, as answers are kept under fingerprints of what was asked."""
        beside = sorted(sorted(pair) for pair in self.adjacent)
        line = "" if self.line is None else f", line={self.line!r}, map={self.map!r}"
        return f"Road(name={self.name!r}, lanelets={self.lanelets!r}, adjacent={beside!r}{line})"

    @property
    def lanes(self) -> tuple[str, ...]:
        """Names of the lanes, in the order of their lanelets."""
        return tuple(dict.fromkeys(lanelet.lane for lanelet in self.lanelets))

    def lanelets_of(self, lane: str) -> tuple[Lanelet, ...]:
        return tuple(x for x in self.lanelets if x.lane == lane)

    def lanelets_in(self, zone: str) -> tuple[Lanelet, ...]:
        return tuple(x for x in self.lanelets if x.zone == zone)

    def beside(self, lane: str) -> tuple[str, ...]:
        """adjLanes(lane), in the order of ``lanes``."""
        return tuple(x for x in self.lanes if x != lane and frozenset((x, lane)) in self.adjacent)


def pairs(names: Iterable[tuple[str, str]]) -> frozenset[frozenset[str]]:
    """Adjacent lanes as ``Road`` wants them."""
    return frozenset(frozenset(pair) for pair in names)
