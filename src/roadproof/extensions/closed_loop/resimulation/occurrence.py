"""An occurrence of scenarios as a situation: SV begins in it, and all others move as they did."""

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import chain, count

import numpy as np

from roadproof.extensions.closed_loop.resimulation.data import RecordedOccurrence
from roadproof.extensions.closed_loop.simulation import VehicleSamples, follow
from roadproof.extensions.closed_loop.situation import Limits, StepClock, TrafficSituation, VehicleCourse
from roadproof.library.scenarios import LANE, SUBJECT
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass
from roadproof.world.road import Road

ANY = Limits(*map(Fraction, (-1000, 1000, 1000, 1000, 1000, 1000)))
"""The limits of all vehicles but SV: they move as they did, whatever their models allow."""


@dataclass(frozen=True)
class RecordedSituation:
    """An occurrence, and the situation that it becomes."""

    occurrence: RecordedOccurrence
    situation: TrafficSituation


@dataclass(frozen=True)
class OccurrenceLimits:
    """The clock's step (s), the greatest duration (s), and the limits of the vehicle under test."""

    dt: Fraction
    seconds: Fraction
    subject: Limits


@dataclass(frozen=True)
class OccurrencePlace:
    """The place of an occurrence: recording or drive, scenarios, vehicles by role, lane and frame.

    ``left_out``: vehicles nearby that are left out.
    """

    recording: str
    scenarios: tuple[int, ...]
    vehicles: Mapping[str, str]
    lane: str = ""
    first_frame: int = 0
    left_out: int = 0

    @property
    def id(self) -> str:
        """The name of the occurrence, of letters, digits and underscores."""
        is_drive = {*self.vehicles.values()} == {*self.vehicles}
        rest = () if is_drive else (*self.vehicles.values(), f"from{self.first_frame}")
        parts = (self.recording, *rest)
        return "_".join(re.sub(r"[^A-Za-z0-9]+", "_", x) for x in parts)


def with_own_ids(every: Iterable[RecordedSituation]) -> Iterator[RecordedSituation]:
    """Yield occurrences with a number behind an id that another one has, such as ``a_b_2``."""
    taken: set[str] = set()
    for x in every:
        first = x.occurrence.id
        names = chain((first,), (f"{first}_{k}" for k in count(2)))
        name = next(y for y in names if y not in taken)
        taken.add(name)
        yield replace(x, occurrence=replace(x.occurrence, id=name))


def recorded_situation(
    place: OccurrencePlace,
    courses: Mapping[str, VehicleCourse],
    samples: Mapping[str, VehicleSamples],
    road: Road,
    clock: StepClock,
    subject: Limits,
) -> RecordedSituation:
    """Return an occurrence with its situation.

    ``courses``: by vehicle, SV first; ``samples``: how they moved, at the steps of the clock.
    """
    limits = {name: subject if name == SUBJECT else ANY for name in courses}
    lanes = {LANE: place.lane} if place.lane else {}
    situation = TrafficSituation(courses, road, lanes, clock, limits)
    others = [x for x in courses if x != SUBJECT]
    tracks = {name: _column(follow([courses[name]], situation, name)) for name in others}
    sizes = {name: (float(x.length), float(x.width)) for name, x in courses.items()}
    occurrence = RecordedOccurrence(
        id=place.id,
        recording=place.recording,
        scenarios=place.scenarios,
        vehicles=place.vehicles,
        lane=place.lane,
        first_frame=place.first_frame,
        seconds=clock.horizon,
        others=len(courses) - len(place.vehicles),
        left_out=place.left_out,
        deviation=round(max(_apart(tracks[name], samples[name]) for name in others), 3),
        gap=least_gap({name: samples[name] for name in place.vehicles}, sizes),
        sha256=digest(courses, road, lanes, clock, limits),
    )
    return RecordedSituation(occurrence, situation)


def least_gap(tracks: Mapping[str, VehicleSamples], sizes: Mapping[str, tuple[float, float]]) -> float | None:
    """Return the least gap between SV and another vehicle while their boxes overlap across the road (m).

    ``tracks``: samples at the same instants; ``sizes``: length and width. 0 where boxes touch, None where no
    vehicle is in the way of another.
    """
    me, gaps = tracks[SUBJECT], list[float]()
    length, width = sizes[SUBJECT]
    for name, x in tracks.items():
        if name == SUBJECT:
            continue
        long, wide = sizes[name]
        meets = (x.d - wide < me.d) & (me.d - width < x.d)
        gap = np.maximum(np.maximum(x.s - long - me.s, me.s - length - x.s), 0.0)[meets]
        gaps += [float(gap.min())] if len(gap) else []
    return round(min(gaps), 3) if gaps else None


def _apart(one: VehicleSamples, other: VehicleSamples) -> float:
    """Return the greatest distance between two motions, along or across the road (m)."""
    return float(max(np.abs(one.s - other.s).max(), np.abs(one.d - other.d).max()))


def _column(track: VehicleSamples) -> VehicleSamples:
    return VehicleSamples(
        track.s[:, 0], track.d[:, 0], track.v_lon[:, 0], track.v_lat[:, 0], track.a_lon[:, 0]
    )
