"""Plane geometry of curved roads: coordinates along a line, and boxes over lanelets."""

from dataclasses import dataclass

import numpy as np

from roadproof.traffic.recording import Bools, Floats


@dataclass(frozen=True)
class Along:
    """Points in the coordinates of a line: s along it, d to its left (m), and its direction there (rad)."""

    s: Floats
    d: Floats
    heading: Floats


def project(line: Floats, points: Floats) -> Along:
    """Coordinates of ``points`` (n, 2) along the polyline ``line`` (m, 2), straight on beyond its ends.

    Each point belongs to the nearest segment.
    """
    step = np.diff(line, axis=0)
    length = np.hypot(step[:, 0], step[:, 1])
    unit = step / length[:, None]
    begin = np.concatenate(([0.0], np.cumsum(length)[:-1]))
    offset = points[:, None, :] - line[None, :-1, :]
    along = (offset * unit).sum(axis=2)
    low, high = np.zeros(len(length)), length.copy()
    low[0], high[-1] = -np.inf, np.inf
    foot = np.clip(along, low, high)
    across = unit[:, 0] * offset[:, :, 1] - unit[:, 1] * offset[:, :, 0]
    distance = np.hypot(along - foot, across)
    nearest = np.argmin(distance, axis=1)
    rows = np.arange(len(points))
    angle = np.arctan2(unit[:, 1], unit[:, 0])
    side = np.where(across[rows, nearest] < 0, -1.0, 1.0)
    return Along(
        begin[nearest] + foot[rows, nearest],
        side * distance[rows, nearest],
        angle[nearest],
    )


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
