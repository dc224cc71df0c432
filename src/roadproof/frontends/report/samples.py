"""A drive as CSV, one row a sample and vehicle, in SI units and as exact as floats are; its road as TOML."""

from __future__ import annotations

import csv
import io
from fractions import Fraction
from typing import TYPE_CHECKING

from roadproof.frontends.report.numbers import decimal
from roadproof.world.drive import Motion, value_at
from roadproof.world.motion import states_at
from roadproof.world.signals import RECORDED, SIZES, Kind

if TYPE_CHECKING:
    from roadproof.evidence.drive_file import DriveFile


HEADER = ("time", "vehicle", *RECORDED, *SIZES)


def csv_of(file: DriveFile, rate: int = 25) -> str:
    """The drive of a drive file, ``rate`` samples a second up to its horizon."""
    from roadproof.library.roles import vehicle_order  # who writes a road needs no library

    vehicles = {name: file.drive.vehicles[name] for name in vehicle_order(file.drive.vehicles)}
    times = [Fraction(k, rate) for k in range(int(file.horizon * rate) + 1)]
    samples = {name: [*states_at(motion, times)] for name, motion in vehicles.items()}
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    kinds = {name: kind_of(motion) for name, motion in vehicles.items()}
    kind_column = ["kind"] if any(kind != "car" for kind in kinds.values()) else []
    courses = file.drive.custom_signals
    own = list(dict.fromkeys(name for name, _ in courses))
    writer.writerow([*HEADER, *kind_column, *own])
    for k, time in enumerate(times):
        for name, motion in vehicles.items():
            known = [courses.get((x, name), courses.get((x, ""))) for x in own]
            more = ["" if course is None else decimal(value_at(course, time)) for course in known]
            signals = [getattr(samples[name][k], signal) for signal in RECORDED]
            sizes = [getattr(motion, size) for size in SIZES]
            kind = [kinds[name].title()] if kind_column else []
            writer.writerow([decimal(time), name, *map(decimal, (*signals, *sizes)), *kind, *more])
    return out.getvalue()


TRUCK_LENGTH = 7
"""A vehicle longer than that (m) is a truck, as in recordings."""


def kind_of(motion: Motion) -> Kind:
    """Return the kind that the drive states, else ``car`` or ``truck``."""
    if motion.kind is not None:
        return motion.kind
    return "car" if motion.length <= TRUCK_LENGTH else "truck"
