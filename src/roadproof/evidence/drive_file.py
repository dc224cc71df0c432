"""Drive files: a drive with everything that is needed to judge it again.

A drive whose accelerations are constant on every piece is ``roadproof/drive/1``; one with jerk is
``roadproof/drive/2``, where every piece says its jerk. Both are read. Numbers are rationals as text; null is
without bound. Reading checks every field; whether the formula
holds on the drive is for ``judged``.
"""

from collections.abc import Mapping, Sized
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any, cast, get_args

from roadproof.errors import InputError
from roadproof.evidence.strict import Fields, is_rational, rational, read_json, text
from roadproof.library.scenarios import LANE
from roadproof.world.drive import Course, Drive, Motion, Piece
from roadproof.world.road import Attribute, Lanelet, Road, Zone, pairs
from roadproof.world.signals import KINDS, SIZES, STARTING

SCHEMA = "roadproof/drive/1"
JERK_SCHEMA = "roadproof/drive/2"
SCHEMAS_READ = (SCHEMA, JERK_SCHEMA)
MOST = {"lanelets": 1000, "adjacent": 1000, "vehicles": 20, "pieces": 2000, "signals": 100, "values": 2000}
_FIELDS = (
    *("schema", "scenario", "set", "formula", "horizon", "lane", "lanes", "overlaps_allowed"),
    *("parameters", "road", "vehicles", "signals", "verdict"),
)
_NUMBERS = (*SIZES, *STARTING)


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


def drive_data(file: DriveFile, verdict: Mapping[str, Any]) -> dict[str, Any]:
    """The file as plain data, in the order in which a reader wants it."""
    with_jerk = any(motion.has_jerk for motion in file.drive.vehicles.values())
    schema = JERK_SCHEMA if with_jerk else SCHEMA
    data: dict[str, Any] = {"schema": schema, "scenario": file.scenario, "set": file.set_name}
    data |= {"formula": file.formula, "horizon": str(file.horizon), "lane": file.lanes.get(LANE)}
    if set(file.lanes) - {LANE}:
        data["lanes"] = dict(file.lanes)
    if file.overlaps_allowed:
        data["overlaps_allowed"] = True
    values = {name: str(value) for name, value in file.values.items()}
    data["parameters"] = values | dict(file.options)
    data["road"] = road_data(file.road)
    data["vehicles"] = {name: _motion_json(motion, with_jerk) for name, motion in file.drive.vehicles.items()}
    if file.drive.own:
        data["signals"] = [_course_json(*key, course) for key, course in file.drive.own.items()]
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


def _motion_json(motion: Motion, with_jerk: bool) -> dict[str, Any]:
    pieces = [
        {
            "duration": None if p.duration is None else str(p.duration),
            "a_lon": str(p.a_lon),
            "a_lat": str(p.a_lat),
            **({"j_lon": str(p.j_lon)} if with_jerk else {}),
        }
        for p in motion.pieces
    ]
    kind = {} if motion.kind is None else {"kind": motion.kind}
    return kind | {str(name): str(getattr(motion, name)) for name in _NUMBERS} | {"pieces": pieces}


def _course_json(name: str, vehicle: str, course: Course) -> dict[str, Any]:
    """An own signal in SI units, 0 and 1 for false and true; ``vehicle`` null where it is of none."""
    values = [{"from": str(start), "value": str(value)} for start, value in course]
    return {"signal": name, "vehicle": vehicle or None, "values": values}


def load_drive(path: Path) -> DriveFile:
    """Read a drive file. Raises ``InputError`` naming file, field, value and rule."""
    return read_drive(read_json(path), str(path))


def read_drive(content: object, where: str) -> DriveFile:
    """The inverse of ``drive_data``. Raises ``InputError``."""
    data = Fields(content, where, _FIELDS)
    schema = data.text("schema")
    if schema not in SCHEMAS_READ:
        known = " or ".join(map(repr, SCHEMAS_READ))
        raise InputError(f"{where}: schema={schema!r}, but a drive file has {known}")
    horizon = data.rational("horizon")
    if horizon < 0:
        raise InputError(f"{where}: horizon={horizon} is negative")
    values: dict[str, Fraction] = {}
    options: dict[str, str] = {}
    for name, value in data.mapping("parameters").items():
        if is_rational(value):
            values[name] = rational(value, f"{where}, parameters.{name}")
        else:
            options[name] = text(value, f"{where}, parameters.{name}")
    _few(data.mapping("vehicles"), "vehicles", where)
    return DriveFile(
        data.whole("scenario") if data.has("scenario") else None,
        data.text("set"),
        data.text("formula"),
        horizon,
        _lanes(data),
        values,
        options,
        read_road(data.content.get("road"), f"{where}, road"),
        _drive(data, where, schema == JERK_SCHEMA),
        data.flag("overlaps_allowed") if "overlaps_allowed" in data.content else False,
    )


def _drive(data: Fields, where: str, with_jerk: bool) -> Drive:
    vehicles = {
        k: _motion(v, f"{where}, vehicle {k}", with_jerk) for k, v in data.mapping("vehicles").items()
    }
    own: dict[tuple[str, str], Course] = {}
    entries = data.items("signals") if "signals" in data.content else []
    _few(entries, "signals", where)
    for k, entry in enumerate(entries):
        course = Fields(entry, f"{where}, signal {k + 1}", ("signal", "vehicle", "values"))
        key = course.text("signal"), course.text("vehicle") if course.has("vehicle") else ""
        if key in own:
            raise InputError(f"{course.where}: {' of '.join(filter(None, key))} is given twice")
        _few(course.items("values"), "values", course.where)
        values = (Fields(v, f"{course.where}, value", ("from", "value")) for v in course.items("values"))
        own[key] = tuple((v.rational("from"), v.rational("value")) for v in values)
    try:
        return Drive(vehicles, own)
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None


def natural_of(content: object, where: str) -> bool | None:
    """Whether a drive file says that its drive is natural, None where it says nothing of it.

    Raises ``InputError``.
    """
    data = Fields(content, where)
    said = Fields(data.mapping("verdict") if data.has("verdict") else {}, f"{where}, verdict")
    return said.flag("natural") if said.has("natural") else None


def _few(items: Sized, what: str, where: str) -> None:
    if len(items) > MOST[what]:
        raise InputError(f"{where}: {len(items)} {what}, at most {MOST[what]} are read")


def _lanes(data: Fields) -> dict[str, str]:
    """``lane`` is what L stands for; ``lanes`` is there where there are others, and says the same of L."""
    lane = {LANE: data.text("lane")} if data.has("lane") else {}
    if "lanes" not in data.content:
        return lane
    lanes = data.named_texts("lanes")
    if lane.get(LANE) != lanes.get(LANE):
        raise InputError(f"{data.where}: lane={lane.get(LANE)}, but lanes.{LANE}={lanes.get(LANE)}")
    return lanes


def read_road(content: object, where: str) -> Road:
    data = Fields(content, where, ("name", "lanelets", "adjacent"))
    _few(data.items("lanelets"), "lanelets", where)
    _few(data.items("adjacent"), "adjacent", where)
    lanelets = tuple(_lanelet(x, f"{where}, lanelet {k + 1}") for k, x in enumerate(data.items("lanelets")))
    ids = [lanelet.id for lanelet in lanelets]
    twice = next((name for k, name in enumerate(ids) if name in ids[:k]), None)
    if twice is not None:
        raise InputError(f"{where}: two lanelets are called '{twice}'")
    lanes = {lanelet.lane for lanelet in lanelets}
    adjacent: list[tuple[str, str]] = []
    for pair in data.items("adjacent"):
        if not isinstance(pair, list) or len(pair) != 2:
            raise InputError(f"{where}: adjacent={str(pair)[:60]!r} is no pair of lanes")
        one, other = (text(lane, f"{where}, adjacent") for lane in pair)
        if one == other:
            raise InputError(f"{where}: adjacent=['{one}', '{other}']: no lane is beside itself")
        for lane in (one, other):
            if lane not in lanes:
                raise InputError(f"{where}: adjacent=['{one}', '{other}']: there is no lane '{lane}'")
        if (one, other) in adjacent or (other, one) in adjacent:
            raise InputError(f"{where}: adjacent=['{one}', '{other}'] is given twice")
        adjacent.append((one, other))
    return Road(data.text("name"), lanelets, pairs(adjacent))


def _lanelet(content: object, where: str) -> Lanelet:
    data = Fields(content, where, ("id", "lane", "zone", "attribute", "s", "d"))
    zone, attribute = data.text("zone"), data.text("attribute")
    if zone not in get_args(Zone) or attribute not in get_args(Attribute):
        raise InputError(
            f"{where}: zone={zone!r}, attribute={attribute!r} are none of docs/explanation/semantics.md §4"
        )
    s, d = data.items("s"), data.items("d")
    if len(s) != 2 or len(d) != 2:
        raise InputError(f"{where}: s and d are pairs")
    bounds = tuple(None if bound is None else rational(bound, f"{where}, s") for bound in s)
    right, left = (rational(bound, f"{where}, d") for bound in d)
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


def _motion(content: object, where: str, with_jerk: bool) -> Motion:
    data = Fields(content, where, (*_NUMBERS, "kind", "pieces"))
    kind = next((x for x in KINDS if data.has("kind") and x == data.text("kind")), None)
    if data.has("kind") and kind is None:
        raise InputError(f"{where}: kind={data.text('kind')!r}, but kinds are {', '.join(KINDS)}")
    _few(data.items("pieces"), "pieces", where)
    fields = ("duration", "a_lon", "a_lat", *(("j_lon",) if with_jerk else ()))
    pieces = []
    for k, entry in enumerate(data.items("pieces")):
        piece = Fields(entry, f"{where}, piece {k + 1}", fields)
        duration = None if piece.get("duration") is None else piece.rational("duration")
        jerk = piece.rational("j_lon") if with_jerk else Fraction(0)
        pieces.append(Piece(duration, piece.rational("a_lon"), piece.rational("a_lat"), jerk))
    numbers = {str(name): data.rational(name) for name in _NUMBERS}
    try:
        return Motion(**numbers, pieces=tuple(pieces), kind=kind)
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None
