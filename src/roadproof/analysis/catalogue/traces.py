"""The traces of a test that is samples, with what the test calls the vehicles."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from roadproof.analysis.catalogue.entries import Concrete
from roadproof.analysis.catalogue.playing import checked, chosen_vehicles, play_samples, roles_of
from roadproof.errors import InputError
from roadproof.library.scenarios import PAIR, TRIPLE
from roadproof.recordings.evaluate.one_trace import OneTrace, cut_trace, is_pair, read_pair, read_samples
from roadproof.recordings.formats.recording import Recording
from roadproof.recordings.formats.sources import find_source

MOST_VEHICLES = 8
"""In a scenario of CommonRoad of which no vehicles are named."""


def is_samples(entry: Concrete) -> bool:
    """Whether a test is a file of samples of a few vehicles, which are called by names."""
    return not is_pair(entry.place) and Path(entry.place).suffix in (".csv", ".parquet", ".xosc")


def first_trace(entry: Concrete) -> OneTrace | None:
    """The first trace of a test that is samples. Raises ``InputError``."""
    return next((trace for trace, _ in traces_of(entry, {*PAIR, *TRIPLE, *entry.roles})), None)


def traces_of(entry: Concrete, known: Collection[str]) -> Iterator[tuple[OneTrace, Mapping[str, str]]]:
    """The traces of a test, each with what the test calls the vehicles; ``known``: the roles of scenarios."""
    path = Path(entry.place)
    if is_pair(entry.place):
        if entry.roles:
            raise InputError(
                f"{entry.place}: roles: the order of the vehicles says their roles; leave roles out"
            )
        ids = entry.place.rpartition(":")[2].split(",")
        trace = read_pair(entry.place)
        yield trace, dict(zip(trace.lanes, ids, strict=True))
    elif is_samples(entry):
        trace = read_samples(path)
        roles = roles_of(entry, tuple(trace.lanes), known)
        played = play_samples(trace, roles)
        yield replace(played, notes=(*played.notes, *((roles.note,) * bool(roles.note)))), roles.own_names
    else:
        yield from _all_of(find_source(path).read(), entry, known)


def _all_of(
    recording: Recording, entry: Concrete, known: Collection[str]
) -> Iterator[tuple[OneTrace, Mapping[str, str]]]:
    """All pairs and triples of vehicles of one direction that are seen together, in all orders.

    Where the test says who plays all roles of a pair or triple, that alone; of further vehicles those that
    it names play their role.
    """
    ids = [str(x) for x in recording.vehicle_id]
    given = dict(checked(entry, ids, known))
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
