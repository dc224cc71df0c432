"""Number tables in CSV files: the one home of polars.

Reading is strict. A file has exactly the header that its format prescribes, every row has every
field, every cell that is asked for is a finite number (or a text where the format has one); the
first cell that breaks a rule is named by file, row (the header is row 1), column and value.
"""

import io
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, BinaryIO, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from roadproof.errors import InputError, MissingSolverError
from roadproof.recordings.formats.plain import plain_text
from roadproof.runtime.file_kind import other_table
from roadproof.runtime.files import whole_file

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


@dataclass(frozen=True)
class Table:
    """Columns of equal length by name, and the file that they came from.

    ``places``: for each row its place among the rows of the file, where it is another.
    """

    path: Path
    columns: Mapping[str, Column]
    rows: int
    places: Column | None = None

    def __getitem__(self, name: str) -> Column:
        return self.columns[name]

    def refuse(self, row: int, column: str, rule: str) -> InputError:
        """The error for the cell in data row ``row`` (from 0)."""
        return InputError(f"{self.path}, {self.cell(row, column)}: {rule}")

    def cell(self, row: int, column: str) -> str:
        """Row of the file, column and value of the cell in data row ``row`` (from 0)."""
        place = row if self.places is None else int(self.places[row])
        return f"row {place + 2}, column {column}={self.columns[column][row]}"

    def require(self, holds: npt.NDArray[np.bool_], column: str, rule: str) -> None:
        """Raise for the first row where ``holds`` is false."""
        if not holds.all():
            raise self.refuse(int(np.argmin(holds)), column, rule)


def names_in(*lines: str) -> tuple[str, ...]:
    """The names of columns in lines of them."""
    return tuple(" ".join(lines).split())


def cell_error(path: Path, row: int, column: str, value: object, rule: str) -> InputError:
    """An error that names a cell; ``row`` counts data rows from 0, the message lines from 1."""
    return InputError(f"{path}, row {row + 2}, column {column}={value}: {rule}")


def read_table(path: Path, header: Sequence[str], wanted: Mapping[str, Kind]) -> Table:
    """The columns ``wanted`` of a CSV file whose header is exactly ``header``.

    Integers come as int64, numbers as finite float64, texts as str. Raises ``InputError`` for a
    file that cannot be read, is empty or truncated, or breaks a rule above.
    """
    content = _Content.of(path)
    beginning = content.beginning()
    other = other_table(beginning, len(header))
    if other is not None:
        raise InputError(f"{path}: the file {other}")
    _check_header(path, beginning.partition(b"\n")[0], header)
    rows = _check_shape(content, len(header))
    columns = _read_fast(content.source(), wanted, rows)
    content.require_unchanged()
    if columns is None:
        _blame(path, content.all().partition(b"\n")[2], header, wanted)
        raise InputError(f"{path}: the file is no table of numbers with the columns {', '.join(header)}")
    _require_finite(path, columns, wanted)
    return Table(path, columns, rows)


def read_pieces(path: Path, header: Sequence[str], wanted: Mapping[str, Kind]) -> Iterator[Table]:
    """As ``read_table``, in pieces of about PIECE bytes, of which one at a time is in memory."""
    content = _Content.of(path)
    names, _, _ = content.beginning().partition(b"\n")
    _check_header(path, names, header)
    _check_shape(content, len(header))
    done, rest = 0, b""
    for block in content.pieces(PIECE):
        lines, rest = (rest + block).rpartition(b"\n")[0], (rest + block).rpartition(b"\n")[2]
        body = lines.partition(b"\n")[2] if done == 0 else lines
        rows = body.count(b"\n") + 1 if body else 0
        if not rows:
            rest = lines + b"\n" + rest if lines and done == 0 else rest
            continue
        body += b"\n"
        columns = _read_fast(names + b"\n" + body, wanted, rows)
        if columns is None:
            content.require_unchanged()
            _blame(path, body, header, wanted, done)
            raise InputError(f"{path}: the file is no table of numbers with the columns {', '.join(header)}")
        _require_finite(path, columns, wanted, done)
        yield Table(path, columns, rows, np.arange(done, done + rows))
        done += rows
    content.require_unchanged()


def count_lines(path: Path) -> int:
    """How many line breaks a file has."""
    return sum(piece.count(b"\n") for piece in _Content.of(path).pieces())


def _require_finite(
    path: Path, columns: Mapping[str, Column], wanted: Mapping[str, Kind], before: int = 0
) -> None:
    for name, kind in wanted.items():
        if kind == "number" and not np.isfinite(columns[name]).all():
            row = int(np.argmin(np.isfinite(columns[name])))
            raise cell_error(path, before + row, name, columns[name][row], "a number must be finite")


def read_named(path: Path, wanted: Mapping[str, Kind]) -> Table:
    """As ``read_table``, for a file that may have other columns too, in any order. Raises ``InputError``."""
    header = _Content.of(path).beginning().partition(b"\n")[0].decode("utf-8", "replace").strip().split(",")
    return read_table(path, header if set(wanted) <= set(header) else tuple(wanted), wanted)


def sample_rows(path: Path, header: Sequence[str], names: Sequence[str], count: int) -> list[list[float]]:
    """The numbers of ``names`` in about ``count`` rows, evenly over a file that ``read_table`` took."""
    places = [header.index(name) for name in names]
    found = []
    with _Content.of(path).open() as file:
        size = file.seek(0, 2)
        for k in range(count):
            file.seek(size * k // count)
            file.readline()
            cells = file.readline().decode("ascii").strip().split(",")
            if len(cells) == len(header):
                found.append([float(cells[place]) for place in places])
    return found


def read_columns(path: Path, names: Sequence[str]) -> None:
    """Read some columns and check nothing: what benchmarks compare ``read_table`` with."""
    pl = polars_module()

    pl.read_csv(path, columns=list(names))


def write_table(path: Path, columns: Mapping[str, Column], decimals: int | None = None) -> None:
    """Write ``columns`` as CSV, floats with ``decimals`` places; the file appears whole or not at all."""
    with whole_file(path) as file:
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


_MARK = b"\xef\xbb\xbf"
"""What some programs begin text in UTF-8 with."""


@dataclass(frozen=True)
class _Content:
    """What is in a file, without the mark of UTF-8: looked at piece by piece, and not kept.

    ``kept``: of what is no file on a disk, which can be read once, and of files with quoted cells or other
    line ends, as they are without. ``stamp`` changes when the file does.
    """

    path: Path
    stamp: tuple[int, ...]
    kept: bytes | None

    @classmethod
    def of(cls, path: Path) -> "_Content":
        """Raises ``InputError`` for a file that cannot be read or is empty."""
        try:
            kept = None if path.is_file() else path.read_bytes().removeprefix(_MARK)
            found = cls(path, stamp_of(path), kept)
            empty = not found.beginning() or (found.beginning().isspace() and found.all().isspace())
            if not empty and found.needs_change():
                found = cls(path, found.stamp, plain_text(path, found.all()))
        except OSError as error:
            raise InputError(f"{path}: the file cannot be read ({error.strerror}); check the path") from None
        if empty:
            raise InputError(f"{path}: the file is empty; get it again from its source")
        return found

    def open(self) -> BinaryIO:
        """The content, to be read."""
        return self.path.open("rb") if self.kept is None else io.BytesIO(self.kept)

    def needs_change(self) -> bool:
        """Whether cells are quoted, or lines end with a carriage return alone; False of what is no text."""
        first = self.beginning()
        if not first.isascii() or b"\0" in first:
            return False
        return (b"\r" in first and b"\n" not in first) or any(b'"' in piece for piece in self.pieces())

    def pieces(self, size: int = 1 << 18) -> Iterator[bytes]:
        """All of it, in pieces that by default fit the cache."""
        with self.open() as file:
            if file.read(len(_MARK)) != _MARK or self.kept is not None:
                file.seek(0)
            while piece := file.read(size):
                yield piece

    def beginning(self) -> bytes:
        """The first of the pieces, in which the header is."""
        return next(self.pieces(), b"")

    def ends_line(self) -> bool:
        """Whether it ends with a line break."""
        if self.kept is not None:
            return self.kept.endswith(b"\n")
        with self.path.open("rb") as file:
            file.seek(-1, io.SEEK_END)
            return file.read() == b"\n"

    def all(self) -> bytes:
        return b"".join(self.pieces())

    def source(self) -> Path | bytes:
        """What polars is to read; the file itself where it has no mark."""
        if self.kept is not None:
            return self.kept
        with self.path.open("rb") as file:
            marked = file.read(len(_MARK)) == _MARK
        return self.all() if marked else self.path

    def require_unchanged(self) -> None:
        """Raise ``InputError`` where the file was written to since it was first looked at."""
        require_unchanged(self.path, self.stamp)


def require_unchanged(path: Path, stamp: tuple[int, ...]) -> None:
    """Raise ``InputError`` where a file is not what it was when ``stamp_of`` it was asked for."""
    if stamp_of(path) != stamp:
        raise InputError(f"{path}: the file changed while it was read; ask again when it is whole")


def stamp_of(path: Path) -> tuple[int, ...]:
    """What changes when a file does; nothing of one that is gone."""
    try:
        found = path.stat()
    except OSError:
        return ()
    return found.st_dev, found.st_ino, found.st_size, found.st_mtime_ns


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


def _check_shape(content: _Content, fields: int) -> int:
    """The number of data rows; every line must end, and hold ``fields`` fields."""
    path = content.path
    if not content.ends_line():
        raise InputError(
            f"{path}: the last row does not end with a line break; the file was cut off, get it again"
        )
    lines = commas = 0
    for found in content.pieces():
        piece = np.frombuffer(found, np.uint8)
        if piece.max() > 127 or not piece.min():
            strange = int(np.argmax((piece > 127) | (piece == 0)))
            row = lines + found.count(b"\n", 0, strange) + 1
            raise InputError(
                f"{path}, row {row}: byte {piece[strange]:#04x} is no part of a table of numbers"
            )
        lines += int(np.count_nonzero(piece == ord("\n")))
        commas += int(np.count_nonzero(piece == ord(",")))
    if commas != lines * (fields - 1):
        for number, line in enumerate(content.all().split(b"\n")[:-1], start=1):
            if line.count(b",") != fields - 1:
                count = line.count(b",") + 1
                raise InputError(f"{path}, row {number}: the row has {count} fields, the format {fields}")
    if lines < 2:
        raise InputError(f"{path}: the file has a header but no rows; get it again from its source")
    return lines - 1


def _read_fast(source: Path | bytes, wanted: Mapping[str, Kind], rows: int) -> dict[str, Column] | None:
    """All wanted columns, or None if some cell is wrong."""
    pl = polars_module()

    types = {"integer": pl.Int64, "number": pl.Float64, "text": pl.String, "list": pl.String}
    try:
        frame = pl.read_csv(
            source,
            columns=list(wanted),
            schema_overrides={name: types[kind] for name, kind in wanted.items()},
            quote_char=None,
            infer_schema=False,
        )
    except (pl.exceptions.PolarsError, UnicodeDecodeError):
        return None
    full = {
        name: frame[name].fill_null("") if kind == "list" else frame[name] for name, kind in wanted.items()
    }
    if frame.height != rows or any(values.null_count() for values in full.values()):
        return None
    return {name: values.to_numpy() for name, values in full.items()}


def _blame(
    path: Path, body: bytes, header: Sequence[str], wanted: Mapping[str, Kind], before: int = 0
) -> None:
    """Read cell by cell and raise for the first one that is wrong; slow, and only after a failure."""
    places = [(header.index(name), name, kind) for name, kind in wanted.items()]
    for row, line in enumerate(body.decode("utf-8", "replace").split("\n")[:-1], before):
        cells = line.rstrip("\r").split(",")
        if len(cells) != len(header):
            raise InputError(
                f"{path}, row {row + 2}: the row has {len(cells)} fields, the format {len(header)}"
            )
        for place, name, kind in places:
            if not _fits(cells[place], kind):
                raise cell_error(path, row, name, repr(cells[place]), RULES[kind])


def _fits(cell: str, kind: Kind) -> bool:
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
