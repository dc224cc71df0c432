"""Motions of a storyboard as a drive, which is judged in dense time.

A drive has pieces of constant jerk along the road and of constant acceleration across it. Steps, linear
changes of speed and speed profiles are such pieces, so the drive is the motion itself, with values rounded to
DIGITS decimals. Elsewhere places and speeds are those of the motion at the ends of pieces, which are halved
until they are within CLOSE of the motion; the largest difference is told.
"""

from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import TypeAlias

from roadproof.errors import InputError
from roadproof.extensions.exchange.storyboard.actions import Actor
from roadproof.extensions.exchange.storyboard.box import ObjectBox
from roadproof.extensions.exchange.storyboard.conditions import TICKS
from roadproof.extensions.exchange.storyboard.control import REMEDY
from roadproof.extensions.exchange.storyboard.controllers import Phases, ReactiveCourse
from roadproof.extensions.exchange.storyboard.courses import (
    AxisCourse,
    CappedTransition,
    PlaceTransition,
    Point,
    SpeedTransition,
)
from roadproof.extensions.exchange.storyboard.play import Play
from roadproof.extensions.exchange.storyboard.positions import ObjectState
from roadproof.extensions.exchange.storyboard.stage import open_stage, run_stage
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Across, Along, Drive, Motion, motion_of
from roadproof.world.not_read import LEFT_OUT
from roadproof.world.road import Road
from roadproof.world.signals import Kind

DIGITS = 9
CLOSE = 1e-4
"""m"""
_TIME_DIGITS = 6
_SHORTEST = 0.02
_CHECK_POINTS = 8
"""So many instants inside a piece are compared with the motion."""
_SMALL = 1e-7
_JUMP = 1e-3
"""m/s: a greater change of the speed at one instant is none that a drive has."""
_KINDS: dict[str, Kind] = {"Car": "car", "Truck": "truck", "Motorcycle": "motorcycle"}
AxisMotion: TypeAlias = Callable[[float], Point]
"""Place, speed and acceleration in one direction by time (s)."""


@dataclass(frozen=True)
class StoryboardDrive:
    """A drive on a road up to its end (s), and how far it is from the storyboard's motion (m, m/s).

    ``unread``: parts of the file that were left out.
    """

    drive: Drive
    road: Road
    horizon: Fraction
    place_error: float
    speed_error: float
    ending: str
    unread: tuple[str, ...] = ()

    @property
    def note(self) -> str:
        """The note about it."""
        ends = f"the storyboard ends at {float(self.horizon):g} s: {self.ending}"
        goes_on = "in dense time vehicles then go on with constant speeds"
        error = f"{self.place_error:.1g} m and {self.speed_error:.1g} m/s of the storyboard"
        left_out = f". {LEFT_OUT.capitalize()}: {'; '.join(self.unread)}" if self.unread else ""
        return f"{ends}; {goes_on}. The drive is within {error}{left_out}"


@dataclass
class _Error:
    place: float = 0.0
    speed: float = 0.0

    def update(self, place: float, speed: float) -> None:
        self.place, self.speed = max(self.place, abs(place)), max(self.speed, abs(speed))


def read_storyboard_drive(path: Path) -> StoryboardDrive:
    """The drive of all motor vehicles of a file. Raises ``InputError`` that names the vehicle and the time.

    All of them have to be on the road, and to drive along it, all the time, without jumps of place or speed.
    """
    stage, play = run_stage(open_stage(path))
    omissions = (*stage.document.left_out(), *stage.road.unread)
    error, vehicles, where = _Error(), dict[str, Motion](), str(path)
    end = len(play.states) - 1
    for name, box in stage.boxes.items():
        if box.recorded:
            _check_presence(play, name, where)
            vehicles[name] = _motion(play, name, box, error, where)
    horizon = Fraction(end, TICKS)
    return StoryboardDrive(
        Drive(vehicles), stage.road, horizon, error.place, error.speed, play.ending, omissions
    )


def _check_presence(play: Play, name: str, where: str) -> None:
    rule = "in dense time every vehicle drives along the road all the time"
    if name in play.controlled:
        raise InputError(f"{where}: vehicle {name}, {play.controlled[name]}: {rule}; {REMEDY}")
    for tick, states in enumerate(play.states):
        if name not in states or not states[name].forward or play.jumps(name, tick):
            raise InputError(f"{where}: vehicle {name} at {tick / TICKS:g} s: {rule}")


def _check_smooth(play: Play, name: str, time: float, where: str) -> None:
    """Raise ``InputError`` where a speed jumps at a knot."""
    if not time:
        return
    before, after = play.state_before(name, time), play.state_at(name, time)
    for speed, direction in (("v_lon", ""), ("v_lat", " across")):
        if abs(getattr(after, speed) - getattr(before, speed)) > _JUMP:
            rule = f"the speed{direction} jumps; in dense time it changes steadily"
            raise InputError(f"{where}: vehicle {name} at {time:g} s: {rule}")


def _motion(play: Play, name: str, box: ObjectBox, error: _Error, where: str) -> Motion:
    knots = [*_knots(play, name)]
    first = play.state_at(name, 0.0)
    ahead, left = box.centre[0] + box.length / 2, box.centre[1] + box.width / 2
    begin_s, begin_d = _rounded(first.s), _rounded(first.d)
    v_lon, v_lat = _rounded(first.v_lon), _rounded(first.v_lat)
    along: list[Along] = []
    across: list[Across] = []
    now_s, now_d = (begin_s, v_lon), (begin_d, v_lat)
    for low, high in pairwise(knots):
        _check_smooth(play, name, float(low), where)
        s, d = _axes(play, name, float(high))
        for piece in _fit_along(s, now_s, (low, high), error):
            along.append(piece)
            now_s = _after(now_s, piece[0], piece[1], piece[2])
        for part in _fit_across(d, now_d, (low, high), error):
            across.append(part)
            now_d = _after(now_d, part[0], part[1], Fraction(0))
    size = _rounded(box.length), _rounded(box.width)
    place = begin_s + _rounded(ahead), begin_d + _rounded(left)
    made = motion_of(size, place, (v_lon, v_lat), along, across)
    return Motion(*size, made.s, made.d, made.v_lon, made.v_lat, made.pieces, _KINDS.get(box.kind))


def _axes(play: Play, name: str, end: float) -> tuple[AxisMotion, AxisMotion]:
    """The motion in both directions up to a knot, where what begins there has no say."""

    def state(time: float) -> ObjectState:
        return play.state_before(name, time) if time >= end else play.state_at(name, time)

    def along(time: float) -> Point:
        x = state(time)
        return Point(x.s, x.v_lon, x.a_lon)

    def across(time: float) -> Point:
        x = state(time)
        return Point(x.d, x.v_lat, x.a_lat)

    return along, across


def _knots(play: Play, name: str) -> Iterator[Fraction]:
    """Times at which the motion changes its form: ticks at which it is another course, and its own breaks."""
    end = Fraction(len(play.states) - 1, TICKS)
    history = play.history[name]
    knots = {Fraction(0), end}
    before: Actor | None = None
    for (tick, actor), later in zip(history, [*(x for x, _ in history[1:]), len(play.states)], strict=True):
        begin, until = Fraction(tick, TICKS), Fraction(later, TICKS)
        exact = (_rounded(x, _TIME_DIGITS) for x in _breaks([actor.along, actor.across]))
        knots |= {x for x in exact if begin < x < until}
        if not _goes_on(before, actor):
            knots.add(begin)
        before = actor
    return iter(sorted(x for x in knots if x <= end))


def _goes_on(before: Actor | None, now: Actor) -> bool:
    """Return whether a vehicle that looks at another one still does the same."""
    if before is None:
        return False
    pairs = (before.along, now.along), (before.across, now.across)
    return all(x is y or (isinstance(x, ReactiveCourse) and type(x) is type(y)) for x, y in pairs)


def _breaks(courses: list[AxisCourse]) -> Iterator[float]:
    """Times at which courses change their form."""
    for course in courses:
        match course:
            case CappedTransition():
                yield course.until
            case SpeedTransition() | PlaceTransition():
                yield course.begin + course.duration
            case Phases():
                time = course.begin
                for duration, _ in course.phases:
                    time += duration
                    yield time


def _fit_along(
    motion: AxisMotion, now: tuple[Fraction, Fraction], span: tuple[Fraction, Fraction], error: _Error
) -> list[Along]:
    """Pieces from a place and speed to those of the motion at the end of a span."""
    low, high = span
    length, target = high - low, motion(float(high))
    more = _rounded(target.place) - now[0] - now[1] * length
    faster = _rounded(target.speed) - now[1]
    jerk = 6 * (faster * length - 2 * more) / length**3
    if abs(jerk * length**3) < _SMALL:
        whole_piece = (length, _rounded(float(faster / length)), Fraction(0))
    else:
        whole_piece = (
            length,
            _rounded(float((6 * more - 2 * faster * length) / length**2), 12),
            _rounded(float(jerk), 12),
        )
    if _is_close(motion, now, whole_piece, span) or float(length) < 2 * _SHORTEST:
        _compare(motion, now, whole_piece, span, error)
        return [whole_piece]
    middle = (low + high) / 2
    first = _fit_along(motion, now, (low, middle), error)
    for piece in first:
        now = _after(now, *piece)
    return [*first, *_fit_along(motion, now, (middle, high), error)]


def _fit_across(
    motion: AxisMotion, now: tuple[Fraction, Fraction], span: tuple[Fraction, Fraction], error: _Error
) -> list[Across]:
    """Fit the motion across the road, with two constant accelerations where one does not suffice."""
    low, high = span
    length, target = high - low, motion(float(high))
    more = _rounded(target.place) - now[0] - now[1] * length
    faster = _rounded(target.speed) - now[1]
    if abs(more - faster * length / 2) < _SMALL:
        pieces = [(length, _rounded(float(faster / length)))]
    else:
        first = 4 * more / length**2 - faster / length
        both = first, 2 * faster / length - first
        pieces = [(length / 2, _rounded(float(x), 12)) for x in both]
    begins, starts = [now], [low]
    for piece in pieces:
        begins.append(_after(begins[-1], *piece, Fraction(0)))
        starts.append(starts[-1] + piece[0])
    parts = [((*x, Fraction(0)), y, z) for x, y, z in zip(pieces, begins, pairwise(starts), strict=False)]
    if all(_is_close(motion, y, x, z) for x, y, z in parts) or float(length) < 2 * _SHORTEST:
        for x, y, z in parts:
            _compare(motion, y, x, z, error)
        return pieces
    middle = (low + high) / 2
    halves = _fit_across(motion, now, (low, middle), error)
    for piece in halves:
        now = _after(now, *piece, Fraction(0))
    return [*halves, *_fit_across(motion, now, (middle, high), error)]


def _differences(
    motion: AxisMotion, now: tuple[Fraction, Fraction], piece: Along, span: tuple[Fraction, Fraction]
) -> Iterator[tuple[float, float]]:
    """Yield differences of place and speed between a piece and the motion, inside it and at its end."""
    for k in range(1, _CHECK_POINTS + 1):
        gone = piece[0] * k / _CHECK_POINTS
        place, speed = _after(now, gone, piece[1], piece[2])
        there = motion(float(span[0] + gone))
        yield float(place) - there.place, float(speed) - there.speed


def _is_close(
    motion: AxisMotion, now: tuple[Fraction, Fraction], piece: Along, span: tuple[Fraction, Fraction]
) -> bool:
    return all(abs(place) < CLOSE for place, _ in _differences(motion, now, piece, span))


def _compare(
    motion: AxisMotion,
    now: tuple[Fraction, Fraction],
    piece: Along,
    span: tuple[Fraction, Fraction],
    error: _Error,
) -> None:
    for place, speed in _differences(motion, now, piece, span):
        error.update(place, speed)


def _after(
    now: tuple[Fraction, Fraction], time: Fraction, acceleration: Fraction, jerk: Fraction
) -> tuple[Fraction, Fraction]:
    place, speed = now
    faster = speed + time * (acceleration + time * jerk / 2)
    return place + time * (speed + time * (acceleration / 2 + time * jerk / 6)), faster


def _rounded(value: float, digits: int = DIGITS) -> Fraction:
    return Fraction(str(round(value, digits)))
