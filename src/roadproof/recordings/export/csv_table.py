"""A drive as CSV: one row a sample and vehicle, SI units, every number as exact as a float is."""

import csv
import io

from roadproof.evidence.drive_file import DriveFile
from roadproof.recordings.export.road_toml import road_toml
from roadproof.recordings.export.subject import Subject, kind_of
from roadproof.recordings.export.xml import decimal
from roadproof.world.drive import value_at
from roadproof.world.signals import RECORDED, SIZES

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
    kinds = {name: kind_of(motion) for name, motion in subject.vehicles.items()}
    told = ["kind"] if any(kind != "car" for kind in kinds.values()) else []
    courses = subject.file.drive.own
    own = list(dict.fromkeys(name for name, _ in courses))
    writer.writerow([*HEADER, *told, *own])
    for k, time in enumerate(subject.times):
        for name, motion in subject.vehicles.items():
            known = [courses.get((x, name), courses.get((x, ""))) for x in own]
            more = ["" if course is None else decimal(value_at(course, time)) for course in known]
            signals = [getattr(subject.samples[name][k], signal) for signal in RECORDED]
            sizes = [getattr(motion, size) for size in SIZES]
            kind = [kinds[name].title()] if told else []
            writer.writerow([decimal(time), name, *map(decimal, (*signals, *sizes)), *kind, *more])
    return out.getvalue()
