"""Recordings in the exiD format (semantics §7; Moers et al., IV 2022), on Lanelet2 maps.

Tracks are as ``levelx`` says. The map of a location is an .osm file in the folder of the recording, or in
``maps`` or ``lanelets`` beside it or beside its parent, whose name has the number of the location;
NAME_zones.toml beside NAME.osm may say which lanelets are of ramps.

Maps in Lanelet2's OSM XML: nodes, ways, and relations of type lanelet with a left and a right way.

Ids of nodes, ways and relations are namespaces of their own. A node has ``local_x`` and ``local_y`` (m), or
else lat and lon, which are projected to UTM (Karney 2011, the series of Krüger to n^4) and moved to an
origin. Bounds are turned so that the left way is on the left of the driving direction. A lanelet follows
another where its bounds begin in the nodes in which those of the other end, and is beside another of the
same direction where the left way of one is the right way of the other.
"""

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.maps.lanelet2 import LaneletBounds, directed, lanelets_among, tag_of
from roadproof.extensions.maps.lanelet2 import omitted_parts as unread_parts
from roadproof.extensions.maps.lines import way_along
from roadproof.extensions.maps.network import ZONES_ENDING
from roadproof.extensions.maps.projections import UtmPoint, utm_of
from roadproof.extensions.maps.topology import MeasuredLanelet
from roadproof.extensions.maps.xml_reader import Element, by_id, number_in, read_xml
from roadproof.extensions.traffic.formats.contradictions import note_if_rare
from roadproof.extensions.traffic.formats.lanelets import network_of
from roadproof.extensions.traffic.formats.levelx import (
    check_cells,
    check_plausible,
    check_velocities,
    ignored_column_notes,
    read_recording_meta,
    read_samples,
    read_vehicles,
    traffic_of,
)
from roadproof.extensions.traffic.formats.measured_roads import place_traffic
from roadproof.extensions.traffic.formats.recording import Floats, Integers, Recording, with_notes
from roadproof.extensions.traffic.formats.reliable import reliable_part
from roadproof.extensions.traffic.formats.source import Files, Format, beside, first_line
from roadproof.extensions.traffic.formats.table import ColumnTable
from roadproof.extensions.traffic.formats.tracks import (
    RATE_AT,
    files_of,
    find_recordings,
    read_tracks,
    usable,
)
from roadproof.world.not_read import LEFT_OUT, not_read_note

NO_LANES = frozenset(
    "emergency_lane walkway shared_walkway crosswalk stairs bicycle_lane rail parking".split()  # noqa: SIM905
)
"""Subtypes of lanelets that are no lanes of the road."""


@dataclass(frozen=True)
class _LaneletNodes:
    """A lanelet as drawn: ids of its ways, and its bounds in driving direction."""

    id: str
    ways: tuple[str, str]
    bounds: LaneletBounds


@dataclass(frozen=True)
class ReadMap:
    """Lanelets by id, notes on others, and kinds of parts of the file that were not read."""

    lanelets: dict[str, MeasuredLanelet]
    notes: tuple[str, ...]
    unread: tuple[str, ...]


def read_osm(path: Path, origin: UtmPoint) -> ReadMap:
    """The lanelets of a map, with what was left out.

    ``origin``: UTM easting and northing (m) of the point from which coordinates count, for nodes that have
    no local ones. Raises ``InputError`` that names the file, the element and the rule.
    """
    root = read_xml(path, "osm")
    nodes, ways = by_id(path, root.findall("node")), by_id(path, root.findall("way"))
    lanelets, others = lanelets_among(root, lambda kind: kind not in NO_LANES)
    relations = by_id(path, lanelets)
    if not relations:
        raise InputError(f"{path}: the map has no relation of type lanelet; a road is needed")
    refs = {name: _nodes_of(path, name, way, nodes) for name, way in ways.items()}
    places = _places(path, {ref: nodes[ref] for way in refs.values() for ref in way}, origin)
    drawn = {name: _draw(path, name, x, refs, places) for name, x in relations.items()}
    kinds = ", ".join(f"{count} of kind {kind}" for kind, count in sorted(others.items()))
    notes = (f"{LEFT_OUT} lanelets of {path.name} that are no lanes of the road: {kinds}",) if kinds else ()
    return ReadMap(_linked(drawn), notes, unread_parts(root))


def _nodes_of(path: Path, name: str, way: Element, nodes: Mapping[str, Element]) -> tuple[str, ...]:
    refs = tuple(x.get("ref", "") for x in way.findall("nd"))
    for ref in refs:
        if ref not in nodes:
            raise InputError(f"{path}: way {name}: nd {ref} is no node of the map")
    return refs


def _places(path: Path, nodes: Mapping[str, Element], origin: UtmPoint) -> dict[str, Floats]:
    """Return x and y of each node that a way uses."""
    local = {name for name, node in nodes.items() if tag_of(node, "local_x") or tag_of(node, "local_y")}
    if local and len(local) < len(nodes):
        name = next(x for x in nodes if x not in local)
        raise InputError(f"{path}: node {name} has no local_x and local_y, but others have; all or none")
    keys = ("local_x", "local_y") if local else ("lat", "lon")
    read = [
        [
            number_in(path, tag_of(node, key) if local else node.get(key), f"{key} of node {name}")
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
        members = [x for x in relation if x.tag == "member" and x.peek("role") == role]
        for member in members:
            member.note("role")
        if len(members) != 1 or members[0].get("type") != "way":
            raise InputError(f"{where} has {len(members)} members of role {role}; a lanelet has one way each")
        ways[role] = members[0].get("ref", "")
        if ways[role] not in refs:
            raise InputError(f"{where}: {role} way {ways[role]} is no way of the map")
        if len(refs[ways[role]]) < 2:
            raise InputError(f"{where}: {role} way {ways[role]} has fewer than two nodes")
    if tag_of(relation, "one_way") == "no":
        raise InputError(f"{where}: one_way=no: lanelets that are driven both ways are not supported")
    left, right = ways["left"], ways["right"]
    return _LaneletNodes(name, (left, right), directed(refs[left], refs[right], places))


def _linked(drawn: Mapping[str, _LaneletNodes]) -> dict[str, MeasuredLanelet]:
    begins: dict[tuple[str, str], list[str]] = defaultdict(list)
    for x in drawn.values():
        begins[x.bounds.left[0], x.bounds.right[0]].append(x.id)
    by_left = {x.ways[0]: x.id for x in drawn.values()}
    by_right = {x.ways[1]: x.id for x in drawn.values()}
    made = {}
    for x in drawn.values():
        left, right = _even(*x.bounds.lines)
        beside = [y for y in (by_right.get(x.ways[0]), by_left.get(x.ways[1])) if y is not None]
        successors = tuple(begins[x.bounds.left[-1], x.bounds.right[-1]])
        made[x.id] = MeasuredLanelet(x.id, left, right, None, successors, tuple(beside))
    return made


def _even(left: Floats, right: Floats) -> tuple[Floats, Floats]:
    """Two lines with points at the same shares of their lengths."""
    shares = []
    for line in (left, right):
        way = way_along(line)
        shares.append(way / max(float(way[-1]), 1e-9))
    at = np.union1d(np.round(shares[0], 9), np.round(shares[1], 9))
    one, other = (
        np.stack([np.interp(at, share, line[:, k]) for k in range(2)], axis=1)
        for share, line in zip(shares, (left, right), strict=True)
    )
    return one, other


LANELETS = "laneletId"


def read_exid(folder: Path, name: str, strict: bool = True) -> Recording:
    """Recording ``name`` of ``folder``; unless ``strict``, bad vehicles are left out.

    Raises ``InputError`` that names file, element, value and rule.
    """
    about, rate = read_recording_meta(folder, name)
    meta = read_vehicles(folder, name)
    tracks, notes = read_samples(folder, name, {LANELETS: "list"}, strict)
    meta, tracks, start, left_out = usable(meta, tracks, "trackId", strict, check_cells)
    notes += (*left_out, *check_velocities(tracks))
    path = _map_of(folder, int(about["locationId"][0]), about)
    chart = read_osm(path, (about["xUtmOrigin"][0], about["yUtmOrigin"][0]))
    not_read = (*not_read_note(path, chart.unread, strict), *ignored_column_notes(folder, name, strict))
    traffic = traffic_of(name, rate, meta, tracks, start, (*notes, *chart.notes, *not_read))
    recording = place_traffic(traffic, network_of(path, chart.lanelets, strict))
    stands = reliable_part(recording, strict, partial(check_plausible, tracks))
    return with_notes(stands, _check_lanelets(tracks, recording, path))


def _check_lanelets(tracks: ColumnTable, recording: Recording, path: Path) -> Iterator[str]:
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
    lane_masks: Integers = masks[which]
    other = (
        (lane_masks != 0) & (recording.lane >= 0) & ((lane_masks >> np.maximum(recording.lane, 0)) & 1 == 0)
    )
    advice = f"do {path.name} and the positions fit?"
    yield from note_if_rare(tracks, other, "laneletId", "not the lane of the box's middle", advice)


def maps_near(folder: Path) -> list[Path]:
    """The .osm files that a recording of ``folder`` may be on."""
    for place in (folder, *(x / name for x in (folder, folder.parent) for name in ("maps", "lanelets"))):
        maps = sorted(place.glob("*.osm") if place == folder else place.rglob("*.osm"))
        if maps:
            return maps
    return []


def _map_of(folder: Path, location: int, about: ColumnTable) -> Path:
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


def names_lanelets(tracks: Path) -> bool:
    """Return whether samples have the lanelets of exiD; True of no file."""
    line = first_line(tracks)
    return not line or LANELETS in line.split(",")


def _find(path: Path) -> dict[str, Files]:
    recordings = find_recordings(path, with_ids=True, files=_files)
    return {name: x for name, x in recordings.items() if names_lanelets(x[-1])}


FORMAT = Format(
    "exiD",
    "the files of highD with a column recordingId, and maps in .osm",
    _find,
    partial(read_tracks, read_exid),
    RATE_AT,
)
