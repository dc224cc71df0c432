"""CSV recordings with their roads, as text that tests may spoil."""

from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np

from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.samples import HEADER
from roadproof.world.road import Lanelet, Road, adjacency
from roadproof.world.signals import RECORDED

TWO = (
    "0,1,20,5.3,20,0,0,0,4.5,1.8",
    "0.1,1,22,5.3,20,0,0,0,4.5,1.8",
    "0.2,1,24,5.3,20,0,0,0,4.5,1.8",
    "0.1,2,62,2.6,30,0,0,0,5,2",
    "0.2,2,65,2.6,30,0,0,0,5,2",
)
"""Vehicle 1 in the left lane of models/roads/merge.toml, vehicle 2, which comes later, in the right one."""


def toml_of(road: Road, more: str = "") -> str:
    """A road in the form of models/roads."""
    parts = [more]
    for x in road.lanelets:
        s = ", ".join(
            sign if bound is None else f'"{bound}"' for bound, sign in zip(x.s, ("-inf", "inf"), strict=True)
        )
        names = f'id = "{x.id}"\nlane = "{x.lane}"\nzone = "{x.zone}"\nattribute = "{x.attribute}"'
        parts.append(f'[[lanelet]]\n{names}\ns = [{s}]\nd = ["{x.d[0]}", "{x.d[1]}"]')
    return "\n".join(parts) + "\n"


def lower_road(recording: Recording) -> Road:
    """The lanes of direction 2 as a road of its own."""
    lanes = [x for x in recording.lanes if x.direction == 2 and x.d is not None]
    lanelets = [
        Lanelet(x.name, x.name, "main", "main", (None, None), (Fraction(str(x.d[0])), Fraction(str(x.d[1]))))
        for x in lanes
        if x.d is not None
    ]
    names = [x.name for x in lanes]
    return Road("lower", tuple(lanelets), adjacency(pairwise(names)))


def csv_of(recording: Recording, kinds: bool = True) -> str:
    """A recording as a CSV file, all its digits kept."""
    vehicle = recording.row_vehicle
    columns = [recording.row_frame / recording.rate, recording.vehicle_id[vehicle]]
    columns += [getattr(recording, name) for name in RECORDED]
    columns += [recording.length[vehicle], recording.width[vehicle]]
    columns += [recording.kind[vehicle]] if kinds else []
    rows = zip(*(np.asarray(x).tolist() for x in columns), strict=True)
    head = ",".join((*HEADER, "kind") if kinds else HEADER)
    return "\n".join((head, *(",".join(map(str, row)) for row in rows))) + "\n"


def write_samples(folder: Path, name: str, text: str, road: str) -> Path:
    """NAME.csv and NAME_road.toml in ``folder``; the path of the samples."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}_road.toml").write_text(road)
    path = folder / f"{name}.csv"
    path.write_text(text)
    return path
