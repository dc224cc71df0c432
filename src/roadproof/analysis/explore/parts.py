"""Parts that are added to a formula, on trees: comparisons with a number, in the names of that formula."""

from collections.abc import Sequence
from fractions import Fraction

from roadproof.engines.search.ask import Search
from roadproof.library.compose import both, comparison
from roadproof.library.query import Query
from roadproof.logic.syntax import BinaryOperator, Expression
from roadproof.logic.terms import Dimension


def with_parts(query: Query, parts: Sequence[Query]) -> Query:
    """``query`` and all of ``parts``; as it was written where there are none."""
    return both(query, *parts) if parts else query


def compared(
    search: Search, left: Expression, op: BinaryOperator, value: Fraction, dimension: Dimension
) -> Query:
    """``left op value`` in the names that the search has, where ``value`` is in SI units of ``dimension``."""
    return comparison(search.specification, search.query.claim.given, left, op, value, dimension)
