"""Samples of terms and comparisons on a drive: each value of a polynomial is exact, and rounded once."""

from fractions import Fraction
from math import inf
from typing import Any, TypeAlias

import numpy as np

from roadproof.logic.formula import Compare
from roadproof.logic.terms import Inverse, Term
from roadproof.semantics.exact.piecewise import Pieces
from roadproof.semantics.exact.signals import TermPieces

Array: TypeAlias = np.ndarray[Any, np.dtype[np.float64]]


def sample_margin(comparison: Compare, courses: TermPieces, dt: Fraction, count: int) -> Array:
    """Return by how much a comparison holds at k·dt for k < count, in its units; ∞ - ∞ is 0.

    The margin of ``left >= right`` is ``left - right``, of ``left <= right`` the reverse; strictness is
    ignored (paper, appendix *Robust Semantics*).
    """
    sides = (comparison.left, comparison.right)
    greater, lesser = sides if comparison.op in (">", ">=") else sides[::-1]
    return _difference(*(_sample_term(x, courses, dt, count) for x in (greater, lesser)))


def _sample_term(term: Term, courses: TermPieces, dt: Fraction, count: int) -> Array:
    if isinstance(term, Inverse):
        inner = _sample_term(term.term, courses, dt, count)
        with np.errstate(divide="ignore", over="ignore"):
            return np.where(inner == 0, inf, 1 / inner)
    return _sample(courses.of(term), dt, count)


def _sample(pieces: Pieces, dt: Fraction, count: int) -> Array:
    """The function at k·dt for k < count, each value exact and then rounded."""
    values = np.empty(count)
    following = [start for start, _ in pieces[1:]]
    piece = 0
    for k in range(count):
        while piece < len(following) and following[piece] <= k * dt:
            piece += 1
        top, bottom = k * dt.numerator, dt.denominator
        polynomial = pieces[piece][1]
        value, scale = 0, 1
        for n in reversed(polynomial.numerators):
            value = value * top + n * scale
            scale *= bottom
        values[k] = _rounded(value * bottom, scale * polynomial.denominator)
    return values


def _rounded(numerator: int, denominator: int) -> float:
    try:
        return numerator / denominator
    except OverflowError:
        return inf if numerator > 0 else -inf


def _difference(left: Array, right: Array) -> Array:
    with np.errstate(invalid="ignore"):
        return np.where(left == right, 0.0, left - right)
