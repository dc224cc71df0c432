"""Files of samples that are larger than memory: kept as converted recordings, some vehicles at a time.

The file is gone through twice: for its vehicles and its clock, and to put its rows into files of some
vehicles each. These are read, checked and placed one after the other, as a whole file is.
"""

import hashlib
import os
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats import windows
from roadproof.extensions.traffic.formats.clock import Clock, clock_of
from roadproof.extensions.traffic.formats.content import require_unchanged, stamp_of
from roadproof.extensions.traffic.formats.contradictions import contradiction_notes
from roadproof.extensions.traffic.formats.converted import (
    HEAD,
    SAMPLES,
    divide_converted,
    frame_of_samples,
    full_metadata,
    read_converted,
)
from roadproof.extensions.traffic.formats.plausible import ContradictionChecks
from roadproof.extensions.traffic.formats.recording import (
    OF_SAMPLES,
    OF_VEHICLES,
    Integers,
    Recording,
    offsets,
)
from roadproof.extensions.traffic.formats.reliable import (
    MOST_LEFT_OUT,
    VehicleSelection,
    left_out_note,
    selection_of,
    stands,
    too_many,
)
from roadproof.extensions.traffic.formats.row_order import RowRepairs, by_time, by_vehicle, steps_of
from roadproof.extensions.traffic.formats.samples import (
    column_pieces,
    count_samples,
    ignored_column_notes,
    ignored_map_notes,
    number_vehicles,
    road_of,
    vehicles_of,
)
from roadproof.extensions.traffic.formats.straight import StraightRoad
from roadproof.extensions.traffic.formats.table import CellError, ColumnTable, polars_module
from roadproof.extensions.traffic.formats.windows import TimeWindow, WindowedRecording
from roadproof.reasons import ReasonKind
from roadproof.runtime.files import write_json

_LEAST = 24
"""Bytes of a row of a CSV file, at least."""
_PLACE, _GROUP = "place in the file", "group of vehicles"


def is_large(path: Path) -> bool:
    """Return whether a file of samples has more than are read as a whole. Raises ``InputError``."""
    if path.suffix != ".parquet" and path.stat().st_size < _LEAST * windows.MOST_SAMPLES:
        return False
    return count_samples(path) > windows.MOST_SAMPLES


def divide_large(path: Path, strict: bool = True, road: str | None = None) -> WindowedRecording | None:
    """A file of samples in windows of time, None where it is small. Raises ``InputError``.

    Unless it is ``strict``, bad vehicles are left out. ``road``: by default that beside it.

    It is converted into a temporary folder, which is gone when the windows are.
    """
    if not path.is_file() or not is_large(path):
        return None
    folder = tempfile.TemporaryDirectory()
    head = write_large(path, Path(folder.name), {}, "", strict, road)
    made = divide_converted(head, checked=True) or windows.undivided(read_converted(head))

    def read() -> Iterator[TimeWindow]:
        with folder:
            yield from made.windows()

    return replace(made, windows=read)


def write_large(
    path: Path,
    folder: Path,
    digests: Mapping[str, str],
    form: str,
    strict: bool = True,
    road: str | None = None,
) -> Path:
    """Write a file of samples as ``converted.write_converted`` does, and return the path of its head.

    ``digests`` of what it is made of, in the format called ``form``. Unless it is ``strict``, bad vehicles
    are left out. Raises ``InputError``.
    """
    lanes, not_read = road_of(path, road), ignored_map_notes(road, strict)
    with tempfile.TemporaryDirectory(dir=folder, prefix=".") as temporary:
        stamp = stamp_of(path)
        survey = _survey(path, strict)
        require_unchanged(path, stamp)
        groups = _divide_rows(path, survey, Path(temporary))
        require_unchanged(path, stamp)
        read = _GroupReader(path, lanes, survey, groups, strict)
        read.begin()
        made = _write_parts(read, VehicleSelection(), Path(temporary))
        if not strict and not stands(made.checks):
            made = _write_parts(read, _vehicles_to_leave_out(read, made.checks), Path(temporary))
        whole = _concatenated(made.heads)
        chosen = made.chosen
        notes = (*not_read, *read.notes, *chosen.notes, *read.contradiction_notes(made))
        table, head = folder / f"{path.stem}{SAMPLES}", folder / f"{path.stem}{HEAD}"
        head.unlink(missing_ok=True)  # it is there when the samples are
        _join_files(made.parts, Path(temporary) / "whole", table)
        with table.open("rb") as file:
            digest = hashlib.file_digest(file, "sha256").hexdigest()
        write_json(
            head, full_metadata(replace(whole, notes=notes), form, digests, int(whole.start[-1]), digest)
        )
    return head


@dataclass(frozen=True)
class _WrittenParts:
    """Files with the samples of groups of vehicles, the vehicles, and checks of all together."""

    chosen: VehicleSelection
    checks: ContradictionChecks
    heads: list[Recording]
    parts: list[Path]


def _write_parts(read: "_GroupReader", chosen: VehicleSelection, folder: Path) -> _WrittenParts:
    """Write the vehicles of each group that are ``chosen``."""
    made = _WrittenParts(chosen, ContradictionChecks(read.clock.rate, read.road.lanes), [], [])
    for number, group in enumerate(read.recordings()):
        recording = chosen.of(group)
        made.checks.add(recording)
        part = folder / f"{number}{SAMPLES}"
        frame_of_samples(recording).write_parquet(part, compression="zstd", statistics=False)
        made.parts.append(part)
        made.heads.append(_without_samples(recording))
    return made


def _vehicles_to_leave_out(read: "_GroupReader", checks: ContradictionChecks) -> VehicleSelection:
    """Return the vehicles to leave out. Raises ``InputError`` where they are more than half."""
    chosen = selection_of(read.recordings)
    if len(chosen.lost) <= MOST_LEFT_OUT * chosen.vehicles:
        return chosen
    try:
        [*read.contradiction_notes(_WrittenParts(VehicleSelection(), checks, [], []))]
    except InputError as error:
        raise too_many(error, len(chosen.lost), chosen.vehicles) from None
    return VehicleSelection()


@dataclass(frozen=True)
class _Survey:
    """The vehicles of a file, in the order of their numbers.

    ``index`` gives the place of each name; ``counts`` how many rows each has. ``unread``: a note on columns.
    """

    names: list[str]
    index: Mapping[str, int]
    numbers: Integers
    counts: Integers
    notes: tuple[str, ...]
    unread: tuple[str, ...]


def _survey(path: Path, strict: bool) -> _Survey:
    counts: dict[str, int] = {}
    not_read: tuple[str, ...] = ()
    for table in column_pieces(path):
        not_read = ignored_column_notes(table, strict)
        names, index = _named(table)
        for name, count in zip(names, np.bincount(index).tolist(), strict=True):
            counts[name] = counts.get(name, 0) + count
    unordered = np.array(sorted(counts))
    numbers, notes = number_vehicles(unordered)
    order = np.argsort(numbers, kind="stable")
    known = [str(name) for name in unordered[order]]
    each = np.array([counts[name] for name in known])
    index_of = {name: k for k, name in enumerate(known)}
    return _Survey(known, index_of, numbers[order], each, notes, not_read)


def _named(table: ColumnTable) -> tuple[list[str], Integers]:
    """The names of the vehicles in some rows, in order, and the place of each row's among them."""
    each = [str(name) for name in table["vehicle"].tolist()]
    names = sorted({*each})
    place = {name: k for k, name in enumerate(names)}
    return names, np.fromiter(map(place.__getitem__, each), np.int64, len(each))


def _divide_rows(path: Path, survey: _Survey, folder: Path) -> list[Path]:
    """Folders with the rows of some vehicles each, in order of vehicles, in files in order of the rows.

    A partitioned sink of polars 2.1 is three times as fast, but keeps all rows in memory: 2.3 GB for a file
    of 0.9 GB, where this needs 0.6 GB for any.
    """
    pl = polars_module()
    group = (offsets(survey.counts)[:-1] // windows.MOST_SAMPLES).astype(np.int64)
    group = np.unique(group, return_inverse=True)[1]
    groups = [folder / str(number) for number in range(int(group[-1]) + 1)]
    for each in groups:
        each.mkdir()
    for number, table in enumerate(column_pieces(path)):
        places = np.arange(table.rows) if table.places is None else table.places
        names, index = _named(table)
        if not survey.index.keys() >= {*names}:
            raise InputError(f"{path}: the file changed while it was read; ask again when it is whole")
        vehicle = np.array([survey.index[name] for name in names])[index]
        columns = {name: pl.Series(name, values) for name, values in table.columns.items()}
        columns |= {
            "vehicle": pl.Series(vehicle),
            _PLACE: pl.Series(places),
            _GROUP: pl.Series(group[vehicle]),
        }
        parts = pl.DataFrame(columns).partition_by(_GROUP, as_dict=True, include_key=False)
        for (k,), part in parts.items():
            part.write_parquet(groups[k] / f"{number:06d}", compression="lz4")
    return groups


@dataclass
class _GroupReader:
    """The recordings of groups of vehicles.

    ``faults``: by name the vehicles of which a cell breaks a rule, unless it is ``strict``; they are left
    out. ``begin`` sets the rest: the clock, what was done to the rows, and how many rows each vehicle has.
    """

    path: Path
    road: StraightRoad
    survey: _Survey
    groups: list[Path]
    strict: bool
    faults: dict[str, CellError] = field(default_factory=dict)
    clock: Clock = field(init=False)
    mended: RowRepairs = field(init=False, default_factory=RowRepairs)
    counts: Integers = field(init=False)

    def begin(self) -> None:
        """Find the clock in the rows of all groups. Raises ``InputError``."""
        times, steps = np.zeros(0), dict[float, int]()
        self.counts = np.zeros_like(self.survey.counts)
        for number in range(len(self.groups)):
            ordered = self._ordered(number)
            if ordered is None:
                continue
            table, ids, mended = ordered
            self.mended += mended
            vehicles, counts = np.unique(table["vehicle"], return_counts=True)
            self.counts[vehicles] = counts
            there, apart, often = steps_of(table, ids)
            times = np.union1d(times, there)
            for step, count in zip(apart.tolist(), often.tolist(), strict=True):
                steps[step] = steps.get(step, 0) + count
        known = sorted(steps)
        often = np.array([steps[x] for x in known], np.int64)
        self.clock = clock_of(self.path, times, np.array(known), often)

    @property
    def notes(self) -> tuple[str, ...]:
        """Return notes on omitted vehicles, names of vehicles, rows and the clock, as for small files."""
        known = len(self.survey.names)
        left_out = (left_out_note([x], known, ReasonKind.TOLD(y.told)) for x, y in self.faults.items())
        done = self.mended.notes(self.path)
        return (*self.survey.unread, *left_out, *self.survey.notes, *done, *self.clock.notes)

    def table(self, number: int) -> tuple[ColumnTable, Integers]:
        """The rows of a group by vehicle, and the number of each row's vehicle.

        The column ``vehicle`` has its place in the survey.
        """
        pl = polars_module()
        frame = pl.read_parquet(sorted(self.groups[number].iterdir()), glob=False)
        columns = {name: frame[name].to_numpy() for name in frame.columns}
        places = columns.pop(_PLACE)
        table = ColumnTable(self.path, columns, frame.height, places)
        return by_vehicle(table, self.survey.numbers[columns["vehicle"]])

    def recordings(self) -> Iterator[Recording]:
        """Yield the recordings of all groups. Raises ``InputError``."""
        for number in range(len(self.groups)):
            recording = self._recording(number)
            if recording is not None:
                yield recording

    def _recording(self, number: int) -> Recording | None:
        while True:
            ordered = self._ordered(number)
            if ordered is None:
                return None
            table, ids, _ = ordered
            try:
                return vehicles_of(table, ids, self.clock, self.road, self.path.stem)
            except CellError as error:
                self._blame(table, error)

    def _ordered(self, number: int) -> tuple[ColumnTable, Integers, RowRepairs] | None:
        """The rows of a group by vehicle and time, without vehicles with faults; None where none is left."""
        whole, numbers = self.table(number)
        while True:
            rows = np.flatnonzero(~np.isin(whole["vehicle"], [self.survey.index[x] for x in self.faults]))
            if not len(rows):
                return None
            table, ids = (whole.at(rows), numbers[rows]) if len(rows) < whole.rows else (whole, numbers)
            try:
                return by_time(table, ids)
            except CellError as error:
                self._blame(table, error)

    def _blame(self, table: ColumnTable, error: CellError) -> None:
        """Leave out the vehicle of a cell that breaks a rule. Raises the first error where none may be."""
        if self.strict or len(self.faults) + 1 > MOST_LEFT_OUT * len(self.survey.names):
            raise next(iter(self.faults.values()), error) from None
        row = int(np.argmax(table.places == error.place))
        self.faults[self.survey.names[int(table["vehicle"][row])]] = error

    def contradiction_notes(self, made: _WrittenParts) -> Iterator[str]:
        """Return notes on contradictions among the written vehicles. Raises ``InputError``."""
        bad = [self.survey.index[x] for x in self.faults]
        written = ~np.isin(self.survey.numbers, made.chosen.lost)
        written[bad] = False
        counts = self.counts.copy()
        counts[bad] = 0
        begins, ours = offsets(counts)[:-1][written], offsets(counts[written])

        def whole_row(row: int) -> int:
            vehicle = int(np.searchsorted(ours, row, "right")) - 1
            return int(begins[vehicle] + row - ours[vehicle])

        def place_of(row: int, signal: str) -> str:
            cell, vehicle = self.cell(whole_row(row), signal)
            return f"{cell} of vehicle {vehicle}"

        def vehicle_at(row: int) -> str:
            return self.cell(whole_row(row), "vehicle")[0]

        return contradiction_notes(self.path, made.checks, place_of, vehicle_at, "lanelet of the road")

    def cell(self, row: int, column: str) -> tuple[str, str]:
        """The cell in a row of the whole, in order of vehicles, in words; and the name of its vehicle."""
        for number in range(len(self.groups)):
            ordered = self._ordered(number)
            if ordered is None:
                continue
            table = ordered[0]
            if row < table.rows:
                name = self.survey.names[int(table["vehicle"][row])]
                value = name if column == "vehicle" else table[column][row]
                assert table.places is not None
                one = ColumnTable(self.path, {column: np.array([value])}, 1, table.places[row : row + 1])
                return one.cell(0, column), name
            row -= table.rows
        raise IndexError(row)


def _without_samples(recording: Recording) -> Recording:
    """Return the recording without its samples."""
    nothing = {name: getattr(recording, name)[:0].copy() for name in (*OF_SAMPLES, "inside")}
    return replace(recording, **nothing, custom_signals={})


def _concatenated(parts: list[Recording]) -> Recording:
    """Recordings without samples, whose vehicles follow each other, as one."""
    names = (*OF_VEHICLES, "label")
    joined = {name: np.concatenate([getattr(part, name) for part in parts]) for name in names}
    counts = np.concatenate([np.diff(part.start) for part in parts])
    return replace(parts[0], **joined, start=offsets(counts))  # type: ignore[arg-type]


def _join_files(parts: list[Path], temporary: Path, table: Path) -> None:
    """One Parquet file of several, which is read again and compared."""
    pl = polars_module()
    pl.scan_parquet(parts, glob=False).sink_parquet(
        temporary, compression="zstd", statistics=False, maintain_order=True
    )
    begin = 0
    for part in parts:
        expected = pl.read_parquet(part, glob=False)
        stored = pl.scan_parquet(temporary, glob=False).slice(begin, expected.height).collect()
        if not stored.equals(expected):
            raise RuntimeError(f"the samples of {table} do not come back")
        begin += expected.height
    os.replace(temporary, table)
