"""Samples of tracks in one file and what another says of each track, as highD and exiD have them."""

from collections.abc import Callable, Collection, Iterable, Mapping
from fractions import Fraction
from pathlib import Path
from typing import TypeAlias

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.clock import LARGEST_RATE, Rate, rate_for
from roadproof.extensions.traffic.formats.recording import Bools, Integers, Recording
from roadproof.extensions.traffic.formats.reliable import MOST_LEFT_OUT, left_out_note
from roadproof.extensions.traffic.formats.source import TRACK_FILES, Files, first_line, with_suffix
from roadproof.extensions.traffic.formats.table import CellError, ColumnTable, Kind, without_copies
from roadproof.reasons import ReasonKind

TRACKS = "_tracks.csv"
RATE_AT = "{2}, row 2, column frameRate={rate}"
"""Where a recording says its rate: in the third file from the end."""


def files_of(folder: Path, name: str) -> Files:
    """The files of a recording, that of its samples last."""
    return tuple(folder / f"{name}_{x}.csv" for x in ("recordingMeta", "tracksMeta", "tracks"))


def read_tracks(read: Callable[[Path, str, bool], Recording], path: Path, strict: bool = True) -> Recording:
    """The recording whose tracks are in ``path``, which ``read`` reads from its folder and name."""
    return read(path.parent, path.name.removesuffix(TRACKS), strict)


def find_recordings(path: Path, with_ids: bool, files: Callable[[Path, str], Files]) -> dict[str, Files]:
    """The recordings of a folder, in order, or that of one of its files, by name.

    ``with_ids``: files have a column recordingId. ``files``: of the recording of a folder and name.
    """
    recordings: dict[str, Files] = {}
    for file in with_suffix(path, ".csv"):
        match = TRACK_FILES.fullmatch(file.name)
        if match is not None and ("recordingId" in first_line(file).split(",")) == with_ids:
            recordings[match[1]] = files(file.parent, match[1])
    return dict(sorted(recordings.items(), key=lambda entry: (int(entry[0]), entry[0])))


def rate_of(meta: ColumnTable, column: str, number: int, rule: str) -> Rate:
    """The frames a second of a recording, whose ``number`` is in ``column``. Raises ``InputError``."""
    if meta.rows != 1:
        raise InputError(f"{meta.path}: {meta.rows} rows; one recording has one row of meta data")
    meta.require(meta[column] == number, column, rule)
    rate = float(meta["frameRate"][0])
    if not 1 <= rate <= LARGEST_RATE:
        raise meta.refuse(0, "frameRate", f"1 to {LARGEST_RATE} frames a second are possible")
    return rate_for(1 / Fraction(repr(rate)))


def cells_of(kinds: Mapping[str, Kind], ids: Collection[str], strict: bool) -> tuple[str, ...]:
    """The columns of tracks whose unreadable cells cost their vehicle; ``ids`` say which that is."""
    if strict:
        return ()
    return tuple(x for x, kind in kinds.items() if x not in ids and kind in ("integer", "number"))


def vehicles_by_id(meta: ColumnTable, column: str) -> ColumnTable:
    """The vehicles by their ids in ``column``, each once, with frames that fit. Raises ``InputError``."""
    order = np.argsort(meta[column], kind="stable")
    repeated = np.zeros(meta.rows, bool)
    repeated[order[1:]] = np.diff(meta[column][order]) == 0
    meta.require(~repeated, column, "a vehicle has one row")
    meta.require(meta["initialFrame"] >= 0, "initialFrame", "a frame is never negative")
    frames = meta["finalFrame"] - meta["initialFrame"] + 1
    meta.require(frames > 0, "finalFrame", "must not come before initialFrame")
    meta.require(meta["numFrames"] == frames, "numFrames", "must be finalFrame - initialFrame + 1")
    return meta.at(order)


def in_order(tracks: ColumnTable, column: str) -> tuple[ColumnTable, tuple[str, ...]]:
    """The samples by vehicle (``column``) and frame, each once, and a note where they had to be sorted.

    Raises ``InputError``.
    """
    ids, frames = tracks[column], tracks["frame"]
    if (np.diff(ids[starts_of(ids)]) > 0).all() and (_steps_within(ids, frames) > 0).all():
        return tracks, ()
    order = np.lexsort((np.arange(tracks.rows), frames, ids))
    again = np.zeros(tracks.rows, bool)
    again[1:] = (np.diff(ids[order]) == 0) & (np.diff(frames[order]) == 0)
    ordered, copies = without_copies(tracks.at(order), again, "frame")
    if (np.diff(order) > 0).all():
        return ordered, copies
    return ordered, (
        f"{tracks.path.name}: rows were not in order of {column} and frame; they were sorted",
        *copies,
    )


def starts_of(ids: Integers) -> Integers:
    """The rows where another id begins than that of the row before."""
    return np.append(0, np.flatnonzero(ids[1:] != ids[:-1]) + 1)


def _steps_within(ids: Integers, frames: Integers) -> Integers:
    """Return by how much frames go on from row to row; 1 from one id to the next."""
    steps: Integers = np.diff(frames)
    steps[starts_of(ids)[1:] - 1] = 1
    return steps


def usable(
    meta: ColumnTable,
    tracks: ColumnTable,
    column: str,
    strict: bool,
    check: Callable[[ColumnTable, ColumnTable], Integers],
) -> tuple[ColumnTable, ColumnTable, Integers, tuple[str, ...]]:
    """The tables, where each vehicle starts as ``check`` says, and notes on vehicles that they are without.

    Unless it is ``strict``, these are vehicles of which ``check`` refuses a cell; ``column`` has their ids.
    Raises ``InputError``, also where these are more than half.
    """
    faults: dict[int, CellError] = {}
    while True:
        known, samples = (_without(table, column, faults) for table in (meta, tracks))
        try:
            start = check(known, samples)
            break
        except CellError as error:
            if strict or len(faults) + 1 > MOST_LEFT_OUT * meta.rows:
                raise next(iter(faults.values()), error) from None
            table = known if error.path == meta.path else samples
            row = error.place if table.places is None else int(np.argmax(table.places == error.place))
            faults[int(table[column][row])] = error
    notes = (left_out_note([vehicle], meta.rows, ReasonKind.TOLD(x.told)) for vehicle, x in faults.items())
    return known, samples, start, tuple(notes)


Rule: TypeAlias = tuple[Bools, str, str]
"""Which rows are fine, the column that is looked at, and the rule that others break."""


def without_bad(
    ids: Integers, rules: Iterable[Rule], refuse: Callable[[int, str, str], CellError], strict: bool
) -> tuple[Bools, list[str]]:
    """The rows of vehicles without a cell that breaks a rule, and notes on the others.

    ``ids``: the vehicle of each row; ``refuse`` makes the error of a row, a column and a rule. Raises it
    where it is ``strict``, and where more than half of the vehicles have one.
    """
    faults: dict[int, CellError] = {}
    for holds, column, rule in rules:
        bad = np.flatnonzero(~holds)
        for k in np.unique(ids[bad], return_index=True)[1].tolist():
            faults.setdefault(int(ids[bad[k]]), refuse(int(bad[k]), column, rule))
    vehicles = len(np.unique(ids))
    if faults and (strict or len(faults) > MOST_LEFT_OUT * vehicles):
        raise next(iter(faults.values()))
    notes = [left_out_note([vehicle], vehicles, ReasonKind.TOLD(x.told)) for vehicle, x in faults.items()]
    return ~np.isin(ids, [*faults]), notes


def _without(table: ColumnTable, column: str, vehicles: Collection[int]) -> ColumnTable:
    if not vehicles:
        return table
    return table.at(np.flatnonzero(~np.isin(table[column], [*vehicles])))


def match_vehicles(meta: ColumnTable, tracks: ColumnTable, column: str, least: int) -> Integers:
    """Return where each vehicle's samples start; both files must tell the same of vehicles and frames.

    ``column`` has the ids, of which ``least`` is the least that is one. Raises ``InputError``.
    """
    first = starts_of(tracks[column])
    start = np.append(first, tracks.rows)
    ids, counts = tracks[column][first], np.diff(start)
    tracks.require(
        tracks[column] >= least, column, f"an id is {least} or greater; others stand for no vehicle"
    )
    tracks_only = np.setdiff1d(ids, meta[column])
    if len(tracks_only):
        raise InputError(
            f"{tracks.path}, column {column}={tracks_only[0]}: the vehicle is not in {meta.path.name}"
        )
    meta.require(np.isin(meta[column], ids), column, f"the vehicle has no rows in {tracks.path.name}")
    gaps = np.flatnonzero(_steps_within(tracks[column], tracks["frame"]) != 1)
    if len(gaps):
        before, after = tracks["frame"][gaps[0]], tracks["frame"][gaps[0] + 1]
        vehicle = tracks[column][gaps[0]]
        message = f"vehicle {column}={vehicle}, frame={after}: the frame before it is {before}"
        place = tracks.place(int(gaps[0]) + 1)
        raise CellError(tracks.path, f"{message}; the frames of a vehicle have no gaps", place)
    for name, actual in (("initialFrame", tracks["frame"][first]), ("numFrames", counts)):
        wrong = np.flatnonzero(meta[name] != actual)
        if len(wrong):
            k = wrong[0]
            where = f"vehicle {column}={meta[column][k]}, column {name}={meta[name][k]}"
            message = f"{where}: {tracks.path.name} has {actual[k]}; the files must agree"
            raise CellError(meta.path, message, meta.place(int(k)))
    return start
