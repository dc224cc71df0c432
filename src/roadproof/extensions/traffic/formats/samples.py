"""Samples of vehicles in road coordinates, as CSV or Parquet: a recording, or one trace.

A file has the columns ``HEADER``, and may have ``kind`` (a class such as Car, which is the default, or
Truck), and columns of custom signals; SI units and coordinates are those of semantics §2.
NAME_road.toml beside NAME.csv or NAME.parquet, in the form of models/roads, says where its lanes are.
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.clock import Clock, clock_of, rate_text
from roadproof.extensions.traffic.formats.content import columns_not_read_note
from roadproof.extensions.traffic.formats.contradictions import contradiction_notes
from roadproof.extensions.traffic.formats.plausible import (
    LARGEST_ACCELERATION,
    LARGEST_SIZE,
    LARGEST_SPEED,
    ContradictionChecks,
    contradiction_checks,
)
from roadproof.extensions.traffic.formats.recording import (
    Floats,
    Integers,
    Recording,
    own_numbers,
    with_notes,
)
from roadproof.extensions.traffic.formats.reliable import MOST_LEFT_OUT, left_out_note, reliable_part
from roadproof.extensions.traffic.formats.row_order import by_time, by_vehicle, steps_of
from roadproof.extensions.traffic.formats.source import first_line
from roadproof.extensions.traffic.formats.straight import StraightRoad, of_road, place_recording
from roadproof.extensions.traffic.formats.table import (
    RULES,
    CellError,
    Column,
    ColumnTable,
    Frame,
    Kind,
    cell_error,
    count_lines,
    polars_module,
    read_pieces,
    read_table,
)
from roadproof.library.roles import vehicle_order
from roadproof.reasons import ReasonKind
from roadproof.runtime.file_kind import other_format
from roadproof.runtime.files import refuse_name
from roadproof.world.models import load_recorded_road, load_road
from roadproof.world.not_read import road_not_read_note
from roadproof.world.signals import RECORDED, SIGNALS, SIZES

PIECE = 250_000
"""Rows of a large file that are in memory at once."""


def read_parquet(path: Path, required: Mapping[str, Kind], optional: Mapping[str, Kind]) -> ColumnTable:
    """The columns of a Parquet file with ``required`` and perhaps ``optional`` columns, in any order.

    Whole numbers may stand for texts; further columns are read as lists. Raises ``InputError``.
    """
    with _readable(path):
        frame = polars_module().read_parquet(path, use_pyarrow=False, glob=False)
    return _table(path, frame, required, optional)


def parquet_pieces(
    path: Path, required: Mapping[str, Kind], optional: Mapping[str, Kind]
) -> Iterator[ColumnTable]:
    """Yield the columns (see ``read_parquet``) in pieces of PIECE rows, one in memory at a time."""
    for begin in range(0, max(1, count_rows(path)), PIECE):
        with _readable(path):
            frame = polars_module().scan_parquet(path, glob=False).slice(begin, PIECE).collect()
        yield _table(path, frame, required, optional, begin)


def count_rows(path: Path) -> int:
    """Return how many rows a Parquet file has. Raises ``InputError``."""
    pl = polars_module()
    with _readable(path):
        return int(pl.scan_parquet(path, glob=False).select(pl.len()).collect().item())


@contextmanager
def _readable(path: Path) -> Iterator[None]:
    refuse_name(path)
    pl = polars_module()
    try:
        yield
    except OSError as error:
        reason = error.strerror or str(error).partition("\n")[0][:200]
        raise InputError(f"{path}: the file cannot be read ({reason}); check the path") from None
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException) as error:
        with path.open("rb") as file:
            other = other_format(file.read(1000), b"PAR1")
        if other is not None:
            raise InputError(f"{path}: the file {other}") from None
        reason = str(error).partition("\n")[0][:200]
        raise InputError(
            f"{path}: no readable Parquet file ({reason}); get it again from its source"
        ) from None


def _table(
    path: Path, frame: Frame, required: Mapping[str, Kind], optional: Mapping[str, Kind], before: int = 0
) -> ColumnTable:
    """The columns of rows of a file, of which there are others ``before``."""
    others = [name for name in frame.columns if name not in required and name.isidentifier()]
    known: dict[str, Kind] = {**required, **dict.fromkeys(others, "list"), **optional}
    missing = [name for name in required if name not in frame.columns]
    extra = [name for name in frame.columns if name not in known]
    if missing or extra:
        message = (
            f"missing columns {', '.join(missing)}" if missing else f"unknown columns {', '.join(extra)}"
        )
        raise InputError(f"{path}: {message}; the format has {', '.join(known)}")
    if not frame.height:
        raise InputError(f"{path}: the file has no rows; get it again from its source")
    columns = {
        name: _parquet_column(path, frame[name], name, kind, before)
        for name, kind in known.items()
        if name in frame.columns
    }
    places = np.arange(before, before + frame.height) if before else None
    return ColumnTable(path, columns, frame.height, places)


def _parquet_column(path: Path, values: Any, name: str, kind: Kind, before: int) -> Column:
    """A column as an array of its kind."""
    pl = polars_module()
    if kind == "list":
        return np.array(["" if x is None else str(x) for x in values.to_list()], np.str_)
    whole, text = values.dtype.is_integer(), values.dtype in (pl.String, pl.Categorical)
    if not {"integer": whole, "number": values.dtype.is_numeric()}.get(kind, whole or text):
        raise InputError(f"{path}, column {name}: {values.dtype} is no type for it; {RULES[kind]}")
    if values.null_count():
        raise cell_error(path, before + int(values.is_null().arg_max()), name, "null", RULES[kind])
    array: Column = values.cast({"integer": pl.Int64, "number": pl.Float64}.get(kind, pl.String)).to_numpy()
    wrong = ~np.isfinite(array) if kind in ("integer", "number") else array == ""
    if wrong.any():
        row = int(np.argmax(wrong))
        raise cell_error(path, before + row, name, repr(values[row]), RULES[kind])
    return array


TIME, VEHICLE = "time", "vehicle"
HEADER = (TIME, VEHICLE, *RECORDED, *SIZES)
ROAD_ENDING = "_road.toml"
CONVERTED = ".samples.parquet"
"""How the files of recordings that were converted end; they are none of these."""
LABEL = "vehicle category"
"""What a file calls a vehicle, where ``kind`` puts several together; no file of samples has it."""
DIRECTION = 1
"""The only driving direction of such a file."""
LARGEST_PLACE = 1_000_000.0
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*", re.ASCII)
_KINDS: dict[str, Kind] = {name: "text" if name == "vehicle" else "number" for name in HEADER}


def read_columns(path: Path) -> ColumnTable:
    """The columns of a file, with ``kind`` and custom signals where it has them. Raises ``InputError``."""
    if path.suffix == ".parquet":
        return read_parquet(path, _KINDS, {"kind": "text"})
    return read_table(path, *_header_of(path))


def column_pieces(path: Path) -> Iterator[ColumnTable]:
    """Yield the columns of a file in pieces, one in memory at a time. Raises ``InputError``."""
    if path.suffix == ".parquet":
        return parquet_pieces(path, _KINDS, {"kind": "text"})
    return read_pieces(path, *_header_of(path))


def count_samples(path: Path) -> int:
    """Return how many rows a file has. Raises ``InputError``."""
    return count_rows(path) if path.suffix == ".parquet" else count_lines(path) - 1


def _header_of(path: Path) -> tuple[tuple[str, ...], dict[str, Kind]]:
    """The columns of a CSV file, in any order, and the kinds of those that are read."""
    names = tuple(first_line(path).split(","))
    more = [name for name in names if name not in HEADER]
    if not {*HEADER} <= {*names} or len({*names}) < len(names) or not all(map(_NAME.fullmatch, more)):
        return HEADER, _KINDS
    kinds: dict[str, Kind] = {name: "text" if name == "kind" else "list" for name in more}
    return names, {**_KINDS, **kinds}


def custom_signal_columns(names: Iterable[str]) -> tuple[str, ...]:
    """Return the columns that may be custom signals, none of which is a known signal."""
    return tuple(name for name in names if name not in (*HEADER, *SIGNALS, "kind", LABEL))


def ignored_column_notes(columns: ColumnTable, strict: bool) -> tuple[str, ...]:
    """A note on columns of signals that no recording has, such as jerk; refused if ``strict``."""
    read = (*HEADER, "kind", LABEL, *custom_signal_columns(columns.columns))
    return columns_not_read_note(columns.path, columns.columns, read, {}, strict)


def read_recording(path: Path, strict: bool = True, road: str | None = None) -> Recording:
    """The recording of a file, on a road or that beside it; unless ``strict``, bad vehicles are left out.

    Raises ``InputError``. Vehicles that are not called by whole numbers are numbered; ``notes`` tell how.
    """
    columns = read_columns(path)
    not_read = (*ignored_column_notes(columns, strict), *ignored_map_notes(road, strict))
    return recording_of(columns, road_of(path, road), path.stem, not_read, strict)


def ignored_map_notes(road: str | None, strict: bool) -> tuple[str, ...]:
    """The note on parts of the map of a named road that were not read; refused if ``strict``."""
    return () if road is None else road_not_read_note(load_road(road), strict)


def road_of(path: Path, road: str | None = None) -> StraightRoad:
    """The ``road`` of a file of samples, by default that beside it. Raises ``InputError``."""
    if road is not None:
        return of_road(load_road(road), DIRECTION, path)
    road_file = path.with_name(f"{path.stem}{ROAD_ENDING}")
    if not road_file.is_file():
        message = f"{road_file.name} is missing beside it, which says where the lanes are; or give --road"
        raise InputError(f"{path}: {message}")
    return of_road(load_recorded_road(road_file)[0], DIRECTION, road_file)


def recording_of(
    columns: ColumnTable,
    road: StraightRoad,
    name: str,
    notes: tuple[str, ...] = (),
    strict: bool = True,
    computed: bool = False,
) -> Recording:
    """The recording of columns called as in ``HEADER``, and ``kind``, on a road. Raises ``InputError``.

    Unless it is ``strict``, vehicles of which a cell breaks a rule, and bad ones, are left out.
    ``computed``: places, speeds and accelerations are those of one motion, and are not compared.
    """
    table, recording, cell_notes = _readable_part(columns, road, name, strict)
    recording = replace(recording, computed=computed)
    return reliable_part(
        with_notes(recording, (*notes, *cell_notes)), strict, partial(_check_plausible, table)
    )


def _readable_part(
    columns: ColumnTable, road: StraightRoad, name: str, strict: bool
) -> tuple[ColumnTable, Recording, tuple[str, ...]]:
    """The rows by vehicle and their recording, with notes. Raises ``InputError``.

    Without vehicles of which a cell breaks a rule, where it is not ``strict`` and they are not too many.
    """
    names = columns["vehicle"].astype(np.str_)
    everyone, usable, faults = np.unique(names), np.ones(columns.rows, np.bool_), dict[str, CellError]()
    known = len(everyone)
    while True:
        try:
            rows = in_order(columns if usable.all() else columns.at(np.flatnonzero(usable)), everyone)
            recording = vehicles_of(rows.table, rows.ids, rows.clock, road, name)
            break
        except CellError as error:
            if strict or len(faults) + 1 > MOST_LEFT_OUT * known:
                raise next(iter(faults.values()), error) from None
            faults[str(names[error.place])] = error
            usable &= names != names[error.place]
    left_out = (left_out_note([vehicle], known, ReasonKind.TOLD(x.told)) for vehicle, x in faults.items())
    return rows.table, recording, (*left_out, *rows.numbered, *rows.notes, *rows.clock.notes)


def contradictions_in(columns: ColumnTable, road: StraightRoad, computed: bool = False) -> tuple[str, ...]:
    """Notes on what samples contradict themselves in, as a recording of them has.

    Raises ``InputError`` where the contradictions are too large or too many.
    ``computed``: as in ``recording_of``.
    """
    rows = in_order(columns)
    recording = vehicles_of(rows.table, rows.ids, rows.clock, road, columns.path.stem)
    checks = contradiction_checks(replace(recording, computed=computed))
    contradictions = _check_plausible(rows.table, checks, np.arange(rows.table.rows))
    return (*rows.notes, *rows.clock.notes, *contradictions)


def vehicles_of(table: ColumnTable, ids: Integers, clock: Clock, road: StraightRoad, name: str) -> Recording:
    """The recording of rows by vehicle, whose numbers are ``ids``, without notes. Raises ``InputError``."""
    first = np.flatnonzero(np.diff(ids, prepend=-1) != 0)
    start = np.append(first, table.rows)
    frames = frames_of(table, ids, clock)
    _check_cells(table, start)
    counts = np.diff(start)
    kind = table["kind"].astype(np.str_) if "kind" in table.columns else np.full(table.rows, "Car")
    table.require(kind == np.repeat(kind[first], counts), "kind", "the class of a vehicle stays the same")
    vehicles: dict[str, Column] = {
        "vehicle_id": ids[first],
        "direction": np.full(len(first), DIRECTION),
        "kind": kind[first],
        **{name: table[name][first] for name in SIZES},
        "first_frame": frames[first],
    }
    return replace(
        place_recording(road, name, clock.rate, vehicles, counts, (table[x] for x in RECORDED)),
        label=table[LABEL].astype(np.str_)[first] if LABEL in table.columns else np.zeros(0, np.str_),
        custom_signals={
            name: own_numbers(table[name].tolist()) for name in custom_signal_columns(table.columns)
        },
    )


def number_vehicles(names: npt.NDArray[np.str_]) -> tuple[Integers, tuple[str, ...]]:
    """The number of each vehicle, and a note where names are no numbers: then SV is 1, as in all exports."""
    if all(name.isdecimal() and name[0] != "0" and len(name) < 10 for name in names):
        return names.astype(np.int64), ()
    known = {name: k for k, name in enumerate(vehicle_order(names.tolist()), 1)}
    number = np.array([known[name] for name in names.tolist()])
    shown = ", ".join(f"{name} is {k}" for name, k in [*known.items()][:12])
    return number, (f"vehicles are numbered: {shown}{', …' if len(names) > 12 else ''}",)


@dataclass(frozen=True)
class Ordered:
    """Rows by vehicle and time, the number of each row's vehicle, and the clock.

    ``numbered``: a note on what vehicles are called. ``notes``: what was done to the rows.
    """

    table: ColumnTable
    ids: Integers
    clock: Clock
    numbered: tuple[str, ...]
    notes: tuple[str, ...]


def in_order(columns: ColumnTable, names: npt.NDArray[np.str_] | None = None) -> Ordered:
    """The rows by vehicle and time. Raises ``InputError`` where times are no clock or rows contradict.

    ``names``: of all vehicles of the file, in order, by default those of the rows.
    """
    each = columns["vehicle"].astype(np.str_)
    names = np.unique(each) if names is None else names
    number, numbered = number_vehicles(names)
    table, ids = by_vehicle(columns, number[np.searchsorted(names, each)])
    table, ids, mended = by_time(table, ids)
    clock = clock_of(table.path, *steps_of(table, ids))
    return Ordered(table, ids, clock, numbered, mended.notes(table.path))


def frames_of(table: ColumnTable, ids: Integers, clock: Clock) -> Integers:
    """The frame of each row."""
    time = table["time"]
    same = np.diff(ids, prepend=-1) == 0
    frames = clock.frames(time)
    rule = f"samples are {clock.step:g} s apart, so times are whole multiples of 1/{rate_text(clock.rate)} s"
    rule += "; use equal steps"
    table.require(clock.misses(time) <= clock.slack, "time", rule)
    table.require(~same | (np.diff(frames, prepend=0) == 1), "time", f"{rule}, without gaps")
    return frames


def _check_cells(table: ColumnTable, start: Integers) -> None:
    """Refuse impossible cells, sizes that change, and vehicles that drive backwards."""
    table.require_within(LARGEST_PLACE, "s", "d")
    table.require_within(LARGEST_SPEED, "v_lon", "v_lat")
    table.require_within(LARGEST_ACCELERATION, "a_lon", "a_lat")
    table.require_within(LARGEST_SIZE, *SIZES)
    for column in SIZES:
        size = table[column]
        table.require(size > 0, column, "the size of a vehicle is greater than zero")
        same = size == np.repeat(size[start[:-1]], np.diff(start))
        table.require(same, column, "the size of a vehicle stays the same")
    s: Floats = table["s"]
    backwards = s[start[1:] - 1] - s[start[:-1]] < -table["length"][start[:-1]]
    ends = np.ones(table.rows, np.bool_)
    ends[start[1:] - 1] = ~backwards
    table.require(ends, "s", "a vehicle never ends further back than its length from where it began")


def _check_plausible(whole: ColumnTable, checks: ContradictionChecks, rows: Integers) -> Iterator[str]:
    """Notes on what the file contradicts itself in. Raises ``InputError`` where that is too much."""
    table = whole if len(rows) == whole.rows else whole.at(rows)

    def at(row: int, signal: str) -> str:
        return f"{table.cell(row, signal)} of vehicle {table['vehicle'][row]}"

    vehicle_at = partial(table.cell, column="vehicle")
    return contradiction_notes(table.path, checks, at, vehicle_at, "lanelet of the road")
