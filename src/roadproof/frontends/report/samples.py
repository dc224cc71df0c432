"""A drive as CSV, one row a sample and vehicle, in SI units and as exact as floats are; its road as TOML."""

import csv
import io
import json
from fractions import Fraction
from typing import TYPE_CHECKING

from roadproof.errors import InputError
from roadproof.frontends.report.xml import decimal
from roadproof.world.drive import Motion, value_at
from roadproof.world.lanelet_rules import check_lanelets, shared_boundaries
from roadproof.world.motion import states_at
from roadproof.world.road import Lanelet, Road
from roadproof.world.signals import RECORDED, SIZES, Kind

if TYPE_CHECKING:
    from roadproof.evidence.drive_file import DriveFile


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


def csv_of(file: "DriveFile", rate: int = 25) -> str:
    """The drive of a drive file, ``rate`` samples a second up to its horizon."""
    from roadproof.library.roles import vehicle_order  # who writes a road needs no library

    vehicles = {name: file.drive.vehicles[name] for name in vehicle_order(file.drive.vehicles)}
    times = [Fraction(k, rate) for k in range(int(file.horizon * rate) + 1)]
    samples = {name: [*states_at(motion, times)] for name, motion in vehicles.items()}
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    kinds = {name: kind_of(motion) for name, motion in vehicles.items()}
    told = ["kind"] if any(kind != "car" for kind in kinds.values()) else []
    courses = file.drive.own
    own = list(dict.fromkeys(name for name, _ in courses))
    writer.writerow([*HEADER, *told, *own])
    for k, time in enumerate(times):
        for name, motion in vehicles.items():
            known = [courses.get((x, name), courses.get((x, ""))) for x in own]
            more = ["" if course is None else decimal(value_at(course, time)) for course in known]
            signals = [getattr(samples[name][k], signal) for signal in RECORDED]
            sizes = [getattr(motion, size) for size in SIZES]
            kind = [kinds[name].title()] if told else []
            writer.writerow([decimal(time), name, *map(decimal, (*signals, *sizes)), *kind, *more])
    return out.getvalue()


TRUCK_LENGTH = 7
"""A vehicle longer than that (m) is a truck, as in recordings."""


def kind_of(motion: Motion) -> Kind:
    """What the drive says that it is; where it says nothing, ``car`` or ``truck``."""
    if motion.kind is not None:
        return motion.kind
    return "car" if motion.length <= TRUCK_LENGTH else "truck"


def class_of(motion: Motion) -> str:
    """As recordings have it that know two classes: ``Car`` or ``Truck``."""
    return "Truck" if kind_of(motion) in ("truck", "bus") else "Car"
