"""Recordings in the highD format (semantics §7; Krajewski et al., ITSC 2018), read and fully checked.

The format's own names mislead: ``width`` is a vehicle's length and ``height`` its width, (x, y) is
the upper-left corner of the box, and y grows down. Direction 1 drives towards -x on the upper lanes.
"""

import re
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.traffic.highd_checks import check_limits, check_plausible, check_sight
from roadproof.traffic.plausible import SHARE
from roadproof.traffic.recording import (
    Floats,
    Integers,
    Lane,
    Masks,
    Recording,
    beside_by_order,
    occupy_bands,
    with_notes,
)
from roadproof.traffic.table import Kind, Table, read_table


def _names(*lines: str) -> tuple[str, ...]:
    return tuple(" ".join(lines).split())


RECORDING_COLUMNS = _names(
    "id frameRate locationId speedLimit month weekDay startTime duration totalDrivenDistance totalDrivenTime",
    "numVehicles numCars numTrucks upperLaneMarkings lowerLaneMarkings",
)
VEHICLE_COLUMNS = _names(
    "id width height initialFrame finalFrame numFrames class drivingDirection traveledDistance",
    "minXVelocity maxXVelocity meanXVelocity minDHW minTHW minTTC numLaneChanges",
)
SAMPLE_COLUMNS = _names(
    "frame id x y width height xVelocity yVelocity xAcceleration yAcceleration frontSightDistance",
    "backSightDistance dhw thw ttc precedingXVelocity precedingId followingId leftPrecedingId",
    "leftAlongsideId leftFollowingId rightPrecedingId rightAlongsideId rightFollowingId laneId",
)
UPPER, LOWER = 1, 2
"""Driving directions: on the upper lanes towards -x, on the lower ones towards +x."""

_RECORDING_KINDS: Mapping[str, Kind] = {
    "id": "integer",
    "frameRate": "number",
    "numVehicles": "integer",
    "numCars": "integer",
    "numTrucks": "integer",
    "upperLaneMarkings": "text",
    "lowerLaneMarkings": "text",
}
_VEHICLE_KINDS: Mapping[str, Kind] = {
    "id": "integer",
    "width": "number",
    "height": "number",
    "initialFrame": "integer",
    "finalFrame": "integer",
    "numFrames": "integer",
    "class": "text",
    "drivingDirection": "integer",
}
SAMPLE_KINDS: Mapping[str, Kind] = {
    "frame": "integer",
    "id": "integer",
    "x": "number",
    "y": "number",
    "width": "number",
    "height": "number",
    "xVelocity": "number",
    "yVelocity": "number",
    "xAcceleration": "number",
    "yAcceleration": "number",
    "laneId": "integer",
}


def find_recordings(folder: Path) -> tuple[str, ...]:
    """The names (01, 02, …) of the highD recordings in ``folder``, in order.

    A recording counts when any one of its three files is there, so that a missing file is an error
    when it is read and not a recording that silently is not counted.
    """
    if not folder.is_dir():
        raise InputError(f"recordings={folder}: not a folder; name the folder that holds XX_tracks.csv")
    pattern = re.compile(r"(\d+)_(?:recordingMeta|tracksMeta|tracks)\.csv")
    names = {match[1] for path in folder.iterdir() if (match := pattern.fullmatch(path.name))}
    if not names:
        raise InputError(f"recordings={folder}: no XX_tracks.csv in it; name the folder of the highD files")
    return tuple(sorted(names, key=lambda name: (int(name), name)))


def read_highd(folder: Path, name: str) -> Recording:
    """Recording ``name`` of ``folder``, in the coordinates of semantics §2.

    Raises ``InputError`` that names file, row, column, value and rule for anything that does not fit;
    what is odd but usable is in ``Recording.notes``.
    """
    rate, lanes, counts = _read_recording(folder / f"{name}_recordingMeta.csv", name)
    meta = _read_vehicles(folder / f"{name}_tracksMeta.csv", counts)
    tracks = read_table(folder / f"{name}_tracks.csv", SAMPLE_COLUMNS, SAMPLE_KINDS)
    tracks, notes = _in_order(tracks)
    start = _match_vehicles(meta, tracks)
    sizes = np.diff(start)
    _check_boxes(meta, tracks, start)
    check_limits(tracks)

    direction = np.repeat(meta["drivingDirection"], sizes)
    up = direction == UPPER
    sign = np.where(up, -1.0, 1.0)
    length, width = tracks["width"], tracks["height"]
    # Rounding undoes what binary floats add: sums of the file's decimals are decimals again.
    s = np.where(up, -tracks["x"], np.round(tracks["x"] + length, 6))
    d = np.where(up, np.round(tracks["y"] + width, 6), -tracks["y"])
    _check_direction(meta, tracks, s, start)
    occupancy, lane = occupy_bands(lanes, direction, d, width)
    recording = Recording(
        name=name,
        rate=rate,
        lanes=lanes,
        beside=beside_by_order(lanes),
        vehicle_id=meta["id"],
        direction=meta["drivingDirection"],
        kind=meta["class"].astype(np.str_),
        length=meta["width"],
        width=meta["height"],
        first_frame=meta["initialFrame"],
        start=start,
        s=s,
        d=d,
        v_lon=sign * tracks["xVelocity"],
        v_lat=-sign * tracks["yVelocity"],
        a_lon=sign * tracks["xAcceleration"],
        a_lat=-sign * tracks["yAcceleration"],
        occupancy=occupancy,
        lane=lane,
        zones=(occupancy != 0).astype(np.uint32),
        notes=notes,
    )
    more = check_plausible(recording, tracks)
    more += _check_lanes(tracks, lanes, lane, occupancy, start)
    return with_notes(recording, (*more, *check_sight(meta, tracks, SAMPLE_COLUMNS, UPPER)))


def lanes_of_markings(upper: tuple[float, ...], lower: tuple[float, ...]) -> tuple[Lane, ...]:
    """Lanes from the y values of the markings; a lane's name is its laneId (semantics §7)."""
    bands = [Lane(str(k), UPPER, (y, z)) for k, (y, z) in enumerate(pairwise(upper), start=2)]
    first = len(upper) + 2
    bands += [Lane(str(k), LOWER, (-z, -y)) for k, (y, z) in enumerate(pairwise(lower), start=first)]
    return tuple(bands)


def _read_recording(path: Path, name: str) -> tuple[int, tuple[Lane, ...], Mapping[str, int]]:
    meta = read_table(path, RECORDING_COLUMNS, _RECORDING_KINDS)
    if meta.rows != 1:
        raise InputError(f"{path}: {meta.rows} rows; one recording has one row of meta data")
    meta.require(meta["id"] == int(name), "id", f"the name of the file says recording {name}")
    rate = meta["frameRate"][0]
    if not (0 < rate <= 1000 and rate == int(rate)):
        raise meta.refuse(0, "frameRate", "a whole number of frames a second is needed")
    for column in ("numVehicles", "numCars", "numTrucks"):
        meta.require(meta[column] >= 0, column, "a count is never negative")
    if meta["numVehicles"][0] != meta["numCars"][0] + meta["numTrucks"][0]:
        raise meta.refuse(0, "numVehicles", "must be numCars + numTrucks")
    upper = _read_markings(meta, "upperLaneMarkings")
    lower = _read_markings(meta, "lowerLaneMarkings")
    if upper[-1] > lower[0]:
        raise meta.refuse(0, "lowerLaneMarkings", f"must lie below the last upper marking {upper[-1]}")
    return (
        int(rate),
        lanes_of_markings(upper, lower),
        {"Car": meta["numCars"][0], "Truck": meta["numTrucks"][0]},
    )


def _read_markings(meta: Table, column: str) -> tuple[float, ...]:
    try:
        values = tuple(float(part) for part in str(meta[column][0]).strip().strip(";").split(";"))
    except ValueError:
        raise meta.refuse(0, column, "y values joined by ';' are needed") from None
    if len(values) < 2 or not np.isfinite(values).all() or (np.diff(values) <= 0).any():
        raise meta.refuse(
            0, column, "at least two finite y values, each greater than the one before, are needed"
        )
    return values


def _read_vehicles(path: Path, counts: Mapping[str, int]) -> Table:
    meta = read_table(path, VEHICLE_COLUMNS, _VEHICLE_KINDS)
    order = np.argsort(meta["id"], kind="stable")
    repeated = np.zeros(meta.rows, bool)
    repeated[order[1:]] = np.diff(meta["id"][order]) == 0
    meta.require(~repeated, "id", "a vehicle has one row")
    meta.require(meta["id"] > 0, "id", "an id is greater than zero, which stands for no vehicle")
    for column in ("width", "height"):
        meta.require(meta[column] > 0, column, "the size of a vehicle is greater than zero")
    meta.require(meta["initialFrame"] >= 0, "initialFrame", "a frame is never negative")
    frames = meta["finalFrame"] - meta["initialFrame"] + 1
    meta.require(
        meta["finalFrame"] >= meta["initialFrame"], "finalFrame", "must not come before initialFrame"
    )
    meta.require(meta["numFrames"] == frames, "numFrames", "must be finalFrame - initialFrame + 1")
    meta.require(np.isin(meta["drivingDirection"], (UPPER, LOWER)), "drivingDirection", "must be 1 or 2")
    kinds = meta["class"].astype(np.str_)
    meta.require(np.isin(kinds, list(counts)), "class", f"must be {' or '.join(counts)}")
    for kind, expected in counts.items():
        found = int(np.count_nonzero(kinds == kind))
        if found != expected:
            raise InputError(
                f"{path}: {found} vehicles of class {kind}, but the recordingMeta file counts {expected}"
            )
    columns = {name: values[order] for name, values in meta.columns.items()}
    return Table(path, columns, meta.rows, order)


def _in_order(tracks: Table) -> tuple[Table, tuple[str, ...]]:
    """The samples by vehicle and frame, each (frame, id) once."""
    ids, frames = tracks["id"], tracks["frame"]
    same = np.diff(ids) == 0
    if ((np.diff(ids) > 0) | (same & (np.diff(frames) > 0))).all():
        return tracks, ()
    order = np.lexsort((np.arange(tracks.rows), frames, ids))
    repeated = np.zeros(tracks.rows, bool)
    repeated[order[1:]] = (np.diff(ids[order]) == 0) & (np.diff(frames[order]) == 0)
    tracks.require(~repeated, "frame", "vehicle and frame occur together once")
    columns = {name: values[order] for name, values in tracks.columns.items()}
    ordered = Table(tracks.path, columns, tracks.rows, order)
    return ordered, (f"{tracks.path.name}: rows were not in order of id and frame; they were sorted",)


def _match_vehicles(meta: Table, tracks: Table) -> Integers:
    """Where each vehicle's samples start; both files must tell the same of vehicles and frames."""
    first = np.flatnonzero(np.diff(tracks["id"], prepend=-1) != 0)
    start = np.append(first, tracks.rows)
    ids, counts = tracks["id"][first], np.diff(start)
    tracks.require(tracks["id"] > 0, "id", "an id is greater than zero, which stands for no vehicle")
    tracks_only = np.setdiff1d(ids, meta["id"])
    if len(tracks_only):
        raise InputError(f"{tracks.path}, column id={tracks_only[0]}: the vehicle is not in {meta.path.name}")
    meta.require(np.isin(meta["id"], ids), "id", f"the vehicle has no rows in {tracks.path.name}")
    gaps = np.flatnonzero((np.diff(tracks["id"]) == 0) & (np.diff(tracks["frame"]) != 1))
    if len(gaps):
        before, after = tracks["frame"][gaps[0]], tracks["frame"][gaps[0] + 1]
        vehicle = tracks["id"][gaps[0]]
        where = f"{tracks.path}, vehicle id={vehicle}, frame={after}"
        raise InputError(f"{where}: the frame before it is {before}; the frames of a vehicle have no gaps")
    for column, found in (("initialFrame", tracks["frame"][first]), ("numFrames", counts)):
        wrong = np.flatnonzero(meta[column] != found)
        if len(wrong):
            k = wrong[0]
            where = f"{meta.path}, vehicle id={meta['id'][k]}, column {column}={meta[column][k]}"
            raise InputError(f"{where}: {tracks.path.name} has {found[k]}; the files must agree")
    return start


def _check_boxes(meta: Table, tracks: Table, start: Integers) -> None:
    for column in ("width", "height"):
        expected = np.repeat(meta[column], np.diff(start))
        tracks.require(tracks[column] > 0, column, "the size of a vehicle is greater than zero")
        same = np.abs(tracks[column] - expected) < 0.015  # both files round to hundredths
        tracks.require(same, column, f"{meta.path.name} has another size for the vehicle")


def _check_direction(meta: Table, tracks: Table, s: Floats, start: Integers) -> None:
    """No vehicle may end further back than its own length from where it began."""
    backwards = s[start[1:] - 1] - s[start[:-1]] < -meta["width"]
    if backwards.any():
        k = int(np.argmax(backwards))
        where = (
            f"{meta.path}, vehicle id={meta['id'][k]}, column drivingDirection={meta['drivingDirection'][k]}"
        )
        raise InputError(f"{where}: in {tracks.path.name} the vehicle moves the other way")


def _check_lanes(
    tracks: Table, lanes: tuple[Lane, ...], lane: Integers, occupancy: Masks, start: Integers
) -> tuple[str, ...]:
    """Markings must fit most vehicles: each is at least once on a lane, and laneId is the centre's band."""
    notes: tuple[str, ...] = ()
    on_road = np.logical_or.reduceat(occupancy != 0, start[:-1])
    outside = int(np.count_nonzero(~on_road))
    if outside:
        row = int(start[np.argmin(on_road)])
        where = f"{tracks.path}, vehicle id={tracks['id'][row]}, column y={tracks['y'][row]}"
        if outside > SHARE * len(on_road):
            raise InputError(
                f"{where}: on no lane of its direction, like {outside} vehicles; the markings do not fit"
            )
        notes = (f"{where}: on no lane of its direction at any time, like {outside} vehicles",)
    names = np.array([int(x.name) for x in lanes] + [0])
    other = names[lane] != tracks["laneId"]
    differ = int(np.count_nonzero(other))
    if differ:
        cell = tracks.cell(int(np.argmax(other)), "laneId")
        rule = f"laneId is not the lane of the box's centre in {differ} rows of {tracks.rows}"
        if differ > SHARE * tracks.rows:
            raise InputError(f"{tracks.path}, {cell}: {rule}; do markings and positions fit?")
        notes += (f"{tracks.path.name}, {cell}: {rule}",)
    return notes
