"""Certified affine bounds of polynomial inequalities on boxes.

``inner``: sufficient conditions, so a solver's solution solves the exact problem. ``outer``: necessary
conditions, so an infeasible relaxation shows that the exact problem has no solution. Squares are convex:
a tangent lies below, a secant above on its window; a product is a difference of two squares (equivalent to
McCormick's relaxation, Math. Programming 10, 1976). Arithmetic is floating point: solutions are judged
exactly elsewhere, and outer conditions are loosened beyond rounding and solver tolerances.
"""

from collections.abc import Sequence
from dataclasses import field, replace
from itertools import pairwise, product
from math import prod
from typing import Literal, TypeAlias

from roadproof.engines.encode.problem import (
    All,
    AnyOf,
    Circuit,
    ColumnInequality,
    Leaf,
    Origin,
    all_of,
    any_of,
)
from roadproof.runtime.records import dataclass

Side: TypeAlias = Literal["inner", "outer"]
# Lower and upper bound of each column.
Box: TypeAlias = Sequence[tuple[float, float]]


# What outer conditions are loosened by: solvers call a row kept or broken that is so by 1e-6 or less,
# and a sum of doubles is off by less than this share of its parts.
TOLERANCE, ROUNDING = 1e-5, 1e-12


class TooNonlinearError(Exception):
    """An inequality has a degree above 2, which no affine bound here covers."""


@dataclass(frozen=True)
class Affine:
    """An affine form Σ coefficient · column + constant."""

    terms: tuple[tuple[int, float], ...]
    constant: float

    def __add__(self, other: "Affine") -> "Affine":
        total = dict(self.terms)
        for column, factor in other.terms:
            total[column] = total.get(column, 0.0) + factor
        return Affine(tuple(total.items()), self.constant + other.constant)

    def scaled(self, factor: float) -> "Affine":
        return Affine(tuple((c, k * factor) for c, k in self.terms), self.constant * factor)

    def range(self, box: Box) -> tuple[float, float]:
        """Return the least and greatest value on a box."""
        low = high = self.constant
        for column, factor in self.terms:
            one, other = factor * box[column][0], factor * box[column][1]
            low, high = low + min(one, other), high + max(one, other)
        return low, high

    def looseness(self, box: Box) -> float:
        """Return the slack that covers rounding and solver tolerance of an outer condition on this form."""
        parts = (abs(factor) * max(abs(end) for end in box[column]) for column, factor in self.terms)
        return TOLERANCE + ROUNDING * (abs(self.constant) + sum(parts))

    def value(self, values: Sequence[float]) -> float:
        return self.constant + sum(factor * values[column] for column, factor in self.terms)


@dataclass(frozen=True)
class Bound:
    """A condition ``affine >= margin``; ``origin``: what it encodes."""

    affine: Affine
    margin: float = 0.0
    origin: Origin | None = field(default=None, compare=False)


def split_squares(inequality: ColumnInequality) -> tuple[Affine, tuple[tuple[float, Affine], ...]]:
    """Split a polynomial of degree at most 2 into an affine part and multiples of squares of affine forms.

    Raises ``TooNonlinearError`` above degree 2.
    """
    terms: dict[int, float] = {}
    constant = 0.0
    squares: list[tuple[float, Affine]] = []
    for monomial, coefficient in inequality.polynomial.terms.items():
        factor = float(coefficient)
        if not monomial:
            constant += factor
        elif len(monomial) == 1:
            terms[monomial[0]] = factor
        elif len(monomial) > 2:
            raise TooNonlinearError(str(len(monomial)))
        elif monomial[0] == monomial[1]:
            squares.append((factor, Affine(((monomial[0], 1.0),), 0.0)))
        else:
            x, y = monomial
            squares.append((factor / 4, Affine(((x, 1.0), (y, 1.0)), 0.0)))
            squares.append((-factor / 4, Affine(((x, 1.0), (y, -1.0)), 0.0)))
    return Affine(tuple(terms.items()), constant), tuple(squares)


def affine_bounds(inequality: ColumnInequality, box: Box, side: Side, pieces: int = 1) -> Circuit[Bound]:
    """Return affine conditions that imply ``inequality`` on ``box`` (inner) or follow from it (outer).

    Outer conditions are loosened beyond rounding. Inner ones keep the margin; without it, strict becomes
    ``>=``. ``pieces``: number of tangents or secant windows per square (a product is two squares). With
    more than 1, the result has alternatives. Raises ``TooNonlinearError`` above degree 2.
    """
    linear, squares = split_squares(inequality)
    options = [_square(factor, form, box, side, pieces) for factor, form in squares]
    cases = []
    for chosen in product(*options):
        conditions = [condition for _, window in chosen for condition in window]
        totals = [linear]
        for bounds, _ in chosen:
            totals = [total + bound for total in totals for bound in bounds]
        leaves = [_leaf(total, inequality, box, side) for total in totals]
        windows = (Leaf(replace(c, origin=inequality.origin)) for c in conditions)
        cases.append(all_of([*windows, *leaves]))
    return any_of(cases)


def loosened(box: Box) -> list[tuple[float, float]]:
    """Return a slightly larger box, so every point of ``box`` is well inside; single values stay."""
    return [
        (low, high)
        if low == high
        else (low - TOLERANCE - ROUNDING * abs(low), high + TOLERANCE + ROUNDING * abs(high))
        for low, high in box
    ]


# Affine bounds that are all valid, and the window in which they are.
Piece: TypeAlias = tuple[tuple[Affine, ...], tuple[Bound, ...]]


def _square(factor: float, form: Affine, box: Box, side: Side, pieces: int) -> list[Piece]:
    """Return alternative affine bounds of ``factor·form²`` on a side, each with the window where it is valid.

    On the inner side one tangent is enough; on the outer side all of them must hold.
    """
    low, high = form.range(box)
    if high - low < 1e-12:
        return [((Affine((), factor * low * low),), ())]
    if (factor > 0) == (side == "inner"):
        points = [low + (high - low) * (2 * k + 1) / (2 * pieces) for k in range(pieces)]
        tangents = [(form.scaled(2 * p) + Affine((), -p * p)).scaled(factor) for p in points]
        return [((t,), ()) for t in tangents] if side == "inner" else [(tuple(tangents), ())]
    cuts = [low + (high - low) * k / pieces for k in range(pieces + 1)]
    windows: list[Piece] = []
    for a, b in pairwise(cuts):
        secant = (form.scaled(a + b) + Affine((), -a * b)).scaled(factor)
        slack = form.looseness(box) if side == "outer" else 0.0
        inside = (Bound(form + Affine((), -a), -slack), Bound(form.scaled(-1) + Affine((), b), -slack))
        windows.append(((secant,), inside if pieces > 1 else ()))
    return windows


def _leaf(affine: Affine, inequality: ColumnInequality, box: Box, side: Side) -> Circuit[Bound]:
    """Return the condition, or true or false where the box decides it."""
    low, high = affine.range(box)
    if side == "outer":
        slack = affine.looseness(box)
        return (
            All(())
            if low >= 0
            else AnyOf(())
            if high < -slack
            else Leaf(Bound(affine, -slack, inequality.origin))
        )
    if low > 0 or (low == 0 and not inequality.strict):
        return All(())
    if high < 0 or (high == 0 and inequality.strict):
        return AnyOf(())
    return Leaf(Bound(affine, float(inequality.margin), inequality.origin))


def polynomial_value(inequality: ColumnInequality, values: Sequence[float]) -> float:
    """Return the value of an inequality's polynomial at the given column values."""
    total = 0.0
    for monomial, coefficient in inequality.polynomial.terms.items():
        total += prod((values[column] for column in monomial), start=float(coefficient))
    return total
