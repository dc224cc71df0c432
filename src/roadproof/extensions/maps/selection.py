"""The part of a map that is meant: ``map.xodr#road=12,from=300,to=900`` or ``map.xodr#route=12+40+13``.

In CommonRoad and Lanelet2: ``map.xml#road=2`` or ``map.osm#way=1204``, see ``lanelet_map``.

``road``: the id of a road. ``lanes=left``: the lanes that are driven against s of the map, where there are
lanes on both sides. ``from``, ``to``: along s (m). ``route``: roads in the order in which they are driven.
``step``: how much the edge of a lane changes at most on one lanelet (m).
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from roadproof.errors import InputError, UsageError
from roadproof.extensions.maps.carriageway import Carriageway, DirectedRoad, carriageway, driven_lanes
from roadproof.extensions.maps.opendrive import MapRoad, RoadMap
from roadproof.world.lanelet_rules import check_lanelets
from roadproof.world.reference_line import Part, ReferenceLine
from roadproof.world.road import Lanelet

STRETCH = "roadproof_stretch"
"""The parameter of a scenario in OpenSCENARIO that has what is selected of its map."""
STEP = Fraction(1, 4)
_KEYS = ("road", "route", "way", "lanes", "from", "to", "step")
LANELETS = (".xml", ".osm")
"""Endings of maps of measured lanelets."""
_JOINED, _TURN = 0.5, 0.2
"""Metres along and radians between the end of a road and the beginning of the next one of a route."""
_MILLI = 1000


@dataclass(frozen=True)
class Selection:
    """``roads``: ids, none for the only one; ``against``: lanes that are driven against s of the map.

    ``way``: a lanelet on whose way s is measured. ``step`` None: ``STEP``, or more where a map of measured
    lanelets has too many (``lanelet_map``).
    """

    roads: tuple[str, ...] = ()
    against: bool | None = None
    span: tuple[Fraction | None, Fraction | None] = (None, None)
    step: Fraction | None = None
    way: str | None = None


@dataclass(frozen=True)
class SelectedStretch:
    """A selected stretch: lanelets, reference line, and how far (m) edges of lanelets are from the map's.

    ``unread``: kinds of parts of the map that were not read and may have an effect.
    """

    lanelets: tuple[Lanelet, ...]
    line: ReferenceLine
    width_error: Fraction
    unread: tuple[str, ...] = ()


def is_map(text: str | Path) -> bool:
    """Return whether a road is a map, with a selection or without one."""
    return Path(str(text).partition("#")[0]).suffix in (".xodr", *LANELETS)


def read_selection(text: str) -> tuple[Path, Selection]:
    """The path and what is selected. Raises ``UsageError``."""
    name, mark, text_after_mark = text.partition("#")
    values = dict[str, str]()
    for piece in text_after_mark.split(",") if mark else ():
        key, equals, value = piece.partition("=")
        if not equals or key not in _KEYS or key in values or not value:
            rule = "road=ID, route=ID+ID, way=ID, lanes=left|right, from=M, to=M, step=M"
            raise UsageError(f"road {text}: '{piece}': after # write {rule}, with commas between")
        values[key] = value
    if len(named := [x for x in ("road", "route", "way") if x in values]) > 1:
        raise UsageError(f"road {text}: {' and '.join(named)}: name one of them")
    lanes, way, road, route = (values.get(x) for x in ("lanes", "way", "road", "route"))
    if way is not None and Path(name).suffix not in LANELETS:
        raise UsageError(f"road {text}: way={way}: a road in OpenDRIVE is named by road=ID")
    if lanes not in (None, "left", "right"):
        raise UsageError(f"road {text}: lanes={lanes}: one of left, right is needed")
    roads = tuple(route.split("+")) if route is not None else () if road is None else (road,)
    low, high, step = (_metres(text, x, values.get(x)) for x in ("from", "to", "step"))
    if low is not None and high is not None and low >= high:
        raise UsageError(f"road {text}: from={float(low):g} is not below to={float(high):g}")
    if step is not None and step < Fraction(1, 100):
        raise UsageError(f"road {text}: step={float(step):g}: at least 0.01 m is needed")
    against = None if lanes is None else lanes == "left"
    return Path(name), Selection(roads, against, (low, high), step, way)


def _metres(text: str, key: str, value: str | None) -> Fraction | None:
    try:
        return None if value is None or len(value) > 40 else Fraction(value)
    except (ValueError, ZeroDivisionError):
        raise UsageError(f"road {text}: {key}={value}: a number of metres is needed") from None


def stretch_of(path: Path, known_map: RoadMap, selection: Selection) -> SelectedStretch:
    """Return the selected stretch of the roads of a file."""
    ways = directed(path, known_map, selection)
    whole_road = carriageway(ways, selection.step or STEP)
    if not whole_road.lanelets:
        raise InputError(
            f"{ways[0].road.where}: no lane is driven on in this direction; try lanes=left or right"
        )
    line = ReferenceLine(tuple(part for way in ways for part in _parts(way)))
    lanelets = tuple(cut(path, whole_road, _span(ways, selection)))
    check_lanelets(lanelets, ways[0].road.where)
    ignored_parts = (*known_map.unread, *dict.fromkeys(x for way in ways for x in way.road.unread))
    return SelectedStretch(lanelets, line, whole_road.width_error, ignored_parts)


def directed(path: Path, known_map: RoadMap, selection: Selection) -> tuple[DirectedRoad, ...]:
    """The selected roads as they are driven. Raises ``InputError``."""
    known, names = {x.id: x for x in known_map.roads}, [x.id for x in known_map.roads]
    names += known_map.refused
    if not selection.roads and len(names) > 1:
        shown = ", ".join(names[:8]) + (", …" if len(names) > 8 else "")
        problem = (
            f"{len(names)} roads ({shown}); name one as {path}#road=ID; roadproof road {path} lists them"
        )
        raise InputError(f"{path}: {problem}")
    for name in selection.roads:
        if name in known_map.refused:
            raise InputError(known_map.refused[name])
        if name not in known:
            raise InputError(f"{path}: there is no road {name}; roadproof road {path} lists the roads")
    chosen = [known[x] for x in selection.roads] or [known_map.roads[0]]
    return _route(path, chosen) if len(chosen) > 1 else (_single(chosen[0], selection),)


def _single(road: MapRoad, selection: Selection) -> DirectedRoad:
    """The only road: along s where lanes are driven so, unless the other lanes are asked for."""
    if selection.against is not None:
        right_is_forward = road.rule == "RHT"
        return DirectedRoad(road, selection.against != right_is_forward)
    forward = DirectedRoad(road, True)
    there = any(driven_lanes(x, forward.side) for x in road.sections)
    return forward if there else DirectedRoad(road, False)


def _span(ways: tuple[DirectedRoad, ...], selection: Selection) -> tuple[Fraction | None, Fraction | None]:
    """Return the span along the way, from s of the map; a route has its own s from 0."""
    low, high = selection.span
    if len(ways) > 1 or ways[0].forward:
        return low, high
    return (None if high is None else ways[0].s(high)), (None if low is None else ways[0].s(low))


def cut(path: Path, whole_road: Carriageway, span: tuple[Fraction | None, Fraction | None]) -> list[Lanelet]:
    """The lanelets between two places, None for the ends of the road. Raises ``InputError``."""
    if not whole_road.lanelets:
        raise InputError(f"{path}: no lane of the road has a length and a width")
    selected = []
    for x in whole_road.lanelets:
        begin, end = x.s
        assert begin is not None
        assert end is not None
        low = begin if span[0] is None else max(begin, span[0])
        high = end if span[1] is None else min(end, span[1])
        if low < high:
            selected.append(Lanelet(x.id, x.lane, x.zone, x.attribute, (low, high), x.d))
    if not selected:
        ends = [x for lanelet in whole_road.lanelets for x in lanelet.s if x is not None]
        there = f"the road goes from {float(min(ends)):g} m to {float(max(ends)):g} m"
        raise InputError(f"{path}: from={span[0]}, to={span[1]}: {there}")
    return selected


def _parts(way: DirectedRoad) -> list[Part]:
    parts = [
        Part(
            way.base + (x.s if way.forward else way.road.length - x.end),
            *(x.length, x.x, x.y, x.heading, x.curve),
            backward=not way.forward,
            offset=way.shift,
        )
        for x in way.road.line.parts
    ]
    return parts if way.forward else parts[::-1]


def _route(path: Path, roads: list[MapRoad]) -> tuple[DirectedRoad, ...]:
    """Roads that are joined end to end. Raises ``InputError`` where they are not."""
    ways: list[DirectedRoad] = []
    for road in roads:
        options = [_joined(ways, road, forward) for forward in (True, False)]
        if not ways:  # the first one: as it joins the second
            both = (DirectedRoad(road, True), DirectedRoad(road, False))
            options = [x for x in both if any(_joined([x], roads[1], y) for y in (True, False))]
        joined = [x for x in options if x is not None]
        if not joined:
            before = roads[max(len(ways) - 1, 0)]
            rule = "only traffic along one road is supported, no crossing traffic"
            raise InputError(
                f"{path}: route: road {road.id} does not go on from road {before.id} at either end: {rule}"
            )
        ways.append(joined[0])
    return tuple(ways)


def _joined(ways: list[DirectedRoad], road: MapRoad, forward: bool) -> DirectedRoad | None:
    """``road`` after the last way in a direction, None where it does not begin there."""
    if not ways:
        return None
    last = ways[-1]
    base = last.base + last.road.length
    end = _parts(last)[-1].pose(float(base))
    begin = _parts(DirectedRoad(road, forward, base))[0].pose(float(base))
    turn = math.cos(begin.heading), math.sin(begin.heading)
    x, y = end.x - begin.x, end.y - begin.y
    along, aside = x * turn[0] + y * turn[1], y * turn[0] - x * turn[1]
    if abs(along) > _JOINED or abs(math.remainder(end.heading - begin.heading, math.tau)) > _TURN:
        return None
    if abs(aside) > 15:
        return None
    return DirectedRoad(road, forward, base, Fraction(round(aside * _MILLI), _MILLI))
