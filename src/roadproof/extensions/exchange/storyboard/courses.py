"""Motions along and across a road as functions of time: transitions of speed, place and lane.

A transition from a to b in T seconds has the value a + (b - a)·f(t/T); f is x (linear), 3x² - 2x³ (cubic) or
(1 - cos πx)/2 (sinusoidal). All are evaluated in closed form, so nothing is integrated in steps.
"""

import math
from collections.abc import Callable, Mapping
from typing import Protocol

import numpy as np

from roadproof.extensions.exchange.storyboard.curves import curve
from roadproof.extensions.traffic.formats.recording import Floats
from roadproof.runtime.records import dataclass

_PI = math.pi


@dataclass(frozen=True)
class Shape:
    """f with its integral from 0 and its derivatives on [0, 1].

    ``steepest`` and ``most_bent``: the largest values of the derivatives.
    """

    value: Callable[[float], float]
    integral: Callable[[float], float]
    slope: Callable[[float], float]
    bend: Callable[[float], float]
    steepest: float
    most_bent: float


SHAPES: Mapping[str, Shape] = {
    "linear": Shape(lambda x: x, lambda x: x * x / 2, lambda x: 1.0, lambda x: 0.0, 1.0, 0.0),
    "cubic": Shape(
        lambda x: x * x * (3 - 2 * x),
        lambda x: x**3 - x**4 / 2,
        lambda x: 6 * x * (1 - x),
        lambda x: 6 - 12 * x,
        1.5,
        6.0,
    ),
    "sinusoidal": Shape(
        lambda x: (1 - math.cos(_PI * x)) / 2,
        lambda x: x / 2 - math.sin(_PI * x) / (2 * _PI),
        lambda x: _PI / 2 * math.sin(_PI * x),
        lambda x: _PI**2 / 2 * math.cos(_PI * x),
        _PI / 2,
        _PI**2 / 2,
    ),
}


@dataclass(frozen=True)
class Point:
    """Place (m), speed (m/s) and acceleration (m/s²) in one direction."""

    place: float
    speed: float
    acceleration: float = 0.0


class AxisCourse(Protocol):
    """A motion in one direction. ``along``: the motion along the road at the same time."""

    def at(self, time: float, along: Point) -> Point: ...

    def ended(self, time: float, along: Point) -> bool:
        """Return whether the transition is over."""
        ...


_SOON = 1e-9


@dataclass(frozen=True)
class ConstantSpeed:
    """Constant speed from ``begin`` (s) on."""

    begin: float
    start: float
    speed: float = 0.0

    def at(self, time: float, along: Point) -> Point:
        return Point(self.start + self.speed * (time - self.begin), self.speed)

    def ended(self, time: float, along: Point) -> bool:
        return True


@dataclass(frozen=True)
class SpeedTransition:
    """A change from one speed to another in ``duration`` s, constant afterwards."""

    begin: float
    start: float
    speeds: tuple[float, float]
    duration: float
    shape: Shape

    def at(self, time: float, along: Point) -> Point:
        low, high = self.speeds
        change, x = high - low, (time - self.begin) / self.duration
        if x >= 1:
            return Point(self.start + self.duration * ((low + high) / 2 + high * (x - 1)), high)
        place = self.start + self.duration * (low * x + change * self.shape.integral(x))
        speed = low + change * self.shape.value(x)
        return Point(place, speed, change * self.shape.slope(x) / self.duration)

    def ended(self, time: float, along: Point) -> bool:
        return time >= self.begin + self.duration - _SOON


@dataclass(frozen=True)
class CappedTransition:
    """A change of speed up to a time (s) at which the largest speed of a vehicle is reached, then steady."""

    course: SpeedTransition
    until: float

    def at(self, time: float, along: Point) -> Point:
        if time < self.until:
            return self.course.at(time, along)
        last = self.course.at(self.until, along)
        return Point(last.place + last.speed * (time - self.until), last.speed)

    def ended(self, time: float, along: Point) -> bool:
        return time >= self.until - _SOON


def cap_speed(course: SpeedTransition, most: float) -> SpeedTransition | CappedTransition:
    """A change of speed that ends where ``most`` (m/s) is reached, forwards or backwards."""
    low, high = course.speeds
    if abs(high) <= most or abs(low) >= abs(high):
        return course
    share = (math.copysign(most, high) - low) / (high - low)
    begin, end = 0.0, 1.0
    for _ in range(60):  # f ascends
        middle = (begin + end) / 2
        begin, end = (middle, end) if course.shape.value(middle) < share else (begin, middle)
    return CappedTransition(course, course.begin + end * course.duration)


@dataclass(frozen=True)
class PlaceTransition:
    """A change from one place to another in ``duration`` s, at rest afterwards."""

    begin: float
    places: tuple[float, float]
    duration: float
    shape: Shape

    def at(self, time: float, along: Point) -> Point:
        low, high = self.places
        change, x = high - low, (time - self.begin) / self.duration
        if x >= 1:
            return Point(high, 0.0)
        speed = change * self.shape.slope(x) / self.duration
        bend = change * self.shape.bend(x) / self.duration**2
        return Point(low + change * self.shape.value(x), speed, bend)

    def ended(self, time: float, along: Point) -> bool:
        return time >= self.begin + self.duration - _SOON


@dataclass(frozen=True)
class PlaceOverDistance:
    """A change of place while the vehicle goes ``length`` m from ``start``, at rest afterwards."""

    start: float
    places: tuple[float, float]
    length: float
    shape: Shape

    def at(self, time: float, along: Point) -> Point:
        low, high = self.places
        change, x = high - low, max(along.place - self.start, 0.0) / self.length
        if x >= 1:
            return Point(high, 0.0)
        speed, acceleration = along.speed / self.length, along.acceleration / self.length
        slope, bend = self.shape.slope(x), self.shape.bend(x)
        return Point(
            low + change * self.shape.value(x),
            change * slope * speed,
            change * (bend * speed**2 + slope * acceleration),
        )

    def ended(self, time: float, along: Point) -> bool:
        return along.place - self.start >= self.length - _SOON


@dataclass(frozen=True)
class ShiftedCourse:
    """A course shifted by a distance."""

    course: AxisCourse
    by: float

    def at(self, time: float, along: Point) -> Point:
        point = self.course.at(time, along)
        return Point(point.place - self.by, point.speed, point.acceleration)

    def ended(self, time: float, along: Point) -> bool:
        return self.course.ended(time, along)


@dataclass(frozen=True)
class PathCourse:
    """Places, along the road or across it, at lengths of a path on which a vehicle moves as ``motion`` says.

    ``straight``: between points; otherwise on cubics through them. ``across``: at rest after the last point;
    otherwise on along the road.
    """

    motion: AxisCourse
    lengths: Floats
    places: Floats
    straight: bool
    across: bool

    def at(self, time: float, along: Point) -> Point:
        gone = self.motion.at(time, along)
        more = gone.place - float(self.lengths[-1])
        if more > 0:
            last = float(self.places[-1])
            return Point(last, 0.0) if self.across else Point(last + more, gone.speed, gone.acceleration)
        if self.straight:
            later = int(np.searchsorted(self.lengths, gone.place, side="right"))
            k = min(max(later, 1), len(self.lengths) - 1)
            low, high = self.lengths[k - 1], self.lengths[k]
            slope = float((self.places[k] - self.places[k - 1]) / (high - low))
            place, bend = float(self.places[k - 1] + slope * (gone.place - low)), 0.0
        else:
            place, slope, bend = (
                float(x[0]) for x in curve(self.lengths, self.places, np.array([gone.place]))
            )
        return Point(place, slope * gone.speed, bend * gone.speed**2 + slope * gone.acceleration)

    def ended(self, time: float, along: Point) -> bool:
        if not self.across:
            return self.motion.ended(time, along)
        return self.motion.at(time, along).place >= float(self.lengths[-1]) - _SOON


@dataclass(frozen=True)
class TimedTrajectory:
    """The motion of a trajectory from ``begin`` to ``end`` (s); ``before`` until then, steady afterwards.

    ``speed``: that afterwards.
    """

    before: AxisCourse
    begin: float
    end: float
    point: Callable[[float], Point]
    speed: float

    def at(self, time: float, along: Point) -> Point:
        if time < self.begin - _SOON:
            return self.before.at(time, along)
        if time <= self.end + _SOON:
            return self.point(min(max(time, self.begin), self.end))
        last = self.point(self.end)
        return ConstantSpeed(self.end, last.place, self.speed).at(time, along)

    def ended(self, time: float, along: Point) -> bool:
        return time >= self.end - _SOON
