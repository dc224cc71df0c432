"""Samples of terms and comparisons on a drive: each value of a polynomial is exact, and rounded once."""

from fractions import Fraction
from math import inf

from roadproof.logic.formula import Compare
from roadproof.logic.terms import Inverse, Term
from roadproof.semantics.exact.piecewise import Pieces
from roadproof.semantics.exact.signals import TermPieces


def sample_margin(comparison: Compare, courses: TermPieces, dt: Fraction, count: int) -> list[float]:
    """Return by how much a comparison holds at k·dt for k < count, in its units; ∞ - ∞ is 0.

    The margin of ``left >= right`` is ``left - right``, of ``left <= right`` the reverse; strictness is
    ignored (paper, appendix *Robust Semantics*).
    """
    sides = (comparison.left, comparison.right)
    greater, lesser = sides if comparison.op in (">", ">=") else sides[::-1]
    return _difference(*(_sample_term(x, courses, dt, count) for x in (greater, lesser)))


def _sample_term(term: Term, courses: TermPieces, dt: Fraction, count: int) -> list[float]:
    if isinstance(term, Inverse):
        return [inf if x == 0 else 1 / x for x in _sample_term(term.term, courses, dt, count)]
    return _sample(courses.of(term), dt, count)


def _sample(pieces: Pieces, dt: Fraction, count: int) -> list[float]:
    """The function at k·dt for k < count, each value exact and then rounded."""
    values = list[float]()
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
        values.append(_rounded(value * bottom, scale * polynomial.denominator))
    return values


def _rounded(numerator: int, denominator: int) -> float:
    try:
        return numerator / denominator
    except OverflowError:
        return inf if numerator > 0 else -inf


def _difference(left: list[float], right: list[float]) -> list[float]:
    return [0.0 if x == y else x - y for x, y in zip(left, right, strict=True)]
