"""Small maps of measured lanelets along an arc or a straight line, as files of other formats."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

Point = tuple[float, float]


@dataclass(frozen=True)
class MapLane:
    """A lanelet from ``s[0]`` to ``s[1]``, ``d``: right and left edge at its beginning and at its end."""

    id: int
    s: tuple[float, float]
    d: tuple[float, float]
    after: tuple[int, ...] = ()
    left: int | None = None
    right: int | None = None
    kind: str = "highway"
    end: tuple[float, float] | None = None

    def bound(self, side: int, curvature: float) -> list[Point]:
        """Points of the right (0) or left (1) bound, at most 4 m apart."""
        count = max(2, math.ceil((self.s[1] - self.s[0]) / 4))
        d0, d1 = self.d[side], (self.end or self.d)[side]
        shares = [k / count for k in range(count + 1)]
        return [place(self.s[0] + x * (self.s[1] - self.s[0]), d0 + x * (d1 - d0), curvature) for x in shares]


def place(s: float, d: float, curvature: float) -> Point:
    """Where (s, d) is in the plane, on an arc that begins at (0, 0) along x."""
    if not curvature:
        return s, d
    turned, radius = s * curvature, 1 / curvature - d
    return radius * math.sin(turned), 1 / curvature - radius * math.cos(turned)


RAMP = (
    MapLane(11, (0, 120), (0, 3.5), (12,), right=21),
    MapLane(21, (0, 120), (-3.5, 0), (22,), left=11),
    MapLane(12, (120, 320), (0, 3.5), (13,), right=22),
    MapLane(22, (120, 320), (-3.5, 0), (23,), left=12, right=32),
    MapLane(32, (120, 320), (-7, -3.5), (), left=22, kind="accessRamp"),
    MapLane(13, (320, 440), (0, 3.5), (), right=23),
    MapLane(23, (320, 440), (-3.5, 0), (), left=13),
)
"""Two lanes with a merge lane from 120 m to 320 m."""


_FIVE = [(300 * k, 300 * k + 300) for k in range(5)]
RAMPS = (
    *(MapLane(11 + k, s, (0, 3.75), (12 + k,) if k < 4 else (), right=21 + k) for k, s in enumerate(_FIVE)),
    *(
        MapLane(
            *(21 + k, s, (-3.75, 0), (22 + k,) if k < 4 else (), 11 + k, {1: 32, 3: 34}.get(k)),
        )
        for k, s in enumerate(_FIVE)
    ),
    MapLane(32, _FIVE[1], (-7.25, -3.75), (), left=22, kind="accessRamp"),
    MapLane(34, _FIVE[3], (-7.25, -3.75), (), left=24, kind="exitRamp"),
)
"""Two lanes of 1500 m with an access ramp from 300 m to 600 m and an exit ramp from 900 m to 1200 m."""


def commonroad(lanes: Sequence[MapLane], curvature: float = 0.0, version: str = "2020a") -> str:
    made = "".join(_lanelet(x, curvature) for x in lanes)
    return f'<commonRoad commonRoadVersion="{version}" timeStepSize="0.1">{made}</commonRoad>'


def _lanelet(lane: MapLane, curvature: float) -> str:
    right, left = (
        "".join(f"<point><x>{x}</x><y>{y}</y></point>" for x, y in lane.bound(side, curvature))
        for side in (0, 1)
    )
    refs = "".join(f'<successor ref="{x}"/>' for x in lane.after)
    for tag, other in (("adjacentLeft", lane.left), ("adjacentRight", lane.right)):
        refs += "" if other is None else f'<{tag} ref="{other}" drivingDir="same"/>'
    return (
        f'<lanelet id="{lane.id}"><leftBound>{left}</leftBound><rightBound>{right}</rightBound>'
        f"{refs}<laneletType>{lane.kind}</laneletType></lanelet>"
    )


def lanelet2(
    lanes: Sequence[MapLane],
    curvature: float = 0.0,
    node: Callable[[Point], str] | None = None,
    subtype: str = "road",
) -> str:
    """The lanelets with a way for each bound, which neighbours share; every second way is turned.

    ``node``: what a node has, its tags and attributes; by default its place in the plane.
    """
    nodes: dict[Point, int] = {}
    ways: dict[tuple[int, ...], int] = {}
    relations = []
    for lane in lanes:
        sides = []
        for side in (0, 1):
            points = [(round(x, 6), round(y, 6)) for x, y in lane.bound(side, curvature)]
            ids = tuple(nodes.setdefault(x, len(nodes) + 1) for x in points)
            sides.append(ways.setdefault(ids, len(ways) + 10_000))
        members = "".join(
            f'<member type="way" ref="{ref}" role="{role}"/>'
            for ref, role in zip(sides, ("right", "left"), strict=True)
        )
        tags = f'<tag k="type" v="lanelet"/><tag k="subtype" v="{subtype}"/><tag k="location" v="nonurban"/>'
        relations.append(f'<relation id="{lane.id}">{members}{tags}</relation>')
    made = "".join(f'<node id="{k}" {(node or local)(x)}</node>' for x, k in nodes.items())
    for ids, k in ways.items():
        turned = ids[::-1] if k % 2 else ids
        refs = "".join(f'<nd ref="{x}"/>' for x in turned)
        made += f'<way id="{k}">{refs}</way>'
    return f"<osm>{made}{''.join(relations)}</osm>"


def local(point: Point) -> str:
    x, y = point
    return f'lat="0" lon="0"><tag k="local_x" v="{x}"/><tag k="local_y" v="{y}"/>'
