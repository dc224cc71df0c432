"""Polynomials of integers over one denominator: values, signs and shifted roots, against plain fractions."""

import random
from fractions import Fraction

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from planting import plant
from roadproof.semantics.exact import polynomial as module
from roadproof.semantics.exact.polynomial import (
    ONE,
    ZERO,
    Polynomial,
    add,
    is_rootless,
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


ends = st.tuples(fractions, st.one_of(st.none(), st.integers(1, 12).map(lambda n: Fraction(n, 4)))).map(
    lambda pair: (pair[0], None if pair[1] is None else pair[0] + pair[1])
)
longer = st.lists(st.integers(-9, 9), min_size=2, max_size=8).filter(lambda x: x[-1] != 0).map(tuple)


def roots_within(found: tuple[int, ...], low: Fraction, high: Fraction | None) -> int:
    p = sympy.Poly(list(reversed(found)), sympy.Symbol("t"))
    return int(p.count_roots(sympy.Rational(low), None if high is None else sympy.Rational(high)))


@settings(max_examples=600, deadline=None, derandomize=True)
@given(longer, ends)
def test_what_is_called_rootless_has_no_root(found: tuple[int, ...], pair: tuple[Fraction, None]) -> None:
    assert not (is_rootless(found, *pair) and roots_within(found, *pair))


def test_most_of_what_has_no_root_is_seen() -> None:
    dice = random.Random(5)
    rootless = seen = 0
    for _ in range(400):
        found = (*(dice.randint(-9, 9) for _ in range(6)), 1)
        low = Fraction(dice.randint(-8, 8), 4)
        high = low + Fraction(1, 2)
        rootless += not roots_within(found, low, high)
        seen += is_rootless(found, low, high)
    assert 0.9 * rootless < seen <= rootless < 400


@pytest.mark.parametrize(
    ("found", "low", "high"),
    [
        ((0, 1), 0, 1),
        ((-1, 1), 0, 1),
        ((-2, 0, 1), 1, 2),
        ((0, 0, 1), 0, None),
        ((1, -1), 0, None),
        ((), 0, 1),
    ],
)
def test_a_root_at_an_end_or_within_is_not_overlooked(found, low, high) -> None:
    assert not is_rootless(found, Fraction(low), None if high is None else Fraction(high))


@pytest.mark.parametrize(
    ("name", "right", "wrong"),
    [
        ("_on_positive", "(at_low, scale), (scale,)", "(at_low, scale), (1,)"),
        ("_on_positive", "(scale, scale)", "(scale,)"),
        ("_on_positive", "power = _times(power, bottom)", "pass"),
        ("is_rootless", "or not found[0] or not found[-1]", "or not found[0]"),
        ("is_rootless", "or not found[0] or not found[-1]", "or not found[-1]"),
        ("is_rootless", "all(x * sign >= 0 for x in found)", "found[-1] * sign > 0"),
        ("is_rootless", "is_rootless(numerators, low, middle, halvings - 1) and", ""),
        ("is_rootless", "numerators, middle, high, halvings - 1", "numerators, middle, middle, halvings - 1"),
    ],
)
def test_faults_in_the_rule_are_noticed(monkeypatch, name: str, right: str, wrong: str) -> None:
    dice = random.Random(6)
    cases = []
    for _ in range(400):
        found = (*(dice.randint(-3, 3) for _ in range(4)), dice.choice((-1, 1)))
        low = Fraction(dice.randint(-4, 4), dice.choice((1, 2, 3)))
        high = None if dice.random() < 0.4 else low + Fraction(dice.randint(1, 4), dice.choice((1, 2, 3)))
        cases.append((found, low, high))
    for eighths in range(1, 16):  # two roots that are near, anywhere
        near = multiply(
            polynomial(Fraction(-eighths, 16), 1), polynomial(Fraction(-eighths, 16) - Fraction(1, 40), 1)
        )
        cases.append((multiply(near, polynomial(1, 0, 1)).numerators, Fraction(0), Fraction(1)))
    has_root = [roots_within(*case) > 0 for case in cases]

    def noticed() -> bool:
        return any(module.is_rootless(*case) and there for case, there in zip(cases, has_root, strict=True))

    assert not noticed()
    plant(monkeypatch, module, name, right, wrong)
    assert noticed()
