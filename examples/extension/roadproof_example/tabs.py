"""Traces as text with tabs: the columns of samples in CSV, one row a sample and vehicle."""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.traffic.formats.samples import HEADER
from roadproof.extensions.traffic.formats.table import ColumnTable
from roadproof.world.models import load_road
from roadproof.world.road import Road


@dataclass(frozen=True)
class Tabs:
    """The samples of a file, on the road main-2."""

    table: ColumnTable
    road: Road
    computed: bool = False
    faults: tuple[str, ...] = ()
    otherwise: tuple[str, ...] = ()


def read_trace(path: Path, strict: bool) -> Tabs:
    """Read a file whose columns are exactly those of samples. Raises ``InputError``."""
    with path.open(encoding="utf-8", newline="") as file:
        rows = [*csv.reader(file, delimiter="\t")]
    if not rows or tuple(rows[0]) != HEADER:
        raise InputError(f"{path}: line 1: write the columns {', '.join(HEADER)} with tabs between")
    wrong = next((k for k, row in enumerate(rows, 1) if len(row) != len(HEADER)), None)
    if wrong is not None:
        raise InputError(f"{path}: line {wrong}: {len(rows[wrong - 1])} cells, but {len(HEADER)} columns")
    columns: dict[str, object] = {}
    for name, cells in zip(HEADER, zip(*rows[1:], strict=True), strict=True):
        try:
            columns[name] = np.array(cells) if name == "vehicle" else np.array(cells, dtype=float)
        except ValueError as error:
            raise InputError(f"{path}: column {name}: {error}") from None
    return Tabs(ColumnTable(path, columns, len(rows) - 1), load_road("main-2"))  # type: ignore[arg-type]
