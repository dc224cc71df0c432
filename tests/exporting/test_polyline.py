"""Straight lines between vertices against the exact motion, at many times between them."""

import math
from fractions import Fraction as F
from itertools import pairwise

import pytest

from exporting.kept import TURN, kept, motion
from roadproof.errors import InputError
from roadproof.exporting import polyline
from roadproof.exporting.points import axle_to_centre, centre, heading, rear_axle
from roadproof.world.drive import Motion
from roadproof.world.motion import State, state_at

HARD = motion(("1", "-6", "1.5"), ("1", "3", "-1.5"), (None, "0", "0"), start=("0", "2.6", "12", "1"))


def worst(vertices: tuple[State, ...], car: Motion) -> float:
    """How far the centre or the rear axle of the interpolated box is from that of the drive."""
    found, ahead = 0.0, float(axle_to_centre(car.length))
    for a, b in pairwise(vertices):
        ends = [(*rear_axle(x, car, heading(x)), heading(x)) for x in (a, b)]
        for k in range(17):
            share = k / 16
            x, y, turned = (p + share * (q - p) for p, q in zip(*ends, strict=True))
            state = state_at(car, a.time + (b.time - a.time) * F(k, 16))
            axle = rear_axle(state, car, heading(state))
            middle = centre(state, car.length, car.width)
            turned_middle = x + ahead * math.cos(turned), y + ahead * math.sin(turned)
            found = max(found, math.dist((x, y), axle), math.dist(turned_middle, map(float, middle)))
    return found


@pytest.mark.parametrize(
    "car", [TURN, HARD, *(m for f in [*kept().values()][::6] for m in f.drive.vehicles.values())]
)
def test_lines_are_within_their_bound_and_a_centimetre_of_the_drive(car: Motion) -> None:
    line = polyline.polyline_of(car, F(6))
    assert (line.vertices[0].time, line.vertices[-1].time) == (0, 6)
    assert worst(line.vertices, car) <= line.bound + 1e-12 <= 0.01 + 1e-12


def test_braking_alone_is_bounded_by_an_eighth_of_the_square() -> None:
    car = motion((None, "-4", "0"))
    line = polyline.polyline_of(car, F(2))
    steps = {b.time - a.time for a, b in pairwise(line.vertices)}
    assert steps == {F(1, 8)}
    assert line.bound == pytest.approx(4 * (1 / 8) ** 2 / 8)
    assert worst(line.vertices, car) == pytest.approx(line.bound)  # it is reached in the middle


def test_a_steady_drive_needs_its_two_ends() -> None:
    line = polyline.polyline_of(motion((None, "0", "0")), F(6))
    assert (len(line.vertices), line.bound) == (2, 0.0)


def test_every_change_of_acceleration_is_a_vertex() -> None:
    times = {x.time for x in polyline.polyline_of(TURN, F(6)).vertices}
    assert {F("0.5"), F("2.1"), F("3.7")} <= times


@pytest.mark.parametrize("car", [TURN, HARD])
def test_planted_fault_too_few_vertices_are_noticed(car: Motion) -> None:
    line = polyline.polyline_of(car, F(6))
    assert worst(line.vertices[::4], car) > 0.01


@pytest.mark.parametrize("car", [TURN, HARD])
def test_planted_fault_a_bound_without_the_turning_would_be_broken_or_loose(car: Motion) -> None:
    """The bound is no guess: it is above what is so, and within a few times of it."""
    line = polyline.polyline_of(car, F(6))
    assert line.bound / 4 < worst(line.vertices, car) <= line.bound


def test_a_vehicle_that_stops_keeps_its_heading() -> None:
    straight = polyline.polyline_of(motion(("5", "-6", "0"), (None, "0", "0")), F(6))
    assert (straight.vertices[-1].v_lon, straight.headings[-1]) == (0, 0.0)
    slanting = motion(("5", "-6", "-0.6"), (None, "0", "0"), start=("0", "2", "30", "3"))
    line = polyline.polyline_of(slanting, F(6))
    assert [*line.headings] == pytest.approx([math.atan(0.1)] * len(line.headings))
    assert line.bound <= 0.01
    starts = motion((None, "2", "0.2"), start=("0", "2", "0", "0"))
    assert polyline.polyline_of(starts, F(2)).headings[0] == pytest.approx(math.atan(0.1))


@pytest.mark.parametrize(
    ("car", "message"),
    [
        (motion((None, "-6", "0")), "v_lon=-0.375 m/s: other tools want vehicles that drive forwards"),
        (motion((None, "0", "1"), start=("0", "2", "0", "-1")), "v_lon=0 m/s: other tools want"),
        (
            motion(("1", "-1", "-0.1"), (None, "1", "0"), start=("0", "2", "1", "0.1")),
            "turns where it all but stands, at 1 s",
        ),
        (
            motion(("1", "-0.999999", "0.001"), (None, "1", "0"), start=("0", "2", "1", "-0.0005")),
            "turns where it all but stands",
        ),
    ],
)
def test_vehicles_without_a_heading_are_refused(car: Motion, message: str) -> None:
    with pytest.raises(InputError, match=message):
        polyline.polyline_of(car, F(6))
