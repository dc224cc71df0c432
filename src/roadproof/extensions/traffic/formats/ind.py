"""Recordings of inD, rounD and uniD (Bock et al., IV 2020; Krajewski et al., ITSC 2020), on a selected road.

Tracks are as ``levelx`` says, and no lanelets are named. The road is a stretch of a map, in Lanelet2 or
OpenDRIVE, as ``maps.selection`` reads it: its coordinates are those of the recording, or degrees. Pedestrians
and cyclists are left out, and so is all that is not on the road (``selected_roads``). The class truck_bus of
inD counts as a truck.
"""

import csv
import re
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.maps.network import ZONES_ENDING
from roadproof.extensions.traffic.formats.exid import maps_near, names_lanelets
from roadproof.extensions.traffic.formats.levelx import (
    check_cells,
    check_plausible,
    check_velocities,
    ignored_column_notes,
    read_recording_meta,
    read_samples,
    read_vehicles,
    traffic_of,
)
from roadproof.extensions.traffic.formats.off_line import follows_line, leave_out_strays
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.reliable import left_out_note, reliable_part
from roadproof.extensions.traffic.formats.selected_roads import chart_of, place_on_road
from roadproof.extensions.traffic.formats.source import Files, Format, beside
from roadproof.extensions.traffic.formats.table import ColumnTable
from roadproof.extensions.traffic.formats.tracks import (
    RATE_AT,
    TRACKS,
    files_of,
    find_recordings,
    read_tracks,
    usable,
)
from roadproof.reasons import ReasonKind

NO_VEHICLES: Mapping[str, str] = {"pedestrian": "pedestrians", "bicycle": "cyclists", "animal": "animals"}
"""Classes that are no vehicles in traffic."""


def read_ind(folder: Path, name: str, strict: bool = True, road: str | None = None) -> Recording:
    """Recording ``name`` of ``folder`` on a road of a map; unless ``strict``, bad vehicles are left out.

    Raises ``InputError`` that names file, element, value and rule; ``UsageError`` for a road that is not well
    said.
    """
    chart_of(road, folder / f"{name}{TRACKS}", maps_near(folder))
    about, rate = read_recording_meta(folder, name)
    meta = read_vehicles(folder, name)
    tracks, notes = read_samples(folder, name, {}, strict)
    meta, tracks, absent = _vehicles(meta, tracks)
    meta, tracks, start, left_out = usable(meta, tracks, "trackId", strict, check_cells)
    notes += (*absent, *left_out, *ignored_column_notes(folder, name, strict), *check_velocities(tracks))
    traffic = traffic_of(str(tracks.path), rate, meta, tracks, start, notes)
    origin = float(about["xUtmOrigin"][0]), float(about["yUtmOrigin"][0])
    recording, rows = place_on_road(traffic, str(road), origin, strict)
    fits = follows_line(traffic.centre[rows], recording)
    fitting = leave_out_strays(replace(recording, name=name), fits, strict)
    rows = rows[np.repeat(fits, np.diff(recording.start))]
    return reliable_part(fitting, strict, partial(check_plausible, tracks.at(rows)))


def _vehicles(meta: ColumnTable, tracks: ColumnTable) -> tuple[ColumnTable, ColumnTable, list[str]]:
    """The tables without pedestrians and the like, which have no size, and notes on these."""
    kinds = np.array([NO_VEHICLES.get(str(x).lower(), "") for x in meta["class"]])
    notes = [
        left_out_note(meta["trackId"][kinds == what].tolist(), meta.rows, ReasonKind.OF_KIND(what))
        for what in dict.fromkeys(kinds.tolist())
        if what
    ]
    if not notes:
        return meta, tracks, []
    if (kinds != "").all():
        raise InputError(f"{meta.path}: no track is of a vehicle")
    gone = meta["trackId"][kinds != ""]
    return (
        meta.at(np.flatnonzero(kinds == "")),
        tracks.at(np.flatnonzero(~np.isin(tracks["trackId"], gone))),
        notes,
    )


def _find(path: Path, road: str | None = None) -> dict[str, Files]:
    """Recordings without lanelets; with a road those of the location in its map's name, if there are any."""
    recordings = find_recordings(path, with_ids=True, files=files_of)
    recordings = {name: x for name, x in recordings.items() if not names_lanelets(x[-1])}
    if road is None:
        return recordings
    chart = Path(road.partition("#")[0])
    numbers = {int(x) for x in re.findall(r"\d+", chart.stem)}
    there = {name: x for name, x in recordings.items() if _location(x[0]) in numbers} or recordings
    charts = (*beside(chart, ZONES_ENDING), *((chart,) if chart.is_file() else ()))
    return {name: (*charts, *x) for name, x in there.items()}


def _location(about: Path) -> int:
    """The number of the location; -1 where there is none."""
    try:
        with about.open(encoding="utf-8", newline="") as file:
            return int(next(csv.DictReader(file))["locationId"])
    except (OSError, ValueError, KeyError, StopIteration, csv.Error):
        return -1


def _on(road: str) -> Format:
    """The format, whose recordings are read on a road of a map."""
    reading = partial(read_tracks, partial(read_ind, road=road))
    return replace(FORMAT, find=partial(_find, road=road), read=reading)


FORMAT = Format(
    "inD",
    "the files of exiD without laneletId, as inD, rounD and uniD have them, with a road of a map",
    _find,
    partial(read_tracks, read_ind),
    RATE_AT,
    on_road=_on,
)
