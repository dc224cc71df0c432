"""Recordings that lie: what a wrong export, a wrong unit or a wrong convention makes of honest highD files.

A lie changes the columns of the three files, as text tables would be changed: everything that depends
on a column and is not named stays as it was.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
import polars as pl

Columns = dict[str, npt.NDArray]
Lie = Callable[["Files"], None]


@dataclass
class Files:
    """The columns of one recording; ``way`` is the driving direction of each sample."""

    recording: Columns
    meta: Columns
    tracks: Columns

    @property
    def way(self) -> npt.NDArray:
        return self.meta["drivingDirection"][np.searchsorted(self.meta["id"], self.tracks["id"])]


def read_columns(folder: Path) -> Files:
    def read(name: str) -> Columns:
        frame = pl.read_csv(folder / f"01_{name}.csv")
        return {column: frame[column].to_numpy().copy() for column in frame.columns}

    return Files(read("recordingMeta"), read("tracksMeta"), read("tracks"))


def write_columns(files: Files, folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    for name, columns in (
        ("recordingMeta", files.recording),
        ("tracksMeta", files.meta),
        ("tracks", files.tracks),
    ):
        pl.DataFrame(columns).write_csv(folder / f"01_{name}.csv", float_precision=2, float_scientific=False)
    return folder


def scaled(factor: float, *columns: str) -> Lie:
    def lie(files: Files) -> None:
        for column in columns:
            files.tracks[column] = files.tracks[column] * factor

    return lie


def scaled_of_one_way(factor: float, way: int, *columns: str) -> Lie:
    def lie(files: Files) -> None:
        for column in columns:
            files.tracks[column] = np.where(files.way == way, factor, 1) * files.tracks[column]

    return lie


def shifted(column: str, size: str, share: float) -> Lie:
    def lie(files: Files) -> None:
        files.tracks[column] = files.tracks[column] + share * files.tracks[size]

    return lie


def all_shifted(*lies: Lie) -> Lie:
    def lie(files: Files) -> None:
        for each in lies:
            each(files)

    return lie


def exchanged(one: str, other: str, meta: bool) -> Lie:
    def lie(files: Files) -> None:
        for columns in (files.tracks, *([files.meta] if meta else [])):
            columns[one], columns[other] = columns[other], columns[one]

    return lie


def sizes_scaled(factor: float) -> Lie:
    def lie(files: Files) -> None:
        for columns in (files.tracks, files.meta):
            for column in ("width", "height"):
                columns[column] = columns[column] * factor

    return lie


def some_sizes(column: str, value: float, vehicles: int) -> Lie:
    def lie(files: Files) -> None:
        cars = np.flatnonzero(files.meta["class"] == "Car")[:vehicles]
        files.meta[column][cars] = value
        files.tracks[column][np.isin(files.tracks["id"], files.meta["id"][cars])] = value

    return lie


def cell(column: str, value: float, count: int = 1) -> Lie:
    """``count`` cells in the middle of as many vehicles."""

    def lie(files: Files) -> None:
        ids = files.tracks["id"]
        long = [k for k in np.unique(ids) if np.count_nonzero(ids == k) > 60][:count]
        assert len(long) == count
        for vehicle in long:
            files.tracks[column][np.flatnonzero(ids == vehicle)[30]] = value

    return lie


def of_some(lie: Lie, vehicles: int) -> Lie:
    """The lie about the samples of so many vehicles only: those that move fastest across the road."""

    def partial(files: Files) -> None:
        honest = {name: values.copy() for name, values in files.tracks.items()}
        lie(files)
        ids = files.meta["id"]
        speeds = [np.abs(honest["yVelocity"][honest["id"] == k]).max() for k in ids]
        chosen = np.isin(honest["id"], ids[np.argsort(speeds)[-vehicles:]])
        for name, values in files.tracks.items():
            files.tracks[name] = np.where(chosen, values, honest[name])

    return partial


def rate(value: int) -> Lie:
    def lie(files: Files) -> None:
        files.recording["frameRate"][0] = value

    return lie


def classes_exchanged(files: Files) -> None:
    kinds = files.meta["class"]
    files.meta["class"] = np.where(kinds == "Car", "Truck", "Car")
    files.recording["numCars"], files.recording["numTrucks"] = (
        files.recording["numTrucks"],
        files.recording["numCars"],
    )


def lanes_shifted(files: Files) -> None:
    files.tracks["laneId"] = files.tracks["laneId"] + 1


def markings_shifted(metres: float) -> Lie:
    def lie(files: Files) -> None:
        for column in ("upperLaneMarkings", "lowerLaneMarkings"):
            text = str(files.recording[column][0])
            files.recording[column] = np.array(
                [";".join(f"{float(x) + metres:.2f}" for x in text.split(";"))]
            )

    return lie


def reversed_time(files: Files) -> None:
    """Every vehicle's positions in the order of another time; all else as it was."""
    ids = files.tracks["id"]
    for vehicle in np.unique(ids):
        rows = np.flatnonzero(ids == vehicle)
        for column in ("x", "y"):
            files.tracks[column][rows] = files.tracks[column][rows][::-1]


def identities_exchanged(files: Files) -> None:
    """Two vehicles of one direction swap their ids half way through what they share."""
    tracks, meta = files.tracks, files.meta
    for k in range(len(meta["id"]) - 1):
        a, b = k, k + 1
        first = max(meta["initialFrame"][a], meta["initialFrame"][b])
        last = min(meta["finalFrame"][a], meta["finalFrame"][b])
        frames = tracks["frame"]
        middle = (first + last) // 2
        at = [tracks["x"][(tracks["id"] == meta["id"][v]) & (frames == middle)] for v in (a, b)]
        near = last - first > 100 and abs(at[0][0] - at[1][0]) < 60
        if meta["drivingDirection"][a] == meta["drivingDirection"][b] and near:
            inside = (frames >= middle) & (frames <= last)
            rows = [np.flatnonzero((tracks["id"] == meta["id"][v]) & inside) for v in (a, b)]
            for column in ("x", "y", "xVelocity", "yVelocity", "xAcceleration", "laneId"):
                one, other = tracks[column][rows[0]].copy(), tracks[column][rows[1]].copy()
                tracks[column][rows[0]], tracks[column][rows[1]] = other, one
            return
    raise AssertionError("no two vehicles meet")


def one_vehicle_twice(files: Files) -> None:
    """A vehicle stands in the files a second time, under another id."""
    new = int(files.meta["id"].max()) + 1
    cars = np.flatnonzero(files.meta["class"] == "Car")
    counts = files.meta["numFrames"][cars]
    twin = int(cars[np.argmax(counts)])
    rows = files.tracks["id"] == files.meta["id"][twin]
    files.tracks = {k: np.concatenate((v, v[rows])) for k, v in files.tracks.items()}
    files.tracks["id"][-int(rows.sum()) :] = new
    files.meta = {k: np.concatenate((v, v[twin : twin + 1])) for k, v in files.meta.items()}
    files.meta["id"][-1] = new
    files.recording["numVehicles"][0] += 1
    files.recording["numCars"][0] += 1


X, Y, VX, VY, AX = "x", "y", "xVelocity", "yVelocity", "xAcceleration"
REFUSED: dict[str, tuple[Lie, str]] = {
    "speeds in km/h": (scaled(3.6, VX, VY), r"xVelocity=.*by a factor of 3\.6: km/h\?"),
    "speed along in km/h": (scaled(3.6, VX), r"by a factor of 3\.6: km/h\?"),
    "speed across in km/h": (scaled(3.6, VY), r"yVelocity=.*by a factor of 3\.\d+"),
    "speeds in miles an hour": (scaled(2.237, VX, VY), "miles an hour"),
    "speed along turned": (scaled(-1, VX), "xVelocity=.*the sign is turned"),
    "speed across turned": (scaled(-1, VY), "yVelocity=.*the sign is turned"),
    "speed along turned in direction 1": (scaled_of_one_way(-1, 1, VX), "xVelocity=.*the sign is turned"),
    "speed across turned in direction 1": (scaled_of_one_way(-1, 1, VY), "yVelocity=.*the sign is turned"),
    "speed across turned in direction 2": (scaled_of_one_way(-1, 2, VY), "yVelocity=.*the sign is turned"),
    "no speed along": (scaled(0, VX), "xVelocity=.*zero"),
    "no speed across": (scaled(0, VY), "yVelocity=.*zero"),
    "speeds exchanged": (exchanged(VX, VY, False), "velocities along the road and positions"),
    "acceleration turned": (scaled(-1, AX), "xAcceleration=.*the sign is turned"),
    "acceleration turned in direction 1": (scaled_of_one_way(-1, 1, AX), "xAcceleration="),
    "no acceleration": (scaled(0, AX), "xAcceleration=.*zero"),
    "acceleration in g": (scaled(1 / 9.81, AX), "xAcceleration="),
    "acceleration exchanged with its place across": (exchanged(AX, "yAcceleration", False), "xAcceleration="),
    "centres": (
        all_shifted(shifted(X, "width", 0.5), shifted(Y, "height", 0.5)),
        "is x the left edge|half widths",
    ),
    "centres across": (shifted(Y, "height", 0.5), "half widths"),
    "centres along": (shifted(X, "width", 0.5), "is x the left edge of the box"),
    "lower corners": (shifted(Y, "height", 1.0), "laneId is not the lane|half widths"),
    "right edges": (shifted(X, "width", 1.0), "is x the left edge of the box"),
    "width and height exchanged": (exchanged("width", "height", True), "wider than"),
    "width and height exchanged in the tracks": (exchanged("width", "height", False), "has another size"),
    "x and y exchanged": (exchanged(X, Y, False), "velocities|no lane|moves the other way"),
    "sizes in feet": (sizes_scaled(3.281), "usually|wider than|must lie between"),
    "sizes in decimetres": (sizes_scaled(10), "must lie between|usually"),
    "sizes halved": (sizes_scaled(0.5), "usually|half widths"),
    "positions in feet": (scaled(3.281, X, Y), "velocities|no lane|wider"),
    "positions along in feet": (scaled(3.281, X), "xVelocity="),
    "classes exchanged": (classes_exchanged, "a Car is usually"),
    "50 frames a second": (rate(50), "xVelocity=.*by a factor of 0.5"),
    "30 frames a second": (rate(30), r"xVelocity=.*by a factor of 0\.83"),
    "20 frames a second": (rate(20), r"xVelocity=.*by a factor of 1\.25"),
    "time runs backwards": (reversed_time, "moves the other way|the sign is turned"),
    "lanes count from one": (lanes_shifted, "laneId is not the lane"),
    "markings half a lane aside": (markings_shifted(1.9), "laneId is not the lane|half widths"),
    "markings a metre aside": (markings_shifted(1.0), "laneId is not the lane|half widths"),
    "a place of 1e5": (cell(X, 1e5), r"column x=100000\.0: must lie between -10000 and 10000"),
    "a place across of 1e5": (cell(Y, 1e5), r"column y=100000\.0: must lie between"),
    "a place 300 m away": (cell(X, 9000.0), "does not move by more than 100 m"),
    "a speed of 1e5": (cell(VX, 1e5), r"column xVelocity=100000\.0: must lie between -250 and 250"),
    "a speed of 1e155": (cell(VX, 1e155), "column xVelocity=1e[+]155: must lie between"),
    "a speed across of 1e5": (cell(VY, 1e5), r"column yVelocity=100000\.0: must lie between"),
    "an acceleration of 1e5": (cell(AX, 1e5), r"column xAcceleration=100000\.0: must lie between"),
    "a length of 1e5": (some_sizes("width", 1e5, 1), r"column width=100000\.0: must lie between"),
    "a width of 1e5": (some_sizes("height", 1e5, 1), r"column height=100000\.0: must lie between"),
}
NOTED: dict[str, tuple[Lie, str]] = {
    "speeds of two vehicles in km/h": (
        of_some(scaled(3.6, VX), 2),
        "velocities along the road and positions",
    ),
    "speed across of two vehicles turned": (
        of_some(scaled(-1, VY), 2),
        "velocities across the road and positions contradict",
    ),
    "all speeds 5 % too high": (scaled(1.05, VX), r"are [45]\.\d % too high on the whole"),
    "all speeds 2 % too low": (scaled(0.98, VX), r"are [12]\.\d % too low on the whole"),
    "positions along 3 % too far": (scaled(1.03, X), r"are [23]\.\d % too low on the whole"),
    "one speed in km/h": (cell(VX, 110.0), "a velocity changes by more than"),
    "one speed of zero": (cell(VX, 0.0), "a velocity changes by more than"),
    "one speed across of 5 m/s": (cell(VY, 5.0), "a velocity changes by more than"),
    "one acceleration of 40": (cell(AX, 40.0), "an acceleration is above 15"),
    "one place 30 m away": (cell(X, 230.0), "a position and the velocity differ"),
    "a car of 12 m": (some_sizes("width", 12.0, 2), "a Car is usually 2 to 8 m long"),
    "a car 5 m wide": (some_sizes("height", 4.6, 1), "wider than|usually|lane"),
    "two vehicles change names": (identities_exchanged, "a position and the velocity|does not move|no lane"),
    "one lane cell": (cell("laneId", 1), "laneId is not the lane of the box's centre in 1 rows"),
}
