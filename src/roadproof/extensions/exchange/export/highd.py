"""A drive as a recording in highD's format, on the lower carriageway; zones of the road as TOML.

The upper carriageway is one lane that nobody drives on, since a recording has two. Places are moved by whole
metres so that x and y are positive, as they are in highD; frames count from 1.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import ceil, floor

import numpy as np

from roadproof.extensions.exchange.export.points import upper_left
from roadproof.extensions.exchange.export.subject import ExportSubject
from roadproof.extensions.traffic.formats.highd_columns import LOWER, lanes_of_markings
from roadproof.extensions.traffic.formats.recording import Floats, Recording
from roadproof.extensions.traffic.formats.straight import of_bands, place_recording
from roadproof.extensions.traffic.formats.table import table_bytes
from roadproof.extensions.traffic.formats.write_highd import highd_tables
from roadproof.extensions.traffic.road_file import road_toml
from roadproof.frontends.report.samples import kind_of
from roadproof.world.drive import Motion
from roadproof.world.road import Road
from roadproof.world.signals import RECORDED

DECIMALS = 9
_UPPER = (0.0, 4.0)
_TOP = 8
"""y of the left edge of the road, below the upper carriageway and a median."""


@dataclass(frozen=True)
class Shift:
    """Metres that a recording's s and d are greater than the drive's."""

    s: Fraction
    d: Fraction


def files(subject: ExportSubject) -> dict[str, bytes]:
    """XX_recordingMeta.csv, XX_tracksMeta.csv, XX_tracks.csv, XX being the subject's number; XX_road.toml.

    Raises ``InputError`` for roads that no road file can say.
    """
    name, shift = f"{subject.number:02d}", shift_of(subject)
    tables = highd_tables(recording_of(subject, name, shift), DECIMALS)
    made = {f"{name}_{table}.csv": table_bytes(columns, DECIMALS) for table, columns in tables.items()}
    if not _is_plain(subject.file.road):
        made[f"{name}_road.toml"] = road_toml(subject.file.road, shift.s, shift.d).encode()
    return made


def shift_of(subject: ExportSubject) -> Shift:
    """Return the shift that puts the last vehicle's rear and the road's left edge where highD begins."""
    rear = min(x.s - m.length for name, m in subject.vehicles.items() for x in subject.samples[name])
    left = max(x.d[1] for x in subject.file.road.lanelets)
    return Shift(Fraction(10 - floor(rear)), Fraction(-_TOP - ceil(left)))


def recording_of(subject: ExportSubject, name: str, shift: Shift) -> Recording:
    """The samples of the drive as a recording."""
    edges = sorted({x + shift.d for lanelet in subject.file.road.lanelets for x in lanelet.d}, reverse=True)
    road = of_bands(lanes_of_markings(_UPPER, tuple(round(float(-y), DECIMALS) for y in edges)))
    motions = [*subject.vehicles.values()]
    counts = np.full(len(motions), len(subject.times))
    length, width = (np.array([float(getattr(m, x)) for m in motions]) for x in ("length", "width"))
    rows = [
        (state, motion) for motion, x in zip(motions, subject.samples.values(), strict=True) for state in x
    ]
    corners = [upper_left(state, motion.length) for state, motion in rows]
    s = _floats(x + shift.s for x, _ in corners) + np.repeat(length, counts)
    d = _floats(-y + shift.d for _, y in corners)
    others = (_floats(getattr(state, x) for state, _ in rows) for x in RECORDED[2:])
    vehicles = {
        "vehicle_id": np.array([*subject.ids.values()]),
        "direction": np.full(len(motions), LOWER),
        "kind": np.array([class_of(m) for m in motions]),
        "length": length,
        "width": width,
        "first_frame": np.ones(len(motions), np.int64),
    }
    return place_recording(road, name, subject.rate, vehicles, counts, (s, d, *others))


def _floats(values: Iterable[Fraction]) -> Floats:
    return np.array([float(x) for x in values])


def _is_plain(road: Road) -> bool:
    """Return whether markings say all of a road: main lanes without end, side by side."""
    main = all(x.zone == x.attribute == "main" and x.s == (None, None) for x in road.lanelets)
    edges = sorted(x.d for x in road.lanelets)
    return main and all(a[1] == b[0] for a, b in pairwise(edges))


def class_of(motion: Motion) -> str:
    """Return the class of recordings with two classes: ``Car`` or ``Truck``."""
    return "Truck" if kind_of(motion) in ("truck", "bus") else "Car"
