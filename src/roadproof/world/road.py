"""Roads of lanelets, which are rectangles in s and d (semantics §4; paper, appendix *Road Network*).

Coordinates: s along the road in driving direction, d across it to the left, in metres. They belong to a
straight road, or follow a reference line in the plane.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import field
from fractions import Fraction
from typing import TYPE_CHECKING, Literal, TypeAlias

from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.world.reference_line import ReferenceLine

Zone: TypeAlias = Literal["main", "merge", "depart"]
Attribute: TypeAlias = Literal["main", "merge", "departure"]


@dataclass(frozen=True)
class Lanelet:
    """The rectangle [s_low, s_high] × [d_right, d_left]; None in ``s`` is unbounded."""

    id: str
    lane: str
    zone: Zone
    attribute: Attribute
    s: tuple[Fraction | None, Fraction | None]
    d: tuple[Fraction, Fraction]


@dataclass(frozen=True)
class Road:
    """Lanelets, and the unordered pairs of adjacent lanes.

    ``line`` None: the road is straight, and s and d are coordinates of the plane. ``map``: the source map,
    and the stretch of it. ``unread``: kinds of parts of the map that were not read.
    """

    name: str
    lanelets: tuple[Lanelet, ...]
    adjacent: frozenset[frozenset[str]]
    line: ReferenceLine | None = None
    map: str | None = None
    unread: tuple[str, ...] = field(default=(), compare=False)

    def __repr__(self) -> str:
        """Return a text that is the same in every process, since fingerprints of answers contain it."""
        beside = sorted(sorted(pair) for pair in self.adjacent)
        line = "" if self.line is None else f", line={self.line!r}, map={self.map!r}"
        return f"Road(name={self.name!r}, lanelets={self.lanelets!r}, adjacent={beside!r}{line})"

    @property
    def lanes(self) -> tuple[str, ...]:
        """The names of the lanes, in the order of their lanelets."""
        return tuple(dict.fromkeys(lanelet.lane for lanelet in self.lanelets))

    def lanelets_of(self, lane: str) -> tuple[Lanelet, ...]:
        return tuple(x for x in self.lanelets if x.lane == lane)

    def lanelets_in(self, zone: str) -> tuple[Lanelet, ...]:
        return tuple(x for x in self.lanelets if x.zone == zone)

    def adjacent_lanes(self, lane: str) -> tuple[str, ...]:
        """Return the adjacent lanes, adjLanes(lane), in the order of ``lanes``."""
        return tuple(x for x in self.lanes if x != lane and frozenset((x, lane)) in self.adjacent)


def adjacency(names: Iterable[tuple[str, str]]) -> frozenset[frozenset[str]]:
    """Return adjacent lanes in the form that ``Road`` requires."""
    return frozenset(frozenset(pair) for pair in names)
