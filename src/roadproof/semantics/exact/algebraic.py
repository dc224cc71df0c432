"""Points in time: rational or irrational algebraic numbers, with exact comparison.

An irrational point is a root of an irreducible integer polynomial, isolated from its other roots by a
rational interval. Irreducible polynomials make equality simple: two points are equal when they have the
same primitive polynomial and one root of it lies in both intervals.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import isqrt
from typing import TypeAlias

from roadproof.semantics.exact.polynomial import primitive, shift, sign_at


@dataclass(frozen=True, slots=True, eq=False)
class Root:
    """The one root of ``polynomial`` in the open interval (low, high).

    ``polynomial``: integers, lowest power first, irreducible, primitive, degree >= 2, leading
    coefficient positive. It has no rational root, so no end of an interval is ever a root.
    """

    polynomial: tuple[int, ...]
    low: Fraction
    high: Fraction

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Root) and _compare_roots(self, other) == 0

    def __hash__(self) -> int:
        return hash(self.polynomial)

    def __lt__(self, other: "Point") -> bool:
        return compare(self, other) < 0

    def __le__(self, other: "Point") -> bool:
        return compare(self, other) <= 0

    def __gt__(self, other: "Point") -> bool:
        return compare(self, other) > 0

    def __ge__(self, other: "Point") -> bool:
        return compare(self, other) >= 0


Point: TypeAlias = Fraction | Root
CLOSED_FORM = 2  # the roots of polynomials up to this degree are written down, those of others are isolated


def compare(left: Point, right: Point) -> int:
    """Return -1, 0 or 1 as ``left`` is less than, equal to or greater than ``right``; exact."""
    if isinstance(left, Root):
        return _compare_roots(left, right) if isinstance(right, Root) else _compare_rational(left, right)
    if isinstance(right, Root):
        return -_compare_rational(right, left)
    return (left > right) - (left < right)


def moved(point: Point, by: Fraction) -> Point:
    """Return ``point + by``."""
    if not isinstance(point, Root):
        return point + by
    if by == 0:
        return point
    return Root(shift(point.polynomial, by), point.low + by, point.high + by)


def bounds(point: Point, width: Fraction) -> tuple[Fraction, Fraction]:
    """Return rationals low <= point <= high with high - low <= ``width`` (> 0)."""
    if not isinstance(point, Root):
        return point, point
    while point.high - point.low > width:
        point = _halved(point)
    return point.low, point.high


def as_float(point: Point) -> float:
    """Return a float near ``point``, for pictures; never for a decision."""
    low, high = bounds(point, Fraction(1, 2**60))
    return float((low + high) / 2)


def decimal(point: Point, places: int = 6) -> str:
    """A decimal with its bound, or the number alone where it is exact.

    >>> decimal(Fraction(3, 5)), decimal(Fraction(1, 3), 3)
    ('0.6', '0.333 ± 0.001')
    """
    unit = Fraction(1, 10**places)
    low, high = bounds(point, unit / 2)
    shown = round((low + high) / 2 / unit)
    sign, (whole, rest) = "-" if shown < 0 else "", divmod(abs(shown), 10**places)
    digits = f"{rest:0{places}d}".rstrip("0") if low == high == shown * unit else f"{rest:0{places}d}"
    text = f"{sign}{whole}" + (f".{digits}" if digits else "")
    return text if low == high == shown * unit else f"{text} ± {'0.' + '0' * (places - 1) + '1'}"


@lru_cache(maxsize=8192)
def real_roots(numerators: tuple[int, ...]) -> tuple[tuple[Point, int], ...]:
    """Return the distinct real roots of a nonzero integer polynomial, ascending, with multiplicities."""
    degree = len(numerators) - 1
    if degree <= 0:
        return ()
    if degree == 1:
        return ((Fraction(-numerators[0], numerators[1]), 1),)
    if degree == 2:
        return _quadratic_roots(numerators)
    return _roots_by_factoring(numerators)


def _quadratic_roots(numerators: tuple[int, ...]) -> tuple[tuple[Point, int], ...]:
    polynomial = primitive(numerators)
    c, b, a = polynomial
    discriminant = b * b - 4 * a * c
    if discriminant < 0:
        return ()
    if discriminant == 0:
        return ((Fraction(-b, 2 * a), 2),)
    root = isqrt(discriminant)
    if root * root == discriminant:
        return ((Fraction(-b - root, 2 * a), 1), (Fraction(-b + root, 2 * a), 1))
    # Narrow from the start, so that later comparisons seldom have to refine.
    bits = 64
    near = isqrt(discriminant << 2 * bits)
    below, width = -b << bits, 2 * a << bits
    lower = Root(polynomial, Fraction(below - near - 1, width), Fraction(below - near, width))
    upper = Root(polynomial, Fraction(below + near, width), Fraction(below + near + 1, width))
    return ((lower, 1), (upper, 1))


def _roots_by_factoring(numerators: tuple[int, ...]) -> tuple[tuple[Point, int], ...]:
    # sympy takes a third of a second to load, and degrees above 2 are rare.
    from sympy import Poly, Symbol

    roots: list[tuple[Point, int]] = []
    t = Symbol("t")
    _, factors = Poly(list(reversed(numerators)), t, domain="ZZ").factor_list()
    for factor, multiplicity in factors:
        integers = tuple(int(c) for c in reversed(factor.all_coeffs()))
        if len(integers) <= 3:
            roots += [(point, multiplicity) for point, _ in real_roots(integers)]
            continue
        polynomial = primitive(integers)
        for (low, high), _ in factor.intervals():
            ends = Fraction(int(low.p), int(low.q)), Fraction(int(high.p), int(high.q))
            roots.append((Root(polynomial, *ends), multiplicity))
    return tuple(sorted(roots, key=lambda entry: entry[0]))


def _compare_rational(root: Root, x: Fraction) -> int:
    if x <= root.low:
        return 1
    if x >= root.high:
        return -1
    return -1 if sign_at(root.polynomial, x) == sign_at(root.polynomial, root.high) else 1


def _compare_roots(left: Root, right: Root) -> int:
    if left is right or _same(left, right):
        return 0
    while True:
        if left.high <= right.low:
            return -1
        if right.high <= left.low:
            return 1
        left, right = _halved(left), _halved(right)


def _same(left: Root, right: Root) -> bool:
    if left.polynomial != right.polynomial:
        return False
    low, high = max(left.low, right.low), min(left.high, right.high)
    return low < high and sign_at(left.polynomial, low) != sign_at(left.polynomial, high)


def _halved(root: Root) -> Root:
    middle = (root.low + root.high) / 2
    if _compare_rational(root, middle) < 0:
        return Root(root.polynomial, root.low, middle)
    return Root(root.polynomial, middle, root.high)
