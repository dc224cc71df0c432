"""What clients should find in exported files, from the drive and its road alone; no exporter is asked."""

import math
from bisect import bisect_right
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from extensions.exchange.exporting.integration import curvature_at, integrated
from roadproof.evidence.drive_file import DriveFile
from roadproof.world.drive import Motion
from roadproof.world.motion import State, piece_starts, state_at
from roadproof.world.road import Lanelet

RATE = 25
EVERY = 5
"""Samples between two at which metrics are compared."""
_LITTLE = 0.1
"""m/s² by which accelerations differ at most where the client takes them for equal."""
_TYPES = {"main": "driving", "merge": "entry", "departure": "exit"}


def expected(file: DriveFile) -> dict[str, Any]:
    """Boxes in time, the lanes of each section from the left, and metrics of SV with each other vehicle."""
    names = sorted(file.drive.vehicles, key=lambda name: (name != "SV", name))
    first = 1000 if from_lanelets(file) else 0  # numbers of lanelets are below
    states = {x: [state_at(file.drive.vehicles[x], t) for t in _times(file, RATE)] for x in names}
    vehicles = {}
    for number, name in enumerate(names, 1):
        car = file.drive.vehicles[name]
        dense = _times(file, 100)
        vehicles[name] = {
            "id": first + number,
            "length": float(car.length),
            "width": float(car.width),
            "times": [*map(float, dense)],
            "centres": [x[:2] for x in _seen(file, [state_at(car, t) for t in dense], car)],
            "samples": _seen(file, states[name], car),
        }
    sections, bends = _sections(file), file.road.line is not None
    metrics = [x for other in names[1:] for x in _metrics(file, states, ("SV", other))]
    return {
        "vehicles": vehicles,
        "sections": sections,
        "lanelets": _count(file, sections),
        "metrics": [] if bends else metrics,  # on bends clients measure along lanelets
        "bends": bends,
        "within": [0.01, 0.02] if bends else [1e-9, 1e-9],  # m and m/s
    }


def from_lanelets(file: DriveFile) -> bool:
    """Whether the road is from a map in CommonRoad."""
    return (file.road.map or "").partition("#")[0].endswith(".xml")


def _count(file: DriveFile, sections: list[dict[str, Any]]) -> int:
    """Lanelets: those of the map, or one for each lane of a section."""
    if from_lanelets(file):
        return Path((file.road.map or "").partition("#")[0]).read_text("utf-8").count("<lanelet ")
    return sum(len(x["lanes"]) for x in sections)


def _seen(
    file: DriveFile, states: list[State], car: Motion
) -> list[tuple[float, float, float | None, float]]:
    """x and y of the centre (m), speed along the box (m/s; None where it is not compared), its direction.

    On the motorway by an integration of its curvature, on other bends by the line of the drive file.
    """
    places = [_centre(x, car) for x in states]
    line = file.road.line
    if line is None:
        return [(*place, float(x.v_lon), 0.0) for place, x in zip(places, states, strict=True)]
    if from_lanelets(file):
        return [(*line.place(s, d), None, line.pose(s).heading) for s, d in places]
    s, d = np.array(places).T
    speeds = np.array([float(x.v_lon) for x in states]) * (1 - curvature_at(s) * d)
    x, y, turned = integrated(s, d)
    return [*zip(x.tolist(), y.tolist(), speeds.tolist(), turned.tolist(), strict=True)]


def _times(file: DriveFile, rate: int) -> list[Fraction]:
    return [Fraction(k, rate) for k in range(int(file.horizon * rate) + 1)]


def _centre(state: State, car: Motion) -> tuple[float, float]:
    return float(state.s - car.length / 2), float(state.d - car.width / 2)


def _sections(file: DriveFile) -> list[dict[str, Any]]:
    places: list[Fraction | None] = sorted({x for y in file.road.lanelets for x in y.s if x is not None})
    bounds = [None, *places, None]
    found = []
    for low, high in pairwise(bounds):
        there = [x for x in file.road.lanelets if _spans(x, low, high)]
        there.sort(key=lambda x: x.d, reverse=True)
        lanes = [
            {"width": float(x.d[1] - x.d[0]), "type": _TYPES[x.attribute], "speed": _limit(file)}
            for x in there
        ]
        if lanes:
            found.append({"lanes": lanes})
    return found


def _limit(file: DriveFile) -> float:
    """m/s: 130 km/h, or the next ten km/h above the fastest vehicle; speeds are greatest at changes."""
    fastest = Fraction(0)
    for car in file.drive.vehicles.values():
        times = {file.horizon, *(x.time for x in piece_starts(car) if x.time < file.horizon)}
        fastest = max(fastest, *(state_at(car, time).v_lon for time in times))
    return max(130, 10 * math.ceil(fastest * Fraction(36, 100))) / 3.6


def _spans(lanelet: Lanelet, low: Fraction | None, high: Fraction | None) -> bool:
    begins = lanelet.s[0] is None or (low is not None and lanelet.s[0] <= low)
    return begins and (lanelet.s[1] is None or (high is not None and high <= lanelet.s[1]))


def _metrics(file: DriveFile, states: dict[str, list[State]], pair: tuple[str, str]) -> list[dict[str, Any]]:
    """Of the one behind to the one ahead, where they have a lane in common."""
    found = []
    numbers = {name: number for number, name in enumerate(states, 1)}
    for k in range(1, len(states["SV"]) - 1, EVERY):
        behind, ahead = sorted(pair, key=lambda name: states[name][k].s)
        one, other = (file.drive.vehicles[x] for x in (behind, ahead))
        here, there = states[behind][k], states[ahead][k]
        gap = there.s - other.length - here.s
        if gap <= 0 or not _lanes(file, here, one) & _lanes(file, there, other):
            continue
        told: dict[str, Any] = {"step": k, "ego": numbers[behind], "other": numbers[ahead]}
        told["headway"] = float(gap)
        reached = _reached([x.s for x in states[behind]], gap + here.s)
        if reached is not None and reached > k:
            told["time headway"] = (reached - k) / RATE
        if _steady(one, k) and _steady(other, k) and there.a_lon >= 0:
            collision = _collision(float(gap), _speed(there) - _speed(here), there.a_lon - here.a_lon)
            if collision is not None:
                told["time to collision"] = collision
        found.append(told)
    return found


def _speed(state: State) -> float:
    """In whatever direction, as the client takes it."""
    return math.hypot(state.v_lon, state.v_lat)


def _collision(gap: float, faster: float, harder: Fraction) -> float | None:
    """When a gap is closed at constant accelerations, or at constant speeds where these differ by little."""
    pull = float(harder)
    if abs(abs(pull) - _LITTLE) < 1e-9:
        return None  # either may be meant
    if abs(pull) < _LITTLE:
        return -gap / faster if faster < 0 else None
    inside = faster**2 - 2 * gap * pull
    if inside < 0 or (faster >= 0 and pull > 0):
        return None
    return (-faster - math.sqrt(inside)) / pull


def _reached(fronts: list[Fraction], place: Fraction) -> int | None:
    """The first sample at which the front has passed a place."""
    at = bisect_right(fronts, place)
    return at if at < len(fronts) else None


def _lanes(file: DriveFile, state: State, car: Motion) -> set[str]:
    return {
        x.lane
        for x in file.road.lanelets
        if (x.s[0] is None or state.s > x.s[0])
        and (x.s[1] is None or state.s - car.length < x.s[1])
        and state.d > x.d[0]
        and state.d - car.width < x.d[1]
    }


def _steady(car: Motion, step: int) -> bool:
    """Whether a vehicle has one acceleration from the sample before to the one after."""
    begin, end = Fraction(step - 1, RATE), Fraction(step + 1, RATE)
    return not any(begin < x.time < end for x in piece_starts(car))
