"""The highD reader against recordings computed by hand, and against every kind of damage."""

import csv
import random
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
import pytest

from examples import some
from extensions.traffic.tiny_highd import Files, tiny_files, write_files
from roadproof.errors import InputError, MissingSolverError
from roadproof.extensions.traffic.formats.highd import find_highd, read_highd
from roadproof.extensions.traffic.formats.highd_columns import (
    RECORDING_COLUMNS,
    SAMPLE_COLUMNS,
    VEHICLE_COLUMNS,
)
from roadproof.extensions.traffic.formats.recording import Recording, keep_vehicles
from tables import read_table

TRACKS, META, RECORDING = "01_tracks.csv", "01_tracksMeta.csv", "01_recordingMeta.csv"


def read(files: Files, folder: Path) -> Recording:
    return read_highd(write_files(files, folder), "01")


def same(a: Recording, b: Recording) -> bool:
    return all(np.array_equal(getattr(a, f.name), getattr(b, f.name)) for f in fields(Recording))


@pytest.mark.parametrize(("layout", "upper_lane", "lower_lanes"), [("2+2", "2", "56"), ("3+2", "3", "67")])
def test_both_directions_by_hand(layout: str, upper_lane: str, lower_lanes: str, tmp_path: Path) -> None:
    r = read(tiny_files(layout), tmp_path)
    assert r.notes == ()
    assert (r.rate, r.vehicle_id.tolist(), r.direction.tolist()) == (25, [1, 2, 3], [1, 2, 2])
    assert r.kind.tolist() == ["Car", "Car", "Truck"]
    assert r.length.tolist() == [4.5, 4.0, 12.0]
    assert r.width.tolist() == [1.8, 2.0, 2.5]
    assert (r.start.tolist(), r.first_frame.tolist()) == ([0, 4, 7, 10], [1, 2, 1])
    assert r.last_frame.tolist() == [4, 4, 3]
    assert r.row_frame.tolist() == [1, 2, 3, 4, 2, 3, 4, 1, 2, 3]
    # Direction 1: s = -x, d = y + height, along is -x, left is +y (down in the picture).
    assert r.s[:4].tolist() == [-300.0, -298.7, -297.4, -296.1]
    assert r.d[:4].tolist() == [11.31, 11.31, 11.32, 11.32]
    assert r.v_lon[:2].tolist() == [32.5, 32.53]
    assert (r.v_lat[0], r.a_lon[0], r.a_lat[0]) == (0.1, 1.0, 0.2)
    # Direction 2: s = x + width, d = -y, along is +x, left is -y.
    assert r.s[4:7].tolist() == [14.0, 15.2, 16.4]
    assert r.d[4:7].tolist() == [-26.0, -25.99, -25.98]
    assert (r.v_lon[4], r.v_lat[4], r.a_lon[4], r.a_lat[4]) == (30.0, 0.25, 0.5, 0.75)
    # Lanes. The truck touches the marking at 24.96 (22.46 + 2.5) in its first frame: no occupation yet.
    index = {lane.name: k for k, lane in enumerate(r.lanes)}
    left, right = (index[name] for name in lower_lanes)
    assert r.occupancy[:4].tolist() == [1 << index[upper_lane]] * 4
    assert r.occupancy[4:7].tolist() == [1 << right] * 3
    assert r.occupancy[7:].tolist() == [1 << left, 1 << left | 1 << right, 1 << left | 1 << right]
    assert r.lane[7:].tolist() == [left, left, left]
    assert r.beside_mask(left) == 1 << right
    assert r.zones.tolist() == [1] * 10


def test_lane_names_are_lane_ids(tmp_path: Path) -> None:
    r = read(tiny_files("3+2"), tmp_path)
    assert [(lane.name, lane.direction) for lane in r.lanes] == [
        ("2", 1),
        ("3", 1),
        ("4", 1),
        ("6", 2),
        ("7", 2),
    ]
    assert frozenset(("4", "6")) not in r.beside


def test_keep_vehicles(tmp_path: Path) -> None:
    r = read(tiny_files(), tmp_path)
    kept = keep_vehicles(r, r.kind == "Car")
    assert kept.start.tolist() == [0, 4, 7]
    assert same(keep_vehicles(r, np.ones(3, bool)), r)
    assert keep_vehicles(r, r.kind == "Truck").s.tolist() == r.s[7:].tolist()


def test_shuffled_rows_are_sorted_and_noted(tmp_path: Path) -> None:
    expected = read(tiny_files(), tmp_path / "a")
    files = tiny_files()
    rows = files[TRACKS][1:]
    random.Random(1).shuffle(rows)
    files[TRACKS][1:] = rows
    found = read(files, tmp_path / "b")
    assert "sorted" in found.notes[0]
    assert np.array_equal(found.s, expected.s)
    assert np.array_equal(found.occupancy, expected.occupancy)


def test_find_recordings(tmp_path: Path) -> None:
    for name in ("02_tracks.csv", "01_recordingMeta.csv", "10_tracksMeta.csv", "x_tracks.csv"):
        (tmp_path / name).write_text("")
    assert list(find_highd(tmp_path)) == ["01", "02", "10"]
    assert list(find_highd(tmp_path / "02_tracks.csv")) == ["02"]
    assert find_highd(tmp_path / "x_tracks.csv") == find_highd(tmp_path / "none") == {}


def change(file: str, row: int, column: str, value: str) -> Callable[[Files], None]:
    def apply(files: Files) -> None:
        files[file][row][files[file][0].index(column)] = value

    return apply


DAMAGES: dict[str, tuple[Callable[[Files], None], str]] = {
    **{name: (change(*cell), said) for name, *cell, said in read_table(__file__, "damaged_cells")},
    "missing file": (lambda f: f.pop(META) and None, r"01_tracksMeta.csv: the file cannot be read"),
    "no rows": (
        lambda f: f.__setitem__(TRACKS, f[TRACKS][:1]),
        r"01_tracks.csv: the file has a header but no rows",
    ),
    "missing column": (lambda f: [row.pop(3) for row in f[TRACKS]] and None, "row 1: missing columns y"),
    "extra column": (
        lambda f: [row.append("lane" if k == 0 else "1") for k, row in enumerate(f[TRACKS])] and None,
        r"row 1: columns 'lane' are not part",
    ),
    "columns swapped": (lambda f: f[TRACKS][0].insert(2, f[TRACKS][0].pop(3)), "must come in the order"),
    "short row": (lambda f: f[TRACKS][4].pop() and None, "row 5: the row has 24 fields, the format 25"),
    "frame gap": (lambda f: f[TRACKS].pop(6) and None, r"vehicle id=2, frame=4: the frame before it is 2"),
    "last frame missing": (
        lambda f: f[TRACKS].pop(4) and None,
        r"id=1, column numFrames=4: 01_tracks.csv has 3",
    ),
    "duplicate": (
        lambda f: f[TRACKS].insert(3, [*f[TRACKS][2][:2], "9", *f[TRACKS][2][3:]]),
        r"row 4, column frame=2: vehicle and frame",
    ),
    "vehicle without rows": (
        lambda f: f.__setitem__(TRACKS, f[TRACKS][:8]),
        r"row 4, column id=3: the vehicle has no rows in 01_tracks.csv",
    ),
    "two recordings": (lambda f: f[RECORDING].append(f[RECORDING][1]), "2 rows; one recording has one row"),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_damage_is_named(name: str, tmp_path: Path) -> None:
    damage, message = DAMAGES[name]
    files = tiny_files()
    damage(files)
    with pytest.raises(InputError, match=message):
        read(files, tmp_path)


def test_wrong_driving_direction(tmp_path: Path) -> None:
    files = tiny_files()
    change(META, 2, "drivingDirection", "1")(files)
    for row in (5, 6, 7):
        change(TRACKS, row, "x", str(50 + 10 * row))(files)
    with pytest.raises(InputError, match=r"vehicle id=2, column drivingDirection=1: .* moves the other way"):
        read(files, tmp_path)


def test_sizes_may_differ_by_rounding(tmp_path: Path) -> None:
    files = tiny_files()
    change(TRACKS, 5, "width", "4.01")(files)
    assert read(files, tmp_path).length[1] == 4.0


def test_without_polars(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "polars", None)
    with pytest.raises(MissingSolverError, match="tables of traffic need polars: install polars"):
        read(tiny_files(), tmp_path)


def test_jump_and_strange_lane_are_noted(tmp_path: Path) -> None:
    files = tiny_files()
    change(TRACKS, 7, "x", "15.40")(files)
    change(TRACKS, 7, "laneId", "5")(files)
    jump, lane = read(files, tmp_path).notes
    cell, rule = (
        "01_tracks.csv, row 8, column laneId=5",
        "laneId is not the lane of the box's centre in 1 rows of 10",
    )
    assert lane == f"{cell}: {rule}"
    cell = "01_tracks.csv, row 8, column x=15.4 of vehicle 2"
    assert jump.startswith(f"{cell}: a position and the velocity differ by more than 1 m from one frame")


def test_rows_are_those_of_the_file(tmp_path: Path) -> None:
    """In shuffled files too: the truck's last row, where its centre crosses the marking, is row 2."""
    files = tiny_files()
    change(TRACKS, 10, "y", "24.46")(files)
    files[TRACKS].insert(1, files[TRACKS].pop())
    change(META, 2, "height", "-2.00")(files)
    files[META].reverse()
    files[META].insert(0, files[META].pop())
    with pytest.raises(InputError, match=r"row 3, column height=-2.0"):
        read(files, tmp_path)
    change(META, 2, "height", "2.00")(files)
    r = read(files, tmp_path)
    assert [r.lanes[k].name for k in r.lane[7:]] == ["5", "5", "6"]
    assert any(note.startswith("01_tracks.csv, row 2, column laneId=5: ") for note in r.notes)
    assert any(note.startswith("01_tracks.csv, row 2, column y=24.46 of vehicle 3: ") for note in r.notes)


SPOILS = [
    "truncate",
    "empty",
    "noise",
    "drop row",
    "double row",
    "cut row",
    "swap cells",
    "cell",
    "shuffle",
    "splice",
]
CELLS = (b"", b"nan", b"-inf", b"1e999", b"x", b"-7", b"0x10", b"1_0", b'"', b"9" * 40, b" 3", b"--1", b"\0")


def _spoil(files: dict[str, bytes], chance: random.Random) -> str:
    """Damage one file in one random way; returns what was done."""
    name = chance.choice(sorted(files))
    content = files[name]
    lines = content.split(b"\n")
    row = chance.randrange(len(lines) - 1)
    match kind := chance.choice(SPOILS):
        case "truncate":
            content = content[: chance.randrange(len(content))]
        case "empty":
            content = chance.choice([b"", b"\n", b"\n\n\n", b"\0" * 100])
        case "noise":
            place = chance.randrange(len(content))
            content = content[:place] + bytes([chance.randrange(128, 256)]) + content[place + 1 :]
        case "drop row":
            content = b"\n".join(lines[:row] + lines[row + 1 :])
        case "double row":
            content = b"\n".join(lines[: row + 1] + lines[row:])
        case "cut row":
            lines[row] = lines[row][: chance.randrange(max(1, len(lines[row])))]
            content = b"\n".join(lines)
        case "swap cells":
            cells = lines[row].split(b",")
            i, j = chance.sample(range(len(cells)), 2)
            cells[i], cells[j] = cells[j], cells[i]
            lines[row] = b",".join(cells)
            content = b"\n".join(lines)
        case "cell":
            cells = lines[row].split(b",")
            cells[chance.randrange(len(cells))] = chance.choice(CELLS)
            lines[row] = b",".join(cells)
            content = b"\n".join(lines)
        case "shuffle":
            body = lines[1:-1]
            chance.shuffle(body)
            content = b"\n".join([lines[0], *body, b""])
        case "splice":
            content = content[: len(content) // 2] + files[sorted(files)[0]]
    files[name] = content
    return f"{kind} in {name}"


def test_fuzz_never_crashes_and_never_stays_silent(tmp_path: Path) -> None:
    """Damages: an InputError, or a note, or the very same recording; never anything else."""
    original = write_files(tiny_files(), tmp_path / "original")
    expected = read_highd(original, "01")
    texts = {path.name: path.read_bytes() for path in original.iterdir()}
    chance = random.Random(34502)
    outcomes = {"refused": 0, "noted": 0, "harmless": 0}
    folder = tmp_path / "spoiled"
    folder.mkdir()
    silent, unnamed = [], []
    tried = some(600)
    for _ in range(tried):
        files = dict(texts)
        done = _spoil(files, chance)
        for name, content in files.items():
            (folder / name).write_bytes(content)
        try:
            found = read_highd(folder, "01")
        except InputError as error:
            unnamed += [] if "01_" in str(error) else [str(error)]
            outcomes["refused"] += 1
            continue
        if found.notes:
            outcomes["noted"] += 1
        elif same(found, expected):
            outcomes["harmless"] += 1
        else:
            silent.append(done)
    assert not unnamed
    # A plausible value in place of another (say -7 for an acceleration) cannot be told from the truth.
    assert all(done.startswith(("cell", "swap cells")) for done in silent), silent
    assert len(silent) < tried / 20, silent
    assert outcomes["refused"] > tried * 7 / 12
    assert outcomes["harmless"] < tried / 3, outcomes


# --- highD files that vary every column in both directions, against a reading of them with ``csv`` alone

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
