"""Polynomials of integers over one denominator: values, signs and shifted roots, against plain fractions."""

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from roadproof.judge.polynomial import (
    ONE,
    ZERO,
    Polynomial,
    add,
    multiply,
    negate,
    polynomial,
    primitive,
    shift,
    sign_at,
)

quiet = settings(max_examples=150, deadline=None, derandomize=True)
fractions = st.builds(Fraction, st.integers(-6, 6), st.integers(1, 4))
polynomials = st.lists(fractions, max_size=4).map(lambda found: polynomial(*found))
numerators = (
    st.lists(st.integers(-6, 6), min_size=1, max_size=4).filter(lambda found: found[-1] != 0).map(tuple)
)


def value(p: Polynomial, x: Fraction) -> Fraction:
    return sum((n * x**i for i, n in enumerate(p.numerators)), Fraction(0)) / p.denominator


@quiet
@given(polynomials, polynomials, fractions)
def test_operations_are_those_of_their_values(p: Polynomial, q: Polynomial, x: Fraction) -> None:
    assert value(add(p, q), x) == value(p, x) + value(q, x)
    assert value(multiply(p, q), x) == value(p, x) * value(q, x)
    assert value(negate(p), x) == -value(p, x)


@quiet
@given(polynomials)
def test_equal_polynomials_look_alike(p: Polynomial) -> None:
    twice = add(p, p)
    assert multiply(twice, polynomial(Fraction(1, 2))) == p
    assert add(p, negate(p)) == multiply(p, ZERO) == ZERO
    assert multiply(p, ONE) == add(p, ZERO) == p


@quiet
@given(numerators, fractions)
def test_the_sign_at_a_point(found: tuple[int, ...], x: Fraction) -> None:
    exact = value(Polynomial(found, 1), x)
    assert sign_at(found, x) == (exact > 0) - (exact < 0)


@pytest.mark.parametrize(("x", "sign"), [(2, -1), (3, 0), (4, 1), (-4, 1), (-3, 0), (Fraction(1, 7), -1)])
def test_the_sign_beside_and_at_a_root(x: Fraction, sign: int) -> None:
    assert sign_at((-9, 0, 1), Fraction(x)) == sign


@quiet
@given(numerators, fractions, fractions)
def test_shifted_roots(found: tuple[int, ...], by: Fraction, x: Fraction) -> None:
    moved = shift(found, by)
    assert abs(sign_at(moved, x + by)) == abs(sign_at(found, x))
    assert moved == primitive(moved)


@pytest.mark.parametrize(
    ("found", "plain"), [((4, -2), (-2, 1)), ((0, 6, 3), (0, 2, 1)), ((3, 5), (3, 5)), ((0,), (0,)), ((), ())]
)
def test_primitive(found: tuple[int, ...], plain: tuple[int, ...]) -> None:
    assert primitive(found) == plain
