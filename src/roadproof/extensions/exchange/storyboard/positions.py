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
from roadproof.extensions.maps.xml_reader import Element
from roadproof.runtime.records import dataclass
from roadproof.world.road import Road
from roadproof.world.signals import RECORDED

_LANE = "LanePosition"


@dataclass(frozen=True)
class ObjectState:
    """The state of a reference point along and across the road; ``forward``: the vehicle drives along s."""

    s: float
    d: float
    v_lon: float
    v_lat: float
    a_lon: float
    a_lat: float
    forward: bool = True

    def in_opposite_direction(self) -> "ObjectState":
        """Return the state in coordinates against the direction of the road."""
        s, d, v_lon, v_lat, a_lon, a_lat = (-getattr(self, x) for x in RECORDED)
        return ObjectState(s, d, v_lon, v_lat, a_lon, a_lat, not self.forward)


States = Mapping[str, ObjectState]


def _position(place: Element) -> Element:
    """An element Position around a place."""
    position = Element("Position")
    position.append(place)
    return position


def is_turned_back(document: Document, place: Element) -> bool:
    """Return whether an Orientation turns a vehicle against its lane."""
    orientation = place.find("Orientation")
    return orientation is not None and math.cos(document.number(orientation, "h", 0.0)) < 0


@dataclass(frozen=True)
class Positions:
    """Finds places on ``road``; ``roads``: those of its map by id. ``sign``: -1 for turned coordinates."""

    document: Document
    road: Road
    roads: Mapping[str, MapRoad]
    sign: int = 1

    def in_opposite_direction(self) -> "Positions":
        """Return the positions in coordinates against the direction of the road."""
        return replace(self, sign=-self.sign)

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Return s and d of a point of the plane."""
        s, d = (x, y) if self.road.line is None else self.road.line.locate(x, y)
        return self.sign * s, self.sign * d

    def pose(self, node: Element, states: States) -> tuple[float, float, float]:
        """Return x, y and heading of an element Position; without a heading, that of the road."""
        place = self.document.only(node)
        s, d = self.find(node, states)
        along = math.pi if self.is_forward(place, states) != (self.sign > 0) else 0.0
        if self.road.line is None:
            return self.sign * s, self.sign * d, along
        x, y = self.road.line.place(self.sign * s, self.sign * d)
        orientation = place if place.tag == "WorldPosition" else place.find("Orientation")
        turn = 0.0 if orientation is None else self.document.number(orientation, "h", 0.0)
        if orientation is not None and (
            orientation.get("type") == "absolute" or (orientation is place and place.get("h"))
        ):
            return x, y, turn
        turn -= math.pi if math.cos(turn) < 0 else 0.0  # which ``along`` says
        return x, y, self.road.line.pose(self.sign * s).heading + along + turn

    def pose_of(self, state: ObjectState) -> tuple[float, float, float]:
        """Return x, y and heading of a vehicle that is aligned with the road."""
        s, d = self.sign * state.s, self.sign * state.d
        along = 0.0 if state.forward == (self.sign > 0) else math.pi
        if self.road.line is None:
            return s, d, along
        return (*self.road.line.place(s, d), self.road.line.pose(s).heading + along)

    def find(self, node: Element, states: States) -> tuple[float, float]:
        """Return s and d of an element Position, with vehicles as in ``states``. Raises ``InputError``.

        ``KeyError``: where a vehicle that it refers to has no place yet.
        """
        document, place = self.document, self.document.only(node)
        match place.tag:
            case "WorldPosition":
                return self.place(document.number(place, "x"), document.number(place, "y"))
            case "LanePosition":
                return self._lane_position(place)
            case "RoadPosition" | "TrackPosition":
                road = self._road(place)
                return self._on_map(road, document.number(place, "s"), document.number(place, "t"))
            case "RoutePosition":
                return self._route_position(place, states)
        if not place.tag.startswith("Relative"):
            raise document.error(place, "this kind of position is not supported")
        other = states[document.text(place, "entityRef")]
        way = 1 if other.forward else -1
        match place.tag:
            case "RelativeLanePosition":
                ahead = document.number(place, "dsLane" if place.get("dsLane") else "ds", 0.0)
                s = other.s + way * ahead
                d = self.lane_beside(place, (s, other.d), way * round(document.number(place, "dLane")))
                return s, d + way * document.number(place, "offset", 0.0)
            case "RelativeRoadPosition":
                ahead, left = (document.number(place, x) * self._road_way(place, other) for x in ("ds", "dt"))
                return other.s + ahead, other.d + left
            case "RelativeObjectPosition":
                ahead, left = document.number(place, "dx"), document.number(place, "dy")
                if self.road.line is None:
                    return other.s + way * ahead, other.d + way * left
                x, y, heading = self.pose_of(other)
                c, s = math.cos(heading), math.sin(heading)
                return self.place(x + ahead * c - left * s, y + ahead * s + left * c)
            case "RelativeWorldPosition" if self.road.line is not None:
                x, y = self.road.line.place(self.sign * other.s, self.sign * other.d)
                return self.place(x + document.number(place, "dx"), y + document.number(place, "dy"))
        raise document.error(place, "this kind of position is not supported")

    def is_forward(self, place: Element, states: States) -> bool:
        """Return whether a vehicle at a place, an element inside Position, drives along s in these
        coordinates.
        """
        orientation = place.find("Orientation")
        if orientation is not None and orientation.get("type") == "absolute" and self.road.line is not None:
            heading = self.document.number(orientation, "h", 0.0)
            here = self.find(_position(place), states)[0]
            return (math.cos(heading - self.road.line.pose(self.sign * here).heading) >= 0) == (self.sign > 0)
        against = is_turned_back(self.document, place)
        if place.tag in (_LANE, "RoadPosition", "TrackPosition"):
            side = self.document.number(place, "laneId" if place.tag == _LANE else "t")
            road, s = self._road(place), self.document.number(place, "s")
            right = side < 0 if road.rule == "RHT" else side > 0
            if place.tag != _LANE and orientation is not None:  # relative to the s axis of the road
                right, side = True, 1.0
            return side == 0 or (right != against) == (self._heading_sign(road, s) > 0)
        if place.tag.startswith("Relative"):
            return states[self.document.text(place, "entityRef")].forward != against
        if place.tag == "WorldPosition" and place.get("h") and self.road.line is not None:
            s, _ = self.road.line.locate(self.document.number(place, "x"), self.document.number(place, "y"))
            heading = self.document.number(place, "h")
            return (math.cos(heading - self.road.line.pose(s).heading) >= 0) == (self.sign > 0)
        return self.sign > 0

    def _route_position(self, place: Element, states: States) -> tuple[float, float]:
        """A place so far behind the first waypoint, along the road."""
        document = self.document
        inside = document.only(document.child(place, "InRoutePosition"))
        if inside.tag == "FromCurrentEntity":
            other = states[document.text(inside, "entityRef")]
            return other.s, other.d
        first = next(place.iter("Waypoint"), None)
        if first is None or inside.tag not in ("FromLaneCoordinates", "FromRoadCoordinates"):
            raise document.error(
                inside, "a Waypoint and FromLaneCoordinates or FromRoadCoordinates are needed"
            )
        begin, d = self.find(document.child(first, "Position"), states)
        ways = self.is_forward(document.only(document.child(first, "Position")), states)
        s = begin + (1 if ways else -1) * document.number(inside, "pathS")
        if inside.tag == "FromRoadCoordinates":
            return s, (1 if ways else -1) * document.number(inside, "t")
        d = self.lane_called(inside, (s, d), round(document.number(inside, "laneId")))
        return s, d + (1 if ways else -1) * document.number(inside, "laneOffset", 0.0)

    def lane_at(self, node: Element, at: tuple[float, float]) -> tuple[int, int]:
        """The number of the lane at a place, from the right and from 0 on, and how many there are."""
        middles = self._middles(node, at)
        if not middles:
            raise self.document.error(node, f"there is no lane at s={at[0]:.2f}")
        return min(range(len(middles)), key=lambda k: abs(middles[k] - at[1])), len(middles)

    def _middles(self, node: Element, at: tuple[float, float]) -> list[float]:
        """Return d of the middles of the lanes beside a place, from the right."""
        road, s = self._road_at(node, at)
        ids = [x.id for x in _section(road, s).lanes.values() if x.type in DRIVEN or x.type in RAMPS]
        return sorted(self._on_map(road, s, self._middle(node, road, s, x))[1] for x in ids)

    def lane_beside(self, node: Element, at: tuple[float, float], number: int) -> float:
        """Return d of the middle of the lane that is ``number`` lanes to the left of a place."""
        middles = self._middles(node, at)
        here = min(range(len(middles)), key=lambda k: abs(middles[k] - at[1]), default=None)
        if here is None or not 0 <= here + number < len(middles):
            side = "left" if number > 0 else "right"
            problem = f"there is no lane {abs(number)} to the {side} at s={at[0]:.2f}, d={at[1]:.2f}"
            raise self.document.error(node, problem)
        return middles[here + number]

    def lane_called(self, node: Element, at: tuple[float, float], lane: int) -> float:
        """Return d of the middle of a lane of the map, beside a place of the road."""
        road, s = self._road_at(node, at)
        return self._on_map(road, s, self._middle(node, road, s, lane))[1]

    def is_off_road(self, at: tuple[float, float]) -> bool:
        """Return whether a place is on no lane of the map."""
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
        document, road = self.document, self._road(place)
        s, lane = document.number(place, "s"), round(document.number(place, "laneId"))
        offset = document.number(place, "offset", 0.0)
        return self._on_map(road, s, self._middle(place, road, s, lane) + offset)

    def _road_way(self, node: Element, other: ObjectState) -> float:
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
    """Return the positions on a road; for a road of a map, with the roads that it consists of."""
    if road.map is None or not is_map(road.map):
        return Positions(document, road, {})
    path, selection = read_selection(road.map)
    known = {x.id: x for x in read_map(path).roads}
    return Positions(document, road, {x: known[x] for x in selection.roads or known})


def _section(road: MapRoad, s: float) -> MapSection:
    return next((x for x in reversed(road.sections) if x.begin <= s), road.sections[0])


def _has_lane(road: MapRoad, s: float, t: float) -> bool:
    """Return whether a road has a lane of some kind at a place that is beside it."""
    if not road.line.begin <= s <= road.line.end:
        return False
    section = _section(road, s)
    ends = min(0, *section.lanes), max(0, *section.lanes)
    right, left = (float(outer_edge(road.offset, section, x, Fraction(s))) for x in ends)
    return right <= t <= left


def distance(road: MapRoad, x: float, y: float) -> float:
    """Return how far a point is from the reference line of a road, and much more beyond its ends."""
    s, t = road.line.locate(x, y)
    beyond = max(float(road.line.begin) - s, s - float(road.line.end), 0.0)
    return abs(t) + 100 * beyond
