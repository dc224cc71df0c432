"""Exact polynomials of several variables with rational coefficients.

The encoders and the derivations that Coq checks share them. The judge has polynomials of time alone
(``semantics.exact.polynomial``), which are twice as fast (docs/adr/0037-two-kinds-of-polynomials.md).
"""

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction
from typing import Generic, TypeVar

from roadproof.runtime.records import dataclass

V = TypeVar("V")
W = TypeVar("W")


@dataclass(frozen=True)
class Polynomial(Generic[V]):
    """The sum Σ coefficient · monomial; a monomial is a sorted tuple of variables, with repetitions for
    powers.
    """

    terms: Mapping[tuple[V, ...], Fraction]

    def __add__(self, other: "Polynomial[V]") -> "Polynomial[V]":
        total = dict(self.terms)
        for monomial, factor in other.terms.items():
            total[monomial] = total.get(monomial, Fraction(0)) + factor
        return _tidy(total)

    def __mul__(self, other: "Polynomial[V]") -> "Polynomial[V]":
        total: dict[tuple[V, ...], Fraction] = {}
        for left, a in self.terms.items():
            for right, b in other.terms.items():
                monomial = tuple(sorted(left + right))  # type: ignore[type-var]
                total[monomial] = total.get(monomial, Fraction(0)) + a * b
        return _tidy(total)

    def scaled(self, factor: Fraction) -> "Polynomial[V]":
        return _tidy({m: c * factor for m, c in self.terms.items()})

    def __sub__(self, other: "Polynomial[V]") -> "Polynomial[V]":
        return self + other.scaled(Fraction(-1))

    @property
    def variables(self) -> set[V]:
        return {variable for monomial in self.terms for variable in monomial}

    @property
    def constant(self) -> Fraction:
        return self.terms.get((), Fraction(0))

    @property
    def degree(self) -> int:
        return max((len(m) for m in self.terms), default=0)

    def value(self, values: Callable[[V], Fraction]) -> Fraction:
        """Return the value at the point that ``values`` gives, a number for each variable."""
        total = Fraction(0)
        for monomial, factor in self.terms.items():
            for variable in monomial:
                factor *= values(variable)
            total += factor
        return total

    def substitute(self, by: Callable[[V], "Polynomial[W]"]) -> "Polynomial[W]":
        """Return the polynomial with each variable replaced by a polynomial."""
        total: dict[tuple[W, ...], Fraction] = {}
        for monomial, factor in self.terms.items():
            product: Polynomial[W] = constant(factor)
            for variable in monomial:
                product = product * by(variable)
            for m, c in product.terms.items():
                total[m] = total.get(m, Fraction(0)) + c
        return _tidy(total)


def _tidy(terms: dict[tuple[V, ...], Fraction]) -> Polynomial[V]:
    return Polynomial({m: c for m, c in terms.items() if c})


def constant(value: Fraction) -> "Polynomial[V]":
    """Return a polynomial without variables."""
    return Polynomial({(): value} if value else {})


def variable(name: V) -> Polynomial[V]:
    """Return the polynomial ``name``."""
    return Polynomial({(name,): Fraction(1)})


def affine(parts: Iterable[tuple[V, Fraction]], rest: Fraction = Fraction(0)) -> Polynomial[V]:
    """Return the polynomial Σ coefficient · variable + rest."""
    total: dict[tuple[V, ...], Fraction] = {(): rest}
    for name, factor in parts:
        total[(name,)] = total.get((name,), Fraction(0)) + factor
    return _tidy(total)
