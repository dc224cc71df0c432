"""Motion: exact double integrators, right-continuous accelerations."""

from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from roadproof.errors import UsageError
from roadproof.world.drive import Motion, Piece
from roadproof.world.motion import starts_of, state_at

values = st.fractions(-5, 5, max_denominator=6)
durations = st.fractions(Fraction(1, 6), 3, max_denominator=6)


@st.composite
def motions(draw):
    pieces = [Piece(draw(durations), draw(values), draw(values)) for _ in range(draw(st.integers(0, 3)))]
    state = [draw(values) for _ in range(4)]
    return Motion(Fraction(4), Fraction(2), *state, (*pieces, Piece(None, draw(values), draw(values))))


@settings(max_examples=100, deadline=None, derandomize=True)
@given(motions(), st.fractions(0, 10, max_denominator=8), st.fractions(0, 10, max_denominator=8))
def test_within_a_piece_positions_are_areas_under_speeds(motion, one, other):
    knots = [state.time for state in starts_of(motion)]
    times = sorted({one, other, *knots})
    for low, high in pairwise(times):
        begin, end, step = state_at(motion, low), state_at(motion, high), high - low
        # The trapezoid rule is exact for linear speeds, and speeds are linear between knots.
        assert end.s - begin.s == step * (begin.v_lon + end.v_lon) / 2
        assert end.d - begin.d == step * (begin.v_lat + end.v_lat) / 2
        assert end.v_lon - begin.v_lon == step * begin.a_lon
        assert end.v_lat - begin.v_lat == step * begin.a_lat


@settings(max_examples=50, deadline=None, derandomize=True)
@given(motions())
def test_a_knot_belongs_to_the_piece_that_begins_there(motion):
    starts = starts_of(motion)
    assert [(x.a_lon, x.a_lat) for x in starts] == [(p.a_lon, p.a_lat) for p in motion.pieces]
    assert starts[0].time == 0
    assert (starts[0].s, starts[0].d) == (motion.s, motion.d)
    assert (starts[0].v_lon, starts[0].v_lat) == (motion.v_lon, motion.v_lat)
    for state in starts:
        assert state_at(motion, state.time) == state
    assert [b.time - a.time for a, b in pairwise(starts)] == [p.duration for p in motion.pieces[:-1]]


def test_written_out():
    pieces = (Piece(Fraction(2), Fraction(3), Fraction(0)), Piece(None, Fraction(-1), Fraction(1, 2)))
    motion = Motion(Fraction(4), Fraction(2), Fraction(10), Fraction(1), Fraction(5), Fraction(0), pieces)
    state = state_at(motion, Fraction(4))
    assert (state.s, state.v_lon, state.a_lon) == (10 + 10 + 6 + 22 - 2, 9, -1)
    assert (state.d, state.v_lat, state.a_lat) == (2, 1, Fraction(1, 2))


def test_there_is_nothing_before_the_start():
    motion = Motion(*(Fraction(1) for _ in range(6)), (Piece(None, Fraction(0), Fraction(0)),))
    with pytest.raises(UsageError, match="time=-1/2"):
        state_at(motion, Fraction(-1, 2))
