"""Recordings in CommonRoad XML, version 2020a: dynamic obstacles on lanelets, projected on their road.

s and d run along the centre line of the longest lane of a carriageway. Occupancy is decided in the
plane, on the box as it is turned; s, d, v_lon and v_lat treat the box as aligned with the road, which
at the headings of highway traffic moves its corners by a few centimetres.
"""

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.traffic.formats import other_format
from roadproof.traffic.lanelets import MeasuredLane, MeasuredLanelet, beside_of, lanes_of, zones_of
from roadproof.traffic.overlaps import describe_overlaps
from roadproof.traffic.plausible import (
    LARGEST_ACCELERATION,
    LARGEST_SIZE,
    LARGEST_SPEED,
    find_doubts,
)
from roadproof.traffic.projection import boxes_of, even_line, inside, overlap, project, triangles_of
from roadproof.traffic.recording import (
    ZONES,
    Bools,
    Floats,
    Integers,
    Lane,
    Masks,
    Recording,
    offsets,
    with_notes,
)
from roadproof.traffic.repeats import moments_of

Element = ElementTree.Element
ATTRIBUTES = {"accessRamp": "merge", "exitRamp": "departure"}
"""lanelet types that are not of the main road, and the paper's attribute for them."""


@dataclass(frozen=True)
class _Obstacle:
    """Columns of ``states``: x, y (centre of the box), orientation, velocity, acceleration."""

    id: int
    kind: str
    length: float
    width: float
    first_step: int
    states: Floats


def read_commonroad(path: Path, truck_length: float = 7.0) -> Recording:
    """The traffic of a CommonRoad file; frame k is time step k.

    A vehicle longer than ``truck_length`` (m) counts as a truck whatever its type says, since data
    sets such as NGSIM's label every vehicle a car. ``notes`` tell of overlapping vehicles, of noise
    and of obstacles that were left out. Raises ``InputError`` for files that are no such recording.
    """
    root = _parse(path)
    step = _number(path, root.get("timeStepSize"), "timeStepSize of commonRoad")
    rate = round(1 / step) if step > 0 else 0
    if rate < 1 or not math.isclose(rate * step, 1):
        raise InputError(f"{path}: timeStepSize={step}: a whole number of steps a second is needed")
    lanelets = _read_lanelets(path, root)
    lanes = lanes_of(lanelets)
    if len(lanes) > 32:
        raise InputError(f"{path}: {len(lanes)} lanes; at most 32 are supported, cut out a part of the road")
    obstacles, notes = _read_obstacles(path, root, truck_length)
    recording = _place(path.stem, rate, lanelets, lanes, obstacles, notes)
    return with_notes(recording, (*_check_plausible(path, recording), *_describe(recording)))


def _place(
    name: str,
    rate: int,
    lanelets: Mapping[str, MeasuredLanelet],
    lanes: tuple[MeasuredLane, ...],
    obstacles: Sequence[_Obstacle],
    notes: tuple[str, ...],
) -> Recording:
    counts = np.array([len(o.states) for o in obstacles])
    states = np.concatenate([o.states for o in obstacles])
    length, width = (np.array([getattr(o, x) for o in obstacles]) for x in ("length", "width"))
    sizes = np.stack((length, width), axis=1)
    centre, heading, speed, pull = states[:, :2], states[:, 2], states[:, 3], states[:, 4]
    boxes = boxes_of(centre, heading, np.repeat(length, counts), np.repeat(width, counts))
    occupancy, lane, zones = _occupy(lanelets, lanes, boxes, centre)
    start = offsets(counts)
    direction = _carriageway(lanes, occupancy, start)
    on = np.repeat(direction, counts)
    s, d, turned, stretch = (np.empty(len(states)) for _ in range(4))
    for way in np.unique(direction):
        ours = on == way
        line = _centre_line(lanelets, [x for x in lanes if x.carriageway == way])
        along = project(even_line(line), centre[ours])
        s[ours], d[ours], turned[ours] = along.s, along.d, heading[ours] - along.heading
        stretch[ours] = along.stretch
    notes = (*notes, _say_stretch(stretch, start, [o.id for o in obstacles]))
    return Recording(
        name=name,
        rate=rate,
        lanes=tuple(Lane(x.name, x.carriageway) for x in lanes),
        beside=beside_of(lanelets, lanes),
        vehicle_id=np.array([o.id for o in obstacles]),
        direction=direction,
        kind=np.array([o.kind for o in obstacles]),
        length=length,
        width=width,
        first_frame=np.array([o.first_step for o in obstacles]),
        start=start,
        s=s + np.repeat(length, counts) / 2,
        d=d + np.repeat(width, counts) / 2,
        v_lon=speed * np.cos(turned),
        v_lat=speed * np.sin(turned),
        a_lon=pull * np.cos(turned),
        a_lat=pull * np.sin(turned),
        occupancy=occupancy,
        lane=lane,
        zones=zones,
        notes=notes,
        moments=moments_of(np.column_stack((speed, pull, np.repeat(sizes, counts, axis=0))), start),
    )


def _say_stretch(stretch: Floats, start: Integers, ids: Sequence[int]) -> str:
    """How far lengths along the reference line are from those that vehicles drove."""
    each = np.add.reduceat(stretch, start[:-1]) / np.diff(start)
    worst = int(np.argmax(np.abs(each)))
    return (
        f"lengths along the reference line are off by {100 * np.abs(each).mean():.1f} % on average, by "
        f"{100 * abs(each[worst]):.1f} % on the way of obstacle {ids[worst]}, by up to "
        f"{100 * np.abs(stretch).max():.1f} % in a bend"
    )


def _occupy(
    lanelets: Mapping[str, MeasuredLanelet], lanes: Sequence[MeasuredLane], boxes: Floats, centre: Floats
) -> tuple[Masks, Integers, Masks]:
    occupancy, zones = np.zeros(len(boxes), np.uint32), np.zeros(len(boxes), np.uint32)
    lane = np.full(len(boxes), -1, np.int64)
    zone_of = zones_of(lanelets)
    for k, measured in enumerate(lanes):
        for name in measured.lanelets:
            triangles = triangles_of(lanelets[name].left, lanelets[name].right)
            here: Bools = overlap(boxes, triangles)
            occupancy[here] |= np.uint32(1 << k)
            zones[here] |= np.uint32(1 << ZONES.index(zone_of[name]))
            near = np.flatnonzero(here & (lane < 0))
            lane[near[inside(centre[near], triangles)]] = k
    return occupancy, lane, zones


def _carriageway(lanes: Sequence[MeasuredLane], occupancy: Masks, start: Integers) -> Integers:
    """Where each vehicle is most often; the first carriageway for one that is nowhere."""
    ways = sorted({x.carriageway for x in lanes})
    masks = [sum(1 << k for k, x in enumerate(lanes) if x.carriageway == way) for way in ways]
    often = [np.add.reduceat((occupancy & np.uint32(m) != 0).astype(np.int64), start[:-1]) for m in masks]
    chosen: Integers = np.array(ways)[np.argmax(often, axis=0)]
    return chosen


def _centre_line(lanelets: Mapping[str, MeasuredLanelet], lanes: Sequence[MeasuredLane]) -> Floats:
    lines = []
    for lane in lanes:
        points = np.concatenate([(lanelets[x].left + lanelets[x].right) / 2 for x in lane.lanelets])
        apart = np.concatenate(([True], np.hypot(*np.diff(points, axis=0).T) > 1e-3))
        lines.append(points[apart])
    return max(lines, key=lambda line: float(np.hypot(*np.diff(line, axis=0).T).sum()))


def _check_plausible(path: Path, recording: Recording) -> Iterator[str]:
    """Notes on what the file contradicts itself in. Raises ``InputError`` where that is too much."""
    for doubt in find_doubts(recording):
        vehicle, step = recording.row_vehicle[doubt.row], recording.row_frame[doubt.row]
        who = f"dynamicObstacle {recording.vehicle_id[vehicle]}, time step {step}"
        if doubt.refused:
            raise InputError(f"{path}: {who}: {doubt.told}")
        yield f"{who}: {doubt.told}"


def _describe(recording: Recording) -> tuple[str, ...]:
    """Notes on overlaps, noise and vehicles beside the road."""
    noisy = np.percentile(recording.a_lon, [0.5, 99.5])
    off = int(np.count_nonzero(recording.lane < 0))
    notes = list(describe_overlaps(recording))
    notes.append(f"accelerations: 99 % within {noisy[0]:.1f} and {noisy[1]:.1f} m/s²")
    if off:
        notes.append(f"{off} of {len(recording.s)} samples have the centre of the box on no lane")
    return tuple(notes)


def _parse(path: Path) -> Element:
    try:
        text = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: the file cannot be read ({error.strerror}); check the path") from None
    other = other_format(text)
    if other is not None:
        raise InputError(f"{path}: the file {other}")
    if b"<!DOCTYPE" in text or b"<!ENTITY" in text:
        raise InputError(f"{path}: a CommonRoad file has no document type or entities; remove them")
    try:
        root = ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise InputError(
            f"{path}: no well-formed XML ({error}); get the file again from its source"
        ) from None
    if root.tag != "commonRoad" or root.get("commonRoadVersion") != "2020a":
        found = f"{root.tag} {root.get('commonRoadVersion')}"
        raise InputError(f"{path}: the root is {found}, but commonRoad of commonRoadVersion 2020a is needed")
    return root


def _read_lanelets(path: Path, root: Element) -> dict[str, MeasuredLanelet]:
    nodes = {node.get("id", ""): node for node in root.findall("lanelet")}
    if not nodes:
        raise InputError(f"{path}: the file has no lanelet; a road is needed to place vehicles on")
    if len(nodes) > 32:
        raise InputError(
            f"{path}: {len(nodes)} lanelets; at most 32 are supported, cut out a part of the road"
        )
    return {name: _read_lanelet(path, node, nodes) for name, node in nodes.items()}


def _read_lanelet(path: Path, node: Element, known: Mapping[str, Element]) -> MeasuredLanelet:
    name = node.get("id", "")
    where = f"lanelet {name}"
    left, right = (_read_line(path, node.find(x), f"{x} of {where}") for x in ("leftBound", "rightBound"))
    if len(left) != len(right):
        raise InputError(f"{path}: {where} has bounds of {len(left)} and {len(right)} points; must be equal")
    types = {(x.text or "").strip() for x in node.findall("laneletType")}

    def refs(*tags: str) -> tuple[str, ...]:
        found = (x for tag in tags for x in node.findall(tag) if x.get("drivingDir", "same") == "same")
        return tuple(x.get("ref", "") for x in found if x.get("ref") in known)

    attribute = next((ATTRIBUTES[x] for x in sorted(types) if x in ATTRIBUTES), "main")
    return MeasuredLanelet(
        name, left, right, attribute, refs("successor"), refs("adjacentLeft", "adjacentRight")
    )


def _read_line(path: Path, node: Element | None, what: str) -> Floats:
    points = [] if node is None else node.findall("point")
    if len(points) < 2:
        raise InputError(f"{path}: {what} has {len(points)} points; at least two are needed")
    return np.array([[_number(path, p.findtext(x), f"{x} in {what}") for x in "xy"] for p in points])


def _read_obstacles(
    path: Path, root: Element, truck_length: float
) -> tuple[list[_Obstacle], tuple[str, ...]]:
    obstacles, left_out = [], []
    seen: set[int] = set()
    for node in root.findall("dynamicObstacle"):
        number = int(_number(path, node.get("id"), "id of a dynamicObstacle"))
        if number in seen:
            raise InputError(f"{path}: dynamicObstacle {number} occurs twice; ids must differ")
        seen.add(number)
        if node.find("shape/rectangle") is None or node.find("trajectory") is None:
            left_out.append(number)
        else:
            obstacles.append(_read_obstacle(path, node, number, truck_length))
    if not obstacles:
        raise InputError(f"{path}: the file has no dynamicObstacle with a rectangle and a trajectory")
    shown = ", ".join(map(str, left_out))
    notes = (f"obstacles left out (no rectangle or no trajectory): {shown}",) if left_out else ()
    return sorted(obstacles, key=lambda o: o.id), notes


def _read_obstacle(path: Path, node: Element, number: int, truck_length: float) -> _Obstacle:
    where = f"dynamicObstacle {number}"
    length, width = (
        _number(path, node.findtext(f"shape/rectangle/{x}"), f"{x} of {where}") for x in ("length", "width")
    )
    if length <= 0 or width <= 0:
        raise InputError(
            f"{path}: {where} has length={length}, width={width}; both must be greater than zero"
        )
    if max(length, width) > LARGEST_SIZE:
        told = f"{where} has length={length:g}, width={width:g}"
        raise InputError(f"{path}: {told}; no vehicle is larger than {LARGEST_SIZE:g} m")
    rows = [
        _read_state(path, x, where)
        for x in (*node.findall("initialState"), *node.findall("trajectory/state"))
    ]
    states = np.array(rows)
    if (np.diff(states[:, 0]) != 1).any():
        k = int(np.argmax(np.diff(states[:, 0]) != 1))
        steps = f"{states[k, 0]:g} is followed by {states[k + 1, 0]:g}"
        raise InputError(f"{path}: {where}: time step {steps}; the steps of a trajectory have no gaps")
    label = (node.findtext("type") or "").strip()
    kind = "Truck" if label in ("truck", "bus") or length > truck_length else "Car"
    return _Obstacle(number, kind, length, width, int(states[0, 0]), states[:, 1:])


def _read_state(path: Path, node: Element, where: str) -> list[float]:
    places = {
        "time": "time/exact",
        "x": "position/point/x",
        "y": "position/point/y",
        "orientation": "orientation/exact",
        "velocity": "velocity/exact",
        "acceleration": "acceleration/exact",
    }
    state = {
        what: _number(path, node.findtext(place), f"{what} in a state of {where}")
        for what, place in places.items()
    }
    for what, most in (("velocity", LARGEST_SPEED), ("acceleration", LARGEST_ACCELERATION)):
        if abs(state[what]) > most:
            at = f"{what}={state[what]:g} of {where} at time step {state['time']:g}"
            raise InputError(f"{path}: {at}: must lie between {-most:g} and {most:g}")
    return list(state.values())


def _number(path: Path, text: str | None, what: str) -> float:
    try:
        value = float(text or "")
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{path}: {what} is {text!r}; a finite number is needed")
    return value
