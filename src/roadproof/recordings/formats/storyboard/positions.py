"""Positions of OpenSCENARIO in the road's coordinates s and d, and the lanes there.

A position on a road of the map is put into the plane and from there on the reference line of the road that
is driven on. Lanes to the left have greater numbers in relative positions (as seen in driving direction).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from roadproof.recordings.formats.storyboard.document import Document
from roadproof.runtime.xml_reader import Element
from roadproof.world.maps.opendrive import MapRoad, MapSection, read_map, value_at
from roadproof.world.maps.selection import STRETCH, is_map, read_selection
from roadproof.world.road import Road

_LANE = "LanePosition"


@dataclass(frozen=True)
class State:
    """Of a reference point: along and across the road."""

    s: float
    d: float
    v_lon: float
    v_lat: float
    a_lon: float
    a_lat: float


States = Mapping[str, State]


def stretch_of(document: Document, path: Path) -> str:
    """The road that is driven on: as a parameter says, or that of the lanes in which vehicles begin."""
    declared = next(
        (x.get("value") for x in document.root.iter("ParameterDeclaration") if x.get("name") == STRETCH), None
    )
    if declared:
        return f"{path}#{declared}"
    places = [*document.root.iter(_LANE)]
    roads = {document.text(x, "roadId") for x in places}
    sides = {document.number(x, "laneId") > 0 for x in places}
    if len(roads) > 1:
        shown = ", ".join(sorted(roads))
        rule = f"name the route as a parameter {STRETCH} with a value such as route=1+2"
        raise document.error(places[0], f"positions on several roads ({shown}); {rule}")
    if len(sides) > 1:
        raise document.error(places[0], "positions in lanes of both directions; one direction is supported")
    if not places:
        return str(path)
    (road,), (left,) = roads, sides
    return f"{path}#road={road},lanes={'left' if left else 'right'}"


@dataclass(frozen=True)
class Positions:
    """Finds places on ``road``; ``roads``: those of its map by id."""

    document: Document
    road: Road
    roads: Mapping[str, MapRoad]

    def place(self, x: float, y: float) -> tuple[float, float]:
        """s and d of a point of the plane."""
        return (x, y) if self.road.line is None else self.road.line.locate(x, y)

    def find(self, node: Element, states: States) -> tuple[float, float]:
        """s and d of an element Position, where vehicles are as ``states`` say. Raises ``InputError``.

        ``KeyError``: where a vehicle that it refers to has no place yet.
        """
        read, place = self.document, self.document.only(node)
        match place.tag:
            case "WorldPosition":
                return self.place(read.number(place, "x"), read.number(place, "y"))
            case "LanePosition":
                return self._lane_position(place)
            case "RoadPosition" | "TrackPosition":
                road = self._road(place)
                return self._on_map(road, read.number(place, "s"), read.number(place, "t"))
        if not place.tag.startswith("Relative"):
            raise read.error(place, "this kind of position is not supported")
        other = states[read.text(place, "entityRef")]
        match place.tag:
            case "RelativeLanePosition":
                ahead = read.number(place, "dsLane" if place.get("dsLane") else "ds")
                s = other.s + ahead
                d = self.lane_beside(place, (s, other.d), round(read.number(place, "dLane")))
                return s, d + read.number(place, "offset", 0.0)
            case "RelativeRoadPosition":
                return other.s + read.number(place, "ds"), other.d + read.number(place, "dt")
            case "RelativeObjectPosition":
                return other.s + read.number(place, "dx"), other.d + read.number(place, "dy")
        raise read.error(place, "this kind of position is not supported")

    def lane_beside(self, node: Element, at: tuple[float, float], number: int) -> float:
        """d of the middle of the lane so many to the left of that at a place."""
        bounds = sorted(
            (float(x.d[0]), float(x.d[1]))
            for x in self.road.lanelets
            if (x.s[0] is None or float(x.s[0]) <= at[0]) and (x.s[1] is None or at[0] <= float(x.s[1]))
        )
        bounds = [x for k, x in enumerate(bounds) if not k or x != bounds[k - 1]]
        here = [k for k, (right, left) in enumerate(bounds) if right <= at[1] <= left]
        if not here:
            raise self.document.error(node, f"there is no lane at s={at[0]:.2f}, d={at[1]:.2f}")
        if not 0 <= here[0] + number < len(bounds):
            side = "left" if number > 0 else "right"
            told = f"there is no lane {abs(number)} to the {side} at s={at[0]:.2f}, d={at[1]:.2f}"
            raise self.document.error(node, told)
        return sum(bounds[here[0] + number]) / 2

    def lane_called(self, node: Element, at: tuple[float, float], lane: int) -> float:
        """d of the middle of a lane of the map, beside a place of the road."""
        if self.road.line is None:
            raise self.document.error(node, "lanes with numbers need a map")
        x, y = self.road.line.place(*at)
        nearest = min(self.roads.values(), key=lambda road: _distance(road, x, y))
        s = nearest.line.locate(x, y)[0]
        return self._on_map(nearest, s, self._middle(node, nearest, s, lane))[1]

    def _lane_position(self, place: Element) -> tuple[float, float]:
        read, road = self.document, self._road(place)
        s, lane = read.number(place, "s"), round(read.number(place, "laneId"))
        side = math.copysign(1.0, lane) if self.road.line is None else self._heading_sign(road, s)
        offset = read.number(place, "offset", 0.0)
        middle = self._middle(place, road, s, lane)
        found = self._on_map(road, s, middle)
        return found[0], found[1] + offset * side

    def _heading_sign(self, road: MapRoad, s: float) -> float:
        """1 where the map's road goes the way that is driven, else -1."""
        one, other = self._on_map(road, s, 0.0), self._on_map(road, s, 1.0)
        return math.copysign(1.0, other[1] - one[1])

    def _middle(self, node: Element, road: MapRoad, s: float, lane: int) -> float:
        """t of the middle of a lane."""
        section = _section(road, s)
        if lane not in section.lanes:
            raise self.document.error(node, f"road {road.id} has no lane {lane} at s={s:.2f}")
        at = Fraction(s)
        sign = 1 if lane > 0 else -1
        widths = [value_at(section.lanes[sign * k].width, at) for k in range(1, abs(lane) + 1)]
        outwards = sum(widths[:-1], Fraction(0)) + widths[-1] / 2
        return float(value_at(road.offset, at) + sign * outwards)

    def _road(self, place: Element) -> MapRoad:
        name = self.document.text(place, "roadId")
        if name not in self.roads:
            raise self.document.error(place, f"road {name} is none of those that are driven on")
        return self.roads[name]

    def _on_map(self, road: MapRoad, s: float, t: float) -> tuple[float, float]:
        return self.place(*road.line.place(s, t))


def positions_on(document: Document, road: Road) -> Positions:
    """For a road of a map: with the roads that it consists of."""
    if road.map is None or not is_map(road.map):
        return Positions(document, road, {})
    path, selection = read_selection(road.map)
    known = {x.id: x for x in read_map(path)}
    return Positions(document, road, {x: known[x] for x in selection.roads or known})


def _section(road: MapRoad, s: float) -> MapSection:
    return next((x for x in reversed(road.sections) if x.begin <= s), road.sections[0])


def _distance(road: MapRoad, x: float, y: float) -> float:
    s, t = road.line.locate(x, y)
    beyond = max(float(road.line.begin) - s, s - float(road.line.end), 0.0)
    return abs(t) + 100 * beyond
