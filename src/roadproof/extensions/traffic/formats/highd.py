"""Recordings in the highD format (semantics §7; Krajewski et al., ITSC 2018), read and fully checked.

The format's own names mislead: ``width`` is a vehicle's length and ``height`` its width, (x, y) is
the upper-left corner of the box, and y grows down. Direction 1 drives towards -x on the upper lanes.
"""

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.clock import Rate
from roadproof.extensions.traffic.formats.content import Content
from roadproof.extensions.traffic.formats.contradictions import contradiction_notes, note_if_rare
from roadproof.extensions.traffic.formats.highd_columns import (
    LOWER,
    RECORDING_COLUMNS,
    SAMPLE_COLUMNS,
    UPPER,
    VEHICLE_COLUMNS,
    lanes_of_markings,
)
from roadproof.extensions.traffic.formats.plausible import (
    LARGEST_ACCELERATION,
    LARGEST_SIZE,
    LARGEST_SPEED,
    OFF_CENTRE,
    ContradictionChecks,
)
from roadproof.extensions.traffic.formats.recording import (
    Bools,
    Floats,
    Integers,
    Lane,
    Recording,
    blockwise,
    with_notes,
)
from roadproof.extensions.traffic.formats.reliable import reliable_part
from roadproof.extensions.traffic.formats.source import Files, Format
from roadproof.extensions.traffic.formats.straight import StraightRoad, of_bands, of_road, place
from roadproof.extensions.traffic.formats.table import ColumnTable, fits_kind, kinds_of, read_table
from roadproof.extensions.traffic.formats.tracks import (
    RATE_AT,
    cells_of,
    files_of,
    find_recordings,
    in_order,
    match_vehicles,
    rate_of,
    read_tracks,
    usable,
    vehicles_by_id,
)
from roadproof.world.models import load_recorded_road
from roadproof.world.signals import SignalName, SizeName

_ROUNDED = 0.015
"""m; sizes in two files that round to hundredths differ by less."""
LARGEST_PLACE = 10_000.0
"""x and y (m) of a section that one camera sees."""
_SIGNALS: Mapping[str, SignalName | SizeName] = {
    "x": "s",
    "y": "d",
    "xVelocity": "v_lon",
    "yVelocity": "v_lat",
    "xAcceleration": "a_lon",
    "width": "length",
    "height": "width",
}
_COLUMNS = {signal: column for column, signal in _SIGNALS.items()}
"""The columns of the signals that rules of ``plausible`` are about."""


_RECORDING_KINDS = kinds_of(
    integer="id numVehicles numCars numTrucks", number="frameRate", text="upperLaneMarkings lowerLaneMarkings"
)
_VEHICLE_KINDS = kinds_of(
    integer="id initialFrame finalFrame numFrames drivingDirection", number="width height", text="class"
)
SAMPLE_KINDS = kinds_of(
    integer="frame id laneId", number="x y width height xVelocity yVelocity xAcceleration yAcceleration"
)

_NUMBERS = tuple(x for x, kind in SAMPLE_KINDS.items() if kind == "number")
_LARGEST: Mapping[str, float] = {
    **dict.fromkeys(("x", "y"), LARGEST_PLACE),
    **dict.fromkeys(("xVelocity", "yVelocity"), LARGEST_SPEED),
    **dict.fromkeys(("xAcceleration", "yAcceleration"), LARGEST_ACCELERATION),
    **dict.fromkeys(("width", "height"), LARGEST_SIZE),
}


def _check_cells(meta: ColumnTable, tracks: ColumnTable) -> Integers:
    """Return where each vehicle's samples start. No cell may say what no vehicle does.

    Both files must say the same of sizes: one of them would decide the pairs that are looked at.
    """
    start = match_vehicles(meta, tracks, "id", 1)
    fine = tracks.is_within(_LARGEST)
    if not fine:
        tracks.require_numbers(*_NUMBERS)
    for column in ("width", "height"):
        _check_size(meta, tracks, column, start)
    if not fine:
        for column, most in _LARGEST.items():
            tracks.require_within(most, column)
    return start


def _check_size(meta: ColumnTable, tracks: ColumnTable, column: str, start: Integers) -> None:
    """A size is greater than zero, and the same in both files, which round to hundredths."""
    extremes = [extreme.reduceat(tracks[column], start[:-1]) for extreme in (np.minimum, np.maximum)]
    if all(((x > 0) & (np.abs(x - meta[column]) < _ROUNDED)).all() for x in extremes):
        return
    expected = np.repeat(meta[column], np.diff(start))
    tracks.require(tracks[column] > 0, column, "the size of a vehicle is greater than zero")
    same = np.abs(tracks[column] - expected) < _ROUNDED
    tracks.require(same, column, f"{meta.path.name} has another size for the vehicle")


def _check_direction(meta: ColumnTable, tracks: ColumnTable, s: Floats, start: Integers) -> None:
    """Refuse vehicles that end further back than their own length from their start. Raises ``InputError``."""
    backwards = s[start[1:] - 1] - s[start[:-1]] < -meta["width"]
    if backwards.any():
        k = int(np.argmax(backwards))
        where = f"vehicle id={meta['id'][k]}, column drivingDirection={meta['drivingDirection'][k]}"
        raise InputError(f"{meta.path}, {where}: in {tracks.path.name} the vehicle moves the other way")


def _check_lanes(tracks: ColumnTable, recording: Recording, marked: Bools) -> Iterator[str]:
    """laneId must be the lane of the centre of most boxes.

    ``marked``: the samples whose lanes come from the markings, which laneId counts. Raises ``InputError``.
    """
    names = np.array([int(x.name) if x.name.isdecimal() else 0 for x in recording.lanes] + [0])
    other = marked & (names.take(recording.lane) != tracks["laneId"])
    rule = "laneId is not the lane of the box's centre"
    return note_if_rare(tracks, other, "laneId", rule, "do markings and positions fit?")


def _sample_rows(
    table: ColumnTable, header: Sequence[str], names: Sequence[str], count: int
) -> list[list[float]]:
    """The numbers of ``names`` in about ``count`` rows, evenly over the file that ``read_table`` took."""
    places = [header.index(name) for name in names]
    sample_rows = []
    content = table.content or Content.of(table.path)
    with content.open() as file:
        size = file.seek(0, 2)
        for k in range(count):
            file.seek(size * k // count)
            file.readline()
            cells = file.readline().decode("utf-8", "replace").strip().split(",")
            numbers = [cells[place] for place in places] if len(cells) == len(header) else []
            if numbers and all(fits_kind(x, "number") for x in numbers):
                sample_rows.append([float(x) for x in numbers])
    return sample_rows


def _check_sight(meta: ColumnTable, tracks: ColumnTable) -> tuple[str, ...]:
    """Compare x with the distance to the end of the section, which the format counts from the box's centre.

    x + width/2 less that distance is one number for short and long vehicles, unless x is not the left edge.
    """
    names = ("id", "x", "width", "frontSightDistance", "backSightDistance")
    rows = np.array(_sample_rows(tracks, SAMPLE_COLUMNS, names, 400)).reshape(-1, len(names))
    rows = rows[(rows[:, 3] > 0) & (rows[:, 4] > 0)]
    rows = rows[np.argsort(rows[:, 2], kind="stable")]
    third = len(rows) // 3
    if third < 15:
        return ()
    spread = float(np.median(rows[-third:, 2]) - np.median(rows[:third, 2])) / 2
    if spread < 0.2:
        return ()
    up = meta["drivingDirection"][np.searchsorted(meta["id"], rows[:, 0])] == UPPER
    west = rows[:, 1] + rows[:, 2] / 2 - np.where(up, rows[:, 3], rows[:, 4])
    slope = float(np.median(west[-third:]) - np.median(west[:third])) / spread
    if abs(slope) <= OFF_CENTRE[0]:
        return ()
    message = (
        f"column x: x + width/2 and the distances to the ends of the section differ by {slope:.2f} half "
        "lengths: is x the left edge of the box?"
    )
    if abs(slope) > OFF_CENTRE[1]:
        raise InputError(f"{tracks.path}, {message}")
    return (f"{tracks.path.name}, {message}",)


def _check_plausible(whole: ColumnTable, checks: ContradictionChecks, rows: Integers) -> Iterator[str]:
    """Notes on what the recording contradicts itself in; each vehicle must be at least once on a lane.

    Raises ``InputError`` where that is too much.
    """

    tracks = whole if len(rows) == whole.rows else whole.at(rows)

    def at(row: int, signal: SignalName | SizeName) -> str:
        return f"{tracks.cell(row, _COLUMNS[signal])} of vehicle {tracks['id'][row]}"

    def vehicle_at(row: int) -> str:
        return f"vehicle id={tracks['id'][row]}, column y={tracks['y'][row]}"

    lanes, advice = "lane of its direction", "the markings do not fit"
    return contradiction_notes(tracks.path, checks, at, vehicle_at, lanes, advice)


def highd_files(folder: Path, name: str) -> Files:
    """The files that recording ``name`` of ``folder`` is read from."""
    road = folder / f"{name}_road.toml"
    return (*((road,) if road.is_file() else ()), *files_of(folder, name))


def read_highd(folder: Path, name: str, strict: bool = True) -> Recording:
    """Recording ``name`` of ``folder``, in the coordinates of semantics §2.

    ``XX_road.toml`` beside the files gives the lanelets of one direction in place of its markings.
    Unless ``strict``, vehicles that contradict themselves are left out.
    Raises ``InputError`` that names file, row, column, value and rule for anything that does not fit;
    what is odd but usable is in ``Recording.notes``.
    """
    rate, bands, counts = _read_recording(folder / f"{name}_recordingMeta.csv", name)
    meta = _read_vehicles(folder / f"{name}_tracksMeta.csv", counts)
    gaps = cells_of(SAMPLE_KINDS, ("id",), strict)
    tracks = read_table(folder / f"{name}_tracks.csv", SAMPLE_COLUMNS, SAMPLE_KINDS, gaps=gaps)
    tracks, notes = in_order(tracks, "id")
    meta, tracks, start, left_out = usable(meta, tracks, "id", strict, _check_cells)
    sizes, notes = np.diff(start), (*left_out, *notes)
    road, way = _read_road(folder / f"{name}_road.toml", bands)

    direction = np.repeat(meta["drivingDirection"], sizes)
    up = direction == UPPER
    length, width = tracks["width"], tracks["height"]
    # Rounding undoes what binary floats add: sums of the file's decimals are decimals again.
    s = blockwise(lambda up, x, length: np.where(up, -x, np.round(x + length, 6)), up, tracks["x"], length)
    d = blockwise(lambda up, y, width: np.where(up, np.round(y + width, 6), -y), up, tracks["y"], width)
    _check_direction(meta, tracks, s, start)
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
    stands = reliable_part(recording, strict, partial(_check_plausible, tracks))
    more = (*_check_lanes(tracks, recording, direction != way), *_check_sight(meta, tracks))
    return with_notes(stands, more)


def _turned(backwards: Bools, values: Floats) -> Floats:
    """The values, with the other sign where what they are of goes ``backwards``."""
    return np.where(backwards, -values, values)


def _read_road(path: Path, bands: tuple[Lane, ...]) -> tuple[StraightRoad, int]:
    """The lanes of both directions, and that of which a file gives them, 0 for none."""
    if not path.is_file():
        return of_bands(bands), 0
    road, way = load_recorded_road(path, (LOWER, UPPER))
    return of_road(road, way, path, (x for x in bands if x.direction != way)), way


def _read_recording(path: Path, name: str) -> tuple[Rate, tuple[Lane, ...], Mapping[str, int]]:
    meta = read_table(path, RECORDING_COLUMNS, _RECORDING_KINDS)
    rate = rate_of(meta, "id", int(name), f"the name of the file says recording {name}")
    for column in ("numVehicles", "numCars", "numTrucks"):
        meta.require(meta[column] >= 0, column, "a count is never negative")
    if meta["numVehicles"][0] != meta["numCars"][0] + meta["numTrucks"][0]:
        raise meta.refuse(0, "numVehicles", "must be numCars + numTrucks")
    upper, lower = (_read_markings(meta, x) for x in ("upperLaneMarkings", "lowerLaneMarkings"))
    if upper[-1] > lower[0]:
        raise meta.refuse(0, "lowerLaneMarkings", f"must lie below the last upper marking {upper[-1]}")
    counts = {"Car": meta["numCars"][0], "Truck": meta["numTrucks"][0]}
    return rate, lanes_of_markings(upper, lower), counts


def _read_markings(meta: ColumnTable, column: str) -> tuple[float, ...]:
    try:
        values = tuple(float(part) for part in str(meta[column][0]).strip().strip(";").split(";"))
    except ValueError:
        raise meta.refuse(0, column, "y values joined by ';' are needed") from None
    if len(values) < 2 or not np.isfinite(values).all() or (np.diff(values) <= 0).any():
        rule = "at least two finite y values, each greater than the one before, are needed"
        raise meta.refuse(0, column, rule)
    return values


def _read_vehicles(path: Path, counts: Mapping[str, int]) -> ColumnTable:
    meta = read_table(path, VEHICLE_COLUMNS, _VEHICLE_KINDS)
    meta.require(meta["id"] > 0, "id", "an id is greater than zero, which stands for no vehicle")
    for column in ("width", "height"):
        meta.require(meta[column] > 0, column, "the size of a vehicle is greater than zero")
    ordered = vehicles_by_id(meta, "id")
    meta.require(np.isin(meta["drivingDirection"], (UPPER, LOWER)), "drivingDirection", "must be 1 or 2")
    kinds = meta["class"].astype(np.str_)
    meta.require(np.isin(kinds, list(counts)), "class", f"must be {' or '.join(counts)}")
    for kind, expected in counts.items():
        count = int(np.count_nonzero(kinds == kind))
        if count != expected:
            message = f"{count} vehicles of class {kind}, but the recordingMeta file counts {expected}"
            raise InputError(f"{path}: {message}")
    return ordered


find_highd = partial(find_recordings, with_ids=False, files=highd_files)
"""The recordings (01, 02, …) of a folder, or that of a file; each counts when one of its files is there."""
FORMAT = Format(
    "highD",
    "XX_recordingMeta.csv, XX_tracksMeta.csv and XX_tracks.csv",
    find_highd,
    partial(read_tracks, read_highd),
    RATE_AT,
)
