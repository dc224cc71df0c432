"""Positions of OpenSCENARIO in the road's coordinates s and d, and the lanes there.

A position on a road of the map is put into the plane and from there on the reference line of the road that
is driven on. Lanes to the left have greater numbers in relative positions (as seen in driving direction).
Actions of a vehicle that drives against the road are read in its own coordinates: s and d of the road turned
around (``sign`` -1), so that all of them mean the same as for the others.
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from roadproof.extensions.exchange.storyboard.document import Document
from roadproof.extensions.maps.carriageway import DRIVEN, RAMPS
from roadproof.extensions.maps.opendrive import MapRoad, MapSection, outer_edge, read_map, value_at
from roadproof.extensions.maps.selection import is_map, read_selection
from roadproof.runtime.records import dataclass
from roadproof.runtime.xml_reader import Element
from roadproof.world.road import Road
from roadproof.world.signals import RECORDED

_LANE = "LanePosition"


@dataclass(frozen=True)
class State:
    """Of a reference point: along and across the road; ``forward``: the vehicle drives along s."""

    s: float
    d: float
    v_lon: float
    v_lat: float
    a_lon: float
    a_lat: float
    forward: bool = True

    def turned(self) -> "State":
        """The same in the coordinates of those who drive against the road."""
        s, d, v_lon, v_lat, a_lon, a_lat = (-getattr(self, x) for x in RECORDED)
        return State(s, d, v_lon, v_lat, a_lon, a_lat, not self.forward)


States = Mapping[str, State]


def _position(place: Element) -> Element:
    """An element Position around a place."""
    found = Element("Position")
    found.append(place)
    return found


def is_turned(document: Document, place: Element) -> bool:
    """Whether an Orientation turns a vehicle against its lane."""
    orientation = place.find("Orientation")
    return orientation is not None and math.cos(document.number(orientation, "h", 0.0)) < 0


@dataclass(frozen=True)
class Positions:
    """Finds places on ``road``; ``roads``: those of its map by id. ``sign``: -1 for turned coordinates."""

    document: Document
    road: Road
    roads: Mapping[str, MapRoad]
    sign: int = 1

    def turned(self) -> "Positions":
        """The same for coordinates of those who drive against the road."""
        return replace(self, sign=-self.sign)

    def place(self, x: float, y: float) -> tuple[float, float]:
        """s and d of a point of the plane."""
        s, d = (x, y) if self.road.line is None else self.road.line.locate(x, y)
        return self.sign * s, self.sign * d

    def pose(self, node: Element, states: States) -> tuple[float, float, float]:
        """x, y and heading of an element Position in the plane: that of the road unless it is told."""
        place = self.document.only(node)
        s, d = self.find(node, states)
        along = math.pi if self.is_forward(place, states) != (self.sign > 0) else 0.0
        if self.road.line is None:
            return self.sign * s, self.sign * d, along
        x, y = self.road.line.place(self.sign * s, self.sign * d)
        told = place if place.tag == "WorldPosition" else place.find("Orientation")
        turn = 0.0 if told is None else self.document.number(told, "h", 0.0)
        if told is not None and (told.get("type") == "absolute" or (told is place and place.get("h"))):
            return x, y, turn
        turn -= math.pi if math.cos(turn) < 0 else 0.0  # which ``along`` says
        return x, y, self.road.line.pose(self.sign * s).heading + along + turn

    def pose_of(self, state: State) -> tuple[float, float, float]:
        """x, y and heading of a vehicle that is aligned with the road."""
        s, d = self.sign * state.s, self.sign * state.d
        along = 0.0 if state.forward == (self.sign > 0) else math.pi
        if self.road.line is None:
            return s, d, along
        return (*self.road.line.place(s, d), self.road.line.pose(s).heading + along)

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
            case "RoutePosition":
                return self._route_position(place, states)
        if not place.tag.startswith("Relative"):
            raise read.error(place, "this kind of position is not supported")
        other = states[read.text(place, "entityRef")]
        way = 1 if other.forward else -1
        match place.tag:
            case "RelativeLanePosition":
                ahead = read.number(place, "dsLane" if place.get("dsLane") else "ds", 0.0)
                s = other.s + way * ahead
                d = self.lane_beside(place, (s, other.d), way * round(read.number(place, "dLane")))
                return s, d + way * read.number(place, "offset", 0.0)
            case "RelativeRoadPosition":
                ahead, left = (read.number(place, x) * self._road_way(place, other) for x in ("ds", "dt"))
                return other.s + ahead, other.d + left
            case "RelativeObjectPosition":
                ahead, left = read.number(place, "dx"), read.number(place, "dy")
                if self.road.line is None:
                    return other.s + way * ahead, other.d + way * left
                x, y, heading = self.pose_of(other)
                c, s = math.cos(heading), math.sin(heading)
                return self.place(x + ahead * c - left * s, y + ahead * s + left * c)
            case "RelativeWorldPosition" if self.road.line is not None:
                x, y = self.road.line.place(self.sign * other.s, self.sign * other.d)
                return self.place(x + read.number(place, "dx"), y + read.number(place, "dy"))
        raise read.error(place, "this kind of position is not supported")

    def is_forward(self, place: Element, states: States) -> bool:
        """Whether a vehicle at a place, an element inside Position, drives along s in these coordinates."""
        orientation = place.find("Orientation")
        if orientation is not None and orientation.get("type") == "absolute" and self.road.line is not None:
            heading = self.document.number(orientation, "h", 0.0)
            here = self.find(_position(place), states)[0]
            return (math.cos(heading - self.road.line.pose(self.sign * here).heading) >= 0) == (self.sign > 0)
        turned = is_turned(self.document, place)
        if place.tag in (_LANE, "RoadPosition", "TrackPosition"):
            side = self.document.number(place, "laneId" if place.tag == _LANE else "t")
            road, s = self._road(place), self.document.number(place, "s")
            right = side < 0 if road.rule == "RHT" else side > 0
            if place.tag != _LANE and orientation is not None:  # relative to the s axis of the road
                right, side = True, 1.0
            return side == 0 or (right != turned) == (self._heading_sign(road, s) > 0)
        if place.tag.startswith("Relative"):
            return states[self.document.text(place, "entityRef")].forward != turned
        if place.tag == "WorldPosition" and place.get("h") and self.road.line is not None:
            s, _ = self.road.line.locate(self.document.number(place, "x"), self.document.number(place, "y"))
            heading = self.document.number(place, "h")
            return (math.cos(heading - self.road.line.pose(s).heading) >= 0) == (self.sign > 0)
        return self.sign > 0

    def _route_position(self, place: Element, states: States) -> tuple[float, float]:
        """A place so far behind the first waypoint, along the road."""
        read = self.document
        inside = read.only(read.child(place, "InRoutePosition"))
        if inside.tag == "FromCurrentEntity":
            other = states[read.text(inside, "entityRef")]
            return other.s, other.d
        first = next(place.iter("Waypoint"), None)
        if first is None or inside.tag not in ("FromLaneCoordinates", "FromRoadCoordinates"):
            raise read.error(inside, "a Waypoint and FromLaneCoordinates or FromRoadCoordinates are needed")
        begin, d = self.find(read.child(first, "Position"), states)
        ways = self.is_forward(read.only(read.child(first, "Position")), states)
        s = begin + (1 if ways else -1) * read.number(inside, "pathS")
        if inside.tag == "FromRoadCoordinates":
            return s, (1 if ways else -1) * read.number(inside, "t")
        d = self.lane_called(inside, (s, d), round(read.number(inside, "laneId")))
        return s, d + (1 if ways else -1) * read.number(inside, "laneOffset", 0.0)

    def lane_at(self, node: Element, at: tuple[float, float]) -> tuple[int, int]:
        """The number of the lane at a place, from the right and from 0 on, and how many there are."""
        middles = self._middles(node, at)
        if not middles:
            raise self.document.error(node, f"there is no lane at s={at[0]:.2f}")
        return min(range(len(middles)), key=lambda k: abs(middles[k] - at[1])), len(middles)

    def _middles(self, node: Element, at: tuple[float, float]) -> list[float]:
        """d of the middles of the lanes beside a place, from the right."""
        road, s = self._road_at(node, at)
        ids = [x.id for x in _section(road, s).lanes.values() if x.type in DRIVEN or x.type in RAMPS]
        return sorted(self._on_map(road, s, self._middle(node, road, s, x))[1] for x in ids)

    def lane_beside(self, node: Element, at: tuple[float, float], number: int) -> float:
        """d of the middle of the lane so many to the left of that at a place."""
        middles = self._middles(node, at)
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

    def is_off_road(self, at: tuple[float, float]) -> bool:
        """Whether a place is on no lane of the map."""
        if self.road.line is None or not self.roads:
            return False
        x, y = self.road.line.place(self.sign * at[0], self.sign * at[1])
        return not any(_has_lane(road, *road.line.locate(x, y)) for road in self.roads.values())

    def _road_at(self, node: Element, at: tuple[float, float]) -> tuple[MapRoad, float]:
        """The map's road at a place, and s there."""
        if self.road.line is None or not self.roads:
            raise self.document.error(node, "lanes need a map")
        x, y = self.road.line.place(self.sign * at[0], self.sign * at[1])
        nearest = min(self.roads.values(), key=lambda road: distance(road, x, y))
        return nearest, nearest.line.locate(x, y)[0]

    def _lane_position(self, place: Element) -> tuple[float, float]:
        read, road = self.document, self._road(place)
        s, lane = read.number(place, "s"), round(read.number(place, "laneId"))
        offset = read.number(place, "offset", 0.0)
        return self._on_map(road, s, self._middle(place, road, s, lane) + offset)

    def _road_way(self, node: Element, other: State) -> float:
        """1 where the map's road at a vehicle goes along s of these coordinates, else -1."""
        if self.road.line is None or not self.roads:
            return self.sign
        return self._heading_sign(*self._road_at(node, (other.s, other.d)))

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


def _has_lane(road: MapRoad, s: float, t: float) -> bool:
    """Whether a road has a lane of some kind at a place that is beside it."""
    if not road.line.begin <= s <= road.line.end:
        return False
    section = _section(road, s)
    ends = min(0, *section.lanes), max(0, *section.lanes)
    right, left = (float(outer_edge(road.offset, section, x, Fraction(s))) for x in ends)
    return right <= t <= left


def distance(road: MapRoad, x: float, y: float) -> float:
    """How far a point is from the reference line of a road, and much more beyond its ends."""
    s, t = road.line.locate(x, y)
    beyond = max(float(road.line.begin) - s, s - float(road.line.end), 0.0)
    return abs(t) + 100 * beyond
