"""What is measured on a drive: a term, at the start or at a moment, and which way is better."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal, TypeAlias

from roadproof.engines.search.ask import Search
from roadproof.errors import UsageError
from roadproof.library.compose import both, comparison, eventually
from roadproof.library.elaborate import read_claim, read_term
from roadproof.library.specification import Query, Specification
from roadproof.logic.parse import parse_claim
from roadproof.logic.show import declared
from roadproof.logic.syntax import BinaryOperator, Binding, Expression
from roadproof.logic.terms import Dimension, Inverse, Term, Varying, leaves


def with_parts(query: Query, parts: Sequence[Query]) -> Query:
    """``query`` and all of ``parts``; as it was written where there are none."""
    return both(query, *parts) if parts else query


def compared(
    search: Search, left: Expression, op: BinaryOperator, value: Fraction, dimension: Dimension
) -> Query:
    """``left op value`` in the names that the search has, where ``value`` is in SI units of ``dimension``."""
    return comparison(search.specification, search.query.claim.given, left, op, value, dimension)


Sense: TypeAlias = Literal["least", "greatest"]


@dataclass(frozen=True)
class Measure:
    """The ``sense`` value of ``term``, at time 0 or at some ``moment`` at which that holds.

    ``text`` and ``when`` are how a user wrote term and moment; ``said`` is the term as a tree.
    """

    sense: Sense
    text: str
    said: Expression
    term: Term
    dimension: Dimension
    when: str = ""
    moment: Query | None = None

    @property
    def sign(self) -> int:
        """What turns a better value into a smaller one."""
        return 1 if self.sense == "least" else -1

    def bound(self, search: Search, value: Fraction | None) -> list[Query]:
        """That the measure is ``value`` or better (None: that there is a moment for it), as parts."""
        op: Literal["<=", ">="] = "<=" if self.sense == "least" else ">="
        here = [] if value is None else [compared(search, self.said, op, value, self.dimension)]
        return here if self.moment is None else [eventually(both(self.moment, *here))]


def read_measure(
    specification: Specification,
    sense: Sense,
    text: str,
    when: str = "",
    given: tuple[Binding, ...] = (),
) -> Measure:
    """A measure from what the user wrote, in the names that a formula has in its ``given``.

    Raises ``TextError``, and ``UsageError`` for what no drive changes.
    """
    head = declared(given)
    term, dimension = read_term(specification, head + text, f"--{sense}")
    if isinstance(term, Inverse):
        raise UsageError(f"--{sense} '{text}': 1/x may be infinite; ask for the other extreme of x")
    if not any(isinstance(leaf, Varying) for leaf in leaves(term)):
        raise UsageError(f"--{sense} '{text}': no drive changes this; name a signal, such as v_lon(SV)")
    moment = read_claim(specification, head + when, "--when") if when else None
    return Measure(sense, text, parse_claim(head + text).body, term, dimension, when, moment)
