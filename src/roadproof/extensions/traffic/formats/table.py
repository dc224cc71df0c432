"""Number tables in CSV files: the one home of polars.

Reading is strict. A file has exactly the header that its format prescribes, every row has every
field, every cell that is asked for is a finite number (or a text where the format has one); the
first cell that breaks a rule is named by file, row (the header is row 1), column and value.
"""

import io
import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, BinaryIO, Literal, Self, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from roadproof.errors import InputError, MissingSolverError
from roadproof.extensions.traffic.formats.content import Content, is_utf_8, strange_byte
from roadproof.runtime.files import atomic_file

if TYPE_CHECKING:
    import polars

    Frame: TypeAlias = polars.DataFrame
else:
    Frame = Any

Kind: TypeAlias = Literal["integer", "number", "text", "list"]
"""A list is text that may be empty."""
PIECE = 1 << 25
"""Bytes of a large file that are in memory at once."""
Column: TypeAlias = npt.NDArray[Any]
RULES: Mapping[Kind, str] = {
    "integer": "a whole number is needed",
    "number": "a finite number is needed",
    "text": "the cell must not be empty",
    "list": "any text is possible",
}


class CellError(InputError):
    """A cell of the file ``path`` breaks a rule; ``place``: its row among the data rows, from 0."""

    def __init__(self, path: Path, detail: str, place: int) -> None:
        super().__init__(f"{path}, {detail}")
        self.path, self.told, self.place = path, detail, place

    def __reduce__(self) -> tuple[type[Self], tuple[Path, str, int]]:
        return type(self), (self.path, self.told, self.place)


@dataclass(frozen=True)
class ColumnTable:
    """Columns of equal length by name, and the file that they came from.

    ``places``: for each row its place among the rows of the file, where it is another. ``content``: of the
    file, where it was read as a whole.
    """

    path: Path
    columns: Mapping[str, Column]
    rows: int
    places: Column | None = None
    content: Content | None = None

    def __getitem__(self, name: str) -> Column:
        return self.columns[name]

    def refuse(self, row: int, column: str, rule: str) -> CellError:
        """The error for the cell in data row ``row`` (from 0)."""
        return CellError(self.path, f"{self.cell(row, column)}: {rule}", self.place(row))

    def place(self, row: int) -> int:
        """The place in the file of the data row ``row``, both from 0."""
        return row if self.places is None else int(self.places[row])

    def cell(self, row: int, column: str) -> str:
        """Row of the file, column and value of the cell in data row ``row`` (from 0)."""
        return f"row {self.place(row) + 2}, column {column}={self.columns[column][row]}"

    def at(self, order: Column) -> "ColumnTable":
        """The rows at ``order``; each knows its place in the file."""
        columns = {name: values[order] for name, values in self.columns.items()}
        places = order if self.places is None else self.places[order]
        return replace(self, columns=columns, rows=len(order), places=places)

    def is_within(self, most: Mapping[str, float]) -> bool:
        """Return whether no cell of these columns is greater than the most, less than its negative, or no
        number.
        """
        return all(largest_magnitude(self[column]) <= limit for column, limit in most.items())

    def require_within(self, most: float, *columns: str) -> None:
        """Raise for the first cell of the columns that is greater than ``most`` or less than -``most``."""
        for column in columns:
            if not self.is_within({column: most}):
                self.require(np.abs(self[column]) <= most, column, f"must lie between {-most:g} and {most:g}")

    def require_numbers(self, *columns: str) -> None:
        """Raise for the first cell of the columns that is no finite number."""
        for column in columns:
            self.require(np.isfinite(self[column]), column, "a number must be finite")

    def require(self, holds: npt.NDArray[np.bool_], column: str, rule: str) -> None:
        """Raise for the first row where ``holds`` is false."""
        if not holds.all():
            raise self.refuse(int(np.argmin(holds)), column, rule)


def largest_magnitude(values: Column) -> float:
    """The greatest magnitude, NaN where there is one."""
    least, greatest = float(values.min()), float(values.max())
    return max(-least, greatest) if least <= greatest else math.nan


def without_copies(
    table: ColumnTable, again: npt.NDArray[np.bool_], column: str
) -> tuple[ColumnTable, tuple[str, ...]]:
    """The rows that do not repeat (``again``) the row before them, and a note. Raises ``InputError``.

    Rows that repeat its key and differ from it are refused, at ``column``.
    """
    if not again.any():
        return table, ()
    rows = np.flatnonzero(again)
    for name, values in table.columns.items():
        same = np.ones(table.rows, np.bool_)
        one, other = values[rows], values[rows - 1]
        same[rows] = (one == other) | ((one != one) & (other != other))
        if not same.all():
            row = int(np.argmin(same))
            first, difference = table.place(row - 1) + 2, f"{name} is {values[row]} and {values[row - 1]}"
            raise table.refuse(
                row,
                column,
                f"vehicle and {column} occur together once, but row {first} has them; {difference}",
            )
    return table.at(np.flatnonzero(~again)), copies_note(table.path, len(rows))


def copies_note(path: Path, count: int) -> tuple[str, ...]:
    """A note on so many rows that repeat another one."""
    return (f"{path.name}: {count} rows that repeat another row were left out",) if count else ()


def names_in(*lines: str) -> tuple[str, ...]:
    """The names of columns in lines of them."""
    return tuple(" ".join(lines).split())


def kinds_of(**names: str) -> dict[str, Kind]:
    """The kinds of columns, from their names by kind."""
    return {name: cast(Kind, kind) for kind, text in names.items() for name in text.split()}


def cell_error(path: Path, row: int, column: str, value: object, rule: str) -> InputError:
    """An error that names a cell; ``row`` counts data rows from 0, the message lines from 1."""
    return InputError(f"{path}, row {row + 2}, column {column}={value}: {rule}")


def read_table(
    path: Path,
    header: Sequence[str],
    kinds: Mapping[str, Kind],
    thousands: bool = False,
    gaps: Collection[str] = (),
) -> ColumnTable:
    """The columns ``kinds`` of a CSV file whose header is exactly ``header``.

    ``thousands``: whether commas in quoted numbers part them. ``gaps``: columns that may have
    unreadable cells, which come as NaN, as -1 among integers.
    Integers come as int64, numbers as finite float64, texts as str. Raises ``InputError`` for a
    file that cannot be read, is empty or truncated, or breaks a rule above.
    """
    content, rows = _checked(path, header, thousands)
    try:
        columns = _columns(content, content.source(), header, kinds, rows)
    except InputError:
        columns_with_gaps = _read_fast(content.source(), kinds, rows, gaps) if gaps else None
        if columns_with_gaps is None:
            raise
        columns = columns_with_gaps
    return ColumnTable(path, columns, rows, content=content)


def read_pieces(path: Path, header: Sequence[str], kinds: Mapping[str, Kind]) -> Iterator[ColumnTable]:
    """Yield the columns (see ``read_table``) in pieces of about PIECE bytes, one in memory at a time."""
    content, _ = _checked(path, header)
    names, _, _ = content.beginning().partition(b"\n")
    done = 0
    with content.open() as file:
        file.readline()
        while piece := file.read(PIECE) + file.readline():
            rows = piece.count(b"\n")
            columns = _columns(content, names + b"\n" + piece, header, kinds, rows, done)
            yield ColumnTable(path, columns, rows, np.arange(done, done + rows))
            done += rows
    content.require_unchanged()


def _checked(path: Path, header: Sequence[str], thousands: bool = False) -> tuple[Content, int]:
    """The content of a file with this header, and the number of its rows. Raises ``InputError``."""
    content = Content.of(path, thousands)
    beginning = content.beginning()
    from roadproof.runtime.file_kind import other_table  # here: writers load this module, too

    other = other_table(beginning, len(header))
    if other is not None:
        raise InputError(f"{path}: the file {other}")
    _check_header(path, beginning.partition(b"\n")[0], header)
    return content, _check_shape(content, len(header))


def count_lines(path: Path) -> int:
    """Return how many line breaks a file has."""
    return sum(piece.count(b"\n") for piece in Content.of(path).pieces())


def _columns(
    content: Content,
    source: Path | bytes,
    header: Sequence[str],
    kinds: Mapping[str, Kind],
    rows: int,
    before: int = 0,
) -> dict[str, Column]:
    """The columns of so many rows, with others ``before`` them. Raises ``InputError`` for a bad cell."""
    path = content.path
    columns = _read_fast(source, kinds, rows)
    content.require_unchanged()
    if columns is None:
        text = content.all() if isinstance(source, Path) else source
        _raise_first_bad_cell(path, text.partition(b"\n")[2], header, kinds, before)
        raise InputError(f"{path}: the file is no table of numbers with the columns {', '.join(header)}")
    for name, kind in kinds.items():
        if kind == "number" and not is_finite(columns[name]):
            row = int(np.argmin(np.isfinite(columns[name])))
            raise cell_error(path, before + row, name, columns[name][row], "a number must be finite")
    return columns


def is_finite(values: Column) -> bool:
    """Return whether all numbers are finite; their sum is, but for numbers that no format has."""
    with np.errstate(invalid="ignore", over="ignore"):
        return bool(math.isfinite(values.sum()) or np.isfinite(values).all())


def read_named(path: Path, kinds: Mapping[str, Kind], gaps: Collection[str] = ()) -> ColumnTable:
    """Return the columns (see ``read_table``) of a file that may have others, in any order.

    Raises ``InputError``.
    """
    header = Content.of(path).beginning().partition(b"\n")[0].decode("utf-8", "replace").strip().split(",")
    return read_table(path, header if set(kinds) <= set(header) else tuple(kinds), kinds, gaps=gaps)


def write_table(path: Path, columns: Mapping[str, Column], decimals: int | None = None) -> None:
    """Write ``columns`` as CSV, floats with ``decimals`` places; the file appears whole or not at all."""
    with atomic_file(path) as file:
        _write_table(file, columns, decimals)


def table_bytes(columns: Mapping[str, Column], decimals: int) -> bytes:
    """The content of the file that ``write_table`` writes."""
    file = io.BytesIO()
    _write_table(file, columns, decimals)
    return file.getvalue()


def _write_table(file: BinaryIO, columns: Mapping[str, Column], decimals: int | None) -> None:
    pl = polars_module()

    frame = pl.DataFrame({name: pl.Series(name, values) for name, values in columns.items()})
    frame.write_csv(file, float_precision=decimals, float_scientific=False if decimals else None)


def frame_of(rows: Sequence[Mapping[str, Any]]) -> "Frame":
    """A frame with a row for each of ``rows``, and a column for each name in them."""
    frame: Frame = polars_module().DataFrame(list(rows), infer_schema_length=None)
    return frame


def columns_of(data: Any) -> dict[str, Sequence[object]]:
    """The columns of a mapping, or of a frame of polars or pandas, by name. Raises ``InputError``."""
    names = getattr(data, "columns", None) if not isinstance(data, Mapping) else data
    if names is None:
        raise InputError(f"{type(data).__name__} has no named columns: give a mapping of arrays, or a frame")
    return {str(name): data[name] for name in names}


def polars_module() -> ModuleType:
    """polars itself. Raises ``MissingSolverError`` where it is not installed."""
    try:
        import polars
    except ImportError:
        raise MissingSolverError("tables of traffic need polars: install polars") from None
    return polars


def _check_header(path: Path, line: bytes, header: Sequence[str]) -> None:
    names = line.decode("utf-8", "replace").strip("\r\n ").split(",")
    missing = [name for name in header if name not in names]
    extra = [name for name in names if name not in header]
    if missing:
        raise InputError(
            f"{path}, row 1: missing columns {', '.join(missing)}; the format has {', '.join(header)}"
        )
    if extra:
        shown = ", ".join(repr(name) for name in extra)
        raise InputError(f"{path}, row 1: columns {shown} are not part of the format; remove them")
    if list(names) != list(header):
        raise InputError(f"{path}, row 1: the columns must come in the order {', '.join(header)}, each once")


def _check_shape(content: Content, fields: int) -> int:
    """The number of data rows; every line must end, and hold ``fields`` fields."""
    path = content.path
    if not content.ends_line():
        raise InputError(
            f"{path}: the last row does not end with a line break; the file was cut off, get it again"
        )
    counts = content.counts
    if counts.strange and not is_utf_8(content):
        raise strange_byte(content)
    lines = counts.lines
    if counts.commas != lines * (fields - 1):
        for number, line in enumerate(content.all().split(b"\n")[:-1], start=1):
            if line.count(b",") != fields - 1:
                count = line.count(b",") + 1
                raise InputError(f"{path}, row {number}: the row has {count} fields, the format {fields}")
    if lines < 2:
        raise InputError(f"{path}: the file has a header but no rows; get it again from its source")
    return lines - 1


def _read_fast(
    source: Path | bytes, kinds: Mapping[str, Kind], rows: int, gaps: Collection[str] = ()
) -> dict[str, Column] | None:
    """All wanted columns, or None if some cell is wrong, but for those in ``gaps``."""
    pl = polars_module()

    types = {"integer": pl.Int64, "number": pl.Float64, "text": pl.String, "list": pl.String}
    try:
        frame = pl.read_csv(
            source,
            columns=list(kinds),
            schema_overrides={name: types[kind] for name, kind in kinds.items()},
            quote_char=None,
            infer_schema=False,
            ignore_errors=bool(gaps),
        )
    except (pl.exceptions.PolarsError, UnicodeDecodeError):
        return None
    full = {
        name: frame[name].fill_null("") if kind == "list" else frame[name] for name, kind in kinds.items()
    }
    full |= {name: full[name].fill_null(math.nan if kinds[name] == "number" else -1) for name in gaps}
    if frame.height != rows or any(values.null_count() for values in full.values()):
        return None
    return {name: concatenated(values.get_chunks()) for name, values in full.items()}


def concatenated(chunks: "Sequence[polars.Series]") -> Column:
    """The values of all chunks, in memory that is kept for the next file, unlike that of polars."""
    return np.concatenate([chunk.to_numpy() for chunk in chunks])


def _raise_first_bad_cell(
    path: Path, body: bytes, header: Sequence[str], kinds: Mapping[str, Kind], before: int = 0
) -> None:
    """Read cell by cell and raise for the first one that is wrong; slow, and only after a failure."""
    places = sorted((header.index(name), name, kind) for name, kind in kinds.items())
    for row, line in enumerate(body.decode("utf-8", "replace").split("\n")[:-1], before):
        cells = line.rstrip("\r").split(",")
        if len(cells) != len(header):
            raise InputError(
                f"{path}, row {row + 2}: the row has {len(cells)} fields, the format {len(header)}"
            )
        for place, name, kind in places:
            if not fits_kind(cells[place], kind):
                raise cell_error(path, row, name, repr(cells[place]), RULES[kind])


def fits_kind(cell: str, kind: Kind) -> bool:
    """Return whether the text of a cell is of a kind."""
    match kind:
        case "text":
            return cell != ""
        case "list":
            return True
        case "integer":
            digits = cell.removeprefix("-")
            return digits.isascii() and digits.isdigit() and abs(int(digits[:20])) < 2**63
        case "number":
            try:
                return cell == cell.strip() and "_" not in cell and math.isfinite(float(cell))
            except ValueError:
                return False
