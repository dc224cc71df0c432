"""Motion along a line that bends, against differences of places in the plane."""

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np
import pytest

from roadproof.extensions.maps.lines import even_line
from roadproof.extensions.traffic.formats.line_coordinates import LineMotion, motion_along, project
from roadproof.extensions.traffic.formats.recording import Floats

ROADS: dict[str, Callable[[Floats], Floats]] = {
    "arc to the left": lambda s: s / 150,
    "arc to the right": lambda s: -s / 150,
    "spirals": lambda s: (s - 250) ** 2 / (2 * 250 * 120),
}
"""The heading (rad) by how far along (m); the spirals begin and end with a radius of 120 m."""
RATE = 1000
TIMES = np.arange(RATE * 10) / RATE


def integrated(rates: Floats, at: Floats) -> Floats:
    """The integral of (n, 2) ``rates`` up to each of the places ``at``, by the trapezoid rule."""
    steps = (rates[1:] + rates[:-1]) / 2 * np.diff(at)[:, None]
    return np.concatenate((np.zeros((1, 2)), np.cumsum(steps, axis=0)))


def direction(angle: Floats) -> Floats:
    return np.stack((np.cos(angle), np.sin(angle)), axis=1)


@dataclass(frozen=True)
class Driven:
    """A road, what a vehicle on it does in the plane by differences, and the rates of its s and d."""

    line: Floats
    heading: Floats
    centre: Floats
    velocity: Floats
    acceleration: Floats
    rates: LineMotion


def drive(turn: Callable[[Floats], Floats]) -> Driven:
    """A vehicle accelerates from 25 m/s and sways between 2 m and 8 m to the left of a road of 500 m."""
    way = np.arange(0, 500, 0.01)
    line = integrated(direction(turn(way)), way)
    s, v_lon, a_lon = 60 + 25 * TIMES + TIMES**2, 25 + 2 * TIMES, np.full_like(TIMES, 2.0)
    d, v_lat, a_lat = 5 + 3 * np.sin(TIMES), 3 * np.cos(TIMES), -3 * np.sin(TIMES)
    heading = turn(s)
    foot = line[6000] + integrated(v_lon[:, None] * direction(heading), TIMES)
    centre = foot + d[:, None] * direction(heading + np.pi / 2)
    velocity = np.gradient(centre, TIMES, axis=0)
    acceleration = np.gradient(velocity, TIMES, axis=0)
    inner = slice(2, -2)  # differences are one-sided at the ends
    rates = LineMotion(*(x[inner] for x in (v_lon, v_lat, a_lon, a_lat)))
    columns = (heading, centre, velocity, acceleration)
    return Driven(line[::200], *(x[inner] for x in columns), rates)


def largest_errors(found: LineMotion, true: LineMotion) -> dict[str, float]:
    names = [x.name for x in fields(LineMotion)]
    return {x: float(np.abs(getattr(found, x) - getattr(true, x)).max()) for x in names}


@pytest.mark.parametrize("road", ROADS)
def test_motion_has_the_rates_of_places_along_the_line(road: str) -> None:
    driven = drive(ROADS[road])
    line = project(even_line(driven.line), driven.centre)
    found = motion_along(line, driven.velocity, driven.acceleration)
    errors = largest_errors(found, driven.rates)
    assert max(errors.values()) < 0.015, errors


@pytest.mark.parametrize("road", ROADS)
@pytest.mark.parametrize("slip", [0.0, 0.1])
def test_accelerations_without_the_turning_of_boxes(road: str, slip: float) -> None:
    """CommonRoad has the acceleration along a box, and what its speed across changes by."""
    driven = drive(ROADS[road])
    boxes = driven.heading + slip
    ahead, left = direction(boxes), direction(boxes + np.pi / 2)
    speed, across = ((driven.velocity * x).sum(axis=1) for x in (ahead, left))
    pull = (driven.acceleration * ahead).sum(axis=1)
    told = pull[:, None] * ahead + np.gradient(across, 1 / RATE)[:, None] * left
    found = motion_along(project(even_line(driven.line), driven.centre), driven.velocity, told, boxes)
    inner = LineMotion(*(x[2:-2] for x in vars(found).values()))
    errors = largest_errors(inner, LineMotion(*(x[2:-2] for x in vars(driven.rates).values())))
    assert max(errors.values()) < 0.015, errors
    assert speed.min() > 20


def test_nothing_changes_on_a_straight_line() -> None:
    """Not a bit; nor beyond the ends of a line."""
    random = np.random.default_rng(1)
    velocity, acceleration = random.normal(20, 5, (50, 2)), random.normal(0, 2, (50, 2))
    ahead = np.arange(0.0, 200.0, 0.3)
    points = np.stack((np.linspace(5, 190, 50), random.normal(0, 4, 50)), axis=1)
    found = motion_along(
        project(even_line(np.stack((ahead, 0 * ahead), axis=1)), points), velocity, acceleration
    )
    columns = np.concatenate((velocity, acceleration), axis=1).T
    assert [x.tobytes() for x in vars(found).values()] == [x.tobytes() for x in columns]
    turned = project(even_line(ahead[:, None] * direction(np.array([0.7])) + 1e4), points + 1e4)
    assert not turned.curvature.any()
    assert not turned.curvature_rate.any()
    driven = drive(ROADS["arc to the left"])
    behind = project(even_line(driven.line), -5 * direction(np.zeros(1)))
    assert (behind.s[0] < 0, behind.curvature[0], behind.curvature_rate[0]) == (True, 0, 0)
