"""Recordings in the exiD format (semantics §7; Moers et al., IV 2022), on Lanelet2 maps.

Positions are the middles of boxes, y grows up, and headings are in degrees, counter-clockwise from x. The
map of a location is an .osm file in the folder of the recording, or in ``maps`` or ``lanelets`` beside it
or beside its parent, whose name has the number of the location; NAME_zones.toml beside NAME.osm may say
which lanelets are of ramps. Further columns are passed over, as versions of the format differ in them.
"""

import re
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import numpy as np

from roadproof.recordings.formats.contradictions import contradictions, seldom
from roadproof.recordings.formats.lanelets import ZONES_ENDING, network_of
from roadproof.recordings.formats.measured_roads import MeasuredTraffic, place_traffic
from roadproof.recordings.formats.osm import read_osm
from roadproof.recordings.formats.plausible import LARGEST_ACCELERATION, LARGEST_SIZE, LARGEST_SPEED, check
from roadproof.recordings.formats.recording import Integers, Recording, with_notes
from roadproof.recordings.formats.source import Files, Format, beside
from roadproof.recordings.formats.table import Table, kinds_of, read_named
from roadproof.recordings.formats.tracks import (
    RATE_AT,
    by_id,
    files_of,
    find_recordings,
    in_order,
    match_vehicles,
    rate_of,
    read_tracks,
)

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


def read_exid(folder: Path, name: str) -> Recording:
    """Recording ``name`` of ``folder``. Raises ``InputError`` that names file, element, value and rule."""
    about = read_named(folder / f"{name}_recordingMeta.csv", RECORDING_KINDS)
    rate = rate_of(about, "recordingId", int(name), f"the file is of recording {name}")
    meta = _read_vehicles(folder / f"{name}_tracksMeta.csv", int(name))
    tracks, notes = in_order(read_named(folder / f"{name}_tracks.csv", SAMPLE_KINDS), "trackId")
    tracks.require(tracks["recordingId"] == int(name), "recordingId", f"the file is of recording {name}")
    start = match_vehicles(meta, tracks, "trackId", 0)
    _check_cells(tracks)
    notes += tuple(_check_velocities(tracks))
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
    recording = place_traffic(traffic, network_of(path, lanelets))
    more = (*_check_plausible(tracks, recording), *_check_lanelets(tracks, recording, path))
    return with_notes(recording, more)


def _read_vehicles(path: Path, recording: int) -> Table:
    meta = read_named(path, VEHICLE_KINDS)
    meta.require(meta["recordingId"] == recording, "recordingId", f"the file is of recording {recording}")
    for column in ("width", "length"):
        size = meta[column]
        meta.require(size > 0, column, "the size of a vehicle is greater than zero; people have none")
        meta.require(size <= LARGEST_SIZE, column, f"no vehicle is larger than {LARGEST_SIZE:g} m")
    return by_id(meta, "trackId")


def _check_cells(tracks: Table) -> None:
    """No cell may say what no vehicle does."""
    tracks.require_within(LARGEST_PLACE, "xCenter", "yCenter")
    tracks.require_within(LARGEST_SPEED, "xVelocity", "yVelocity", "lonVelocity", "latVelocity")
    tracks.require_within(LARGEST_ACCELERATION, "xAcceleration", "yAcceleration")
    tracks.require_within(360.0, "heading")


def _check_velocities(tracks: Table) -> Iterator[str]:
    """lonVelocity is the velocity along the heading; where it is not, headings or axes are others."""
    heading = np.radians(tracks["heading"])
    along = tracks["xVelocity"] * np.cos(heading) + tracks["yVelocity"] * np.sin(heading)
    wrong = np.abs(along - tracks["lonVelocity"]) > 0.5
    rule, advice = "not the velocity along the heading", "does y grow up, and is heading in degrees?"
    yield from seldom(tracks, wrong, "lonVelocity", rule, advice)


def _check_plausible(tracks: Table, recording: Recording) -> Iterator[str]:
    """Notes on what the file contradicts itself in. Raises ``InputError`` where that is too much."""

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
