"""Scenarios in OpenSCENARIO XML (ASAM, 1.0 to 1.3): vehicles that follow polylines, or a storyboard.

The road is that in OpenDRIVE that the file names. Between vertices places are interpolated by cubics through
them with the speeds that three vertices in a row have, which is exact where accelerations are constant across
them. Speeds and accelerations are those of the cubics. Files with other actions, or with vehicles that keep
their initial state, are run (``storyboard``). A box is aligned with the road; its centre is where that of the
file's box is, and in a storyboard where it is when the vehicle is aligned with the road. Speeds are those of
s and d, which differ on a bend by the factor 1 - κd from those of the vehicle. Pedestrians, other objects and
vehicles that drive against the others move in a storyboard, but are no part of the recording.
"""

import math
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.exchange.storyboard.box import Box
from roadproof.extensions.exchange.storyboard.conditions import TICKS
from roadproof.extensions.exchange.storyboard.curves import curve
from roadproof.extensions.exchange.storyboard.distributions import read_distribution, scenarios_of, split
from roadproof.extensions.exchange.storyboard.document import catalogues_of, open_document
from roadproof.extensions.exchange.storyboard.faults import faults_of
from roadproof.extensions.exchange.storyboard.run import Play
from roadproof.extensions.exchange.storyboard.stage import (
    map_of,
    number_of,
    open_stage,
    played,
    text_of,
    unread_of,
)
from roadproof.extensions.traffic.formats.recording import Floats, Recording
from roadproof.extensions.traffic.formats.samples import DIRECTION, LABEL, recording_of
from roadproof.extensions.traffic.formats.source import Files, Format, with_suffix
from roadproof.extensions.traffic.formats.straight import of_road
from roadproof.extensions.traffic.formats.table import Column, Table
from roadproof.runtime.xml_reader import Element
from roadproof.semantics.exact.robust import MOST_SAMPLES
from roadproof.world.road import Road
from roadproof.world.signals import RECORDED, SIZES
from roadproof.world.unread import LEFT_OUT

RATE = 25
"""Samples a second."""
_FOLLOWS = "followingMode=follow is taken as position: vehicles are on their trajectories, as in esmini"
_LATER = ("greaterThan", "greaterOrEqual")
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
    """Samples of all vehicles, RATE a second, the road with its file, and notes on them.

    ``otherwise``: those of the notes that say what was left out, or taken otherwise than it is written.
    ``faults``: parts of the motion that no vehicle drives. ``computed``: a storyboard was run. ``unread``:
    notes on parts of the file that were left out, and on vehicles that controllers move.
    """

    table: Table
    road: Road
    road_path: Path
    notes: tuple[str, ...]
    otherwise: tuple[str, ...] = ()
    faults: tuple[str, ...] = ()
    computed: bool = False
    unread: tuple[str, ...] = ()


def read_scenario(path: Path, strict: bool = False) -> Scenario:
    """The vehicles of a file; if ``strict``, nothing of it may be left out.

    Raises ``InputError`` that names element and rule.
    """
    found = _read_scenario(path)
    if strict and found.unread:
        raise InputError(f"{path}: {'; '.join(found.unread)}; unless read strictly, the rest is read")
    return found


def _read_scenario(path: Path) -> Scenario:
    stage = open_stage(path)
    document, boxes, road, road_path = stage.document, stage.boxes, stage.road, stage.road_path
    root = document.root
    modes = {x.get("followingMode") for x in root.iter("TrajectoryFollowingMode")}
    follows = (_FOLLOWS,) if "follow" in modes else ()
    varied = (document.told,) if document.told else ()
    if _follows_polylines(root, boxes):
        _read_init(root)
        ways = {name: _in_road(x, boxes[name], road) for name, x in _vertices(path, root, boxes)}
        _read_stop(path, root, max(float(x.time[-1]) for x in ways.values()))
        note = f"speeds and accelerations are those of curves through the vertices, {RATE} samples a second"
        unread = unread_of(stage)
        otherwise = (*follows, *varied, *unread)
        table = _sampled(path, boxes, ways)
        return Scenario(table, road, road_path, (note, *otherwise), otherwise, unread=unread)
    stage, play = played(stage)
    if len(play.states) < 2 * TICKS // RATE:
        raise InputError(f"{path}: the storyboard ends at {len(play.states) / TICKS:g} s: {play.ending}")
    told = f"the storyboard ends at {(len(play.states) - 1) / TICKS:g} s: {play.ending}"
    note = f"the storyboard was run with conditions evaluated {TICKS} times a second, {RATE} samples a second"
    table, left_out = _of_play(path, boxes, play)
    controlled = tuple(x for x in left_out if any(told in x for told in play.controlled.values()))
    unread = (*controlled, *unread_of(stage))
    otherwise = (*follows, *varied, *(x for x in left_out if x not in controlled), *unread)
    faults = faults_of(play, boxes)
    idle = (f"events that never start: {', '.join(play.idle)}",) if play.idle else ()
    notes = (note, told, *idle, *otherwise, *faults)
    return Scenario(table, stage.road, road_path, notes, otherwise, faults, computed=True, unread=unread)


def _read_init(root: Element) -> None:
    """Pass over actions of Init that trajectories replace, from the first vertex on."""
    for action in root.findall("Storyboard/Init/Actions/Private/PrivateAction"):
        if (
            action.find("TeleportAction") is not None
            or action.find("LongitudinalAction/SpeedAction") is not None
        ):
            action.read_all()


def read_recording(path: Path, strict: bool = True) -> Recording:
    """The vehicles of a file as a recording; unless ``strict``, without bad ones. Raises ``InputError``."""
    found = read_scenario(path, strict)
    road = of_road(found.road, DIRECTION, found.road_path)
    made = recording_of(found.table, road, path.stem, found.notes, strict, found.computed)
    return replace(made, faults=found.faults)


def _follows_polylines(root: Element, boxes: Mapping[str, Box]) -> bool:
    """Whether all that happens is that each vehicle follows a polyline with times."""
    if any(str(x.tag).endswith("ControllerAction") for x in root.iter()):
        return False
    actions = root.findall("Storyboard/Story/Act/ManeuverGroup/Maneuver/Event/Action")
    actors = {x.get("entityRef") for x in root.findall("Storyboard/Story/Act/ManeuverGroup/Actors/EntityRef")}
    return bool(actions) and {*boxes} <= actors and all(map(_is_timed_polyline, actions))


def _is_timed_polyline(action: Element) -> bool:
    """Whether an Action follows a trajectory of which nothing needs a storyboard."""
    follow = action.find(_PLACES)
    if follow is None or follow.find("TimeReference/None") is not None:
        return False
    shapes = {x.tag for shape in follow.iter("Shape") for x in shape}
    kinds = {x.tag for position in follow.iter("Position") for x in position}
    return not shapes & {"Clothoid", "ClothoidSpline", "Nurbs"} and kinds <= {"WorldPosition"}


def _vertices(path: Path, root: Element, boxes: Mapping[str, Box]) -> Iterator[tuple[str, Floats]]:
    """By vehicle, rows of time, x, y and heading."""
    seen: set[str] = set()
    acts = root.findall("Storyboard/Story/Act")
    for act, group in ((x, y) for x in acts for y in x.findall("ManeuverGroup")):
        _read_counts(group)
        actors = [text_of(path, x, "entityRef", "an EntityRef") for x in group.findall("Actors/EntityRef")]
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


def _read_stop(path: Path, root: Element, last: float) -> None:
    """Pass over a StopTrigger that fires only after the last vertex; another one is left out."""
    for trigger in root.findall("Storyboard/StopTrigger"):
        clocks = [x for x in trigger.iter() if x.tag == "SimulationTimeCondition"]
        conditions = [x for x in trigger.iter() if x.tag == "Condition"]
        late = all(
            x.peek("rule") in _LATER and number_of(path, x, "value", "a StopTrigger") >= last - 1 / RATE
            for x in clocks
        )
        if late and len(clocks) == len(conditions):
            trigger.read_all()


def _read_counts(group: Element) -> None:
    """Read attributes of a maneuver group and its events that have no effect on one trajectory."""
    for node, name, plain in (
        (group, "maximumExecutionCount", "1"),
        *((x, "selectTriggeringEntities", "false") for x in group.findall("Actors")),
        *((x, "maximumExecutionCount", "1") for x in group.findall("Maneuver/Event")),
    ):
        if node.peek(name) == plain:
            node.note(name)
    for event in group.findall("Maneuver/Event"):
        event.note("priority")  # it is the only one of its actors


def _check_begin(path: Path, node: Element, first: float, told: str) -> None:
    """Raise ``InputError`` where an act or event may begin after ``first`` (s), when the first vertex is."""

    def in_time(condition: Element) -> bool:
        clock = condition.find("ByValueCondition/SimulationTimeCondition")
        if clock is None or clock.get("rule") not in _LATER:
            return False
        trigger = f"a StartTrigger of {told}"
        begin = number_of(path, clock, "value", trigger)
        if condition.peek("conditionEdge") in ("none", "rising"):
            condition.note("conditionEdge")
        delay = number_of(path, condition, "delay", trigger) if condition.get("delay") else 0.0
        return begin + delay <= first

    groups = node.findall("StartTrigger/ConditionGroup")
    if groups and not any(all(map(in_time, group.findall("Condition"))) for group in groups):
        rule = f"a SimulationTimeCondition that is met at time {first:g} is needed, that of the first Vertex"
        raise InputError(f"{path}: {told}: StartTrigger of the {node.tag}: {rule}")


def _check_exact(path: Path, follow: Element, told: str) -> None:
    """Raise ``InputError`` where vehicles need not be on the vertices at their times."""
    offset = "initialDistanceOffset"
    if follow.get(offset) and number_of(path, follow, offset, told) != 0:
        raise InputError(f"{path}: {told}: {offset}={follow.get(offset)}: begin at the first Vertex")
    if any(x.get("closed") in ("true", "1") for x in follow.iter("Trajectory")):
        raise InputError(f"{path}: {told}: closed=true: write out the way back as vertices with times")


def _polyline(path: Path, follow: Element, told: str) -> Floats:
    """Rows of time, x, y and heading."""
    _check_exact(path, follow, told)
    timing = follow.find("TimeReference/Timing")
    if timing is None or timing.get("domainAbsoluteRelative") != "absolute":
        raise InputError(f"{path}: {told}: a Timing with domainAbsoluteRelative=absolute is needed")
    scale, offset = (number_of(path, timing, x, f"the Timing of {told}") for x in ("scale", "offset"))
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
        time = number_of(path, vertex, "time", at) * scale + offset
        heading = number_of(path, place, "h", at) if place.get("h") else 0.0
        rows.append((time, *(number_of(path, place, x, at) for x in ("x", "y")), heading))
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


def _sampled(path: Path, boxes: Mapping[str, Box], ways: dict[str, CentreLine]) -> Table:
    tables = []
    for name, way in ways.items():
        first, last = math.ceil(way.time[0] * RATE - 1e-6), math.floor(way.time[-1] * RATE + 1e-6)
        if last - first >= MOST_SAMPLES:
            raise InputError(
                f"{path}: the trajectory of {name} lasts {way.time[-1] - way.time[0]:g} s; at most "
                f"{MOST_SAMPLES // RATE:,} s are read"
            )
        times = np.clip(np.arange(first, last + 1) / RATE, way.time[0], way.time[-1])
        s, v_lon, a_lon = curve(way.time, way.s, times)
        d, v_lat, a_lat = curve(way.time, way.d, times)
        moving = (s, d, v_lon, v_lat, a_lon, a_lat)
        tables.append(_rows(name, boxes[name], np.arange(first, last + 1) / RATE, moving))
    return _joined(path, tables)


def _of_play(path: Path, boxes: Mapping[str, Box], play: Play) -> tuple[Table, list[str]]:
    """The states of a storyboard, RATE a second, and notes on objects that are left out.

    An object is another vehicle after it was put somewhere else, or was away.
    """
    step = TICKS // RATE
    tables, notes = [], []
    against = sorted(x for x in boxes if any(x in now and not now[x].forward for now in play.states))
    for name, box in boxes.items():
        parts = [x for x in _presences(name, play, step) if len(x) > 1] if box.recorded else []
        for k, ticks in enumerate(parts):
            states = [play.states[tick][name] for tick in ticks]
            moving = np.array([[getattr(x, y) for x in states] for y in map(str, RECORDED)])
            moving[:2] += np.array(box.centre)[:, None]
            called = f"{name} ({k + 1})" if k else name
            tables.append(_rows(called, box, np.array(ticks) / TICKS, tuple(moving)))
        if len(parts) > 1:
            notes.append(f"{name} is put somewhere else: from then on it is {name} (2)")
        if not parts and box.recorded and name not in against:
            notes.append(
                f"left out, as no TeleportAction, AddEntityAction or trajectory says where it is: {name}"
                if name not in play.controlled
                else f"{LEFT_OUT}, as the file does not say where it is: {name}, {play.controlled[name]}"
            )
        elif name in play.controlled:
            notes.append(f"{LEFT_OUT} from then on: {name}, {play.controlled[name]}")
    for rule, names in (
        ("they are no motor vehicles", sorted(x for x, box in boxes.items() if not box.recorded)),
        ("they drive against the others", [x for x in against if boxes[x].recorded]),
    ):
        if names:
            notes.append(f"left out, as {rule}: {', '.join(names)}")
    if not tables:
        raise InputError(f"{path}: no motor vehicle is on the road: {'; '.join(notes)}")
    return _joined(path, tables), notes


def _presences(name: str, play: Play, step: int) -> Iterator[list[int]]:
    """Ticks at which an object drives along the road, every ``step``-th, from one jump to the next one."""
    found: list[int] = []
    for tick in range(0, len(play.states), step):
        there = name in play.states[tick] and play.states[tick][name].forward
        jumps = there and any(play.jumps(name, x) for x in range(max(tick - step, 0) + 1, tick + 1))
        if found and (not there or jumps):
            yield found
            found = []
        if there:
            found.append(tick)
    if found:
        yield found


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


def _find(path: Path) -> dict[str, Files]:
    """The scenarios of a folder or a file, and those of distributions."""
    if split(path) is not None:
        return {path.stem: files_of(path)}
    files = (y for x in with_suffix(path, ".xosc") for y in scenarios_of(x))
    return {x.stem: files_of(x) for x in files}


def files_of(path: Path) -> Files:
    """Every file that a scenario is read from, itself last: map, catalogues, and what varies it."""
    found = split(path)
    varied = () if found is None else (found[0], read_distribution(found[0]).scenario)
    named: Files = ()
    with suppress(InputError):  # a scenario that cannot be read says why when it is
        document = open_document(path)
        named = catalogues_of(document)
        named = (map_of(document), *named)
    return (*dict.fromkeys((*named, *varied)), path)


FORMAT = Format(
    "OpenSCENARIO",
    "NAME.xosc, whose storyboard is run",
    _find,
    read_recording,
    "{0}, sampled {rate} times a second",
    is_name=lambda path: split(path) is not None,
)
