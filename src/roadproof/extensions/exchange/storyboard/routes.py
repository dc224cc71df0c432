"""The road or the route of a map on which the vehicles of a storyboard drive.

A parameter ``roadproof_stretch`` says it. Otherwise it is the road on which the vehicles begin, or the route
of the fewest roads, joined by their links, that has all of these roads. Where a vehicle comes to its end, it
goes on in the road that its links lead to, at a junction in the straightest one.
"""

import math
from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.exchange.storyboard.document import Document
from roadproof.extensions.exchange.storyboard.positions import distance, is_turned_back, positions_on
from roadproof.extensions.maps.carriageway import DirectedRoad, driven_lanes
from roadproof.extensions.maps.opendrive import MapRoad, RoadLink, read_map
from roadproof.extensions.maps.selection import LANELETS, STRETCH, directed, read_selection
from roadproof.extensions.maps.xml_reader import Element
from roadproof.world.models import load_road

_MOST_STEPS = 5000
"""So many routes are looked at."""
_LONGEST = 20
"""Roads of a route."""


def stretch_of(document: Document, path: Path) -> str:
    """The road that is driven on, as ``--road`` takes it. Raises ``InputError``."""
    declared = next(
        (x.get("value") for x in document.root.iter("ParameterDeclaration") if x.get("name") == STRETCH), None
    )
    if declared:
        return f"{path}#{declared}"
    places = [*_begins(document)]
    if not places:
        return str(path)
    roads = {x.id: x for x in read_map(path).roads}
    start_places: dict[str, Element] = {}
    for place in places:
        name = _road_of(document, place, roads)
        if name is not None:
            start_places.setdefault(name, place)
    if not start_places:
        return str(path)
    first = next(iter(start_places.values()))
    if len(start_places) == 1:
        (name,) = start_places
        return _single(document, path, name, first) if name in roads else f"{path}#road={name}"
    return _route(document, path, roads, start_places)


def extended_stretch(stretch: str) -> str | None:
    """A road or route with the road that goes on from its end, None where there is none."""
    path, selection = read_selection(stretch)
    if path.suffix in LANELETS or selection.span != (None, None) or not selection.roads:
        return None
    road_map = read_map(path)
    last = directed(path, road_map, selection)[-1]
    roads = {x.id: x for x in road_map.roads if x.id not in selection.roads}
    ahead = min(_next(roads, last, []), key=_turn, default=None)
    return None if ahead is None else f"{path}#route={'+'.join((*selection.roads, ahead.road.id))}"


def _turn(way: DirectedRoad) -> float:
    line = way.road.line
    begin, end = (line.pose(float(x)).heading for x in (line.begin, line.end))
    return abs(math.remainder(end - begin, math.tau))


def _begins(document: Document) -> Iterator[Element]:
    """Elements inside Position at which vehicles begin or their routes lead, else any lane."""
    init = document.root.find("Storyboard/Init")
    places = []
    others = {x.get("name") for x in document.root.iter("ScenarioObject") if x.find("Vehicle") is None}
    for private in () if init is None else init.iter("Private"):
        if private.get("entityRef") in others:
            continue
        places += [x[0] for node in private.iter() for x in node.findall("Position") if len(x)]
    named = [x for x in places if x.tag in ("LanePosition", "RoadPosition", "TrackPosition", "WorldPosition")]
    yield from named or document.root.iter("LanePosition")


def _road_of(document: Document, place: Element, roads: Mapping[str, MapRoad]) -> str | None:
    """The id of the road of a place; for one in the plane the nearest, outside of junctions if possible."""
    if place.tag != "WorldPosition":
        return document.text(place, "roadId")
    if len(roads) < 2:
        return None
    at = document.number(place, "x"), document.number(place, "y")
    outside = [x for x in roads.values() if x.junction is None] or [*roads.values()]
    return min(outside, key=lambda road: distance(road, *at)).id


def _single(document: Document, path: Path, name: str, place: Element) -> str:
    """A road in the direction of the vehicle at ``place``."""
    if place.tag == "LanePosition":
        left = (document.number(place, "laneId") > 0) != is_turned_back(document, place)
        return f"{path}#road={name},lanes={'left' if left else 'right'}"
    sides = (f"{path}#road={name},lanes={side}" for side in ("right", "left"))
    return _forward(document, place, sides) or f"{path}#road={name}"


def _forward(document: Document, place: Element, stretches: Iterable[str]) -> str | None:
    """The first stretch that can be read, and in whose direction the vehicle at ``place`` is."""
    for stretch in stretches:
        try:
            positions = positions_on(document, load_road(stretch))
        except InputError:
            continue
        if positions.is_forward(place, {}):
            return stretch
    return None


def _route(
    document: Document, path: Path, roads: Mapping[str, MapRoad], start_places: Mapping[str, Element]
) -> str:
    """The roads in the order in which they are driven. Raises ``InputError``."""
    place = next(iter(start_places.values()))
    routes = (f"{path}#route={'+'.join(names)}" for names in _chains(roads, [*start_places]))
    if (route := _forward(document, place, routes)) is not None:
        return route
    shown = ", ".join(sorted(start_places))
    rule = f"name the route as a parameter {STRETCH} with a value such as route=1+2"
    raise document.error(place, f"positions on several roads ({shown}) that are not one route; {rule}")


def _chains(roads: Mapping[str, MapRoad], required: list[str]) -> Iterator[tuple[str, ...]]:
    """Routes over all wanted roads that begin on one of them, the shortest ones first."""
    starts = [DirectedRoad(roads[x], y) for x in required if x in roads for y in (True, False)]
    queue: deque[tuple[DirectedRoad, ...]] = deque((x,) for x in starts)
    for _ in range(_MOST_STEPS):
        if not queue:
            return
        chain = queue.popleft()
        names = tuple(x.road.id for x in chain)
        if {*required} <= {*names}:
            yield names
        elif len(chain) < _LONGEST:
            queue.extend((*chain, x) for x in _next(roads, chain[-1], starts) if x.road.id not in names)


def _next(
    roads: Mapping[str, MapRoad], last: DirectedRoad, unlinked: list[DirectedRoad]
) -> Iterator[DirectedRoad]:
    """Roads that go on from the end of one, by its link or by those of the roads of a junction.

    ``unlinked``: those that may go on where there is no link.
    """
    link = last.road.successor if last.forward else last.road.predecessor
    if link is None:
        yield from unlinked
        return
    if link.kind == "road" and link.id in roads:
        yield DirectedRoad(roads[link.id], link.contact != "end")
        return
    here = "end" if last.forward else "start"
    for road in roads.values() if link.kind == "junction" else ():
        if road.junction == link.id:
            for way, forward in ((road.predecessor, True), (road.successor, False)):
                directed_road = DirectedRoad(road, forward)
                if _meets(way, last.road.id, here) and any(
                    driven_lanes(x, directed_road.side) for x in road.sections
                ):
                    yield directed_road


def _meets(link: RoadLink | None, name: str, contact: str) -> bool:
    return link is not None and link.kind == "road" and link.id == name and link.contact == contact
