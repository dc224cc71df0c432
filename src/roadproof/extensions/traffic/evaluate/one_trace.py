"""One trace to monitor: samples of a few vehicles on one road, from whatever file they came.

Where a file is one trace, it has for every time one row a vehicle, in equal steps.
"""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence, Sized
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import combinations, product
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extension import entries, import_entry
from roadproof.extensions.traffic.evaluate.robust import MOST_SAMPLES
from roadproof.extensions.traffic.evaluate.traces import KIND, by_vehicle, gather_one, refuse_missing
from roadproof.extensions.traffic.formats import samples
from roadproof.extensions.traffic.formats.recording import (
    BACKWARDS,
    Bools,
    Recording,
    kind_called,
    own_numbers,
)
from roadproof.extensions.traffic.formats.source import ReadTrace, beside
from roadproof.extensions.traffic.formats.sources import find_source, has_numbers
from roadproof.extensions.traffic.formats.straight import as_lanelet, of_road
from roadproof.extensions.traffic.formats.table import Column, ColumnTable
from roadproof.library.bind import occupies
from roadproof.library.roles import Roles
from roadproof.library.scenarios import roles
from roadproof.logic.custom_names import code_of, custom_signals_of
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import signals_of, with_values
from roadproof.semantics.sampled.batch import Array, Batch
from roadproof.world.drive import Drive, value_at
from roadproof.world.models import load_recorded_road, load_road
from roadproof.world.motion import states_at
from roadproof.world.not_read import left_out_in, road_not_read_note
from roadproof.world.road import Lanelet, Road
from roadproof.world.signals import FIXED, RECORDED, SIGNALS, SIZES, SignalName, SizeName

_PAIR = re.compile(r"(?P<path>.+):(?P<ids>\d{1,9}(?:,\d{1,9}){0,2})")


@dataclass(frozen=True)
class OneTrace:
    """A batch of one trace, its road, and the lane of each vehicle's centre at the start ("" for none).

    ``first`` is the time of the first sample as the source counts it: seconds, or a frame. ``notes``: what is
    odd in the recording that it is from. ``names``: what the source calls vehicles that have other names
    here. ``faults``: parts of motions that no vehicle drives; such a trace shows nothing.
    """

    source: str
    batch: Batch
    road: Road
    lanes: Mapping[str, str]
    first: str
    notes: tuple[str, ...] = ()
    names: Mapping[str, str] = field(default_factory=dict)
    faults: tuple[str, ...] = ()


def is_pair(text: str) -> bool:
    """Return whether ``text`` names vehicles of a recording, as ``highd/01_tracks.csv:12,15`` does."""
    return _PAIR.fullmatch(text) is not None


def read_pair(
    text: str,
    frames: tuple[int | None, int | None] = (None, None),
    strict: bool = False,
    road: str | None = None,
) -> OneTrace:
    """Vehicles of a recording on their common frames, or on those of ``frames`` (first, last).

    The first id is SV, the others are POV, or POV1 and POV2. ``road``: as for ``find_sources``. Raises
    ``InputError`` for files that are no recording, vehicles that are not there or drive in different
    directions, and no frames.
    """
    named = _PAIR.fullmatch(text)
    if named is None:
        raise InputError(f"{text}: name a pair as highd/01_tracks.csv:12,15, or three vehicles")
    path, numbers = named.groups()
    ids = [int(x) for x in numbers.split(",")]
    if len(set(ids)) < len(ids):
        raise InputError(f"{text}: each vehicle may be named once")
    by_role = dict(zip(roles(len(ids)), ids, strict=True))
    return read_vehicles(Path(path), by_role, frames, text, strict, road)


def read_vehicles(
    path: Path,
    by_role: Mapping[str, int],
    frames: tuple[int | None, int | None],
    text: str,
    strict: bool = False,
    road: str | None = None,
) -> OneTrace:
    """Return the trace of recorded vehicles, given by role (see ``read_pair``); ``text`` names the trace."""
    if road is None and is_samples_alone(path):
        road = USUAL_ROAD
    recording = find_source(path, strict, road).read()
    index = [_find(recording, number, text) for number in by_role.values()]
    if len({int(recording.direction[v]) for v in index}) > 1:
        raise InputError(f"{text}: the vehicles drive in different directions; name some of one direction")
    low = max(int(recording.first_frame[v]) for v in index)
    high = min(int(recording.last_frame[v]) for v in index)
    span = (low if frames[0] is None else frames[0], high if frames[1] is None else frames[1])
    if low > high or not low <= span[0] <= span[1] <= high:
        have = f"they share the frames {low} to {high}" if low <= high else "they share no frame"
        raise InputError(f"{text}, frames {span[0]} to {span[1]}: {have}")
    trace = cut_trace(recording, text, dict(zip(by_role, index, strict=True)), span)
    names = {role: str(number) for role, number in by_role.items()}
    return replace(trace, notes=(*trace.notes, *_overlaps(trace), *backwards(trace)), names=names)


USUAL_ROAD = "main-2"
"""The road of samples that say none."""


def is_samples_alone(path: Path) -> bool:
    """Return whether a file is a table of samples without a road beside it."""
    is_table = path.suffix == ".parquet" or (path.suffix == ".csv" and not has_numbers(path))
    return is_table and not path.name.endswith(samples.CONVERTED) and not beside(path, samples.ROAD_ENDING)


def play_samples(trace: OneTrace, roles: Roles) -> OneTrace:
    """Samples with their vehicles called as their roles; nothing but signals is given of them."""
    if not roles.by_name:
        return trace
    called, batch = roles.role_of, trace.batch
    signals = {(signal, called(name)): x for (signal, name), x in batch.signals.items()}
    sizes = {(size, called(name)): x for (size, name), x in batch.sizes.items()}
    lanes = {called(name): lane for name, lane in trace.lanes.items()}
    played = replace(batch, signals=signals, sizes=sizes, given={})
    return replace(trace, batch=played, lanes=lanes, names=roles.name_by_role)


def _overlaps(trace: OneTrace) -> Iterator[str]:
    """A line for each two vehicles whose boxes overlap with positive area, as evaluations have one."""
    signals, sizes, count = trace.batch.signals, trace.batch.sizes, int(trace.batch.lengths[0])
    axes: tuple[tuple[SignalName, SizeName], ...] = (("s", "length"), ("d", "width"))
    for one, other in combinations(trace.lanes, 2):
        depth = np.full(count, np.inf)
        for place, size in axes:
            first, second = signals[place, one][:count, 0], signals[place, other][:count, 0]
            rear = np.maximum(first - sizes[size, one][0], second - sizes[size, other][0])
            depth = np.minimum(depth, np.round(np.minimum(first, second) - rear, 6))
        frames = int(np.count_nonzero(depth > 0))
        if frames:
            yield f"vehicles {one} and {other} overlap in {frames} frames, by up to {depth.max():.2f} m"


def backwards(trace: OneTrace) -> Iterator[str]:
    """A line for each vehicle that drives backwards, for which RSS has no safe distance."""
    for name in trace.lanes:
        speed = trace.batch.signals["v_lon", name][: int(trace.batch.lengths[0]), 0]
        if speed.min() < BACKWARDS:
            yield (
                f"vehicle {name} drives backwards, at {speed.min():.3g} m/s: the safe distance of RSS holds "
                "for speeds of 0 or more, so rssViolation and danger decide nothing there"
            )


def _find(recording: Recording, number: int, text: str) -> int:
    place = np.flatnonzero(recording.vehicle_id == number)
    if not len(place):
        known = f"{recording.vehicle_id.min()} to {recording.vehicle_id.max()}"
        reason = f"recording {recording.name} has no vehicle {number}; ids are {known}"
        raise with_causes(InputError(f"{text}: {reason}"), left_out_in(recording.notes))
    return int(place[0])


def with_causes(error: InputError, notes: Iterable[str]) -> InputError:
    """Return an error about a vehicle that is missing with the notes that may say why, a line each."""
    return InputError("\n".join((str(error), *notes)))


def cut_trace(
    recording: Recording, source: str, vehicles: Mapping[str, int], frames: tuple[int, int]
) -> OneTrace:
    """Vehicles of a recording (indices by name), of one direction, from the first frame to the last.

    Lane predicates are decided by the recording, as in an evaluation.
    """

    way = int(recording.direction[next(iter(vehicles.values()))])
    road = road_of(recording, way)
    made = gather_one(recording, vehicles, frames, RECORDED)
    given: dict[Formula, Array] = {}
    own: dict[str, dict[str, Array]] = {}
    lanes = {}
    for name, v in vehicles.items():
        begin = int(recording.start[v]) + frames[0] - int(recording.first_frame[v])
        rows = slice(begin, begin + frames[1] - frames[0] + 1)
        for lanelet, inside in _lanelets(recording, way, rows):
            given[with_values(occupies(name, lanelet), {})] = inside[:, None]
        at = int(recording.lane[begin])
        lanes[name] = recording.lanes[at].name if at >= 0 else ""
        for column, values in recording.custom_signals.items():
            own.setdefault(column, {})[name] = values[rows, None]
    signals = {**made.signals, **dict(by_vehicle(own))}
    batch = Batch(made.dt, made.lengths, signals, made.sizes, given, source)
    first = f"frame {frames[0]}"
    return OneTrace(source, batch, road, lanes, first, recording.notes, faults=recording.faults)


def _lanelets(recording: Recording, way: int, rows: slice) -> Iterator[tuple[Lanelet, Bools]]:
    """The lanelets of a direction, and at which of some samples the box is in each."""
    ways = {lane.name: lane.direction for lane in recording.lanes}
    for j, lanelet in enumerate(recording.lanelets):
        if ways[lanelet.lane] == way:
            yield lanelet, recording.inside[rows, j]
    for k, lane in enumerate(recording.lanes if not recording.lanelets else ()):
        if lane.direction == way:
            yield as_lanelet(lane), (recording.occupancy[rows] >> np.uint32(k)) & 1 != 0


def road_of(recording: Recording, way: int) -> Road:
    """Return the lanes of one direction."""
    lanelets = tuple(lanelet for lanelet, _ in _lanelets(recording, way, slice(0)))
    names = {x.lane for x in lanelets}
    beside = frozenset(pair for pair in recording.beside if pair <= names)
    return Road(f"recording {recording.name}, direction {way}", lanelets, beside)


def sample_drive(drive: Drive, road: Road, horizon: Fraction, dt: Fraction, source: str) -> OneTrace:
    """A drive as a recording of it would have it: samples every ``dt`` s from 0 up to ``horizon``.

    Raises ``InputError`` for samples that are too many, or no time apart.
    """
    if dt <= 0:
        raise InputError(f"dt={dt}: the time between samples must be greater than zero")
    if horizon / dt >= MOST_SAMPLES:
        raise InputError(
            f"dt={dt}: {source} lasts {horizon} s, which makes more than {MOST_SAMPLES:,} samples"
        )
    times = [k * dt for k in range(int(horizon / dt) + 1)]
    columns: dict[tuple[str, str], Sequence[float]] = {}
    for name, motion in drive.vehicles.items():
        states = states_at(motion, times)
        columns |= {(x, name): [float(getattr(state, x)) for state in states] for x in SIGNALS}
    sizes: dict[tuple[SizeName, str], float] = {
        (x, n): float(getattr(m, x)) for n, m in drive.vehicles.items() for x in SIZES
    }
    kinds = {n: m.kind for n, m in drive.vehicles.items() if m.kind is not None}
    sizes |= {(KIND, name): float(code_of(kind)) for name, kind in kinds.items()}
    columns |= {key: [float(value_at(x, time)) for time in times] for key, x in drive.custom_signals.items()}
    return _one_trace(source, dt, columns, sizes, road, "0 s")


def refuse_unmeasured(trace: OneTrace, formula: Formula) -> None:
    """Raise ``InputError`` where a trace lacks a signal that a formula speaks of."""
    for name in signals_of([formula]):
        if not any((name, vehicle) in trace.batch.signals for vehicle in trace.lanes):
            raise InputError(
                f"{trace.source}: no recording has the signal {name}, which the formula needs: ask that of a "
                "drive"
            )
    refuse_missing(
        ((x.name, x.vehicle) for x in custom_signals_of([formula])), trace.batch.signals, trace.source
    )


def read_samples(path: Path, road: Road | None = None, strict: bool = False) -> OneTrace:
    """The trace of a file in which every vehicle is seen all the time: CSV, Parquet, OpenSCENARIO.

    ``road``: by default that which the file names or that beside it, or else main-2. ``strict``: nothing of
    the file may be left out. ``notes`` of the trace say in what the file contradicts itself. Raises
    ``InputError`` with file, row, column, value and rule, also where it contradicts itself too much.
    """
    own = entries("traces")
    if path.suffix in own:
        read: ReadTrace = import_entry(own[path.suffix])
        scenario = read(path, strict)
        table, road, notes = scenario.table, road or scenario.road, (*scenario.otherwise, *scenario.faults)
        computed, faults = scenario.computed, scenario.faults
    else:
        table, computed, faults = samples.read_columns(path), False, ()
        notes = samples.ignored_column_notes(table, strict)
    if road is None:
        known = beside(path, samples.ROAD_ENDING)
        road = load_recorded_road(known[0])[0] if known else load_road(USUAL_ROAD)
    if path.suffix not in own:
        notes += road_not_read_note(road, strict)
    lists = {name: values.tolist() for name, values in table.columns.items()}
    try:
        trace = of_columns(lists, road, str(path))
    except InputError as error:
        raise with_causes(error, notes) from None
    contradictions = samples.contradictions_in(table, of_road(road, samples.DIRECTION, path), computed)
    return replace(trace, notes=(*notes, *contradictions, *_overlaps(trace), *trace.notes), faults=faults)


def of_columns(columns: Mapping[str, Sequence[object]], road: Road, source: str = "columns") -> OneTrace:
    """The trace of columns named as in ``HEADER``: arrays, or a frame with such columns, in any order.

    There may be ``kind``, a class that makes every vehicle a car where it is missing, and custom signals.
    Times are numbers of seconds, taken as the decimals that they are shown as (nine places). Raises
    ``InputError`` with column, row, value and rule.
    """
    missing = [name for name in samples.HEADER if name not in columns]
    if missing:
        raise InputError(
            f"{source}: there is no column {', '.join(missing)}; columns are {', '.join(samples.HEADER)}"
        )
    rows = len(list(columns[samples.HEADER[0]]))
    sized = {name: x for name, x in columns.items() if isinstance(x, Sized) and not isinstance(x, str)}
    own = [name for name in samples.custom_signal_columns(sized) if len(sized[name]) == rows]
    kind = [next(name for name in (samples.LABEL, "kind") if name in columns)] if "kind" in columns else []
    read = {name: list(columns[name]) for name in (*samples.HEADER, *kind, *own)}
    lengths = {name: len(values) for name, values in read.items()}
    if len(set(lengths.values())) > 1:
        lengths_text = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise InputError(f"{source}: columns must be equally long, but have {lengths_text} rows")
    numeric = (samples.TIME, *RECORDED, *SIZES)
    values: dict[str, Column] = {
        x: np.array([_finite(source, k, x, value) for k, value in enumerate(read[x])]) for x in numeric
    }
    values[samples.TIME] = np.round(values[samples.TIME], 9)
    values[samples.VEHICLE] = np.array([str(x) for x in read[samples.VEHICLE]])
    values |= {name: own_numbers(read[name]) for name in own}
    kinds = map(str, read[kind[0]]) if kind else ["car"] * rows
    values[KIND] = np.array([float(code_of(kind_called(name))) for name in kinds])
    return _of_table(source, ColumnTable(Path(source), values, rows), own, road)


def _of_table(source: str, columns: ColumnTable, own: Sequence[str], road: Road) -> OneTrace:
    """The trace of rows, each with its time and vehicle. Raises ``InputError`` where they are no table."""
    names = list(dict.fromkeys(columns[samples.VEHICLE].tolist()))
    if len(np.unique(columns[samples.TIME])) < 2:
        raise InputError(f"{source}: fewer than two times; at least two samples are needed")
    ordered = samples.in_order(columns)
    table, clock = ordered.table, ordered.clock
    frames = samples.frames_of(table, ordered.ids, clock)
    count = int(frames.max()) + 1
    rows = {name: np.flatnonzero(table[samples.VEHICLE] == name) for name in names}
    for name, at in rows.items():
        if len(at) != count:
            raise InputError(
                f"{source}: vehicle {name} has {len(at)} of {count} samples: every vehicle needs exactly one "
                "row at every time; of vehicles that come and go, name some (FILE:12,15)"
            )
    sizes: dict[tuple[SizeName, str], float] = {}
    for name, size in product(names, FIXED):
        sizes[size, name], *others = {*table[size][rows[name]].tolist()}
        if others:
            what = "class" if size == KIND else "size"
            raise InputError(f"{source}: {size} of {name} changes; the {what} of a vehicle stays the same")
    read = {x: {n: table[x][rows[n]] for n in names} for x in (*RECORDED, *own)}
    signals: dict[tuple[str, str], Array] = {(x, n): read[x][n] for x in RECORDED for n in names}
    signals |= by_vehicle({x: read[x] for x in own})
    first = f"{float(columns[samples.TIME].min()):.15g} s"
    return _one_trace(source, 1 / Fraction(clock.rate), signals, sizes, road, first)


def _finite(source: str, row: int, column: str, value: object) -> float:
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise InputError(f"{source}, row {row}, column {column}={value!r}: a finite number is needed")
    return number


def _one_trace(
    source: str,
    dt: Fraction,
    columns: Mapping[tuple[str, str], Sequence[float] | Array],
    sizes: Mapping[tuple[SizeName, str], float],
    road: Road,
    first: str,
) -> OneTrace:
    batch = Batch(
        dt,
        np.array([len(next(iter(columns.values())))]),
        {key: np.array(values)[:, None] for key, values in columns.items()},
        {key: np.array([value]) for key, value in sizes.items()},
        source=source,
    )
    names = dict.fromkeys(name for _, name in sizes)
    lanes = {n: _lane_of(road, columns["s", n][0], columns["d", n][0], sizes["width", n]) for n in names}
    made = OneTrace(source, batch, road, lanes, first)
    return replace(made, notes=tuple(backwards(made)))


def _lane_of(road: Road, s: float, d: float, width: float) -> str:
    """The lane that holds the middle of the box's front; "" for none."""
    for lanelet in road.lanelets:
        low, high = lanelet.s
        right, left = lanelet.d
        if right <= d - width / 2 < left and (low is None or s >= low) and (high is None or s < high):
            return lanelet.lane
    return ""
