"""Reference points, by hand: a car of 4.5 m by 1.8 m whose front-left corner is at s = 10 m, d = 2.6 m."""

import math
from fractions import Fraction as F

import pytest

from exporting.kept import motion
from roadproof.recordings.export import points
from roadproof.world.motion import State, state_at

CAR = motion((None, "0", "0"))
STATE = state_at(CAR, F(0))


def test_the_centre_is_half_a_length_behind_and_half_a_width_to_the_right() -> None:
    assert points.centre(STATE, CAR.length, CAR.width) == (F("7.75"), F("1.7"))


def test_upper_left_is_the_rear_left_corner_of_a_box_that_drives_right_with_y_down() -> None:
    assert points.upper_left(STATE, CAR.length) == (F("5.5"), F("-2.6"))


def test_the_rear_axle_is_a_fifth_of_the_length_ahead_of_the_rear() -> None:
    assert points.axle_to_centre(CAR.length) == F("1.35")
    assert points.rear_axle(STATE, CAR, 0.0) == pytest.approx((5.5 + 0.9, 1.7))


def test_a_turned_box_is_turned_about_its_centre() -> None:
    x, y = points.rear_axle(STATE, CAR, math.pi / 2)
    assert (x, y) == pytest.approx((7.75, 1.7 - 1.35))


@pytest.mark.parametrize(
    ("v_lon", "v_lat", "turned"), [(30, 0, 0.0), (1, 1, math.pi / 4), (20, -2, -math.atan(0.1)), (0, 0, None)]
)
def test_the_heading_is_that_of_the_motion(v_lon: int, v_lat: int, turned: float | None) -> None:
    state = State(F(0), F(0), F(0), F(v_lon), F(v_lat), F(0), F(0), F(0))
    assert points.heading(state) == pytest.approx(turned)
