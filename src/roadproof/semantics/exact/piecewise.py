"""Piecewise polynomial functions of time, and where they are positive, zero or negative.

A piece holds from its start (included) to the start of the next (excluded), the last for ever. So
at a knot the value is that of the piece which begins there, and sums, products, maxima and minima
of such functions are such functions again.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import TypeAlias

from roadproof.semantics.exact.algebraic import CLOSED_FORM, Point, Root, real_roots
from roadproof.semantics.exact.polynomial import (
    HALVINGS,
    TimePolynomial,
    add,
    is_rootless,
    negate,
    sign_at,
    sum_of,
)
from roadproof.semantics.exact.truth import START, Cut, TruthSet, from_values

# Ascending (start, polynomial); the first start is 0.
Pieces: TypeAlias = tuple[tuple[Point, TimePolynomial], ...]


def constant(value: TimePolynomial) -> Pieces:
    """Return one polynomial for all times."""
    return ((START.point, value),)


def apply(change: Callable[[TimePolynomial], TimePolynomial], pieces: Pieces) -> Pieces:
    """Return the function with ``change`` applied to every piece."""
    return tuple((start, change(p)) for start, p in pieces)


def combine(
    join: Callable[[TimePolynomial, TimePolynomial], TimePolynomial], left: Pieces, right: Pieces
) -> Pieces:
    """Return the function with ``join`` applied to every common piece."""
    return _joined_pieces([(start, join(*parts)) for start, parts in _on_common_pieces((left, right))])


def greatest(left: Pieces, right: Pieces) -> Pieces:
    """Return the pointwise maximum; pieces are split where the two functions cross."""
    return _chosen(left, right, 1)


def least(left: Pieces, right: Pieces) -> Pieces:
    """Return the pointwise minimum of two functions."""
    return _chosen(left, right, -1)


def total(functions: Sequence[Pieces]) -> Pieces:
    """Return the sum of functions, of which there is at least one."""
    return _joined_pieces([(start, sum_of(parts)) for start, parts in _on_common_pieces(functions)])


def subtract(left: Pieces, right: Pieces) -> Pieces:
    """Return ``left - right``."""
    return combine(add, left, apply(negate, right))


def where_sign(pieces: Pieces, signs: frozenset[int]) -> TruthSet:
    """Return the times at which the sign (-1, 0 or 1) of the function is one of ``signs``."""
    values: list[tuple[Cut, bool]] = []
    for (start, p), end in zip(pieces, _ends(pieces), strict=True):
        for point, at, after in _signs(p, start, end):
            values.append((Cut(point, False), at in signs))
            values.append((Cut(point, True), after in signs))
    return from_values(values)


def _chosen(left: Pieces, right: Pieces, sign: int) -> Pieces:
    """``left`` where ``left - right`` has the given sign, else ``right``."""
    common = _on_common_pieces((left, right))
    chosen: list[tuple[Point, TimePolynomial]] = []
    ends = [*(start for start, _ in common[1:]), None]
    for (start, (p, q)), end in zip(common, ends, strict=True):
        # Where the two meet they are equal, so the choice after a point is right at it, too.
        for point, _, after in _signs(add(p, negate(q)), start, end):
            chosen.append((point, p if after == sign else q))
    return _joined_pieces(chosen)


def _signs(p: TimePolynomial, start: Point, end: Point | None) -> list[tuple[Point, int, int]]:
    """(point, sign at it, sign after it) at ``start`` and at every root in (start, end)."""
    steady = _steady_sign(p.numerators, start, end)
    if steady:
        return [(start, steady, steady)]
    before, changes = _sign_changes(p.numerators)
    at = after = before
    later: list[tuple[Point, int, int]] = []
    for root, following in changes:
        if root > start:
            if end is not None and root >= end:
                break
            later.append((root, 0, following))
        else:
            at, after = (0 if root == start else following), following
    return [(start, at, after), *later]


def _steady_sign(numerators: tuple[int, ...], start: Point, end: Point | None) -> int:
    """Return the sign on all of [start, end] where a quick test shows that it is constant, else 0.

    Most pieces have no root; to factor their polynomials would cost a hundred times as much.
    """
    degree = len(numerators) - 1
    if degree < CLOSED_FORM:
        return 0
    low = start.low if isinstance(start, Root) else start
    high = end.high if isinstance(end, Root) else end
    halvings = HALVINGS if degree > CLOSED_FORM else 0
    return sign_at(numerators, low) if is_rootless(numerators, low, high, halvings) else 0


@lru_cache(maxsize=8192)
def _sign_changes(numerators: tuple[int, ...]) -> tuple[int, tuple[tuple[Point, int], ...]]:
    """The sign before all roots, and each root with the sign after it."""
    if not numerators:
        return 0, ()
    sign = first = (1 if numerators[-1] > 0 else -1) * (-1) ** (len(numerators) - 1)
    changes: list[tuple[Point, int]] = []
    for root, multiplicity in real_roots(numerators):
        sign *= (-1) ** multiplicity
        changes.append((root, sign))
    return first, tuple(changes)


def _on_common_pieces(functions: Sequence[Pieces]) -> list[tuple[Point, list[TimePolynomial]]]:
    """Return all functions on their common pieces."""
    longest = max(functions, key=len)
    if all(len(x) == 1 or _starts_alike(x, longest) for x in functions):
        return [
            (start, [x[k if len(x) > 1 else 0][1] for x in functions]) for k, (start, _) in enumerate(longest)
        ]
    common: list[tuple[Point, list[TimePolynomial]]] = []
    start, places = functions[0][0][0], [0] * len(functions)
    while True:
        common.append((start, [pieces[k][1] for pieces, k in zip(functions, places, strict=True)]))
        ahead = [
            (j, pieces[k + 1][0])
            for j, (pieces, k) in enumerate(zip(functions, places, strict=True))
            if k + 1 < len(pieces)
        ]
        if not ahead:
            return common
        start = min(point for _, point in ahead)
        for j, point in ahead:
            if point is start or point == start:
                places[j] += 1


def _starts_alike(one: Pieces, other: Pieces) -> bool:
    """Return whether two functions have the same pieces, as those of one drive often have."""
    return one is other or (
        len(one) == len(other) and all(p is q or p == q for (p, _), (q, _) in zip(one, other, strict=True))
    )


def _ends(pieces: Pieces) -> list[Point | None]:
    return [*(after for _, (after, _) in pairwise(pieces)), None]


def _joined_pieces(pieces: list[tuple[Point, TimePolynomial]]) -> Pieces:
    """Return the pieces without starts at which nothing changes."""
    joined = pieces[:1]
    for start, p in pieces[1:]:
        if p != joined[-1][1]:
            joined.append((start, p))
    return tuple(joined)
