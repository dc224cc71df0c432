"""Occurrences of scenarios in recordings as situations: SV begins as recorded, all others move so."""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cache
from math import ceil
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from roadproof.extensions.closed_loop.protocol import OBSERVED
from roadproof.extensions.closed_loop.resimulation.occurrence import (
    OccurrenceLimits,
    OccurrencePlace,
    RecordedSituation,
    recorded_situation,
)
from roadproof.extensions.closed_loop.simulation import VehicleSamples
from roadproof.extensions.closed_loop.situation import (
    Phase,
    StepClock,
    VehicleCourse,
)
from roadproof.extensions.traffic.evaluate.evaluate import Findings
from roadproof.extensions.traffic.evaluate.foretelling import last_common
from roadproof.extensions.traffic.evaluate.one_trace import road_of
from roadproof.extensions.traffic.evaluate.traces import gather_one
from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.library.scenarios import SUBJECT, roles
from roadproof.world.road import Road
from roadproof.world.signals import KINDS, RECORDED

Floats: TypeAlias = npt.NDArray[np.float64]
_NEAR = 100.0  # m along the road, between fronts, within which the controller sees other vehicles
_MOST = 20  # vehicles of a drive file
_BACK = 1.0  # s in which a course comes back to the recorded place
_FINE = 1000
_Key: TypeAlias = tuple[int, tuple[int, ...]]
"""The first frame of a match, and its vehicles in the order of roles."""


def situations_in(
    recording: Recording, findings: Findings, limits: OccurrenceLimits
) -> Iterator[RecordedSituation]:
    """Yield the occurrences in a recording; scenarios with one beginning and the same vehicles are one."""
    scenarios: dict[_Key, set[int]] = {}
    lanes: dict[_Key, str] = {}
    for match in findings.matches:
        vehicles = tuple(x for x in (match.sv, match.pov, match.pov2) if x is not None)
        key = match.start_frame, vehicles
        scenarios.setdefault(key, set()).add(match.scenario)
        lanes.setdefault(key, match.lane)
    of = _RecordingReader(recording, limits)
    for key, numbers in sorted(scenarios.items()):
        made = of.situation(key, lanes[key], tuple(sorted(numbers)))
        if made is not None:
            yield made


class _RecordingReader:
    """A recording with what is known of it for all of its occurrences."""

    def __init__(self, recording: Recording, limits: OccurrenceLimits) -> None:
        self.recording, self.limits = recording, limits
        self.place = {number: k for k, number in enumerate(recording.vehicle_id.tolist())}
        self.last = recording.first_frame + np.diff(recording.start) - 1
        self._roads: dict[int, Road] = {}

    def situation(self, key: _Key, lane: str, scenarios: tuple[int, ...]) -> RecordedSituation | None:
        """Return an occurrence; None where the vehicles are recorded together for less than a step."""
        first, numbers = key
        recording, dt = self.recording, self.limits.dt
        cast = dict(zip(roles(len(numbers)), (self.place[x] for x in numbers), strict=True))
        common = int(last_common(recording, np.array([[x] for x in cast.values()]))[0])
        rate = Fraction(recording.rate)
        steps = int(min((common - first) / rate, self.limits.seconds) / dt)
        if steps < 1:
            return None
        last = min(common, first + ceil(steps * dt * rate))
        near, left_out = self._near(cast[SUBJECT], (first, last), set(cast.values()))
        everyone = cast | {f"V{recording.vehicle_id[k]}": k for k in near}
        clock = StepClock(dt, steps)
        samples = self._samples(everyone, (first, last), clock)
        courses = {name: self._course(k, samples[name], dt) for name, k in everyone.items()}
        names = dict(zip(cast, map(str, numbers), strict=True))
        road = self._road(int(recording.direction[cast[SUBJECT]]))
        place = OccurrencePlace(recording.name, scenarios, names, lane, first, left_out)
        return recorded_situation(place, courses, samples, road, clock, self.limits.subject)

    def _road(self, way: int) -> Road:
        if way not in self._roads:
            self._roads[way] = road_of(self.recording, way)
        return self._roads[way]

    def _near(self, subject: int, frames: tuple[int, int], cast: set[int]) -> tuple[list[int], int]:
        """Return the other vehicles near SV in all of the frames, and the number of those in some of them."""
        recording, (first, last) = self.recording, frames
        begin, end = recording.first_frame, self.last
        there = (recording.direction == recording.direction[subject]) & (begin <= last) & (end >= first)
        near: list[tuple[float, int]] = []
        left_out = 0
        for k in np.flatnonzero(there).tolist():
            if k in cast:
                continue
            low, high = max(first, int(begin[k])), min(last, int(end[k]))
            apart = np.abs(self._s(k, low, high) - self._s(subject, low, high))
            if apart.min() <= _NEAR:
                if (low, high) == (first, last):
                    near.append((float(apart.min()), k))
                else:
                    left_out += 1
        most = _MOST - len(cast)
        return [k for _, k in sorted(near)[:most]], left_out + max(0, len(near) - most)

    def _s(self, k: int, low: int, high: int) -> Floats:
        recording = self.recording
        row = int(recording.start[k]) - int(recording.first_frame[k])
        values: Floats = recording.s[row + low : row + high + 1]
        return values

    def _samples(
        self, vehicles: Mapping[str, int], frames: tuple[int, int], clock: StepClock
    ) -> dict[str, VehicleSamples]:
        """Return the recorded signals at the steps of a clock, on straight lines between frames."""
        batch = gather_one(self.recording, vehicles, frames, RECORDED)
        signals: dict[Any, Any] = {**batch.signals}
        at = np.arange(clock.steps + 1) * float(clock.dt) * float(self.recording.rate)
        count = int(batch.lengths[0])
        return {
            name: VehicleSamples(
                *(np.interp(at, np.arange(count), signals[x, name][:count, 0]) for x in OBSERVED)
            )
            for name in vehicles
        }

    def _course(self, k: int, samples: VehicleSamples, dt: Fraction) -> VehicleCourse:
        recording = self.recording
        code = int(recording.kind_code[k])
        s, v, along = _followed(samples.s, samples.v_lon[0], dt, is_forward=True)
        d, u, across = _followed(samples.d, samples.v_lat[0], dt, is_forward=False)
        return VehicleCourse(
            _fine(recording.length[k]),
            _fine(recording.width[k]),
            KINDS[code - 1] if code else None,
            s,
            d,
            v,
            u,
            along,
            across,
        )


def _followed(
    places: Floats, speed_at_start: float, dt: Fraction, is_forward: bool
) -> tuple[Fraction, Fraction, tuple[Phase, ...]]:
    """Return place and speed at the start, and the accelerations that follow recorded places.

    Each step aims at the rate of change of the places, since recorded speeds need not fit them, and takes
    back the distance to the recorded place within a second.
    """
    speeds = np.gradient(places, float(dt))
    first_place, first_speed = _fine(places[0]), _fine(speed_at_start)
    if is_forward:
        first_speed = max(first_speed, Fraction(0))
    place, speed, step = float(first_place), float(first_speed), float(dt)
    phases: list[Phase] = []
    for k in range(len(places) - 1):
        foreseen = place + (speed + float(speeds[k + 1])) * step / 2
        aim = float(speeds[k + 1]) + (float(places[k + 1]) - foreseen) / _BACK
        if is_forward:
            aim = max(aim, 0.0)
        push = _thousandths(round((aim - speed) / step * _FINE))
        faster = speed + float(push) * step
        if is_forward:
            faster = max(faster, 0.0)
        place, speed = place + (speed + faster) * step / 2, faster
        phases.append(Phase(k, 1, push))
    return first_place, first_speed, tuple(phases)


def _fine(value: float) -> Fraction:
    return _thousandths(round(float(value) * _FINE))


@cache
def _thousandths(count: int) -> Fraction:
    """Return a fraction, the same object for the same value: long recordings have millions of them."""
    return Fraction(count, _FINE)
