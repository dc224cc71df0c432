"""The traces of a test that is samples, with the names of its vehicles, and the digest of its files."""

import hashlib
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.catalogue.entries import ConcreteTest
from roadproof.extensions.catalogue.role_choices import vehicle_choices
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
from roadproof.library.roles import Roles, check_roles, roles_of
from roadproof.library.scenarios import PAIR, SUBJECT, TRIPLE

MOST_VEHICLES = 8
"""The most vehicles of a scenario of CommonRoad of which all choices are looked at."""


def is_samples(entry: ConcreteTest) -> bool:
    """Return whether a test is a file of samples of a few vehicles, which have names."""
    return not is_pair(entry.place) and Path(entry.place).suffix in (".csv", ".parquet", ".xosc")


def roles_in(entry: ConcreteTest, vehicles: Sequence[str], known: Collection[str]) -> Roles:
    """Return the roles of the vehicles of a test. Raises ``InputError`` for unknown names and roles."""
    return roles_of(vehicles, known, entry.roles, f"{entry.place}: roles")


def traces_of(entry: ConcreteTest, known: Collection[str]) -> Iterator[tuple[OneTrace, Mapping[str, str]]]:
    """Yield the traces of a test, each with the name in its file of each vehicle of the trace.

    ``known``: the roles of scenarios. Raises ``InputError`` for a test that cannot be read, and for a motion
    that no vehicle drives.
    """
    for trace, names_in_file in _traces_of(entry, known):
        if trace.faults:
            raise InputError(f"{entry.place}: no vehicle drives so: {'; '.join(trace.faults)}")
        yield trace, names_in_file


def _traces_of(entry: ConcreteTest, known: Collection[str]) -> Iterator[tuple[OneTrace, Mapping[str, str]]]:
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
        yield replace(played, notes=(*played.notes, *((roles.note,) * bool(roles.note)))), roles.name_by_role
    else:
        yield from _all_of(find_source(path, entry.strict).read(), entry, known)


def _all_of(
    recording: Recording, entry: ConcreteTest, known: Collection[str]
) -> Iterator[tuple[OneTrace, Mapping[str, str]]]:
    """Yield all pairs and triples of vehicles of one direction that are seen together, in all orders.

    SV is the vehicle of a planning problem, unless the test names it (``_with_subject``). Where the test
    names vehicles for all roles of a pair or triple, these alone. Other vehicles that it names play their
    role.
    """
    ids = [str(x) for x in recording.vehicle_id]
    roles = entry.roles
    if SUBJECT not in roles and entry.place.endswith(".xml"):
        roles = _with_subject(roles, ids, subject_of_problem(Path(entry.place)))
    check_roles(ids, known, roles, f"{entry.place}: roles")
    complete = [x for x in (PAIR, TRIPLE) if set(x) <= set(roles)]
    if recording.vehicles > MOST_VEHICLES and not complete:
        raise InputError(
            f"{entry.place}: {recording.vehicles} vehicles, but of at most {MOST_VEHICLES} all choices are "
            f"looked at; name some in a catalogue.toml, as file = '{Path(entry.place).name}:12,15'"
        )
    for names in complete or (PAIR, TRIPLE):
        for chosen in vehicle_choices(ids, roles, names):
            low = max(int(recording.first_frame[v]) for v in chosen)
            high = min(int(recording.last_frame[v]) for v in chosen)
            if high > low and len({int(recording.direction[v]) for v in chosen}) == 1:
                vehicles = dict(zip(names, chosen, strict=True))
                trace = cut_trace(recording, entry.place, vehicles, (low, high))
                yield trace, {n: ids[v] for n, v in vehicles.items()}


def _with_subject(roles: Mapping[str, str], ids: Sequence[str], subject: str) -> Mapping[str, str]:
    """Return the roles with the subject of a planning problem as SV, where it is a vehicle without a role.

    Where a test names no roles and has as many vehicles as a pair or triple, the others play the other roles
    in their order.
    """
    if subject not in ids or subject in roles.values():
        return roles
    others = [x for x in ids if x != subject]
    cast = next((x for x in (PAIR, TRIPLE) if len(x) == len(ids)), None)
    if roles or cast is None:
        return {**roles, SUBJECT: subject}
    return dict(zip(cast, (subject, *others), strict=True))


# --- the files of a test --------------------------------------------------------------------------


def digest_of(place: str) -> str:
    """Return the SHA-256 of the file of a concrete test in hexadecimal digits; empty where it is unreadable.

    For several files, such as those of a recording or samples with their road, it is the digest of the joined
    digests.
    """
    digests = [file_digest(path) for path in files_of(place)]
    if not digests or not all(digests):
        return ""
    return digests[0] if len(digests) == 1 else hashlib.sha256("".join(digests).encode()).hexdigest()


def files_of(place: str) -> tuple[Path, ...]:
    """Return every file from which a concrete test is read; none where there is no recording of that name.

    A file beside it that describes its road is one of them.
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
