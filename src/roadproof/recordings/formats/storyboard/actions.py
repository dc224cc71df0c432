"""Private actions of OpenSCENARIO as courses along and across the road.

Conventions where the standard is open are those of esmini: a change of speed over a distance takes the time
2·distance/(v0 + v1); a rate is the largest one of the shape; lanes are counted to the left.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal, TypeAlias

from roadproof.recordings.formats.storyboard.box import Box
from roadproof.recordings.formats.storyboard.controllers import Arrive, KeepDistance, Limits, Phases
from roadproof.recordings.formats.storyboard.courses import (
    SHAPES,
    Course,
    Guided,
    PlaceOverDistance,
    PlaceTransition,
    Point,
    SpeedTransition,
    Steady,
)
from roadproof.recordings.formats.storyboard.document import Document
from roadproof.recordings.formats.storyboard.positions import Positions, State, States
from roadproof.runtime.xml_reader import Element

Axis: TypeAlias = Literal["along", "across"]
_IGNORED = frozenset(
    "ControllerAction ActivateControllerAction AssignControllerAction VisibilityAction AppearanceAction "  # noqa: SIM905
    "LightStateAction AssignRouteAction EnvironmentAction UserDefinedAction".split()
)
"""Actions that have no effect on the motion of a vehicle that does as the storyboard says."""


@dataclass(frozen=True)
class Trajectory:
    """Places of a vehicle's reference point from ``begin`` to ``end`` (s)."""

    begin: float
    end: float
    state: Callable[[float], State]


TrajectoryReader: TypeAlias = Callable[[Element, str, float], Trajectory]
"""Reads a FollowTrajectoryAction that begins at a time (s), for a vehicle by name."""


@dataclass(frozen=True)
class Scene:
    """All vehicles at a time."""

    time: float
    states: States


@dataclass(frozen=True)
class Actor:
    """A vehicle with its courses along and across the road."""

    name: str
    courses: Mapping[Axis, Course]


@dataclass(frozen=True)
class ActionReader:
    """Reads actions of a document as courses."""

    document: Document
    boxes: Mapping[str, Box]
    positions: Positions
    trajectory: TrajectoryReader

    def courses(self, action: Element, actor: Actor, scene: Scene) -> dict[Axis, Course]:
        """The courses that a PrivateAction begins for a vehicle; none where it has no effect.

        Raises ``InputError`` that names what is not supported, and ``KeyError`` for a vehicle without place.
        """
        node = self.document.only(action)
        while node.tag in ("LongitudinalAction", "LateralAction", "RoutingAction"):
            node = self.document.only(node)
        if node.tag in _IGNORED:
            return {}
        match node.tag:
            case "TeleportAction":
                place = self.document.child(node, "Position")
                s, d = self.positions.find(place, scene.states)
                self.positions.check_direction(self.document.only(place))
                speed = scene.states[actor.name].v_lon if actor.name in scene.states else 0.0
                return {"along": Steady(scene.time, s, speed), "across": Steady(scene.time, d)}
            case "SpeedAction":
                return {"along": self._speed(node, actor, scene)}
            case "SpeedProfileAction":
                return {"along": self._speed_profile(node, actor, scene)}
            case "LongitudinalDistanceAction":
                return {"along": self._keep_distance(node, actor, scene)}
            case "SynchronizeAction":
                return {"along": self._synchronize(node, actor, scene)}
            case "LaneChangeAction":
                return {"across": self._lane_change(node, actor, scene)}
            case "LaneOffsetAction":
                return {"across": self._lane_offset(node, actor, scene)}
            case "FollowTrajectoryAction":
                return self._follow(node, actor, scene)
        raise self.document.error(node, "this action is not supported")

    def _speed(self, node: Element, actor: Actor, scene: Scene) -> Course:
        read, state = self.document, scene.states[actor.name]
        target = read.only(read.child(node, "SpeedActionTarget"))
        if target.tag == "AbsoluteTargetSpeed":
            speed = read.number(target, "value")
        elif target.tag == "RelativeTargetSpeed":
            speed = self._relative_speed(target, scene)
        else:
            raise read.error(target, "this target is not supported")
        low, change = state.v_lon, speed - state.v_lon
        dynamics = read.child(node, "SpeedActionDynamics")
        shape, dimension, value = self._dynamics(dynamics)
        if shape == "step" or not change:
            return Steady(scene.time, state.s, speed)
        if dimension == "distance":
            if low + speed <= 0:
                raise read.error(dynamics, f"no distance is gone from {low:g} to {speed:g} m/s")
            value = 2 * value / (low + speed)
        elif dimension == "rate":
            value = SHAPES[shape].steepest * abs(change) / value
        return SpeedTransition(scene.time, state.s, (low, speed), value, SHAPES[shape])

    def _relative_speed(self, target: Element, scene: Scene) -> float:
        """That of the other vehicle at the start of the action, plus or times a value."""
        read = self.document
        other, value = self._state(target, scene).v_lon, read.number(target, "value")
        kind = read.text(target, "speedTargetValueType")
        if kind not in ("delta", "factor"):
            raise read.error(target, f"speedTargetValueType={kind}: one of delta, factor is needed")
        return other + value if kind == "delta" else other * value

    def _speed_profile(self, node: Element, actor: Actor, scene: Scene) -> Course:
        """Speeds that are reached linearly, each in its time; the first one at once where its time is 0."""
        read, state = self.document, scene.states[actor.name]
        if read.text(node, "followingMode") != "position":
            raise read.error(node, f"followingMode={node.get('followingMode')}: position is needed")
        if node.get("entityRef"):
            raise read.error(node, "speeds that are relative to a vehicle are not supported")
        begin = speed = state.v_lon
        phases = []
        for k, entry in enumerate(node.findall("SpeedProfileEntry")):
            target, duration = (read.number(entry, x) for x in ("speed", "time"))
            if duration > 0:
                phases.append((duration, (target - speed) / duration))
            elif k or duration < 0:
                raise read.error(entry, f"time={duration:g} must be above 0")
            else:
                begin = target
            speed = target
        return Phases(scene.time, state.s, begin, tuple(phases))

    def _dynamics(self, node: Element) -> tuple[str, str, float]:
        """Shape, dimension and value, which is positive unless the shape is a step."""
        read = self.document
        shape, dimension = read.text(node, "dynamicsShape"), read.text(node, "dynamicsDimension")
        if shape not in ("step", *SHAPES):
            raise read.error(node, f"dynamicsShape={shape}: one of step, {', '.join(SHAPES)} is needed")
        if dimension not in ("time", "distance", "rate"):
            raise read.error(node, f"dynamicsDimension={dimension}: one of time, distance, rate is needed")
        value = abs(read.number(node, "value"))
        return (shape if value else "step"), dimension, value

    def _keep_distance(self, node: Element, actor: Actor, scene: Scene) -> Course:
        read, state, other = self.document, scene.states[actor.name], self._state(node, scene)
        name, seconds = read.text(node, "entityRef"), node.get("timeGap") is not None
        distance = abs(read.number(node, "timeGap" if seconds else "distance"))
        kind, ahead = node.get("displacement", "any"), other.s < state.s
        if kind not in ("any", "trailingReferencedEntity", "leadingReferencedEntity"):
            raise read.error(node, f"displacement={kind} is not supported")
        ahead = ahead if kind == "any" else kind == "leadingReferencedEntity"
        apart = 0.0
        if node.get("freespace") in ("true", "1"):
            box, beyond = self.boxes[actor.name], self.boxes[name]
            shift = box.centre[0] - beyond.centre[0]
            apart = (box.length + beyond.length) / 2 + (-shift if ahead else shift)
        most = Limits()
        limits = node.find("DynamicConstraints")
        if limits is not None:
            for rate in ("maxAccelerationRate", "maxDecelerationRate"):
                if limits.get(rate):
                    raise read.error(limits, f"{rate} is not supported")
            names = ("maxAcceleration", "maxDeceleration", "maxSpeed")
            most = Limits(*(read.number(limits, x) if limits.get(x) else math.inf for x in names))
        now = Steady(scene.time, state.s, state.v_lon)
        continuous = read.text(node, "continuous") in ("true", "1")
        signed = -distance if ahead else distance
        course = KeepDistance(now, actor.name, name, signed, seconds, apart, most, continuous)
        return course.next(scene.time, scene.states)

    def _synchronize(self, node: Element, actor: Actor, scene: Scene) -> Course:
        """Tolerances are not used: both vehicles arrive at the positions themselves."""
        read, state = self.document, scene.states[actor.name]
        other = read.text(node, "masterEntityRef")
        there, here = (
            self.positions.find(read.child(node, x), scene.states)[0]
            for x in ("TargetPositionMaster", "TargetPosition")
        )
        if here <= state.s or there <= scene.states[other].s:
            raise read.error(node, "a target position is behind its vehicle")
        final, share, steady = None, 0.0, (0.0, 0.0)
        if node.find("FinalSpeed") is not None:
            speed = read.only(read.child(node, "FinalSpeed"))
            for x in speed:
                kinds = {"TargetDistanceSteadyState": "distance", "TargetTimeSteadyState": "time"}
                if x.tag not in kinds:
                    raise read.error(x, "this steady state is not supported")
                value = read.number(x, kinds[x.tag])
                steady = (value, 0.0) if kinds[x.tag] == "distance" else (0.0, value)
            final = read.number(speed, "value")
            if speed.tag == "RelativeSpeedToMaster":
                factor = speed.get("speedTargetValueType") == "factor"
                final, share = (0.0, final) if factor else (final, 1.0)
        now = Steady(scene.time, state.s, state.v_lon)
        course = Arrive(now, actor.name, other, here, there, final, share, steady)
        return course.next(scene.time, scene.states)

    def _lane_change(self, node: Element, actor: Actor, scene: Scene) -> Course:
        read, state = self.document, scene.states[actor.name]
        target = read.only(read.child(node, "LaneChangeTarget"))
        here = state.s, state.d
        if target.tag == "AbsoluteTargetLane":
            d = self.positions.lane_called(target, here, round(read.number(target, "value")))
        elif target.tag == "RelativeTargetLane":
            other = self._state(target, scene)
            lane = self.positions.lane_beside(target, (other.s, other.d), round(read.number(target, "value")))
            d = self.positions.lane_beside(target, (state.s, lane), 0)
        else:
            raise read.error(target, "this target is not supported")
        d += read.number(node, "targetLaneOffset", 0.0)
        shape, dimension, value = self._dynamics(read.child(node, "LaneChangeActionDynamics"))
        change = d - state.d
        if shape == "step" or not change:
            return Steady(scene.time, d)
        if dimension == "distance":
            return PlaceOverDistance(state.s, (state.d, d), value, SHAPES[shape])
        if dimension == "rate":
            value = SHAPES[shape].steepest * abs(change) / value
        return PlaceTransition(scene.time, (state.d, d), value, SHAPES[shape])

    def _lane_offset(self, node: Element, actor: Actor, scene: Scene) -> Course:
        read, state = self.document, scene.states[actor.name]
        target = read.only(read.child(node, "LaneOffsetTarget"))
        value = read.number(target, "value")
        if target.tag == "AbsoluteTargetLaneOffset":
            d = self.positions.lane_beside(target, (state.s, state.d), 0) + value
        elif target.tag == "RelativeTargetLaneOffset":
            other = self._state(target, scene)
            offset = other.d - self.positions.lane_beside(target, (other.s, other.d), 0)
            d = self.positions.lane_beside(target, (state.s, state.d), 0) + offset + value
        else:
            raise read.error(target, "this target is not supported")
        dynamics = read.child(node, "LaneOffsetActionDynamics")
        shape, change = read.text(dynamics, "dynamicsShape"), d - state.d
        if shape == "step" or not change:
            return Steady(scene.time, d)
        if shape not in SHAPES or not SHAPES[shape].most_bent:
            raise read.error(dynamics, f"dynamicsShape={shape}: one of step, cubic, sinusoidal is needed")
        most = read.number(dynamics, "maxLateralAcc")
        if most <= 0:
            raise read.error(dynamics, f"maxLateralAcc={most:g} must be above 0")
        duration = math.sqrt(SHAPES[shape].most_bent * abs(change) / most)
        return PlaceTransition(scene.time, (state.d, d), duration, SHAPES[shape])

    def _follow(self, node: Element, actor: Actor, scene: Scene) -> dict[Axis, Course]:
        found = self.trajectory(node, actor.name, scene.time)
        if found.begin < scene.time - 0.011:
            told = f"it begins at {scene.time:g} s, after the first Vertex at {found.begin:g} s"
            raise self.document.error(node, told)

        def along(time: float) -> Point:
            x = found.state(time)
            return Point(x.s, x.v_lon, x.a_lon)

        def across(time: float) -> Point:
            x = found.state(time)
            return Point(x.d, x.v_lat, x.a_lat)

        span = found.begin, found.end
        return {
            "along": Guided(actor.courses["along"], *span, along, rests=False),
            "across": Guided(actor.courses["across"], *span, across, rests=True),
        }

    def _state(self, node: Element, scene: Scene) -> State:
        """The vehicle that an element refers to. Raises ``KeyError`` where it has no place yet."""
        return scene.states[self.document.text(node, "entityRef")]
