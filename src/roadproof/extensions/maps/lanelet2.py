"""Lanelets of a map in Lanelet2 (OSM XML): relations of two ways, left and right, with their subtype.

Places are ``local_x`` and ``local_y`` of nodes where all have them. Else latitude and longitude are projected
by a transverse Mercator projection of the WGS84 ellipsoid around the middle of the map (Snyder 1987,
equations 8-9 and 8-10, up to the fifth power): within 50 km of it, places are within a millimetre of the
exact projection, and lengths within 0.004 % of those on the ground. Elevation is left out.

A lanelet follows another where its bounds begin at the points where those of the other end, and is beside one
with a bound of the same points. Lanelets of subtype road and highway, and those without one, are read; the
others are counted. Of lanelets that are driven both ways the direction of the bounds is read.
"""

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.maps.harmless import LANELET2, OSM_KEYS
from roadproof.extensions.maps.lines import resampled
from roadproof.extensions.maps.projections import UtmPoint, transverse_mercator, utm_of
from roadproof.extensions.maps.topology import Floats, MeasuredLanelet
from roadproof.extensions.maps.xml_reader import (
    Element,
    by_id,
    number_in,
    parts_not_read,
    read_xml,
    summary_of,
)

ROADS = frozenset(("road", "highway"))
"""Subtypes of lanelets that vehicles drive on along a road."""
_SPACING = 1.0
"""Metres between the points of bounds that have different numbers of them."""
_VEHICLES = ("vehicle", "car", "truck", "bus", "motorcycle")
_PLAIN = (("one_way", "yes"), ("dynamic", "no"))
_NO_LANELETS = {"regulatory_element": "rules of traffic", "multipolygon": "areas"}
"""Types of relations that place no lane, and the rule by which they are harmless."""


@dataclass(frozen=True)
class LaneletBounds:
    """Ids of the nodes of both bounds in driving direction, and their points."""

    left: tuple[str, ...]
    right: tuple[str, ...]
    lines: tuple[Floats, Floats]


@dataclass(frozen=True)
class LaneletFile:
    """Lanelets by id; how many relations are no road, by their kind; kinds of parts that were not read."""

    lanelets: dict[str, MeasuredLanelet]
    others: tuple[tuple[str, int], ...]
    unread: tuple[str, ...]


def read_map(path: Path, origin: UtmPoint | None = None) -> LaneletFile:
    """The lanelets of a map, with what was left out. Raises ``InputError``.

    ``origin``: easting and northing (m) of the point in UTM from which places count, where nodes have no
    local ones.
    """
    root = read_xml(path, "osm")
    points = _points(path, by_id(path, root.findall("node")), origin)
    ways = by_id(path, root.findall("way"))
    bounds: dict[str, LaneletBounds] = {}
    relations, others = lanelets_among(root, lambda kind: kind in ROADS)
    for name, node in by_id(path, relations).items():
        left, right = (_nodes(path, name, node, x, ways, points) for x in ("left", "right"))
        bounds[name] = directed(left, right, points)
    if not bounds:
        raise InputError(f"{path}: {_without_roads(others, ways)}")
    return LaneletFile(_with_links(bounds), tuple(sorted(others.items())), omitted_parts(root))


def lanelets_among(root: Element, is_road: Callable[[str], bool]) -> tuple[list[Element], Counter[str]]:
    """The lanelets that are of a road by their subtype, and how many other relations there are by kind.

    All of a relation that is no road counts as read. A lanelet without a subtype is a road.
    """
    roads, others = list[Element](), Counter[str]()
    for relation in root.findall("relation"):
        form = tag_of(relation, "type")
        kind = tag_of(relation, "subtype") or "road" if form == "lanelet" else f"relation of type {form}"
        if form == "lanelet" and is_road(kind):
            _read_users(relation)
            roads.append(relation)
            continue
        relation.read_all()
        if form not in _NO_LANELETS:
            others[kind] += 1
    return roads, others


def _read_users(relation: Element) -> None:
    """Count tags as read that let vehicles drive in the direction of a lanelet; others are named."""
    for tag in (x for x in relation if x.tag == "tag"):
        name, value = tag.peek("k") or "", tag.peek("v")
        _, participant, user = name.partition("participant:")
        others = bool(participant) and user.partition(":")[0] not in _VEHICLES
        if others or (participant and value == "yes") or (name, value) in _PLAIN:
            tag.read_all()


def omitted_parts(root: Element) -> tuple[str, ...]:
    """A line for each kind of parts that were not read; ways of which no node was read place no lanelet."""
    for way in root.findall("way"):
        if not any(x.is_read for x in way):
            way.read_all()
    return summary_of(parts_not_read(root, LANELET2, OSM_KEYS))


def tag_of(node: Element, key: str) -> str:
    """The value of a tag, empty where there is none; other tags do not count as read."""
    for tag in node:
        if tag.tag == "tag" and tag.peek("k") == key:
            tag.note("k")
            return tag.get("v", "")
    return ""


def _without_roads(others: Mapping[str, int], ways: Mapping[str, Element]) -> str:
    """Return why there is no road in a file."""
    if others:
        counts = ", ".join(f"{count} of {kind}" for kind, count in sorted(others.items()))
        return f"the file has no lanelet of subtype {' or '.join(sorted(ROADS))}, but {counts}"
    streets = sum(bool(tag_of(x, "highway")) for x in ways.values())
    what = f"{streets} streets as lines (tag highway)" if streets else "none"
    return f"relations of type lanelet are needed, and the file has {what}; use a map in Lanelet2"


def _points(
    path: Path, nodes: Mapping[str, Element], origin: UtmPoint | None
) -> dict[str, tuple[float, float]]:
    """Return where the nodes are in the plane (m)."""
    keys = "local_x", "local_y"
    local = {name: [tag_of(node, key) for key in keys] for name, node in nodes.items()}
    if all(x and y for x, y in local.values()):
        rows = {
            name: [number_in(path, x, f"{key} of node {name}") for key, x in zip(keys, texts, strict=True)]
            for name, texts in local.items()
        }
        return {name: (x, y) for name, (x, y) in rows.items()}
    places = {
        name: tuple(number_in(path, node.get(key), f"{key} of node {name}") for key in ("lat", "lon"))
        for name, node in nodes.items()
    }
    for name, (latitude, longitude) in places.items():
        if abs(latitude) > 85 or abs(longitude) > 180:
            raise InputError(f"{path}: node {name}: lat={latitude}, lon={longitude}: no place on a map")
    if origin is not None:
        moved = utm_of(*np.array([*places.values()]).reshape(-1, 2).T) - np.array(origin)
        return {name: (x, y) for name, (x, y) in zip(places, moved.tolist(), strict=True)}
    middle = [(min(x) + max(x)) / 2 for x in zip(*places.values(), strict=True)]
    return {name: transverse_mercator(x, y, (middle[0], middle[1])) for name, (x, y) in places.items()}


def _nodes(
    path: Path,
    name: str,
    relation: Element,
    side: str,
    ways: Mapping[str, Element],
    points: Mapping[str, tuple[float, float]],
) -> tuple[str, ...]:
    """Ids of the nodes of a side, whose ways follow each other. Raises ``InputError``."""
    where = f"{path}: lanelet {name}: {side} bound"
    parts = []
    for member in (x for x in relation if x.tag == "member"):
        if member.peek("role") == side and member.get("type") == "way":
            member.note("role")
            way = ways.get(member.get("ref", ""))
            if way is None:
                raise InputError(f"{where}: way {member.get('ref')} is not in the file")
            parts.append([x.get("ref", "") for x in way.findall("nd")])
    nodes = list(_join_ways(parts))
    unknown = next((x for x in nodes if x not in points), None)
    if unknown is not None:
        raise InputError(f"{where}: node {unknown} is not in the file")
    if len(nodes) < 2:
        raise InputError(f"{where} has {len(nodes)} points; at least two are needed")
    return tuple(nodes)


def _join_ways(parts: Sequence[list[str]]) -> Iterator[str]:
    """Yield the points of ways in sequence, turned so that each begins where the one before ends."""
    last: str | None = None
    for k, part in enumerate(parts):
        following = parts[k + 1] if k + 1 < len(parts) else []
        ends = following[:1] + following[-1:]
        turned = part[-1:] == [last] if last is not None else part[:1] != part[-1:] and part[0] in ends
        ordered = part[::-1] if turned else part
        yield from ordered[1:] if ordered[:1] == [last] else ordered
        last = ordered[-1] if ordered else last


def directed(
    left: tuple[str, ...],
    right: tuple[str, ...],
    points: Mapping[str, tuple[float, float]] | Mapping[str, Floats],
) -> LaneletBounds:
    """Return both bounds in the direction in which the left one is on the left."""
    one, other = (np.array([points[x] for x in side]) for side in (left, right))
    along = np.hypot(*(one[0] - other[0])) + np.hypot(*(one[-1] - other[-1]))
    if along > np.hypot(*(one[0] - other[-1])) + np.hypot(*(one[-1] - other[0])):
        other, right = other[::-1], right[::-1]
    around = np.concatenate((other, one[::-1]))
    around = around - around[0]
    area = float(np.sum(around[:-1, 0] * around[1:, 1] - around[1:, 0] * around[:-1, 1]))
    if area < 0:
        one, other, left, right = one[::-1], other[::-1], left[::-1], right[::-1]
    return LaneletBounds(left, right, (one, other))


def _with_links(bounds: Mapping[str, LaneletBounds]) -> dict[str, MeasuredLanelet]:
    begins, rights, lefts = (defaultdict[tuple[str, ...], list[str]](list) for _ in range(3))
    for name, x in bounds.items():
        begins[x.left[0], x.right[0]].append(name)
        lefts[x.left].append(name)
        rights[x.right].append(name)
    lanelets = {}
    for name, x in bounds.items():
        left, right = x.lines
        if len(left) != len(right):
            longest = max(float(np.hypot(*np.diff(line, axis=0).T).sum()) for line in x.lines)
            count = max(len(left), len(right), math.ceil(longest / _SPACING) + 1)
            left, right = resampled(left, count), resampled(right, count)
        after = tuple(y for y in begins[x.left[-1], x.right[-1]] if y != name)
        beside = dict.fromkeys(y for y in (*rights[x.left], *lefts[x.right]) if y != name)
        lanelets[name] = MeasuredLanelet(name, left, right, None, after, tuple(beside))
    return lanelets
