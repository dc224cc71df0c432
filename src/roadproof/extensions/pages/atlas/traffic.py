"""How often scenarios occur in recorded traffic: the table of US-101 that comes with the documents."""

import csv
from collections.abc import Sequence
from dataclasses import dataclass

from roadproof.runtime.package_data import shipped

SOURCE = "NGSIM US-101, US Department of Transportation, Federal Highway Administration, 2005"


@dataclass(frozen=True)
class Frequency:
    """In how many of the disturbances on a road sector a scenario holds; ``min_danger`` in s."""

    set: str
    min_danger: str
    matches: int
    disturbances: int


def frequencies(number: int, sector: str) -> Sequence[Frequency]:
    """Those of a scenario in each spec set; none where the table does not have it."""
    with (shipped("docs/data") / "us101.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    column = next((x for x in (rows[0] if rows else ()) if f"s{number}" in x.split()), None)
    return [
        Frequency(x["set"], x["minDanger"], int(x[column]), int(x["traces"]))
        for x in rows
        if column is not None and x["traces begin in"] == sector
    ]
