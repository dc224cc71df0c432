"""One trace to monitor: samples of a few vehicles on a straight road, from whatever file they came.

A CSV file has the header ``HEADER`` and, for every time, one row a vehicle; times are decimals in
equal steps, the same for all vehicles. SI units and coordinates are those of semantics §2.
"""

import csv
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import with_values
from roadproof.monitor.batch import Array, Batch
from roadproof.signals import RECORDED, SIGNALS, SIZES
from roadproof.spec.bind import occupies
from roadproof.traffic.formats import other_table
from roadproof.traffic.highd import read_highd
from roadproof.traffic.pairs import row_of
from roadproof.traffic.recording import Integers, Recording
from roadproof.traffic.traces import gather
from roadproof.world.drive import Drive
from roadproof.world.motion import state_at
from roadproof.world.road import Lanelet, Road

HEADER = ("time", "vehicle", *RECORDED, *SIZES)
LARGEST_FILE = 100_000_000
_PAIR = re.compile(r"(?P<path>.*)_tracks\.csv:(?P<ids>\d{1,9}(?:,\d{1,9}){0,2})")
_TIME = re.compile(r"-?\d{1,12}(\.\d{1,12})?")
_NAMES = {1: ("SV",), 2: ("SV", "POV"), 3: ("SV", "POV1", "POV2")}


@dataclass(frozen=True)
class OneTrace:
    """A batch of one trace, its road, and the lane of each vehicle's centre at the start ("" for none).

    ``first`` is the time of the first sample as the source counts it: seconds, or a frame. ``notes``: what is
    odd in the recording that it is from.
    """

    source: str
    batch: Batch
    road: Road
    lanes: Mapping[str, str]
    first: str
    notes: tuple[str, ...] = ()


def is_pair(text: str) -> bool:
    """Whether ``text`` names vehicles of a highD recording, as ``highd/01_tracks.csv:12,15`` does."""
    return _PAIR.fullmatch(text) is not None


def read_pair(text: str, frames: tuple[int | None, int | None] = (None, None)) -> OneTrace:
    """Vehicles of a highD recording on their common frames, or on those of ``frames`` (first, last).

    The first id is SV, the others are POV, or POV1 and POV2. Raises ``InputError`` for files that are
    no highD recording, vehicles that are not there or drive in different directions, and no frames.
    """
    named = _PAIR.fullmatch(text)
    if named is None:
        raise InputError(f"{text}: name a pair as highd/01_tracks.csv:12,15, or three vehicles")
    path = Path(named["path"])
    ids = [int(x) for x in named["ids"].split(",")]
    recording = read_highd(path.parent, path.name)
    index = [_find(recording, number, text) for number in ids]
    if len(set(ids)) < len(ids):
        raise InputError(f"{text}: each vehicle may be named once")
    if len({int(recording.direction[v]) for v in index}) > 1:
        raise InputError(f"{text}: the vehicles drive in different directions; name some of one direction")
    low = max(int(recording.first_frame[v]) for v in index)
    high = min(int(recording.last_frame[v]) for v in index)
    wanted = (low if frames[0] is None else frames[0], high if frames[1] is None else frames[1])
    if low > high or not low <= wanted[0] <= wanted[1] <= high:
        have = f"they share the frames {low} to {high}" if low <= high else "they share no frame"
        raise InputError(f"{text}, frames {wanted[0]} to {wanted[1]}: {have}")
    return cut_trace(recording, text, dict(zip(_NAMES[len(ids)], index, strict=True)), wanted)


def _find(recording: Recording, number: int, text: str) -> int:
    place = np.flatnonzero(recording.vehicle_id == number)
    if not len(place):
        known = f"{recording.vehicle_id.min()} to {recording.vehicle_id.max()}"
        raise InputError(f"{text}: recording {recording.name} has no vehicle {number}; ids are {known}")
    return int(place[0])


def cut_trace(
    recording: Recording, source: str, vehicles: Mapping[str, int], frames: tuple[int, int]
) -> OneTrace:
    """Vehicles of a recording (indices by name), of one direction, from the first frame to the last.

    Lane predicates are decided by the recording, as in an evaluation.
    """

    def one(value: int) -> Integers:
        return np.array([value])

    way = int(recording.direction[next(iter(vehicles.values()))])
    road = _road_of(recording, way)
    made = gather(
        recording, {n: one(v) for n, v in vehicles.items()}, one(frames[0]), one(frames[1]), RECORDED
    )
    given: dict[Formula, Array] = {}
    lanes = {}
    for name, v in vehicles.items():
        begin = int(row_of(recording, one(v), one(frames[0]))[0])
        bits = recording.occupancy[begin : begin + frames[1] - frames[0] + 1]
        for k, lane in enumerate(recording.lanes):
            for lanelet in road.lanelets_of(lane.name) if lane.direction == way else ():
                given[with_values(occupies(name, lanelet), {})] = ((bits >> np.uint32(k)) & 1)[:, None] != 0
        at = int(recording.lane[begin])
        lanes[name] = recording.lanes[at].name if at >= 0 else ""
    batch = Batch(made.dt, made.lengths, made.signals, made.sizes, given)
    return OneTrace(source, batch, road, lanes, f"frame {frames[0]}", recording.notes)


def _road_of(recording: Recording, way: int) -> Road:
    """The lanes of one direction as a straight main road; a lane is one lanelet, without end."""
    lanelets = []
    for lane in recording.lanes:
        if lane.direction == way and lane.d is not None:
            right, left = (Fraction(str(x)) for x in lane.d)
            lanelets.append(Lanelet(lane.name, lane.name, "main", "main", (None, None), (right, left)))
    names = {x.lane for x in lanelets}
    beside = frozenset(pair for pair in recording.beside if pair <= names)
    return Road(f"recording {recording.name}, direction {way}", tuple(lanelets), beside)


def sample_drive(drive: Drive, road: Road, horizon: Fraction, dt: Fraction, source: str) -> OneTrace:
    """A drive as a recording of it would have it: samples every ``dt`` s from 0 up to ``horizon``."""
    if dt <= 0:
        raise InputError(f"dt={dt}: the time between samples must be greater than zero")
    times = [k * dt for k in range(int(horizon / dt) + 1)]
    columns: dict[tuple[str, str], list[float]] = {}
    for name, motion in drive.vehicles.items():
        states = [state_at(motion, time) for time in times]
        columns |= {(x, name): [float(getattr(state, x)) for state in states] for x in SIGNALS}
    sizes: dict[tuple[str, str], float] = {
        (x, n): float(getattr(m, x)) for n, m in drive.vehicles.items() for x in SIZES
    }
    return _one_trace(source, dt, columns, sizes, road, "0 s")


def read_samples(path: Path, road: Road) -> OneTrace:
    """The trace of a CSV file (see above) on ``road``.

    Raises ``InputError`` with file, row, column, value and rule.
    """
    rows = _rows(path)
    names = list(dict.fromkeys(row["vehicle"] for row in rows))
    times = list(dict.fromkeys(row["time"] for row in rows))
    if len(times) < 2:
        raise InputError(f"{path}: {len(times)} times; at least two samples are needed")
    exact = [_time(path, text) for text in times]
    dt = exact[1] - exact[0]
    for k, time in enumerate(exact):
        if time != exact[0] + k * dt or dt <= 0:
            raise InputError(f"{path}: time={times[k]} breaks the step of {float(dt):g} s; use equal steps")
    wanted = [(time, name) for time in times for name in names]
    found = [(row["time"], row["vehicle"]) for row in rows]
    if sorted(found) != sorted(wanted):
        raise InputError(
            f"{path}: {len(found)} rows for {len(times)} times and {len(names)} vehicles: every vehicle "
            "needs exactly one row at every time"
        )
    columns: dict[tuple[str, str], list[float]] = {(x, n): [] for x in (*RECORDED, *SIZES) for n in names}
    order = {time: k for k, time in enumerate(times)}
    for number, row in sorted(enumerate(rows, start=2), key=lambda x: order[x[1]["time"]]):
        for x in (*RECORDED, *SIZES):
            columns[x, row["vehicle"]].append(_number(path, number, x, row[x]))
    sizes: dict[tuple[str, str], float] = {}
    for name in names:
        for x in SIZES:
            values = columns.pop((x, name))
            if len(set(values)) > 1:
                raise InputError(f"{path}: {x} of {name} changes; the size of a vehicle stays the same")
            sizes[x, name] = values[0]
    return _one_trace(str(path), dt, columns, sizes, road, f"{times[0]} s")


def _rows(path: Path) -> list[dict[str, str]]:
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise InputError(f"{path} is larger than {LARGEST_FILE} bytes; cut out what is to be monitored")
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}); check the path") from None
    other = other_table(content, len(HEADER))
    if other is not None:
        raise InputError(f"{path}: the file {other}")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{path}: is not UTF-8 text") from None
    lines = text.splitlines()
    if not lines or tuple(lines[0].split(",")) != HEADER:
        raise InputError(f"{path}, row 1: the header must be {','.join(HEADER)}")
    made = []
    for number, cells in enumerate(csv.reader(lines[1:]), start=2):
        if len(cells) != len(HEADER):
            raise InputError(f"{path}, row {number}: {len(cells)} cells, but {len(HEADER)} are needed")
        made.append(dict(zip(HEADER, cells, strict=True)))
    return made


def _time(path: Path, text: str) -> Fraction:
    if not _TIME.fullmatch(text):
        raise InputError(f"{path}, column time={text!r}: a decimal number of seconds is needed")
    return Fraction(text)


def _number(path: Path, row: int, column: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{path}, row {row}, column {column}={text!r}: a finite number is needed")
    return value


def _one_trace(
    source: str,
    dt: Fraction,
    columns: Mapping[tuple[str, str], Sequence[float]],
    sizes: Mapping[tuple[str, str], float],
    road: Road,
    first: str,
) -> OneTrace:
    length = len(next(iter(columns.values())))
    batch = Batch(
        dt,
        np.array([length]),
        {key: np.array(values)[:, None] for key, values in columns.items()},  # type: ignore[misc]
        {key: np.array([value]) for key, value in sizes.items()},  # type: ignore[misc]
    )
    names = dict.fromkeys(name for _, name in columns)
    lanes = {n: _lane_of(road, columns["s", n][0], columns["d", n][0], sizes["width", n]) for n in names}
    return OneTrace(source, batch, road, lanes, first)


def _lane_of(road: Road, s: float, d: float, width: float) -> str:
    """The lane that holds the middle of the box's front; "" for none."""
    for lanelet in road.lanelets:
        low, high = lanelet.s
        right, left = lanelet.d
        if right <= d - width / 2 < left and (low is None or s >= low) and (high is None or s < high):
            return lanelet.lane
    return ""
