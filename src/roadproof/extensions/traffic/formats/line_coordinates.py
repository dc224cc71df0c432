"""Coordinates along a polyline in the plane, and motion in them.

On a line with the curvature κ, a point at s and d moves along the line's direction with the speed
s'·(1 - κ·d), and to its left with d'. Its acceleration along is s''·(1 - κ·d) - 2·κ·s'·d' - κ'·d·s'², and to
the left d'' + κ·(1 - κ·d)·s'², as the direction turns by κ·s' (κ' is the change of κ along the line).
"""

from dataclasses import dataclass, fields

import numpy as np

from roadproof.extensions.traffic.formats.recording import Floats, Integers

BLOCK = 10_000
"""Points that are projected at once, so that memory does not grow with a recording."""
AROUND = 6
"""Segments of a line before and after the vertex nearest to a point, among which it is projected."""
BEND = 12.5
"""m before and after a place, on which its curvature is an average: vertices are only so accurate."""
FLATTEST = 1e-6
"""1/m: less curvature is rounding, and the line is straight."""
NEAREST = 0.2
"""The least 1 - κ·d that motion is corrected with: near the centre of a bend it has no meaning."""


@dataclass(frozen=True)
class LineCoordinates:
    """Points in the coordinates of a line: s along it, d to its left (m), and its direction there (rad).

    ``stretch`` is how much longer a way of one metre is at the point than on the line, as a share: d times
    the curvature, positive on the outer side. ``turn`` is how much the line has turned up to there (rad),
    to both sides together. ``curvature`` is an average around the place, in 1/m, positive to the left, and
    ``curvature_rate`` its change along the line, in 1/m².
    """

    s: Floats
    d: Floats
    heading: Floats
    stretch: Floats
    turn: Floats
    curvature: Floats
    curvature_rate: Floats


def project(line: Floats, points: Floats) -> LineCoordinates:
    """Coordinates of ``points`` (n, 2) along the polyline ``line`` (m, 2), straight on beyond its ends.

    The direction of the line turns evenly from vertex to vertex (at a vertex it is that of the chord
    between its neighbours), and a point belongs to the nearest place that it is square to; so s, d and
    heading have no jumps at the kinks of the line (Héry, Xu, Bonnifait: *Map-based curvilinear coordinates
    for autonomous vehicles*, IV 2017).
    """
    blocks = [_project(line, points[k : k + BLOCK]) for k in range(0, max(1, len(points)), BLOCK)]
    return LineCoordinates(
        *(np.concatenate([getattr(block, x.name) for block in blocks]) for x in fields(LineCoordinates))
    )


def _project(line: Floats, points: Floats) -> LineCoordinates:
    step = np.diff(line, axis=0)
    length = np.hypot(step[:, 0], step[:, 1])
    unit = step / length[:, None]
    direction = np.concatenate((unit[:1], line[2:] - line[:-2], unit[-1:]))
    direction /= np.hypot(direction[:, 0], direction[:, 1])[:, None]
    turn = np.diff(direction, axis=0)
    near = _near(line, points)
    offset = points[:, None, :] - line[near]
    share = _square_to(offset, step[near], direction[near], turn[near])
    straight = (offset * unit[near]).sum(axis=2) / length[near]
    first, last = near == 0, near == len(length) - 1
    share = np.where(first, np.where(straight < 0, straight, np.maximum(share, 0)), share)
    share = np.where(last, np.where(straight > 1, straight, np.minimum(share, 1)), share)
    clipped = np.clip(share, np.where(first, -np.inf, 0), np.where(last, np.inf, 1))
    beyond = np.abs(share - clipped) * length[near]
    away = offset - clipped[:, :, None] * step[near]
    # A vertex may be nearer than the place beside it that the point is square to.
    best = np.argmin(np.hypot(away[:, :, 0], away[:, :, 1]) + beyond, axis=1)
    rows = np.arange(len(points))
    nearest, on, off = near[rows, best], clipped[rows, best], away[rows, best]
    ahead = direction[nearest] + np.clip(on, 0, 1)[:, None] * turn[nearest]
    ahead /= np.hypot(ahead[:, 0], ahead[:, 1])[:, None]
    d = ahead[:, 0] * off[:, 1] - ahead[:, 1] * off[:, 0]
    begin = np.concatenate(([0.0], np.cumsum(length)[:-1]))
    angle = unit[:, 0] * turn[:, 1] - unit[:, 1] * turn[:, 0]
    turned = np.concatenate(([0.0], np.cumsum(np.abs(angle))))
    s = begin[nearest] + on * length[nearest]
    curvature, curvature_rate = _bend(np.append(begin, length.sum()), np.append(0.0, np.cumsum(angle)), s)
    return LineCoordinates(
        s,
        d,
        np.arctan2(ahead[:, 1], ahead[:, 0]),
        np.where((on >= 0) & (on <= 1), -d * (angle / length)[nearest], 0.0),
        turned[nearest] + np.clip(on, 0, 1) * np.abs(angle)[nearest],
        curvature,
        curvature_rate,
    )


def _near(line: Floats, points: Floats) -> Integers:
    """Return for each point the segments (n, k) around the nearest vertex, or all segments where they are
    few.
    """
    segments = len(line) - 1
    if segments <= 2 * AROUND:
        return np.broadcast_to(np.arange(segments), (len(points), segments))
    middle = line.mean(axis=0)
    vertices = line - middle
    square = (vertices**2).sum(axis=1) - 2 * (points - middle) @ vertices.T
    first = np.clip(np.argmin(square, axis=1) - AROUND, 0, segments - 2 * AROUND)
    chosen: Integers = first[:, None] + np.arange(2 * AROUND)
    return chosen


def _square_to(offset: Floats, step: Floats, direction: Floats, turn: Floats) -> Floats:
    """Return where on each segment, from 0 to 1, the line's direction is square to the way to each point.

    That is (offset - x·step)·(direction + x·turn) = 0, of whose two solutions the one is taken that is there
    for straight segments too.
    """
    constant = (offset * direction).sum(axis=2)
    linear = (offset * turn).sum(axis=2) - (step * direction).sum(axis=2)
    square = -(step * turn).sum(axis=2)
    root = np.sqrt(np.maximum(linear**2 - 4 * square * constant, 0))
    below = root - linear
    share: Floats = np.divide(2 * constant, below, out=np.full_like(constant, np.inf), where=below > 0)
    return share


def _bend(way: Floats, turned: Floats, s: Floats) -> tuple[Floats, Floats]:
    """Curvature at ``s`` and its change, by how far (rad) the line has ``turned`` at the places ``way``.

    Both are 0 beyond the ends of the line.
    """

    def between(low: Floats, high: Floats) -> Floats:
        low, high = np.clip(low, 0, way[-1]), np.clip(high, 0, way[-1])
        turn = np.interp(high, way, turned) - np.interp(low, way, turned)
        curvature: Floats = np.divide(turn, high - low, out=np.zeros_like(s), where=high > low)
        return np.where(np.abs(curvature) < FLATTEST, 0.0, curvature)

    outside = (s < 0) | (s > way[-1])
    change = (between(s, s + 2 * BEND) - between(s - 2 * BEND, s)) / (2 * BEND)
    inner = (s >= 2 * BEND) & (s <= way[-1] - 2 * BEND)
    return np.where(outside, 0.0, between(s - BEND, s + BEND)), np.where(inner, change, 0.0)


@dataclass(frozen=True)
class LineMotion:
    """Rates of s and d: speeds (m/s) and accelerations (m/s²) along the line and to its left."""

    v_lon: Floats
    v_lat: Floats
    a_lon: Floats
    a_lat: Floats


def motion_along(
    line: LineCoordinates, velocity: Floats, acceleration: Floats, boxes: Floats | None = None
) -> LineMotion:
    """Motion in the coordinates of a line, from ``velocity`` and ``acceleration`` in the plane (n, 2).

    ``boxes``: directions (rad) of boxes whose ``acceleration`` lacks what their turning adds to it, which
    is the speed along the box times its yaw rate, to its left. Boxes turn as the line does.
    """
    along, v_lat = _turned(velocity, line.heading)
    pull, push = _turned(acceleration, line.heading)
    factor = np.maximum(1 - line.curvature * line.d, NEAREST)
    v_lon = along / factor
    yaw = line.curvature * v_lon
    if boxes is not None:
        forward, _ = _turned(velocity, boxes)
        pull = pull - forward * yaw * np.sin(boxes - line.heading)
        push = push + forward * yaw * np.cos(boxes - line.heading)
    a_lon = (pull + 2 * yaw * v_lat + line.curvature_rate * line.d * v_lon**2) / factor
    bent = (line.curvature != 0) | (line.curvature_rate != 0)
    return LineMotion(v_lon, v_lat, np.where(bent, a_lon, pull), np.where(bent, push - along * yaw, push))


def _turned(vectors: Floats, heading: Floats) -> tuple[Floats, Floats]:
    """Vectors (n, 2) along directions, and to their left."""
    along, across = np.cos(heading), np.sin(heading)
    x, y = vectors[:, 0], vectors[:, 1]
    return x * along + y * across, y * along - x * across
