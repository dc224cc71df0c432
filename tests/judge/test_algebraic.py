"""Points in time against sympy and against squares of rationals."""

from fractions import Fraction
from itertools import pairwise, product

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from roadproof.semantics.exact.algebraic import Root, approximate, bounds, compare, decimal, moved, real_roots

small = st.integers(-6, 6)
rationals = st.fractions(-4, 4, max_denominator=12)


def as_sympy(numerators):
    x = sympy.Symbol("x")
    return sympy.Poly(list(reversed(numerators)), x)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.lists(small, min_size=1, max_size=5).filter(lambda c: c[-1] != 0))
def test_roots_are_all_there_with_their_multiplicities(numerators):
    found = real_roots(tuple(numerators))
    expected = sympy.real_roots(as_sympy(numerators)) if len(numerators) > 1 else []
    assert sum(multiplicity for _, multiplicity in found) == len(expected)
    flat = [point for point, multiplicity in found for _ in range(multiplicity)]
    for point, root in zip(flat, expected, strict=True):
        low, high = bounds(point, Fraction(1, 10**9))
        assert sympy.Rational(low.numerator, low.denominator) <= root
        assert root <= sympy.Rational(high.numerator, high.denominator)
        assert isinstance(point, Root) != bool(root.is_rational)
    assert all(a < b for (a, _), (b, _) in pairwise(found))


def square_root(n, sign=1):
    """±√n as a point."""
    roots = [point for point, _ in real_roots((-n, 0, 1))]
    return roots[1] if sign > 0 else roots[0]


@settings(max_examples=200, deadline=None, derandomize=True)
@given(rationals, st.integers(2, 12), rationals, st.integers(2, 12), st.sampled_from([1, -1]))
def test_order_of_shifted_square_roots(a, m, b, n, sign):
    left, right = moved(square_root(m, sign), a), moved(square_root(n), b)
    x = sympy.Rational(a.numerator, a.denominator) + sign * sympy.sqrt(m)
    y = sympy.Rational(b.numerator, b.denominator) + sympy.sqrt(n)
    expected = int(sympy.sign(sympy.simplify(x - y)))
    assert compare(left, right) == expected
    assert compare(right, left) == -expected
    assert (left == right, left < right, left <= right) == (expected == 0, expected < 0, expected <= 0)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(rationals, st.integers(2, 12), rationals)
def test_order_against_rationals(a, n, x):
    point = moved(square_root(n), a)
    gap = x - a
    if isinstance(point, Root):
        expected = gap < 0 or gap * gap < n
        assert (x < point, point > x, x <= point, point >= x) == (expected,) * 4
        assert x != point
    else:
        assert point == a + round(n**0.5)


def test_the_same_number_by_two_roads_is_equal_and_hashes_alike():
    direct = moved(square_root(2), Fraction(1, 3))
    again = moved(moved(square_root(2), Fraction(-5, 7)), Fraction(1, 3) + Fraction(5, 7))
    scaled = real_roots((-51, -18, 27))[1][0]  # 27x² - 18x - 51 = 3·((3x - 1)² - 18)
    assert direct == again == scaled
    assert hash(direct) == hash(again) == hash(scaled)
    assert direct != moved(square_root(2, -1), Fraction(1, 3))
    # A root of (x² - 2)(x³ - x - 1) is recognised as √2.
    assert square_root(2) in [point for point, _ in real_roots((2, 2, -1, -3, 0, 1))]


def test_numbers_that_agree_to_forty_digits_are_told_apart():
    n = 10**80
    near = moved(real_roots((-(n + 1), 0, 1))[1][0], -Fraction(10**40))
    assert near > 0
    assert near > Fraction(1, 2 * 10**40 + 1)
    assert near < Fraction(1, 2 * 10**40)
    other = moved(real_roots((-(n + 2), 0, 1))[1][0], -Fraction(10**40))
    assert near < other


def test_conjugates_are_ordered():
    for a, b, c in product(range(1, 4), range(-3, 4), range(-3, 0)):
        lower, upper = (point for point, _ in real_roots((c, b, a)))
        assert lower < upper


@pytest.mark.parametrize(
    ("point", "places", "shown"),
    [
        (Fraction(3, 5), 6, "0.6"),
        (Fraction(-3, 2), 6, "-1.5"),
        (Fraction(12), 6, "12"),
        (Fraction(100), 2, "100"),
        (Fraction(-1, 3), 3, "-0.333 ± 0.001"),
        (Fraction(1, 1000), 2, "0.00 ± 0.01"),
    ],
)
def test_decimals(point, places, shown):
    assert decimal(point, places) == shown


def test_decimal_of_a_root_keeps_its_bound():
    assert decimal(square_root(2), 6) == "1.414214 ± 0.000001"
    assert decimal(square_root(2, -1), 3) == "-1.414 ± 0.001"


def test_floats_for_pictures():
    assert approximate(square_root(2)) == pytest.approx(2**0.5, abs=1e-15)
    assert approximate(Fraction(3, 4)) == 0.75
