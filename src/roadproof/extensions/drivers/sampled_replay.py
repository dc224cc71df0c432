"""A driver model put into samples: POV is where the samples say, and SV moves as the model prescribes.

Between samples places are straight lines; so it is decided whether the boxes touch, and when SV has passed.
"""

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from fractions import Fraction
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.fuzzy import HERTZ
from roadproof.extensions.drivers.fuzzy_looks import LONGEST, Sight, controlled, known_from
from roadproof.extensions.drivers.lanes import Across, VehicleBox, across
from roadproof.extensions.drivers.manoeuvres import ManoeuvreName
from roadproof.extensions.drivers.models import driver_model
from roadproof.extensions.drivers.outcome import Outcome, Result
from roadproof.extensions.drivers.replay import until_it_stands
from roadproof.extensions.drivers.response import Phase
from roadproof.reasons import ReasonKind
from roadproof.runtime.records import dataclass
from roadproof.world.road import Road
from roadproof.world.signals import RECORDED, STARTING, SignalName

Floats: TypeAlias = npt.NDArray[np.float64]
Bools: TypeAlias = npt.NDArray[np.bool_]
_PLACES = 6  # decimals of a state


@dataclass(frozen=True)
class Track:
    """A vehicle in samples: front, left side (m), speeds along and across (m/s), and acceleration along.

    ``s``, ``d``, ``v_lon``, ``v_lat`` and ``a_lon`` have a value for each sample.
    """

    s: Floats
    d: Floats
    v_lon: Floats
    v_lat: Floats
    a_lon: Floats
    length: float
    width: float

    def box(self, k: int) -> VehicleBox:
        """Return the box at a sample, rounded to a micrometre."""
        return VehicleBox(*(_exact(x) for x in (self.s[k], self.d[k], self.length, self.width)))


TRACKED: tuple[SignalName, ...] = tuple(x for x in RECORDED if x in {y.name for y in fields(Track)})
"""The signals of which a driver model is told."""


@dataclass(frozen=True)
class SampledScene:
    """Samples as a ``Scene``; between two of them positions are straight lines."""

    tracks: Mapping[str, Track]
    road: Road
    vehicles: tuple[str, ...]
    step: Fraction
    first_sample: int

    @property
    def start(self) -> Fraction:
        return self.first_sample * self.step

    @cached_property
    def across(self) -> Across:
        """Return where SV and the first POV begin across the road."""
        me, other = (self.tracks[x].box(self.first_sample) for x in self.vehicles[:2])
        return across(self.road, me, other, len(self.vehicles) == 2)

    def offset(self, metres: Fraction) -> Fraction | None:
        other, here = self.tracks[self.vehicles[1]], self.across
        away = other.d - other.width / 2 - float(here.centre)
        if len(self.vehicles) > 2:  # it leaves the lane, to either side
            return self._first(np.abs(away) - float(metres))
        return self._first(-here.side * away - float(metres))

    def beside(self) -> Fraction | None:
        me, other = self._pair
        return self._first(np.minimum(me.d - other.d + other.width, other.d - me.d + me.width))

    def past_marking(self, metres: Fraction) -> Fraction | None:
        other, here = self.tracks[self.vehicles[1]], self.across
        edge = other.d - other.width if here.side > 0 else other.d
        return self._first(here.side * (float(here.marking) - edge) - float(metres))

    def wrapped(self) -> Fraction | None:
        me, other = self._pair
        inner, outer = (other, me) if other.width <= me.width else (me, other)
        return self._first(np.minimum(outer.d - inner.d, inner.d - inner.width - outer.d + outer.width))

    def closing(self, seconds: Fraction, since: Fraction) -> Fraction | None:
        me, other = self._pair
        faster = me.v_lon - other.v_lon
        gap = other.s - other.length - me.s
        return self._first(np.where(faster > 0, float(seconds) * faster - gap, -np.inf), since)

    def braking(self, least: Fraction) -> Fraction | None:
        me, other = self._pair
        slows = other.a_lon <= -float(least) if least else other.a_lon < 0
        holds = slows & (other.s - other.length >= me.s) & in_way(me, other)
        return self._first(np.where(holds, 0.0, -np.inf))

    @property
    def _pair(self) -> tuple[Track, Track]:
        return self.tracks[self.vehicles[0]], self.tracks[self.vehicles[1]]

    def _first(self, margin: Floats, since: Fraction | None = None) -> Fraction | None:
        """Return the first instant at which a margin, straight between samples, is 0 or more."""
        begin = self.first_sample if since is None else max(0, -int(-since // self.step))
        samples = np.flatnonzero(margin[begin:] >= 0)
        if not len(samples):
            return None
        k = begin + int(samples[0])
        if k == begin or not np.isfinite(margin[k - 1]):
            return k * self.step
        part = float(margin[k - 1] / (margin[k - 1] - margin[k]))
        return (k - 1 + _exact(part)) * self.step


def in_way(me: Track, other: Track) -> Bools:
    """Return at which samples the boxes overlap across the road, or their edges meet."""
    overlap: Bools = (me.d >= other.d - other.width) & (other.d >= me.d - me.width)
    return overlap


def replay_samples(
    scene: SampledScene, manoeuvre: ManoeuvreName, model: str, settings: DriverSettings
) -> Outcome:
    """Replace the motion of SV from the first sample of the scene on by the response of a model."""
    me = scene.vehicles[0]
    tracks = {**scene.tracks, me: _unbraked(scene.tracks[me], scene.first_sample, scene.step)}
    scene = replace(scene, tracks={name: _longer(x, scene.step) for name, x in tracks.items()})
    law = driver_model(model).law
    if law is None:
        onset, phases = _looked(scene, manoeuvre)
    else:
        response = law.respond(manoeuvre, scene, settings)
        onset, phases = (None, []) if response is None else (response.onset, [*response.phases])
    mine = scene.tracks[me]
    driven = mine if onset is None else _driven(mine, scene.step, onset, phases)
    outcome = _judged(driven, scene)
    return replace(outcome, onset=None if onset is None else float(onset))


def _unbraked(track: Track, first: int, step: Fraction) -> Track:
    """Return a track of which the speed along never falls from sample ``first`` on."""
    s, v = track.s.copy(), track.v_lon.copy()
    more = np.maximum(np.diff(v[first:]), 0)
    v[first:] = v[first] + np.concatenate(([0.0], np.cumsum(more)))
    faster = (v - track.v_lon)[first:]
    gone = np.diff(s[first:]) + (faster[:-1] + faster[1:]) / 2 * float(step)
    even = v[first:-1] * float(step)
    s[first + 1 :] = s[first] + np.cumsum(np.where((more > 0) | (faster[1:] == 0), gone, even))
    return replace(track, s=s, v_lon=v)


def _longer(track: Track, step: Fraction) -> Track:
    """Return a track that goes on after its last sample as fast as there, straight on, for ``LONGEST`` s."""
    count = int(LONGEST / step)
    ahead = np.arange(1, count + 1) * float(step)
    s, d, v_lon = track.s[-1], track.d[-1], track.v_lon[-1]
    return replace(
        track,
        s=np.concatenate((track.s, s + v_lon * ahead)),
        d=np.concatenate((track.d, np.full(count, d))),
        v_lon=np.concatenate((track.v_lon, np.full(count, v_lon))),
        v_lat=np.concatenate((track.v_lat, np.zeros(count))),
        a_lon=np.concatenate((track.a_lon, np.zeros(count))),
    )


def _driven(track: Track, step: Fraction, onset: Fraction, phases: Sequence[Phase]) -> Track:
    """Return a track that is as before up to ``onset``, and then has these phases along until it stands."""
    times = np.arange(len(track.s)) * float(step)
    begin = float(onset)
    later = times > begin
    place, speed = (float(np.interp(begin, times, x)) for x in (track.s, track.v_lon))
    s, v = track.s.copy(), track.v_lon.copy()
    time, still = begin, times >= begin
    for duration, acceleration, jerk in until_it_stands(_exact(speed), phases):
        a, j, lasts = float(acceleration), float(jerk), float(duration)
        now = later & (times >= time)
        x = np.minimum(times[now] - time, lasts)
        s[now] = place + speed * x + a * x**2 / 2 + j * x**3 / 6
        v[now] = speed + a * x + j * x**2 / 2
        place += speed * lasts + a * lasts**2 / 2 + j * lasts**3 / 6
        speed += a * lasts + j * lasts**2 / 2
        time += lasts
    rest = still & (times >= time)
    s[rest], v[rest] = place + speed * (times[rest] - time), speed
    return replace(track, s=s, v_lon=v)


def _judged(mine: Track, scene: SampledScene) -> Outcome:
    """Return whether SV touches the last vehicle before it has passed it."""
    other, begin = scene.tracks[scene.vehicles[-1]], scene.first_sample
    gap, clear = other.s - other.length - mine.s, other.s - mine.s + mine.length
    touch = _first_together(begin, mine.d - other.d + other.width, other.d - mine.d + mine.width, -gap, clear)
    past = _first_together(begin, np.nextafter(-clear, -np.inf))
    step = float(scene.step)
    if touch is not None and (past is None or touch <= past):
        samples = np.arange(len(gap))
        speed = float(np.interp(touch, samples, mine.v_lon - other.v_lon))
        return Outcome(Result.COLLIDES, instant=round(touch * step, 3), speed=round(speed, 2))
    if past is not None:
        return Outcome(Result.UNDECIDED, reason=ReasonKind.PASSED_BY(round(past * step, 2)))
    least = gap[begin:][in_way(mine, other)[begin:]]
    return Outcome(Result.PREVENTED, gap=round(float(least.min()), 2) if len(least) else None)


def _first_together(begin: int, *margins: Floats) -> float | None:
    """Return the first sample, and part of one, at which no margin is negative.

    Between samples margins are straight lines.
    """
    count = len(margins[0]) - 1
    low, high = np.zeros(count), np.ones(count)
    for margin in margins:
        now, later = margin[:-1], margin[1:]
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = now / (now - later)
        low = np.maximum(low, np.where(now >= 0, 0.0, np.where(later >= 0, crossing, 2.0)))
        high = np.minimum(high, np.where(later >= 0, 1.0, np.where(now >= 0, crossing, -1.0)))
    intervals = np.flatnonzero(low[begin:] <= high[begin:])
    if not len(intervals):
        return None
    k = begin + int(intervals[0])
    return k + float(low[k])


def _looked(scene: SampledScene, manoeuvre: ManoeuvreName) -> tuple[Fraction | None, list[Phase]]:
    """Return when the fuzzy safety model first brakes, and its braking from look to look."""
    tracks = [scene.tracks[x] for x in (scene.vehicles[0], scene.vehicles[-1])]
    times = [scene.start + Fraction(k, HERTZ) for k in range(LONGEST * HERTZ)]
    samples = np.arange(len(tracks[0].s)) * float(scene.step)
    places = np.array([float(x) for x in times])
    columns = [[np.interp(places, samples, getattr(x, name)) for name in STARTING] for x in tracks]
    end = (len(samples) - int(LONGEST / scene.step)) * scene.step
    return controlled(
        (_sight(time, k, tracks, columns, time >= end) for k, time in enumerate(times)),
        known_from(scene, manoeuvre),
    )


def _sight(
    time: Fraction, k: int, tracks: Sequence[Track], columns: Sequence[Sequence[Floats]], is_even: bool
) -> Sight:
    (s, d, v, u), (its_s, its_d, its_v, its_u) = ([_exact(x[k]) for x in those] for those in columns)
    mine, its = ((_exact(x.length), _exact(x.width)) for x in tracks)
    return Sight(time, VehicleBox(s, d, *mine), VehicleBox(its_s, its_d, *its), v, its_v, u, its_u, is_even)


def _exact(value: float) -> Fraction:
    return Fraction(round(value * 10**_PLACES), 10**_PLACES)
