"""Motion: exact integrators, right-continuous accelerations and jerks."""

from fractions import Fraction
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from examples import some
from planting import plant
from roadproof.errors import UsageError
from roadproof.world import drive as pieces
from roadproof.world.drive import Motion, Piece, motion_of, pieces_of
from roadproof.world.motion import advance, piece_starts, state_at

values = st.fractions(-5, 5, max_denominator=6)
durations = st.fractions(Fraction(1, 6), 3, max_denominator=6)


@st.composite
def motions(draw):
    accelerations = draw(st.lists(st.tuples(durations, values, values, values), max_size=3))
    pieces = [Piece(*drawn) for drawn in accelerations]
    state = [draw(values) for _ in range(4)]
    return Motion(Fraction(4), Fraction(2), *state, (*pieces, Piece(None, draw(values), draw(values))))


def before(motion, time):
    """The state at a time as the piece that lasts until then has it, whose acceleration may be another."""
    begun = [state for state in piece_starts(motion) if state.time < time or state.time == 0][-1]
    return advance(begun, time - begun.time)


@settings(max_examples=some(100), deadline=None, derandomize=True)
@given(motions(), st.fractions(0, 10, max_denominator=8), st.fractions(0, 10, max_denominator=8))
def test_within_a_piece_positions_are_areas_under_speeds(motion, one, other):
    knots = [state.time for state in piece_starts(motion)]
    times = sorted({one, other, *knots})
    for low, high in pairwise(times):
        begin, end, step = state_at(motion, low), state_at(motion, high), high - low
        # Simpson's rule is exact for quadratic speeds, the trapezoid rule for linear accelerations.
        middle = state_at(motion, (low + high) / 2)
        assert end.s - begin.s == step * (begin.v_lon + 4 * middle.v_lon + before(motion, high).v_lon) / 6
        assert end.d - begin.d == step * (begin.v_lat + end.v_lat) / 2
        assert end.v_lon - begin.v_lon == step * (begin.a_lon + before(motion, high).a_lon) / 2
        assert end.v_lat - begin.v_lat == step * begin.a_lat
        assert before(motion, high).a_lon - begin.a_lon == step * begin.j_lon


@settings(max_examples=50, deadline=None, derandomize=True)
@given(motions())
def test_a_knot_belongs_to_the_piece_that_begins_there(motion):
    starts = piece_starts(motion)
    told = [(p.a_lon, p.a_lat, p.j_lon) for p in motion.pieces]
    assert [(x.a_lon, x.a_lat, x.j_lon) for x in starts] == told
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


def test_written_out_with_jerk():
    """From 5 m/s at 3 m/s², which falls by 6 m/s³ to -9 m/s² within 2 s, and jumps to none."""
    pieces = (
        Piece(Fraction(2), Fraction(3), Fraction(0), Fraction(-6)),
        Piece(None, Fraction(0), Fraction(0)),
    )
    motion = Motion(*map(Fraction, (4, 2, 10, 1, 5, 0)), pieces)
    state = state_at(motion, Fraction(1))
    assert (state.s, state.v_lon, state.a_lon, state.j_lon) == (
        10 + 5 + Fraction(3, 2) - 1,
        5 + 3 - 3,
        -3,
        -6,
    )
    state = state_at(motion, Fraction(3))
    assert (state.s, state.v_lon, state.a_lon, state.j_lon) == (10 + 10 + 6 - 8 - 1, 5 + 6 - 12, 0, 0)


def test_the_last_piece_has_no_jerk():
    zero, one = Fraction(0), Fraction(1)
    for last in (Piece(None, zero, zero, one), Piece(None, one, zero, -one)):
        with pytest.raises(ValueError, match=r"j_lon=-?1 m/s\^3.*let a piece with j_lon=0 follow"):
            Motion(*(one for _ in range(6)), (last,))
    assert not Motion(*(one for _ in range(6)), (Piece(None, one, zero),)).has_jerk
    jerking = (Piece(one, zero, zero, one), Piece(None, one, zero))
    assert Motion(*(one for _ in range(6)), jerking).has_jerk


def test_there_is_nothing_before_the_start():
    motion = Motion(*(Fraction(1) for _ in range(6)), (Piece(None, Fraction(0), Fraction(0)),))
    with pytest.raises(UsageError, match="time=-1/2"):
        state_at(motion, Fraction(-1, 2))


# --- Pieces that are put together: at every time the accelerations are those that were given --------

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


@settings(max_examples=some(200), deadline=None, derandomize=True)
@given(entries, st.fractions(0, 12, max_denominator=6))
def test_accelerations_are_those_of_the_entries(entries, time):
    assert not disagreement(*entries, time)


def test_pieces_written_out():
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
    plant(
        monkeypatch, pieces, "pieces_of", "initial + j_lon * (time - ends_along[place] + duration)", "initial"
    )
    along, across = [(Fraction(2), Fraction(0), Fraction(1))], [(Fraction(1), Fraction(1))]
    assert disagreement(along, across, Fraction(3, 2))
