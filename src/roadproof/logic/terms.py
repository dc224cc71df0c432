"""Terms: real-valued expressions over vehicle signals, sizes and parameters, in SI units.

A term is a tree of plain nodes. ``Inverse`` is 1/x with 1/0 = ∞ (paper, appendix *Robust Semantics*). It may
only be a whole side of a comparison; every other node is finite. The denominator of a ``Quotient`` has no
signals, so each term is a piecewise polynomial of signals.
"""

from collections.abc import Callable
from fractions import Fraction
from math import prod
from typing import TypeAlias, assert_never

from roadproof.logic.node import memoised, node
from roadproof.world.signals import SIGNAL_DIMENSIONS as SIGNAL_DIMENSIONS
from roadproof.world.signals import SIZE_DIMENSIONS as SIZE_DIMENSIONS
from roadproof.world.signals import SignalName as SignalName
from roadproof.world.signals import SizeName as SizeName
from roadproof.world.units import Dimension as Dimension


@node
class Number:
    """A rational constant, with its dimension so that it can be printed with a unit."""

    value: Fraction
    dimension: Dimension = (0, 0)


@node
class Parameter:
    """A named constant of the specification, such as ``rho``; the prover keeps it symbolic."""

    name: str
    dimension: Dimension = (0, 0)


@node
class Variable:
    """A real number that a claim quantifies over (``given v: m/s: …``), constant in time."""

    name: str
    dimension: Dimension = (0, 0)


@node
class Signal:
    """A quantity of a vehicle that varies with time (semantics §2: front-left corner, d to the left)."""

    name: SignalName
    vehicle: str


@node
class Size:
    """A constant quantity of a vehicle, greater than zero."""

    name: SizeName
    vehicle: str


@node
class CustomSignal:
    """A custom signal, declared with ``signal`` in a specification: of ``vehicle``, or of none ('').

    It is any function of time with values within ``low`` and ``high`` (SI; None is unbounded). If ``truth``,
    it is 0 or 1, and only ``logic.custom_names.signal_is_true`` compares it.
    """

    name: str
    vehicle: str
    dimension: Dimension = (0, 0)
    low: Fraction | None = None
    high: Fraction | None = None
    truth: bool = False

    @property
    def text(self) -> str:
        """The signal as it is written: ``jerk(SV)``, ``red``."""
        return f"{self.name}({self.vehicle})" if self.vehicle else self.name


@node
class Sum:
    terms: tuple["Term", ...]


@node
class Product:
    factors: tuple["Term", ...]


@node
class Power:
    base: "Term"
    exponent: int


@node
class Quotient:
    """``numerator / denominator``; the denominator has no signals and is not zero."""

    numerator: "Term"
    denominator: "Term"


@node
class Maximum:
    terms: tuple["Term", ...]


@node
class Minimum:
    terms: tuple["Term", ...]


@node
class Inverse:
    """1/x, and ∞ where x = 0."""

    term: "Term"


Term: TypeAlias = (
    Number
    | Parameter
    | Variable
    | Signal
    | Size
    | CustomSignal
    | Sum
    | Product
    | Power
    | Quotient
    | Maximum
    | Minimum
    | Inverse
)
Leaf: TypeAlias = Number | Parameter | Variable | Signal | Size | CustomSignal
Varying: TypeAlias = Signal | CustomSignal
"""The leaves that change with time."""


def number(value: Fraction | int, dimension: Dimension = (0, 0)) -> Number:
    """Return a rational constant."""
    return Number(Fraction(value), dimension)


def negate(term: Term) -> Term:
    """Return ``-term``, as a product with -1."""
    if isinstance(term, Number):
        return Number(-term.value, term.dimension)
    return Product((number(-1), term))


def subtract(left: Term, right: Term) -> Term:
    """Return ``left - right``."""
    return Sum((left, negate(right)))


def children(term: Term) -> tuple[Term, ...]:
    """Return the direct sub-terms of ``term``."""
    match term:
        case Number() | Parameter() | Variable() | Signal() | Size() | CustomSignal():
            return ()
        case Sum(terms) | Maximum(terms) | Minimum(terms):
            return terms
        case Product(factors):
            return factors
        case Power(base, _):
            return (base,)
        case Quotient(numerator, denominator):
            return (numerator, denominator)
        case Inverse(inner):
            return (inner,)
        case _:
            assert_never(term)


def with_children(term: Term, new: tuple[Term, ...]) -> Term:
    """Return ``term`` with its direct sub-terms replaced, in the order of ``children``."""
    match term:
        case Number() | Parameter() | Variable() | Signal() | Size() | CustomSignal():
            return term
        case Sum() | Product() | Maximum() | Minimum():
            return type(term)(new)
        case Power(_, exponent):
            return Power(new[0], exponent)
        case Quotient():
            return Quotient(new[0], new[1])
        case Inverse():
            return Inverse(new[0])
        case _:
            assert_never(term)


def leaves(term: Term) -> tuple[Leaf, ...]:
    """Return every leaf of ``term``, from left to right."""
    return (term,) if isinstance(term, Leaf) else _leaves_inside(term)


@memoised
def _leaves_inside(term: Term) -> tuple[Leaf, ...]:
    return tuple(leaf for child in children(term) for leaf in leaves(child))


def replace_leaves(term: Term, replace: Callable[[Leaf], Term]) -> Term:
    """Return ``term`` with each leaf replaced by ``replace(leaf)``."""
    if isinstance(term, Leaf):
        return replace(term)
    return with_children(term, tuple(replace_leaves(child, replace) for child in children(term)))


def replace_term(term: Term, old: Term, new: Term) -> Term:
    """Return ``term`` with every occurrence of ``old`` replaced by ``new``."""
    if term == old:
        return new
    return with_children(term, tuple(replace_term(child, old, new) for child in children(term)))


def constant_value(term: Term) -> Fraction | None:
    """Return the value of a term of numbers only, else None.

    >>> constant_value(Quotient(number(3), number(5)))
    Fraction(3, 5)
    """
    if isinstance(term, Number):
        return term.value
    return None if isinstance(term, Leaf | Inverse) else _constant_inside(term)


@memoised
def _constant_inside(term: Sum | Product | Power | Quotient | Maximum | Minimum) -> Fraction | None:
    values: list[Fraction] = []
    for child in children(term):
        value = constant_value(child)
        if value is None:
            return None
        values.append(value)
    match term:
        case Sum():
            return sum(values, Fraction(0))
        case Product():
            return prod(values, start=Fraction(1))
        case Power(_, exponent):
            return values[0] ** exponent
        case Quotient():
            return None if values[1] == 0 else values[0] / values[1]
        case Maximum():
            return max(values)
        case Minimum():
            return min(values)
        case _:
            assert_never(term)
