"""Pieces that are put together: at every time the accelerations are those that were given."""

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from planting import plant
from roadproof.world import pieces
from roadproof.world.drive import Piece
from roadproof.world.motion import state_at
from roadproof.world.pieces import motion_of, pieces_of

values = st.fractions(-5, 5, max_denominator=6)
durations = st.fractions(Fraction(1, 6), 3, max_denominator=6)
entries = st.tuples(
    st.lists(st.tuples(durations, values, values), max_size=4),
    st.lists(st.tuples(durations, values), max_size=4),
)
BOX, START = (Fraction(4), Fraction(2)), (Fraction(0), Fraction(0))


def said(entries, time):
    """Acceleration and jerk of the entry that has begun, by walking through them."""
    for duration, acceleration, *jerk in entries:
        if time < duration:
            return acceleration + sum(jerk) * time, sum(jerk)
        time -= duration
    return 0, 0


def disagreement(along, across, time):
    state = state_at(motion_of(BOX, START, START, along, across), time)
    return (state.a_lon, state.j_lon, state.a_lat) != (*said(along, time), said(across, time)[0])


@settings(max_examples=200, deadline=None, derandomize=True)
@given(entries, st.fractions(0, 12, max_denominator=6))
def test_accelerations_are_those_of_the_entries(entries, time):
    assert not disagreement(*entries, time)


def test_written_out():
    along = [(Fraction(1), Fraction(0), Fraction(-2)), (Fraction(2), Fraction(-2), Fraction(0))]
    assert pieces_of(along, [(Fraction(2), Fraction(1))]) == (
        Piece(Fraction(1), Fraction(0), Fraction(1), Fraction(-2)),
        Piece(Fraction(1), Fraction(-2), Fraction(1)),
        Piece(Fraction(1), Fraction(-2), Fraction(0)),
        Piece(None, Fraction(0), Fraction(0)),
    )
    assert pieces_of([]) == (Piece(None, Fraction(0), Fraction(0)),)


@pytest.mark.parametrize("entries", [([(0, 1, 1)], []), ([(1, 1, 1)], [(-1, 0)])])
def test_a_duration_is_above_zero(entries):
    with pytest.raises(ValueError, match=r"duration=(0|-1) s: every duration is above 0"):
        pieces_of(*entries)


def test_an_acceleration_that_begins_anew_where_the_other_direction_changes_is_noticed(monkeypatch):
    plant(monkeypatch, pieces, "pieces_of", "begun + j_lon * (time - ends_along[place] + duration)", "begun")
    along, across = [(Fraction(2), Fraction(0), Fraction(1))], [(Fraction(1), Fraction(1))]
    assert disagreement(along, across, Fraction(3, 2))
