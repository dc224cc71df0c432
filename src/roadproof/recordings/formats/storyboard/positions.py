"""Positions of OpenSCENARIO in the road's coordinates s and d, and the lanes there.

A position on a road of the map is put into the plane and from there on the reference line of the road that
is driven on. Lanes to the left have greater numbers in relative positions (as seen in driving direction).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import permutations
from pathlib import Path

from roadproof.errors import InputError
from roadproof.recordings.formats.storyboard.document import Document
from roadproof.runtime.xml_reader import Element
from roadproof.world.maps.carriageway import DRIVEN, RAMPS
from roadproof.world.maps.opendrive import MapRoad, MapSection, outer_edge, read_map, value_at
from roadproof.world.maps.selection import STRETCH, is_map, read_selection
from roadproof.world.models import load_road
from roadproof.world.road import Road

_LANE = "LanePosition"
_MOST_ROADS = 4
"""Of so many roads the order is found."""


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
    places = document.root.findall(f"Storyboard/Init//{_LANE}") or [*document.root.iter(_LANE)]
    if not places:
        return str(path)
    roads = {document.text(x, "roadId") for x in places}
    if len(roads) > 1:
        return _route(document, path, sorted(roads), places[0])
    left = (document.number(places[0], "laneId") > 0) != _turned(document, places[0])
    return f"{path}#road={roads.pop()},lanes={'left' if left else 'right'}"


def _route(document: Document, path: Path, roads: list[str], place: Element) -> str:
    """The roads in the order in which the vehicle at ``place`` drives on them. Raises ``InputError``."""
    for order in permutations(roads) if len(roads) <= _MOST_ROADS else ():
        route = f"{path}#route={'+'.join(order)}"
        try:
            found = positions_on(document, load_road(route))
            found.check_direction(place)
        except InputError:
            continue
        return route
    shown = ", ".join(roads)
    rule = f"name the route as a parameter {STRETCH} with a value such as route=1+2"
    raise document.error(place, f"positions on several roads ({shown}) that are not one route; {rule}")


def _turned(document: Document, place: Element) -> bool:
    """Whether an Orientation turns a vehicle against its lane."""
    orientation = place.find("Orientation")
    return orientation is not None and math.cos(document.number(orientation, "h", 0.0)) < 0


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

    def check_direction(self, place: Element) -> None:
        """Raise ``InputError`` where a vehicle with this kind of position would drive against the road."""
        against = False
        if place.tag == _LANE and self.document.text(place, "laneId") != "0":
            road, s = self._road(place), self.document.number(place, "s")
            side = -1 if road.rule == "RHT" else 1
            forward = self.document.number(place, "laneId") * side > 0
            against = (forward != _turned(self.document, place)) != (self._heading_sign(road, s) > 0)
        elif place.tag == "WorldPosition" and place.get("h") and self.road.line is not None:
            s, _ = self.place(self.document.number(place, "x"), self.document.number(place, "y"))
            against = math.cos(self.document.number(place, "h") - self.road.line.pose(s).heading) < 0
        if against:
            raise self.document.error(
                place, "a vehicle drives against the others; one direction is supported"
            )

    def lane_beside(self, node: Element, at: tuple[float, float], number: int) -> float:
        """d of the middle of the lane so many to the left of that at a place."""
        road, s = self._road_at(node, at)
        ids = [x.id for x in _section(road, s).lanes.values() if x.type in DRIVEN or x.type in RAMPS]
        middles = sorted(self._on_map(road, s, self._middle(node, road, s, x))[1] for x in ids)
        here = min(range(len(middles)), key=lambda k: abs(middles[k] - at[1]), default=None)
        if here is None or not 0 <= here + number < len(middles):
            side = "left" if number > 0 else "right"
            told = f"there is no lane {abs(number)} to the {side} at s={at[0]:.2f}, d={at[1]:.2f}"
            raise self.document.error(node, told)
        return middles[here + number]

    def lane_called(self, node: Element, at: tuple[float, float], lane: int) -> float:
        """d of the middle of a lane of the map, beside a place of the road."""
        road, s = self._road_at(node, at)
        return self._on_map(road, s, self._middle(node, road, s, lane))[1]

    def _road_at(self, node: Element, at: tuple[float, float]) -> tuple[MapRoad, float]:
        """The map's road at a place, and s there."""
        if self.road.line is None or not self.roads:
            raise self.document.error(node, "lanes need a map")
        x, y = self.road.line.place(*at)
        nearest = min(self.roads.values(), key=lambda road: _distance(road, x, y))
        return nearest, nearest.line.locate(x, y)[0]

    def _lane_position(self, place: Element) -> tuple[float, float]:
        read, road = self.document, self._road(place)
        s, lane = read.number(place, "s"), round(read.number(place, "laneId"))
        offset = read.number(place, "offset", 0.0)
        return self._on_map(road, s, self._middle(place, road, s, lane) + offset)

    def _heading_sign(self, road: MapRoad, s: float) -> float:
        """1 where the map's road goes the way that is driven, else -1."""
        one, other = self._on_map(road, s, 0.0), self._on_map(road, s, 1.0)
        return math.copysign(1.0, other[1] - one[1])

    def _middle(self, node: Element, road: MapRoad, s: float, lane: int) -> float:
        """t of the middle of a lane."""
        section, at = _section(road, s), Fraction(s)
        if lane == 0:
            return float(value_at(road.offset, at))
        if lane not in section.lanes:
            raise self.document.error(node, f"road {road.id} has no lane {lane} at s={s:.2f}")
        inner = lane - 1 if lane > 0 else lane + 1
        return float(sum(outer_edge(road.offset, section, x, at) for x in (inner, lane)) / 2)

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
    known = {x.id: x for x in read_map(path).roads}
    return Positions(document, road, {x: known[x] for x in selection.roads or known})


def _section(road: MapRoad, s: float) -> MapSection:
    return next((x for x in reversed(road.sections) if x.begin <= s), road.sections[0])


def _distance(road: MapRoad, x: float, y: float) -> float:
    s, t = road.line.locate(x, y)
    beyond = max(float(road.line.begin) - s, s - float(road.line.end), 0.0)
    return abs(t) + 100 * beyond
