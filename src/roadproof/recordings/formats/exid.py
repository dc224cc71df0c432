"""Recordings in the exiD format (semantics §7; Moers et al., IV 2022), on Lanelet2 maps.

Positions are the middles of boxes, y grows up, and headings are in degrees, counter-clockwise from x. The
map of a location is an .osm file in the folder of the recording, or in ``maps`` or ``lanelets`` beside it
or beside its parent, whose name has the number of the location; NAME_zones.toml beside NAME.osm may say
which lanelets are of ramps. Further columns are passed over, as versions of the format differ in them.
"""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.recordings.formats.contradictions import contradictions, nowhere, seldom
from roadproof.recordings.formats.lanelets import ZONES_ENDING, network_of, read_said
from roadproof.recordings.formats.measured_roads import MeasuredTraffic, place_traffic
from roadproof.recordings.formats.osm import read_osm
from roadproof.recordings.formats.plausible import (
    LARGEST_ACCELERATION,
    LARGEST_SIZE,
    LARGEST_SPEED,
    Implausible,
)
from roadproof.recordings.formats.recording import Integers, Recording, with_notes
from roadproof.recordings.formats.source import (
    TRACK_FILES,
    Files,
    Format,
    beside,
    first_line,
    rate_in_meta,
    with_suffix,
)
from roadproof.recordings.formats.table import Kind, Table, read_named
from roadproof.recordings.formats.tracks import in_order, match_vehicles

RECORDING_KINDS: Mapping[str, Kind] = {
    "recordingId": "integer",
    "locationId": "integer",
    "frameRate": "number",
    "xUtmOrigin": "number",
    "yUtmOrigin": "number",
}
VEHICLE_KINDS: Mapping[str, Kind] = {
    "recordingId": "integer",
    "trackId": "integer",
    "initialFrame": "integer",
    "finalFrame": "integer",
    "numFrames": "integer",
    "width": "number",
    "length": "number",
    "class": "text",
}
SAMPLE_KINDS: Mapping[str, Kind] = {
    "recordingId": "integer",
    "trackId": "integer",
    "frame": "integer",
    "xCenter": "number",
    "yCenter": "number",
    "heading": "number",
    "xVelocity": "number",
    "yVelocity": "number",
    "xAcceleration": "number",
    "yAcceleration": "number",
    "lonVelocity": "number",
    "latVelocity": "number",
    "laneletId": "list",
}
LARGEST_PLACE = 10_000.0


def read_exid(folder: Path, name: str) -> Recording:
    """Recording ``name`` of ``folder``. Raises ``InputError`` that names file, element, value and rule."""
    about = read_named(folder / f"{name}_recordingMeta.csv", RECORDING_KINDS)
    if about.rows != 1:
        raise InputError(f"{about.path}: {about.rows} rows; one recording has one row of meta data")
    about.require(about["recordingId"] == int(name), "recordingId", f"the file is of recording {name}")
    rate = about["frameRate"][0]
    if not (0 < rate <= 1000 and rate == int(rate)):
        raise about.refuse(0, "frameRate", "a whole number of frames a second is needed")
    meta = _read_vehicles(folder / f"{name}_tracksMeta.csv", int(name))
    tracks, notes = in_order(read_named(folder / f"{name}_tracks.csv", SAMPLE_KINDS), "trackId")
    tracks.require(tracks["recordingId"] == int(name), "recordingId", f"the file is of recording {name}")
    start = match_vehicles(meta, tracks, "trackId", 0)
    _check_cells(tracks)
    notes += tuple(_check_velocities(tracks))
    path = _map_of(folder, int(about["locationId"][0]), about)
    lanelets, told = read_osm(path, (about["xUtmOrigin"][0], about["yUtmOrigin"][0]))
    said = read_said(path.with_name(f"{path.stem}{ZONES_ENDING}"), lanelets)
    heading = np.radians(tracks["heading"])
    traffic = MeasuredTraffic(
        name=name,
        rate=int(rate),
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
    recording = place_traffic(traffic, network_of(path, lanelets, said))
    more = (*_check_plausible(tracks, recording), *_check_lanelets(tracks, recording, path))
    return with_notes(recording, more)


def _read_vehicles(path: Path, recording: int) -> Table:
    meta = read_named(path, VEHICLE_KINDS)
    meta.require(meta["recordingId"] == recording, "recordingId", f"the file is of recording {recording}")
    order = np.argsort(meta["trackId"], kind="stable")
    repeated = np.zeros(meta.rows, bool)
    repeated[order[1:]] = np.diff(meta["trackId"][order]) == 0
    meta.require(~repeated, "trackId", "a vehicle has one row")
    for column in ("width", "length"):
        size = meta[column]
        meta.require(size > 0, column, "the size of a vehicle is greater than zero; people have none")
        meta.require(size <= LARGEST_SIZE, column, f"no vehicle is larger than {LARGEST_SIZE:g} m")
    meta.require(meta["initialFrame"] >= 0, "initialFrame", "a frame is never negative")
    frames = meta["finalFrame"] - meta["initialFrame"] + 1
    meta.require(frames > 0, "finalFrame", "must not come before initialFrame")
    meta.require(meta["numFrames"] == frames, "numFrames", "must be finalFrame - initialFrame + 1")
    columns = {name: values[order] for name, values in meta.columns.items()}
    return Table(path, columns, meta.rows, order)


def _check_cells(tracks: Table) -> None:
    """No cell may say what no vehicle does."""
    limits: dict[float, tuple[str, ...]] = {
        LARGEST_PLACE: ("xCenter", "yCenter"),
        LARGEST_SPEED: ("xVelocity", "yVelocity", "lonVelocity", "latVelocity"),
        LARGEST_ACCELERATION: ("xAcceleration", "yAcceleration"),
        360.0: ("heading",),
    }
    for most, columns in limits.items():
        for column in columns:
            rule = f"must lie between {-most:g} and {most:g}"
            tracks.require(np.abs(tracks[column]) <= most, column, rule)


def _check_velocities(tracks: Table) -> Iterator[str]:
    """lonVelocity is the velocity along the heading; where it is not, headings or axes are others."""
    heading = np.radians(tracks["heading"])
    along = tracks["xVelocity"] * np.cos(heading) + tracks["yVelocity"] * np.sin(heading)
    wrong = np.abs(along - tracks["lonVelocity"]) > 0.5
    rule, advice = "not the velocity along the heading", "does y grow up, and is heading in degrees?"
    yield from seldom(tracks, wrong, "lonVelocity", rule, advice)


def _check_plausible(tracks: Table, recording: Recording) -> Iterator[str]:
    """Notes on what the file contradicts itself in. Raises ``InputError`` where that is too much."""

    def at(doubt: Implausible) -> str:
        return f"{tracks.cell(doubt.row, 'frame')}, trackId={tracks['trackId'][doubt.row]}"

    yield from contradictions(tracks.path, recording, at)
    yield from nowhere(tracks.path, recording, lambda row: tracks.cell(row, "trackId"), "lanelet of the map")


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


def _find(path: Path) -> dict[str, Files]:
    found: dict[str, Files] = {}
    for file in with_suffix(path, ".csv"):
        match = TRACK_FILES.fullmatch(file.name)
        if match is not None and "recordingId" in first_line(file).split(","):
            name = match[1]
            maps = [x for osm in maps_near(file.parent) for x in (*beside(osm, ZONES_ENDING), osm)]
            meta = (file.with_name(f"{name}_{x}.csv") for x in ("recordingMeta", "tracksMeta", "tracks"))
            found[name] = (*maps, *meta)
    return dict(sorted(found.items(), key=lambda entry: (int(entry[0]), entry[0])))


def _read(files: Files) -> Recording:
    return read_exid(files[-1].parent, files[-1].name.removesuffix("_tracks.csv"))


FORMAT = Format(
    "exiD", "the files of highD with a column recordingId, and maps in .osm", _find, _read, rate_in_meta
)
