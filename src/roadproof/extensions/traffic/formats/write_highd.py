"""Write a recording as the three files of the highD format (semantics §7), every column filled."""

from fractions import Fraction
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.highd_columns import (
    RECORDING_COLUMNS,
    SAMPLE_COLUMNS,
    UPPER,
    VEHICLE_COLUMNS,
)
from roadproof.extensions.traffic.formats.neighbours import find_neighbours, gaps_ahead
from roadproof.extensions.traffic.formats.recording import Floats, Integers, Recording
from roadproof.extensions.traffic.formats.table import write_table

Columns: TypeAlias = dict[str, npt.NDArray[Any]]
DECIMALS = 2


def write_highd(recording: Recording, folder: Path) -> None:
    """Write XX_recordingMeta.csv, XX_tracksMeta.csv and XX_tracks.csv, XX being the recording's name.

    Numbers have two decimals, as highD's own. Each file appears whole or not at all. Raises ``InputError``
    where ``folder`` cannot be written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{folder}: the folder cannot be made ({error.strerror}); choose another") from None
    for table, columns in highd_tables(recording, DECIMALS).items():
        write_table(folder / f"{recording.name}_{table}.csv", columns, DECIMALS)


def highd_tables(recording: Recording, decimals: int) -> dict[str, Columns]:
    """The columns of the three files by what follows the recording's name in theirs.

    The tracks, which a reader needs most, come last. Numbers are rounded to so many decimals.
    """
    samples = _sample_columns(recording, decimals)
    return {
        "recordingMeta": _recording_columns(recording, decimals),
        "tracksMeta": _vehicle_columns(recording, samples),
        "tracks": samples,
    }


def _sample_columns(recording: Recording, decimals: int) -> Columns:
    vehicle = recording.row_vehicle
    up = recording.direction[vehicle] == UPPER
    sign = np.where(up, -1.0, 1.0)
    length, width = recording.length[vehicle], recording.width[vehicle]
    x = np.where(up, -recording.s, recording.s - length)
    neighbours = find_neighbours(recording)
    dhw, thw, ttc, leader_speed = gaps_ahead(recording, neighbours.preceding)
    ids = np.append(recording.vehicle_id[vehicle], 0)  # no neighbour is row -1
    west, east = float(x.min()), float((x + length).max())
    middle = x + length / 2
    columns: Columns = {
        "frame": recording.row_frame,
        "id": ids[:-1],
        "x": x,
        "y": np.where(up, recording.d - width, -recording.d),
        "width": length,
        "height": width,
        "xVelocity": sign * recording.v_lon,
        "yVelocity": -sign * recording.v_lat,
        "xAcceleration": sign * recording.a_lon,
        "yAcceleration": -sign * recording.a_lat,
        "frontSightDistance": np.where(up, middle - west, east - middle),
        "backSightDistance": np.where(up, east - middle, middle - west),
        "dhw": dhw,
        "thw": thw,
        "ttc": ttc,
        "precedingXVelocity": sign * leader_speed,
        "precedingId": ids[neighbours.preceding],
        "followingId": ids[neighbours.following],
        **{f"{name}Id": ids[rows] for name, rows in neighbours.beside.items()},
        "laneId": np.array([int(lane.name) for lane in recording.lanes] + [0])[recording.lane],
    }
    return {name: _rounded(columns[name], decimals) for name in SAMPLE_COLUMNS}


def _rounded(values: npt.NDArray[Any], decimals: int) -> npt.NDArray[Any]:
    """Floats with so many decimals and no negative zero; whole numbers as they are."""
    return np.round(values, decimals) + 0.0 if values.dtype.kind == "f" else values


def _vehicle_columns(recording: Recording, samples: Columns) -> Columns:
    start = recording.start[:-1]
    velocity, lane = samples["xVelocity"], samples["laneId"]
    changes = np.diff(lane, prepend=lane[0]) != 0
    changes[start] = False
    least = {
        f"min{name.upper()}": _least_positive(samples[name], samples["precedingId"] > 0, start)
        for name in ("dhw", "thw", "ttc")
    }
    counts = np.diff(recording.start)
    columns: Columns = {
        "id": recording.vehicle_id,
        "width": recording.length,
        "height": recording.width,
        "initialFrame": recording.first_frame,
        "finalFrame": recording.last_frame,
        "numFrames": counts,
        "class": recording.kind,
        "drivingDirection": recording.direction,
        "traveledDistance": recording.s[recording.start[1:] - 1] - recording.s[start],
        "minXVelocity": np.minimum.reduceat(velocity, start),
        "maxXVelocity": np.maximum.reduceat(velocity, start),
        "meanXVelocity": np.add.reduceat(velocity, start) / counts,
        **least,
        "numLaneChanges": np.add.reduceat(changes.astype(np.int64), start),
    }
    return {name: columns[name] for name in VEHICLE_COLUMNS}


def _least_positive(values: Floats, known: npt.NDArray[np.bool_], start: Integers) -> Floats:
    """The least value above zero of each vehicle, -1 where there is none."""
    least = np.minimum.reduceat(np.where(known & (values > 0), values, np.inf), start)
    return np.where(np.isinf(least), -1.0, least)


def _recording_columns(recording: Recording, decimals: int) -> Columns:
    upper, lower = _markings(recording, decimals)
    last = int(recording.last_frame.max())
    distance = float((recording.s[recording.start[1:] - 1] - recording.s[recording.start[:-1]]).sum())
    trucks = int(np.count_nonzero(recording.kind == "Truck"))
    values: dict[str, object] = {
        "id": int(recording.name),
        "frameRate": float(recording.rate) if isinstance(recording.rate, Fraction) else recording.rate,
        "locationId": 1,
        "speedLimit": -1.0,
        "month": "1.2020",
        "weekDay": "Mon",
        "startTime": "12:00",
        "duration": last / float(recording.rate),
        "totalDrivenDistance": distance,
        "totalDrivenTime": len(recording.s) / float(recording.rate),
        "numVehicles": recording.vehicles,
        "numCars": recording.vehicles - trucks,
        "numTrucks": trucks,
        "upperLaneMarkings": upper,
        "lowerLaneMarkings": lower,
    }
    return {name: np.array([values[name]]) for name in RECORDING_COLUMNS}


def _markings(recording: Recording, decimals: int) -> tuple[str, str]:
    """The y values of the markings as the format joins them."""
    texts = []
    for direction in (1, 2):
        bands = [lane.d for lane in recording.lanes if lane.direction == direction]
        edges = sorted({edge if direction == UPPER else -edge for band in bands if band for edge in band})
        texts.append(";".join(f"{edge:.{decimals}f}" for edge in edges))
    return texts[0], texts[1]
