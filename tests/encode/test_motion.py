"""Motions as columns and rows: what a drive does satisfies them, and nothing else does."""

from dataclasses import replace
from fractions import Fraction
from types import SimpleNamespace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from examples import some
from roadproof.engines.encode.build import Assumptions, inequality_at, inequality_from_last_sample
from roadproof.engines.encode.motion import ColumnLayout, encode_motions
from roadproof.engines.encode.place import move_one_way, rectangles, stay_apart, stay_on_road
from roadproof.engines.encode.problem import AnyOf, Inequality, LimitKind, Origin, evaluate
from roadproof.engines.encode.unroll import Grid
from roadproof.engines.search.shape import round_drive
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.motion import state_at
from roadproof.world.polynomial import affine, variable

quiet = settings(deadline=None, derandomize=True)
GRID = Grid(Fraction(1, 2), 4)
AT_END = Origin(LimitKind.START, 4)
CAR = load_vehicle("car")
WIDE = (Fraction(-1000), Fraction(1000))


def motions(natural=False, straight=()):
    cars = {"A": CAR, "B": CAR}
    places = dict.fromkeys(cars, WIDE)
    layout = ColumnLayout(tuple(cars), GRID)
    columns, rows = encode_motions(cars, layout, places, places, natural, Fraction(0), straight)
    return SimpleNamespace(layout=layout, columns=columns, rows=rows)


def columns_of(accelerations, speed=Fraction(25), s=Fraction(0), d=Fraction(3)):
    """Column values of one vehicle by the equations of motion, step by step."""
    states = [(s, d, speed, Fraction(0))]
    h = GRID.dt
    for a, b in accelerations:
        s, d, v, w = states[-1]
        states.append((s + v * h + a * h * h / 2, d + w * h + b * h * h / 2, v + a * h, w + b * h))
    return [x for signal in zip(*states, strict=True) for x in signal]


def satisfied(made, values):
    for row in made.rows:
        total = sum(factor * values[column] for column, factor in row.terms.items())
        if (row.low is not None and total < row.low) or (row.high is not None and total > row.high):
            return False
    return all(c.low <= v <= c.high for c, v in zip(made.columns, values, strict=True))


accelerations = st.lists(
    st.tuples(st.integers(-7, 4).map(Fraction), st.integers(-8, 8).map(lambda n: Fraction(n, 4))),
    min_size=4,
    max_size=4,
)


def test_a_column_stands_where_the_layout_says_and_knows_what_it_stands_for():
    made = motions(natural=True)
    told = [(column.of.vehicle, column.of.signal, column.of.step) for column in made.columns]
    assert [made.layout.column(*what) for what in told] == list(range(len(told)))
    assert len(set(told)) == len(told) == 2 * 4 * 5
    with pytest.raises(ValueError, match="signal=a_lon has no columns"):
        made.layout.column("A", "a_lon", 0)


@settings(quiet, max_examples=some(200))
@given(accelerations)
def test_rows_hold_exactly_for_motions_within_the_limits(made):
    values = columns_of(made) + columns_of([(Fraction(0), Fraction(0))] * 4)
    speeds = values[10:15]
    lateral = values[15:20]
    allowed = (
        all(-6 <= a <= 3 and -Fraction(3, 2) <= b <= Fraction(3, 2) for a, b in made)
        and all(15 <= v <= 40 for v in speeds)
        and all(abs(w) <= min(v / 10, Fraction(2)) for v, w in zip(speeds, lateral, strict=True))
    )
    assert satisfied(motions(), values) == allowed


@settings(quiet, max_examples=60)
@given(st.integers(0, 19), st.sampled_from([Fraction(1, 100), Fraction(-1, 7)]))
def test_any_position_that_is_not_driven_is_refused(column, shift):
    values = columns_of([(Fraction(1), Fraction(0))] * 4) + columns_of([(Fraction(0), Fraction(0))] * 4)
    assert satisfied(motions(), values)
    if column not in (15, 16, 17, 18, 19):
        values[column] += shift
        assert not satisfied(motions(), values)


def test_natural_motions_start_and_end_straight_and_do_not_jerk():
    calm = columns_of([(Fraction(1), Fraction(0))] * 4) * 2
    hard = (
        columns_of([(Fraction(3), Fraction(0)), (Fraction(-1), Fraction(0))] + [(Fraction(0),) * 2] * 2) * 2
    )
    drifting = columns_of([(Fraction(0), Fraction(1, 4))] * 4) * 2
    assert satisfied(motions(True), calm)
    assert satisfied(motions(), hard)
    assert not satisfied(motions(True), hard)
    assert satisfied(motions(), drifting)
    assert not satisfied(motions(True), drifting)
    assert not satisfied(motions(False, ("A",)), drifting)


@settings(quiet, max_examples=60)
@given(accelerations)
def test_a_rounded_drive_is_where_its_columns_say(made):
    layout = ColumnLayout(("A",), GRID)
    values = columns_of(made)
    exact = round_drive(layout, {"A": CAR}, values, None)
    near = round_drive(layout, {"A": CAR}, [float(v) for v in values])
    for k in range(5):
        state = state_at(exact.vehicles["A"], k * GRID.dt)
        rounded = state_at(near.vehicles["A"], k * GRID.dt)
        for signal in ("s", "d", "v_lon", "v_lat"):
            assert getattr(state, signal) == values[layout.column("A", signal, k)]
            assert abs(getattr(rounded, signal) - getattr(state, signal)) < Fraction(1, 100)
    assert state_at(exact.vehicles["A"], Fraction(5)).a_lon == 0


def test_an_acceleration_is_that_of_the_piece_which_begins():
    layout = ColumnLayout(("A",), GRID)
    values = columns_of([(Fraction(n), Fraction(0)) for n in (1, 2, 3, -1)])
    found = [layout.state("A", "a_lon", k).value(lambda c: values[c]) for k in range(5)]
    assert found == [1, 2, 3, -1, 0]


@settings(quiet, max_examples=some(200))
@given(st.integers(-3, 3), st.integers(-3, 3), st.integers(-2, 2), st.integers(-40, 40), st.booleans())
def test_a_fact_for_ever_stays_true(factor, square, constant, start, strict):
    layout = ColumnLayout(("A",), GRID)
    signal = ("A", "s")
    polynomial = affine([(signal, Fraction(factor))], Fraction(constant)) + (
        variable(signal) * variable(signal)
    ).scaled(Fraction(square))
    values = columns_of([(Fraction(0), Fraction(0))] * 4, Fraction(20), Fraction(start))
    circuit = inequality_from_last_sample(Inequality(polynomial, strict), layout, AT_END)

    def true(inequality):
        value = inequality.polynomial.value(lambda c: values[c])
        return value > 0 if inequality.strict else value >= 0

    if evaluate(circuit, true):
        end = values[layout.column("A", "s", 4)]
        for later in (0, Fraction(1, 10), 1, 7, 1000):
            value = polynomial.value(lambda _, at=end + 20 * later: at)
            assert value > 0 or (value == 0 and not strict)
    else:
        assert (
            true(inequality_at(Inequality(polynomial, strict), layout, AT_END)) is False
            or factor < 0
            or square != 0
        )


def test_rectangles_of_a_merge_cover_the_road_and_nothing_else():
    road = load_road("merge")
    found = rectangles(road.lanelets)
    assert ((None, None), (Fraction(0), Fraction(7))) in found
    assert ((Fraction(-100), Fraction(300)), (Fraction(-7, 2), Fraction(7))) in found
    assert len(found) == 2


@settings(quiet, max_examples=some(200))
@given(st.integers(-8, 8), st.integers(-8, 8))
def test_boxes_apart_are_those_that_do_not_overlap(ds, dd):
    layout = ColumnLayout(("A", "B"), GRID)
    still = [(Fraction(0), Fraction(0))] * 4
    shift = (Fraction(ds), 3 + Fraction(dd, 2))
    values = columns_of(still) + columns_of(still, Fraction(25), *shift)
    none = (Fraction(0), Fraction(0))
    for between in (True, False):
        circuit = stay_apart(layout, ("A", CAR), ("B", CAR), none, between)
        overlap = abs(shift[0]) < CAR.length and abs(shift[1] - 3) < CAR.width
        apart = evaluate(circuit, lambda inequality: inequality.polynomial.value(lambda c: values[c]) >= 0)
        assert apart != overlap


@pytest.mark.parametrize(("d", "on_road"), [("9/5", True), ("7", True), ("17/10", False), ("71/10", False)])
def test_the_box_stays_on_the_road(d, on_road):
    layout = ColumnLayout(("A",), GRID)
    values = columns_of([(Fraction(0), Fraction(0))] * 4, d=Fraction(d))
    circuit = stay_on_road(layout, load_road("main-2"), "A", CAR, True)
    assert (
        evaluate(circuit, lambda inequality: inequality.polynomial.value(lambda c: values[c]) >= 0) == on_road
    )


def test_a_merge_lane_must_be_left_before_it_ends():
    layout = ColumnLayout(("A",), GRID)
    values = columns_of([(Fraction(0), Fraction(0))] * 4, d=Fraction(-1))
    circuit = stay_on_road(layout, load_road("merge"), "A", CAR, True)
    assert not isinstance(circuit, AnyOf)
    assert not evaluate(circuit, lambda inequality: inequality.polynomial.value(lambda c: values[c]) >= 0)


@pytest.mark.parametrize(
    ("across", "one_way"),
    [
        ([0, 0, 0, 0], True),
        ([1, 0, 0, -1], True),
        ([-1, 0, 0, 1], True),
        ([1, -1, 0, -1], False),  # left, then right
        ([-1, 0, 0, 2], False),  # to the left at the last sample only
        ([1, 0, 0, -2], False),
    ],
)
def test_natural_drives_go_across_in_one_direction(across, one_way):
    values = columns_of([(Fraction(0), Fraction(b)) for b in across])
    circuit = move_one_way(ColumnLayout(("A",), GRID), "A")
    assert (
        evaluate(circuit, lambda inequality: inequality.polynomial.value(lambda c: values[c]) >= 0) == one_way
    )


def test_plain_manners_keep_what_is_not_a_matter_of_taste():
    assumptions = Assumptions(reach=Fraction(33), collisions=True, straight=frozenset({"A"}))
    assert assumptions.without_comfort() == replace(
        assumptions,
        natural=False,
        straight=frozenset(),
        margin=assumptions.without_comfort().margin,
        apart=assumptions.without_comfort().apart,
    )
