"""Writes a problem exactly as an integer program, for refutation trees that others can check."""

import math
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import assert_never

from roadproof.engines.encode.problem import All, AnyOf, ColumnInequality, Leaf, Problem, nodes
from roadproof.evidence.program import Conjunction, Disjunction, DisjunctiveProgram, Linear, Node


def integer_program(problem: Problem) -> DisjunctiveProgram | None:
    """Return the problem in integers; None where an inequality has a degree above 2."""
    writer = _Writer(len(problem.columns))
    equal: list[Linear] = []
    above: list[Linear] = []
    for row in problem.rows:
        terms: dict[tuple[int, ...], Fraction] = {(column,): factor for column, factor in row.terms.items()}
        if row.low is not None and row.low == row.high:
            equal.append(writer.linear(terms, -row.low))
            continue
        if row.low is not None:
            above.append(writer.linear(terms, -row.low))
        if row.high is not None:
            above.append(writer.linear({c: -factor for c, factor in terms.items()}, row.high))
    written = _nodes(problem, writer)
    if written is None:
        return None
    ends = [(column.low, column.high) for column in problem.columns]
    scale = math.lcm(*(end.denominator for pair in ends for end in pair))
    box = tuple((int(low * scale), int(high * scale)) for low, high in ends)
    return DisjunctiveProgram(scale, box, tuple(writer.products), tuple(equal), tuple(above), written)


def _nodes(problem: Problem, writer: "_Writer") -> tuple[Node, ...] | None:
    numbers: dict[int, int] = {}
    written: list[Node] = []
    for node in nodes(problem.circuit):
        match node:
            case Leaf(inequality):
                if _degree(inequality) > 2:
                    return None
                polynomial = inequality.polynomial
                terms = {m: factor for m, factor in polynomial.terms.items() if m}
                written.append(replace(writer.linear(terms, polynomial.constant), strict=inequality.strict))
            case All(parts):
                written.append(Conjunction(tuple(numbers[id(p)] for p in parts)))
            case AnyOf(parts):
                written.append(Disjunction(tuple(numbers[id(p)] for p in parts)))
            case _:
                assert_never(node)
        numbers[id(node)] = len(written) - 1
    return tuple(written)


def _degree(inequality: ColumnInequality) -> int:
    return max((len(monomial) for monomial in inequality.polynomial.terms), default=0)


class _Writer:
    """A writer of degree-2 polynomials as linear expressions, with a column for each product."""

    def __init__(self, columns: int) -> None:
        self.columns = columns
        self.products: dict[tuple[int, int], int] = {}

    def linear(self, terms: Mapping[tuple[int, ...], Fraction], constant: Fraction) -> Linear:
        """Return a polynomial as a linear expression, scaled by the least factor that makes it integral."""
        whole = math.lcm(constant.denominator, *(factor.denominator for factor in terms.values()))
        written = ((self._column(monomial), int(factor * whole)) for monomial, factor in terms.items())
        return Linear(tuple((column, factor) for column, factor in written if factor), int(constant * whole))

    def _column(self, monomial: tuple[int, ...]) -> int:
        if len(monomial) == 1:
            return monomial[0]
        one, other = sorted(monomial)
        return self.columns + self.products.setdefault((one, other), len(self.products))
