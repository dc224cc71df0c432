"""Recordings in CommonRoad XML, version 2020a: dynamic obstacles on lanelets, projected on their road.

``NAME_zones.toml`` beside the file may say which lanelets are of ramps, and in which zone.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.recordings.formats.lanelets import ZONES_ENDING, network_of
from roadproof.recordings.formats.measured_roads import MeasuredTraffic, place_traffic
from roadproof.recordings.formats.neighbours import describe_overlaps
from roadproof.recordings.formats.plausible import (
    LARGEST_ACCELERATION,
    LARGEST_SIZE,
    LARGEST_SPEED,
    check,
)
from roadproof.recordings.formats.recording import Floats, Integers, Recording, offsets, with_notes
from roadproof.recordings.formats.repeats import moments_of
from roadproof.recordings.formats.source import Format, find_files
from roadproof.recordings.formats.topology import MeasuredLanelet
from roadproof.runtime.xml_reader import Element, by_id, number_in, read_xml
from roadproof.world.road import Attribute

ATTRIBUTES: Mapping[str, Attribute] = {
    "accessRamp": "merge",
    "exitRamp": "departure",
    "mainCarriageWay": "main",
}
"""Lanelet types that say what is main road and what is not, and the paper's attribute for them."""


LARGEST_PLACE, LARGEST_ORIENTATION = 1e8, 100.0
"""m, as in all coordinates of maps, and rad, which need not be one turn."""


_STATE = {
    "time": ("time/exact", math.inf),
    "x": ("position/point/x", LARGEST_PLACE),
    "y": ("position/point/y", LARGEST_PLACE),
    "orientation": ("orientation/exact", LARGEST_ORIENTATION),
    "velocity": ("velocity/exact", LARGEST_SPEED),
    "acceleration": ("acceleration/exact", LARGEST_ACCELERATION),
    "velocityY": ("velocityY/exact", LARGEST_SPEED),
}
"""What a state has, where, and how large it is at most; ``velocityY`` may be missing."""


@dataclass(frozen=True)
class _Obstacle:
    """Columns of ``states``: x, y (centre of the box), orientation, velocity, acceleration, velocityY.

    Velocity and acceleration are along the box, velocityY to its left.
    """

    id: int
    kind: str
    label: str
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
    root = read_xml(path, "commonRoad")
    if root.get("commonRoadVersion") != "2020a":
        told = f"commonRoadVersion={root.get('commonRoadVersion')}"
        raise InputError(f"{path}: {told}: commonRoad of version 2020a is needed")
    step = number_in(path, root.get("timeStepSize"), "timeStepSize of commonRoad")
    rate = round(1 / step) if step > 0 else 0
    if rate < 1 or not math.isclose(rate * step, 1):
        raise InputError(f"{path}: timeStepSize={step}: a whole number of steps a second is needed")
    nodes = by_id(path, root.findall("lanelet"))
    if not nodes:
        raise InputError(f"{path}: the file has no lanelet; a road is needed to place vehicles on")
    lanelets = {name: _read_lanelet(path, node, nodes) for name, node in nodes.items()}
    network = network_of(path, lanelets)
    obstacles, notes = _read_obstacles(path, root, truck_length)
    traffic = _traffic(path.stem, rate, obstacles, notes)
    if _is_made(root):
        traffic = replace(traffic, moments=np.zeros_like(traffic.moments))
    recording = place_traffic(traffic, network)
    return with_notes(recording, (*_check_plausible(path, recording), *_describe(recording)))


def _is_made(root: Element) -> bool:
    """Whether the traffic was made and not recorded: ZAM stands for no country in a benchmark's name.

    Then no file is a window of what another shows.
    """
    return root.get("benchmarkID", "").removeprefix("C-").startswith("ZAM_")


def _traffic(name: str, rate: int, obstacles: Sequence[_Obstacle], notes: tuple[str, ...]) -> MeasuredTraffic:
    counts = np.array([len(o.states) for o in obstacles])
    states = np.concatenate([o.states for o in obstacles])
    length, width = (np.array([getattr(o, x) for o in obstacles]) for x in ("length", "width"))
    sizes = np.repeat(np.stack((length, width), axis=1), counts, axis=0)
    heading, speed, pull, drift = states[:, 2], states[:, 3], states[:, 4], states[:, 5]
    forward = np.stack((np.cos(heading), np.sin(heading)), axis=1)
    aside = np.stack((-np.sin(heading), np.cos(heading)), axis=1)
    start = offsets(counts)
    return MeasuredTraffic(
        name=name,
        rate=rate,
        vehicle_id=np.array([o.id for o in obstacles]),
        kind=np.array([o.kind for o in obstacles]),
        label=np.array([o.label for o in obstacles]),
        length=length,
        width=width,
        first_frame=np.array([o.first_step for o in obstacles]),
        start=start,
        centre=states[:, :2],
        heading=heading,
        velocity=speed[:, None] * forward + drift[:, None] * aside,
        acceleration=pull[:, None] * forward + _change(drift, start, rate)[:, None] * aside,
        notes=notes,
        moments=moments_of(np.column_stack((speed, pull, sizes)), start),
    )


def _change(drift: Floats, start: Integers, rate: int) -> Floats:
    """What velocityY changes by in a second, from each sample to the next; the last one is as the one before.

    States have no acceleration across the box.
    """
    step = np.diff(drift, append=0.0) * rate
    last = start[1:] - 1
    step[last] = np.where(np.diff(start) > 1, step[last - 1], 0.0)
    return step


def _check_plausible(path: Path, recording: Recording) -> Iterator[str]:
    """Notes on what the file contradicts itself in. Raises ``InputError`` where that is too much."""
    checks, ids = check(recording), recording.vehicle_id[recording.row_vehicle]
    found = [
        (f"{ids[x.row]}, time step {recording.row_frame[x.row]}: {x.told}", x.refused)
        for x in checks.doubts()
    ]
    off = checks.off_road()
    if off is not None:
        found.append((f"{ids[off.row]}: on no lanelet at any time, like {off.count} obstacles", off.refused))
    for told, refused in found:
        if refused:
            raise InputError(f"{path}: dynamicObstacle {told}")
        yield f"dynamicObstacle {told}"


def _describe(recording: Recording) -> Iterator[str]:
    """Notes on overlaps, noise and vehicles beside the road."""
    yield from describe_overlaps(recording)
    low, high = np.percentile(recording.a_lon, [0.5, 99.5])
    yield f"accelerations: 99 % within {low:.1f} and {high:.1f} m/s²"
    off = int(np.count_nonzero(recording.lane < 0))
    if off:
        yield f"{off} of {len(recording.s)} samples have the centre of the box on no lane"


def _read_lanelet(path: Path, node: Element, known: Mapping[str, Element]) -> MeasuredLanelet:
    name = node.get("id", "")
    where = f"lanelet {name}"
    left, right = (_read_line(path, node.find(x), f"{x} of {where}") for x in ("leftBound", "rightBound"))
    if len(left) != len(right):
        raise InputError(f"{path}: {where} has bounds of {len(left)} and {len(right)} points; must be equal")
    types = {(x.text or "").strip() for x in node.findall("laneletType")}

    def refs(*tags: str) -> tuple[str, ...]:
        found = [x for tag in tags for x in node.findall(tag)]
        for x in found:
            if x.get("ref") not in known:
                raise InputError(f"{path}: {where}: {x.tag} {x.get('ref')} is no lanelet of the file")
        return tuple(x.get("ref", "") for x in found if x.get("drivingDir", "same") == "same")

    refs("predecessor")
    attribute = next((ATTRIBUTES[x] for x in sorted(types) if x in ATTRIBUTES), None)
    return MeasuredLanelet(
        name, left, right, attribute, refs("successor"), refs("adjacentLeft", "adjacentRight")
    )


def _read_line(path: Path, node: Element | None, what: str) -> Floats:
    points = [] if node is None else node.findall("point")
    if len(points) < 2:
        raise InputError(f"{path}: {what} has {len(points)} points; at least two are needed")
    return np.array([[number_in(path, p.findtext(x), f"{x} in {what}") for x in "xy"] for p in points])


def _read_obstacles(
    path: Path, root: Element, truck_length: float
) -> tuple[list[_Obstacle], tuple[str, ...]]:
    obstacles, left_out = [], []
    seen: set[int] = set()
    for node in root.findall("dynamicObstacle"):
        number = int(number_in(path, node.get("id"), "id of a dynamicObstacle"))
        if number in seen:
            raise InputError(f"{path}: dynamicObstacle {number} occurs twice; ids must differ")
        seen.add(number)
        shape = node.find("shape")
        if shape is None or [x.tag for x in shape] != ["rectangle"] or node.find("trajectory") is None:
            left_out.append(number)
        else:
            obstacles.append(_read_obstacle(path, node, number, truck_length))
    if not obstacles:
        raise InputError(f"{path}: the file has no dynamicObstacle with a rectangle and a trajectory")
    shown = ", ".join(map(str, left_out))
    notes = [f"obstacles left out (not one rectangle, or no trajectory): {shown}"] if left_out else []
    static = len(root.findall("staticObstacle"))
    if static:
        notes.append(f"{static} static obstacles left out: they are no traffic")
    return sorted(obstacles, key=lambda o: o.id), tuple(notes)


def _read_obstacle(path: Path, node: Element, number: int, truck_length: float) -> _Obstacle:
    where = f"dynamicObstacle {number}"
    length, width = (
        number_in(path, node.findtext(f"shape/rectangle/{x}"), f"{x} of {where}") for x in ("length", "width")
    )
    if length <= 0 or width <= 0:
        told = f"{where} has length={length}, width={width}"
        raise InputError(f"{path}: {told}; both must be greater than zero")
    if max(length, width) > LARGEST_SIZE:
        told = f"{where} has length={length:g}, width={width:g}"
        raise InputError(f"{path}: {told}; no vehicle is larger than {LARGEST_SIZE:g} m")
    nodes = (*node.findall("initialState"), *node.findall("trajectory/state"))
    states = np.array([_read_state(path, x, where) for x in nodes])
    states[:, 1:3] += _middle(path, node, states[:, 3], where)
    if (np.diff(states[:, 0]) != 1).any():
        k = int(np.argmax(np.diff(states[:, 0]) != 1))
        steps = f"{states[k, 0]:g} is followed by {states[k + 1, 0]:g}"
        raise InputError(f"{path}: {where}: time step {steps}; the steps of a trajectory have no gaps")
    label = (node.findtext("type") or "").strip()
    kind = "Truck" if label in ("truck", "bus") or length > truck_length else "Car"
    told = kind if label == "car" else label
    return _Obstacle(number, kind, told, length, width, int(states[0, 0]), states[:, 1:])


def _middle(path: Path, node: Element, heading: Floats, where: str) -> Floats:
    """How far (m) the middle of the box is from the position, whose frame is turned by ``heading`` (rad)."""
    box = "shape/rectangle"
    turned = node.find(f"{box}/orientation")
    if turned is not None and number_in(path, turned.text, f"orientation of the rectangle of {where}") != 0:
        told = f"orientation={turned.text} of the rectangle of {where}"
        raise InputError(f"{path}: {told}: 0 is needed; boxes lie along their obstacle")
    if node.find(f"{box}/center") is None:
        return np.zeros((len(heading), 2))
    ahead, left = (
        number_in(path, node.findtext(f"{box}/center/{x}"), f"center {x} of the rectangle of {where}")
        for x in "xy"
    )
    cos, sin = np.cos(heading), np.sin(heading)
    return np.stack((ahead * cos - left * sin, ahead * sin + left * cos), axis=1)


def _read_state(path: Path, node: Element, where: str) -> list[float]:
    def number(what: str, place: str) -> float:
        return number_in(path, node.findtext(place), f"{what} in a state of {where}")

    aside = node.find("velocityY") is not None
    state = {
        what: number(what, place) if aside or what != "velocityY" else 0.0
        for what, (place, _) in _STATE.items()
    }
    for what, (_, most) in _STATE.items():
        if abs(state[what]) > most:
            at = f"{what}={state[what]:g} of {where} at time step {state['time']:g}"
            raise InputError(f"{path}: {at}: must lie between {-most:g} and {most:g}")
    return list(state.values())


FORMAT = Format(
    "CommonRoad",
    "NAME.xml of CommonRoad 2020a",
    partial(find_files, suffix=".xml", ending=ZONES_ENDING),
    read_commonroad,
    "{0}: timeStepSize={step:g}",
)
