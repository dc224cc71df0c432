"""The result of a question, described once as columns and entries.

CSV files, data frames, tables on terminals and tables of pages are made of it.
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import zip_longest
from typing import Generic, Literal, NamedTuple, TypeAlias, TypeVar

from roadproof.frontends.report.csv_table import csv_text
from roadproof.library.scenario_names import Scenario
from roadproof.runtime.records import dataclass

T = TypeVar("T")
Value: TypeAlias = str | int | float | bool | None


class ColouredText(NamedTuple):
    """A word or sign, and the class of its colour on pages."""

    text: str
    colour: str


class Bar(NamedTuple):
    """A share from 0 to 1, which pages draw as a bar, in words."""

    text: str
    share: float


@dataclass(frozen=True)
class Trail:
    """Names from the outside in."""

    names: Sequence[str]

    @property
    def text(self) -> str:
        """The names in a line."""
        return " > ".join(self.names)


Cell: TypeAlias = Value | Fraction | Scenario | ColouredText | Bar | Trail
"""CSV rounds a fraction and writes of a scenario its number; a frame has floats, and names such as 4@base."""
Renderer: TypeAlias = Literal["csv", "frame", "terminal", "outline", "page"]


@dataclass(frozen=True)
class Column(Generic[T]):
    """A column of a sheet.

    ``name``: in CSV files and frames; ``heading``: on terminals and pages, where it is another. ``cell``: the
    value of an entry. ``only``: the one renderer that has the column; where that is empty all have it, except
    an outline. ``look``: how pages show a cell; a ``heading`` is a line of an outline above its entries.
    ``link``: the kind of evidence on the page to which a cell leads. ``width`` (letters): of an outline.
    """

    name: str
    cell: Callable[[T], Cell]
    only: Literal["", Renderer] = ""
    heading: str | None = None
    look: Literal["", "verdict", "code", "strong", "heading"] = ""
    link: str = ""
    width: int = 0

    @property
    def title(self) -> str:
        """The title of the column on terminals and pages."""
        return self.name if self.heading is None else self.heading


@dataclass(frozen=True)
class Sheet(Generic[T]):
    """Columns, and the entries of which each is a row."""

    columns: tuple[Column[T], ...]
    entries: Sequence[T]

    def columns_of(self, renderer: Renderer) -> list[Column[T]]:
        """The columns that a renderer has."""
        shared = () if renderer == "outline" else ("",)
        return [x for x in self.columns if x.only in (*shared, renderer)]


def as_csv(sheet: Sheet[T]) -> str:
    """A header and a row for each entry; nothing is written where there is no value."""
    columns = sheet.columns_of("csv")
    rows = ([_written(x.cell(entry)) for x in columns] for entry in sheet.entries)
    return csv_text([x.name for x in columns], rows)


def as_rows(sheet: Sheet[T]) -> list[dict[str, Value]]:
    """A row for each entry, values by the name of their column."""
    columns = sheet.columns_of("frame")
    return [{x.name: _value(x.cell(entry)) for x in columns} for entry in sheet.entries]


def as_lines(sheet: Sheet[T]) -> list[str]:
    """A line of headings and a line for each entry, columns aligned."""
    columns = sheet.columns_of("terminal")
    body = ([str(_value(x.cell(entry))) for x in columns] for entry in sheet.entries)
    return aligned([[x.title for x in columns], *body])


def as_outline(sheet: Sheet[T]) -> list[str]:
    """A line for each entry; above it its headings: each where it changes, or stands below one that does."""
    columns, last = sheet.columns_of("outline"), dict[str, str]()
    headings = [x for x in columns if x.look == "heading"]
    lines: list[str] = []
    for entry in sheet.entries:
        for place, column in enumerate(headings):
            heading = str(_value(column.cell(entry)))
            if heading and heading != last.get(column.name):
                lines.append(heading)
                last = {x.name: last.get(x.name, "") for x in headings[:place]} | {column.name: heading}
        cells = (str(_value(x.cell(entry))).ljust(x.width) for x in columns if x.look != "heading")
        lines.append(f"  {' '.join(cells)}".rstrip())
    return lines


def aligned(rows: Sequence[Sequence[str]], right: Sequence[bool] = ()) -> list[str]:
    """Rows as lines, columns aligned by spaces: to the left, but for those that are ``right``."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    sides = [f"{'>' if one else '<'}{width}" for one, width in zip_longest(right, widths)]
    return ["  ".join(map(format, row, sides)).rstrip() for row in rows]


def excerpt(text: str, most: int) -> str:
    """A text of at most so many letters: of a longer one the beginning."""
    return text if len(text) <= most else f"{text[: most - 1]}…"


def _written(cell: Cell) -> Value:
    if isinstance(cell, Fraction):
        return f"{float(cell):.10g}"
    return cell.number if isinstance(cell, Scenario) else _value(cell)


def _value(cell: Cell) -> Value:
    if isinstance(cell, Fraction):
        return float(cell)
    if isinstance(cell, ColouredText | Bar | Trail):
        return cell.text
    return str(cell) if isinstance(cell, str | Scenario) else cell  # a verdict becomes plain text
