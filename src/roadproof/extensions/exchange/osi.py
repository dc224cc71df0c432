"""Ground truth in traces of ASAM OSI 3 (Open Simulation Interface), on a selected road.

A trace NAME.osi is a sequence of messages, each after its length in four bytes, the least first: of
GroundTruth, or of SensorView where the name contains ``_sv_``. Of a moving object, ``base.position`` is the
middle of its box, ``orientation.yaw`` is in rad counter-clockwise from x, and velocity and acceleration are
those in the plane. Vehicles are read, others are left out and counted. Missing accelerations are changes of
velocities. Messages are equally far apart. Numbers of fields are those of osi_groundtruth.proto,
osi_object.proto and osi_common.proto.
"""

import struct
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.exchange.protobuf import WireError, doubles_in, fields_of, integer_in, message_in
from roadproof.extensions.maps.network import ZONES_ENDING
from roadproof.extensions.traffic.formats.clock import Rate, clock_of
from roadproof.extensions.traffic.formats.contradictions import contradiction_notes
from roadproof.extensions.traffic.formats.measured_roads import MeasuredTraffic
from roadproof.extensions.traffic.formats.off_line import follows_line, leave_out_strays
from roadproof.extensions.traffic.formats.plausible import (
    LARGEST_ACCELERATION,
    LARGEST_SIZE,
    LARGEST_SPEED,
    ContradictionChecks,
)
from roadproof.extensions.traffic.formats.recording import Floats, Integers, Recording
from roadproof.extensions.traffic.formats.reliable import (
    first_names,
    left_out_note,
    rate_of_change,
    reliable_part,
)
from roadproof.extensions.traffic.formats.selected_roads import chart_of, place_on_road
from roadproof.extensions.traffic.formats.source import Files, Format, beside, with_suffix
from roadproof.extensions.traffic.formats.table import CellError
from roadproof.extensions.traffic.formats.tracks import Rule, without_bad
from roadproof.reasons import ReasonKind
from roadproof.runtime.file_kind import other_format
from roadproof.world.not_read import not_read_note

ENDING = ".osi"
SENSOR_VIEW = "_sv_"
"""In the name of a trace of SensorView, as OSI recommends."""
_LENGTH = struct.Struct("<I")
_LARGEST_ID = 10**9
_NANO = 1_000_000_000
_GROUND_TRUTH = 7
"""Of SensorView."""
_TIMESTAMP, _HOST, _MOVING_OBJECT = 2, 3, 5
"""Of GroundTruth."""
_VEHICLE = 2
"""A type of moving object."""
_HARMLESS: Mapping[str, Mapping[int, str]] = {
    "GroundTruth": {
        1: "the version of OSI",
        4: "objects that do not move, which are no traffic",
        **dict.fromkeys((6, 7, 8), "signs, lights and markings, which no formula sees"),
        **dict.fromkeys((9, 10, 17, 18, 19), "lanes by another map; the road is that which was selected"),
        11: "people in vehicles",
        12: "weather and light",
        **dict.fromkeys((13, 14), "where the road is on the earth; places are those of the file"),
        **dict.fromkeys((15, 16), "names of other files; the road is that which was selected"),
    },
    "MovingObject": {
        4: "lanes by another map; the road is that which was selected",
        5: "axles and wheels; places are those of the middle of the box",
        7: "looks",
        8: "a motion that is planned; that of the next messages is read",
        9: "lanes by another map; the road is that which was selected",
        10: "the name in another file",
        11: "poses of people, who are left out",
    },
    "BaseMoving": {
        **dict.fromkeys((6, 8), "how fast the vehicle turns; its heading is read"),
        7: "the outline within the box, which is read",
    },
}
"""By message the fields that are not read, since they change no motion, with the reason of each."""
_READ: Mapping[str, tuple[int, ...]] = {
    "GroundTruth": (_TIMESTAMP, _HOST, _MOVING_OBJECT),
    "MovingObject": (1, 2, 3, 6),
    "BaseMoving": (1, 2, 3, 4, 5),
}
_FIELDS = {("GroundTruth", 20): "proj_frame_offset"}
"""Names of fields that are left out."""
NO_VEHICLES: Mapping[int, str] = {3: "pedestrians", 4: "animals"}
"""Types of moving objects."""
KINDS: Mapping[int, str] = {
    **dict.fromkeys((2, 3, 4, 5), "Car"),
    6: "Van",
    **dict.fromkeys((7, 16), "Truck"),
    **dict.fromkeys((8, 9), "Trailer"),
    10: "Motorcycle",
    12: "Bus",
}
"""Types of vehicles; all others are called Other."""
NO_TRAFFIC: Mapping[int, str] = {
    11: "cyclists",
    **dict.fromkeys((13, 14), "trains"),
    **dict.fromkeys((15, 17, 18), "users of wheelchairs and scooters"),
}
"""Types of vehicles that are none in traffic."""
COLUMNS = (
    *("length", "width", "position.x", "position.y", "orientation.yaw"),
    *("velocity.x", "velocity.y", "acceleration.x", "acceleration.y"),
)
"""What is read of the base of a moving object."""
_PARTS = ((1, 2), (2, 2), (3, 3), (4, 2), (5, 2))
"""Fields of the base, and how many doubles are read of each; of the orientation the last one."""
_MOST = dict(zip(COLUMNS, (LARGEST_SIZE,) * 2 + (1e6,) * 2 + (100.0,), strict=False))
_MOST |= dict.fromkeys(COLUMNS[5:7], LARGEST_SPEED) | dict.fromkeys(COLUMNS[7:], LARGEST_ACCELERATION)


class _Samples:
    """Moving objects of all messages: number of the message, id and base of each, and what they are."""

    def __init__(self) -> None:
        self.message: list[int] = []
        self.id: list[int] = []
        self.base: list[tuple[float, ...]] = []
        self.kind: dict[int, str] = {}
        self.absent: dict[str, dict[int, None]] = {}
        self.host: int | None = None
        self.unread: dict[str, None] = {}

    def note_unread_fields(self, message: str, content: bytes) -> None:
        """Note the fields of a message of this kind that are not read and may have an effect."""
        known = {*_READ[message], *_HARMLESS[message]}
        for field in {number for number, _ in fields_of(content)} - known:
            self.unread[f"{message}.{_FIELDS.get((message, field), f'field {field}')}"] = None

    def add(self, number: int, content: bytes) -> None:
        """Add a moving object of the message of this number. Raises ``WireError``."""
        name = integer_in(message_in(content, 1) or b"", 1)
        object_type = integer_in(content, 3)
        kind = integer_in(message_in(content, 6) or b"", 1)
        no_traffic = (
            NO_TRAFFIC.get(kind, "")
            if object_type == _VEHICLE
            else NO_VEHICLES.get(object_type, "other objects")
        )
        if no_traffic:
            self.absent.setdefault(no_traffic, {})[name] = None
            return
        base = message_in(content, 2) or b""
        self.note_unread_fields("MovingObject", content)
        self.note_unread_fields("BaseMoving", base)
        self.message.append(number)
        self.id.append(name)
        self.base.append(_base_of(base))
        self.kind.setdefault(name, KINDS.get(kind, "Other"))

    def notes(self) -> Iterator[str]:
        """Return which vehicle is the host, and what is left out."""
        if self.host is not None:
            yield f"host_vehicle_id is {self.host}"
        of = len({*self.kind}.union(*self.absent.values()))
        for what, names in self.absent.items():
            yield left_out_note([*names], of, ReasonKind.OF_KIND(what))


def _base_of(content: bytes) -> tuple[float, ...]:
    """The values of COLUMNS; NaN for parts that are missing."""
    values: list[float] = []
    for number, count in _PARTS:
        part = message_in(content, number)
        read = (np.nan,) * count if part is None else doubles_in(part, count)
        values += read[-1:] if number == 3 else read
    return tuple(values)


def read_osi(path: Path, strict: bool = True, road: str | None = None) -> Recording:
    """The vehicles of a trace on a road of a map; unless ``strict``, bad ones are left out.

    Raises ``InputError`` that names message, object, value and rule; ``UsageError`` for a road that is not
    well said.
    """
    chart_of(road, path)
    samples, rate = _read(path)
    ids, frame, base = np.array(samples.id), np.array(samples.message), np.array(samples.base)
    order = np.lexsort((frame, ids))
    ids, frame, base = ids[order], frame[order], base[order]

    def cell(row: int, column: str) -> str:
        value = base[row, COLUMNS.index(column)] if column in COLUMNS else frame[row] + 1
        return f"message {frame[row] + 1}, moving_object {ids[row]}, {column}={value}"

    def cell_error(row: int, column: str, rule: str) -> CellError:
        return CellError(path, f"{cell(row, column)}: {rule}", row)

    base, derived = _with_accelerations(ids, base, rate)
    retained, left_out = without_bad(ids, _rules(ids, frame, base), cell_error, strict)
    ids, frame, base = ids[retained], frame[retained], base[retained]
    omissions = not_read_note(path, samples.unread, strict)
    notes = (*samples.notes(), *left_out, *omissions, *derived)
    traffic = _traffic(str(path), rate, ids, frame, base, samples.kind, notes)
    recording, rows = place_on_road(traffic, str(road), strict=strict)
    fits = follows_line(traffic.centre[rows], recording)
    fitting = leave_out_strays(replace(recording, name=path.stem), fits, strict)
    rows = rows[np.repeat(fits, np.diff(recording.start))]
    return reliable_part(fitting, strict, partial(_contradiction_notes, path, ids[rows], frame[rows]))


def _read(path: Path) -> tuple[_Samples, Rate]:
    """The vehicles of all messages, and how many messages there are a second. Raises ``InputError``."""
    samples, times = _Samples(), list[int]()
    for number, message in enumerate(_messages(path)):
        try:
            if SENSOR_VIEW in path.name:
                message = message_in(message, _GROUND_TRUTH) or b""
            samples.note_unread_fields("GroundTruth", message)
            time = message_in(message, _TIMESTAMP) or b""
            times.append(integer_in(time, 1) * _NANO + integer_in(time, 2))
            host = message_in(message, _HOST)
            if samples.host is None and host is not None:
                samples.host = integer_in(host, 1)
            for field, value in fields_of(message):
                if field == _MOVING_OBJECT and isinstance(value, bytes):
                    samples.add(number, value)
        except WireError as error:
            raise InputError(f"{path}, message {number + 1}: no message of OSI ({error})") from None
    if not samples.id:
        advice = f"traces of SensorView have {SENSOR_VIEW} in their names"
        raise InputError(f"{path}: no moving_object is a vehicle in traffic; {advice}")
    if not 0 <= min(samples.id) <= max(samples.id) < _LARGEST_ID:
        raise InputError(f"{path}: ids of moving objects must lie between 0 and {_LARGEST_ID - 1}")
    return samples, _rate_of(path, times)


def _messages(path: Path) -> Iterator[bytes]:
    try:
        with path.open("rb") as file:
            other = other_format(file.read(1000))
            if other is not None:
                raise InputError(f"{path}: the file {other}")
            file.seek(0)
            number = 0
            while head := file.read(_LENGTH.size):
                number += 1
                size = _LENGTH.unpack(head)[0] if len(head) == _LENGTH.size else -1
                message = file.read(max(size, 0))
                if len(message) != size:
                    raise InputError(f"{path}, message {number}: the file was cut off; get it again")
                yield message
    except OSError as error:
        raise InputError(f"{path}: the file cannot be read ({error.strerror}); check the path") from None


def _rate_of(path: Path, times: list[int]) -> Rate:
    """Return how many messages a second there are, all of them equally far apart. Raises ``InputError``."""
    if len(times) < 2 or times[1] <= times[0]:
        raise InputError(f"{path}: at least two messages are needed, each later than the one before")
    ahead = (np.array(times) - times[0]) / _NANO
    steps, counts = np.unique(np.diff(ahead), return_counts=True)
    later = steps > 0
    clock = clock_of(path, np.unique(ahead), steps[later], counts[later])
    for number, frame in enumerate(clock.frames(ahead)):
        if frame != number or clock.misses(ahead)[number] > 0.1 * clock.step:
            problem = (
                f"timestamp={times[number] / _NANO:g} s: messages are 1/{clock.rate} s apart, without gaps"
            )
            raise InputError(f"{path}, message {number + 1}, {problem}")
    return clock.rate


def _starts(ids: Integers) -> list[int]:
    return [*np.flatnonzero(np.diff(ids, prepend=-1)).tolist(), len(ids)]


def _with_accelerations(ids: Integers, base: Floats, rate: Rate) -> tuple[Floats, list[str]]:
    """The base of each sample, where missing accelerations are changes of velocities, and a note on these."""
    base, derived = base.copy(), []
    for begin, end in pairwise(_starts(ids)):
        if np.isnan(base[begin:end, 7]).all():
            derived.append(int(ids[begin]))
            for k in (0, 1):
                base[begin:end, 7 + k] = rate_of_change(base[begin:end, 5 + k], rate)
    note = f"velocities imply acceleration of {len(derived)} vehicles ({first_names(derived)})"
    return base, [note] * bool(derived)


def _rules(ids: Integers, frame: Integers, base: Floats) -> Iterator[Rule]:
    """Yield a rule for each column: which samples keep it, and its text."""
    same = np.diff(ids, prepend=-1) == 0
    step = np.diff(frame, prepend=0)
    yield ~same | (step == 1), "message", "a vehicle is once in each message, from its first to its last"
    for k, name in enumerate(COLUMNS):
        yield np.isfinite(base[:, k]), name, "a finite number is needed"
        most = _MOST[name]
        yield ~(np.abs(base[:, k]) > most), name, f"must lie between {-most:g} and {most:g}"
    for k in (0, 1):
        yield base[:, k] > 0, COLUMNS[k], "the size of a vehicle is greater than zero"
        stays = ~same | (np.diff(base[:, k], prepend=0) == 0)
        yield stays, COLUMNS[k], "the size of a vehicle stays the same"


def _traffic(
    name: str,
    rate: Rate,
    ids: Integers,
    frame: Integers,
    base: Floats,
    kind: Mapping[int, str],
    notes: tuple[str, ...],
) -> MeasuredTraffic:
    start = np.array(_starts(ids))
    first = start[:-1]
    return MeasuredTraffic(
        name=name,
        rate=rate,
        vehicle_id=ids[first],
        kind=np.array([kind[x] for x in ids[first].tolist()]),
        length=base[first, 0],
        width=base[first, 1],
        first_frame=frame[first],
        start=start,
        centre=base[:, 2:4],
        heading=base[:, 4],
        velocity=base[:, 5:7],
        acceleration=base[:, 7:9],
        notes=notes,
    )


def _contradiction_notes(
    path: Path, ids: Integers, frame: Integers, checks: ContradictionChecks, rows: Integers
) -> Iterator[str]:
    """Notes on what the trace contradicts itself in. Raises ``InputError`` where that is too much."""

    def at(row: int, signal: str) -> str:
        return f"message {frame[rows[row]] + 1}, moving_object {ids[rows[row]]}, {signal} on the road"

    return contradiction_notes(path, checks, at, lambda row: at(row, "place"), "lanelet of the road")


def _find(path: Path, road: str | None = None) -> dict[str, Files]:
    chart = None if road is None else Path(road.partition("#")[0])
    charts = () if chart is None else (*beside(chart, ZONES_ENDING), chart)
    return {x.stem: (*(y for y in charts if y.is_file()), x) for x in with_suffix(path, ENDING)}


def _on_map_road(road: str) -> Format:
    """The format, whose recordings are read on a road of a map."""
    return replace(FORMAT, find=partial(_find, road=road), read=partial(read_osi, road=road))


FORMAT = Format(
    "OSI",
    "NAME.osi, traces of GroundTruth or SensorView, with a road of a map",
    _find,
    read_osi,
    "{0}, timestamps {step} s apart",
    on_road=_on_map_road,
)
