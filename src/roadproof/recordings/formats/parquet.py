"""Tables in Parquet files, checked as those in CSV files are."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from roadproof.errors import InputError
from roadproof.recordings.formats.table import RULES, Column, Frame, Kind, Table, cell_error, polars_module

PIECE = 250_000
"""Rows of a large file that are in memory at once."""


def read_parquet(path: Path, wanted: Mapping[str, Kind], optional: Mapping[str, Kind]) -> Table:
    """The columns of a Parquet file with ``wanted`` and perhaps ``optional`` columns, in any order.

    Whole numbers may stand for texts; further columns are read as lists. Raises ``InputError``.
    """
    with _readable(path):
        frame = polars_module().read_parquet(path, use_pyarrow=False, glob=False)
    return _table(path, frame, wanted, optional)


def parquet_pieces(path: Path, wanted: Mapping[str, Kind], optional: Mapping[str, Kind]) -> Iterator[Table]:
    """As ``read_parquet``, in pieces of PIECE rows, of which one at a time is in memory."""
    for begin in range(0, max(1, count_rows(path)), PIECE):
        with _readable(path):
            frame = polars_module().scan_parquet(path, glob=False).slice(begin, PIECE).collect()
        yield _table(path, frame, wanted, optional, begin)


def count_rows(path: Path) -> int:
    """How many rows a Parquet file has. Raises ``InputError``."""
    pl = polars_module()
    with _readable(path):
        return int(pl.scan_parquet(path, glob=False).select(pl.len()).collect().item())


@contextmanager
def _readable(path: Path) -> Iterator[None]:
    pl = polars_module()
    try:
        yield
    except OSError as error:
        told = error.strerror or str(error).partition("\n")[0][:200]
        raise InputError(f"{path}: the file cannot be read ({told}); check the path") from None
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException) as error:
        told = str(error).partition("\n")[0][:200]
        raise InputError(f"{path}: no readable Parquet file ({told}); get it again from its source") from None


def _table(
    path: Path, frame: Frame, wanted: Mapping[str, Kind], optional: Mapping[str, Kind], before: int = 0
) -> Table:
    """The columns of rows of a file, of which there are others ``before``."""
    others = [name for name in frame.columns if name not in wanted and name.isidentifier()]
    known: dict[str, Kind] = {**wanted, **dict.fromkeys(others, "list"), **optional}
    missing = [name for name in wanted if name not in frame.columns]
    extra = [name for name in frame.columns if name not in known]
    if missing or extra:
        told = f"missing columns {', '.join(missing)}" if missing else f"unknown columns {', '.join(extra)}"
        raise InputError(f"{path}: {told}; the format has {', '.join(known)}")
    if not frame.height:
        raise InputError(f"{path}: the file has no rows; get it again from its source")
    columns = {
        name: _parquet_column(path, frame[name], name, kind, before)
        for name, kind in known.items()
        if name in frame.columns
    }
    places = np.arange(before, before + frame.height) if before else None
    return Table(path, columns, frame.height, places)


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
