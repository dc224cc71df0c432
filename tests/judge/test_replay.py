"""Replay: overlaps of boxes and breaches of limits, at their first instant."""

from dataclasses import dataclass
from fractions import Fraction

import pytest

from judge.test_exact import motion
from planting import plant
from roadproof.errors import UsageError
from roadproof.semantics.exact import replay
from roadproof.semantics.exact.algebraic import real_roots
from roadproof.semantics.exact.replay import first_breach, first_overlap, states_at
from roadproof.world.drive import Drive

ONE, TEN = Fraction(1), Fraction(10)


@dataclass(frozen=True)
class Car:
    v_lon: tuple = (Fraction(0), Fraction(50))
    v_lat: tuple = (Fraction(-2), Fraction(2))
    a_lon: tuple = (Fraction(-8), Fraction(4))
    a_lat: tuple = (Fraction(-2), Fraction(2))
    lateral_share: Fraction = Fraction(1, 10)


def test_states_are_exact():
    drive = Drive({"A": motion(1, 2, 3, 0, [(Fraction(1, 3), 3, 0)], last=(0, 6))})
    state = states_at(drive, Fraction(4, 3))["A"]
    assert (state.s, state.d) == (1 + 1 + Fraction(1, 6) + 4, 2 + 3)
    assert (state.v_lon, state.v_lat, state.a_lon, state.a_lat) == (4, 6, 0, 6)


def test_boxes_overlap_when_the_rear_one_catches_up():
    # The rear of B is at 14.5 m, A's front starts at 0 and gains 5 m/s: they touch at 2.9 s.
    drive = Drive({"A": motion(0, 2, 25), "B": motion(19, 2, 20)})
    found = first_overlap(drive, TEN)
    assert (found.first, found.second, found.time, found.after) == ("A", "B", Fraction(29, 10), True)
    assert "overlap from 2.9 s on" in str(found)
    assert first_overlap(drive, Fraction(29, 10)) is None  # touching is no overlap
    assert first_overlap(drive, Fraction(291, 100)) is not None
    assert first_overlap(drive, None) is not None


def test_boxes_beside_each_other_do_not_overlap():
    beside = Drive({"A": motion(0, 2, 25), "B": motion(19, 2 + Fraction(9, 5), 20)})
    assert first_overlap(beside, None) is None
    nearer = Drive({"A": motion(0, 2, 25), "B": motion(19, 2 + Fraction(179, 100), 20)})
    assert first_overlap(nearer, None).time == Fraction(29, 10)


def test_overlap_from_the_start_and_the_first_of_several():
    drive = Drive({"A": motion(0, 2), "B": motion(50, 2, -10), "C": motion(1, 3)})
    found = first_overlap(drive, TEN)
    assert (found.first, found.second, found.time, found.after) == ("A", "C", 0, False)


def test_an_irrational_overlap():
    # A gains t²/2 on the 1 m between the boxes.
    drive = Drive({"A": motion(0, 2, last=(1, 0)), "B": motion(Fraction(11, 2), 2)})
    assert first_overlap(drive, TEN).time == real_roots((-2, 0, 1))[1][0]


@pytest.mark.parametrize(
    ("state", "rule", "time", "after"),
    [
        ({"v_lon": 49, "last": (1, 0)}, "v_lon <= 50", 1, True),
        ({"v_lon": 4, "last": (-2, 0)}, "v_lon >= 0", 2, True),
        ({"v_lon": 20, "pieces": [(2, 0, 0), (1, 5, 0)]}, "a_lon <= 4", 2, False),
        ({"v_lon": 20, "pieces": [(2, 0, 0), (1, -9, 0)]}, "a_lon >= -8", 2, False),
        ({"v_lon": 30, "pieces": [(1, 0, 0), (1, 0, 3)]}, "a_lat <= 2", 1, False),
        ({"v_lon": 30, "last": (0, 1)}, "v_lat <= 2", 2, True),
        ({"v_lon": 30, "last": (0, -1)}, "v_lat >= -2", 2, True),
        ({"v_lon": 10, "v_lat": 1, "last": (-1, 0)}, "lateral_share|heading", 0, True),
        ({"v_lon": 10, "v_lat": -1, "last": (-1, 0)}, "lateral_share|heading", 0, True),
        ({"v_lon": 5, "v_lat": 1}, "heading", 0, False),
    ],
)
def test_a_breach_is_found_at_its_first_instant(state, rule, time, after):
    drive = Drive({"A": motion(**state)})
    found = first_breach(drive, {"A": Car()}, TEN)
    assert any(part in found.rule for part in rule.split("|"))
    assert (found.vehicle, found.time, found.after) == ("A", time, after)
    if after:
        assert first_breach(drive, {"A": Car()}, Fraction(time)) is None


HALF_A_ROOT = real_roots((1, -4, 2))[0][0]
"""1 - √2/2, the first root of 1 - 4·t + 2·t²."""


@pytest.mark.parametrize(
    ("state", "rule", "time"),
    [
        # 1 - 4·t + 2·t² for 2 s, then 1 again; with 2 its least is 0, which is no reversing.
        ({"v_lon": 1, "pieces": [(2, -4, 0, 4)]}, "v_lon >= 0", HALF_A_ROOT),
        ({"v_lon": 2, "pieces": [(2, -4, 0, 4)]}, None, None),
        # 48 + 4·t - 2·t² is 50 at its greatest; with 49 it passes 50 before it is 51.
        ({"v_lon": 48, "pieces": [(2, 4, 0, -4)]}, None, None),
        ({"v_lon": 49, "pieces": [(2, 4, 0, -4)]}, "v_lon <= 50", HALF_A_ROOT),
        # An acceleration that comes up to its limit where it jumps back; and two that pass it inside a piece.
        ({"v_lon": 20, "pieces": [(2, 0, 0, 2)]}, None, None),
        ({"v_lon": 20, "pieces": [(2, 0, 0, 3)]}, "a_lon <= 4", Fraction(4, 3)),
        ({"v_lon": 40, "pieces": [(3, 0, 0, -3)]}, "a_lon >= -8", Fraction(8, 3)),
        # |v_lat| = 1/2 is too much below 5 m/s, which 6 - 4·t + 2·t² is in the middle alone.
        ({"v_lon": 6, "v_lat": "1/2", "pieces": [(2, -4, 0, 4)]}, "heading", HALF_A_ROOT),
        ({"v_lon": 7, "v_lat": "1/2", "pieces": [(2, -4, 0, 4)]}, None, None),
    ],
)
def test_limits_hold_inside_pieces_with_jerk(state, rule, time):
    """At the samples none of these breaks anything."""
    found = first_breach(Drive({"A": motion(**state)}), {"A": Car()}, None)
    if rule is None:
        assert found is None
    else:
        assert (rule in found.rule, found.time, found.after) == (True, time, True)


def test_boxes_that_meet_under_jerk():
    """A gains t³/6 on the 1 m between the boxes, and is 0.33 m into B when its acceleration jumps to none."""
    pieces = [(2, 0, 0, 1)]
    drive = Drive({"A": motion(0, 2, pieces=pieces), "B": motion(Fraction(11, 2), 2)})
    assert first_overlap(drive, TEN).time == real_roots((-6, 0, 0, 1))[0][0]
    farther = Drive({"A": motion(0, 2, last=(0, 0), pieces=[(2, 0, 0, 1)]), "B": motion(6, 2, 2)})
    assert first_overlap(farther, None) is None  # 1.5 m are never gained: A is no faster than B in the end


def test_reversing_is_a_breach_even_where_the_range_allows_it():
    roomy = Car(v_lon=(Fraction(-5), Fraction(50)))
    assert "no reversing" in first_breach(Drive({"A": motion(v_lon=-1)}), {"A": roomy}, ONE).rule


def test_a_quiet_drive_breaks_nothing():
    drive = Drive({"A": motion(0, 2, 25, 0, [(2, 1, Fraction(1, 2)), (2, 1, Fraction(-1, 2))])})
    assert first_breach(drive, {"A": Car()}, None) is None


def test_wrong_questions():
    drive = Drive({"A": motion(), "B": motion(20)})
    with pytest.raises(UsageError, match="vehicle=B has no limits"):
        first_breach(drive, {"A": Car()}, ONE)
    with pytest.raises(UsageError, match="horizon=-1"):
        first_overlap(drive, -ONE)
    with pytest.raises(UsageError, match="time=-1"):
        states_at(drive, -ONE)


def horizon_is_kept():
    """What begins at the horizon is found, and what begins after it is not."""
    together = Drive({"A": motion(0, 2), "B": motion(1, 2)})
    meeting = Drive({"A": motion(0, 2, 25), "B": motion(19, 2, 20)})  # just after 2.9 s
    hard = Drive({"A": motion(0, 2, 25, 0, [(1, 0, 0)], last=(5, 0))})  # from 1 s on
    found = [first_overlap(together, Fraction(0)), first_breach(hard, {"A": Car()}, ONE)]
    missed = [first_overlap(meeting, Fraction(29, 10)), first_breach(hard, {"A": Car()}, Fraction(99, 100))]
    return None not in found and missed == [None, None]


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("begin > Cut(horizon, False)", "begin >= Cut(horizon, False)"),
        ("begin > Cut(horizon, False)", "begin > Cut(horizon, True)"),
        ("begin > Cut(horizon, False)", "begin.point > 2 * horizon"),
    ],
)
def test_faults_at_the_horizon_are_caught(right, wrong, monkeypatch):
    assert horizon_is_kept()
    plant(monkeypatch, replay, "_first", right, wrong)
    assert not horizon_is_kept()
