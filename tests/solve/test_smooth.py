"""Convex programs: optima that are known, and inequalities near a point."""

import random
from fractions import Fraction

import pytest

from roadproof.engines.encode.problem import Row
from roadproof.engines.solve import smooth
from roadproof.engines.solve.bounds import Affine, Bound, value_of
from roadproof.engines.solve.smooth import Square, minimise, narrow, near
from roadproof.errors import MissingSolverError
from solve import small

BOX = [(-10.0, 10.0), (-10.0, 10.0)]
X, Y = Affine(((0, 1.0),), 0.0), Affine(((1, 1.0),), 0.0)


def test_a_least_square_within_rows_and_bounds():
    row = Row({0: Fraction(1), 1: Fraction(1)}, Fraction(4), Fraction(4))
    found = minimise([row], BOX, [Bound(X, 3.0)], [Square(1.0, X), Square(1.0, Y)])
    assert found == pytest.approx((3.0, 1.0), abs=1e-4)


def test_a_cost_beside_squares():
    found = minimise(
        [], BOX, [], [Square(0.5, X + Affine((), -1.0)), Square(1.0, Y)], Affine(((0, 2.0),), 0.0)
    )
    assert found == pytest.approx((-1.0, 0.0), abs=1e-4)


def test_a_cost_alone_ends_at_the_ends_of_the_box():
    found = minimise([], [(-1.0, 2.0), (-3.0, 4.0)], [], [], Affine(((0, -1.0), (1, 1.0)), 0.0))
    assert found == pytest.approx((2.0, -3.0), abs=1e-4)


def test_what_cannot_be_is_none():
    assert minimise([], BOX, [Bound(X, 3.0), Bound(X.scaled(-1.0), 0.0)], [Square(1.0, X)]) is None


def test_fixed_columns_stay():
    assert minimise([], [(2.0, 2.0), (-1.0, 1.0)], [], [Square(1.0, X), Square(1.0, Y)]) == pytest.approx(
        (2.0, 0.0), abs=1e-4
    )


def test_near_a_point_a_fact_is_approximated_from_inside():
    dice = random.Random(5)
    for _ in range(60):
        inequality = small.inequality(dice, True)
        point = [dice.uniform(-3, 3) for _ in range(small.COLUMNS)]
        box = narrow([(-4.0, 4.0)] * small.COLUMNS, point, [0.5] * small.COLUMNS)
        bound = near(inequality, point, box)
        for p in small.grid_of(box, 5):
            assert bound.affine.value(p) <= value_of(inequality, p) + 1e-9


def test_narrow_stays_inside_and_around():
    assert narrow([(0.0, 10.0), (0.0, 1.0)], [9.5, 1.0000001], [1.0, 5.0]) == [(8.5, 10.0), (0.0, 1.0)]


def test_a_missing_solver_is_named(monkeypatch):
    monkeypatch.setattr(smooth, "find_spec", lambda name: None)
    with pytest.raises(MissingSolverError, match="clarabel"):
        minimise([], BOX, [], [])
