"""Recordings in the highD format (semantics §7; Krajewski et al., ITSC 2018), read and fully checked.

The format's own names mislead: ``width`` is a vehicle's length and ``height`` its width, (x, y) is
the upper-left corner of the box, and y grows down. Direction 1 drives towards -x on the upper lanes.
"""

from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.recordings.formats.blockwise import blockwise
from roadproof.recordings.formats.highd_checks import (
    check_boxes,
    check_direction,
    check_lanes,
    check_limits,
    check_plausible,
    check_sight,
)
from roadproof.recordings.formats.recording import Bools, Floats, Lane, Recording, with_notes
from roadproof.recordings.formats.source import Files, Format, rate_in_meta
from roadproof.recordings.formats.straight import StraightRoad, of_bands, of_road, place
from roadproof.recordings.formats.table import Table, kinds_of, names_in, read_table
from roadproof.recordings.formats.tracks import (
    by_id,
    files_of,
    find_recordings,
    in_order,
    match_vehicles,
    rate_of,
)
from roadproof.world.models import load_recorded_road

RECORDING_COLUMNS = names_in(
    "id frameRate locationId speedLimit month weekDay startTime duration totalDrivenDistance totalDrivenTime",
    "numVehicles numCars numTrucks upperLaneMarkings lowerLaneMarkings",
)
VEHICLE_COLUMNS = names_in(
    "id width height initialFrame finalFrame numFrames class drivingDirection traveledDistance",
    "minXVelocity maxXVelocity meanXVelocity minDHW minTHW minTTC numLaneChanges",
)
SAMPLE_COLUMNS = names_in(
    "frame id x y width height xVelocity yVelocity xAcceleration yAcceleration frontSightDistance",
    "backSightDistance dhw thw ttc precedingXVelocity precedingId followingId leftPrecedingId",
    "leftAlongsideId leftFollowingId rightPrecedingId rightAlongsideId rightFollowingId laneId",
)
UPPER, LOWER = 1, 2
"""Driving directions: on the upper lanes towards -x, on the lower ones towards +x."""

_RECORDING_KINDS = kinds_of(
    integer="id numVehicles numCars numTrucks",
    number="frameRate",
    text="upperLaneMarkings lowerLaneMarkings",
)
_VEHICLE_KINDS = kinds_of(
    integer="id initialFrame finalFrame numFrames drivingDirection",
    number="width height",
    text="class",
)
SAMPLE_KINDS = kinds_of(
    integer="frame id laneId",
    number="x y width height xVelocity yVelocity xAcceleration yAcceleration",
)


def find_highd(path: Path) -> dict[str, Files]:
    """The highD recordings (01, 02, …) of a folder, in order, or that of one of its files.

    A recording counts when any one of its three files is there.
    """
    return find_recordings(path, False, highd_files)


def highd_files(folder: Path, name: str) -> Files:
    """The files that recording ``name`` of ``folder`` is read from."""
    road = folder / f"{name}_road.toml"
    return (*((road,) if road.is_file() else ()), *files_of(folder, name))


def read_highd(folder: Path, name: str) -> Recording:
    """Recording ``name`` of ``folder``, in the coordinates of semantics §2.

    ``XX_road.toml`` beside the files gives the lanelets of one direction in place of its markings.
    Raises ``InputError`` that names file, row, column, value and rule for anything that does not fit;
    what is odd but usable is in ``Recording.notes``.
    """
    rate, bands, counts = _read_recording(folder / f"{name}_recordingMeta.csv", name)
    meta = _read_vehicles(folder / f"{name}_tracksMeta.csv", counts)
    tracks = read_table(folder / f"{name}_tracks.csv", SAMPLE_COLUMNS, SAMPLE_KINDS)
    tracks, notes = in_order(tracks, "id")
    start = match_vehicles(meta, tracks, "id", 1)
    sizes = np.diff(start)
    check_boxes(meta, tracks, start)
    check_limits(tracks)
    road, way = _read_road(folder / f"{name}_road.toml", bands)

    direction = np.repeat(meta["drivingDirection"], sizes)
    up = direction == UPPER
    length, width = tracks["width"], tracks["height"]
    # Rounding undoes what binary floats add: sums of the file's decimals are decimals again.
    s = blockwise(lambda up, x, length: np.where(up, -x, np.round(x + length, 6)), up, tracks["x"], length)
    d = blockwise(lambda up, y, width: np.where(up, np.round(y + width, 6), -y), up, tracks["y"], width)
    check_direction(meta, tracks, s, start)
    placed = place(road, direction, s, d, length, width)
    recording = Recording(
        name=name,
        rate=rate,
        **vars(road),
        vehicle_id=meta["id"],
        direction=meta["drivingDirection"],
        kind=meta["class"].astype(np.str_),
        length=meta["width"],
        width=meta["height"],
        first_frame=meta["initialFrame"],
        start=start,
        s=s,
        d=d,
        v_lon=blockwise(_turned, up, tracks["xVelocity"]),
        v_lat=blockwise(_turned, ~up, tracks["yVelocity"]),
        a_lon=blockwise(_turned, up, tracks["xAcceleration"]),
        a_lat=blockwise(_turned, ~up, tracks["yAcceleration"]),
        notes=notes,
        **vars(placed),
    )
    more = (*check_plausible(recording, tracks), *check_lanes(tracks, recording, direction != way))
    return with_notes(recording, (*more, *check_sight(meta, tracks, SAMPLE_COLUMNS, UPPER)))


def _turned(backwards: Bools, values: Floats) -> Floats:
    """The values, with the other sign where what they are of goes ``backwards``."""
    return np.where(backwards, -values, values)


def _read_road(path: Path, bands: tuple[Lane, ...]) -> tuple[StraightRoad, int]:
    """The lanes of both directions, and that of which a file gives them, 0 for none."""
    if not path.is_file():
        return of_bands(bands), 0
    road, way = load_recorded_road(path, (LOWER, UPPER))
    return of_road(road, way, path, (x for x in bands if x.direction != way)), way


def lanes_of_markings(upper: tuple[float, ...], lower: tuple[float, ...]) -> tuple[Lane, ...]:
    """Lanes from the y values of the markings; a lane's name is its laneId (semantics §7)."""
    bands = [Lane(str(k), UPPER, (y, z)) for k, (y, z) in enumerate(pairwise(upper), start=2)]
    first = len(upper) + 2
    bands += [Lane(str(k), LOWER, (-z, -y)) for k, (y, z) in enumerate(pairwise(lower), start=first)]
    return tuple(bands)


def _read_recording(path: Path, name: str) -> tuple[int, tuple[Lane, ...], Mapping[str, int]]:
    meta = read_table(path, RECORDING_COLUMNS, _RECORDING_KINDS)
    rate = rate_of(meta, "id", int(name), f"the name of the file says recording {name}")
    for column in ("numVehicles", "numCars", "numTrucks"):
        meta.require(meta[column] >= 0, column, "a count is never negative")
    if meta["numVehicles"][0] != meta["numCars"][0] + meta["numTrucks"][0]:
        raise meta.refuse(0, "numVehicles", "must be numCars + numTrucks")
    upper = _read_markings(meta, "upperLaneMarkings")
    lower = _read_markings(meta, "lowerLaneMarkings")
    if upper[-1] > lower[0]:
        raise meta.refuse(0, "lowerLaneMarkings", f"must lie below the last upper marking {upper[-1]}")
    return (
        rate,
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
    meta.require(meta["id"] > 0, "id", "an id is greater than zero, which stands for no vehicle")
    for column in ("width", "height"):
        meta.require(meta[column] > 0, column, "the size of a vehicle is greater than zero")
    ordered = by_id(meta, "id")
    meta.require(np.isin(meta["drivingDirection"], (UPPER, LOWER)), "drivingDirection", "must be 1 or 2")
    kinds = meta["class"].astype(np.str_)
    meta.require(np.isin(kinds, list(counts)), "class", f"must be {' or '.join(counts)}")
    for kind, expected in counts.items():
        found = int(np.count_nonzero(kinds == kind))
        if found != expected:
            raise InputError(
                f"{path}: {found} vehicles of class {kind}, but the recordingMeta file counts {expected}"
            )
    return ordered


def _read(files: Files) -> Recording:
    return read_highd(files[-1].parent, files[-1].name.removesuffix("_tracks.csv"))


FORMAT = Format(
    "highD", "XX_recordingMeta.csv, XX_tracksMeta.csv and XX_tracks.csv", find_highd, _read, rate_in_meta
)
