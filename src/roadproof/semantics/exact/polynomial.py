"""Polynomials in time with rational coefficients: integers over one common denominator.

One denominator keeps numbers small and arithmetic quick: each operation reduces once.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import comb, gcd, lcm


@dataclass(frozen=True, slots=True)
class TimePolynomial:
    """A polynomial Σ numerators[i]·tⁱ / denominator, reduced; zero is (), without trailing zeros."""

    numerators: tuple[int, ...]
    denominator: int

    @property
    def coefficients(self) -> tuple[Fraction, ...]:
        """Lowest power first."""
        return tuple(Fraction(n, self.denominator) for n in self.numerators)


def polynomial(*coefficients: Fraction | int) -> TimePolynomial:
    """Return the polynomial with these coefficients, lowest power first.

    >>> polynomial(Fraction(1, 2), 0, Fraction(1, 3))
    TimePolynomial(numerators=(3, 0, 2), denominator=6)
    """
    denominator = lcm(*(c.denominator for c in coefficients))
    return _reduced([c.numerator * (denominator // c.denominator) for c in coefficients], denominator)


ZERO = TimePolynomial((), 1)
ONE = TimePolynomial((1,), 1)


def add(left: TimePolynomial, right: TimePolynomial) -> TimePolynomial:
    """``left + right``."""
    return sum_of((left, right))


def sum_of(parts: Sequence[TimePolynomial]) -> TimePolynomial:
    """The sum of polynomials, of which there is at least one."""
    denominator = lcm(*[p.denominator for p in parts])
    total = [0] * max([len(p.numerators) for p in parts])
    for p in parts:
        factor = denominator // p.denominator
        for i, n in enumerate(p.numerators):
            total[i] += n * factor
    return _reduced(total, denominator)


def multiply(left: TimePolynomial, right: TimePolynomial) -> TimePolynomial:
    """``left * right``."""
    if not left.numerators or not right.numerators:
        return ZERO
    return _reduced(_times(left.numerators, right.numerators), left.denominator * right.denominator)


def negate(p: TimePolynomial) -> TimePolynomial:
    """``-p``."""
    return TimePolynomial(tuple(-n for n in p.numerators), p.denominator)


def shift(numerators: tuple[int, ...], by: Fraction) -> tuple[int, ...]:
    """A primitive polynomial whose roots are those of ``numerators`` plus ``by``.

    >>> shift((-2, 0, 1), Fraction(1, 2))  # roots ±√2 + 1/2
    (-7, -4, 4)
    """
    degree = len(numerators) - 1
    top, bottom = by.numerator, by.denominator
    moved = [0] * (degree + 1)
    for power, n in enumerate(numerators):
        # n·(t - top/bottom)^power · bottom^degree
        for i in range(power + 1):
            moved[i] += n * comb(power, i) * (-top) ** (power - i) * bottom ** (degree - power + i)
    return primitive(tuple(moved))


def primitive(numerators: tuple[int, ...]) -> tuple[int, ...]:
    """Return coefficients without common factor and with positive leading one; the roots are the same."""
    factor = gcd(*numerators)
    if factor and numerators[-1] < 0:
        factor = -factor
    return numerators if factor in (0, 1) else tuple(n // factor for n in numerators)


def sign_at(numerators: tuple[int, ...], x: Fraction) -> int:
    """Return the sign (-1, 0, 1) of an integer polynomial at a rational point."""
    top, bottom = x.numerator, x.denominator
    value, scale = 0, 1
    for n in reversed(numerators):
        value = value * top + n * scale
        scale *= bottom
    return (value > 0) - (value < 0)


HALVINGS = 3


def is_rootless(
    numerators: tuple[int, ...], low: Fraction, high: Fraction | None, halvings: int = HALVINGS
) -> bool:
    """Return whether Descartes' rule of signs shows that there is no root in [low, high], low < high.

    ``high`` None: in [low, ∞). True is a proof; False only says that the rule does not tell, nor of halves,
    quarters and eighths. With t = (low + high·x)/(1 + x), x >= 0 is the interval, and a polynomial in x whose
    coefficients have one sign, the first and the last not 0, has no root there (Collins and Akritas, SYMSAC
    1976).

    >>> is_rootless((-2, 0, 1), Fraction(0), Fraction(1)), is_rootless((-2, 0, 1), Fraction(1), Fraction(2))
    (True, False)
    """
    coefficients = _on_positive(numerators, low, high)
    if not coefficients or not coefficients[0] or not coefficients[-1]:
        return False
    sign = 1 if coefficients[0] > 0 else -1
    if all(x * sign >= 0 for x in coefficients):
        return True
    if high is None or not halvings or coefficients[-1] * sign < 0:
        return False
    middle = (low + high) / 2
    return is_rootless(numerators, low, middle, halvings - 1) and is_rootless(
        numerators, middle, high, halvings - 1
    )


def _on_positive(numerators: tuple[int, ...], low: Fraction, high: Fraction | None) -> list[int]:
    """Coefficients of a polynomial in x >= 0 that has the signs of ``numerators`` from low to high."""
    scale = lcm(low.denominator, high.denominator if high is not None else 1)
    at_low = low.numerator * (scale // low.denominator)
    top: tuple[int, ...]
    bottom: tuple[int, ...]
    if high is None:
        top, bottom = (at_low, scale), (scale,)
    else:
        top, bottom = (at_low, high.numerator * (scale // high.denominator)), (scale, scale)
    # Σ n·topⁱ·bottom^(degree - i), by Horner's rule
    coefficients: list[int] = []
    power: list[int] = [1]
    for n in reversed(numerators):
        coefficients = _times(coefficients, top)
        coefficients += [0] * (len(power) - len(coefficients))
        for i, x in enumerate(power):
            coefficients[i] += n * x
        power = _times(power, bottom)
    return coefficients


def _times(left: Sequence[int], right: Sequence[int]) -> list[int]:
    if not left:
        return []
    product = [0] * (len(left) + len(right) - 1)
    for i, x in enumerate(left):
        for j, y in enumerate(right):
            product[i + j] += x * y
    return product


def _reduced(numerators: list[int], denominator: int) -> TimePolynomial:
    while numerators and numerators[-1] == 0:
        numerators.pop()
    factor = gcd(denominator, *numerators)
    if factor != 1:
        return TimePolynomial(tuple(n // factor for n in numerators), denominator // factor)
    return TimePolynomial(tuple(numerators), denominator)
