"""Straight lines between vertices against the exact motion, at many times between them."""

import math
from fractions import Fraction as F
from itertools import pairwise

import pytest

from exporting.kept import SMOOTH, TURN, WEAVING, kept, motion, subject
from planting import plant
from roadproof.errors import InputError
from roadproof.recordings.export import openscenario, polyline
from roadproof.recordings.export.layout import span_of
from roadproof.recordings.export.points import axle_to_centre, centre, heading, rear_axle
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
    "car",
    [TURN, HARD, SMOOTH, WEAVING, *(m for f in [*kept().values()][::6] for m in f.drive.vehicles.values())],
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


@pytest.mark.parametrize("car", [TURN, HARD, SMOOTH, WEAVING])
def test_planted_fault_too_few_vertices_are_noticed(car: Motion) -> None:
    line = polyline.polyline_of(car, F(6))
    assert worst(line.vertices[::4], car) > 0.01


@pytest.mark.parametrize("car", [TURN, HARD, SMOOTH])
def test_planted_fault_a_bound_without_the_turning_would_be_broken_or_loose(car: Motion) -> None:
    """The bound is no guess: it is above what is so, and within a few times of it."""
    line = polyline.polyline_of(car, F(6))
    assert line.bound / 4 < worst(line.vertices, car) <= line.bound


def test_a_bound_has_the_greatest_acceleration_between_its_vertices() -> None:
    """From none to -6 m/s²: the last line is the one that is farthest from the drive, and near its bound."""
    car = motion(("2", "0", "0", "-3"), (None, "0", "0"))
    line = polyline.polyline_of(car, F(2))
    assert line.bound * 0.8 < worst(line.vertices, car) <= line.bound <= 0.01


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("for x in (state, end))", "for x in (state,))"),
        ("max(abs(state.v_lat), abs(end.v_lat))", "0"),
        ("max(abs(state.v_lat), abs(end.v_lat))", "abs(state.v_lat) / 10"),
        ("+ swerving / slowest**2", ""),
    ],
)
def test_planted_fault_a_bound_that_forgets_jerk_is_broken(
    monkeypatch: pytest.MonkeyPatch, right: str, wrong: str
) -> None:
    cars = [
        motion(("2", "0", "0", "-3"), (None, "0", "0")),
        motion(("1", "0", "0", "60"), (None, "0", "0"), start=("0", "2", "10", "3"), size=("400", "2")),
        motion(("1", "0", "3", "60"), (None, "0", "0"), start=("0", "2", "10", "0"), size=("400", "2")),
    ]

    def broken() -> bool:
        made = [(car, polyline.polyline_of(car, F(1), 0.01)) for car in cars]
        return any(worst(line.vertices, car) > line.bound + 1e-12 for car, line in made)

    assert not broken()
    plant(monkeypatch, polyline, "_part", right, wrong)
    assert broken()


def test_speeds_accelerations_and_headings_between_vertices_are_within_what_is_said() -> None:
    for car in (SMOOTH, WEAVING, HARD, TURN):
        line = polyline.polyline_of(car, F(4))
        states = [state_at(car, F(k, 200)) for k in range(801)]
        assert max(x.v_lon for x in states) <= max(x.v_lon for x in line.vertices)
        assert min(x.v_lon for x in states) >= min(x.v_lon for x in line.vertices)
        assert min(line.pulls) <= min(x.a_lon for x in states)
        assert max(x.a_lon for x in states) <= max(line.pulls)
        turned = max(abs(heading(x) or 0.0) for x in states)
        assert turned <= line.turned <= 1.2 * turned


def test_an_acceleration_that_is_reached_only_before_a_jump_counts() -> None:
    car = motion(("2", "0", "0", "6"), (None, "0", "0"))
    assert max(polyline.polyline_of(car, F(3)).pulls) == 12
    assert b'maxAcceleration="12"' in openscenario.files(subject(SV=car))["made.xosc"]


def test_a_speed_that_is_greatest_inside_a_piece_counts() -> None:
    """From 30 m/s at 10 m/s², which falls by 10 m/s³: 35 m/s after 1 s, 30 m/s again after 2 s."""
    car = motion(("2", "10", "0", "-10"), (None, "0", "0"))
    assert b'maxSpeed="45"' in openscenario.files(subject(SV=car))["made.xosc"]
    fast = motion(("2", "30", "0", "-30"), (None, "0", "0"))  # 45 m/s are 162 km/h
    assert b'max="170"' in openscenario.files(subject(SV=fast))["made.xodr"]


@pytest.mark.parametrize("starts", ["1", "0.99"])
def test_a_vehicle_that_goes_back_inside_a_piece_is_refused(starts: str) -> None:
    """v = 1 - 2·t + t² touches 0 after 1 s; from less it falls below."""
    car = motion(("2", "-2", "0", "2"), (None, "0", "0"), start=("0", "2", starts, "0"))
    if starts == "1":
        assert min(x.v_lon for x in polyline.polyline_of(car, F(3)).vertices) == 0
        return
    with pytest.raises(InputError, match=r"at 1 s a vehicle has v_lon=-0\.01 m/s"):
        polyline.polyline_of(car, F(3))


def test_the_road_reaches_as_far_as_a_vehicle_goes_back() -> None:
    """v = -1 + t²/2: the front is least at √2 s, and the road is cut a margin before its rear there."""
    car = motion(("4", "0", "0", "1"), (None, "0", "0"), start=("0.4428", "2.6", "-1", "0"))
    low, high = span_of([car], F(4))
    least = -(2**0.5) * 2 / 3 + 0.4428
    assert float(low) == pytest.approx(least - 4.5, abs=1e-9)
    assert high == state_at(car, F(4)).s


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
