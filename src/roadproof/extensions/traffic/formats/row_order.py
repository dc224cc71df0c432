"""Rows of vehicles by vehicle and time: sorted, without those that repeat another one."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from roadproof.extensions.traffic.formats.recording import Floats, Integers
from roadproof.extensions.traffic.formats.table import ColumnTable, copies_note, without_copies


def by_vehicle(table: ColumnTable, ids: Integers) -> tuple[ColumnTable, Integers]:
    """The rows by vehicle, in the order of the file, and the number of each row's vehicle."""
    order = np.argsort(ids, kind="stable")
    return table.at(order), ids[order]


def steps_of(table: ColumnTable, ids: Integers) -> tuple[Floats, Floats, Integers]:
    """The times of some rows, how far they are apart in a vehicle, and how often each distance occurs."""
    time, same = table["time"], np.diff(ids, prepend=-1) == 0
    steps, counts = np.unique(np.diff(time, prepend=0.0)[same], return_counts=True)
    return np.unique(time), steps, counts


@dataclass(frozen=True)
class RowRepairs:
    """The repairs of a table's rows: whether they were sorted, and how many repeated another one."""

    is_sorted: bool = False
    copies: int = 0

    def __add__(self, other: "RowRepairs") -> "RowRepairs":
        return RowRepairs(self.is_sorted or other.is_sorted, self.copies + other.copies)

    def notes(self, path: Path) -> tuple[str, ...]:
        sorted_note = (f"{path.name}: rows were not in order of time; they were sorted",) * self.is_sorted
        return (*sorted_note, *copies_note(path, self.copies))


def by_time(table: ColumnTable, ids: Integers) -> tuple[ColumnTable, Integers, RowRepairs]:
    """The rows of each vehicle in order of time, without repeated ones. Raises ``InputError``."""
    same, ahead = np.diff(ids, prepend=-1) == 0, np.diff(table["time"], prepend=0.0)
    if (~same | (ahead > 0)).all():
        return table, ids, RowRepairs()
    is_sorted = bool((same & (ahead < 0)).any())
    if is_sorted:
        order = np.lexsort((np.arange(table.rows), table["time"], ids))
        table, ids = table.at(order), ids[order]
    again = (np.diff(ids, prepend=-1) == 0) & (np.diff(table["time"], prepend=0.0) == 0)
    table, _ = without_copies(table, again, "time")
    return table, ids[~again], RowRepairs(is_sorted, int(np.count_nonzero(again)))
