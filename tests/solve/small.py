"""Small random problems, and bounds checked point by point."""

import random
from fractions import Fraction

from roadproof.engines.encode.problem import (
    Inequality,
    Leaf,
    Problem,
    RealColumn,
    Row,
    Unknown,
    all_of,
    any_of,
    evaluate,
)
from roadproof.engines.solve.bounds import affine_bounds, polynomial_value
from roadproof.engines.solve.exact import solve_exactly
from roadproof.runtime.budget import Effort
from roadproof.world.polynomial import affine, variable

COLUMNS = 3


def problems(count, quadratic=False, seed=1):
    """Problems of a few columns and a random circuit; thresholds lie between the corners of the box."""
    for number in range(count):
        yield problem(random.Random(seed * 1000 + number), quadratic)


def problem(dice, quadratic):
    columns = tuple(
        RealColumn(Unknown("x", "s", k), Fraction(-4), Fraction(dice.randint(1, 6))) for k in range(COLUMNS)
    )
    terms = {0: Fraction(1), 1: Fraction(-2), 2: Fraction(1)}
    rows = (Row(terms, Fraction(-3), Fraction(dice.randint(0, 4))),)
    return Problem(columns, rows, circuit(dice, 3, quadratic))


def circuit(dice, depth, quadratic):
    if depth == 0:
        return Leaf(inequality(dice, quadratic))
    parts = [circuit(dice, depth - 1, quadratic) for _ in range(dice.randint(2, 3))]
    return (all_of if depth % 2 else any_of)(parts)


def inequality(dice, quadratic):
    parts = [(k, Fraction(dice.randint(-3, 3))) for k in range(COLUMNS)]
    polynomial = affine(parts, Fraction(2 * dice.randint(-9, 3) + 1, 2))
    if quadratic:
        x, y = (variable(dice.randrange(COLUMNS)) for _ in range(2))
        polynomial = polynomial + (x * y).scaled(Fraction(dice.choice([-2, -1, 1, 2])))
    return Inequality(polynomial, dice.random() < 0.5)


def exactly(problem):
    return solve_exactly(problem, Effort(20).meter()).status


def grid_of(box, count=9):
    points = [[]]
    for low, high in box:
        points = [[*p, low + (high - low) * k / (count - 1)] for p in points for k in range(count)]
    return points


def approximation_holds(made, point):
    return evaluate(made, lambda bound: bound.affine.value(point) >= -1e-9)


def inner_is_safe(inequality, box, pieces=1):
    """Wherever the inner approximation holds, the inequality does."""
    made = affine_bounds(inequality, box, "inner", pieces)
    return all(polynomial_value(inequality, p) >= -1e-6 for p in grid_of(box) if approximation_holds(made, p))


def outer_is_safe(inequality, box, pieces=1):
    """Wherever the inequality holds, the outer approximation does."""
    made = affine_bounds(inequality, box, "outer", pieces)
    return all(approximation_holds(made, p) for p in grid_of(box) if polynomial_value(inequality, p) >= 0)
