"""Parts that are added to a formula, on trees: comparisons with a number, in the names of that formula."""

from collections.abc import Sequence
from fractions import Fraction

from roadproof.logic import syntax
from roadproof.logic.syntax import BinaryOperator, Expression
from roadproof.logic.terms import Dimension
from roadproof.searching.ask import Search
from roadproof.spec.compose import both
from roadproof.spec.elaborate import elaborate
from roadproof.spec.query import Query
from roadproof.units import SI


def with_parts(query: Query, parts: Sequence[Query]) -> Query:
    """``query`` and all of ``parts``; as it was written where there are none."""
    return both(query, *parts) if parts else query


def compared(
    search: Search, left: Expression, op: BinaryOperator, value: Fraction, dimension: Dimension
) -> Query:
    """``left op value`` in the names that the search has, where ``value`` is in SI units of ``dimension``."""
    said = syntax.Binary(op, left, quantity(value, dimension))
    return elaborate(search.specification, syntax.Claim(search.query.claim.given, said))


def quantity(value: Fraction, dimension: Dimension) -> Expression:
    """A number with its unit; where no unit has that dimension, a product of metres and seconds."""
    unit = SI.get(dimension)
    number: Expression = syntax.Literal_(abs(value), "" if unit in (None, "unitless") else unit or "")
    if unit is None:
        for power, base in zip(dimension, ("m", "s"), strict=True):
            for _ in range(abs(power)):
                number = syntax.Binary("*" if power > 0 else "/", number, syntax.Literal_(Fraction(1), base))
    return syntax.Prefix("-", number) if value < 0 else number


def unit_text(dimension: Dimension) -> str:
    """The unit in which values of ``dimension`` are printed; empty without dimension."""
    if dimension == (0, 0):
        return ""
    metres, seconds = dimension
    return SI.get(dimension) or f"m^{metres} s^{seconds}"
