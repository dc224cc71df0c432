"""Plane geometry of curved roads: coordinates along a line, and boxes over lanelets."""

from dataclasses import dataclass, fields

import numpy as np

from roadproof.recordings.formats.recording import Bools, Floats, Integers

BLOCK = 10_000
"""Points that are projected at once, so that memory does not grow with a recording."""
AROUND = 6
"""Segments of a line before and after the vertex nearest to a point, among which it is projected."""


@dataclass(frozen=True)
class LineCoordinates:
    """Points in the coordinates of a line: s along it, d to its left (m), and its direction there (rad).

    ``stretch`` is how much longer a way of one metre is at the point than on the line, as a share: d times
    the curvature, positive on the outer side. ``turn`` is how much the line has turned up to there (rad),
    to both sides together.
    """

    s: Floats
    d: Floats
    heading: Floats
    stretch: Floats
    turn: Floats


def even_line(line: Floats, step: float = 5.0) -> Floats:
    """The polyline (m, 2) with vertices about ``step`` metres apart, so that its kinks are those of the road.

    Lanelets have vertices centimetres apart, whose rounded coordinates turn the line by a degree and back.
    """
    way = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    at = np.linspace(0, way[-1], 1 + max(1, round(float(way[-1]) / step)))
    return np.stack((np.interp(at, way, line[:, 0]), np.interp(at, way, line[:, 1])), axis=1)


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
    held = np.clip(share, np.where(first, -np.inf, 0), np.where(last, np.inf, 1))
    beyond = np.abs(share - held) * length[near]
    away = offset - held[:, :, None] * step[near]
    # A vertex may be nearer than the place beside it that the point is square to.
    best = np.argmin(np.hypot(away[:, :, 0], away[:, :, 1]) + beyond, axis=1)
    rows = np.arange(len(points))
    nearest, on, off = near[rows, best], held[rows, best], away[rows, best]
    ahead = direction[nearest] + np.clip(on, 0, 1)[:, None] * turn[nearest]
    ahead /= np.hypot(ahead[:, 0], ahead[:, 1])[:, None]
    d = ahead[:, 0] * off[:, 1] - ahead[:, 1] * off[:, 0]
    begin = np.concatenate(([0.0], np.cumsum(length)[:-1]))
    angle = unit[:, 0] * turn[:, 1] - unit[:, 1] * turn[:, 0]
    turned = np.concatenate(([0.0], np.cumsum(np.abs(angle))))
    return LineCoordinates(
        begin[nearest] + on * length[nearest],
        d,
        np.arctan2(ahead[:, 1], ahead[:, 0]),
        np.where((on >= 0) & (on <= 1), -d * (angle / length)[nearest], 0.0),
        turned[nearest] + np.clip(on, 0, 1) * np.abs(angle)[nearest],
    )


def _near(line: Floats, points: Floats) -> Integers:
    """For each point the segments (n, k) around the vertex that is nearest, or all where they are few."""
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
    """Where on each segment, from 0 to 1, the line's direction is square to the way to each point.

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


def boxes_of(centre: Floats, heading: Floats, length: Floats, width: Floats) -> Floats:
    """Corners (n, 4, 2) of boxes, in order around."""
    forward = np.stack((np.cos(heading), np.sin(heading)), axis=1)
    left = np.stack((-np.sin(heading), np.cos(heading)), axis=1)
    ahead, aside = forward * (length / 2)[:, None], left * (width / 2)[:, None]
    around = (ahead + aside, ahead - aside, -ahead - aside, aside - ahead)
    corners: Floats = np.stack([centre + x for x in around], axis=1)
    return corners


def triangles_of(left: Floats, right: Floats) -> Floats:
    """A strip between two polylines with equally many points, cut into triangles (n, 3, 2) with an area."""
    upper = np.stack((left[:-1], right[:-1], left[1:]), axis=1)
    lower = np.stack((right[:-1], right[1:], left[1:]), axis=1)
    made = np.concatenate((upper, lower))
    one, other = made[:, 1] - made[:, 0], made[:, 2] - made[:, 0]
    flat: Bools = one[:, 0] * other[:, 1] == one[:, 1] * other[:, 0]
    return made[~flat]


def overlap(boxes: Floats, triangles: Floats) -> Bools:
    """For each box (n, 4, 2) whether it overlaps any triangle (m, 3, 2) with positive area; touching is none.

    Two convex figures overlap with positive area unless some edge of either is along a line that
    separates their interiors.
    """
    found = np.zeros(len(boxes), bool)
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    begin, end = boxes.min(axis=1), boxes.max(axis=1)
    near = np.flatnonzero(((low.min(axis=0) < end) & (high.max(axis=0) > begin)).all(axis=1))
    for k in range(0, len(near), BLOCK):
        block = near[k : k + BLOCK]
        one, other = np.nonzero(_within(begin[block], end[block], low, high))
        meet = ~_separated(boxes[block[one]], triangles[other])
        found[block[one[meet]]] = True
    return found


def _separated(boxes: Floats, triangles: Floats) -> Bools:
    """For each box (n, 4, 2) and triangle (n, 3, 2) whether an edge of either separates the two."""
    # Opposite edges of a box are parallel.
    edges = np.concatenate(
        (np.diff(boxes[:, :3], axis=1), np.roll(triangles, -1, axis=1) - triangles), axis=1
    )
    normal = np.stack((-edges[:, :, 1], edges[:, :, 0]), axis=2)
    ours = np.einsum("nac,nbc->nab", normal, boxes)
    theirs = np.einsum("nac,npc->nap", normal, triangles)
    apart = (ours.max(axis=2) <= theirs.min(axis=2)) | (theirs.max(axis=2) <= ours.min(axis=2))
    separated: Bools = np.logical_or.reduce(apart, axis=1)
    return separated


def inside(points: Floats, triangles: Floats) -> Bools:
    """For each point (n, 2) whether some triangle (m, 3, 2) holds it, its edges included."""
    held = np.zeros(len(points), bool)
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    edges = np.roll(triangles, -1, axis=1) - triangles
    for k in range(0, len(points), BLOCK):
        block = points[k : k + BLOCK]
        one, other = np.nonzero(_within(block, block, low, high))
        offset = block[one, None, :] - triangles[other]
        turn = edges[other][..., 0] * offset[..., 1] - edges[other][..., 1] * offset[..., 0]
        each = np.logical_and.reduce(turn >= 0, axis=1) | np.logical_and.reduce(turn <= 0, axis=1)
        held[k + one[each]] = True
    return held


def _within(begin: Floats, end: Floats, low: Floats, high: Floats) -> Bools:
    """Which of some boxes [begin, end] (n, 2) and [low, high] (m, 2) along the axes meet, (n, m)."""
    meet: Bools = (low[:, 0] <= end[:, :1]) & (high[:, 0] >= begin[:, :1])
    meet &= (low[:, 1] <= end[:, 1:]) & (high[:, 1] >= begin[:, 1:])
    return meet
