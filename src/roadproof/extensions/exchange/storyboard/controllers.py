"""Actions that look at another vehicle at each tick: distances that are kept, and arrivals at the same time.

All are courses whose ``next`` is the course from the next tick on. Accelerations are constant in a tick.
"""

import math
from dataclasses import replace
from itertools import pairwise
from typing import Final, Literal, TypeAlias

from roadproof.extensions.exchange.storyboard.courses import AxisCourse, ConstantSpeed, Point, Shape
from roadproof.extensions.exchange.storyboard.positions import ObjectState, States
from roadproof.runtime.records import dataclass

_NEAR = 0.1
"""m: a distance that is to be reached once is reached, as in esmini."""
_SPRING = 0.4
_SLOWEST = 1e-6
_STEP = 0.01

Axis: TypeAlias = Literal["along", "across"]
AXES: Final[tuple[Axis, ...]] = ("along", "across")
Phase: TypeAlias = tuple[float, float]
"""Duration (s) and acceleration (m/s²)."""


def point_on_axis(state: ObjectState, axis: Axis) -> Point:
    """A vehicle's motion along the road or across it."""
    if axis == "along":
        return Point(state.s, state.v_lon, state.a_lon)
    return Point(state.d, state.v_lat, state.a_lat)


@dataclass(frozen=True)
class Phases:
    """Constant accelerations one after the other, then constant speed."""

    begin: float
    start: float
    speed: float
    phases: tuple[Phase, ...]

    def at(self, time: float, along: Point) -> Point:
        place, speed, left = self.start, self.speed, time - self.begin
        for duration, acceleration in self.phases:
            u = min(left, duration)
            place += speed * u + acceleration * u * u / 2
            speed += acceleration * u
            left -= u
            if left <= 0:
                return Point(place, speed, acceleration if u < duration else 0.0)
        return Point(place + speed * left, speed)

    def ended(self, time: float, along: Point) -> bool:
        return time >= self.begin + sum(x for x, _ in self.phases)


@dataclass(frozen=True)
class DynamicConstraints:
    """Limits of acceleration and deceleration (m/s²), of their rates (m/s³) and of speed (m/s)."""

    acceleration: float = math.inf
    deceleration: float = math.inf
    speed: float = math.inf
    acceleration_rate: float = math.inf
    deceleration_rate: float = math.inf


@dataclass(frozen=True)
class DistanceGoal:
    """A distance to another vehicle: m, or s of its speed, along the road or across it.

    Positive: behind the other one or to its right. ``apart``: what is between reference points where the
    distance is 0. ``continuous``: it is kept, otherwise reached once.
    """

    axis: Axis
    other: str
    distance: float
    seconds: bool
    apart: float
    limits: DynamicConstraints
    continuous: bool

    def error(self, name: str, states: States) -> float:
        """Return how far a vehicle has to go to be at the distance (m)."""
        other = states[self.other]
        target = self.distance * (abs(other.v_lon) if self.seconds else 1.0)
        target += math.copysign(self.apart, self.distance)
        return point_on_axis(other, self.axis).place - point_on_axis(states[name], self.axis).place - target


@dataclass(frozen=True)
class DistanceKeeping:
    """Is at the distance of a ``goal``.

    Without limits of acceleration it is there at once. With them it is a spring with critical damping, as in
    esmini: stiffness 0.4 times the limit of acceleration; limits of jerk hold where acceleration grows.
    """

    now: AxisCourse
    name: str
    goal: DistanceGoal
    acceleration: float = 0.0
    reached: bool = False

    def at(self, time: float, along: Point) -> Point:
        return self.now.at(time, along)

    def ended(self, time: float, along: Point) -> bool:
        return self.reached

    def next(self, time: float, states: States) -> "DistanceKeeping":
        """Return the controller from ``time`` on, with all vehicles as in ``states``."""
        goal, most = self.goal, self.goal.limits
        here, other = (point_on_axis(states[x], goal.axis) for x in (self.name, goal.other))
        error = goal.error(self.name, states)
        reached = not goal.continuous and abs(error) < _NEAR
        if math.isinf(most.acceleration) and math.isinf(most.deceleration):
            if goal.axis == "across" and abs(error) > most.speed * _STEP:
                glide = ConstantSpeed(time, here.place, math.copysign(most.speed, error))
                return replace(self, now=glide, reached=reached)
            there = Phases(time, here.place + error, other.speed, ((_STEP, other.acceleration),))
            return replace(self, now=there, reached=not goal.continuous)
        pull = self._spring_acceleration(error, here, other)
        course = Phases(time, here.place, here.speed, ((_STEP, 0.0 if reached else pull),))
        return replace(self, now=course, acceleration=pull, reached=reached)

    def _spring_acceleration(self, error: float, here: Point, other: Point) -> float:
        """The acceleration of the spring within the limits."""
        most, before = self.goal.limits, self.acceleration
        tension = most.acceleration if error < 0 else most.deceleration
        tension = tension if math.isfinite(tension) else min(most.acceleration, most.deceleration)
        stiffness = _SPRING * tension
        pull = error * stiffness - (here.speed - other.speed) * 2 * math.sqrt(stiffness)
        pull = min(max(pull, -most.deceleration), most.acceleration)
        if pull < min(before, 0.0):
            pull = max(before - most.deceleration_rate * _STEP, pull)
        elif pull > max(before, 0.0):
            pull = min(before + most.acceleration_rate * _STEP, pull)
        return min(max(pull, (-most.speed - here.speed) / _STEP), (most.speed - here.speed) / _STEP)


@dataclass(frozen=True)
class SynchronizedArrival:
    """Is at ``place`` when another vehicle, if it keeps its speed, is at ``other_place``.

    With ``final_speed``: two phases of the same acceleration, or with a stop between; otherwise constant
    speed. A plan is made again where the other vehicle changes its speed. ``share``: the final speed is
    ``final_speed`` plus so many times that of the other one. ``steady``: it has this speed in the last so
    many metres, and in the last so many seconds.
    """

    now: AxisCourse
    name: str
    other: str
    place: float
    other_place: float
    final_speed: float | None
    share: float = 0.0
    steady: tuple[float, float] = (0.0, 0.0)
    planned: float | None = None
    over: bool = False

    def at(self, time: float, along: Point) -> Point:
        return self.now.at(time, along)

    def ended(self, time: float, along: Point) -> bool:
        return self.over

    def next(self, time: float, states: States) -> "SynchronizedArrival":
        """Return the controller from ``time`` on, with all vehicles as in ``states``."""
        state, other = states[self.name], states[self.other]
        way, left = self.place - state.s, self.other_place - other.s
        over = way <= _STEP * abs(state.v_lon) / 2 or left <= _STEP * abs(other.v_lon) / 2
        if over or other.v_lon == self.planned:
            return replace(self, over=over)
        if other.v_lon <= _SLOWEST:
            return replace(self, now=ConstantSpeed(time, state.s), planned=other.v_lon)
        duration = left / other.v_lon
        if self.final_speed is None:
            course: AxisCourse = ConstantSpeed(time, state.s, way / duration)
        else:
            final = self.final_speed + self.share * other.v_lon
            last = self.steady[1] + (self.steady[0] / final if final > _SLOWEST else 0.0)
            way, duration = way - last * final, duration - last
            if way <= 0 or duration <= 0:
                course = Phases(time, state.s, final, ())
            else:
                phases = arrival_phases(way, duration, (state.v_lon, final))
                course = Phases(time, state.s, state.v_lon, phases)
        return replace(self, now=course, planned=other.v_lon)


@dataclass(frozen=True)
class SpeedGoal:
    """A speed that is relative to that of another vehicle at any time: plus ``more``, ``factor`` times it.

    It is reached in ``duration`` s as ``shape`` says, from ``begin`` (s) and a speed on; at most ``most``.
    """

    other: str
    factor: float
    more: float
    begin: float
    start: float
    duration: float
    shape: Shape
    most: float

    def speed(self, time: float, states: States) -> float:
        """The speed to be had at ``time``, where all vehicles are as ``states`` say a step earlier."""
        other = states[self.other]
        speed = other.v_lon + other.a_lon * _STEP
        goal = (speed if other.forward else -speed) * self.factor + self.more
        goal = min(max(goal, -self.most), self.most)
        if self.duration <= 0 or time >= self.begin + self.duration:
            return goal
        return self.start + (goal - self.start) * self.shape.value((time - self.begin) / self.duration)


@dataclass(frozen=True)
class SpeedFollowing:
    """Has the speed of a ``goal`` for ever."""

    now: AxisCourse
    name: str
    goal: SpeedGoal

    def at(self, time: float, along: Point) -> Point:
        return self.now.at(time, along)

    def ended(self, time: float, along: Point) -> bool:
        return False

    def next(self, time: float, states: States) -> "SpeedFollowing":
        """Return the controller from ``time`` on, with all vehicles as in ``states``."""
        here, goal = states[self.name], self.goal
        speed = goal.speed(time, states) if goal.duration <= 0 and time <= goal.begin else here.v_lon
        change = (goal.speed(time + _STEP, states) - speed) / _STEP
        return replace(self, now=Phases(time, here.s, speed, ((_STEP, change),)))


ReactiveCourse: TypeAlias = DistanceKeeping | SynchronizedArrival | SpeedFollowing
"""Courses that look at another vehicle at each tick."""


def arrival_phases(way: float, duration: float, speeds: tuple[float, float]) -> tuple[Phase, ...]:
    """Phases in which a vehicle goes ``way`` m in ``duration`` s from one speed to another.

    Two with the same acceleration, one of them negative; where this were backwards, a stop between.
    """
    low, high = speeds
    change, more = high - low, way - low * duration
    half = change * duration - 2 * more  # of duration² a² + 2 half a - change² = 0
    root = math.sqrt(half * half + (duration * change) ** 2)
    a = (-half - root if half > 0 else root - half) / duration**2
    if abs(a) < _SLOWEST:
        return ((duration, 0.0),)
    first = min(max((duration + change / a) / 2, 0.0), duration)
    if low + a * first >= 0 or low <= 0 or high <= 0:
        return ((first, a), (duration - first, -a))
    a = (low * low + high * high) / (2 * way)
    ends = (0.0, low / a, duration - high / a, duration)
    moves = (-a, 0.0, a)
    return tuple((end - begin, x) for (begin, end), x in zip(pairwise(ends), moves, strict=True))
