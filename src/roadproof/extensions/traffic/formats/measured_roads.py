"""Traffic in the plane, on measured lanelets, as a recording in the coordinates of its road.

s and d run along the main way of a carriageway (``topology.main_way``). Occupancy is decided in the plane,
on the box as it is turned; s, d, v_lon and v_lat treat the box as aligned with the road, and
``Recording.slack`` says how far that is off.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from roadproof.extensions.maps.lines import even_line, joined
from roadproof.extensions.maps.network import Network
from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.lanelets import with_used_lanes
from roadproof.extensions.traffic.formats.line_coordinates import (
    BLOCK,
    LineCoordinates,
    motion_along,
    project,
)
from roadproof.extensions.traffic.formats.recording import (
    ZONES,
    Bools,
    Floats,
    Integers,
    Lane,
    Masks,
    Recording,
    Slack,
)
from roadproof.world.road import Lanelet


def boxes_of(centre: Floats, heading: Floats, length: Floats, width: Floats) -> Floats:
    """Corners (n, 4, 2) of boxes, in order around."""
    forward = np.stack((np.cos(heading), np.sin(heading)), axis=1)
    left = np.stack((-np.sin(heading), np.cos(heading)), axis=1)
    ahead, aside = forward * (length / 2)[:, None], left * (width / 2)[:, None]
    around = (ahead + aside, ahead - aside, -ahead - aside, aside - ahead)
    return np.stack([centre + x for x in around], axis=1)


def triangles_of(left: Floats, right: Floats) -> Floats:
    """A strip between two polylines with equally many points, cut into triangles (n, 3, 2) with an area."""
    upper = np.stack((left[:-1], right[:-1], left[1:]), axis=1)
    lower = np.stack((right[:-1], right[1:], left[1:]), axis=1)
    made = np.concatenate((upper, lower))
    one, other = made[:, 1] - made[:, 0], made[:, 2] - made[:, 0]
    flat: Bools = one[:, 0] * other[:, 1] == one[:, 1] * other[:, 0]
    return made[~flat]


def overlap(boxes: Floats, triangles: Floats) -> Bools:
    """Return for each box (n, 4, 2) whether it overlaps any triangle (m, 3, 2) with positive area.

    Two convex figures overlap with positive area unless some edge of either is along a line that
    separates their interiors.
    """
    overlapping = np.zeros(len(boxes), bool)
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    begin, end = boxes.min(axis=1), boxes.max(axis=1)
    near = np.flatnonzero(((low.min(axis=0) < end) & (high.max(axis=0) > begin)).all(axis=1))
    for k in range(0, len(near), BLOCK):
        block = near[k : k + BLOCK]
        one, other = np.nonzero(_within(begin[block], end[block], low, high))
        meet = ~_separated(boxes[block[one]], triangles[other])
        overlapping[block[one[meet]]] = True
    return overlapping


def _separated(boxes: Floats, triangles: Floats) -> Bools:
    """Return for each box (n, 4, 2) and triangle (n, 3, 2) whether an edge of either separates the two."""
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
    """Return for each point (n, 2) whether some triangle (m, 3, 2) contains it, edges included."""
    contained = np.zeros(len(points), bool)
    low, high = triangles.min(axis=1), triangles.max(axis=1)
    edges = np.roll(triangles, -1, axis=1) - triangles
    for k in range(0, len(points), BLOCK):
        block = points[k : k + BLOCK]
        one, other = np.nonzero(_within(block, block, low, high))
        offset = block[one, None, :] - triangles[other]
        turn = edges[other][..., 0] * offset[..., 1] - edges[other][..., 1] * offset[..., 0]
        each = np.logical_and.reduce(turn >= 0, axis=1) | np.logical_and.reduce(turn <= 0, axis=1)
        contained[k + one[each]] = True
    return contained


def _within(begin: Floats, end: Floats, low: Floats, high: Floats) -> Bools:
    """Return which of some boxes [begin, end] (n, 2) and [low, high] (m, 2) along the axes meet, (n, m)."""
    meet: Bools = (low[:, 0] <= end[:, :1]) & (high[:, 0] >= begin[:, :1])
    meet &= (low[:, 1] <= end[:, 1:]) & (high[:, 1] >= begin[:, 1:])
    return meet


MOST_TURNED = math.radians(45)
"""Beyond that a vehicle does not drive along the road."""


@dataclass(frozen=True)
class MeasuredTraffic:
    """Vehicles in the plane. Per vehicle and per sample as in ``Recording``, but for these.

    ``centre`` of the box (n, 2) in m, ``heading`` of the box (rad), ``velocity`` and ``acceleration`` (n, 2).
    ``acceleration_turns``: whether the acceleration has the part across that is due to the vehicle's turning.
    """

    name: str
    rate: Rate
    vehicle_id: Integers
    kind: npt.NDArray[np.str_]
    length: Floats
    width: Floats
    first_frame: Integers
    start: Integers
    centre: Floats
    heading: Floats
    velocity: Floats
    acceleration: Floats
    acceleration_turns: bool = True
    notes: tuple[str, ...] = ()
    moments: Integers = field(default_factory=lambda: np.zeros(0, np.int64))
    label: npt.NDArray[np.str_] = field(default_factory=lambda: np.zeros(0, np.str_))


_IN_PLANE = ("centre", "heading", "velocity", "acceleration", "acceleration_turns", "notes")


def place_traffic(traffic: MeasuredTraffic, network: Network) -> Recording:
    """The recording of ``traffic`` on ``network``; ``notes`` tell what was inferred and what is off.

    Of more than 32 lanes those remain that some vehicle is in. Raises ``InputError`` where these are more.
    """
    counts = np.diff(traffic.start)
    length, width = (np.repeat(x, counts) for x in (traffic.length, traffic.width))
    boxes = boxes_of(traffic.centre, traffic.heading, length, width)
    network, unused = with_used_lanes(
        network, lambda x: bool(overlap(boxes, triangles_of(x.left, x.right)).any()), traffic.name
    )
    inside_of, occupancy, lane, zones = _occupy(network, boxes, traffic.centre)
    direction = _carriageway(network, occupancy, traffic.start)
    along = _along_main_ways(network, traffic.centre, np.repeat(direction, counts))
    corners = _along_main_ways(network, boxes.reshape(-1, 2), np.repeat(direction, counts * 4))
    s, d = along.s + length / 2, along.d + width / 2
    slack = _slack(along, corners, traffic.heading, s, d, length, width)
    boxes_without_turn = None if traffic.acceleration_turns else traffic.heading
    motion = motion_along(along, traffic.velocity, traffic.acceleration, boxes_without_turn)
    notes = (
        *traffic.notes,
        *network.notes,
        *unused,
        *_say_off(along, slack, traffic.start, traffic.vehicle_id),
    )
    return Recording(
        **{name: value for name, value in vars(traffic).items() if name not in _IN_PLANE},
        lanes=tuple(Lane(x.name, x.carriageway) for x in network.lanes),
        beside=network.beside,
        direction=direction,
        s=s,
        d=d,
        **vars(motion),
        occupancy=occupancy,
        lane=lane,
        zones=zones,
        notes=notes,
        lanelets=tuple(_lanelets(network)),
        inside=inside_of,
        slack=slack,
    )


def _lanelets(network: Network) -> Iterator[Lanelet]:
    """Yield the lanelets in the order of their lanes; their bounds only tell them apart."""
    ordered = ((lane.name, name) for lane in network.lanes for name in lane.lanelets)
    for k, (lane, name) in enumerate(ordered):
        band = (Fraction(k), Fraction(k + 1))
        yield Lanelet(name, lane, network.zones[name], network.attributes[name], (None, None), band)


def _along_main_ways(network: Network, points: Floats, direction: Integers) -> LineCoordinates:
    """Return the coordinates of each point along the main way of its carriageway."""
    made = LineCoordinates(*(np.zeros(len(points)) for _ in fields(LineCoordinates)))
    for way, chain in enumerate(network.main, start=1):
        ours = np.flatnonzero(direction == way)
        if len(ours):
            coordinates = project(
                even_line(joined([network.lanelets[x].centre for x in chain])), points[ours]
            )
            for name, values in vars(coordinates).items():
                getattr(made, name)[ours] = values
    return made


def _slack(
    along: LineCoordinates,
    corners: LineCoordinates,
    heading: Floats,
    s: Floats,
    d: Floats,
    length: Floats,
    width: Floats,
) -> Slack:
    """Return how far the projected corners of the boxes are from aligned boxes."""
    far, left = corners.s.reshape(-1, 4), corners.d.reshape(-1, 4)
    ends = np.maximum(np.abs(far.max(axis=1) - s), np.abs(far.min(axis=1) - (s - length)))
    sides = np.maximum(np.abs(left.max(axis=1) - d), np.abs(left.min(axis=1) - (d - width)))
    beside = np.abs(np.remainder(heading - along.heading + math.pi, math.tau) - math.pi) > MOST_TURNED
    return Slack(
        np.where(beside, np.inf, ends), np.where(beside, np.inf, sides), along.turn, np.abs(left).max(axis=1)
    )


def _say_off(along: LineCoordinates, slack: Slack, start: Integers, ids: Integers) -> Iterator[str]:
    """Return how far lengths and places along the reference line are from those in the plane."""
    each = np.add.reduceat(along.stretch, start[:-1]) / np.diff(start)
    worst = int(np.argmax(np.abs(each)))
    yield (
        f"lengths along the reference line are off by {100 * np.abs(each).mean():.1f} % on average, by "
        f"{100 * abs(each[worst]):.1f} % on the way of obstacle {ids[worst]}, by up to "
        f"{100 * np.abs(along.stretch).max():.1f} % in a bend"
    )
    straying = int(np.count_nonzero(~np.isfinite(slack.along)))
    if straying:
        yield f"{straying} of {len(slack.along)} samples head more than 45 degrees away from the road"
    if straying < len(slack.along):
        ends, sides = (x[np.isfinite(x)] for x in (slack.along, slack.across))
        yield (
            f"boxes as they are turned end up to {ends.max():.2f} m (in the median {np.median(ends):.2f} m) "
            f"from boxes along the road, to their sides up to {sides.max():.2f} m ({np.median(sides):.2f} m)"
        )


def _occupy(network: Network, boxes: Floats, centre: Floats) -> tuple[Bools, Masks, Integers, Masks]:
    """Return for each sample its lanelets and lanes, the lane of its centre, and its zones."""
    occupancy, zones = np.zeros(len(boxes), np.uint32), np.zeros(len(boxes), np.uint32)
    lane = np.full(len(boxes), -1, np.int64)
    inside_of = np.zeros((len(boxes), sum(len(x.lanelets) for x in network.lanes)), np.bool_)
    column = 0
    for k, measured in enumerate(network.lanes):
        for name in measured.lanelets:
            triangles = triangles_of(network.lanelets[name].left, network.lanelets[name].right)
            here = overlap(boxes, triangles)
            inside_of[:, column] = here
            column += 1
            occupancy[here] |= np.uint32(1 << k)
            zones[here] |= np.uint32(1 << ZONES.index(network.zones[name]))
            near = np.flatnonzero(here & (lane < 0))
            lane[near[inside(centre[near], triangles)]] = k
    return inside_of, occupancy, lane, zones


def _carriageway(network: Network, occupancy: Masks, start: Integers) -> Integers:
    """Return where each vehicle is most often; the first carriageway for one that is nowhere."""
    ways = range(1, len(network.main) + 1)
    masks = [sum(1 << k for k, x in enumerate(network.lanes) if x.carriageway == way) for way in ways]
    often = [np.add.reduceat((occupancy & np.uint32(m) != 0).astype(np.int64), start[:-1]) for m in masks]
    chosen: Integers = np.array(ways)[np.argmax(often, axis=0)]
    return chosen
