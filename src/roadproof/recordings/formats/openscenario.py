"""Scenarios in OpenSCENARIO XML (ASAM, 1.0 to 1.3): vehicles that follow polylines, or a storyboard.

The road is that in OpenDRIVE that the file names. Between vertices places are interpolated by cubics through
them with the speeds that three vertices in a row have, which is exact where accelerations are constant across
them. Speeds and accelerations are those of the cubics. Files with other actions, or with vehicles that keep
their initial state, are run (``storyboard``). A box is aligned with the road; its centre is where that of the
file's box is, and in a storyboard where it is when the vehicle is aligned with the road. Speeds are those of
s and d, which differ on a bend by the factor 1 - κd from those of the vehicle.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.recordings.formats.recording import Floats, Recording
from roadproof.recordings.formats.samples import DIRECTION, LABEL, recording_of
from roadproof.recordings.formats.source import Files, Format, with_suffix
from roadproof.recordings.formats.storyboard.actions import Trajectory, TrajectoryReader
from roadproof.recordings.formats.storyboard.box import Box
from roadproof.recordings.formats.storyboard.conditions import TICKS
from roadproof.recordings.formats.storyboard.document import Document, open_document
from roadproof.recordings.formats.storyboard.positions import State, stretch_of
from roadproof.recordings.formats.storyboard.run import Play, run_storyboard
from roadproof.recordings.formats.straight import of_road
from roadproof.recordings.formats.table import Column, Table
from roadproof.runtime.xml_reader import Element, number_in
from roadproof.world.models import load_road
from roadproof.world.road import Road
from roadproof.world.signals import RECORDED, SIZES

RATE = 25
"""Samples a second."""
_KINDS = {
    "car": "Car",
    "van": "Car",
    "truck": "Truck",
    "semitrailer": "Truck",
    "trailer": "Truck",
    "bus": "Truck",
    "motorbike": "Motorcycle",
}
_OTHERS = ("Pedestrian", "MiscObject")
_PLACES = "PrivateAction/RoutingAction/FollowTrajectoryAction"


@dataclass(frozen=True)
class CentreLine:
    """Vertices of the centre of a box in road coordinates, by time (s, m)."""

    time: Floats
    s: Floats
    d: Floats


class Samples(Table):
    """Samples whose place is said by vehicle and time, as the file has vertices in place of rows."""

    def cell(self, row: int, column: str) -> str:
        vehicle, time = self.columns["vehicle"][row], self.columns["time"][row]
        value = self.columns[column][row]
        shown = value if isinstance(value, str) else f"{value:g}"
        return f"vehicle {vehicle} at {time:g} s, {column}={shown}"


@dataclass(frozen=True)
class Scenario:
    """Samples of all vehicles, RATE a second, the road with its file, and notes on them."""

    table: Table
    road: Road
    road_path: Path
    notes: tuple[str, ...]


def read_scenario(path: Path) -> Scenario:
    """The vehicles of a file. Raises ``InputError`` that names element and rule."""
    document = open_document(path)
    root = document.root
    road_path = path.parent / _text(path, root.find("RoadNetwork/LogicFile"), "filepath", "a LogicFile")
    if road_path.suffix != ".xodr":
        raise InputError(
            f"{path}: LogicFile filepath={road_path.name}: a road in OpenDRIVE (.xodr) is needed"
        )
    boxes = dict(_boxes(path, root))
    if not boxes:
        raise InputError(f"{path}: no ScenarioObject is a motor vehicle")
    road = load_road(stretch_of(document, road_path))
    if _follows_polylines(root):
        ways = {name: _in_road(x, boxes[name], road) for name, x in _vertices(path, root, boxes)}
        note = f"speeds and accelerations are those of curves through the vertices, {RATE} samples a second"
        return Scenario(_sampled(path, boxes, ways), road, road_path, (note,))
    play = run_storyboard(document, boxes, road, _trajectory_reader(document, boxes, road))
    if len(play.states) < 2 * TICKS // RATE:
        raise InputError(f"{path}: the storyboard ends at {len(play.states) / TICKS:g} s: {play.ending}")
    told = f"the storyboard ends at {(len(play.states) - 1) / TICKS:g} s: {play.ending}"
    note = f"the storyboard was run with conditions evaluated {TICKS} times a second, {RATE} samples a second"
    others = sorted({x.get("name", "") for x in root.findall("Entities/ScenarioObject")} - {*boxes})
    left_out = [f"left out, as they are no motor vehicles: {', '.join(others)}"] if others else []
    return Scenario(_of_play(path, boxes, play), road, road_path, (note, told, *left_out))


def read_columns(path: Path) -> tuple[Table, Road, Path]:
    """Samples of all vehicles, RATE a second, and the road with its file.

    Raises ``InputError`` that names element and rule.
    """
    found = read_scenario(path)
    return found.table, found.road, found.road_path


def read_recording(path: Path, strict: bool = True) -> Recording:
    """The vehicles of a file as a recording; unless ``strict``, without bad ones. Raises ``InputError``."""
    found = read_scenario(path)
    road = of_road(found.road, DIRECTION, found.road_path)
    return recording_of(found.table, road, path.stem, found.notes, strict)


def _follows_polylines(root: Element) -> bool:
    """Whether all that happens is that each vehicle follows a trajectory."""
    actions = root.findall("Storyboard/Story/Act/ManeuverGroup/Maneuver/Event/Action")
    actors = {x.get("entityRef") for x in root.findall("Storyboard/Story/Act/ManeuverGroup/Actors/EntityRef")}
    names = {x.get("name") for x in root.findall("Entities/ScenarioObject")}
    return bool(actions) and names <= actors and all(x.find(_PLACES) is not None for x in actions)


def _trajectory_reader(document: Document, boxes: Mapping[str, Box], road: Road) -> TrajectoryReader:
    """Reads a FollowTrajectoryAction of a storyboard."""

    def read(follow: Element, name: str, begin: float) -> Trajectory:
        told, box = document.places[follow], boxes[name]
        way = _in_road(_polyline(document.path, follow, told, begin), box, road)

        def state(time: float) -> State:
            at = np.array([time])
            s, v_lon, a_lon = (float(x[0]) for x in _curve(way.time, way.s, at))
            d, v_lat, a_lat = (float(x[0]) for x in _curve(way.time, way.d, at))
            return State(s - box.centre[0], d - box.centre[1], v_lon, v_lat, a_lon, a_lat)

        return Trajectory(float(way.time[0]), float(way.time[-1]), state)

    return read


def _text(path: Path, node: Element | None, attribute: str, what: str) -> str:
    value = None if node is None else node.get(attribute)
    if not value:
        raise InputError(f"{path}: {what} with {attribute} is needed")
    return value


def _number(path: Path, node: Element | None, attribute: str, what: str) -> float:
    return number_in(path, _text(path, node, attribute, what), f"{attribute} of {what}")


def _boxes(path: Path, root: Element) -> Iterator[tuple[str, Box]]:
    """The motor vehicles by name."""
    seen: set[str] = set()
    for node in root.findall("Entities/ScenarioObject"):
        name = _text(path, node, "name", "a ScenarioObject")
        if name in seen:
            raise InputError(f"{path}: two ScenarioObjects are called {name}")
        seen.add(name)
        told = f"ScenarioObject {name}"
        vehicle = node.find("Vehicle")
        if vehicle is None and any(node.find(x) is not None for x in _OTHERS):
            continue
        if vehicle is None:
            raise InputError(f"{path}: {told} is no Vehicle")
        category = vehicle.get("vehicleCategory", "car")
        if category == "bicycle":
            continue
        if category not in _KINDS:
            raise InputError(f"{path}: {told}: vehicleCategory={category} is none of {', '.join(_KINDS)}")
        size, centre = vehicle.find("BoundingBox/Dimensions"), vehicle.find("BoundingBox/Center")
        length, width = (_number(path, size, x, f"the Dimensions of {told}") for x in ("length", "width"))
        ahead, left = (_number(path, centre, x, f"the Center of {told}") for x in ("x", "y"))
        yield name, Box(_KINDS[category], category, length, width, (ahead, left))
    if not seen:
        raise InputError(f"{path}: there is no ScenarioObject")


def _vertices(path: Path, root: Element, boxes: dict[str, Box]) -> Iterator[tuple[str, Floats]]:
    """By vehicle, rows of time, x, y and heading."""
    seen: set[str] = set()
    acts = root.findall("Storyboard/Story/Act")
    for act, group in ((x, y) for x in acts for y in x.findall("ManeuverGroup")):
        actors = [_text(path, x, "entityRef", "an EntityRef") for x in group.findall("Actors/EntityRef")]
        for event, action in ((x, y) for x in group.findall("Maneuver/Event") for y in x.findall("Action")):
            told = f"Action {action.get('name')} of {', '.join(actors)}"
            follow = action.find(_PLACES)
            if follow is None:
                raise InputError(f"{path}: {told} is no FollowTrajectoryAction; only these are read")
            found = _polyline(path, follow, told)
            for begun in (act, event):
                _check_begin(path, begun, found[0, 0], told)
            for name in actors:
                if name not in boxes:
                    raise InputError(f"{path}: {told}: there is no ScenarioObject {name}")
                if name in seen:
                    raise InputError(f"{path}: {name} follows two trajectories; one is needed")
                seen.add(name)
                yield name, found


def _check_begin(path: Path, node: Element, first: float, told: str) -> None:
    """Raise ``InputError`` where an act or event may begin after ``first`` (s), when the first vertex is."""

    def in_time(condition: Element) -> bool:
        clock = condition.find("ByValueCondition/SimulationTimeCondition")
        if clock is None or clock.get("rule") not in ("greaterThan", "greaterOrEqual"):
            return False
        trigger = f"a StartTrigger of {told}"
        begin = _number(path, clock, "value", trigger)
        delay = _number(path, condition, "delay", trigger) if condition.get("delay") else 0.0
        return begin + delay <= first

    groups = node.findall("StartTrigger/ConditionGroup")
    if groups and not any(all(map(in_time, group.findall("Condition"))) for group in groups):
        rule = f"a SimulationTimeCondition that is met at time {first:g} is needed, that of the first Vertex"
        raise InputError(f"{path}: {told}: StartTrigger of the {node.tag}: {rule}")


def _check_exact(path: Path, follow: Element, told: str) -> None:
    """Raise ``InputError`` where vehicles need not be on the vertices at their times."""
    mode = follow.find("TrajectoryFollowingMode")
    if mode is not None and mode.get("followingMode") != "position":
        raise InputError(f"{path}: {told}: followingMode={mode.get('followingMode')}: position is needed")
    offset = "initialDistanceOffset"
    if follow.get(offset) and _number(path, follow, offset, told) != 0:
        raise InputError(f"{path}: {told}: {offset}={follow.get(offset)}: begin at the first Vertex")
    if any(x.get("closed") in ("true", "1") for x in follow.iter("Trajectory")):
        raise InputError(f"{path}: {told}: closed=true: write out the way back as vertices with times")


def _polyline(path: Path, follow: Element, told: str, begin: float | None = None) -> Floats:
    """Rows of time, x, y and heading; times may be relative where the action begins at ``begin`` (s)."""
    _check_exact(path, follow, told)
    timing = follow.find("TimeReference/Timing")
    domain = None if timing is None else timing.get("domainAbsoluteRelative")
    if timing is None or (domain != "absolute" and (begin is None or domain != "relative")):
        raise InputError(f"{path}: {told}: a Timing with domainAbsoluteRelative=absolute is needed")
    scale, offset = (_number(path, timing, x, f"the Timing of {told}") for x in ("scale", "offset"))
    offset += begin if begin is not None and domain == "relative" else 0.0
    shape = next((x for x in follow.iter("Shape")), None)
    shapes = [] if shape is None else [x.tag for x in shape]
    if shape is None or shapes != ["Polyline"]:
        raise InputError(f"{path}: {told}: Shape {' and '.join(shapes) or 'missing'}; a Polyline is needed")
    rows = []
    for number, vertex in enumerate(shape.findall("Polyline/Vertex"), 1):
        at = f"Vertex {number} of {told}"
        place = vertex.find("Position/WorldPosition")
        if place is None:
            raise InputError(f"{path}: {at}: a WorldPosition is needed")
        time = _number(path, vertex, "time", at) * scale + offset
        heading = _number(path, place, "h", at) if place.get("h") else 0.0
        rows.append((time, *(_number(path, place, x, at) for x in ("x", "y")), heading))
    found = np.array(rows).reshape(-1, 4)
    if len(found) < 2 or not (np.diff(found[:, 0]) > 0).all():
        raise InputError(f"{path}: {told}: at least two vertices are needed, each later than the one before")
    return found


def _in_road(vertices: Floats, box: Box, road: Road) -> CentreLine:
    """The centre of the box, along and beside the reference line of the road."""
    time, x, y, heading = vertices.T
    ahead, left = box.centre
    x = x + ahead * np.cos(heading) - left * np.sin(heading)
    y = y + ahead * np.sin(heading) + left * np.cos(heading)
    if road.line is None:
        return CentreLine(time, x, y)
    s, d = np.array([road.line.locate(float(a), float(b)) for a, b in zip(x, y, strict=True)]).T
    return CentreLine(time, s, d)


def _sampled(path: Path, boxes: dict[str, Box], ways: dict[str, CentreLine]) -> Table:
    tables = []
    for name, way in ways.items():
        first, last = math.ceil(way.time[0] * RATE - 1e-6), math.floor(way.time[-1] * RATE + 1e-6)
        times = np.clip(np.arange(first, last + 1) / RATE, way.time[0], way.time[-1])
        s, v_lon, a_lon = _curve(way.time, way.s, times)
        d, v_lat, a_lat = _curve(way.time, way.d, times)
        moving = (s, d, v_lon, v_lat, a_lon, a_lat)
        tables.append(_rows(name, boxes[name], np.arange(first, last + 1) / RATE, moving))
    return _joined(path, tables)


def _of_play(path: Path, boxes: dict[str, Box], play: Play) -> Table:
    """The states of a storyboard, RATE a second."""
    states = play.states[:: TICKS // RATE]
    tables = []
    for name, box in boxes.items():
        moving = np.array([[getattr(x[name], y) for x in states] for y in map(str, RECORDED)])
        moving[:2] += np.array(box.centre)[:, None]
        tables.append(_rows(name, box, np.arange(len(states)) / RATE, tuple(moving)))
    return _joined(path, tables)


def _rows(name: str, box: Box, times: Floats, moving: tuple[Floats, ...]) -> dict[str, Column]:
    """The samples of a vehicle whose middle moves so: its front-left corner, as in all recordings."""
    s, d, *rates = moving
    told: dict[str, Column] = {
        "time": times,
        "vehicle": np.full(len(times), name),
        "kind": np.full(len(times), box.kind),
        LABEL: np.full(len(times), box.label),
    }
    corner = (s + box.length / 2, d + box.width / 2, *rates)
    told |= zip(map(str, RECORDED), corner, strict=True)
    return told | {str(x): np.full(len(times), getattr(box, x)) for x in SIZES}


def _joined(path: Path, tables: list[dict[str, Column]]) -> Table:
    columns = {column: np.concatenate([x[column] for x in tables]) for column in tables[0]}
    return Samples(path, columns, len(columns["time"]))


def _curve(knots: Floats, places: Floats, times: Floats) -> tuple[Floats, Floats, Floats]:
    """Place, speed and acceleration at ``times`` on the cubics through ``places``."""
    speeds = _speeds(knots, places)
    k = np.clip(np.searchsorted(knots, times, side="right") - 1, 0, len(knots) - 2)
    step = knots[k + 1] - knots[k]
    x = (times - knots[k]) / step
    rise = places[k + 1] - places[k]
    low, high = speeds[k] * step, speeds[k + 1] * step
    square, cube = 3 * rise - 2 * low - high, low + high - 2 * rise
    place = places[k] + x * (low + x * (square + x * cube))
    return place, (low + x * (2 * square + 3 * x * cube)) / step, (2 * square + 6 * x * cube) / step**2


def _speeds(knots: Floats, places: Floats) -> Floats:
    """At each knot the speed of the parabola through it and its neighbours."""
    means = np.diff(places) / np.diff(knots)
    if len(means) == 1:
        return np.repeat(means, 2)
    before, after = np.diff(knots)[:-1], np.diff(knots)[1:]
    inside = (after * means[:-1] + before * means[1:]) / (before + after)
    return np.concatenate(([2 * means[0] - inside[0]], inside, [2 * means[-1] - inside[-1]]))


def _find(path: Path) -> dict[str, Files]:
    return {x.stem: (x,) for x in with_suffix(path, ".xosc")}


FORMAT = Format(
    "OpenSCENARIO",
    "NAME.xosc, whose storyboard is run",
    _find,
    read_recording,
    "{0}, sampled {rate} times a second",
)
