"""Affine forms, squares split off, and conditions on either side of an inequality: small cases by hand."""

from fractions import Fraction

import pytest

from roadproof.engines.encode.circuit import All, AnyOf, Leaf, evaluate, nodes
from roadproof.engines.encode.polynomial import Inequality, affine, constant, variable
from roadproof.engines.solve.bounds import (
    ROUNDING,
    TOLERANCE,
    Affine,
    Bound,
    TooNonlinearError,
    approximate,
    loosened,
    split_squares,
    value_of,
)

BOX = [(-1.0, 3.0), (2.0, 5.0)]
FORM = Affine(((0, 2.0), (1, -1.0)), 0.5)


def test_affine_forms():
    assert FORM.range(BOX) == (2 * -1 - 5 + 0.5, 2 * 3 - 2 + 0.5)
    assert FORM.value([3.0, 4.0]) == 2.5
    assert FORM.scaled(-2.0) == Affine(((0, -4.0), (1, 2.0)), -1.0)
    assert FORM + Affine(((1, 3.0), (2, 1.0)), 1.0) == Affine(((0, 2.0), (1, 2.0), (2, 1.0)), 1.5)
    assert FORM.looseness(BOX) == TOLERANCE + ROUNDING * (0.5 + 2 * 3 + 5)


def test_a_loosened_box_keeps_single_values():
    (fixed, wide) = loosened([(7.0, 7.0), (-2.0, 3.0)])
    assert fixed == (7.0, 7.0)
    assert wide == (-2 - TOLERANCE - 2 * ROUNDING, 3 + TOLERANCE + 3 * ROUNDING)


def test_a_polynomial_is_an_affine_part_and_squares():
    x, y = variable(0), variable(1)
    polynomial = x * x + (x * y).scaled(Fraction(6)) + affine([(0, Fraction(-3))], Fraction(7))
    linear, squares = split_squares(Inequality(polynomial, False))
    assert linear == Affine(((0, -3.0),), 7.0)
    for point in ([0.0, 0.0], [1.0, 2.0], [-2.0, 3.5]):
        total = linear.value(point) + sum(factor * form.value(point) ** 2 for factor, form in squares)
        assert total == pytest.approx(value_of(Inequality(polynomial, False), point))
    assert value_of(Inequality(polynomial, False), [1.0, 2.0]) == 1 + 12 - 3 + 7
    with pytest.raises(TooNonlinearError):
        split_squares(Inequality(x * x * y, False))


@pytest.mark.parametrize(
    ("shift", "strict", "inner", "outer"),
    [
        (0, False, "true", "true"),
        (0, True, "leaf", "true"),
        (1, True, "true", "true"),
        (-1, False, "leaf", "leaf"),
        (-4, False, "leaf", "leaf"),
        (-4, True, "false", "leaf"),
        (-5, False, "false", "false"),
        (-5, True, "false", "false"),
    ],
)
def test_what_the_box_decides(shift: int, strict: bool, inner: str, outer: str):
    """The polynomial is x + 1 + shift on [-1, 3], so from shift to 4 + shift."""
    inequality = Inequality(affine([(0, Fraction(1))], Fraction(1 + shift)), strict, Fraction(1, 8))
    for side, expected in (("inner", inner), ("outer", outer)):
        made = approximate(inequality, BOX, side)
        found = (
            "leaf"
            if isinstance(made, Leaf)
            else "true"
            if made.parts == () and isinstance(made, All)
            else "false"
        )
        assert found == expected, side
        if isinstance(made, Leaf):
            slack = -made.content.affine.looseness(BOX)
            assert made.content.margin == (0.125 if side == "inner" else slack)


def bounds_of(polynomial, side, pieces):
    made = approximate(Inequality(polynomial, False), [(-2.0, 4.0)], side, pieces)
    return made, [node.content for node in nodes(made) if isinstance(node, Leaf)]


def test_a_tangent_is_below_a_square_and_a_secant_above():
    square = variable(0) * variable(0)
    low, high = square + constant(Fraction(-3)), square.scaled(Fraction(-1)) + constant(Fraction(9))
    assert bounds_of(low, "inner", 1)[1] == [Bound(Affine(((0, 2.0),), -1.0 - 3.0), 0.0)]
    assert bounds_of(high, "inner", 1)[1] == [Bound(Affine(((0, -2.0),), 9.0 - 8.0), 0.0)]
    (above,) = bounds_of(square + constant(Fraction(-9)), "outer", 1)[1]
    assert above.affine == Affine(((0, 2.0),), 8.0 - 9.0)
    assert above.margin == -above.affine.looseness([(-2.0, 4.0)])


def test_pieces_are_tangents_to_choose_from_and_windows():
    square = variable(0) * variable(0)
    made, tangents = bounds_of(square + constant(Fraction(-3)), "inner", 3)
    assert isinstance(made, AnyOf)
    assert [b.affine for b in tangents] == [Affine(((0, 2.0 * p),), -p * p - 3.0) for p in (-1.0, 1.0, 3.0)]
    made, windows = bounds_of(square.scaled(Fraction(-1)) + constant(Fraction(3)), "inner", 2)
    assert isinstance(made, AnyOf)
    ends = [(b.affine.terms, b.affine.constant) for b in windows if abs(b.affine.terms[0][1]) == 1.0]
    assert {(((0, 1.0),), -1.0), (((0, -1.0),), 1.0)} <= set(ends)


def test_windows_of_outer_secants_overlap():
    """At an end or a cut, a solver that is a little off finds a window; else it would say a wrong no."""
    made, _ = bounds_of(variable(0) * variable(0) + constant(Fraction(-1, 2)), "outer", 2)
    for x in (-2.0, 1 - TOLERANCE, 1.0, 1 + TOLERANCE, 4.0):
        assert evaluate(made, lambda bound, x=x: bound.affine.value([x]) >= bound.margin + TOLERANCE / 10)


def test_outer_tangents_are_all_asked_for():
    square = variable(0) * variable(0)
    made, bounds = bounds_of(square.scaled(Fraction(-1)) + constant(Fraction(2)), "outer", 3)
    assert isinstance(made, All)
    assert len(bounds) == 3


def test_a_square_of_one_value_is_a_number():
    square = variable(0) * variable(0)
    made = approximate(Inequality(square + constant(Fraction(-9)), False), [(3.0, 3.0)], "inner")
    assert isinstance(made, All)
    assert made.parts == ()
