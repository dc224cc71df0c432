"""Traffic in the plane, on measured lanelets, as a recording in the coordinates of its road.

s and d run along the main way of a carriageway (``topology.main_way``). Occupancy is decided in the plane,
on the box as it is turned; s, d, v_lon and v_lat treat the box as aligned with the road, and
``Recording.slack`` says how far that is off.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from roadproof.recordings.formats.lanelets import Network
from roadproof.recordings.formats.projection import (
    LineCoordinates,
    boxes_of,
    even_line,
    inside,
    overlap,
    project,
    triangles_of,
)
from roadproof.recordings.formats.recording import (
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

MOST_TURNED = math.radians(45)
"""Beyond that a vehicle does not drive along the road."""


@dataclass(frozen=True)
class MeasuredTraffic:
    """Vehicles in the plane. Per vehicle and per sample as in ``Recording``, but for these.

    ``centre`` of the box (n, 2) in m, ``heading`` of the box (rad), ``velocity`` and ``acceleration`` (n, 2).
    """

    name: str
    rate: int
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
    notes: tuple[str, ...] = ()
    moments: Integers = field(default_factory=lambda: np.zeros(0, np.int64))
    label: npt.NDArray[np.str_] = field(default_factory=lambda: np.zeros(0, np.str_))


def place_traffic(traffic: MeasuredTraffic, network: Network) -> Recording:
    """The recording of ``traffic`` on ``network``; ``notes`` tell what was inferred and what is off."""
    counts = np.diff(traffic.start)
    length, width = (np.repeat(x, counts) for x in (traffic.length, traffic.width))
    boxes = boxes_of(traffic.centre, traffic.heading, length, width)
    inside_of, occupancy, lane, zones = _occupy(network, boxes, traffic.centre)
    direction = _carriageway(network, occupancy, traffic.start)
    along = _project(network, traffic.centre, np.repeat(direction, counts))
    corners = _project(network, boxes.reshape(-1, 2), np.repeat(direction, counts * 4))
    s, d = along.s + length / 2, along.d + width / 2
    slack = _slack(along, corners, traffic.heading, s, d, length, width)
    v_lon, v_lat = _turned(traffic.velocity, along.heading)
    a_lon, a_lat = _turned(traffic.acceleration, along.heading)
    told = (*network.notes, *_say_off(along, slack, traffic.start, traffic.vehicle_id))
    return Recording(
        name=traffic.name,
        rate=traffic.rate,
        lanes=tuple(Lane(x.name, x.carriageway) for x in network.lanes),
        beside=network.beside,
        vehicle_id=traffic.vehicle_id,
        direction=direction,
        kind=traffic.kind,
        label=traffic.label,
        length=traffic.length,
        width=traffic.width,
        first_frame=traffic.first_frame,
        start=traffic.start,
        s=s,
        d=d,
        v_lon=v_lon,
        v_lat=v_lat,
        a_lon=a_lon,
        a_lat=a_lat,
        occupancy=occupancy,
        lane=lane,
        zones=zones,
        notes=(*traffic.notes, *told),
        moments=traffic.moments,
        lanelets=tuple(_lanelets(network)),
        inside=inside_of,
        slack=slack,
    )


def _lanelets(network: Network) -> Iterator[Lanelet]:
    """In the order of their lanes; bounds that only tell them apart stand for theirs."""
    ordered = ((lane.name, name) for lane in network.lanes for name in lane.lanelets)
    for k, (lane, name) in enumerate(ordered):
        band = (Fraction(k), Fraction(k + 1))
        yield Lanelet(name, lane, network.zones[name], network.attributes[name], (None, None), band)


def _project(network: Network, points: Floats, direction: Integers) -> LineCoordinates:
    """Each point along the main way of its carriageway."""
    made = LineCoordinates(*(np.zeros(len(points)) for _ in range(5)))
    for way, chain in enumerate(network.main, start=1):
        ours = np.flatnonzero(direction == way)
        if len(ours):
            found = project(even_line(_centre_line(network, chain)), points[ours])
            for name, values in vars(found).items():
                getattr(made, name)[ours] = values
    return made


def _centre_line(network: Network, chain: tuple[str, ...]) -> Floats:
    points = np.concatenate([network.lanelets[x].centre for x in chain])
    apart = np.concatenate(([True], np.hypot(*np.diff(points, axis=0).T) > 1e-3))
    line: Floats = points[apart]
    return line


def _slack(
    along: LineCoordinates,
    corners: LineCoordinates,
    heading: Floats,
    s: Floats,
    d: Floats,
    length: Floats,
    width: Floats,
) -> Slack:
    """What the corners of the boxes, projected themselves, say against aligned boxes."""
    far, left = corners.s.reshape(-1, 4), corners.d.reshape(-1, 4)
    ends = np.maximum(np.abs(far.max(axis=1) - s), np.abs(far.min(axis=1) - (s - length)))
    sides = np.maximum(np.abs(left.max(axis=1) - d), np.abs(left.min(axis=1) - (d - width)))
    beside = np.abs(np.remainder(heading - along.heading + math.pi, math.tau) - math.pi) > MOST_TURNED
    return Slack(
        np.where(beside, np.inf, ends),
        np.where(beside, np.inf, sides),
        along.turn,
        np.abs(left).max(axis=1),
    )


def _turned(vectors: Floats, heading: Floats) -> tuple[Floats, Floats]:
    """Vectors (n, 2) along directions, and to their left."""
    along, across = np.cos(heading), np.sin(heading)
    x, y = vectors[:, 0], vectors[:, 1]
    return x * along + y * across, y * along - x * across


def _say_off(along: LineCoordinates, slack: Slack, start: Integers, ids: Integers) -> Iterator[str]:
    """How far lengths and places along the reference line are from those in the plane."""
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
    """For each sample the lanelets and lanes it is in, the lane of its centre, and its zones."""
    occupancy, zones = np.zeros(len(boxes), np.uint32), np.zeros(len(boxes), np.uint32)
    lane = np.full(len(boxes), -1, np.int64)
    inside_of = np.zeros((len(boxes), len(network.lanelets)), np.bool_)
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
    """Where each vehicle is most often; the first carriageway for one that is nowhere."""
    ways = range(1, len(network.main) + 1)
    masks = [sum(1 << k for k, x in enumerate(network.lanes) if x.carriageway == way) for way in ways]
    often = [np.add.reduceat((occupancy & np.uint32(m) != 0).astype(np.int64), start[:-1]) for m in masks]
    chosen: Integers = np.array(ways)[np.argmax(often, axis=0)]
    return chosen
