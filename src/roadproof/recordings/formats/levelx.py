"""What the recordings of exiD, inD, rounD and uniD have in common (levelXdata): tracks in the plane.

Positions are the middles of boxes, y grows up, and headings are in degrees, counter-clockwise from x.
lonVelocity is the velocity along the heading. Coordinates count from xUtmOrigin and yUtmOrigin. Columns are
found by name, and further ones are passed over, as versions of the formats differ in them.
"""

from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path

import numpy as np

from roadproof.recordings.formats.contradictions import contradictions, seldom
from roadproof.recordings.formats.measured_roads import MeasuredTraffic
from roadproof.recordings.formats.plausible import (
    LARGEST_ACCELERATION,
    LARGEST_SIZE,
    LARGEST_SPEED,
    ContradictionChecks,
)
from roadproof.recordings.formats.recording import Integers
from roadproof.recordings.formats.table import Kind, Table, kinds_of, read_named
from roadproof.recordings.formats.tracks import cells_of, in_order, match_vehicles, rate_of, vehicles_by_id

RECORDING_KINDS = kinds_of(integer="recordingId locationId", number="frameRate xUtmOrigin yUtmOrigin")
VEHICLE_KINDS = kinds_of(
    integer="recordingId trackId initialFrame finalFrame numFrames", number="width length", text="class"
)
SAMPLE_KINDS = kinds_of(
    integer="recordingId trackId frame",
    number="xCenter yCenter heading xVelocity yVelocity xAcceleration yAcceleration lonVelocity latVelocity",
)
LARGEST_PLACE = 10_000.0
TRUCK_BUS = "truck_bus"
"""A class of inD, which counts as a truck."""


def read_about(folder: Path, name: str) -> tuple[Table, int]:
    """The meta data of a recording and its rate. Raises ``InputError``."""
    about = read_named(folder / f"{name}_recordingMeta.csv", RECORDING_KINDS)
    return about, rate_of(about, "recordingId", int(name), f"the file is of recording {name}")


def read_vehicles(folder: Path, name: str) -> Table:
    """The vehicles of a recording by their ids. Raises ``InputError``."""
    meta = read_named(folder / f"{name}_tracksMeta.csv", VEHICLE_KINDS)
    meta.require(meta["recordingId"] == int(name), "recordingId", f"the file is of recording {int(name)}")
    return vehicles_by_id(meta, "trackId")


def read_samples(
    folder: Path, name: str, more: Mapping[str, Kind], strict: bool
) -> tuple[Table, tuple[str, ...]]:
    """The samples with ``more`` columns by vehicle and frame, and notes. Raises ``InputError``.

    Unless it is ``strict``, unreadable cells are left to ``check_cells``.
    """
    gaps = cells_of(SAMPLE_KINDS, ("recordingId", "trackId"), strict)
    tracks = read_named(folder / f"{name}_tracks.csv", {**SAMPLE_KINDS, **more}, gaps)
    tracks, notes = in_order(tracks, "trackId")
    tracks.require(tracks["recordingId"] == int(name), "recordingId", f"the file is of recording {name}")
    return tracks, notes


def check_cells(meta: Table, tracks: Table) -> Integers:
    """Where each vehicle's samples start; no cell may say what no vehicle is or does."""
    for column in ("width", "length"):
        size = meta[column]
        meta.require(size > 0, column, "the size of a vehicle is greater than zero; people have none")
        meta.require(size <= LARGEST_SIZE, column, f"no vehicle is larger than {LARGEST_SIZE:g} m")
    start = match_vehicles(meta, tracks, "trackId", 0)
    tracks.require_numbers(*(x for x, kind in SAMPLE_KINDS.items() if kind == "number"))
    tracks.require_within(LARGEST_PLACE, "xCenter", "yCenter")
    tracks.require_within(LARGEST_SPEED, "xVelocity", "yVelocity", "lonVelocity", "latVelocity")
    tracks.require_within(LARGEST_ACCELERATION, "xAcceleration", "yAcceleration")
    tracks.require_within(360.0, "heading")
    return start


def check_velocities(tracks: Table) -> Iterator[str]:
    """lonVelocity is the velocity along the heading; where it is not, headings or axes are others."""
    heading = np.radians(tracks["heading"])
    along = tracks["xVelocity"] * np.cos(heading) + tracks["yVelocity"] * np.sin(heading)
    wrong = np.abs(along - tracks["lonVelocity"]) > 0.5
    rule, advice = "not the velocity along the heading", "does y grow up, and is heading in degrees?"
    yield from seldom(tracks, wrong, "lonVelocity", rule, advice)


def traffic_of(
    name: str, rate: int, meta: Table, tracks: Table, start: Integers, notes: tuple[str, ...]
) -> MeasuredTraffic:
    """The vehicles in the plane; classes begin with a capital."""
    heading = np.radians(tracks["heading"])
    classes = meta["class"].astype(np.str_)
    kind = np.where(classes == TRUCK_BUS, "Truck", np.array([x.capitalize() for x in classes.tolist()]))
    return MeasuredTraffic(
        name=name,
        rate=rate,
        vehicle_id=meta["trackId"],
        kind=kind,
        length=meta["length"],
        width=meta["width"],
        first_frame=meta["initialFrame"],
        start=start,
        centre=np.stack((tracks["xCenter"], tracks["yCenter"]), axis=1),
        heading=heading,
        velocity=np.stack((tracks["xVelocity"], tracks["yVelocity"]), axis=1),
        acceleration=np.stack((tracks["xAcceleration"], tracks["yAcceleration"]), axis=1),
        notes=notes,
    )


def check_plausible(whole: Table, checks: ContradictionChecks, rows: Integers) -> Iterator[str]:
    """Notes on what the file contradicts itself in. Raises ``InputError`` where that is too much."""
    tracks = whole if len(rows) == whole.rows else whole.at(rows)

    def at(row: int, signal: str) -> str:
        return f"{tracks.cell(row, 'frame')}, trackId={tracks['trackId'][row]}"

    vehicle_at = partial(tracks.cell, column="trackId")
    return contradictions(tracks.path, checks, at, vehicle_at, "lanelet of the map")
