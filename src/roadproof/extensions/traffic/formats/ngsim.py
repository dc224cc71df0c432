"""Recordings of NGSIM's freeways US-101 and I-80 in CSV (FHWA, 2006 and 2007): in feet, ten frames a second.

Local_X grows to the right from the left edge of the section, Local_Y along it, and both are of the middle of
a vehicle's front. A foot is 0.3048 m. So s is Local_Y, and d is -Local_X and half of v_Width. v_Vel and v_Acc
are along the road. Files say nothing of motion across it: v_lat is the change of d, and a_lat that of v_lat,
by central differences. Names of columns count in upper or lower case, other columns are passed over.

A file is of one place and time, or that of data.gov with all of them and a column Location. Of this one, the
streets are left out. Global_Time and Frame_ID tell times apart, which then follow each other in frames; the
ids of vehicles grow by PERIOD from each to the next. NAME_road.toml beside the file replaces measured lanes.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np

from roadproof.extensions.traffic.formats.content import columns_not_read_note
from roadproof.extensions.traffic.formats.contradictions import contradiction_notes, note_if_rare
from roadproof.extensions.traffic.formats.harmless_columns import NGSIM
from roadproof.extensions.traffic.formats.ngsim_lanes import FOOT, FREEWAYS, measured_road
from roadproof.extensions.traffic.formats.plausible import (
    LARGEST_ACCELERATION,
    LARGEST_SIZE,
    LARGEST_SPEED,
    ContradictionChecks,
)
from roadproof.extensions.traffic.formats.recording import Bools, Floats, Integers, Recording, with_notes
from roadproof.extensions.traffic.formats.reliable import rate_of_change, reliable_part
from roadproof.extensions.traffic.formats.source import Files, Format, find_files, first_line
from roadproof.extensions.traffic.formats.straight import StraightRoad, of_road, place_recording
from roadproof.extensions.traffic.formats.table import ColumnTable, Kind, kinds_of, read_table
from roadproof.extensions.traffic.formats.tracks import Rule, without_bad
from roadproof.world.models import load_recorded_road
from roadproof.world.signals import RECORDED, SIZES, SignalName, SizeName

RATE = 10
STEP = 100
"""ms of Global_Time from one frame to the next."""
PERIOD = 100_000
"""Vehicle_ID is less than that."""
ROAD_ENDING = "_road.toml"
KINDS = {1: "Motorcycle", 2: "Car", 3: "Truck"}
"""Names of v_Class."""
_READ = kinds_of(
    integer="Vehicle_ID Frame_ID Global_Time v_Class Lane_ID",
    number="Local_X Local_Y v_Length v_Width v_Vel v_Acc",
)
_PLACES = kinds_of(number="Global_X Global_Y")
_LOCATION = "Location"
_MEASURED = ("Local_Y", "Local_X", "v_Vel", "Local_X", "v_Acc", "Local_X")
_SIZES = ("v_Length", "v_Width")
_SIGNALS: Mapping[SignalName | SizeName, str] = dict(
    zip((*RECORDED, *SIZES), (*_MEASURED, *_SIZES), strict=True)
)
"""The column from which each signal is."""
_MOST = {
    "Local_X": 30_000.0,
    "Local_Y": 30_000.0,
    "v_Vel": LARGEST_SPEED / FOOT,
    "v_Acc": LARGEST_ACCELERATION / FOOT,
    "v_Length": LARGEST_SIZE / FOOT,
    "v_Width": LARGEST_SIZE / FOOT,
}
"""In ft and s; beyond that there is no vehicle."""
_ASIDE = 3.0
_CLOCK = f"it does not grow by {STEP} ms from one Frame_ID to the next, as in other rows"
_FARTHEST = 50_000.0
"""ft from the place in ``Freeway.near``."""
_RARE = 0.05
"""A share of rows with another time of frame 0 that makes no period: their times are wrong."""
_DERIVED_NOTE = (
    "v_lat and a_lat are differences of Local_X; NGSIM smooths v_Vel and v_Acc, but not Local_X and Local_Y"
)


def read_ngsim(path: Path, strict: bool = True) -> Recording:
    """The recording of a file; unless ``strict``, bad vehicles are left out.

    Raises ``InputError`` that names file, row, column, value and rule.
    """
    not_read = columns_not_read_note(path, *_names(path), strict)
    rows, streets = _freeways(_read(path))
    rows, late, periods = _in_order(rows)
    if not strict:
        rows, late, periods = _without_copies(rows, late, periods)
    usable_rows, left_out = without_bad(rows["track"], _rules(rows, late), rows.refuse, strict)
    rows = rows.at(np.flatnonzero(usable_rows))
    road, way = _road_of(path, rows)
    recording = with_notes(
        _recording(rows, road, path.stem), (*streets, *periods, *left_out, *not_read, _DERIVED_NOTE)
    )
    whole = reliable_part(recording, strict, partial(_check_plausible, rows))
    return with_notes(whole, () if way else _check_lanes(rows, recording))


def _names(path: Path) -> tuple[list[str], list[str], dict[str, str]]:
    """The columns of a file, those that are read, and the harmless ones, in lower case."""
    names = [x.lower() for x in first_line(path).split(",")]
    return names, [x.lower() for x in (*_READ, _LOCATION)], {x.lower(): y for x, y in NGSIM.items()}


def _read(path: Path) -> ColumnTable:
    """The columns, called as above. Raises ``InputError``."""
    header = tuple(first_line(path).split(","))
    known = {name.lower(): name for name in header}
    columns: dict[str, Kind] = {**_READ, **({_LOCATION: "text"} if "location" in known else _PLACES)}
    names = {name: known.get(name.lower(), name) for name in columns}
    if not set(names.values()) <= set(header):
        header = tuple(columns)  # so that reading says which columns are missing
    table = read_table(path, header, {names[name]: kind for name, kind in columns.items()}, thousands=True)
    return replace(table, columns={name: table[names[name]] for name in columns})


def _freeways(table: ColumnTable) -> tuple[ColumnTable, list[str]]:
    """The rows on freeways, with a column Location, and a note on others. Raises ``InputError``."""
    if _LOCATION not in table.columns:
        return replace(table, columns={**table.columns, _LOCATION: _located(table)}), []
    names = np.char.lower(np.char.strip(table[_LOCATION].astype(np.str_)))
    table = replace(table, columns={**table.columns, _LOCATION: names})
    on_freeway = np.isin(names, [*FREEWAYS])
    streets = sorted(set(names[~on_freeway].tolist()))
    if not on_freeway.any():
        raise table.refuse(0, _LOCATION, f"only freeways are read: {', '.join(FREEWAYS)}")
    if not streets:
        return table, []
    left = f"left out {int(np.count_nonzero(~on_freeway))} of {table.rows} rows: {', '.join(streets)}"
    return table.at(np.flatnonzero(on_freeway)), [
        f"{left} are streets with crossings, and only freeways are read"
    ]


def _located(table: ColumnTable) -> np.ndarray[tuple[int], np.dtype[np.str_]]:
    """The freeway on which all samples are, by their Global_X and Global_Y. Raises ``InputError``."""
    x, y = (float(np.median(table[name])) for name in _PLACES)
    for name, freeway in FREEWAYS.items():
        if max(abs(x - freeway.near[0]), abs(y - freeway.near[1])) < _FARTHEST:
            return np.full(table.rows, name)
    rule = f"Global_X and Global_Y are near none of {', '.join(FREEWAYS)}; add a column {_LOCATION}"
    raise table.refuse(0, "Global_X", rule)


def _in_order(table: ColumnTable) -> tuple[ColumnTable, Bools, list[str]]:
    """The rows by vehicle and frame, with columns ``track``, ``frame`` and ``way`` (which freeway).

    Also which rows have a wrong time, and notes on periods of time. Raises ``InputError``.
    """
    way: Integers = np.zeros(table.rows, np.int64)
    for number, name in enumerate(FREEWAYS, 1):
        way[table[_LOCATION] == name] = number
    track, frame = table["Vehicle_ID"].copy(), table["Frame_ID"].copy()
    table.require((track >= 0) & (track < PERIOD), "Vehicle_ID", f"must lie between 0 and {PERIOD - 1}")
    period, wrong = _periods(table, way)
    notes, following = [], 0
    for number in range(int(period.max()) + 1 if period.any() else 0):
        ours = period == number
        frame[ours] += following - int(frame[ours].min())
        track[ours] += PERIOD * number
        time = datetime.fromtimestamp(int(table["Global_Time"][ours].min()) / 1000, UTC)
        name = table[_LOCATION][ours][0]
        notes.append(
            f"{name}, {time:%Y-%m-%d %H:%M} UTC: frames from {following}, ids from {PERIOD * number}"
        )
        following = int(frame[ours].max()) + RATE
    columns = {**table.columns, "track": track, "frame": frame, "way": way}
    order = np.lexsort((frame, track))
    return replace(table, columns=columns).at(order), wrong[order], notes


def _without_copies(rows: ColumnTable, late: Bools, notes: list[str]) -> tuple[ColumnTable, Bools, list[str]]:
    """Return the rows without copies of the row before, with a note on the copies."""
    names = ("track", "frame", *_READ)
    again = np.logical_and.reduce([np.diff(rows[name], prepend=np.inf) == 0 for name in names])
    count = int(np.count_nonzero(again))
    if not count:
        return rows, late, notes
    note = f"{count} of {rows.rows} rows occur twice; they were read once"
    return rows.at(np.flatnonzero(~again)), late[~again], [*notes, note]


def _periods(table: ColumnTable, way: Integers) -> tuple[Integers, Bools]:
    """Return for each row the number of its period, and whether its time is wrong. Raises ``InputError``.

    A period is of one freeway, and all of its rows have frame 0 at one time. Rows with a time that few have
    are put into the largest one.
    """
    origin = table["Global_Time"] - STEP * table["Frame_ID"]
    keys, group, counts = np.unique(np.stack((origin, way)), axis=1, return_inverse=True, return_counts=True)
    group = group.reshape(-1)
    share = counts / np.bincount(way)[keys[1]]
    if not (share > _RARE).any():
        raise table.refuse(0, "Global_Time", _CLOCK)
    largest = [int(np.argmax(share * (keys[1] == k))) for k in range(int(way.max()) + 1)]
    known = np.where(share > _RARE, np.arange(len(share)), np.array(largest)[keys[1]])
    return np.unique(known[group], return_inverse=True)[1], (known != np.arange(len(share)))[group]


def _rules(rows: ColumnTable, late: Bools) -> list[Rule]:
    """Return a rule for each column: which rows keep it, and its text. ``late``: rows whose time is wrong."""
    same = np.diff(rows["track"], prepend=-1) == 0
    step = np.diff(rows["frame"], prepend=0)
    aside = np.abs(np.diff(rows["Local_X"], prepend=0))
    jump = f"no vehicle moves across the road by more than {_ASIDE:g} ft from one frame to the next"
    rules: list[Rule] = [
        (~late, "Global_Time", _CLOCK),
        (~same | (step > 0), "Frame_ID", "vehicle and frame occur together once"),
        (~same | (step < 2), "Frame_ID", "the frame before it is missing; those of a vehicle have no gaps"),
        (np.isin(rows["v_Class"], [*KINDS]), "v_Class", "1 (motorcycle), 2 (car) or 3 (truck) is needed"),
    ]
    for name in ("v_Class", *_SIZES):
        rules.append((~same | (np.diff(rows[name], prepend=0) == 0), name, "it is the same in all frames"))
    for name, most in _MOST.items():
        rules.append((np.abs(rows[name]) <= most, name, f"must lie between {-most:.0f} and {most:.0f}"))
    for name in _SIZES:
        rules.append((rows[name] > 0, name, "the size of a vehicle is greater than zero"))
    return [*rules, (~same | (aside <= _ASIDE), "Local_X", jump)]


def _road_of(path: Path, rows: ColumnTable) -> tuple[StraightRoad, bool]:
    """The road beside the file, or the measured lanes of each freeway; and whether it is the former."""
    beside = path.with_name(f"{path.stem}{ROAD_ENDING}")
    ways = np.unique(rows["way"]).tolist()
    if beside.is_file() and len(ways) == 1:
        return of_road(load_recorded_road(beside)[0], ways[0], beside), True
    roads = []
    for way in ways:
        name = [*FREEWAYS][way - 1]
        road = measured_road(name, FREEWAYS[name], rows.at(np.flatnonzero(rows["way"] == way)))
        roads.append(of_road(road, way, path))
    return _joined(roads), False


def _joined(roads: Sequence[StraightRoad]) -> StraightRoad:
    """Roads of several freeways, of which each is a driving direction of its own."""
    if len(roads) == 1:
        return roads[0]
    made = []
    for road in roads:
        called = {x.name: f"{[*FREEWAYS][x.direction - 1]}.{x.name}" for x in road.lanes}
        lanes = tuple(replace(x, name=called[x.name]) for x in road.lanes)
        beside = frozenset(frozenset(called[x] for x in pair) for pair in road.beside)
        prefix = lanes[0].name.partition(".")[0]
        lanelets = tuple(replace(x, id=f"{prefix}.{x.id}", lane=called[x.lane]) for x in road.lanelets)
        made.append(StraightRoad(lanes, beside, lanelets))
    return StraightRoad(
        tuple(x for road in made for x in road.lanes),
        frozenset(pair for road in made for pair in road.beside),
        tuple(x for road in made for x in road.lanelets),
    )


def _recording(rows: ColumnTable, road: StraightRoad, name: str) -> Recording:
    """The recording of rows by vehicle and frame, in metres."""
    first = np.flatnonzero(np.diff(rows["track"], prepend=-1) != 0)
    start = np.append(first, rows.rows)
    s, width = rows["Local_Y"] * FOOT, rows["v_Width"] * FOOT
    d = width / 2 - rows["Local_X"] * FOOT
    v_lat = _rates_of_change(d, start)
    vehicles = {
        "vehicle_id": rows["track"][first],
        "direction": rows["way"][first],
        "kind": np.array([KINDS[x] for x in rows["v_Class"][first].tolist()]),
        "length": rows["v_Length"][first] * FOOT,
        "width": width[first],
        "first_frame": rows["frame"][first],
    }
    signals = (s, d, rows["v_Vel"] * FOOT, v_lat, rows["v_Acc"] * FOOT, _rates_of_change(v_lat, start))
    return place_recording(road, name, RATE, vehicles, np.diff(start), signals)


def _rates_of_change(values: Floats, start: Integers) -> Floats:
    """Return the change per second of the values of each vehicle."""
    return np.concatenate([rate_of_change(values[a:b], RATE) for a, b in pairwise(start.tolist())])


def _check_plausible(whole: ColumnTable, checks: ContradictionChecks, rows: Integers) -> Iterator[str]:
    """Notes on what the file contradicts itself in. Raises ``InputError`` where that is too much."""
    table = whole if len(rows) == whole.rows else whole.at(rows)

    def at(row: int, signal: SignalName | SizeName) -> str:
        return f"{table.cell(row, _SIGNALS[signal])} of vehicle {table['track'][row]}"

    vehicle_at = partial(table.cell, column="Vehicle_ID")
    return contradiction_notes(table.path, checks, at, vehicle_at, "lane")


def _check_lanes(rows: ColumnTable, recording: Recording) -> Iterator[str]:
    """Lane_ID must be the lane of the middle of most boxes, where it is one that goes through."""
    names = np.array([x.name.rpartition(".")[2] for x in recording.lanes] + [""])
    numbers = np.array([int(x) if x.isdecimal() else 0 for x in names.tolist()])[recording.lane]
    other = (numbers > 0) & (numbers != rows["Lane_ID"])
    rule = "Lane_ID is not the lane of the box's centre"
    return note_if_rare(
        rows, other, "Lane_ID", rule, "lanes are not straight: write them into NAME_road.toml"
    )


def is_ngsim(path: Path) -> bool:
    """Return whether a CSV file has NGSIM's columns."""
    return {"vehicle_id", "frame_id", "local_x"} <= set(first_line(path).lower().split(","))


def _find(path: Path) -> dict[str, Files]:
    return {name: x for name, x in find_files(path, ".csv", ROAD_ENDING).items() if is_ngsim(x[-1])}


FORMAT = Format(
    "NGSIM",
    "NAME.csv with the columns Vehicle_ID, Frame_ID, Local_X, … of US-101 and I-80",
    _find,
    read_ngsim,
    "{0}, column Frame_ID, frames of 1/{rate} s",
)
