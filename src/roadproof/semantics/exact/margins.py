"""The robustness of a formula without temporal operators, as an exact piecewise polynomial in time.

A comparison is the difference of its sides, ``not`` a change of sign, ``and`` and ``or`` are the least and
the greatest part. So pieces begin at knots of the drive and where two parts cross. A supremum over a window
would need values at irrational instants, which are no rational polynomials: such formulas are refused.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from typing import TypeAlias, assert_never

from roadproof.errors import InputError
from roadproof.logic import formula as f
from roadproof.logic.formula import Compare, Formula
from roadproof.logic.terms import Inverse
from roadproof.semantics.exact import piecewise
from roadproof.semantics.exact.algebraic import Point, as_float, bounds, real_roots
from roadproof.semantics.exact.piecewise import Pieces
from roadproof.semantics.exact.polynomial import TimePolynomial, add, negate
from roadproof.semantics.exact.signals import TermPieces

_NARROW = Fraction(1, 2**90)
StateMargin: TypeAlias = Pieces | bool
"""A function of time, or ∞ (True) or -∞ (False) at all times."""


class NoExactPieces(InputError):
    """A formula whose robustness is no piecewise polynomial in time, or is not known to be one."""


def state_margin(formula: Formula, courses: TermPieces) -> StateMargin:
    """Return the robustness of a bound state formula as a function of time.

    Raises ``NoExactPieces`` for temporal operators and for ``inverse``, ``InputError`` for formulas that are
    not bound.
    """
    match formula:
        case f.Truth(value):
            return value
        case Compare():
            return _difference(formula, courses)
        case f.Not(body):
            inner = state_margin(body, courses)
            return not inner if isinstance(inner, bool) else piecewise.apply(negate, inner)
        case f.And(parts):
            return _fold([state_margin(x, courses) for x in parts], universal=True)
        case f.Or(parts):
            return _fold([state_margin(x, courses) for x in parts], universal=False)
        case f.Application(_, _, body):
            return state_margin(body, courses)
        case f.Eventually() | f.Always() | f.Until() | f.Since():
            raise NoExactPieces("the formula has temporal operators")
        case f.Occupies() | f.Some() | f.Every():
            raise InputError("a formula over a road's lanes has a robustness after it is bound to a road")
        case _:
            assert_never(formula)


def _difference(comparison: Compare, courses: TermPieces) -> Pieces:
    sides = (comparison.left, comparison.right)
    if any(isinstance(x, Inverse) for x in sides):
        raise NoExactPieces("the formula has inverse(…)")
    greater, lesser = sides if comparison.op in (">", ">=") else sides[::-1]
    return piecewise.subtract(courses.of(greater), courses.of(lesser))


def _fold(margins: list[StateMargin], universal: bool) -> StateMargin:
    """Return the least margin (``universal``) or the greatest one."""
    if (not universal) in margins:
        return not universal
    functions = [x for x in margins if not isinstance(x, bool)]
    if not functions:
        return universal
    return reduce(piecewise.least if universal else piecewise.greatest, functions)


@dataclass(frozen=True)
class LeastValue:
    """The least value of a function, rounded, and the time (s) at which it has it.

    Unless ``attained``, values come near it just before that time, at which the function jumps.
    """

    value: float
    time: float
    attained: bool = True


def least_value(pieces: Pieces, horizon: Fraction) -> LeastValue:
    """Return the least value of a function within [0, ``horizon``] (s), the first one of several."""
    return min(_candidates(pieces, horizon), key=lambda x: (x.value, not x.attained, x.time))


def value_at(pieces: Pieces, time: Point) -> Fraction:
    """Return the value of a function at a time >= 0; near it, within 2^-90 s, where that is irrational."""
    p = next(p for start, p in reversed(pieces) if start <= time)
    return _value(p, time)


def _value(p: TimePolynomial, time: Point) -> Fraction:
    low, high = bounds(time, _NARROW)
    middle = (low + high) / 2
    value = Fraction(0)
    for n in reversed(p.numerators):
        value = value * middle + n
    return value / p.denominator


def _candidates(pieces: Pieces, horizon: Fraction) -> Iterator[LeastValue]:
    """Yield values where a piece begins, turns and ends; the last one that matters ends with the horizon."""
    for k, (start, p) in enumerate(pieces):
        if start > horizon:
            return
        following = pieces[k + 1] if k + 1 < len(pieces) else None
        last = following is None or following[0] > horizon
        end = horizon if following is None or last else following[0]
        yield LeastValue(float(_value(p, start)), as_float(start))
        slope = tuple(power * n for power, n in enumerate(p.numerators))[1:]
        for turn, _ in real_roots(slope) if any(slope) else ():
            if start < turn < end:
                yield LeastValue(float(_value(p, turn)), as_float(turn))
        if last:
            yield LeastValue(float(_value(p, end)), as_float(end))
        elif following is not None and not _meet(p, following[1], end):
            yield LeastValue(float(_value(p, end)), as_float(end), attained=False)


def _meet(p: TimePolynomial, q: TimePolynomial, time: Point) -> bool:
    """Return whether two polynomials are equal at a time."""
    difference = add(p, negate(q)).numerators
    return not difference or any(root == time for root, _ in real_roots(difference))
