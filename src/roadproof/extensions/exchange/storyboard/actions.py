"""Private actions of OpenSCENARIO as courses along and across the road.

Conventions where the standard is open are those of esmini: a change of speed over a distance takes the time
2·distance/(v0 + v1); a rate is the largest one of the shape; lanes are counted to the left; a linear change
of the lane offset takes as long as a cubic one.
"""

import math
from collections.abc import Mapping
from dataclasses import replace

from roadproof.extensions.exchange.storyboard.box import ObjectBox
from roadproof.extensions.exchange.storyboard.controllers import (
    Axis,
    DistanceGoal,
    DistanceKeeping,
    DynamicConstraints,
    Phases,
    SpeedFollowing,
    SpeedGoal,
    SynchronizedArrival,
)
from roadproof.extensions.exchange.storyboard.courses import (
    SHAPES,
    AxisCourse,
    ConstantSpeed,
    PathCourse,
    PlaceOverDistance,
    PlaceTransition,
    Point,
    SpeedTransition,
    cap_speed,
)
from roadproof.extensions.exchange.storyboard.document import Document
from roadproof.extensions.exchange.storyboard.positions import ObjectState, Positions, States
from roadproof.extensions.exchange.storyboard.trajectories import TrajectoryReader
from roadproof.extensions.maps.xml_reader import Element
from roadproof.runtime.records import dataclass

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
class ActionScene:
    """All vehicles at a time, in the coordinates of the vehicle that acts."""

    time: float
    states: States


@dataclass(frozen=True)
class Actor:
    """An object with its courses along and across the road, in its own coordinates.

    ``forward``: these are s and d of the road; otherwise the road is turned around.
    """

    name: str
    along: AxisCourse
    across: AxisCourse
    forward: bool = True

    def course(self, axis: Axis) -> AxisCourse:
        """Return the course along or across the road."""
        return self.along if axis == "along" else self.across

    def with_courses(self, courses: Mapping[Axis, AxisCourse]) -> "Actor":
        """Return the object with these courses in place of its own."""
        along, across = courses.get("along", self.along), courses.get("across", self.across)
        return replace(self, along=along, across=across)


@dataclass(frozen=True)
class ActionReader:
    """Reads actions of a document as courses."""

    document: Document
    boxes: Mapping[str, ObjectBox]
    positions: Positions

    def in_opposite_direction(self) -> "ActionReader":
        """Return the reader for actors that drive against the road."""
        return replace(self, positions=self.positions.in_opposite_direction())

    def courses(self, action: Element, actor: Actor, scene: ActionScene) -> dict[Axis, AxisCourse]:
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
                before = actor.along, actor.across
                reader = TrajectoryReader(self.document, self.positions, actor.name, self.boxes[actor.name])
                pair = reader.courses(node, before, scene.time, scene.states)
                return {"along": pair[0], "across": pair[1]}
        raise self.document.error(node, "this action is not supported")

    def _of_speed(self, node: Element, actor: Actor, scene: ActionScene) -> AxisCourse:
        read_course = self._speed if node.tag == "SpeedAction" else self._speed_profile
        return read_course(node, actor, scene)

    def _on_path(self, node: Element, actor: Actor, scene: ActionScene) -> dict[Axis, AxisCourse]:
        """An action of speed on a path without times: the courses on the path; none for other vehicles."""
        along, across = actor.along, actor.across
        if not isinstance(along, PathCourse) or not isinstance(across, PathCourse):
            return {}
        gone = along.motion.at(scene.time, Point(0.0, 0.0))
        state = replace(scene.states[actor.name], s=gone.place, v_lon=gone.speed, a_lon=gone.acceleration)
        inside = ActionScene(scene.time, {**scene.states, actor.name: state})
        motion = self._of_speed(node, actor, inside)
        return {"along": replace(along, motion=motion), "across": replace(across, motion=motion)}

    def place_actor(self, position: Element, name: str, scene: ActionScene) -> Actor:
        """A vehicle that is put to a Position, or to the first point of a trajectory; it keeps its speed.

        ``scene``: in coordinates of the road. Raises ``InputError``, and ``KeyError`` where it refers to a
        vehicle without place.
        """
        if position.tag == "FollowTrajectoryAction":
            reader = TrajectoryReader(self.document, self.positions, name, self.boxes[name])
            s, d = reader.first(position, scene.states)
            return Actor(name, ConstantSpeed(scene.time, s), ConstantSpeed(scene.time, d))
        forward = self.positions.is_forward(self.document.only(position), scene.states)
        positions = self.positions if forward else self.positions.in_opposite_direction()
        states = scene.states if forward else in_opposite_direction(scene.states)
        s, d = positions.find(position, states)
        state = scene.states.get(name)
        own_speed = 0.0 if state is None else state.v_lon if state.forward else -state.v_lon
        along = ConstantSpeed(scene.time, s, own_speed)
        return Actor(name, along, ConstantSpeed(scene.time, d), forward)

    def _speed(self, node: Element, actor: Actor, scene: ActionScene) -> AxisCourse:
        """Return the course of a SpeedAction, which ends at most at the largest speed of the vehicle."""
        document, state = self.document, scene.states[actor.name]
        target = document.only(document.child(node, "SpeedActionTarget"))
        if target.tag == "AbsoluteTargetSpeed":
            speed = document.number(target, "value")
        elif target.tag == "RelativeTargetSpeed":
            speed = self._relative_speed(target, scene)
        else:
            raise document.error(target, "this target is not supported")
        low, most = state.v_lon, self.boxes[actor.name].limits[0]
        dynamics = document.child(node, "SpeedActionDynamics")
        shape, dimension, value = self._dynamics(dynamics)
        if dimension == "distance" and shape != "step" and speed != low:
            if low + speed <= 0:
                raise document.error(dynamics, f"no distance is gone from {low:g} to {speed:g} m/s")
            value = 2 * value / (low + speed)
        elif dimension == "rate" and shape != "step":
            value = SHAPES[shape].steepest * abs(speed - low) / value
        if target.tag == "RelativeTargetSpeed" and document.flag(target, "continuous"):
            return self._follow_speed(target, actor, scene, (0.0 if shape == "step" else value, shape))
        if shape == "step" or speed == low:
            return ConstantSpeed(scene.time, state.s, min(max(speed, -most), most))
        return cap_speed(SpeedTransition(scene.time, state.s, (low, speed), value, SHAPES[shape]), most)

    def _relative_speed(self, target: Element, scene: ActionScene) -> float:
        """Return the other vehicle's speed at the start of the action, plus or times a value."""
        factor, more = self._relation(target)
        other = self._state(target, scene)
        return (other.v_lon if other.forward else -other.v_lon) * factor + more

    def _relation(self, target: Element) -> tuple[float, float]:
        """The factor and the sum that give a speed that is relative to another one."""
        document = self.document
        value, kind = document.number(target, "value"), document.text(target, "speedTargetValueType")
        if kind not in ("delta", "factor"):
            raise document.error(target, f"speedTargetValueType={kind}: one of delta, factor is needed")
        return (1.0, value) if kind == "delta" else (value, 0.0)

    def _follow_speed(
        self, target: Element, actor: Actor, scene: ActionScene, transition: tuple[float, str]
    ) -> AxisCourse:
        """The speed relative to another vehicle at any time, reached in a duration (s) by a shape."""
        if isinstance(actor.along, PathCourse):
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
        now = ConstantSpeed(scene.time, state.s, state.v_lon)
        return SpeedFollowing(now, actor.name, goal).next(scene.time, scene.states)

    def _speed_profile(self, node: Element, actor: Actor, scene: ActionScene) -> AxisCourse:
        """Speeds that are reached linearly, each in its time; the first one at once where its time is 0."""
        document, state = self.document, scene.states[actor.name]
        if document.text(node, "followingMode") != "position":
            raise document.error(node, f"followingMode={node.get('followingMode')}: position is needed")
        if node.get("entityRef"):
            raise document.error(node, "speeds that are relative to a vehicle are not supported")
        begin = speed = state.v_lon
        phases, most = [], self.boxes[actor.name].limits[0]
        for k, entry in enumerate(node.findall("SpeedProfileEntry")):
            target, duration = (document.number(entry, x) for x in ("speed", "time"))
            if abs(target) > most:
                problem = f"speed={target:g} is above maxSpeed={most:g} of the Performance of {actor.name}"
                raise document.error(entry, problem)
            if duration > 0:
                phases.append((duration, (target - speed) / duration))
            elif k or duration < 0:
                raise document.error(entry, f"time={duration:g} must be above 0")
            else:
                begin = target
            speed = target
        return Phases(scene.time, state.s, begin, tuple(phases))

    def _dynamics(self, node: Element) -> tuple[str, str, float]:
        """Shape, dimension and value, which is positive unless the shape is a step."""
        document = self.document
        shape, dimension = document.text(node, "dynamicsShape"), document.text(node, "dynamicsDimension")
        if shape not in ("step", *SHAPES):
            raise document.error(node, f"dynamicsShape={shape}: one of step, {', '.join(SHAPES)} is needed")
        if dimension not in ("time", "distance", "rate"):
            raise document.error(
                node, f"dynamicsDimension={dimension}: one of time, distance, rate is needed"
            )
        value = abs(document.number(node, "value"))
        document.pass_over(node, "followingMode", "position")
        return (shape if value else "step"), dimension, value

    def _keep_distance(self, node: Element, actor: Actor, scene: ActionScene, axis: Axis) -> AxisCourse:
        """Behind or right of another vehicle, or ahead or left of it, as ``displacement`` says.

        Where it does not say: as it is now along the road; across it to the left, as in esmini.
        """
        document, state, other = self.document, scene.states[actor.name], self._state(node, scene)
        name, seconds = document.text(node, "entityRef"), node.get("timeGap") is not None
        distance = abs(document.number(node, "timeGap" if seconds else "distance"))
        kind = node.get("displacement", "any")
        if kind not in ("any", *_BEHIND, *_AHEAD):
            raise document.error(node, f"displacement={kind} is not supported")
        beyond = other.s < state.s if axis == "along" else True
        beyond = beyond if kind == "any" else kind in _AHEAD
        clearance = 0.0
        if document.flag(node, "freespace"):
            box, other_box = self.boxes[actor.name], self.boxes[name]
            sizes = (box.length, other_box.length) if axis == "along" else (box.width, other_box.width)
            which = 0 if axis == "along" else 1
            shift = box.centre[which] - other_box.centre[which]
            clearance = sum(sizes) / 2 + (-shift if beyond else shift)
        for system in ("entity", "lane", "road"):
            document.pass_over(node, "coordinateSystem", system)
        limits = self._limits(node)
        if axis == "across":
            limits = replace(limits, deceleration=limits.acceleration)
        now = (
            ConstantSpeed(scene.time, state.s, state.v_lon)
            if axis == "along"
            else ConstantSpeed(scene.time, state.d)
        )
        continuous = document.flag(node, "continuous")
        signed = math.copysign(distance, -1.0 if beyond else 1.0)
        goal = DistanceGoal(axis, name, signed, seconds, clearance, limits, continuous)
        return DistanceKeeping(now, actor.name, goal).next(scene.time, scene.states)

    def _limits(self, node: Element) -> DynamicConstraints:
        limits = node.find("DynamicConstraints")
        if limits is None:
            return DynamicConstraints()
        names = ("Acceleration", "Deceleration", "Speed", "AccelerationRate", "DecelerationRate")
        return DynamicConstraints(
            *(self.document.number(limits, f"max{x}") if limits.get(f"max{x}") else math.inf for x in names)
        )

    def _synchronize(self, node: Element, actor: Actor, scene: ActionScene) -> AxisCourse:
        """Tolerances are not used: both vehicles arrive at the positions themselves."""
        document, state = self.document, scene.states[actor.name]
        other = document.text(node, "masterEntityRef")
        there, here = (
            self.positions.find(document.child(node, x), scene.states)[0]
            for x in ("TargetPositionMaster", "TargetPosition")
        )
        if here <= state.s or there <= scene.states[other].s:
            raise document.error(node, "a target position is behind its vehicle")
        final, share, steady = None, 0.0, (0.0, 0.0)
        if node.find("FinalSpeed") is not None:
            speed = document.only(document.child(node, "FinalSpeed"))
            for x in speed:
                kinds = {"TargetDistanceSteadyState": "distance", "TargetTimeSteadyState": "time"}
                if x.tag not in kinds:
                    raise document.error(x, "this steady state is not supported")
                value = document.number(x, kinds[x.tag])
                steady = (value, 0.0) if kinds[x.tag] == "distance" else (0.0, value)
            final = document.number(speed, "value")
            if speed.tag == "RelativeSpeedToMaster":
                factor = speed.get("speedTargetValueType") == "factor"
                final, share = (0.0, final) if factor else (final, 1.0)
        now = ConstantSpeed(scene.time, state.s, state.v_lon)
        course = SynchronizedArrival(now, actor.name, other, here, there, final, share, steady)
        return course.next(scene.time, scene.states)

    def _lane_change(self, node: Element, actor: Actor, scene: ActionScene) -> AxisCourse:
        document, state = self.document, scene.states[actor.name]
        target = document.only(document.child(node, "LaneChangeTarget"))
        here = state.s, state.d
        if target.tag == "AbsoluteTargetLane":
            d = self.positions.lane_called(target, here, round(document.number(target, "value")))
        elif target.tag == "RelativeTargetLane":
            other = self._state(target, scene)
            lane = self.positions.lane_beside(
                target, (other.s, other.d), round(document.number(target, "value"))
            )
            d = self.positions.lane_beside(target, (state.s, lane), 0)
        else:
            raise document.error(target, "this target is not supported")
        d += document.number(node, "targetLaneOffset", 0.0)
        shape, dimension, value = self._dynamics(document.child(node, "LaneChangeActionDynamics"))
        change = d - state.d
        if shape == "step" or not change:
            return ConstantSpeed(scene.time, d)
        if dimension == "distance":
            return PlaceOverDistance(state.s, (state.d, d), value, SHAPES[shape])
        if dimension == "rate":
            value = SHAPES[shape].steepest * abs(change) / value
        return PlaceTransition(scene.time, (state.d, d), value, SHAPES[shape])

    def _lane_offset(self, node: Element, actor: Actor, scene: ActionScene) -> AxisCourse:
        document, state = self.document, scene.states[actor.name]
        document.pass_over(node, "continuous", "false")
        target = document.only(document.child(node, "LaneOffsetTarget"))
        value = document.number(target, "value")
        if target.tag == "AbsoluteTargetLaneOffset":
            d = self.positions.lane_beside(target, (state.s, state.d), 0) + value
        elif target.tag == "RelativeTargetLaneOffset":
            if document.flag(node, "continuous"):
                rule = "continuous=true is not supported beside another vehicle"
                raise document.error(node, rule)
            other = self._state(target, scene)
            d = other.d + (value if other.forward else -value)
        else:
            raise document.error(target, "this target is not supported")
        dynamics = document.child(node, "LaneOffsetActionDynamics")
        shape, change = document.text(dynamics, "dynamicsShape"), d - state.d
        most = document.number(dynamics, "maxLateralAcc", _LATERAL)
        if shape == "step" or not change:
            return ConstantSpeed(scene.time, d)
        if shape not in SHAPES:
            raise document.error(
                dynamics, f"dynamicsShape={shape}: one of step, {', '.join(SHAPES)} is needed"
            )
        if most <= 0:
            raise document.error(dynamics, f"maxLateralAcc={most:g} must be above 0")
        bend = SHAPES[shape if SHAPES[shape].most_bent else "cubic"].most_bent
        duration = math.sqrt(bend * abs(change) / most)
        return PlaceTransition(scene.time, (state.d, d), duration, SHAPES[shape])

    def _state(self, node: Element, scene: ActionScene) -> ObjectState:
        """The vehicle that an element refers to. Raises ``KeyError`` where it has no place yet."""
        return scene.states[self.document.text(node, "entityRef")]


def in_opposite_direction(states: States) -> dict[str, ObjectState]:
    """States in the coordinates of those who drive against the road."""
    return {name: state.in_opposite_direction() for name, state in states.items()}
