"""The traces of a test that is samples, with what the test calls the vehicles."""

import hashlib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path

from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile, load_drive
from roadproof.extensions.catalogue.entries import Concrete
from roadproof.extensions.catalogue.playing import chosen_vehicles, play_drive
from roadproof.extensions.exchange.commonroad import subject_of_problem
from roadproof.extensions.exchange.storyboard.distributions import split
from roadproof.extensions.traffic.evaluate.one_trace import (
    OneTrace,
    cut_trace,
    is_pair,
    play_samples,
    read_pair,
    read_samples,
)
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.samples import ROAD_ENDING
from roadproof.extensions.traffic.formats.source import beside, file_digest
from roadproof.extensions.traffic.formats.sources import find_source
from roadproof.library.roles import Roles, check_roles, roles_of, vehicle_order
from roadproof.library.scenarios import PAIR, SUBJECT, TRIPLE
from roadproof.world.motion import state_at
from roadproof.world.road import Road

MOST_VEHICLES = 8
"""In a scenario of CommonRoad of which no vehicles are named."""


def is_samples(entry: Concrete) -> bool:
    """Whether a test is a file of samples of a few vehicles, which are called by names."""
    return not is_pair(entry.place) and Path(entry.place).suffix in (".csv", ".parquet", ".xosc")


def roles_in(entry: Concrete, vehicles: Sequence[str], known: Collection[str]) -> Roles:
    """The roles of the vehicles of a test. Raises ``InputError`` for unknown names and roles."""
    return roles_of(vehicles, known, entry.roles, f"{entry.place}: roles")


def traces_of(entry: Concrete, known: Collection[str]) -> Iterator[tuple[OneTrace, Mapping[str, str]]]:
    """The traces of a test, each with what the test calls the vehicles; ``known``: the roles of scenarios.

    Raises ``InputError`` for a test that cannot be read, and for a motion that no vehicle drives.
    """
    for trace, told in _traces_of(entry, known):
        if trace.faults:
            raise InputError(f"{entry.place}: no vehicle drives so: {'; '.join(trace.faults)}")
        yield trace, told


def _traces_of(entry: Concrete, known: Collection[str]) -> Iterator[tuple[OneTrace, Mapping[str, str]]]:
    path = Path(entry.place)
    if is_pair(entry.place):
        if entry.roles:
            raise InputError(
                f"{entry.place}: roles: the order of the vehicles says their roles; leave roles out"
            )
        ids = entry.place.rpartition(":")[2].split(",")
        trace = read_pair(entry.place, strict=entry.strict)
        yield trace, dict(zip(trace.lanes, ids, strict=True))
    elif is_samples(entry):
        trace = read_samples(path, strict=entry.strict)
        roles = roles_in(entry, tuple(trace.lanes), known)
        played = play_samples(trace, roles)
        yield replace(played, notes=(*played.notes, *((roles.note,) * bool(roles.note)))), roles.own_names
    else:
        yield from _all_of(find_source(path, entry.strict).read(), entry, known)


def _all_of(
    recording: Recording, entry: Concrete, known: Collection[str]
) -> Iterator[tuple[OneTrace, Mapping[str, str]]]:
    """All pairs and triples of vehicles of one direction that are seen together, in all orders.

    SV is the vehicle that begins as a planning problem says, unless the test names it (``_with_subject``).
    Where the test says who plays all roles of a pair or triple, that alone; of further vehicles those that
    it names play their role.
    """
    ids = [str(x) for x in recording.vehicle_id]
    given = entry.roles
    if SUBJECT not in given and entry.place.endswith(".xml"):
        given = _with_subject(given, ids, subject_of_problem(Path(entry.place)))
    check_roles(ids, known, given, f"{entry.place}: roles")
    complete = [x for x in (PAIR, TRIPLE) if set(x) <= set(given)]
    if recording.vehicles > MOST_VEHICLES and not complete:
        raise InputError(
            f"{entry.place}: {recording.vehicles} vehicles, but of at most {MOST_VEHICLES} all choices are "
            f"looked at; name some in a catalogue.toml, as file = '{Path(entry.place).name}:12,15'"
        )
    for names in complete or (PAIR, TRIPLE):
        for chosen in chosen_vehicles(ids, given, names):
            low = max(int(recording.first_frame[v]) for v in chosen)
            high = min(int(recording.last_frame[v]) for v in chosen)
            if high > low and len({int(recording.direction[v]) for v in chosen}) == 1:
                vehicles = dict(zip(names, chosen, strict=True))
                trace = cut_trace(recording, entry.place, vehicles, (low, high))
                yield trace, {n: ids[v] for n, v in vehicles.items()}


def _with_subject(given: Mapping[str, str], ids: Sequence[str], subject: str) -> Mapping[str, str]:
    """The roles with the subject of a planning problem as SV, where it is a vehicle without a role.

    Where a test names no roles, and the vehicles are as many as a pair or triple has, the others play the
    other roles in their order, as vehicles do that are called so.
    """
    if subject not in ids or subject in given.values():
        return given
    others = [x for x in ids if x != subject]
    cast = next((x for x in (PAIR, TRIPLE) if len(x) == len(ids)), None)
    if given or cast is None:
        return {**given, SUBJECT: subject}
    return dict(zip(cast, (subject, *others), strict=True))


# --- how the vehicles of a test move, sampled to be drawn ------------------------------------------

GRAIN = Fraction(1, 10)
"""Seconds between the points of a curve of a drive."""


@dataclass(frozen=True)
class Course:
    """Of one vehicle: where its front is along (m), and where its right and left edges are across (m)."""

    along: Sequence[float]
    right: Sequence[float]
    left: Sequence[float]


@dataclass(frozen=True)
class Courses:
    """All vehicles of a test, SV or the first one first, at the same ``times`` (s).

    ``markings``: where lanes of its road end across (m).
    """

    times: Sequence[float]
    vehicles: Mapping[str, Course]
    markings: tuple[float, ...]


def courses_of(entry: Concrete) -> Courses | None:
    """How the vehicles of a test move; None where it cannot be read."""
    if entry.fault:
        return None
    known = {*PAIR, *TRIPLE, *entry.roles}
    try:
        if entry.place.endswith(".json") and not is_pair(entry.place):
            file = load_drive(Path(entry.place))
            return of_drive(play_drive(file, roles_in(entry, tuple(file.drive.vehicles), known)))
        return next((_of_trace(trace) for trace, _ in traces_of(entry, known)), None)
    except InputError:
        return None


def of_drive(file: DriveFile) -> Courses:
    """How the vehicles of a drive move up to its horizon."""
    times = [k * GRAIN for k in range(int(file.horizon / GRAIN) + 1)]
    found = {}
    for name, motion in file.drive.vehicles.items():
        states = [state_at(motion, time) for time in times]
        left = [float(x.d) for x in states]
        right = [x - float(motion.width) for x in left]
        found[name] = Course([float(x.s) for x in states], right, left)
    return Courses([*map(float, times)], _in_order(found), _markings(file.road))


def _of_trace(trace: OneTrace) -> Courses:
    batch, count = trace.batch, int(trace.batch.lengths[0])
    found = {}
    for name in trace.lanes:
        left = batch.signals["d", name][:count, 0]
        right = left - batch.sizes["width", name][0]
        found[name] = Course(batch.signals["s", name][:count, 0].tolist(), right.tolist(), left.tolist())
    times = [float(k * batch.dt) for k in range(count)]
    return Courses(times, _in_order(found), _markings(trace.road))


def _in_order(found: Mapping[str, Course]) -> dict[str, Course]:
    return {name: found[name] for name in vehicle_order(found)}


def _markings(road: Road) -> tuple[float, ...]:
    return tuple(sorted({float(end) for lanelet in road.lanelets for end in lanelet.d}))


# --- whether the files of a test have changed ------------------------------------------------------


def digest_of(place: str) -> str:
    """SHA-256 of the file of a concrete test, in hexadecimal digits; empty where a file cannot be read.

    Of several files, such as those of a recording or samples with their road, it is that of the digests of
    all, one after the other.
    """
    digests = [file_digest(path) for path in files_of(place)]
    if not digests or not all(digests):
        return ""
    return digests[0] if len(digests) == 1 else hashlib.sha256("".join(digests).encode()).hexdigest()


def files_of(place: str) -> tuple[Path, ...]:
    """Every file that a concrete test is read from; none where there is no recording of that name.

    A file beside it that says more of its road is one of them where it is there.
    """
    path = Path(place.rpartition(":")[0]) if is_pair(place) else Path(place)
    if path.suffix == ".json" and not is_pair(place):
        return (path,)
    if path.suffix in (".csv", ".parquet") and not is_pair(place):
        return (path, *beside(path, ROAD_ENDING))
    try:
        files = find_source(path).files
    except InputError:
        return (path,) if path.is_file() else ()
    return files[:-1] if split(path) is not None else files
