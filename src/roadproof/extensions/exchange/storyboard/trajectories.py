"""Trajectories: polylines, clothoids, splines of clothoids and NURBS, with or without times.

Clothoids and NURBS become points at most SPACING m apart, but at most MOST; cubics through the points are
less than a millimetre from a curve of more than 10 m radius. A trajectory with times says where the vehicle
is. On one without times it begins at the first point, as in esmini, and its speed is that on the path.
"""

import math
from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from roadproof.extensions.exchange.storyboard.box import ObjectBox
from roadproof.extensions.exchange.storyboard.controllers import Phases
from roadproof.extensions.exchange.storyboard.courses import (
    AxisCourse,
    ConstantSpeed,
    PathCourse,
    Point,
    ShiftedCourse,
    SpeedTransition,
    TimedTrajectory,
)
from roadproof.extensions.exchange.storyboard.curves import curve
from roadproof.extensions.exchange.storyboard.document import Document
from roadproof.extensions.exchange.storyboard.positions import Positions, States
from roadproof.extensions.maps.xml_reader import Element
from roadproof.extensions.traffic.formats.recording import Floats
from roadproof.runtime.records import dataclass

SPACING = 0.25
MOST = 20_000
_LATE = 0.011


_Pose: TypeAlias = tuple[float, float, float]


@dataclass(frozen=True)
class _Points:
    """Points in the plane with headings; ``times`` where the file says them.

    ``straight``: lines between them are meant, where there are no times.
    """

    x: Floats
    y: Floats
    heading: Floats
    times: Floats | None
    straight: bool = False


@dataclass(frozen=True)
class TrajectoryReader:
    """Reads FollowTrajectoryActions of a vehicle."""

    document: Document
    positions: Positions
    name: str
    box: ObjectBox

    def courses(
        self, node: Element, before: tuple[AxisCourse, AxisCourse], begin: float, states: States
    ) -> tuple[AxisCourse, AxisCourse]:
        """The courses along and across the road of an action that begins now, after those ``before``."""
        document = self.document
        trajectory = next(node.iter("Trajectory"), None)
        if trajectory is None:
            raise document.error(node, "a Trajectory is needed")
        document.text(
            document.child(node, "TrajectoryFollowingMode"), "followingMode"
        )  # both as position: see notes
        if document.flag(trajectory, "closed"):
            raise document.error(node, "closed=true: write out the way back as vertices with times")
        if document.number(node, "initialDistanceOffset", 0.0):
            raise document.error(node, "initialDistanceOffset is not supported; begin at the first point")
        points = self._points(trajectory, states)
        s, d = self._in_road(points)
        times = self._times(node, points.times, begin)
        if times is None:
            if not (np.diff(s).any() or np.diff(d).any()):
                raise document.error(node, "all points are at one place")
            return _on_path(before[0], (s, d), points.straight, begin)
        if times[0] < begin - _LATE:
            problem = f"it begins at {begin:g} s, after the first point at {times[0]:g} s"
            raise document.error(node, problem)
        first, last = float(times[0]), float(times[-1])
        ahead, beside = _at(times, s), _at(times, d)
        speeds = ahead(last).speed, beside(last).speed
        speed = math.copysign(math.hypot(*speeds), speeds[0])  # it goes on along the road
        return (
            TimedTrajectory(before[0], first, last, ahead, speed),
            TimedTrajectory(before[1], first, last, beside, 0.0),
        )

    def first(self, node: Element, states: States) -> tuple[float, float]:
        """Return s and d of a vehicle's reference point at the first point of an action's trajectory."""
        trajectory = next(node.iter("Trajectory"), None)
        if trajectory is None:
            raise self.document.error(node, "a Trajectory is needed")
        s, d = self._in_road(self._points(trajectory, states))
        return float(s[0]), float(d[0])

    def _times(self, node: Element, times: Floats | None, begin: float) -> Floats | None:
        """Seconds of the storyboard at which the points are reached, None where the file says no times."""
        document = self.document
        if node.find("TimeReference") is None or node.find("TimeReference/None") is not None:
            return None
        timing = document.child(node, "TimeReference/Timing")
        domain = timing.get("domainAbsoluteRelative")
        if domain not in ("absolute", "relative"):
            raise document.error(timing, f"domainAbsoluteRelative={domain}: absolute or relative is needed")
        if times is None:
            raise document.error(node, "a Timing needs points with times")
        scale, offset = (document.number(timing, x) for x in ("scale", "offset"))
        seconds: Floats = times * scale + offset + (begin if domain == "relative" else 0.0)
        if not (np.diff(seconds) > 0).all():
            raise document.error(node, "each point must have a later time than the one before")
        return seconds

    def _in_road(self, points: _Points) -> tuple[Floats, Floats]:
        """Return s and d of the reference point of an aligned vehicle, by the centre of its box."""
        ahead, left = self.box.centre
        x = points.x + ahead * np.cos(points.heading) - left * np.sin(points.heading)
        y = points.y + ahead * np.sin(points.heading) + left * np.cos(points.heading)
        places = [self.positions.place(float(a), float(b)) for a, b in zip(x, y, strict=True)]
        s, d = np.array(places).T
        return s - ahead, d - left

    def _points(self, trajectory: Element, states: States) -> _Points:
        document = self.document
        shape = document.only(document.child(trajectory, "Shape"))
        match shape.tag:
            case "Polyline":
                return self._vertices(shape.findall("Vertex"), states)
            case "Clothoid":
                prime = "curvaturePrime" if shape.get("curvaturePrime") else "curvatureDot"
                low, length = document.number(shape, "curvature"), document.number(shape, "length")
                piece = low, low + document.number(shape, prime) * length, length
                pose = self.positions.pose(document.child(shape, "Position"), states)
                ends = [document.number(shape, x) for x in ("startTime", "stopTime") if shape.get(x)]
                return self._clothoids(shape, [(pose, 0.0, piece)], ends, states)
            case "ClothoidSpline":
                return self._spline(shape, states)
            case "Nurbs":
                return self._nurbs(shape, states)
        raise document.error(shape, "one of Polyline, Clothoid, ClothoidSpline, Nurbs is needed")

    def _vertices(self, nodes: list[Element], states: States) -> _Points:
        if len(nodes) < 2:
            problem = "at least two vertices are needed"
            raise self.document.error(nodes[0] if nodes else self.document.root, problem)
        x, y, heading = np.array([self._vertex(node, states) for node in nodes]).T
        timed = all(node.get("time") for node in nodes)
        times = np.array([self.document.number(node, "time") for node in nodes]) if timed else None
        ways = np.arctan2(np.gradient(y), np.gradient(x))
        return _Points(x, y, np.where(np.isnan(heading), ways, heading), times, straight=True)

    def _vertex(self, node: Element, states: States) -> tuple[float, float, float]:
        """Return x, y and heading; NaN for a heading that the file lacks."""
        position = self.document.child(node, "Position")
        x, y, heading = self.positions.pose(position, states)
        place = self.document.only(position)
        direction = place.get("h") if place.tag == "WorldPosition" else place.find("Orientation")
        return x, y, math.nan if direction is None else heading

    def _spline(self, shape: Element, states: States) -> _Points:
        document = self.document
        pieces = []
        for node in shape.findall("ClothoidSplineSegment"):
            begin = node.find("PositionStart")
            pose = None if begin is None else self.positions.pose(begin, states)
            if node.get("timeStart"):
                raise document.error(node, "timeStart is not supported")
            low, high, length = (
                document.number(node, x) for x in ("curvatureStart", "curvatureEnd", "length")
            )
            pieces.append((pose, document.number(node, "hOffset", 0.0), (low, high, length)))
        return self._clothoids(shape, pieces, [], states)

    def _clothoids(
        self,
        node: Element,
        pieces: list[tuple[_Pose | None, float, _Pose]],
        ends: list[float],
        states: States,
    ) -> _Points:
        """Points of clothoids, each with its pose, a turn, curvatures and length.

        Without pose it begins where the one before ends, the first one where the vehicle is. ``ends``: times
        of the first and the last point.
        """
        if not pieces:
            raise self.document.error(node, "a ClothoidSplineSegment is needed")
        x, y, heading = pieces[0][0] or self.positions.pose_of(states[self.name])
        poses = [(x, y, heading)]
        for pose, offset, (low, high, length) in pieces:
            x, y, heading = poses[-1] if pose is None else pose
            heading += offset
            count = min(max(math.ceil(length / SPACING), 1), MOST)
            step = length / count
            for k in range(count):
                quarter, middle = (low + (high - low) * (k + part) / count for part in (0.25, 0.5))
                half, turn = heading + step * quarter / 2, step * middle
                chord = step * (1 - turn * turn / 24)
                x, y = x + chord * math.cos(half), y + chord * math.sin(half)
                heading += turn
                poses.append((x, y, heading))
        xs, ys, headings = np.array(poses).T
        times = np.linspace(ends[0], ends[1], len(poses)) if len(ends) == 2 else None
        return _Points(xs, ys, headings, times)

    def _nurbs(self, shape: Element, states: States) -> _Points:
        """Points of a NURBS; the times of its control points are a further coordinate of it."""
        document = self.document
        order = round(document.number(shape, "order"))
        controls = shape.findall("ControlPoint")
        knots = np.array([document.number(x, "value") for x in shape.findall("Knot")])
        if (
            order < 2
            or len(controls) < order
            or len(knots) != len(controls) + order
            or (np.diff(knots) < 0).any()
        ):
            raise document.error(
                shape, f"{len(controls)} control points of order {order} need ascending knots"
            )
        poses = [self.positions.pose(document.child(x, "Position"), states)[:2] for x in controls]
        timed = all(x.get("time") for x in controls)
        rows = [
            (*xy, document.number(x, "time") if timed else 0.0, 1.0)
            for x, xy in zip(controls, poses, strict=True)
        ]
        weights = np.array([document.number(x, "weight", 1.0) for x in controls])
        values = np.array(rows) * weights[:, None]
        length = float(np.hypot(*np.diff(np.array(poses), axis=0).T).sum())
        count = min(max(math.ceil(length / SPACING), order), MOST)
        spans = np.linspace(knots[order - 1], knots[len(controls)], count + 1)
        rational = np.array([de_boor(float(u), order, knots, values) for u in spans])
        x, y, time = (rational[:, :3] / rational[:, 3:]).T
        return _Points(x, y, np.arctan2(np.gradient(y), np.gradient(x)), time if timed else None)


def _on_path(
    motion: AxisCourse, places: tuple[Floats, Floats], straight: bool, begin: float
) -> tuple[AxisCourse, AxisCourse]:
    """The courses of a vehicle that goes on with its speed, from the first point of a path."""
    steps = np.hypot(*np.diff(np.array(places), axis=1))
    apart = np.concatenate(([True], steps > 0))
    s, d = (x[apart] for x in places)
    lengths = np.concatenate(([0.0], np.cumsum(steps[steps > 0])))
    now = motion.at(begin, Point(0.0, 0.0))
    goes_on = isinstance(motion, SpeedTransition | Phases)
    inner: AxisCourse = ShiftedCourse(motion, now.place) if goes_on else ConstantSpeed(begin, 0.0, now.speed)
    return PathCourse(inner, lengths, s, straight, across=False), PathCourse(
        inner, lengths, d, straight, across=True
    )


def de_boor(u: float, order: int, knots: Floats, values: Floats) -> Floats:
    """The value at ``u`` of the B-spline of an order with such control values, by de Boor's algorithm."""
    k = min(int(np.searchsorted(knots, u, side="right")) - 1, len(values) - 1)
    controls = [values[j + k - order + 1].copy() for j in range(order)]
    for r in range(1, order):
        for j in range(order - 1, r - 1, -1):
            low, high = knots[j + k - order + 1], knots[j + 1 + k - r]
            share = (u - low) / (high - low) if high > low else 0.0
            controls[j] = (1 - share) * controls[j - 1] + share * controls[j]
    last: Floats = controls[order - 1]
    return last


def _at(times: Floats, places: Floats) -> Callable[[float], Point]:
    def point(time: float) -> Point:
        return Point(*(float(x[0]) for x in curve(times, places, np.array([time]))))

    return point
