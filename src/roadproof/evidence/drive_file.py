"""Drive files: a drive with everything that is needed to judge it again.

A drive whose accelerations are constant on every piece is ``roadproof/drive/1``; one with jerk is
``roadproof/drive/2``, where every piece says its jerk. Both are read. Numbers are rationals as text; null is
without bound. Reading checks every field; whether the formula
holds on the drive is for ``judged``.
"""

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import Any

from roadproof.errors import InputError
from roadproof.evidence.answers import drive as kept
from roadproof.evidence.codec import read, write
from roadproof.evidence.line_file import line_of, line_said
from roadproof.evidence.strict import Fields, JsonObject, is_rational, rational, read_json
from roadproof.library.roles import with_vehicles
from roadproof.library.scenarios import LANE
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Course, Drive, Motion, Piece
from roadproof.world.road import Lanelet, Road, pairs
from roadproof.world.signals import SIZES, STARTING

SCHEMA = "roadproof/drive/1"
JERK_SCHEMA = "roadproof/drive/2"
SCHEMAS_READ = (SCHEMA, JERK_SCHEMA)
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


def drive_data(file: DriveFile, said: object) -> JsonObject:
    """The file as plain data, in the order in which a reader wants it; ``said``: what the judge said."""
    has_jerk = any(motion.has_jerk for motion in file.drive.vehicles.values())
    values = {name: str(value) for name, value in file.values.items()}
    return write(
        (kept.JerkDrive if has_jerk else kept.Drive)(
            scenario=file.scenario,
            set=file.set_name,
            formula=file.formula,
            horizon=file.horizon,
            lane=file.lanes.get(LANE),
            lanes=file.lanes if set(file.lanes) - {LANE} else None,
            overlaps_allowed=file.overlaps_allowed,
            parameters=values | dict(file.options),
            road=road_said(file.road),
            vehicles={name: _motion_said(x, has_jerk) for name, x in file.drive.vehicles.items()},
            signals=tuple(_signal_said(*key, course) for key, course in file.drive.own.items()),
            verdict=said,
        )
    )


def road_said(road: Road) -> kept.Road:
    """A road as files hold it."""
    lanelets = tuple(
        kept.Lanelet(id=x.id, lane=x.lane, zone=x.zone, attribute=x.attribute, s=x.s, d=x.d)
        for x in road.lanelets
    )
    beside = sorted(tuple(sorted(pair)) for pair in road.adjacent)
    return kept.Road(
        name=road.name,
        lanelets=lanelets,
        adjacent=tuple((x, y) for x, y in beside),
        line=line_said(road.line),
        map=road.map,
        unread=road.unread,
    )


def _motion_said(motion: Motion, has_jerk: bool) -> Any:
    starts = {name: getattr(motion, name) for name in _NUMBERS}
    if has_jerk:
        jerking = tuple(
            kept.JerkPiece(duration=p.duration, a_lon=p.a_lon, a_lat=p.a_lat, j_lon=p.j_lon)
            for p in motion.pieces
        )
        return kept.JerkMotion(kind=motion.kind, **starts, pieces=jerking)
    pieces = tuple(kept.Piece(duration=p.duration, a_lon=p.a_lon, a_lat=p.a_lat) for p in motion.pieces)
    return kept.Motion(kind=motion.kind, **starts, pieces=pieces)


def _signal_said(name: str, vehicle: str, course: Course) -> kept.Signal:
    """An own signal in SI units, 0 and 1 for false and true."""
    values = tuple(kept.CourseValue(start=start, value=value) for start, value in course)
    return kept.Signal(signal=name, vehicle=vehicle or None, values=values)


def load_drive(path: Path) -> DriveFile:
    """Read a drive file. Raises ``InputError`` naming file, field, value and rule."""
    return read_drive(read_json(path), str(path))


def read_drive(content: object, where: str) -> DriveFile:
    """The inverse of ``drive_data``. Raises ``InputError``."""
    schema = Fields(content, where).text("schema")
    if schema not in SCHEMAS_READ:
        known = " or ".join(map(repr, SCHEMAS_READ))
        raise InputError(f"{where}: schema={schema!r}, but a drive file has {known}")
    said: kept.AnyDrive = read(kept.JerkDrive if schema == JERK_SCHEMA else kept.Drive, content, where)
    if said.horizon < 0:
        raise InputError(f"{where}: horizon={said.horizon} is negative")
    written = said.parameters
    numbers = {n: rational(x, f"{where}, parameters.{n}") for n, x in written.items() if is_rational(x)}
    return DriveFile(
        said.scenario,
        said.set,
        with_vehicles(said.formula, said.vehicles),
        said.horizon,
        _lanes(said, where),
        numbers,
        {name: x for name, x in written.items() if name not in numbers},
        road_of(said.road, f"{where}, road"),
        _drive(said, where),
        said.overlaps_allowed,
    )


def _drive(said: kept.AnyDrive, where: str) -> Drive:
    vehicles = {name: _motion(x, f"{where}, vehicle {name}") for name, x in said.vehicles.items()}
    own: dict[tuple[str, str], Course] = {}
    for k, course in enumerate(said.signals, 1):
        key = course.signal, course.vehicle or ""
        if key in own:
            raise InputError(f"{where}, signal {k}: {' of '.join(filter(None, key))} is given twice")
        own[key] = tuple((x.start, x.value) for x in course.values)
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


def _lanes(said: kept.AnyDrive, where: str) -> dict[str, str]:
    """``lane`` is what L stands for; ``lanes`` is there where there are others, and says the same of L."""
    if said.lanes is None:
        return {} if said.lane is None else {LANE: said.lane}
    if said.lane != said.lanes.get(LANE):
        raise InputError(f"{where}: lane={said.lane}, but lanes.{LANE}={said.lanes.get(LANE)}")
    return dict(said.lanes)


def road_of(said: kept.Road, where: str) -> Road:
    """The inverse of ``road_said``. Raises ``InputError``."""
    lanelets = tuple(_lanelet(x, f"{where}, lanelet {k}") for k, x in enumerate(said.lanelets, 1))
    ids = [lanelet.id for lanelet in lanelets]
    twice = next((name for k, name in enumerate(ids) if name in ids[:k]), None)
    if twice is not None:
        raise InputError(f"{where}: two lanelets are called '{twice}'")
    lanes = {lanelet.lane for lanelet in lanelets}
    adjacent: list[tuple[str, str]] = []
    for one, other in said.adjacent:
        if one == other:
            raise InputError(f"{where}: adjacent=['{one}', '{other}']: no lane is beside itself")
        for lane in (one, other):
            if lane not in lanes:
                raise InputError(f"{where}: adjacent=['{one}', '{other}']: there is no lane '{lane}'")
        if (one, other) in adjacent or (other, one) in adjacent:
            raise InputError(f"{where}: adjacent=['{one}', '{other}'] is given twice")
        adjacent.append((one, other))
    return Road(said.name, lanelets, pairs(adjacent), line_of(said.line, where), said.map, said.unread)


def _lanelet(said: kept.Lanelet, where: str) -> Lanelet:
    (begin, end), (right, left) = said.s, said.d
    if right >= left or (begin is not None and end is not None and begin >= end):
        raise InputError(f"{where}: an empty lanelet")
    return Lanelet(said.id, said.lane, said.zone, said.attribute, said.s, said.d)


def _motion(said: kept.Motion, where: str) -> Motion:
    pieces = [
        Piece(x.duration, x.a_lon, x.a_lat, x.j_lon if isinstance(x, kept.JerkPiece) else Fraction(0))
        for x in said.pieces
    ]
    numbers = {str(name): getattr(said, name) for name in _NUMBERS}
    try:
        return Motion(**numbers, pieces=tuple(pieces), kind=said.kind)
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None
