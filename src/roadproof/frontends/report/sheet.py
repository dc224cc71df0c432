"""The result of a question, described once as columns and entries: CSV and data frames are made of it."""

import csv
import io
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Generic, Literal, TypeAlias, TypeVar

from roadproof.library.scenarios import Scenario

T = TypeVar("T")
Value: TypeAlias = str | int | float | bool | None
Cell: TypeAlias = Value | Fraction | Scenario
"""CSV rounds a fraction and writes of a scenario its number; a frame has floats, and names such as 4@base."""


@dataclass(frozen=True)
class Column(Generic[T]):
    """A name, the cell of each entry below it, and whether only one renderer has the column."""

    name: str
    cell: Callable[[T], Cell]
    only: Literal["", "csv", "frame"] = ""


@dataclass(frozen=True)
class Sheet(Generic[T]):
    """Columns, and the entries of which each is a row."""

    columns: tuple[Column[T], ...]
    entries: Sequence[T]


def as_csv(sheet: Sheet[T]) -> str:
    """A header and a row for each entry; nothing is written where there is no value."""
    columns = [x for x in sheet.columns if x.only != "frame"]
    rows = ([_written(x.cell(entry)) for x in columns] for entry in sheet.entries)
    return csv_text([x.name for x in columns], rows)


def as_rows(sheet: Sheet[T]) -> list[dict[str, Value]]:
    """A row for each entry, values by the name of their column."""
    columns = [x for x in sheet.columns if x.only != "csv"]
    return [{x.name: _value(x.cell(entry)) for x in columns} for entry in sheet.entries]


def csv_text(header: Iterable[object], rows: Iterable[Iterable[object]]) -> str:
    """Header and rows as CSV."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return out.getvalue()


def _written(cell: Cell) -> Value:
    if isinstance(cell, Fraction):
        return f"{float(cell):.10g}"
    return cell.number if isinstance(cell, Scenario) else cell


def _value(cell: Cell) -> Value:
    if isinstance(cell, Fraction):
        return float(cell)
    return str(cell) if isinstance(cell, str | Scenario) else cell  # a verdict becomes plain text
