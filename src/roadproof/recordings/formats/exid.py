"""Recordings in the exiD format (semantics §7; Moers et al., IV 2022), on Lanelet2 maps.

Positions are the middles of boxes, y grows up, and headings are in degrees, counter-clockwise from x. The
map of a location is an .osm file in the folder of the recording, or in ``maps`` or ``lanelets`` beside it
or beside its parent, whose name has the number of the location; NAME_zones.toml beside NAME.osm may say
which lanelets are of ramps. Further columns are passed over, as versions of the format differ in them.

Maps in Lanelet2's OSM XML: nodes, ways, and relations of type lanelet with a left and a right way.

Ids of nodes, ways and relations are namespaces of their own. A node has ``local_x`` and ``local_y`` (m), or
else lat and lon, which are projected to UTM (Karney 2011, the series of Krüger to n^4) and moved to an
origin. Bounds are turned so that the left way is on the left of the driving direction. A lanelet follows
another where its bounds begin in the nodes in which those of the other end, and is beside another of the
same direction where the left way of one is the right way of the other.
"""

import math
import re
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.recordings.formats.contradictions import contradictions, seldom
from roadproof.recordings.formats.lanelets import network_of
from roadproof.recordings.formats.measured_roads import MeasuredTraffic, place_traffic
from roadproof.recordings.formats.plausible import LARGEST_ACCELERATION, LARGEST_SIZE, LARGEST_SPEED, check
from roadproof.recordings.formats.recording import Floats, Integers, Recording, with_notes
from roadproof.recordings.formats.reliable import reliable
from roadproof.recordings.formats.source import Files, Format, beside
from roadproof.recordings.formats.table import Table, kinds_of, read_named
from roadproof.recordings.formats.tracks import (
    RATE_AT,
    files_of,
    find_recordings,
    in_order,
    match_vehicles,
    rate_of,
    read_tracks,
    usable,
    vehicles_by_id,
)
from roadproof.runtime.xml_reader import Element, by_id, number_in, read_xml
from roadproof.world.maps.network import ZONES_ENDING
from roadproof.world.maps.topology import MeasuredLanelet

LEFT_OUT = frozenset(
    "emergency_lane walkway shared_walkway crosswalk stairs bicycle_lane rail parking".split()  # noqa: SIM905
)
"""Subtypes of lanelets that are no lanes of the road."""
_AXIS, _FLATTENING = 6_378_137.0, 1 / 298.257223563
_SCALE, _EASTING = 0.9996, 500_000.0


@dataclass(frozen=True)
class _LaneletNodes:
    """A lanelet as drawn: ids of its ways, and its bounds as nodes in driving direction."""

    id: str
    ways: tuple[str, str]
    left: tuple[str, ...]
    right: tuple[str, ...]


def read_osm(path: Path, origin: tuple[float, float]) -> tuple[dict[str, MeasuredLanelet], tuple[str, ...]]:
    """The lanelets of a map by id, and notes on what was left out.

    ``origin``: UTM easting and northing (m) of the point from which coordinates count, for nodes that have
    no local ones. Raises ``InputError`` that names the file, the element and the rule.
    """
    root = read_xml(path, "osm")
    nodes, ways = by_id(path, root.findall("node")), by_id(path, root.findall("way"))
    relations = by_id(path, [x for x in root.findall("relation") if _tag(x, "type") == "lanelet"])
    left_out = sorted({_tag(x, "subtype") for x in relations.values()} & LEFT_OUT)
    relations = {name: x for name, x in relations.items() if _tag(x, "subtype") not in LEFT_OUT}
    if not relations:
        raise InputError(f"{path}: the map has no relation of type lanelet; a road is needed")
    refs = {name: _nodes_of(path, name, way, nodes) for name, way in ways.items()}
    places = _places(path, {ref: nodes[ref] for way in refs.values() for ref in way}, origin)
    drawn = {name: _draw(path, name, x, refs, places) for name, x in relations.items()}
    notes = (f"lanelets of subtype {', '.join(left_out)} are left out",) if left_out else ()
    return _linked(drawn, places), notes


def utm_of(lat: Floats, lon: Floats) -> Floats:
    """Easting and northing (n, 2) in metres of points in degrees, in the zone of the first.

    >>> [round(float(x), 2) for x in utm_of(np.array([50.0]), np.array([9.0]))[0]]
    [500000.0, 5538630.7]
    """
    middle = math.radians(6 * math.floor((float(lon[0]) + 180) / 6) - 177)
    n = _FLATTENING / (2 - _FLATTENING)
    radius = _AXIS / (1 + n) * (1 + n**2 / 4 + n**4 / 64)
    series = (
        n / 2 - 2 * n**2 / 3 + 5 * n**3 / 16 + 41 * n**4 / 180,
        13 * n**2 / 48 - 3 * n**3 / 5 + 557 * n**4 / 1440,
        61 * n**3 / 240 - 103 * n**4 / 140,
        49561 * n**4 / 161280,
    )
    eccentric = 2 * math.sqrt(n) / (1 + n)
    sine, turn = np.sin(np.radians(lat)), np.radians(lon) - middle
    t = np.sinh(np.arctanh(sine) - eccentric * np.arctanh(eccentric * sine))
    xi, eta = np.arctan2(t, np.cos(turn)), np.arctanh(np.sin(turn) / np.hypot(1, t))
    east, north = eta.copy(), xi.copy()
    for k, factor in enumerate(series, start=1):
        east += factor * np.cos(2 * k * xi) * np.sinh(2 * k * eta)
        north += factor * np.sin(2 * k * xi) * np.cosh(2 * k * eta)
    scale = _SCALE * radius
    return np.stack((_EASTING + scale * east, scale * north + np.where(lat < 0, 1e7, 0.0)), axis=1)


def _tag(node: Element, key: str) -> str:
    found = (x.get("v", "") for x in node.findall("tag") if x.get("k") == key)
    return next(found, "")


def _nodes_of(path: Path, name: str, way: Element, nodes: Mapping[str, Element]) -> tuple[str, ...]:
    refs = tuple(x.get("ref", "") for x in way.findall("nd"))
    for ref in refs:
        if ref not in nodes:
            raise InputError(f"{path}: way {name}: nd {ref} is no node of the map")
    return refs


def _places(path: Path, nodes: Mapping[str, Element], origin: tuple[float, float]) -> dict[str, Floats]:
    """x and y of each node that a way uses."""
    local = {name for name, node in nodes.items() if _tag(node, "local_x") or _tag(node, "local_y")}
    if local and len(local) < len(nodes):
        name = next(x for x in nodes if x not in local)
        raise InputError(f"{path}: node {name} has no local_x and local_y, but others have; all or none")
    keys = ("local_x", "local_y") if local else ("lat", "lon")
    read = [
        [
            number_in(path, _tag(node, key) if local else node.get(key), f"{key} of node {name}")
            for key in keys
        ]
        for name, node in nodes.items()
    ]
    points = np.array(read).reshape(-1, 2)
    if not local and len(points):
        names = list(nodes)
        wrong = np.flatnonzero((np.abs(points[:, 0]) > 84) | (np.abs(points[:, 1]) > 180))
        if len(wrong):
            lat, lon = points[wrong[0]]
            raise InputError(f"{path}: node {names[wrong[0]]} has lat={lat}, lon={lon}: no place in UTM")
        points = utm_of(points[:, 0], points[:, 1]) - np.array(origin)
    return dict(zip(nodes, points, strict=True))


def _draw(
    path: Path,
    name: str,
    relation: Element,
    refs: Mapping[str, tuple[str, ...]],
    places: Mapping[str, Floats],
) -> _LaneletNodes:
    where = f"{path}: relation {name}"
    ways: dict[str, str] = {}
    for role in ("left", "right"):
        members = [x for x in relation.findall("member") if x.get("role") == role]
        if len(members) != 1 or members[0].get("type") != "way":
            raise InputError(f"{where} has {len(members)} members of role {role}; a lanelet has one way each")
        ways[role] = members[0].get("ref", "")
        if ways[role] not in refs:
            raise InputError(f"{where}: {role} way {ways[role]} is no way of the map")
        if len(refs[ways[role]]) < 2:
            raise InputError(f"{where}: {role} way {ways[role]} has fewer than two nodes")
    if _tag(relation, "one_way") == "no":
        raise InputError(f"{where}: one_way=no: lanelets that are driven both ways are not supported")
    left, right = refs[ways["left"]], refs[ways["right"]]
    ends = [np.array([places[x[0]], places[x[-1]]]) for x in (left, right)]
    if np.hypot(*(ends[0] - ends[1]).T).sum() > np.hypot(*(ends[0] - ends[1][::-1]).T).sum():
        right = right[::-1]
    if _area([*(places[x] for x in left), *(places[x] for x in reversed(right))]) > 0:
        left, right = left[::-1], right[::-1]
    return _LaneletNodes(name, (ways["left"], ways["right"]), left, right)


def _area(points: Sequence[Floats]) -> float:
    """Of a polygon; greater than zero where it goes around to the left."""
    x, y = np.array(points).T
    return float((x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2)


def _linked(drawn: Mapping[str, _LaneletNodes], places: Mapping[str, Floats]) -> dict[str, MeasuredLanelet]:
    begins: dict[tuple[str, str], list[str]] = defaultdict(list)
    for x in drawn.values():
        begins[x.left[0], x.right[0]].append(x.id)
    by_left = {x.ways[0]: x.id for x in drawn.values()}
    by_right = {x.ways[1]: x.id for x in drawn.values()}
    made = {}
    for x in drawn.values():
        left, right = _even(*(np.array([places[ref] for ref in bound]) for bound in (x.left, x.right)))
        beside = [y for y in (by_right.get(x.ways[0]), by_left.get(x.ways[1])) if y is not None]
        successors = tuple(begins[x.left[-1], x.right[-1]])
        made[x.id] = MeasuredLanelet(x.id, left, right, None, successors, tuple(beside))
    return made


def _even(left: Floats, right: Floats) -> tuple[Floats, Floats]:
    """Two lines with points at the same shares of their lengths."""
    shares = []
    for line in (left, right):
        way = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))))
        shares.append(way / max(float(way[-1]), 1e-9))
    at = np.union1d(np.round(shares[0], 9), np.round(shares[1], 9))
    one, other = (
        np.stack([np.interp(at, share, line[:, k]) for k in range(2)], axis=1)
        for share, line in zip(shares, (left, right), strict=True)
    )
    return one, other


RECORDING_KINDS = kinds_of(
    integer="recordingId locationId",
    number="frameRate xUtmOrigin yUtmOrigin",
)
VEHICLE_KINDS = kinds_of(
    integer="recordingId trackId initialFrame finalFrame numFrames",
    number="width length",
    text="class",
)
SAMPLE_KINDS = kinds_of(
    integer="recordingId trackId frame",
    number="xCenter yCenter heading xVelocity yVelocity xAcceleration yAcceleration lonVelocity latVelocity",
    list="laneletId",
)
LARGEST_PLACE = 10_000.0


def read_exid(folder: Path, name: str, strict: bool = True) -> Recording:
    """Recording ``name`` of ``folder``; unless ``strict``, bad vehicles are left out.

    Raises ``InputError`` that names file, element, value and rule.
    """
    about = read_named(folder / f"{name}_recordingMeta.csv", RECORDING_KINDS)
    rate = rate_of(about, "recordingId", int(name), f"the file is of recording {name}")
    meta = _read_vehicles(folder / f"{name}_tracksMeta.csv", int(name))
    tracks, notes = in_order(read_named(folder / f"{name}_tracks.csv", SAMPLE_KINDS), "trackId")
    tracks.require(tracks["recordingId"] == int(name), "recordingId", f"the file is of recording {name}")
    meta, tracks, start, left_out = usable(meta, tracks, "trackId", strict, _check_cells)
    notes += (*left_out, *_check_velocities(tracks))
    path = _map_of(folder, int(about["locationId"][0]), about)
    lanelets, told = read_osm(path, (about["xUtmOrigin"][0], about["yUtmOrigin"][0]))
    heading = np.radians(tracks["heading"])
    traffic = MeasuredTraffic(
        name=name,
        rate=rate,
        vehicle_id=meta["trackId"],
        kind=np.array([str(x).capitalize() for x in meta["class"]]),
        length=meta["length"],
        width=meta["width"],
        first_frame=meta["initialFrame"],
        start=start,
        centre=np.stack((tracks["xCenter"], tracks["yCenter"]), axis=1),
        heading=heading,
        velocity=np.stack((tracks["xVelocity"], tracks["yVelocity"]), axis=1),
        acceleration=np.stack((tracks["xAcceleration"], tracks["yAcceleration"]), axis=1),
        notes=(*notes, *told),
    )
    recording = place_traffic(traffic, network_of(path, lanelets, strict))
    stands = reliable(recording, strict, partial(_check_plausible, tracks))
    return with_notes(stands, _check_lanelets(tracks, recording, path))


def _read_vehicles(path: Path, recording: int) -> Table:
    meta = read_named(path, VEHICLE_KINDS)
    meta.require(meta["recordingId"] == recording, "recordingId", f"the file is of recording {recording}")
    return vehicles_by_id(meta, "trackId")


def _check_cells(meta: Table, tracks: Table) -> Integers:
    """Where each vehicle's samples start; no cell may say what no vehicle is or does."""
    for column in ("width", "length"):
        size = meta[column]
        meta.require(size > 0, column, "the size of a vehicle is greater than zero; people have none")
        meta.require(size <= LARGEST_SIZE, column, f"no vehicle is larger than {LARGEST_SIZE:g} m")
    start = match_vehicles(meta, tracks, "trackId", 0)
    tracks.require_within(LARGEST_PLACE, "xCenter", "yCenter")
    tracks.require_within(LARGEST_SPEED, "xVelocity", "yVelocity", "lonVelocity", "latVelocity")
    tracks.require_within(LARGEST_ACCELERATION, "xAcceleration", "yAcceleration")
    tracks.require_within(360.0, "heading")
    return start


def _check_velocities(tracks: Table) -> Iterator[str]:
    """lonVelocity is the velocity along the heading; where it is not, headings or axes are others."""
    heading = np.radians(tracks["heading"])
    along = tracks["xVelocity"] * np.cos(heading) + tracks["yVelocity"] * np.sin(heading)
    wrong = np.abs(along - tracks["lonVelocity"]) > 0.5
    rule, advice = "not the velocity along the heading", "does y grow up, and is heading in degrees?"
    yield from seldom(tracks, wrong, "lonVelocity", rule, advice)


def _check_plausible(whole: Table, recording: Recording, rows: Integers) -> Iterator[str]:
    """Notes on what the file contradicts itself in. Raises ``InputError`` where that is too much."""
    tracks = whole if len(rows) == whole.rows else whole.at(rows)

    def at(row: int, signal: str) -> str:
        return f"{tracks.cell(row, 'frame')}, trackId={tracks['trackId'][row]}"

    vehicle_at = partial(tracks.cell, column="trackId")
    return contradictions(tracks.path, check(recording), at, vehicle_at, "lanelet of the map")


def _check_lanelets(tracks: Table, recording: Recording, path: Path) -> Iterator[str]:
    """laneletId lists must name lanelets of the map, and mostly one of the lane that the middle is in."""
    lane_of = {x.id: x.lane for x in recording.lanelets}
    index = {lane.name: k for k, lane in enumerate(recording.lanes)}
    listed, which = np.unique(tracks["laneletId"].astype(np.str_), return_inverse=True)
    masks = np.zeros(len(listed), np.int64)
    for k, text in enumerate(listed):
        names = [x.strip() for x in str(text).split(";") if x.strip() not in ("", "-1")]
        unknown = [x for x in names if x not in lane_of]
        if unknown and len(unknown) == len(names):
            row = int(np.argmax(which == k))
            raise tracks.refuse(row, "laneletId", f"{path.name} has no lanelet {unknown[0]} among its lanes")
        masks[k] = sum({1 << index[lane_of[x]] for x in names if x in lane_of})
    told: Integers = masks[which]
    other = (told != 0) & (recording.lane >= 0) & ((told >> np.maximum(recording.lane, 0)) & 1 == 0)
    advice = f"do {path.name} and the positions fit?"
    yield from seldom(tracks, other, "laneletId", "not the lane of the box's middle", advice)


def maps_near(folder: Path) -> list[Path]:
    """The .osm files that a recording of ``folder`` may be on."""
    for place in (folder, *(x / name for x in (folder, folder.parent) for name in ("maps", "lanelets"))):
        found = sorted(place.glob("*.osm") if place == folder else place.rglob("*.osm"))
        if found:
            return found
    return []


def _map_of(folder: Path, location: int, about: Table) -> Path:
    maps = maps_near(folder)
    named = [x for x in maps if location in map(int, re.findall(r"\d+", x.stem))]
    if len(named) != 1:
        shown = ", ".join(x.name for x in named or maps) or "none"
        raise about.refuse(
            0, "locationId", f"one map is needed whose name has this number, but there are {shown}"
        )
    return named[0]


def _files(folder: Path, name: str) -> Files:
    maps = [x for osm in maps_near(folder) for x in (*beside(osm, ZONES_ENDING), osm)]
    return (*maps, *files_of(folder, name))


FORMAT = Format(
    "exiD",
    "the files of highD with a column recordingId, and maps in .osm",
    partial(find_recordings, with_ids=True, files=_files),
    partial(read_tracks, read_exid),
    RATE_AT,
)
