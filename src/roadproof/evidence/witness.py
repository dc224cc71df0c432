"""Drive files, ``roadproof/drive/1``: a drive with everything that is needed to judge it again.

Numbers are rationals as text; null is without bound. Reading checks every field; ``judge_file``
elaborates the formula with the library at hand and asks the exact judge, no solver.
"""

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, cast, get_args

from roadproof.errors import InputError, RoadproofError
from roadproof.files import read_limited
from roadproof.judge.exact import Judgement, judge
from roadproof.judge.replay import first_overlap
from roadproof.spec.bind import bind, default_values
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import Library
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.road import Attribute, Lanelet, Road, Zone, pairs

SCHEMA = "roadproof/drive/1"
LARGEST_FILE = 5_000_000
_RATIONAL = re.compile(r"-?\d{1,40}(/\d{1,40})?")


@dataclass(frozen=True)
class DriveFile:
    """A drive and what it is a drive of; ``lanes`` gives each free lane of the formula a lane of the road.

    ``overlaps_allowed``: whether boxes may overlap within the horizon (s).
    """

    scenario: int | None
    set_name: str
    formula: str
    horizon: Fraction
    lanes: Mapping[str, str]
    values: Mapping[str, Fraction]
    options: Mapping[str, str]
    road: Road
    drive: Drive
    overlaps_allowed: bool = False


@dataclass(frozen=True)
class Ruling:
    """Whether the file's claim stands; ``reason`` says why where it does not."""

    judgement: Judgement | None
    reason: str

    @property
    def accepted(self) -> bool:
        return not self.reason


def judge_file(file: DriveFile, library: Library) -> Ruling:
    """Judge the drive on the formula in dense and unbounded time, with no look at the file's verdict."""
    try:
        query = read_claim(library.select(file.set_name, file.options), file.formula)
        missing = set(query.lanes) - set(file.lanes)
        if missing:
            raise InputError(f"the file names no lane for {', '.join(sorted(missing))}")
        absent = set(query.vehicles) - set(file.drive.vehicles)
        if absent:
            raise InputError(f"the file has no vehicle {', '.join(sorted(absent))}")
        formula = bind(query.formula, file.road, file.lanes, {**default_values(library), **file.values})
        judgement = judge(formula, file.drive)
    except RoadproofError as error:
        return Ruling(None, str(error))
    if not judgement.holds:
        return Ruling(judgement, f"the formula does not hold on the drive: {file.formula}")
    if not file.overlaps_allowed:
        overlap = first_overlap(file.drive, file.horizon)
        if overlap is not None:
            return Ruling(judgement, str(overlap))
    return Ruling(judgement, "")


def as_json(file: DriveFile, verdict: Mapping[str, Any]) -> dict[str, Any]:
    """The file as plain data, in the order in which a reader wants it."""
    data: dict[str, Any] = {"schema": SCHEMA, "scenario": file.scenario, "set": file.set_name}
    data |= {"formula": file.formula, "horizon": str(file.horizon), "lane": file.lanes.get("L")}
    if set(file.lanes) - {"L"}:
        data["lanes"] = dict(file.lanes)
    if file.overlaps_allowed:
        data["overlaps_allowed"] = True
    values = {name: str(value) for name, value in file.values.items()}
    data["parameters"] = values | dict(file.options)
    data["road"] = road_data(file.road)
    data["vehicles"] = {name: _motion_json(motion) for name, motion in file.drive.vehicles.items()}
    return data | {"verdict": dict(verdict)}


def road_data(road: Road) -> dict[str, Any]:
    """A road as plain data, as drive files hold it."""
    return {
        "name": road.name,
        "lanelets": [_lanelet_json(x) for x in road.lanelets],
        "adjacent": sorted(sorted(pair) for pair in road.adjacent),
    }


def _lanelet_json(lanelet: Lanelet) -> dict[str, Any]:
    s = [None if bound is None else str(bound) for bound in lanelet.s]
    return {
        "id": lanelet.id,
        "lane": lanelet.lane,
        "zone": lanelet.zone,
        "attribute": lanelet.attribute,
        "s": s,
        "d": [str(bound) for bound in lanelet.d],
    }


def _motion_json(motion: Motion) -> dict[str, Any]:
    fields = ("length", "width", "s", "d", "v_lon", "v_lat")
    pieces = [
        {
            "duration": None if p.duration is None else str(p.duration),
            "a_lon": str(p.a_lon),
            "a_lat": str(p.a_lat),
        }
        for p in motion.pieces
    ]
    return {field: str(getattr(motion, field)) for field in fields} | {"pieces": pieces}


def load_drive(path: Path) -> DriveFile:
    """Read a drive file. Raises ``InputError`` naming file, field, value and rule."""
    data = read_limited(path, LARGEST_FILE, "this is no drive file")
    try:
        content = json.loads(data.decode("utf-8"))
    except (UnicodeDecodeError, ValueError, RecursionError):
        raise InputError(f"{path} is no JSON") from None
    return from_json(content, str(path))


def from_json(content: object, where: str) -> DriveFile:
    """The inverse of ``as_json``. Raises ``InputError``."""
    data = _Reader(content, where)
    if data.text("schema") != SCHEMA:
        raise InputError(f"{where}: schema={data.text('schema')!r}, but a drive file has {SCHEMA!r}")
    lanes = {str(k): str(v) for k, v in data.mapping("lanes").items()} if "lanes" in data.content else {}
    if data.content.get("lane") is not None:
        lanes["L"] = data.text("lane")
    values: dict[str, Fraction] = {}
    options: dict[str, str] = {}
    for name, value in data.mapping("parameters").items():
        if isinstance(value, str) and _RATIONAL.fullmatch(value):
            values[name] = _rational(value, f"{where}, parameters.{name}")
        else:
            options[name] = str(value)
    scenario = data.content.get("scenario")
    if scenario is not None and type(scenario) is not int:
        raise InputError(f"{where}: scenario={scenario!r} is no whole number")
    overlaps_allowed = data.content.get("overlaps_allowed", False)
    if type(overlaps_allowed) is not bool:
        raise InputError(f"{where}: overlaps_allowed={overlaps_allowed!r}; write true or false")
    vehicles = {
        str(name): _motion(entry, f"{where}, vehicle {name}")
        for name, entry in data.mapping("vehicles").items()
    }
    horizon = data.rational("horizon")
    if horizon < 0:
        raise InputError(f"{where}: horizon={horizon} is negative")
    return DriveFile(
        scenario,
        data.text("set"),
        data.text("formula"),
        horizon,
        lanes,
        values,
        options,
        _road(data.content.get("road"), f"{where}, road"),
        Drive(vehicles),
        overlaps_allowed,
    )


class _Reader:
    """Fields of a JSON object, each read as what it must be."""

    def __init__(self, content: object, where: str) -> None:
        if not isinstance(content, dict):
            raise InputError(f"{where}: a JSON object is expected here")
        self.content: dict[str, Any] = content
        self.where = where

    def _get(self, field: str) -> Any:
        if field not in self.content:
            raise InputError(f"{self.where}: '{field}' is missing")
        return self.content[field]

    def text(self, field: str) -> str:
        value = self._get(field)
        if not isinstance(value, str):
            raise InputError(f"{self.where}: {field}={value!r} is no text")
        return value

    def mapping(self, field: str) -> dict[str, Any]:
        value = self._get(field)
        if not isinstance(value, dict):
            raise InputError(f"{self.where}: '{field}' is no object")
        return value

    def items(self, field: str) -> list[Any]:
        value = self._get(field)
        if not isinstance(value, list):
            raise InputError(f"{self.where}: '{field}' is no list")
        return value

    def rational(self, field: str) -> Fraction:
        return _rational(self._get(field), f"{self.where}, {field}")


def _rational(value: object, where: str) -> Fraction:
    if not isinstance(value, str) or not _RATIONAL.fullmatch(value):
        raise InputError(f'{where}: {str(value)[:60]!r} is no rational as text, such as "3/5"')
    top, _, bottom = value.partition("/")
    if bottom and int(bottom) == 0:
        raise InputError(f"{where}: {value!r} divides by zero")
    return Fraction(int(top), int(bottom or 1))


def _road(content: object, where: str) -> Road:
    data = _Reader(content, where)
    lanelets = tuple(_lanelet(x, f"{where}, lanelet {k + 1}") for k, x in enumerate(data.items("lanelets")))
    adjacent: list[tuple[str, str]] = []
    for pair in data.items("adjacent"):
        if not isinstance(pair, list) or len(pair) != 2:
            raise InputError(f"{where}: adjacent={pair!r} is no pair of lanes")
        adjacent.append((str(pair[0]), str(pair[1])))
    return Road(str(data.content.get("name", "road")), lanelets, pairs(adjacent))


def _lanelet(content: object, where: str) -> Lanelet:
    data = _Reader(content, where)
    zone, attribute = data.text("zone"), data.text("attribute")
    if zone not in get_args(Zone) or attribute not in get_args(Attribute):
        raise InputError(f"{where}: zone={zone!r}, attribute={attribute!r} are not of SPEC §4")
    s, d = data.items("s"), data.items("d")
    if len(s) != 2 or len(d) != 2:
        raise InputError(f"{where}: s and d are pairs")
    bounds = tuple(None if bound is None else _rational(bound, f"{where}, s") for bound in s)
    right, left = (_rational(bound, f"{where}, d") for bound in d)
    if right >= left or (bounds[0] is not None and bounds[1] is not None and bounds[0] >= bounds[1]):
        raise InputError(f"{where}: an empty lanelet")
    return Lanelet(
        data.text("id"),
        data.text("lane"),
        cast(Zone, zone),
        cast(Attribute, attribute),
        (bounds[0], bounds[1]),
        (right, left),
    )


def _motion(content: object, where: str) -> Motion:
    data = _Reader(content, where)
    pieces = []
    for k, entry in enumerate(data.items("pieces")):
        piece = _Reader(entry, f"{where}, piece {k + 1}")
        for_ever = piece._get("duration") is None
        duration = None if for_ever else piece.rational("duration")
        pieces.append(Piece(duration, piece.rational("a_lon"), piece.rational("a_lat")))
    length, width, s, d, v_lon, v_lat = (
        data.rational(name) for name in ("length", "width", "s", "d", "v_lon", "v_lat")
    )
    try:
        return Motion(length, width, s, d, v_lon, v_lat, tuple(pieces))
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None
