"""Recordings on straight roads put into the plane: CommonRoad files, along any line."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from roadproof.extensions.traffic.formats.recording import Floats, Recording
from roadproof.world.road import Lanelet, Road

Bend = Callable[[Floats, Floats], tuple[Floats, Floats, Floats]]
"""x, y and heading of the line at (s, d)."""


def straight(s: Floats, d: Floats) -> tuple[Floats, Floats, Floats]:
    return s, d, np.zeros_like(s)


def moving(
    recording: Recording, rows: slice, bend: Bend, s: Floats, d: Floats
) -> tuple[Floats, Floats, Floats]:
    """The speed along the line in the plane, its rate and the line's yaw rate, by differences over 2 m."""

    def lengths(ahead: float, aside: float) -> Floats:
        """How long a metre of the line is there, in the plane."""
        (x, y, _), (u, v, _) = (bend(s + ahead + step, d + aside) for step in (-1.0, 1.0))
        return np.asarray(np.hypot(u - x, v - y) / 2)

    v_lon, here = recording.v_lon[rows], lengths(0, 0)
    along, across = ((lengths(*x) - lengths(-x[0], -x[1])) / 2 for x in ((1.0, 0.0), (0.0, 1.0)))
    rate = recording.a_lon[rows] * here + v_lon * (along * v_lon + across * recording.v_lat[rows])
    yaw = (bend(s + 1, d)[2] - bend(s - 1, d)[2]) / 2 * v_lon
    return v_lon * here, rate, yaw


TYPES = {"main": "highway", "merge": "accessRamp", "departure": "exitRamp"}


def commonroad_of(
    recording: Recording,
    road: Road,
    bend: Bend = straight,
    types: Callable[[Lanelet], str] = lambda x: TYPES[x.attribute],
    ends: tuple[float, float] = (-600.0, 1400.0),
    step: float = 50.0,
) -> str:
    """Vehicles as dynamic obstacles whose boxes are aligned with the line; ids of lanelets are numbers.

    The velocity of the file is the speed, and the orientation that of the motion; where nobody moves
    across the lane, a box is as in the recording.
    """
    number = numbers_of(road)
    head = '<?xml version="1.0"?>\n'
    head += f'<commonRoad commonRoadVersion="2020a" timeStepSize="{1 / recording.rate!r}">\n'
    parts = [lanelet_xml(x, road, number, bend, types(x), ends, step) for x in road.lanelets]
    parts += [obstacle_xml(recording, v, bend) for v in range(recording.vehicles)]
    return head + "\n".join(parts) + "\n</commonRoad>\n"


def numbers_of(road: Road) -> dict[str, int]:
    """Ids of lanelets in a file: the name of a lane where that is a number and it has one lanelet."""
    names = [x.id for x in road.lanelets]
    if all(name.isdecimal() for name in names):
        return {name: int(name) for name in names}
    return {name: 1001 + k for k, name in enumerate(names)}


def bounds_of(lanelet: Lanelet, bend: Bend, ends: tuple[float, float], step: float) -> tuple[Floats, Floats]:
    """Left and right bound (n, 2) with a vertex every ``step`` metres or so."""
    low = ends[0] if lanelet.s[0] is None else float(lanelet.s[0])
    high = ends[1] if lanelet.s[1] is None else float(lanelet.s[1])
    at = np.linspace(low, high, 1 + max(1, math.ceil((high - low) / step)))
    right, left = (np.stack(bend(at, np.full_like(at, float(d)))[:2], axis=1) for d in lanelet.d)
    return left, right


def links_of(lanelet: Lanelet, road: Road) -> dict[str, list[Lanelet]]:
    """Successors, predecessors and neighbours of a lanelet."""

    def alongside(other: Lanelet) -> bool:
        return other.s == lanelet.s

    others = [x for x in road.lanelets if x is not lanelet]
    same = [x for x in others if x.lane == lanelet.lane]
    return {
        "predecessor": [x for x in same if x.s[1] is not None and x.s[1] == lanelet.s[0]],
        "successor": [x for x in same if x.s[0] is not None and x.s[0] == lanelet.s[1]],
        "adjacentLeft": [x for x in others if x.d[0] == lanelet.d[1] and alongside(x)],
        "adjacentRight": [x for x in others if x.d[1] == lanelet.d[0] and alongside(x)],
    }


def lanelet_xml(
    lanelet: Lanelet,
    road: Road,
    number: dict[str, int],
    bend: Bend,
    kind: str,
    ends: tuple[float, float],
    step: float,
) -> str:
    parts = []
    for tag, points in zip(("leftBound", "rightBound"), bounds_of(lanelet, bend, ends, step), strict=True):
        inner = "".join(f"<point><x>{x!r}</x><y>{y!r}</y></point>" for x, y in points.tolist())
        parts.append(f"<{tag}>{inner}</{tag}>")
    for tag, others in links_of(lanelet, road).items():
        same = ' drivingDir="same"' if tag.startswith("adjacent") else ""
        parts += [f'<{tag} ref="{number[x.id]}"{same}/>' for x in others]
    parts.append(f"<laneletType>{kind}</laneletType>")
    return f'<lanelet id="{number[lanelet.id]}">{"".join(parts)}</lanelet>'


def obstacle_xml(recording: Recording, v: int, bend: Bend) -> str:
    rows = slice(recording.start[v], recording.start[v + 1])
    length, width = recording.length[v], recording.width[v]
    s, d = recording.s[rows] - length / 2, recording.d[rows] - width / 2
    x, y, heading = bend(s, d)
    v_lat = recording.v_lat[rows]
    along, rate, _ = moving(recording, rows, bend, s, d)
    turned = heading + np.arctan2(v_lat, along)
    pull = rate / np.cos(turned - heading)
    speed = np.hypot(along, v_lat)
    first = int(recording.first_frame[v])
    columns: Sequence[Floats] = (x, y, turned, speed, pull)
    states = [state_xml(first + k, *values) for k, values in enumerate(zip(*columns, strict=True))]
    shape = f"<length>{float(length)!r}</length><width>{float(width)!r}</width>"
    return (
        f'<dynamicObstacle id="{recording.vehicle_id[v]}"><type>car</type>'
        f"<shape><rectangle>{shape}</rectangle></shape><initialState>{states[0]}</initialState>"
        f"<trajectory>{''.join(f'<state>{x}</state>' for x in states[1:])}</trajectory></dynamicObstacle>"
    )


def state_xml(step: int, x: float, y: float, heading: float, speed: float, pull: float) -> str:
    values = {"orientation": heading, "time": step, "velocity": speed, "acceleration": pull}
    told = "".join(
        f"<{k}><exact>{v if k == 'time' else repr(float(v))}</exact></{k}>" for k, v in values.items()
    )
    return f"<position><point><x>{float(x)!r}</x><y>{float(y)!r}</y></point></position>{told}"
