"""highD files that vary every column in both directions, against a reading of them with ``csv`` alone."""

import csv
import random
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from roadproof.recordings.formats.highd import RECORDING_COLUMNS, SAMPLE_COLUMNS, VEHICLE_COLUMNS, read_highd

UPPER, LOWER = (8.5, 12.6, 16.4, 20.1), (25.0, 28.9, 32.7)
KINDS = {"Car": (4.5, 1.8), "Truck": (14.0, 2.5)}


@dataclass(frozen=True)
class Vehicle:
    """In the picture: the upper-left corner with y down, and its motion; ``first`` frame and how many."""

    id: int
    way: int
    kind: str
    first: int
    frames: int
    corner: tuple[float, float]
    speed: tuple[float, float]
    pull: tuple[float, float]
    size: tuple[float, float]


def vehicles(seed: int) -> list[Vehicle]:
    """Eight, each in a stretch of its own, some across a marking, entering at different frames."""
    rng = random.Random(seed)
    made = []
    for k, number in enumerate(rng.sample(range(1, 90), 8)):
        way = 1 + k % 2
        kind = "Truck" if k in (2, 5) else "Car"
        length, width = (x + rng.uniform(-0.3, 0.3) for x in KINDS[kind])
        edges = UPPER if way == 1 else LOWER
        y = rng.uniform(edges[0] + 0.3, edges[-1] - width - 0.3)
        sign = -1 if way == 1 else 1
        made.append(
            Vehicle(
                number,
                way,
                kind,
                rng.randrange(0, 30),
                rng.randrange(3, 12),
                (round(60 + 50 * k + rng.uniform(0, 5), 2), round(y, 2)),
                (round(sign * rng.uniform(20, 35), 2), round(rng.uniform(-0.6, 0.6), 2)),
                (round(rng.uniform(-1, 1), 2), round(rng.uniform(-0.3, 0.3), 2)),
                (round(length, 2), round(width, 2)),
            )
        )
    return made


def at(vehicle: Vehicle, k: int, rate: int) -> list[float]:
    """x, y, both speeds, both accelerations in the k-th frame."""
    t = k / rate
    places = (
        x + v * t + a * t * t / 2 for x, v, a in zip(vehicle.corner, vehicle.speed, vehicle.pull, strict=True)
    )
    speeds = (v + a * t for v, a in zip(vehicle.speed, vehicle.pull, strict=True))
    return [round(z, 4) for z in (*places, *speeds, *vehicle.pull)]


def lane_of(vehicle: Vehicle, y: float) -> int:
    middle = y + vehicle.size[1] / 2
    edges, first = (UPPER, 2) if vehicle.way == 1 else (LOWER, len(UPPER) + 2)
    return first + sum(middle >= edge for edge in edges[1:-1])


def write(folder: Path, seed: int, rate: int) -> list[Vehicle]:
    made = vehicles(seed)
    samples = []
    for x in made:
        for k in range(x.frames):
            row = at(x, k, rate)
            cells: dict[str, object] = dict.fromkeys(SAMPLE_COLUMNS, 0)
            cells |= dict(
                zip(("x", "y", "xVelocity", "yVelocity", "xAcceleration", "yAcceleration"), row, strict=True)
            )
            cells |= {"frame": x.first + k, "id": x.id, "width": x.size[0], "height": x.size[1]}
            middle = row[0] + x.size[0] / 2
            ahead, back = (middle, 500 - middle) if x.way == 1 else (500 - middle, middle)
            cells |= {"frontSightDistance": round(ahead, 4), "backSightDistance": round(back, 4)}
            samples.append(cells | {"laneId": lane_of(x, row[1])})
    meta = [
        {
            **dict.fromkeys(VEHICLE_COLUMNS, 0),
            **{"id": x.id, "width": x.size[0], "height": x.size[1], "initialFrame": x.first, "class": x.kind},
            **{"finalFrame": x.first + x.frames - 1, "numFrames": x.frames, "drivingDirection": x.way},
        }
        for x in made
    ]
    about = {
        **dict.fromkeys(RECORDING_COLUMNS, 0),
        **{"id": 17, "frameRate": rate, "numVehicles": 8, "numCars": 6, "numTrucks": 2},
        "upperLaneMarkings": ";".join(map(str, UPPER)),
        "lowerLaneMarkings": ";".join(map(str, LOWER)),
    }
    tables = {"tracks": (SAMPLE_COLUMNS, samples), "tracksMeta": (VEHICLE_COLUMNS, meta)}
    for name, (columns, rows) in {**tables, "recordingMeta": (RECORDING_COLUMNS, [about])}.items():
        with (folder / f"17_{name}.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, columns)
            writer.writeheader()
            writer.writerows(rows)
    return made


def told(folder: Path) -> Iterator[tuple[int, dict[str, float]]]:
    """Vehicle and signals of each row, in road coordinates: along the driving direction, and to its left."""
    with (folder / "17_tracksMeta.csv").open(newline="") as file:
        ways = {int(row["id"]): int(row["drivingDirection"]) for row in csv.DictReader(file)}
    with (folder / "17_tracks.csv").open(newline="") as file:
        for row in csv.DictReader(file):
            x = {name: float(value) for name, value in row.items()}
            up = ways[int(row["id"])] == 1
            along, left = (-1, 1) if up else (1, -1)
            yield (
                int(row["id"]),
                {
                    "frame": x["frame"],
                    "s": -x["x"] if up else x["x"] + x["width"],
                    "d": x["y"] + x["height"] if up else -x["y"],
                    "v_lon": along * x["xVelocity"],
                    "v_lat": left * x["yVelocity"],
                    "a_lon": along * x["xAcceleration"],
                    "a_lat": left * x["yAcceleration"],
                    "lane": x["laneId"],
                },
            )


@pytest.mark.parametrize(("seed", "rate"), [(1, 25), (2, 10), (3, 50), (4, 25), (5, 30)])
def test_every_column_is_read_as_the_format_says(seed: int, rate: int, tmp_path: Path) -> None:
    made = {x.id: x for x in write(tmp_path, seed, rate)}
    r = read_highd(tmp_path, "17")
    assert r.rate == rate
    expected: dict[int, list[dict[str, float]]] = {}
    for number, row in told(tmp_path):
        expected.setdefault(number, []).append(row)
    assert {*r.vehicle_id.tolist()} == {*expected}
    for k, number in enumerate(r.vehicle_id.tolist()):
        vehicle, rows = made[number], slice(r.start[k], r.start[k + 1])
        own = (r.length[k], r.width[k], r.kind[k], r.direction[k], r.first_frame[k], r.last_frame[k])
        last = vehicle.first + vehicle.frames - 1
        assert own == (*vehicle.size, vehicle.kind, vehicle.way, vehicle.first, last)
        for signal in ("s", "d", "v_lon", "v_lat", "a_lon", "a_lat"):
            wanted = [row[signal] for row in expected[number]]
            assert getattr(r, signal)[rows] == pytest.approx(wanted, abs=1e-6), (number, signal)
        lanes = [int(r.lanes[x].name) for x in r.lane[rows]]
        assert lanes == [int(row["lane"]) for row in expected[number]]
        assert r.row_frame[rows].tolist() == [row["frame"] for row in expected[number]]


def test_signals_are_the_motion_of_the_places(tmp_path: Path) -> None:
    """Where a sign were wrong in the reading above too, places and speeds would contradict each other."""
    made = {x.id: x for x in write(tmp_path, 6, 25)}
    r = read_highd(tmp_path, "17")
    for k, number in enumerate(r.vehicle_id.tolist()):
        rows = slice(r.start[k], r.start[k + 1])
        for place, speed, pull in (("s", "v_lon", "a_lon"), ("d", "v_lat", "a_lat")):
            moved = np.diff(getattr(r, place)[rows]) * 25
            speeds = getattr(r, speed)[rows]
            assert moved == pytest.approx((speeds[1:] + speeds[:-1]) / 2, abs=0.01)
            assert np.diff(speeds) * 25 == pytest.approx(getattr(r, pull)[rows][1:], abs=0.01)
        assert (r.v_lon[rows] > 0).all()
        assert made[number].speed[1] != 0
