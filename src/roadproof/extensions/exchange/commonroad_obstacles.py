"""Dynamic obstacles of CommonRoad: boxes and their states, some of which may have to be computed.

Strict reading wants every value of every state. Otherwise an interval stands for its middle, a state without
orientation, velocity or acceleration gets what the others imply, and an obstacle that cannot be read is left
out, as are those that are no vehicles in traffic.
"""

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.maps.xml_element import text_of
from roadproof.extensions.maps.xml_reader import Element, number_in
from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.plausible import LARGEST_ACCELERATION, LARGEST_SIZE, LARGEST_SPEED
from roadproof.extensions.traffic.formats.recording import Floats
from roadproof.extensions.traffic.formats.reliable import (
    MOST_LEFT_OUT,
    first_names,
    left_out_note,
    rate_of_change,
)
from roadproof.reasons import ReasonKind
from roadproof.world.not_read import LEFT_OUT

LARGEST_PLACE, LARGEST_ORIENTATION = 1e8, 100.0
"""m, as in all coordinates of maps, and rad, which need not be one turn."""
_STATE = {
    "time": ("time", math.inf),
    "x": ("position/point/x", LARGEST_PLACE),
    "y": ("position/point/y", LARGEST_PLACE),
    "orientation": ("orientation", LARGEST_ORIENTATION),
    "velocity": ("velocity", LARGEST_SPEED),
    "acceleration": ("acceleration", LARGEST_ACCELERATION),
    "velocityY": ("velocityY", LARGEST_SPEED),
}
"""What a state has, where, and how large it is at most; ``velocityY`` may be missing."""
_DERIVABLE = ("orientation", "velocity", "acceleration")
"""What the other values of a trajectory imply, in the order in which it is computed."""
NO_TRAFFIC = {
    "pedestrian": "pedestrians",
    "bicycle": "cyclists",
    "parkedVehicle": "parked vehicles",
    "constructionZone": "construction zones",
    "roadBoundary": "parts of the road",
    "medianStrip": "parts of the road",
    "building": "buildings",
    "pillar": "pillars",
    "train": "trains",
}
"""Types of dynamic obstacles that are no vehicles in traffic."""
STANDS = 0.1
"""m: so short a step says nothing of where a vehicle heads."""


@dataclass(frozen=True)
class Obstacle:
    """Columns of ``states``: x, y (centre of the box), orientation, velocity, acceleration, velocityY.

    Velocity and acceleration are along the box, velocityY to its left. ``derived``: what was computed.
    """

    id: int
    kind: str
    label: str
    length: float
    width: float
    first_step: int
    states: Floats
    derived: tuple[str, ...] = ()


@dataclass(frozen=True)
class ObstacleRules:
    """The settings for obstacles: the ``rate`` (1/s) of states, and the length (m) from which they are
    trucks.
    """

    rate: Rate
    truck_length: float
    strict: bool


def read_obstacles(path: Path, root: Element, rules: ObstacleRules) -> tuple[list[Obstacle], tuple[str, ...]]:
    """The obstacles of a file by id, and notes on what was left out or computed. Raises ``InputError``."""
    obstacles, shapeless, nodes = [], [], root.findall("dynamicObstacle")
    absent, faults = defaultdict[str, list[int]](list), dict[int, str]()
    seen: set[int] = set()
    for node in nodes:
        number = int(number_in(path, node.get("id"), "id of a dynamicObstacle"))
        if number in seen:
            raise InputError(f"{path}: dynamicObstacle {number} occurs twice; ids must differ")
        seen.add(number)
        shape, label = node.find("shape"), (node.findtext("type") or "").strip()
        if not rules.strict and label in NO_TRAFFIC:
            absent[NO_TRAFFIC[label]].append(number)
            node.read_all()
        elif shape is None or [x.tag for x in shape] != ["rectangle"] or node.find("trajectory") is None:
            shapeless.append(number)
            node.read_all()
        else:
            try:
                obstacles.append(_read_obstacle(path, node, number, rules))
            except InputError as error:
                if rules.strict:
                    raise
                faults[number] = str(error).removeprefix(f"{path}: ")
                node.read_all()
    if len(faults) > MOST_LEFT_OUT * (len(faults) + len(obstacles)):
        raise InputError(f"{path}: {next(iter(faults.values()))}; {len(faults)} obstacles have such faults")
    if not obstacles:
        raise InputError(f"{path}: the file has no dynamicObstacle with a rectangle and a trajectory")
    shown = ", ".join(map(str, shapeless))
    notes = [f"{LEFT_OUT} obstacles (not one rectangle, or no trajectory): {shown}"] if shapeless else []
    static = root.findall("staticObstacle")
    for node in static:
        node.read_all()
    if static:
        notes.append(f"{LEFT_OUT} {len(static)} static obstacles: they are no traffic")
    notes += [left_out_note(ids, len(nodes), ReasonKind.OF_KIND(what)) for what, ids in absent.items()]
    notes += [left_out_note([number], len(nodes), ReasonKind.TOLD(fault)) for number, fault in faults.items()]
    return sorted(obstacles, key=lambda o: o.id), (*notes, *_derived_value_notes(obstacles))


def _derived_value_notes(obstacles: Sequence[Obstacle]) -> Iterator[str]:
    for what in dict.fromkeys(x for obstacle in obstacles for x in obstacle.derived):
        ids = [x.id for x in obstacles if what in x.derived]
        yield f"{what} of {len(ids)} of {len(obstacles)} vehicles ({first_names(ids)})"


def _read_obstacle(path: Path, node: Element, number: int, rules: ObstacleRules) -> Obstacle:
    where = f"dynamicObstacle {number}"
    length, width = (
        number_in(path, node.findtext(f"shape/rectangle/{x}"), f"{x} of {where}") for x in ("length", "width")
    )
    if length <= 0 or width <= 0:
        description = f"{where} has length={length}, width={width}"
        raise InputError(f"{path}: {description}; both must be greater than zero")
    if max(length, width) > LARGEST_SIZE:
        description = f"{where} has length={length:g}, width={width:g}"
        raise InputError(f"{path}: {description}; no vehicle is larger than {LARGEST_SIZE:g} m")
    nodes = (*node.findall("initialState"), *node.findall("trajectory/state"))
    reader = _StateReader(path, where, rules.strict)
    states = np.array([reader.read(x) for x in nodes])
    derived = reader.derived
    if not rules.strict:
        states, more = _complete_states(path, states, rules.rate, where)
        derived = (*derived, *more)
    states[:, 1:3] += _box_offset(path, node, states[:, 3], where)
    if (np.diff(states[:, 0]) != 1).any():
        k = int(np.argmax(np.diff(states[:, 0]) != 1))
        steps = f"{states[k, 0]:g} is followed by {states[k + 1, 0]:g}"
        raise InputError(f"{path}: {where}: time step {steps}; the steps of a trajectory have no gaps")
    label = (node.findtext("type") or "").strip()
    kind = "Truck" if label in ("truck", "bus") or length > rules.truck_length else "Car"
    description = kind if label == "car" else label
    return Obstacle(number, kind, description, length, width, int(states[0, 0]), states[:, 1:], derived)


def _box_offset(path: Path, node: Element, heading: Floats, where: str) -> Floats:
    """Return how far (m) the middle of the box is from the position, whose frame is turned by ``heading``
    (rad).
    """
    box = "shape/rectangle"
    turned = node.find(f"{box}/orientation")
    if turned is not None and number_in(path, turned.text, f"orientation of the rectangle of {where}") != 0:
        problem = f"orientation={turned.text} of the rectangle of {where}"
        raise InputError(f"{path}: {problem}: 0 is needed; boxes lie along their obstacle")
    if node.find(f"{box}/center") is None:
        return np.zeros((len(heading), 2))
    ahead, left = (
        number_in(path, node.findtext(f"{box}/center/{x}"), f"center {x} of the rectangle of {where}")
        for x in "xy"
    )
    cos, sin = np.cos(heading), np.sin(heading)
    return np.stack((ahead * cos - left * sin, ahead * sin + left * cos), axis=1)


class _StateReader:
    """Reads the states of one obstacle; unless ``strict``, NaN stands for what a state does not have."""

    def __init__(self, path: Path, where: str, strict: bool) -> None:
        self.path, self.where, self.strict = path, where, strict
        self.derived: tuple[str, ...] = ()

    def read(self, node: Element) -> list[float]:
        aside = node.find("velocityY") is not None
        for slip in (x for x in node if x.tag == "slipAngle"):
            if _is_zero(slip):
                slip.read_all()
        state = {what: self._value(node, what) if aside or what != "velocityY" else 0.0 for what in _STATE}
        for what, (_, most) in _STATE.items():
            if abs(state[what]) > most:
                at = f"{what}={state[what]:g} of {self.where} at time step {state['time']:g}"
                raise InputError(f"{self.path}: {at}: must lie between {-most:g} and {most:g}")
        return list(state.values())

    def _value(self, node: Element, what: str) -> float:
        place = _STATE[what][0]
        value = node.find(place)
        if not self.strict and value is None and what in _DERIVABLE:
            return math.nan
        if value is not None and "point" not in place:
            ends = [value.findtext(x) for x in ("intervalStart", "intervalEnd")]
            if not self.strict and None not in ends:
                self.derived = tuple(dict.fromkeys((*self.derived, f"the middle of an interval is {what}")))
                return sum(number_in(self.path, x, f"{what} in a state of {self.where}") for x in ends) / 2
            value = value.find("exact")
        text = None if value is None else value.text
        return number_in(self.path, text, f"{what} in a state of {self.where}")


def _is_zero(node: Element) -> bool:
    """Return whether the exact value of a node is 0, without counting it as read."""
    texts = [text_of(x) for x in node if x.tag == "exact"]
    with suppress(TypeError, ValueError):
        return len(texts) == 1 and float(texts[0] or "") == 0
    return False


def _complete_states(path: Path, states: Floats, rate: Rate, where: str) -> tuple[Floats, tuple[str, ...]]:
    """States with a first one that is said once, and with what their places and velocities imply."""
    if len(states) > 1 and states[0, 0] == states[1, 0]:
        states = states[1:]
    notes = []
    x, y, heading, velocity, acceleration = (states[:, k] for k in range(1, 6))
    if np.isnan(heading).any():
        heading[:] = np.where(np.isnan(heading), _headings(path, x, y, where), heading)
        notes.append("the motion implies orientation")
    along = rate_of_change(x, rate) * np.cos(heading) + rate_of_change(y, rate) * np.sin(heading)
    if np.isnan(velocity).any():
        velocity[:] = np.where(np.isnan(velocity), along, velocity)
        notes.append("the motion implies velocity")
    elif _drives_backwards(along, velocity, rate):
        velocity *= -1
        notes.append("the motion is backwards, against an unsigned velocity,")
    if np.isnan(acceleration).any():
        acceleration[:] = np.where(np.isnan(acceleration), rate_of_change(velocity, rate), acceleration)
        notes.append("velocities imply acceleration")
    return states, tuple(notes)


def _drives_backwards(along: Floats, velocity: Floats, rate: Rate) -> bool:
    """Return whether a vehicle drives backwards all the time, as fast as velocities say that it drives
    forwards.
    """
    moved_distance, stated_distance = float(along.sum()) / float(rate), float(velocity.sum()) / float(rate)
    return (
        stated_distance > 1
        and bool((velocity >= 0).all())
        and abs(moved_distance + stated_distance) < 0.1 * stated_distance
    )


def _headings(path: Path, x: Floats, y: Floats, where: str) -> Floats:
    """Return where a vehicle heads by its motion; where it stands, as before, and at first as later."""
    step = np.stack((np.gradient(x), np.gradient(y))) if len(x) > 1 else np.zeros((2, len(x)))
    moving = np.flatnonzero(np.hypot(*step) > STANDS)
    if not len(moving):
        raise InputError(f"{path}: {where} has no orientation, and no motion that says it")
    latest = np.maximum(np.searchsorted(moving, np.arange(len(x)), side="right") - 1, 0)
    headings: Floats = np.arctan2(step[1], step[0])[moving[latest]]
    return headings
