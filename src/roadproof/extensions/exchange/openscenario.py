"""Scenarios in OpenSCENARIO XML (ASAM, 1.0 to 1.3): vehicles that follow polylines, or a storyboard.

The road is that in OpenDRIVE that the file names. Between vertices places are interpolated by cubics through
them with the speeds that three vertices in a row have, which is exact where accelerations are constant across
them. Speeds and accelerations are those of the cubics. Files with other actions, or with vehicles that keep
their initial state, are run (``storyboard``). A box is aligned with the road; its centre is where that of the
file's box is, and in a storyboard where it is when the vehicle is aligned with the road. Speeds are those of
s and d, which differ on a bend by the factor 1 - κd from those of the vehicle. Pedestrians, other objects and
vehicles that drive against the others move in a storyboard, but are no part of the recording.
"""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.exchange.scenario_samples import RATE, centre_line, sample_centre_lines, sample_play
from roadproof.extensions.exchange.storyboard.box import ObjectBox
from roadproof.extensions.exchange.storyboard.conditions import TICKS
from roadproof.extensions.exchange.storyboard.distributions import read_distribution, scenarios_of, split
from roadproof.extensions.exchange.storyboard.document import catalogues_of, open_document
from roadproof.extensions.exchange.storyboard.faults import faults_of
from roadproof.extensions.exchange.storyboard.stage import (
    map_of,
    number_of,
    omission_notes,
    open_stage,
    run_stage,
    text_of,
)
from roadproof.extensions.maps.xml_reader import Element
from roadproof.extensions.traffic.formats.recording import Floats, Recording
from roadproof.extensions.traffic.formats.samples import DIRECTION, recording_of
from roadproof.extensions.traffic.formats.source import Files, Format, with_suffix
from roadproof.extensions.traffic.formats.straight import of_road
from roadproof.extensions.traffic.formats.table import ColumnTable
from roadproof.world.road import Road

_FOLLOWS = "followingMode=follow is taken as position: vehicles are on their trajectories, as in esmini"
_LATER = ("greaterThan", "greaterOrEqual")
_PLACES = "PrivateAction/RoutingAction/FollowTrajectoryAction"


@dataclass(frozen=True)
class SampledScenario:
    """Samples of all vehicles, RATE a second, the road with its file, and notes on them.

    ``otherwise``: those of the notes that say what was left out, or taken otherwise than it is written.
    ``faults``: parts of the motion that no vehicle drives. ``computed``: a storyboard was run. ``unread``:
    notes on parts of the file that were left out, and on vehicles that controllers move.
    """

    table: ColumnTable
    road: Road
    road_path: Path
    notes: tuple[str, ...]
    otherwise: tuple[str, ...] = ()
    faults: tuple[str, ...] = ()
    computed: bool = False
    unread: tuple[str, ...] = ()


def read_scenario(path: Path, strict: bool = False) -> SampledScenario:
    """The vehicles of a file; if ``strict``, nothing of it may be left out.

    Raises ``InputError`` that names element and rule.
    """
    scenario = _read_scenario(path)
    if strict and scenario.unread:
        raise InputError(f"{path}: {'; '.join(scenario.unread)}; unless read strictly, the rest is read")
    return scenario


def _read_scenario(path: Path) -> SampledScenario:
    stage = open_stage(path)
    document, boxes, road, road_path = stage.document, stage.boxes, stage.road, stage.road_path
    root = document.root
    modes = {x.get("followingMode") for x in root.iter("TrajectoryFollowingMode")}
    follows = (_FOLLOWS,) if "follow" in modes else ()
    distribution_notes = (document.distribution_note,) if document.distribution_note else ()
    if _follows_polylines(root, boxes):
        _read_init(root)
        centre_lines = {name: centre_line(x, boxes[name], road) for name, x in _vertices(path, root, boxes)}
        _read_stop(path, root, max(float(x.time[-1]) for x in centre_lines.values()))
        note = f"speeds and accelerations are those of curves through the vertices, {RATE} samples a second"
        omissions = omission_notes(stage)
        otherwise = (*follows, *distribution_notes, *omissions)
        table = sample_centre_lines(path, boxes, centre_lines)
        return SampledScenario(table, road, road_path, (note, *otherwise), otherwise, unread=omissions)
    stage, play = run_stage(stage)
    if len(play.states) < 2 * TICKS // RATE:
        raise InputError(f"{path}: the storyboard ends at {len(play.states) / TICKS:g} s: {play.ending}")
    ending = f"the storyboard ends at {(len(play.states) - 1) / TICKS:g} s: {play.ending}"
    note = f"the storyboard was run with conditions evaluated {TICKS} times a second, {RATE} samples a second"
    table, left_out = sample_play(path, boxes, play)
    controlled = tuple(x for x in left_out if any(ending in x for ending in play.controlled.values()))
    omissions = (*controlled, *omission_notes(stage))
    otherwise = (*follows, *distribution_notes, *(x for x in left_out if x not in controlled), *omissions)
    faults = faults_of(play, boxes)
    idle = (f"events that never start: {', '.join(play.idle)}",) if play.idle else ()
    notes = (note, ending, *idle, *otherwise, *faults)
    return SampledScenario(
        table, stage.road, road_path, notes, otherwise, faults, computed=True, unread=omissions
    )


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
    scenario = read_scenario(path, strict)
    road = of_road(scenario.road, DIRECTION, scenario.road_path)
    recording = recording_of(scenario.table, road, path.stem, scenario.notes, strict, scenario.computed)
    return replace(recording, faults=scenario.faults)


def _follows_polylines(root: Element, boxes: Mapping[str, ObjectBox]) -> bool:
    """Return whether all that happens is that each vehicle follows a polyline with times."""
    if any(str(x.tag).endswith("ControllerAction") for x in root.iter()):
        return False
    actions = root.findall("Storyboard/Story/Act/ManeuverGroup/Maneuver/Event/Action")
    actors = {x.get("entityRef") for x in root.findall("Storyboard/Story/Act/ManeuverGroup/Actors/EntityRef")}
    return bool(actions) and {*boxes} <= actors and all(map(_is_timed_polyline, actions))


def _is_timed_polyline(action: Element) -> bool:
    """Return whether an Action follows a trajectory of which nothing needs a storyboard."""
    follow = action.find(_PLACES)
    if follow is None or follow.find("TimeReference/None") is not None:
        return False
    shapes = {x.tag for shape in follow.iter("Shape") for x in shape}
    kinds = {x.tag for position in follow.iter("Position") for x in position}
    return not shapes & {"Clothoid", "ClothoidSpline", "Nurbs"} and kinds <= {"WorldPosition"}


def _vertices(path: Path, root: Element, boxes: Mapping[str, ObjectBox]) -> Iterator[tuple[str, Floats]]:
    """Yield the rows of time, x, y and heading of each vehicle."""
    seen: set[str] = set()
    acts = root.findall("Storyboard/Story/Act")
    for act, group in ((x, y) for x in acts for y in x.findall("ManeuverGroup")):
        _read_counts(group)
        actors = [text_of(path, x, "entityRef", "an EntityRef") for x in group.findall("Actors/EntityRef")]
        for event, action in ((x, y) for x in group.findall("Maneuver/Event") for y in x.findall("Action")):
            where = f"Action {action.get('name')} of {', '.join(actors)}"
            follow = action.find(_PLACES)
            if follow is None:
                raise InputError(f"{path}: {where} is no FollowTrajectoryAction; only these are read")
            vertices = _polyline(path, follow, where)
            for node in (act, event):
                _check_begin(path, node, vertices[0, 0], where)
            for name in actors:
                if name not in boxes:
                    raise InputError(f"{path}: {where}: there is no ScenarioObject {name}")
                if name in seen:
                    raise InputError(f"{path}: {name} follows two trajectories; one is needed")
                seen.add(name)
                yield name, vertices


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


def _check_begin(path: Path, node: Element, first: float, where: str) -> None:
    """Raise ``InputError`` where an act or event may begin after ``first`` (s), when the first vertex is."""

    def in_time(condition: Element) -> bool:
        clock = condition.find("ByValueCondition/SimulationTimeCondition")
        if clock is None or clock.get("rule") not in _LATER:
            return False
        trigger = f"a StartTrigger of {where}"
        begin = number_of(path, clock, "value", trigger)
        if condition.peek("conditionEdge") in ("none", "rising"):
            condition.note("conditionEdge")
        delay = number_of(path, condition, "delay", trigger) if condition.get("delay") else 0.0
        return begin + delay <= first

    groups = node.findall("StartTrigger/ConditionGroup")
    if groups and not any(all(map(in_time, group.findall("Condition"))) for group in groups):
        rule = f"a SimulationTimeCondition that is met at time {first:g} is needed, that of the first Vertex"
        raise InputError(f"{path}: {where}: StartTrigger of the {node.tag}: {rule}")


def _check_exact(path: Path, follow: Element, where: str) -> None:
    """Raise ``InputError`` where vehicles need not be on the vertices at their times."""
    offset = "initialDistanceOffset"
    if follow.get(offset) and number_of(path, follow, offset, where) != 0:
        raise InputError(f"{path}: {where}: {offset}={follow.get(offset)}: begin at the first Vertex")
    if any(x.get("closed") in ("true", "1") for x in follow.iter("Trajectory")):
        raise InputError(f"{path}: {where}: closed=true: write out the way back as vertices with times")


def _polyline(path: Path, follow: Element, where: str) -> Floats:
    """Rows of time, x, y and heading."""
    _check_exact(path, follow, where)
    timing = follow.find("TimeReference/Timing")
    if timing is None or timing.get("domainAbsoluteRelative") != "absolute":
        raise InputError(f"{path}: {where}: a Timing with domainAbsoluteRelative=absolute is needed")
    scale, offset = (number_of(path, timing, x, f"the Timing of {where}") for x in ("scale", "offset"))
    shape = next((x for x in follow.iter("Shape")), None)
    shapes = [] if shape is None else [x.tag for x in shape]
    if shape is None or shapes != ["Polyline"]:
        raise InputError(f"{path}: {where}: Shape {' and '.join(shapes) or 'missing'}; a Polyline is needed")
    rows = []
    for number, vertex in enumerate(shape.findall("Polyline/Vertex"), 1):
        at = f"Vertex {number} of {where}"
        place = vertex.find("Position/WorldPosition")
        if place is None:
            raise InputError(f"{path}: {at}: a WorldPosition is needed")
        time = number_of(path, vertex, "time", at) * scale + offset
        heading = number_of(path, place, "h", at) if place.get("h") else 0.0
        rows.append((time, *(number_of(path, place, x, at) for x in ("x", "y")), heading))
    vertices = np.array(rows).reshape(-1, 4)
    if len(vertices) < 2 or not (np.diff(vertices[:, 0]) > 0).all():
        raise InputError(f"{path}: {where}: at least two vertices are needed, each later than the one before")
    return vertices


def _find(path: Path) -> dict[str, Files]:
    """The scenarios of a folder or a file, and those of distributions."""
    if split(path) is not None:
        return {path.stem: files_of(path)}
    files = (y for x in with_suffix(path, ".xosc") for y in scenarios_of(x))
    return {x.stem: files_of(x) for x in files}


def files_of(path: Path) -> Files:
    """Every file that a scenario is read from, itself last: map, catalogues, and what varies it."""
    distribution = split(path)
    distribution_files = (
        () if distribution is None else (distribution[0], read_distribution(distribution[0]).scenario)
    )
    named_files: Files = ()
    with suppress(InputError):  # a scenario that cannot be read says why when it is
        document = open_document(path)
        named_files = catalogues_of(document)
        named_files = (map_of(document), *named_files)
    return (*dict.fromkeys((*named_files, *distribution_files)), path)


FORMAT = Format(
    "OpenSCENARIO",
    "NAME.xosc, whose storyboard is run",
    _find,
    read_recording,
    "{0}, sampled {rate} times a second",
    is_name=lambda path: split(path) is not None,
)
