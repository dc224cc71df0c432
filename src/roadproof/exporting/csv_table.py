"""A drive as CSV: one row a sample and vehicle, SI units, every number as exact as a float is."""

import csv
import io

from roadproof.evidence.drive_file import DriveFile
from roadproof.exporting.road_toml import road_toml
from roadproof.exporting.subject import Subject
from roadproof.exporting.xml import decimal
from roadproof.signals import RECORDED, SIZES

HEADER = ("time", "vehicle", *RECORDED, *SIZES)


def files(subject: Subject) -> dict[str, bytes]:
    """NAME.csv, and NAME_road.toml, the road that it is on. Raises ``InputError``."""
    table = _table(subject)
    road = road_toml(subject.file.road)
    return {f"{subject.name}.csv": table.encode(), f"{subject.name}_road.toml": road.encode()}


def csv_of(file: DriveFile) -> str:
    """The drive of a drive file, 25 samples a second up to its horizon."""
    return _table(Subject("drive", 1, file))


def _table(subject: Subject) -> str:
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(HEADER)
    for k, time in enumerate(subject.times):
        for name, motion in subject.vehicles.items():
            signals = [getattr(subject.samples[name][k], signal) for signal in RECORDED]
            sizes = [getattr(motion, size) for size in SIZES]
            writer.writerow([decimal(time), name, *map(decimal, (*signals, *sizes))])
    return out.getvalue()
