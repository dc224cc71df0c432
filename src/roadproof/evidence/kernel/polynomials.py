"""Polynomials with rational coefficients over numbered variables, and as Products.v has them."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeAlias

# Variables with their exponents, in order; the empty one is 1.
Monomial: TypeAlias = tuple[tuple[int, int], ...]


def times(one: Monomial, other: Monomial) -> Monomial:
    """The product of two monomials."""
    found = dict(one)
    for variable, exponent in other:
        found[variable] = found.get(variable, 0) + exponent
    return tuple(sorted(found.items()))


@dataclass(frozen=True)
class Polynomial:
    """Coefficients by monomial, none of them 0."""

    parts: Mapping[Monomial, Fraction] = field(default_factory=dict)

    def __add__(self, other: "Polynomial") -> "Polynomial":
        found = dict(self.parts)
        for monomial, factor in other.parts.items():
            found[monomial] = found.get(monomial, Fraction(0)) + factor
        return Polynomial({m: q for m, q in found.items() if q})

    def __sub__(self, other: "Polynomial") -> "Polynomial":
        return self + other * constant(Fraction(-1))

    def __mul__(self, other: "Polynomial") -> "Polynomial":
        found: dict[Monomial, Fraction] = {}
        for m, p in self.parts.items():
            for n, q in other.parts.items():
                monomial = times(m, n)
                found[monomial] = found.get(monomial, Fraction(0)) + p * q
        return Polynomial({m: q for m, q in found.items() if q})

    @property
    def variables(self) -> set[int]:
        return {variable for m in self.parts for variable, _ in m}


def constant(value: Fraction) -> Polynomial:
    """A number."""
    return Polynomial({(): value} if value else {})


def variable(number: int) -> Polynomial:
    """The variable of that number, from 1."""
    return Polynomial({((number, 1),): Fraction(1)})


def coq(polynomial: Polynomial) -> str:
    """As a term of Products.v."""
    shown = [_product(m, q) for m, q in sorted(polynomial.parts.items())] or ["(c_ 0 1)"]
    found = shown[0]
    for part in shown[1:]:
        found = f"(add_ {found} {part})"
    return found


def _product(monomial: Monomial, factor: Fraction) -> str:
    shown = list(_factors(monomial, factor))
    found = shown[0]
    for part in shown[1:]:
        found = f"(mul_ {found} {part})"
    return found


def _factors(monomial: Monomial, factor: Fraction) -> Iterator[str]:
    if factor != 1 or not monomial:
        top = str(factor.numerator) if factor >= 0 else f"({factor.numerator})"
        yield f"(c_ {top} {factor.denominator})"
    for variable, exponent in monomial:
        yield from [f"(x_ {variable})"] * exponent
