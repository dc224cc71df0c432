"""A drive as CSV, one row a sample and vehicle, in SI units and as exact as floats are; its road as TOML."""

import csv
import io
import json
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.exchange.export.subject import Subject, kind_of
from roadproof.extensions.exchange.export.xml import decimal
from roadproof.world.drive import value_at
from roadproof.world.lanelet_rules import check_lanelets, shared_boundaries
from roadproof.world.road import Lanelet, Road
from roadproof.world.signals import RECORDED, SIZES


def road_toml(road: Road, s: Fraction = Fraction(0), d: Fraction = Fraction(0)) -> str:
    """The text of a file that ``world.models.load_road`` reads as ``road``, moved by ``s`` and ``d`` m.

    Raises ``InputError`` for what such a file cannot say: lanes that are adjacent without a shared boundary
    or have one and are not adjacent, and lanes that are no chain of lanelets.
    """
    where = f"road {road.name}"
    check_lanelets(road.lanelets, where)
    other = shared_boundaries(road.lanelets) ^ road.adjacent
    if other:
        names = " and ".join(sorted(min(other, key=sorted)))
        raise InputError(f"{where}: lanes {names} share a boundary or are adjacent, but not both")
    return "\n".join([f"name = {_text(road.name)}\n", *(_lanelet(x, s, d) for x in road.lanelets)])


def _lanelet(lanelet: Lanelet, s: Fraction, d: Fraction) -> str:
    texts = {name: _text(getattr(lanelet, name)) for name in ("id", "lane", "zone", "attribute")}
    low = "-inf" if lanelet.s[0] is None else _number(lanelet.s[0] + s)
    high = "inf" if lanelet.s[1] is None else _number(lanelet.s[1] + s)
    ranges = {"s": (low, high), "d": tuple(_number(x + d) for x in lanelet.d)}
    lines = [f"{name} = {text}" for name, text in texts.items()]
    lines += [f"{name} = [{', '.join(both)}]" for name, both in ranges.items()]
    return "[[lanelet]]\n" + "\n".join(lines) + "\n"


def _text(text: str) -> str:
    """A basic string of TOML, whose escapes are those of JSON."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _number(value: Fraction) -> str:
    """Exactly: a decimal, or a ratio as text where there is none."""
    text = decimal(value)
    return text if Fraction(text) == value else _text(str(value))


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
