"""Samples of tracks in one file and what another says of each track, as highD and exiD have them."""

import numpy as np

from roadproof.errors import InputError
from roadproof.recordings.formats.recording import Integers
from roadproof.recordings.formats.table import Table


def in_order(tracks: Table, column: str) -> tuple[Table, tuple[str, ...]]:
    """The samples by vehicle (``column``) and frame, each once, and a note where they had to be sorted.

    Raises ``InputError``.
    """
    ids, frames = tracks[column], tracks["frame"]
    same = np.diff(ids) == 0
    if ((np.diff(ids) > 0) | (same & (np.diff(frames) > 0))).all():
        return tracks, ()
    order = np.lexsort((np.arange(tracks.rows), frames, ids))
    repeated = np.zeros(tracks.rows, bool)
    repeated[order[1:]] = (np.diff(ids[order]) == 0) & (np.diff(frames[order]) == 0)
    tracks.require(~repeated, "frame", "vehicle and frame occur together once")
    columns = {name: values[order] for name, values in tracks.columns.items()}
    ordered = Table(tracks.path, columns, tracks.rows, order)
    return ordered, (f"{tracks.path.name}: rows were not in order of {column} and frame; they were sorted",)


def match_vehicles(meta: Table, tracks: Table, column: str, least: int) -> Integers:
    """Where each vehicle's samples start; both files must tell the same of vehicles and frames.

    ``column`` has the ids, of which ``least`` is the least that is one. Raises ``InputError``.
    """
    first = np.flatnonzero(np.diff(tracks[column], prepend=-1) != 0)
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
    gaps = np.flatnonzero((np.diff(tracks[column]) == 0) & (np.diff(tracks["frame"]) != 1))
    if len(gaps):
        before, after = tracks["frame"][gaps[0]], tracks["frame"][gaps[0] + 1]
        vehicle = tracks[column][gaps[0]]
        where = f"{tracks.path}, vehicle {column}={vehicle}, frame={after}"
        raise InputError(f"{where}: the frame before it is {before}; the frames of a vehicle have no gaps")
    for name, found in (("initialFrame", tracks["frame"][first]), ("numFrames", counts)):
        wrong = np.flatnonzero(meta[name] != found)
        if len(wrong):
            k = wrong[0]
            where = f"{meta.path}, vehicle {column}={meta[column][k]}, column {name}={meta[name][k]}"
            raise InputError(f"{where}: {tracks.path.name} has {found[k]}; the files must agree")
    return start
