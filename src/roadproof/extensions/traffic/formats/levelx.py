"""The common part of the formats exiD, inD, rounD and uniD (levelXdata): tracks in the plane.

Positions are the middles of boxes, y grows up, and headings are in degrees, counter-clockwise from x.
lonVelocity is the velocity along the heading. Coordinates count from xUtmOrigin and yUtmOrigin. Columns are
found by name, and further ones are passed over, as versions of the formats differ in them.
"""

from collections.abc import Iterator, Mapping
from functools import partial
from pathlib import Path

import numpy as np

from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.content import columns_not_read_note
from roadproof.extensions.traffic.formats.contradictions import contradiction_notes, note_if_rare
from roadproof.extensions.traffic.formats.harmless_columns import LEVELX
from roadproof.extensions.traffic.formats.measured_roads import MeasuredTraffic
from roadproof.extensions.traffic.formats.plausible import (
    LARGEST_ACCELERATION,
    LARGEST_SIZE,
    LARGEST_SPEED,
    ContradictionChecks,
)
from roadproof.extensions.traffic.formats.recording import Floats, Integers
from roadproof.extensions.traffic.formats.source import first_line
from roadproof.extensions.traffic.formats.table import ColumnTable, Kind, kinds_of, read_named
from roadproof.extensions.traffic.formats.tracks import (
    cells_of,
    in_order,
    match_vehicles,
    rate_of,
    vehicles_by_id,
)

RECORDING_KINDS = kinds_of(integer="recordingId locationId", number="frameRate xUtmOrigin yUtmOrigin")
VEHICLE_KINDS = kinds_of(
    integer="recordingId trackId initialFrame finalFrame numFrames", number="width length", text="class"
)
SAMPLE_KINDS = kinds_of(
    integer="recordingId trackId frame",
    number="xCenter yCenter heading xVelocity yVelocity xAcceleration yAcceleration lonVelocity latVelocity",
)
LARGEST_PLACE = 10_000.0
_ROUNDED = 0.015
"""m; sizes in two files that round to hundredths differ by less."""
SIZES = ("length", "width")
TRUCK_BUS = "truck_bus"
"""A class of inD, which counts as a truck."""


def read_recording_meta(folder: Path, name: str) -> tuple[ColumnTable, Rate]:
    """The meta data of a recording and its rate. Raises ``InputError``."""
    about = read_named(folder / f"{name}_recordingMeta.csv", RECORDING_KINDS)
    return about, rate_of(about, "recordingId", int(name), f"the file is of recording {name}")


def ignored_column_notes(folder: Path, name: str, strict: bool) -> tuple[str, ...]:
    """Notes on columns that are not read and may have an effect, which are refused where it is ``strict``."""
    read = {
        "recordingMeta": RECORDING_KINDS,
        "tracksMeta": VEHICLE_KINDS,
        "tracks": (*SAMPLE_KINDS, *SIZES),
    }
    notes: tuple[str, ...] = ()
    for ending, columns in read.items():
        path = folder / f"{name}_{ending}.csv"
        notes += columns_not_read_note(path, first_line(path).split(","), columns, LEVELX, strict)
    return notes


def read_vehicles(folder: Path, name: str) -> ColumnTable:
    """The vehicles of a recording by their ids. Raises ``InputError``."""
    meta = read_named(folder / f"{name}_tracksMeta.csv", VEHICLE_KINDS)
    meta.require(meta["recordingId"] == int(name), "recordingId", f"the file is of recording {int(name)}")
    return vehicles_by_id(meta, "trackId")


def read_samples(
    folder: Path, name: str, more: Mapping[str, Kind], strict: bool
) -> tuple[ColumnTable, tuple[str, ...]]:
    """The samples with ``more`` columns by vehicle and frame, and notes. Raises ``InputError``.

    Unless it is ``strict``, unreadable cells are left to ``check_cells``.
    """
    gaps = cells_of(SAMPLE_KINDS, ("recordingId", "trackId"), strict)
    path = folder / f"{name}_tracks.csv"
    sizes: dict[str, Kind] = {x: "number" for x in SIZES if x in first_line(path).split(",")}
    tracks = read_named(path, {**SAMPLE_KINDS, **sizes, **more}, (*gaps, *(() if strict else sizes)))
    tracks, notes = in_order(tracks, "trackId")
    tracks.require(tracks["recordingId"] == int(name), "recordingId", f"the file is of recording {name}")
    return tracks, notes


def check_cells(meta: ColumnTable, tracks: ColumnTable) -> Integers:
    """Return where each vehicle's samples start; no cell may say what no vehicle is or does."""
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
    for column in (x for x in SIZES if x in tracks.columns):
        size = tracks[column]
        tracks.require((size >= 0) & (size <= LARGEST_SIZE), column, f"a size is 0 to {LARGEST_SIZE:g} m")
    return start


def check_velocities(tracks: ColumnTable) -> Iterator[str]:
    """lonVelocity is the velocity along the heading; where it is not, headings or axes are others."""
    heading = np.radians(tracks["heading"])
    along = tracks["xVelocity"] * np.cos(heading) + tracks["yVelocity"] * np.sin(heading)
    wrong = np.abs(along - tracks["lonVelocity"]) > 0.5
    rule, advice = "not the velocity along the heading", "does y grow up, and is heading in degrees?"
    yield from note_if_rare(tracks, wrong, "lonVelocity", rule, advice)


def traffic_of(
    name: str, rate: Rate, meta: ColumnTable, tracks: ColumnTable, start: Integers, notes: tuple[str, ...]
) -> MeasuredTraffic:
    """The vehicles in the plane; classes begin with a capital."""
    heading = np.radians(tracks["heading"])
    (length, width), size_notes = _sizes(meta, tracks, start)
    classes = meta["class"].astype(np.str_)
    kind = np.where(classes == TRUCK_BUS, "Truck", np.array([x.capitalize() for x in classes.tolist()]))
    return MeasuredTraffic(
        name=name,
        rate=rate,
        vehicle_id=meta["trackId"],
        kind=kind,
        length=length,
        width=width,
        first_frame=meta["initialFrame"],
        start=start,
        centre=np.stack((tracks["xCenter"], tracks["yCenter"]), axis=1),
        heading=heading,
        velocity=np.stack((tracks["xVelocity"], tracks["yVelocity"]), axis=1),
        acceleration=np.stack((tracks["xAcceleration"], tracks["yAcceleration"]), axis=1),
        notes=(*notes, *size_notes),
    )


def _sizes(meta: ColumnTable, tracks: ColumnTable, start: Integers) -> tuple[list[Floats], list[str]]:
    """Length and width of each vehicle by its samples, which hold where tracksMeta differs; and notes.

    A vehicle has one size: the median of its samples. Samples without a size leave that of tracksMeta.
    """
    chosen_sizes, notes = [], []
    for column in SIZES:
        stated = meta[column]
        if column not in tracks.columns:
            chosen_sizes.append(stated)
            continue
        samples = np.split(tracks[column], start[1:-1])
        sizes = np.array([float(np.median(x)) for x in samples])
        varying = sum(float(np.ptp(x)) > _ROUNDED for x in samples)
        differs = (sizes > 0) & (np.abs(sizes - stated) > _ROUNDED)
        size, other = np.where(differs, sizes, stated), np.flatnonzero(differs)
        if len(other):
            first = int(other[0])
            notes.append(
                f"{tracks.path.name}, column {column}: {len(other)} of {meta.rows} vehicles have another "
                f"size than in {meta.path.name}, such as trackId={meta['trackId'][first]}: "
                f"{size[first]:g} m, not {stated[first]:g} m; the size of {tracks.path.name} counts"
            )
        if varying:
            notes.append(
                f"{tracks.path.name}, column {column}: {varying} of {meta.rows} vehicles change their size; "
                "the median counts"
            )
        chosen_sizes.append(size)
    return chosen_sizes, notes


def check_plausible(whole: ColumnTable, checks: ContradictionChecks, rows: Integers) -> Iterator[str]:
    """Notes on what the file contradicts itself in. Raises ``InputError`` where that is too much."""
    tracks = whole if len(rows) == whole.rows else whole.at(rows)

    def at(row: int, signal: str) -> str:
        return f"{tracks.cell(row, 'frame')}, trackId={tracks['trackId'][row]}"

    vehicle_at = partial(tracks.cell, column="trackId")
    return contradiction_notes(tracks.path, checks, at, vehicle_at, "lanelet of the map")
