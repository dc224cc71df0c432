"""The closed loop: POVs follow their courses, and SV does what its controller demands, step by step.

Floating point guides a search. ``exact_drive`` runs the controller again on exact states; it alone decides.
"""

import math
import signal
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from fractions import Fraction
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from roadproof.evidence.claim import Claim
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.closed_loop.errors import ControllerError
from roadproof.extensions.closed_loop.protocol import (
    OBSERVED,
    ControllerInput,
    ObservedLane,
    ObservedVehicle,
    VehicleController,
)
from roadproof.extensions.closed_loop.situation import TrafficSituation, VehicleCourse, values_of
from roadproof.extensions.closed_loop.stepping import FINE, Body, limits_as
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.road import Road

Floats: TypeAlias = npt.NDArray[np.float64]
LOOP = 1
"""A number that changes with the loop, so that older stored answers do not count."""
Rows: TypeAlias = "Sequence[tuple[Any, ...]]"
"""The values of several signals in each step."""
_HALF = Fraction(1, 2)
_LAST = Fraction(1)  # s in which a motion across the road ends after the last step
_MOST = 1e6  # of a demand


@dataclass(frozen=True)
class VehicleSamples:
    """The signals of one vehicle at each instant, shape (steps + 1,) or (steps + 1, simulations)."""

    s: Floats
    d: Floats
    v_lon: Floats
    v_lat: Floats
    a_lon: Floats


# --- POVs ----------------------------------------------------------------------------------------


def follow(courses: Sequence[VehicleCourse], situation: TrafficSituation, name: str) -> VehicleSamples:
    """Return the motion of POV in several simulations, which share clock and limits."""
    steps, dt = situation.clock.steps, float(situation.clock.dt)
    least, greatest, top, across, sideways, share = (
        float(x) for x in limits_as(situation.limits[name], float)
    )
    shape = (steps + 1, len(courses))
    s, d, v, u, a = (np.zeros(shape) for _ in OBSERVED)
    along = np.array([_floats(x.along, steps) for x in courses]).T
    aside = np.array([_floats(x.across, steps) for x in courses]).T
    along = np.clip(along, least, greatest)
    aside = np.clip(aside, -across, across)
    for row, key in ((s, "s"), (d, "d"), (v, "v_lon"), (u, "v_lat")):
        row[0] = [float(getattr(x, key)) for x in courses]
    moves = bool(np.any(aside)) or bool(np.any(u[0]))
    for k in range(steps):
        faster = np.clip(v[k] + along[k] * dt, 0.0, top)
        a[k] = (faster - v[k]) / dt
        s[k + 1] = s[k] + (v[k] + faster) * (dt / 2)
        v[k + 1] = faster
        if moves:
            most = np.minimum(share * faster, sideways)
            turned = np.clip(u[k] + aside[k] * dt, -most, most)
            d[k + 1] = d[k] + (u[k] + turned) * (dt / 2)
            u[k + 1] = turned
        else:
            d[k + 1] = d[k]
    return VehicleSamples(s, d, v, u, a)


def _floats(phases: Any, steps: int) -> Floats:
    values = np.zeros(steps)
    for x in phases:
        values[max(0, x.begin) : max(0, x.begin + x.count)] = float(x.acceleration)
    return values


# --- SV ------------------------------------------------------------------------------------------


def lanes_of(road: Road) -> tuple[ObservedLane, ...]:
    """Return the lanes of a road from the right, each with its outermost edges."""
    edges: dict[str, tuple[float, float]] = {}
    for x in road.lanelets:
        right, left = map(float, x.d)
        low, high = edges.get(x.lane, (right, left))
        edges[x.lane] = min(low, right), max(high, left)
    lanes = (ObservedLane(name, *edge) for name, edge in edges.items())
    return tuple(sorted(lanes, key=lambda lane: (lane.right, lane.name)))


def _seen(name: str, course: VehicleCourse) -> ObservedVehicle:
    return ObservedVehicle(
        name,
        float(course.s),
        float(course.d),
        float(course.v_lon),
        float(course.v_lat),
        0.0,
        float(course.length),
        float(course.width),
    )


class ControlLoop:
    """A controller with its time-out: ``patience`` is the greatest duration of a simulation (s)."""

    def __init__(self, controller: VehicleController, patience: float) -> None:
        self.controller, self.patience = controller, patience
        self._lanes: tuple[Road, tuple[ObservedLane, ...]] | None = None

    def run(self, situation: TrafficSituation, others: Mapping[str, Rows]) -> VehicleSamples:
        """Return the motion of SV; ``others``: the OBSERVED of each POV in each step.

        Raises ``ControllerError``.
        """
        course, dt = situation.courses[situation.subject], float(situation.clock.dt)
        limits = limits_as(situation.limits[situation.subject], float)
        place = float(course.s), float(course.d), float(course.v_lon), float(course.v_lat)
        body: Body[Any] = Body(*place, dt, 0.5, limits)
        with patient(self.patience):
            rows = self.drive(situation, body, [others[name] for name in situation.others])
        s, d, v, u, a, _ = (np.array(x) for x in zip(*rows, strict=True))
        return VehicleSamples(s, d, v, u, a)

    def drive(self, situation: TrafficSituation, body: Body[Any], others: Sequence[Rows]) -> Rows:
        """Ask the controller in each step; return OBSERVED and the acceleration across, at each instant.

        Numbers are of the kind of ``body``. Raises ``ControllerError``.
        """
        clock, course = situation.clock, situation.courses[situation.subject]
        number, dt, steps = type(body.s), float(clock.dt), clock.steps
        is_exact = number is Fraction
        lanes = self._lanes_of(situation.road)
        places = _places(lanes, number(course.width), number)
        plan: Any = values_of(course.across, steps) if is_exact else _floats(course.across, steps).tolist()
        me = _seen(situation.subject, course)
        seen = tuple(_seen(name, situation.courses[name]) for name in situation.others)
        pairs = list(zip(seen, others, strict=True))
        now, rows = ControllerInput(0.0, me, seen, lanes), list[tuple[Any, ...]]()
        step, time, keeps_lane = self.controller.step, 0.0, not course.across
        try:
            for vehicle, track in pairs:
                vehicle.s, vehicle.d, vehicle.v_lon, vehicle.v_lat, vehicle.a_lon = track[0]
            self.controller.reset(now)
            for k in range(steps):
                now.time = time = k * dt
                for vehicle, track in pairs:
                    vehicle.s, vehicle.d, vehicle.v_lon, vehicle.v_lat, vehicle.a_lon = track[k]
                now.plan = float(body.v_lat) if keeps_lane else float(body.v_lat + plan[k] * body.dt)
                answer = step(now, dt)
                demand, aside = (answer, None) if answer.__class__ is float else _parts(answer)
                if not -_MOST < demand < _MOST:
                    raise ControllerError(f"it demands an acceleration of {demand}: demand a finite number")
                a_lat = plan[k] if aside is None else _sideways(body, aside, places)
                s, d, v, u = body.s, body.d, body.v_lon, body.v_lat
                fine = round(demand * FINE)
                demanded: Any = Fraction(fine, FINE) if is_exact else fine / FINE
                body.move(demanded, a_lat)
                rows.append((s, d, v, u, body.a_lon, body.a_lat))
                if is_exact:
                    me.s, me.d, me.v_lon = float(body.s), float(body.d), float(body.v_lon)
                    me.v_lat, me.a_lon = float(body.v_lat), float(body.a_lon)
                else:
                    me.s, me.d, me.v_lon, me.v_lat, me.a_lon = (
                        body.s,
                        body.d,
                        body.v_lon,
                        body.v_lat,
                        body.a_lon,
                    )
        except Exception as error:  # whatever the code of a user does
            raise self._error(error, time) from error
        rows.append((body.s, body.d, body.v_lon, body.v_lat, 0, 0))
        return rows

    def _lanes_of(self, road: Road) -> tuple[ObservedLane, ...]:
        """Return the lanes of a road; those of the latest road are remembered."""
        if self._lanes is None or self._lanes[0] is not road:
            self._lanes = road, lanes_of(road)
        return self._lanes[1]

    def _error(self, error: Exception, time: float) -> ControllerError:
        """Return the error that says what the controller did, and when."""
        if isinstance(error, _LateError):
            return ControllerError(
                f"no answer within {self.patience:g} s for a whole simulation (at {time:g} s); raise "
                "--patience if it is slow by design"
            )
        name = "" if isinstance(error, ControllerError) else f"{type(error).__name__}: "
        return ControllerError(f"{name}{error} (at {time:g} s)")


def _places(lanes: Sequence[ObservedLane], width: Any, number: Any) -> dict[str, Any]:
    """Return the place (d) of the left side of SV in the middle of each lane."""
    return {x.name: (number(x.left + x.right) + width) / 2 for x in lanes}


def _sideways(body: Body[Any], aside: float | str, places: Mapping[str, Any]) -> Any:
    """Return the acceleration across the road that a demand needs. Raises ``ControllerError``."""
    if not isinstance(aside, str):
        return body.towards(_rounded(aside, type(body.s)))
    if aside not in places:
        raise ControllerError(f"it demands the lane {aside!r}: the road has {', '.join(places)}")
    return body.push_to(aside, places[aside])


def _rounded(value: float, number: Any) -> Any:
    fine = round(value * FINE)
    return Fraction(fine, FINE) if number is Fraction else fine / FINE


def _parts(answer: Any) -> tuple[float, float | str | None]:
    """Return both parts of a demand. Raises ``ControllerError`` for anything else."""
    demand, aside = answer if isinstance(answer, tuple | list) and len(answer) == 2 else (answer, None)
    numbers = (int, float, np.integer, np.floating)
    if not isinstance(demand, numbers) or isinstance(demand, bool):
        raise ControllerError(
            f"it demands {answer!r:.60}: return an acceleration (m/s^2), or that and a velocity across the "
            "road (m/s) or the name of a lane"
        )
    if aside is None or isinstance(aside, str):
        return float(demand), aside
    if not isinstance(aside, numbers) or isinstance(aside, bool) or not math.isfinite(aside):
        raise ControllerError(
            f"it demands {aside!r:.60} across the road: return m/s, the name of a lane or None"
        )
    return float(demand), float(aside)


class _LateError(Exception):
    """The time of a simulation is over."""


@contextmanager
def patient(seconds: float) -> Iterator[None]:
    """Interrupt what takes longer; only the main thread of a process can be interrupted."""
    if not hasattr(signal, "setitimer") or threading.current_thread() is not threading.main_thread():
        yield
        return

    def ring(number: int, frame: object) -> None:
        raise _LateError

    former = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, former)


# --- exact drives --------------------------------------------------------------------------------


def exact_drive(loop: ControlLoop, situation: TrafficSituation) -> Drive:
    """Return the drive of a simulation, with exact states throughout. Raises ``ControllerError``.

    The controller drives twice, and has to do the same both times.
    """
    once, again = (_exact_run(loop, situation) for _ in range(2))
    if once != again:
        raise ControllerError(_difference(once, again, situation))
    return once


def driven_file(
    situation: TrafficSituation, claim: Claim, drive: Drive, may_overlap: bool, scenario: int | None = None
) -> DriveFile:
    """Return the drive of a situation as a file with the formula of a claim."""
    return DriveFile(
        scenario,
        claim.home.set_name,
        claim.text,
        situation.clock.horizon,
        dict(situation.lanes),
        dict(claim.values),
        dict(claim.home.options),
        situation.road,
        drive,
        may_overlap,
    )


def _exact_run(loop: ControlLoop, situation: TrafficSituation) -> Drive:
    motions: dict[str, Motion] = {}
    columns: list[Rows] = []
    steps = situation.clock.steps
    for name in situation.others:
        course = situation.courses[name]
        along, across = values_of(course.along, steps), values_of(course.across, steps)
        rows: list[tuple[Any, ...]] = []
        body = _body(situation, name)
        pushes: list[tuple[Fraction, Fraction]] = []
        for k in range(steps):
            place = float(body.s), float(body.d), float(body.v_lon), float(body.v_lat)
            body.move(along[k], across[k])
            rows.append((*place, float(body.a_lon)))
            pushes.append((body.a_lon, body.a_lat))
        columns.append(rows)
        motions[name] = _motion(situation, name, pushes)
    me = situation.subject
    with patient(loop.patience):
        driven = loop.drive(situation, _body(situation, me), columns)
    mine = [(a_lon, a_lat) for *_, a_lon, a_lat in driven[:-1]]
    return Drive({me: _motion(situation, me, mine), **motions})


def _body(situation: TrafficSituation, name: str) -> Any:
    x = situation.courses[name]
    limits = limits_as(situation.limits[name], Fraction)
    return Body(x.s, x.d, x.v_lon, x.v_lat, situation.clock.dt, _HALF, limits)


def _motion(situation: TrafficSituation, name: str, pushes: Sequence[tuple[Fraction, Fraction]]) -> Motion:
    """Return the motion of a vehicle: after the last step it keeps its speed, and goes straight on."""
    course, dt = situation.courses[name], situation.clock.dt
    pieces: list[Piece] = []
    for k, (a_lon, a_lat) in enumerate(pushes):
        if k and pushes[k - 1] == (a_lon, a_lat):
            former = pieces.pop()
            assert former.duration is not None
            pieces.append(Piece(former.duration + dt, a_lon, a_lat))
        else:
            pieces.append(Piece(dt, a_lon, a_lat))
    drift = course.v_lat + sum((a_lat * dt for _, a_lat in pushes), Fraction(0))
    if drift:
        pieces.append(Piece(_LAST, Fraction(0), -drift / _LAST))
    still = Piece(None, Fraction(0), Fraction(0))
    return Motion(
        course.length,
        course.width,
        course.s,
        course.d,
        course.v_lon,
        course.v_lat,
        (*pieces, still),
        course.kind,
    )


def _difference(once: Drive, again: Drive, situation: TrafficSituation) -> str:
    me, time = situation.subject, Fraction(0)
    pairs = zip(once.vehicles[me].pieces, again.vehicles[me].pieces, strict=False)
    for one, other in pairs:
        if (one.a_lon, one.a_lat, one.duration) != (other.a_lon, other.a_lat, other.duration):
            break
        time += one.duration or 0
    return (
        "it is not deterministic: after a reset with the same state, its demands differ from "
        f"{float(time):g} s on; draw random numbers from a generator that reset() seeds, and forget the rest"
    )
