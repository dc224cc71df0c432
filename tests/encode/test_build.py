"""Whole problems: which drives are among their solutions."""

from fractions import Fraction

import pytest

from roadproof.engines.encode.build import NONE, Assumptions, encode_formula, frame, ground
from roadproof.engines.encode.circuit import evaluate
from roadproof.engines.encode.motion import Layout
from roadproof.engines.encode.unroll import Grid, unroll
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.world.models import load_road, load_vehicle

GRID = Grid(Fraction(1, 2), 4)
CARS = dict.fromkeys(("A", "B", "C"), load_vehicle("car"))
ROAD = load_road("main-2")
REACH = Assumptions().reach


def steady(layout, places):
    """Column values where each vehicle goes 20 m/s straight on from its place (s, d)."""
    values = {}
    for name, (s, d) in places.items():
        for k in range(layout.grid.steps + 1):
            state = {"s": s + 20 * k * layout.grid.dt, "d": d, "v_lon": 20, "v_lat": 0}
            values |= {layout.column(name, signal, k): Fraction(x) for signal, x in state.items()}
    return values


def build_problem(assumptions):
    """The problem of any drive at all."""
    layout = Layout(tuple(CARS), GRID)
    wanted = encode_formula(f.Truth(True), CARS, layout, assumptions)
    return frame(wanted, ROAD, CARS, layout, assumptions), layout


def is_solution(problem, values):
    for row in problem.rows:
        total = sum(factor * values[column] for column, factor in row.terms.items())
        if (row.low is not None and total < row.low) or (row.high is not None and total > row.high):
            return False
    if not all(c.low <= values[k] <= c.high for k, c in enumerate(problem.columns)):
        return False
    return evaluate(problem.circuit, lambda x: x.polynomial.value(lambda k: values[k]) >= x.margin)


@pytest.mark.parametrize(
    ("b", "c", "possible"),
    [
        ((30, 3), (-30, 3), True),
        ((REACH / 2, 3), (-REACH / 2, 3), True),
        ((REACH / 2, 3), (-REACH / 2 - 1, 3), False),  # B and C too far apart
        ((30, 3), (REACH + 1, 3), False),  # A and C
        ((30, 3), (REACH, 3), True),
        ((10, 3), (30, 3), False),  # less than 8 m from B to A
        ((10, 6), (30, 3), True),
        ((10, "21/5"), (30, 6), False),  # beside A, by less than 0.7 m
        ((30, 3), (-30, 8), False),  # off the road
    ],
)
def test_drives_within_the_reach_apart_and_on_the_road(b, c, possible):
    problem, layout = build_problem(Assumptions(natural=False))
    places = {"A": (0, Fraction(3)), "B": (b[0], Fraction(b[1])), "C": (c[0], Fraction(c[1]))}
    assert is_solution(problem, steady(layout, places)) == possible


def test_columns_across_end_where_the_road_does():
    """How strong a linear relaxation is follows from these."""
    problem, layout = build_problem(Assumptions())
    for name, car in CARS.items():
        column = problem.columns[layout.column(name, "d", 2)]
        assert (column.low, column.high) == (car.width, 7)


def test_what_holds_at_the_last_sample_holds_for_ever_unless_told_otherwise():
    layout = Layout(("A",), GRID)
    near = f.Compare(t.Signal("s", "A"), "<=", t.number(50))  # at 40 m at the end
    circuit = unroll(f.Always(f.Interval(t.number(0), None), near), GRID)
    values = steady(layout, {"A": (0, Fraction(3))})
    found = [
        evaluate(made, lambda x: x.polynomial.value(lambda k: values[k]) >= 0)
        for made in (ground(circuit, CARS, layout, NONE), ground(circuit, CARS, layout, NONE, False))
    ]
    assert found == [False, True]
