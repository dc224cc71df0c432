"""Plane geometry of curved roads: coordinates along a line, and boxes over lanelets."""

from dataclasses import dataclass

import numpy as np

from roadproof.traffic.recording import Bools, Floats


@dataclass(frozen=True)
class Along:
    """Points in the coordinates of a line: s along it, d to its left (m), and its direction there (rad).

    ``stretch`` is how much longer a way of one metre is at the point than on the line, as a share: d times
    the curvature, positive on the outer side.
    """

    s: Floats
    d: Floats
    heading: Floats
    stretch: Floats


def even_line(line: Floats, step: float = 5.0) -> Floats:
    """The polyline (m, 2) with vertices about ``step`` metres apart, so that its kinks are those of the road.

    Lanelets have vertices centimetres apart, whose rounded coordinates turn the line by a degree and back.
    """
    way = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
    at = np.linspace(0, way[-1], 1 + max(1, round(float(way[-1]) / step)))
    return np.stack((np.interp(at, way, line[:, 0]), np.interp(at, way, line[:, 1])), axis=1)


def project(line: Floats, points: Floats) -> Along:
    """Coordinates of ``points`` (n, 2) along the polyline ``line`` (m, 2), straight on beyond its ends.

    The direction of the line turns evenly from vertex to vertex (at a vertex it is that of the chord
    between its neighbours), and a point belongs to the nearest place that it is square to; so s, d and
    heading have no jumps at the kinks of the line (Héry, Xu, Bonnifait: *Map-based curvilinear coordinates
    for autonomous vehicles*, IV 2017).
    """
    step = np.diff(line, axis=0)
    length = np.hypot(step[:, 0], step[:, 1])
    unit = step / length[:, None]
    direction = np.concatenate((unit[:1], line[2:] - line[:-2], unit[-1:]))
    direction /= np.hypot(direction[:, 0], direction[:, 1])[:, None]
    turn = np.diff(direction, axis=0)
    offset = points[:, None, :] - line[None, :-1, :]
    share = _square_to(offset, step, direction[:-1], turn)
    straight = (offset * unit).sum(axis=2) / length
    share[:, 0] = np.where(straight[:, 0] < 0, straight[:, 0], np.maximum(share[:, 0], 0))
    share[:, -1] = np.where(straight[:, -1] > 1, straight[:, -1], np.minimum(share[:, -1], 1))
    low, high = np.zeros(len(length)), np.ones(len(length))
    low[0], high[-1] = -np.inf, np.inf
    beyond = np.abs(share - np.clip(share, low, high)) * length
    share = np.clip(share, low, high)
    away = offset - share[:, :, None] * step
    # A vertex may be nearer than the place beside it that the point is square to.
    nearest = np.argmin(np.hypot(away[:, :, 0], away[:, :, 1]) + beyond, axis=1)
    rows = np.arange(len(points))
    on, off = share[rows, nearest], away[rows, nearest]
    ahead = direction[nearest] + np.clip(on, 0, 1)[:, None] * turn[nearest]
    ahead /= np.hypot(ahead[:, 0], ahead[:, 1])[:, None]
    d = ahead[:, 0] * off[:, 1] - ahead[:, 1] * off[:, 0]
    begin = np.concatenate(([0.0], np.cumsum(length)[:-1]))
    inside = (on >= 0) & (on <= 1)
    angle = unit[:, 0] * turn[:, 1] - unit[:, 1] * turn[:, 0]
    return Along(
        begin[nearest] + on * length[nearest],
        d,
        np.arctan2(ahead[:, 1], ahead[:, 0]),
        np.where(inside, -d * (angle / length)[nearest], 0.0),
    )


def _square_to(offset: Floats, step: Floats, direction: Floats, turn: Floats) -> Floats:
    """Where on each segment, from 0 to 1, the line's direction is square to the way to each point.

    That is (offset - x·step)·(direction + x·turn) = 0, of whose two solutions the one is taken that is there
    for straight segments too.
    """
    constant = (offset * direction).sum(axis=2)
    linear = (offset * turn).sum(axis=2) - (step * direction).sum(axis=1)
    square = -(step * turn).sum(axis=1)
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
    for k, box in enumerate(boxes):
        close = ((low < box.max(axis=0)) & (high > box.min(axis=0))).all(axis=1)
        if close.any():
            found[k] = bool((~_separated(box, triangles[close])).any())
    return found


def _separated(box: Floats, triangles: Floats) -> Bools:
    """For each triangle whether an edge of it or of the box separates the two."""
    box_edges = np.diff(box[[0, 1, 2]], axis=0)  # opposite edges are parallel
    edges = np.concatenate(
        (
            np.broadcast_to(box_edges, (len(triangles), 2, 2)),
            triangles[:, [1, 2, 0]] - triangles,
        ),
        axis=1,
    )
    normal = np.stack((-edges[:, :, 1], edges[:, :, 0]), axis=2)
    ours = np.einsum("tac,bc->tab", normal, box)
    theirs = np.einsum("tac,tpc->tap", normal, triangles)
    apart = (ours.max(axis=2) <= theirs.min(axis=2)) | (theirs.max(axis=2) <= ours.min(axis=2))
    separated: Bools = np.logical_or.reduce(apart, axis=1)
    return separated


def inside(points: Floats, triangles: Floats) -> Bools:
    """For each point (n, 2) whether some triangle (m, 3, 2) holds it, its edges included."""
    corner = triangles[None]
    edge = np.roll(triangles, -1, axis=1)[None] - corner
    offset = points[:, None, None, :] - corner
    turn = edge[..., 0] * offset[..., 1] - edge[..., 1] * offset[..., 0]
    each = np.logical_and.reduce(turn >= 0, axis=2) | np.logical_and.reduce(turn <= 0, axis=2)
    held: Bools = np.logical_or.reduce(each, axis=1)
    return held
