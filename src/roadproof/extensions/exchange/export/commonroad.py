"""A drive in CommonRoad XML, version 2020a: lanelets with their types and neighbours, vehicles as obstacles.

A vehicle's reference point is the centre of its box, which is aligned with the road as it was judged:
``velocity`` and ``acceleration`` are along the box and so along the road, ``velocityY`` is to its left. The
format has no place for the acceleration across. On a bend the speed along is v_lon·(1 - κ·d), with d and the
curvature κ at the centre, and the acceleration along is the rate of that less v_lat·v_lon·κ.

A road that is from a map in CommonRoad 2020a is exported as that map: its lanelets, signs, lights and
intersections, and the file with zones beside it. Numbers of vehicles are then above all that the map has.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

from roadproof.extensions.exchange.export.points import centre, centre_in_plane
from roadproof.extensions.exchange.export.subject import (
    WRITTEN,
    ExportSubject,
    RoadCut,
    Section,
    allow_lane_change,
    are_adjacent,
)
from roadproof.extensions.exchange.export.user_map import checked_map
from roadproof.extensions.maps.network import ZONES_ENDING, zones_beside
from roadproof.extensions.maps.xml_reader import read_xml
from roadproof.extensions.maps.xml_writer import Element, document, element
from roadproof.frontends.report.numbers import decimal
from roadproof.frontends.report.samples import kind_of
from roadproof.world.drive import Motion
from roadproof.world.motion import State
from roadproof.world.reference_line import ReferenceLine
from roadproof.world.road import Attribute, Lanelet
from roadproof.world.signals import Kind

_TYPES: Mapping[Attribute, str] = {"main": "mainCarriageWay", "merge": "accessRamp", "departure": "exitRamp"}
MOTORCYCLE_WIDTH = Fraction(6, 5)
"""A vehicle as narrow as that (m) is a motorcycle: cars are 1.4 m wide or more."""
_CHORD = 0.005
"""Metres between a bend and a line that stands for a part of it."""
FIRST_LANELET, PROBLEM = 1001, 9001
"""Ids: vehicles count from 1, lanelets from 1001; ids differ among all of them."""

VERSION = "2020a"
_NETWORK = ("lanelet", "trafficSign", "trafficLight", "intersection")
_NOWHERE = {"geoNameId": "-999", "gpsLatitude": "999", "gpsLongitude": "999"}
# Kinds that CommonRoad calls otherwise.
_OBSTACLES: Mapping[Kind, str] = {"other": "unknown"}


@dataclass(frozen=True)
class _SectionLanelet:
    """A lanelet within one section."""

    id: int
    lanelet: Lanelet
    section: Section


def files(subject: ExportSubject) -> dict[str, bytes]:
    """NAME.xml, and NAME_zones.toml where the map has one or a zone does not follow from ramps.

    Raises ``InputError`` for roads that have no lanes side by side, and maps that are others by now.
    """
    path, map_elements = _map_of(subject)
    ids = _vehicle_ids_beside(subject, map_elements)
    nowhere = element("location", *(element(tag, text=text) for tag, text in _NOWHERE.items()))
    root = element(
        "commonRoad",
        next((x for x in map_elements if x.tag == "location"), nowhere),
        element("scenarioTags", element("highway"), element("simulated")),
        *([x for x in map_elements if x.tag in _NETWORK] or _lanelets(subject.layout)),
        *(_obstacle(subject, ids[name], name, motion) for name, motion in subject.vehicles.items()),
        _problem(subject, max([PROBLEM, *(x + 1 for x in ids.values())])),
        commonRoadVersion=VERSION,
        benchmarkID=f"ZAM_Roadproof-{subject.number}_1_T-1",
        date=WRITTEN,
        author="roadproof",
        affiliation="roadproof",
        source=subject.formula_note,
        timeStepSize=decimal(Fraction(1, subject.rate)),
    )
    contents = {f"{subject.name}.xml": document(root)}
    zones = None if path is None else path.with_name(f"{path.stem}{ZONES_ENDING}")
    if zones is not None and zones.is_file():
        contents[f"{subject.name}{ZONES_ENDING}"] = zones.read_bytes()
    elif path is None and (entries := [*_zones(subject.layout)]):
        contents[f"{subject.name}{ZONES_ENDING}"] = "\n".join(entries).encode()
    return contents


def vehicle_ids(subject: ExportSubject) -> dict[str, int]:
    """Return the ids of vehicles by name. Raises ``InputError`` for maps that are others by now."""
    return _vehicle_ids_beside(subject, _map_of(subject)[1])


def _map_of(subject: ExportSubject) -> tuple[Path | None, list[Element]]:
    """The map in CommonRoad 2020a that the road is from, and what it has; None where there is none."""
    path = checked_map(subject, ".xml")
    root = None if path is None else read_xml(path, "commonRoad")
    if root is None or root.get("commonRoadVersion") != VERSION:
        return None, []
    return path, list(root)


def _vehicle_ids_beside(subject: ExportSubject, map_elements: list[Element]) -> dict[str, int]:
    """Vehicles count from 1, beside a map from the next thousand above its greatest number."""
    names = (y.get("id", "") for x in map_elements if x.tag in _NETWORK for y in x.iter())
    taken = [int(x) for x in names if x.isdecimal()]
    first = 1000 * (max(taken) // 1000 + 1) if taken else 0
    return {name: first + number for name, number in subject.ids.items()}


def _rows(layout: RoadCut) -> list[list[_SectionLanelet]]:
    """The lanelets of each section, from left to right."""
    rows: list[list[_SectionLanelet]] = []
    for section in layout.sections:
        first = FIRST_LANELET + sum(map(len, rows))
        rows.append([_SectionLanelet(first + k, x, section) for k, x in enumerate(section.lanelets)])
    return rows


def _zones(layout: RoadCut) -> Iterator[str]:
    """An entry for each lanelet that is in another zone than the ramps side by side with it say."""
    for row in _rows(layout):
        beside = {
            str(x.id): str(y.id) for x, y in pairwise(row) if are_adjacent(x.lanelet, y.lanelet, layout.road)
        }
        attributes = {str(x.id): x.lanelet.attribute for x in row}
        inferred = zones_beside(attributes, beside.items())
        for x in row:
            if inferred[str(x.id)] != x.lanelet.zone:
                yield f'[[lanelet]]\nid = {x.id}\nzone = "{x.lanelet.zone}"\n'


def _lanelets(layout: RoadCut) -> Iterator[Element]:
    rows = _rows(layout)
    for k, row in enumerate(rows):
        before = {x.lanelet.lane: x.id for x in rows[k - 1]} if k else {}
        after = {x.lanelet.lane: x.id for x in rows[k + 1]} if k + 1 < len(rows) else {}
        for place, cell in enumerate(row):
            lane = cell.lanelet.lane
            links = (("predecessor", before.get(lane)), ("successor", after.get(lane)))
            refs = [element(tag, ref=str(other)) for tag, other in links if other is not None]
            sides = {"left": row[place - 1] if place else None, "right": [*row, None][place + 1]}
            near = {
                side: x
                for side, x in sides.items()
                if x and are_adjacent(cell.lanelet, x.lanelet, layout.road)
            }
            dashed = {
                side for side, x in near.items() if allow_lane_change(cell.lanelet, x.lanelet, layout.road)
            }
            refs += [
                element(f"adjacent{side.title()}", ref=str(x.id), drivingDir="same")
                for side, x in near.items()
            ]
            yield element(
                "lanelet",
                _bound("leftBound", cell, cell.lanelet.d[1], "left" in dashed, layout.road.line),
                _bound("rightBound", cell, cell.lanelet.d[0], "right" in dashed, layout.road.line),
                *refs,
                element("laneletType", text="highway"),
                element("laneletType", text=_TYPES[cell.lanelet.attribute]),
                id=str(cell.id),
            )


def _bound(
    tag: str, cell: _SectionLanelet, across: Fraction, is_dashed: bool, line: ReferenceLine | None
) -> Element:
    """A side of a lanelet; on a bend its points are so near that lines are within ``_CHORD`` of it."""
    low, high = cell.section.low, cell.section.high
    if line is None:
        points = [_point(s, across) for s in (low, (low + high) / 2, high)]
    else:
        count = _points_between(low, high, line)
        places = (float(low + (high - low) * k / count) for k in range(count + 1))
        points = [_point(x, y) for x, y in (line.place(s, float(across)) for s in places)]
    return element(tag, *points, element("lineMarking", text="dashed" if is_dashed else "solid"))


def _points_between(low: Fraction, high: Fraction, line: ReferenceLine) -> int:
    """Into how many parts a lanelet is divided."""
    sharpest = max((x.greatest for x in line.bends() if x.end > low and x.begin < high), default=0)
    longest = math.sqrt(8 * _CHORD / float(sharpest)) if sharpest else math.inf
    return max(2, math.ceil(float(high - low) / longest))


def _point(x: Fraction | float, y: Fraction | float, tag: str = "point") -> Element:
    return element(tag, element("x", text=decimal(x)), element("y", text=decimal(y)))


def _box(motion: Motion) -> Element:
    sizes = {"length": motion.length, "width": motion.width}
    return element("rectangle", *(element(tag, text=decimal(size)) for tag, size in sizes.items()))


def _obstacle(subject: ExportSubject, number: int, name: str, motion: Motion) -> Element:
    box = _box(motion)
    first, *others = (
        _state("state" if k else "initialState", k, state, motion, subject.file.road.line)
        for k, state in enumerate(subject.samples[name])
    )
    return element(
        "dynamicObstacle",
        element("type", text=_type(motion)),
        element("shape", box),
        first,
        element("trajectory", *others),
        id=str(number),
    )


def _type(motion: Motion) -> str:
    """The type of an obstacle; where a drive says sizes only, no car is as narrow as a motorcycle."""
    if motion.kind is None and motion.width <= MOTORCYCLE_WIDTH:
        return "motorcycle"
    kind = kind_of(motion)
    return _OBSTACLES.get(kind, kind)


@dataclass(frozen=True)
class _BoxState:
    """A state as the format has it: the centre of the box in the plane, and what is along its direction."""

    place: tuple[Fraction, Fraction] | tuple[float, float]
    orientation: Fraction | float
    velocity: Fraction | float
    acceleration: Fraction | float


def _box_state(state: State, motion: Motion, line: ReferenceLine | None) -> _BoxState:
    middle = centre(state, motion.length, motion.width)
    if line is None:
        return _BoxState(middle, Fraction(0), state.v_lon, state.a_lon)
    pose = centre_in_plane(state, motion, line)
    speed, aside = float(state.v_lon), float(middle[1])
    shorter = 1 - pose.curvature * aside
    swing = 2 * speed * float(state.v_lat) * pose.curvature + speed**2 * pose.curvature_rate * aside
    return _BoxState((pose.x, pose.y), pose.along, speed * shorter, float(state.a_lon) * shorter - swing)


def _state(tag: str, step: int, state: State, motion: Motion, line: ReferenceLine | None) -> Element:
    moving = _box_state(state, motion, line)
    return element(
        tag,
        element("position", _point(*moving.place)),
        _exact("orientation", moving.orientation),
        _exact("time", Fraction(step)),
        _exact("velocity", moving.velocity),
        _exact("velocityY", state.v_lat),
        _exact("acceleration", moving.acceleration),
    )


def _exact(tag: str, value: Fraction | float) -> Element:
    return element(tag, element("exact", text=decimal(value)))


def _problem(subject: ExportSubject, number: int) -> Element:
    """Return the planning problem of SV: from its start to where and when it ends (2020a requires one)."""
    name = next(iter(subject.vehicles))
    motion = subject.vehicles[name]
    states = subject.samples[name]
    start, end = (_box_state(x, motion, subject.file.road.line) for x in (states[0], states[-1]))
    initial = element(
        "initialState",
        element("position", _point(*start.place)),
        _exact("velocity", start.velocity),
        _exact("orientation", start.orientation),
        _exact("yawRate", Fraction(0)),
        _exact("slipAngle", Fraction(0)),
        _exact("time", Fraction(0)),
    )
    place = _box(motion)
    place.append(element("orientation", text=decimal(end.orientation)))
    place.append(_point(end.place[0], end.place[1], "center"))
    steps = len(states) - 1
    begin, last = element("intervalStart", text=str(steps)), element("intervalEnd", text=str(steps + 1))
    goal = element("goalState", element("time", begin, last), element("position", place))
    return element("planningProblem", initial, goal, id=str(number))
