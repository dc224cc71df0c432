"""Private actions of OpenSCENARIO as courses along and across the road.

Conventions where the standard is open are those of esmini: a change of speed over a distance takes the time
2·distance/(v0 + v1); a rate is the largest one of the shape; lanes are counted to the left; a linear change
of the lane offset takes as long as a cubic one.
"""

import math
from collections.abc import Mapping
from dataclasses import replace

from roadproof.extensions.exchange.storyboard.box import Box
from roadproof.extensions.exchange.storyboard.controllers import (
    Arrive,
    Axis,
    DistanceGoal,
    FollowSpeed,
    KeepDistance,
    Limits,
    Phases,
    SpeedGoal,
)
from roadproof.extensions.exchange.storyboard.courses import (
    SHAPES,
    Course,
    OnPath,
    PlaceOverDistance,
    PlaceTransition,
    Point,
    SpeedTransition,
    Steady,
    capped,
)
from roadproof.extensions.exchange.storyboard.document import Document
from roadproof.extensions.exchange.storyboard.positions import Positions, State, States
from roadproof.extensions.exchange.storyboard.trajectories import TrajectoryReader
from roadproof.runtime.records import dataclass
from roadproof.runtime.xml_reader import Element

_IGNORED = frozenset(
    "ControllerAction ActivateControllerAction AssignControllerAction VisibilityAction AppearanceAction "  # noqa: SIM905
    "LightStateAction AssignRouteAction AcquirePositionAction RandomRouteAction".split()
)
"""Actions that have no effect on the motion of a vehicle that does as the storyboard says, on one road."""
_BEHIND = ("trailingReferencedEntity", "rightToReferencedEntity")
_AHEAD = ("leadingReferencedEntity", "leftToReferencedEntity")

_LATERAL = 0.5
"""m/s²: maxLateralAcc where a LaneOffsetAction does not say it, as in esmini."""


@dataclass(frozen=True)
class Scene:
    """All vehicles at a time, in the coordinates of the vehicle that acts."""

    time: float
    states: States


@dataclass(frozen=True)
class Actor:
    """An object with its courses along and across the road, in its own coordinates.

    ``forward``: these are s and d of the road; otherwise the road is turned around.
    """

    name: str
    courses: Mapping[Axis, Course]
    forward: bool = True


@dataclass(frozen=True)
class ActionReader:
    """Reads actions of a document as courses."""

    document: Document
    boxes: Mapping[str, Box]
    positions: Positions

    def turned(self) -> "ActionReader":
        """The same for actors that drive against the road."""
        return replace(self, positions=self.positions.turned())

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
            case "SpeedAction" | "SpeedProfileAction":
                return self._on_path(node, actor, scene) or {"along": self._of_speed(node, actor, scene)}
            case "LongitudinalDistanceAction":
                return {"along": self._keep_distance(node, actor, scene, "along")}
            case "LateralDistanceAction":
                return {"across": self._keep_distance(node, actor, scene, "across")}
            case "SynchronizeAction":
                return {"along": self._synchronize(node, actor, scene)}
            case "LaneChangeAction":
                return {"across": self._lane_change(node, actor, scene)}
            case "LaneOffsetAction":
                return {"across": self._lane_offset(node, actor, scene)}
            case "FollowTrajectoryAction":
                before = actor.courses["along"], actor.courses["across"]
                read = TrajectoryReader(self.document, self.positions, actor.name, self.boxes[actor.name])
                found = read.courses(node, before, scene.time, scene.states)
                return {"along": found[0], "across": found[1]}
        raise self.document.error(node, "this action is not supported")

    def _of_speed(self, node: Element, actor: Actor, scene: Scene) -> Course:
        read = self._speed if node.tag == "SpeedAction" else self._speed_profile
        return read(node, actor, scene)

    def _on_path(self, node: Element, actor: Actor, scene: Scene) -> dict[Axis, Course]:
        """An action of speed on a path without times: the courses on the path; none for other vehicles."""
        along, across = actor.courses["along"], actor.courses["across"]
        if not isinstance(along, OnPath) or not isinstance(across, OnPath):
            return {}
        gone = along.motion.at(scene.time, Point(0.0, 0.0))
        state = replace(scene.states[actor.name], s=gone.place, v_lon=gone.speed, a_lon=gone.acceleration)
        inside = Scene(scene.time, {**scene.states, actor.name: state})
        motion = self._of_speed(node, actor, inside)
        return {"along": replace(along, motion=motion), "across": replace(across, motion=motion)}

    def placed(self, position: Element, name: str, scene: Scene) -> Actor:
        """A vehicle that is put to a Position, or to the first point of a trajectory; it keeps its speed.

        ``scene``: in coordinates of the road. Raises ``InputError``, and ``KeyError`` where it refers to a
        vehicle without place.
        """
        if position.tag == "FollowTrajectoryAction":
            read = TrajectoryReader(self.document, self.positions, name, self.boxes[name])
            s, d = read.first(position, scene.states)
            return Actor(name, {"along": Steady(scene.time, s), "across": Steady(scene.time, d)})
        forward = self.positions.is_forward(self.document.only(position), scene.states)
        positions = self.positions if forward else self.positions.turned()
        states = scene.states if forward else turned(scene.states)
        s, d = positions.find(position, states)
        speed = scene.states.get(name)
        now = 0.0 if speed is None else speed.v_lon if speed.forward else -speed.v_lon
        return Actor(name, {"along": Steady(scene.time, s, now), "across": Steady(scene.time, d)}, forward)

    def _speed(self, node: Element, actor: Actor, scene: Scene) -> Course:
        """At most the largest speed of the vehicle, at which a change of speed ends."""
        read, state = self.document, scene.states[actor.name]
        target = read.only(read.child(node, "SpeedActionTarget"))
        if target.tag == "AbsoluteTargetSpeed":
            speed = read.number(target, "value")
        elif target.tag == "RelativeTargetSpeed":
            speed = self._relative_speed(target, scene)
        else:
            raise read.error(target, "this target is not supported")
        low, most = state.v_lon, self.boxes[actor.name].limits[0]
        dynamics = read.child(node, "SpeedActionDynamics")
        shape, dimension, value = self._dynamics(dynamics)
        if dimension == "distance" and shape != "step" and speed != low:
            if low + speed <= 0:
                raise read.error(dynamics, f"no distance is gone from {low:g} to {speed:g} m/s")
            value = 2 * value / (low + speed)
        elif dimension == "rate" and shape != "step":
            value = SHAPES[shape].steepest * abs(speed - low) / value
        if target.tag == "RelativeTargetSpeed" and read.flag(target, "continuous"):
            return self._follow_speed(target, actor, scene, (0.0 if shape == "step" else value, shape))
        if shape == "step" or speed == low:
            return Steady(scene.time, state.s, min(max(speed, -most), most))
        return capped(SpeedTransition(scene.time, state.s, (low, speed), value, SHAPES[shape]), most)

    def _relative_speed(self, target: Element, scene: Scene) -> float:
        """That of the other vehicle at the start of the action, plus or times a value."""
        factor, more = self._relation(target)
        other = self._state(target, scene)
        return (other.v_lon if other.forward else -other.v_lon) * factor + more

    def _relation(self, target: Element) -> tuple[float, float]:
        """The factor and the sum that give a speed that is relative to another one."""
        read = self.document
        value, kind = read.number(target, "value"), read.text(target, "speedTargetValueType")
        if kind not in ("delta", "factor"):
            raise read.error(target, f"speedTargetValueType={kind}: one of delta, factor is needed")
        return (1.0, value) if kind == "delta" else (value, 0.0)

    def _follow_speed(
        self, target: Element, actor: Actor, scene: Scene, transition: tuple[float, str]
    ) -> Course:
        """The speed relative to another vehicle at any time, reached in a duration (s) by a shape."""
        if isinstance(actor.courses["along"], OnPath):
            rule = "continuous=true is not supported on a trajectory without times"
            raise self.document.error(target, rule)
        state, (duration, shape) = scene.states[actor.name], transition
        goal = SpeedGoal(
            self.document.text(target, "entityRef"),
            *self._relation(target),
            scene.time,
            state.v_lon,
            duration,
            SHAPES.get(shape, SHAPES["linear"]),
            self.boxes[actor.name].limits[0],
        )
        now = Steady(scene.time, state.s, state.v_lon)
        return FollowSpeed(now, actor.name, goal).next(scene.time, scene.states)

    def _speed_profile(self, node: Element, actor: Actor, scene: Scene) -> Course:
        """Speeds that are reached linearly, each in its time; the first one at once where its time is 0."""
        read, state = self.document, scene.states[actor.name]
        if read.text(node, "followingMode") != "position":
            raise read.error(node, f"followingMode={node.get('followingMode')}: position is needed")
        if node.get("entityRef"):
            raise read.error(node, "speeds that are relative to a vehicle are not supported")
        begin = speed = state.v_lon
        phases, most = [], self.boxes[actor.name].limits[0]
        for k, entry in enumerate(node.findall("SpeedProfileEntry")):
            target, duration = (read.number(entry, x) for x in ("speed", "time"))
            if abs(target) > most:
                told = f"speed={target:g} is above maxSpeed={most:g} of the Performance of {actor.name}"
                raise read.error(entry, told)
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
        read.pass_over(node, "followingMode", "position")
        return (shape if value else "step"), dimension, value

    def _keep_distance(self, node: Element, actor: Actor, scene: Scene, axis: Axis) -> Course:
        """Behind or right of another vehicle, or ahead or left of it, as ``displacement`` says.

        Where it does not say: as it is now along the road; across it to the left, as in esmini.
        """
        read, state, other = self.document, scene.states[actor.name], self._state(node, scene)
        name, seconds = read.text(node, "entityRef"), node.get("timeGap") is not None
        distance = abs(read.number(node, "timeGap" if seconds else "distance"))
        kind = node.get("displacement", "any")
        if kind not in ("any", *_BEHIND, *_AHEAD):
            raise read.error(node, f"displacement={kind} is not supported")
        beyond = other.s < state.s if axis == "along" else True
        beyond = beyond if kind == "any" else kind in _AHEAD
        apart = 0.0
        if read.flag(node, "freespace"):
            box, far = self.boxes[actor.name], self.boxes[name]
            sizes = (box.length, far.length) if axis == "along" else (box.width, far.width)
            which = 0 if axis == "along" else 1
            shift = box.centre[which] - far.centre[which]
            apart = sum(sizes) / 2 + (-shift if beyond else shift)
        for system in ("entity", "lane", "road"):
            read.pass_over(node, "coordinateSystem", system)
        limits = self._limits(node)
        if axis == "across":
            limits = replace(limits, deceleration=limits.acceleration)
        now = Steady(scene.time, state.s, state.v_lon) if axis == "along" else Steady(scene.time, state.d)
        continuous = read.flag(node, "continuous")
        signed = math.copysign(distance, -1.0 if beyond else 1.0)
        goal = DistanceGoal(axis, name, signed, seconds, apart, limits, continuous)
        return KeepDistance(now, actor.name, goal).next(scene.time, scene.states)

    def _limits(self, node: Element) -> Limits:
        limits = node.find("DynamicConstraints")
        if limits is None:
            return Limits()
        names = ("Acceleration", "Deceleration", "Speed", "AccelerationRate", "DecelerationRate")
        return Limits(
            *(self.document.number(limits, f"max{x}") if limits.get(f"max{x}") else math.inf for x in names)
        )

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
        read.pass_over(node, "continuous", "false")
        target = read.only(read.child(node, "LaneOffsetTarget"))
        value = read.number(target, "value")
        if target.tag == "AbsoluteTargetLaneOffset":
            d = self.positions.lane_beside(target, (state.s, state.d), 0) + value
        elif target.tag == "RelativeTargetLaneOffset":
            if read.flag(node, "continuous"):
                rule = "continuous=true is not supported beside another vehicle"
                raise read.error(node, rule)
            other = self._state(target, scene)
            d = other.d + (value if other.forward else -value)
        else:
            raise read.error(target, "this target is not supported")
        dynamics = read.child(node, "LaneOffsetActionDynamics")
        shape, change = read.text(dynamics, "dynamicsShape"), d - state.d
        most = read.number(dynamics, "maxLateralAcc", _LATERAL)
        if shape == "step" or not change:
            return Steady(scene.time, d)
        if shape not in SHAPES:
            raise read.error(dynamics, f"dynamicsShape={shape}: one of step, {', '.join(SHAPES)} is needed")
        if most <= 0:
            raise read.error(dynamics, f"maxLateralAcc={most:g} must be above 0")
        bend = SHAPES[shape if SHAPES[shape].most_bent else "cubic"].most_bent
        duration = math.sqrt(bend * abs(change) / most)
        return PlaceTransition(scene.time, (state.d, d), duration, SHAPES[shape])

    def _state(self, node: Element, scene: Scene) -> State:
        """The vehicle that an element refers to. Raises ``KeyError`` where it has no place yet."""
        return scene.states[self.document.text(node, "entityRef")]


def turned(states: States) -> dict[str, State]:
    """States in the coordinates of those who drive against the road."""
    return {name: state.turned() for name, state in states.items()}
