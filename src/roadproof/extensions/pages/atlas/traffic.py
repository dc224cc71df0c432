"""Reads how often scenarios occur in recorded traffic: the table of US-101 that comes with the documents."""

import csv
from collections.abc import Sequence
from dataclasses import dataclass
from operator import itemgetter

from roadproof.runtime.package_data import shipped_folder

SOURCE = "NGSIM US-101, US Department of Transportation, Federal Highway Administration, 2005"


@dataclass(frozen=True)
class Frequency:
    """The number of disturbances on a road sector in which a scenario holds; ``min_danger`` is in s."""

    set: str
    min_danger: str
    matches: int
    disturbances: int


def frequencies(number: int, sector: str) -> Sequence[Frequency]:
    """Return the frequencies of a scenario in each spec set; empty where the table does not have it."""
    with (shipped_folder("docs/data") / "us101.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    column = next((x for x in (rows[0] if rows else ()) if f"s{number}" in x.split()), None)
    if column is None:
        return []
    cells = map(itemgetter("traces begin in", "set", "minDanger", column, "traces"), rows)
    return [
        Frequency(name, danger, int(n), int(of)) for begin, name, danger, n, of in cells if begin == sector
    ]
