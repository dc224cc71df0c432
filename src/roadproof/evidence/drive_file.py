"""Drive files: a drive with everything that is needed to judge it again.

The schema is ``roadproof/drive/1`` if all accelerations are piecewise constant, and ``roadproof/drive/2`` if
a piece has jerk; then every piece has a jerk. Both versions are read. Numbers are rationals as text; null
means unbounded. Reading checks every field; ``judged`` checks whether the formula holds on the drive.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.core_record import DRIVES, JERK_DRIVE
from roadproof.errors import InputError
from roadproof.evidence.answers import drive as json_types
from roadproof.evidence.codec import read, write
from roadproof.evidence.strict import Fields, JsonObject, is_rational, rational, read_json
from roadproof.library.bind import default_values, values_with
from roadproof.library.roles import with_vehicles
from roadproof.library.scenario_names import LANE
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Course, Drive, Motion, Piece
from roadproof.world.road import Lanelet, Road, adjacency
from roadproof.world.signals import SIZES, STARTING

if TYPE_CHECKING:
    from roadproof.library.specification import Library
    from roadproof.world.reference_line import ReferenceLine

_NUMBERS = (*SIZES, *STARTING)


@dataclass(frozen=True)
class DriveFile:
    """A drive with its formula; ``lanes`` maps each free lane of the formula to a lane of the road.

    ``overlaps_allowed``: whether boxes may overlap within the ``horizon`` (s).
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


def drive_data(file: DriveFile, verdict: object) -> JsonObject:
    """Return the file as JSON, in an order that suits readers; ``verdict``: the verdict of the judge."""
    has_jerk = any(motion.has_jerk for motion in file.drive.vehicles.values())
    values = {name: str(value) for name, value in file.values.items()}
    return write(
        (json_types.JerkDriveData if has_jerk else json_types.DriveData)(
            scenario=file.scenario,
            set=file.set_name,
            formula=file.formula,
            horizon=file.horizon,
            lane=file.lanes.get(LANE),
            lanes=file.lanes if set(file.lanes) - {LANE} else None,
            overlaps_allowed=file.overlaps_allowed,
            parameters=values | dict(file.options),
            road=road_data(file.road),
            vehicles={name: _motion_data(x, has_jerk) for name, x in file.drive.vehicles.items()},
            signals=tuple(_signal_data(*key, course) for key, course in file.drive.custom_signals.items()),
            verdict=verdict,
        )
    )


def road_data(road: Road) -> json_types.RoadData:
    """Return the JSON form of a road."""
    lanelets = tuple(
        json_types.LaneletData(id=x.id, lane=x.lane, zone=x.zone, attribute=x.attribute, s=x.s, d=x.d)
        for x in road.lanelets
    )
    pairs_of_lanes = sorted(tuple(sorted(pair)) for pair in road.adjacent)
    return json_types.RoadData(
        name=road.name,
        lanelets=lanelets,
        adjacent=tuple((x, y) for x, y in pairs_of_lanes),
        line=_line_data(road.line),
        map=road.map,
        unread=road.unread,
    )


def _line_data(line: ReferenceLine | None) -> tuple[json_types.CurveData, ...]:
    if line is None:
        return ()
    from roadproof.evidence.line_file import line_data  # here: most roads are straight

    return line_data(line)


def _motion_data(motion: Motion, has_jerk: bool) -> Any:
    starts = {name: getattr(motion, name) for name in _NUMBERS}
    if has_jerk:
        jerk_pieces = tuple(
            json_types.JerkPieceData(duration=p.duration, a_lon=p.a_lon, a_lat=p.a_lat, j_lon=p.j_lon)
            for p in motion.pieces
        )
        return json_types.JerkMotionData(kind=motion.kind, **starts, pieces=jerk_pieces)
    pieces = tuple(
        json_types.PieceData(duration=p.duration, a_lon=p.a_lon, a_lat=p.a_lat) for p in motion.pieces
    )
    return json_types.MotionData(kind=motion.kind, **starts, pieces=pieces)


def _signal_data(name: str, vehicle: str, course: Course) -> json_types.SignalData:
    """Return the JSON form of a custom signal in SI units; 0 and 1 are false and true."""
    values = tuple(json_types.CourseValueData(start=start, value=value) for start, value in course)
    return json_types.SignalData(signal=name, vehicle=vehicle or None, values=values)


def load_drive(path: Path) -> DriveFile:
    """Return the drive file at a path. Raises ``InputError`` with file, field, value and rule."""
    return read_drive(read_json(path), str(path))


def read_drive(content: object, where: str) -> DriveFile:
    """Return the drive file in parsed JSON, the inverse of ``drive_data``. Raises ``InputError``."""
    schema = Fields(content, where).text("schema")
    if schema not in DRIVES:
        known = " or ".join(map(repr, DRIVES))
        raise InputError(f"{where}: schema={schema!r}, but a drive file has {known}")
    stored: json_types.AnyDriveData = read(
        json_types.JerkDriveData if schema == JERK_DRIVE else json_types.DriveData, content, where
    )
    if stored.horizon < 0:
        raise InputError(f"{where}: horizon={stored.horizon} is negative")
    parameters = stored.parameters
    numbers = {n: rational(x, f"{where}, parameters.{n}") for n, x in parameters.items() if is_rational(x)}
    return DriveFile(
        stored.scenario,
        stored.set,
        with_vehicles(stored.formula, stored.vehicles),
        stored.horizon,
        _lanes(stored, where),
        numbers,
        {name: x for name, x in parameters.items() if name not in numbers},
        road_of(stored.road, f"{where}, road"),
        _drive(stored, where),
        stored.overlaps_allowed,
    )


def _drive(stored: json_types.AnyDriveData, where: str) -> Drive:
    vehicles = {name: _motion(x, f"{where}, vehicle {name}") for name, x in stored.vehicles.items()}
    own: dict[tuple[str, str], Course] = {}
    for k, course in enumerate(stored.signals, 1):
        key = course.signal, course.vehicle or ""
        if key in own:
            raise InputError(f"{where}, signal {k}: {' of '.join(filter(None, key))} is given twice")
        own[key] = tuple((x.start, x.value) for x in course.values)
    try:
        return Drive(vehicles, own)
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None


def natural_of(content: object, where: str) -> bool | None:
    """Return whether a drive file calls its drive natural; None if it does not say. Raises ``InputError``."""
    data = Fields(content, where)
    verdict = Fields(data.mapping("verdict") if data.has("verdict") else {}, f"{where}, verdict")
    return verdict.flag("natural") if verdict.has("natural") else None


def _lanes(stored: json_types.AnyDriveData, where: str) -> dict[str, str]:
    """Return the lanes by free name: ``lane`` is the lane of L, ``lanes`` has all if there are others."""
    if stored.lanes is None:
        return {} if stored.lane is None else {LANE: stored.lane}
    if stored.lane != stored.lanes.get(LANE):
        raise InputError(f"{where}: lane={stored.lane}, but lanes.{LANE}={stored.lanes.get(LANE)}")
    return dict(stored.lanes)


def road_of(stored: json_types.RoadData, where: str) -> Road:
    """Return the road of its JSON form, the inverse of ``road_data``. Raises ``InputError``."""
    lanelets = tuple(_lanelet(x, f"{where}, lanelet {k}") for k, x in enumerate(stored.lanelets, 1))
    ids = [lanelet.id for lanelet in lanelets]
    duplicate = next((name for k, name in enumerate(ids) if name in ids[:k]), None)
    if duplicate is not None:
        raise InputError(f"{where}: two lanelets are called '{duplicate}'")
    lanes = {lanelet.lane for lanelet in lanelets}
    adjacent: list[tuple[str, str]] = []
    for one, other in stored.adjacent:
        if one == other:
            raise InputError(f"{where}: adjacent=['{one}', '{other}']: no lane is beside itself")
        for lane in (one, other):
            if lane not in lanes:
                raise InputError(f"{where}: adjacent=['{one}', '{other}']: there is no lane '{lane}'")
        if (one, other) in adjacent or (other, one) in adjacent:
            raise InputError(f"{where}: adjacent=['{one}', '{other}'] is given twice")
        adjacent.append((one, other))
    line = _line_of(stored.line, where)
    return Road(stored.name, lanelets, adjacency(adjacent), line, stored.map, stored.unread)


def _line_of(stored: Sequence[json_types.CurveData], where: str) -> ReferenceLine | None:
    if not stored:
        return None
    from roadproof.evidence.line_file import line_of  # here: most roads are straight

    return line_of(stored, where)


def _lanelet(stored: json_types.LaneletData, where: str) -> Lanelet:
    (begin, end), (right, left) = stored.s, stored.d
    if right >= left or (begin is not None and end is not None and begin >= end):
        raise InputError(f"{where}: an empty lanelet")
    return Lanelet(stored.id, stored.lane, stored.zone, stored.attribute, stored.s, stored.d)


def _motion(stored: json_types.MotionData, where: str) -> Motion:
    pieces = [
        Piece(
            x.duration, x.a_lon, x.a_lat, x.j_lon if isinstance(x, json_types.JerkPieceData) else Fraction(0)
        )
        for x in stored.pieces
    ]
    numbers = {str(name): getattr(stored, name) for name in _NUMBERS}
    try:
        return Motion(**numbers, pieces=tuple(pieces), kind=stored.kind)
    except ValueError as error:
        raise InputError(f"{where}: {error}") from None


def other_values(file: DriveFile, library: Library) -> list[str]:
    """Return the parameters of a drive file whose values differ from the declared ones, as text."""
    declared = default_values(library)
    values = values_with(library, file.values)
    return [f"{name}={value}" for name, value in sorted(values.items()) if declared.get(name) != value]
