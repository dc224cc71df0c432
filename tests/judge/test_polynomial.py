"""Polynomials of integers over one denominator: values, signs and shifted roots, against plain fractions."""

import random
from fractions import Fraction
from itertools import pairwise, product

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from examples import some
from planting import plant
from roadproof.semantics.exact import polynomial as module
from roadproof.semantics.exact.algebraic import Root, as_float, bounds, compare, decimal, moved, real_roots
from roadproof.semantics.exact.polynomial import (
    ONE,
    ZERO,
    TimePolynomial,
    add,
    is_rootless,
    multiply,
    negate,
    polynomial,
    primitive,
    shift,
    sign_at,
)
from roadproof.semantics.exact.truth import (
    ALWAYS,
    NEVER,
    always,
    complement,
    eventually,
    from_switches,
    intersection,
    interval,
    union,
    until,
)
from tables import read_table

quiet = settings(max_examples=some(150), deadline=None, derandomize=True)
fractions = st.builds(Fraction, st.integers(-6, 6), st.integers(1, 4))
polynomials = st.lists(fractions, max_size=4).map(lambda found: polynomial(*found))
numerators = (
    st.lists(st.integers(-6, 6), min_size=1, max_size=4).filter(lambda found: found[-1] != 0).map(tuple)
)


def value(p: TimePolynomial, x: Fraction) -> Fraction:
    return sum((n * x**i for i, n in enumerate(p.numerators)), Fraction(0)) / p.denominator


@quiet
@given(polynomials, polynomials, fractions)
def test_operations_are_those_of_their_values(p: TimePolynomial, q: TimePolynomial, x: Fraction) -> None:
    assert value(add(p, q), x) == value(p, x) + value(q, x)
    assert value(multiply(p, q), x) == value(p, x) * value(q, x)
    assert value(negate(p), x) == -value(p, x)


@quiet
@given(polynomials)
def test_equal_polynomials_look_alike(p: TimePolynomial) -> None:
    twice = add(p, p)
    assert multiply(twice, polynomial(Fraction(1, 2))) == p
    assert add(p, negate(p)) == multiply(p, ZERO) == ZERO
    assert multiply(p, ONE) == add(p, ZERO) == p


@quiet
@given(numerators, fractions)
def test_the_sign_at_a_point(found: tuple[int, ...], x: Fraction) -> None:
    exact = value(TimePolynomial(found, 1), x)
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


@settings(max_examples=some(600), deadline=None, derandomize=True)
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
    read_table(__file__, "faults_in_the_rule_are_noticed"),
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


# --- Points in time against sympy and against squares of rationals ----------------------------------

small = st.integers(-6, 6)
rationals = st.fractions(-4, 4, max_denominator=12)


def as_sympy(numerators):
    x = sympy.Symbol("x")
    return sympy.Poly(list(reversed(numerators)), x)


@settings(max_examples=some(150), deadline=None, derandomize=True)
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


@settings(max_examples=some(200), deadline=None, derandomize=True)
@given(rationals, st.integers(2, 12), rationals, st.integers(2, 12), st.sampled_from([1, -1]))
def test_order_of_shifted_square_roots(a, m, b, n, sign):
    left, right = moved(square_root(m, sign), a), moved(square_root(n), b)
    x = sympy.Rational(a.numerator, a.denominator) + sign * sympy.sqrt(m)
    y = sympy.Rational(b.numerator, b.denominator) + sympy.sqrt(n)
    expected = int(sympy.sign(sympy.simplify(x - y)))
    assert compare(left, right) == expected
    assert compare(right, left) == -expected
    assert (left == right, left < right, left <= right) == (expected == 0, expected < 0, expected <= 0)


@settings(max_examples=some(200), deadline=None, derandomize=True)
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
    assert as_float(square_root(2)) == pytest.approx(2**0.5, abs=1e-15)
    assert as_float(Fraction(3, 4)) == 0.75


# --- Written-out cases of the operators on truth sets: ends, windows, until -------------------------

SQRT2 = real_roots((-2, 0, 1))[1][0]


def q(text):
    return Fraction(text)


def point(time):
    return interval(q(time), q(time))


def span(low, high, closed="[]"):
    return interval(q(low), None if high is None else q(high), closed)


def test_complement_swaps_open_and_closed():
    assert complement(span(1, 2, "[)")) == union([span(0, 1, "[)"), span(2, None)])
    assert complement(span(1, 2, "(]")) == union([span(0, 1), span(2, None, "()")])
    assert complement(point(0)) == span(0, None, "()")
    assert complement(ALWAYS) == NEVER
    assert complement(complement(point(3))) == point(3)


def test_touching_intervals_join_only_where_a_point_is_covered():
    assert union([span(0, 1, "[)"), span(1, 2)]) == span(0, 2)
    assert len(union([span(0, 1, "[)"), span(1, 2, "(]")]).spans()) == 2
    assert intersection([span(0, 1), span(1, 2)]) == point(1)
    assert intersection([span(0, 1, "[)"), span(1, 2)]) == NEVER
    assert intersection([]) == ALWAYS
    assert union([]) == NEVER


def test_switches_say_what_holds_at_and_after_each_point():
    made = from_switches([(q(0), True, False), (q(1), True, True), (q(2), False, True), (q(3), True, False)])
    assert made == union([point(0), span(1, 2, "[)"), span(2, 3, "(]")])
    assert [made.at(q(t)) for t in ("0", "1/2", "1", "2", "3", "4")] == [
        True,
        False,
        True,
        False,
        True,
        False,
    ]


def test_eventually_keeps_ends_as_they_are():
    assert eventually(q("1/2"), q(1), span(2, 3, "(]")) == span(1, "5/2", "(]")
    assert eventually(q("1/2"), q(1), span(2, 3, "[)")) == span(1, "5/2", "[)")
    assert eventually(q(1), None, span(2, 3, "[)")) == span(0, 2, "[)")
    assert eventually(q(1), q(1), span("1/2", 1, "[)")) == NEVER
    assert eventually(q(1), q(1), span("1/2", 1)) == point(0)


def test_a_single_instant_is_seen_by_a_window_that_ends_on_it():
    assert eventually(q(0), q(1), point(2)) == span(1, 2)
    assert always(q(0), q(1), complement(point(2))) == union([span(0, 1, "[)"), span(2, None, "()")])


def test_point_windows():
    for body in (point(2), span(0, 1, "[)"), span(1, None, "()")):
        assert always(q(0), q(0), body) == eventually(q(0), q(0), body) == body
        assert until(NEVER, q(0), q(0), body) == body


def test_unbounded_operators_look_at_what_lasts_for_ever():
    assert always(q(0), None, span(3, None)) == span(3, None)
    assert always(q(2), None, span(3, None, "()")) == span(1, None, "()")
    assert eventually(q(0), None, span(3, None)) == ALWAYS
    assert eventually(q(0), None, span(3, 4, "[)")) == span(0, 4, "[)")
    assert always(q(0), None, complement(point(7))) == span(7, None, "()")


def test_windows_that_end_on_an_irrational_root():
    reached = interval(SQRT2, None)
    passed = interval(SQRT2, None, "()")
    one = q(1)
    assert eventually(q(0), one, reached) == interval(moved(SQRT2, -one), None)
    assert eventually(q(0), one, passed) == interval(moved(SQRT2, -one), None, "()")
    at = moved(SQRT2, -one)
    assert eventually(q(0), one, reached).at(at)
    assert not eventually(q(0), one, passed).at(at)
    assert str(eventually(q(0), one, interval(SQRT2, SQRT2))) == "[0.414214 ± 0.000001, 1.414214 ± 0.000001]"


def test_until_reaches_over_the_open_end_of_left():
    # left on [0, 2), right only at 2: at every T in [0, 2) left holds at all times before 2.
    assert until(span(0, 2, "[)"), q(0), None, point(2)) == span(0, 2)
    # right only after 2: before each witness lie instants after 2, where left fails.
    assert until(span(0, 2, "[)"), q(0), None, span(2, 3, "(]")) == span(2, 3, "(]")
    assert until(span(0, 2), q(0), None, span(2, 3, "(]")) == span(2, 3, "(]")
    assert until(span(0, "5/2"), q(0), None, span(2, 3, "(]")) == span(0, 3)
    # left open at its beginning.
    assert until(span(1, 2, "()"), q(0), None, point(2)) == span(1, 2, "(]")


def test_until_at_simultaneous_switches():
    left, right = span(0, 1, "[)"), span(1, None)
    assert until(left, q(0), None, right) == ALWAYS
    assert until(left, q(0), q("1/2"), right) == span("1/2", None)
    assert until(span(0, 1, "[)"), q(0), None, span(1, None, "()")) == span(1, None, "()")


def test_until_asks_for_left_from_low_on_only():
    # At 0 left fails on [0, 1), outside the window [1, 3]: the classic until would say no.
    left, right = span(1, 2), point(2)
    assert until(left, q(1), q(3), right).at(q(0))
    classic = intersection([always(q(0), q(1), left), until(left, q(1), q(3), right)])
    assert not classic.at(q(0))
    # Left is not asked for when right holds where the window begins.
    assert until(NEVER, q(1), q(3), point(1)) == point(0)


def test_until_over_two_intervals_of_left():
    left = union([span(0, 1, "[)"), span(1, 2, "(]")])
    assert until(left, q(0), None, point(2)) == union([span(1, 2, "(]")])
    assert until(left, q(0), None, union([point(1), point(2)])) == span(0, 2)


@pytest.mark.parametrize(
    ("truth", "shown"),
    [
        (NEVER, "∅"),
        (ALWAYS, "[0, ∞)"),
        (point("3/2"), "{1.5}"),
        (union([span(0, 1, "[)"), span(2, 3, "(]"), span(4, None, "()")]), "[0, 1) ∪ (2, 3] ∪ (4, ∞)"),
    ],
)
def test_shown(truth, shown):
    assert str(truth) == shown
