"""Consequences of a formula for the instant at which it is evaluated, and for the values of parameters."""

from collections.abc import Collection, Iterator, Mapping
from fractions import Fraction
from functools import cache, reduce
from typing import TypeAlias, assert_never

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula, Interval
from roadproof.logic.node import memoised
from roadproof.logic.rewrite import leaves_of
from roadproof.logic.terms import Parameter, Term, constant_value


def top_level_conjuncts(formula: Formula, positive: bool = True) -> Iterator[Formula]:
    """Yield the conjuncts of ``formula`` (of its negation if not ``positive``), also inside definitions.

    A temporal operator or a quantifier is one conjunct, with everything in its scope.
    """
    match formula:
        case f.And(parts) | f.Or(parts) if isinstance(formula, f.And) == positive:
            for part in parts:
                yield from top_level_conjuncts(part, positive)
        case f.Not(body):
            yield from top_level_conjuncts(body, not positive)
        case f.Application(_, _, body):
            yield from top_level_conjuncts(body, positive)
        case f.Truth() | f.Compare() | f.Occupies() | f.Some() | f.Every() | f.And() | f.Or():
            yield formula if positive else f.negation(formula)
        case f.Until() | f.Since() | f.Eventually() | f.Always():
            yield formula if positive else f.negation(formula)
        case _:
            assert_never(formula)


def comparisons_at_start(formula: Formula) -> Iterator[f.Compare]:
    """Yield the comparisons of a bound formula that are outside all temporal operators."""
    match formula:
        case f.Compare():
            yield formula
        case f.And() | f.Or() | f.Not() | f.Application():
            for part in f.children(formula):
                yield from comparisons_at_start(part)
        case (
            f.Truth()
            | f.Occupies()
            | f.Some()
            | f.Every()
            | f.Until()
            | f.Since()
            | f.Eventually()
            | f.Always()
        ):
            return
        case _:
            assert_never(formula)


def without_comparisons(formula: Formula, without: Collection[f.Compare], positive: bool = True) -> Formula:
    """Strengthen a bound formula (weaken it if not ``positive``) by dropping these comparisons.

    Each becomes false (true) where it is asserted, and true (false) where it is negated. Comparisons inside
    temporal operators stay.
    """
    match formula:
        case f.Compare() if formula in without:
            return f.FALSE if positive else f.TRUE
        case f.And(parts):
            return f.conjunction(*(without_comparisons(part, without, positive) for part in parts))
        case f.Or(parts):
            return f.disjunction(*(without_comparisons(part, without, positive) for part in parts))
        case f.Not(body):
            return f.negation(without_comparisons(body, without, not positive))
        case f.Application(_, _, body) if any(x in without for x in comparisons_at_start(body)):
            return without_comparisons(body, without, positive)
        case f.Truth() | f.Compare() | f.Occupies() | f.Some() | f.Every() | f.Application():
            return formula
        case f.Until() | f.Since() | f.Eventually() | f.Always():
            return formula
        case _:
            assert_never(formula)


def necessary_at_start(formula: Formula) -> Formula:
    """Return a formula about one instant that is necessary, at time 0, for the bound ``formula``.

    It has no definitions. Conditions on later times and on custom signals are dropped.
    """

    @cache
    def visit(current: Formula, positive: bool) -> Formula:
        """Return a necessary condition for ``current`` (for its negation if not ``positive``)."""
        match current:
            case f.And(parts) | f.Or(parts):
                below = [visit(part, positive) for part in parts]
                both = isinstance(current, f.And) == positive
                return f.conjunction(*below) if both else f.disjunction(*below)
            case f.Not(body):
                return visit(body, not positive)
            case f.Application(_, _, body):
                return visit(body, positive)
            case f.Always(interval, body) if positive and _has_now(interval):
                return visit(body, True)
            case f.Eventually(interval, body) if not positive and _has_now(interval):
                return visit(body, False)
            case f.Until(left, interval, right) if _has_now(interval):
                now = visit(right, positive)
                return f.disjunction(visit(left, True), now) if positive else now
            case f.Since(_, interval, right) if constant_value(interval.low) is not None:
                now = visit(right, positive) if _has_now(interval) else f.Truth(not positive)
                return now  # nothing is before time 0
            case f.Compare(left, op, right) if not _has_own(current):
                return current if positive else f.Compare(left, f.NEGATED[op], right)
            case f.Truth():
                return current if positive else f.negation(current)
            case f.Compare() | f.Occupies() | f.Some() | f.Every():
                return f.TRUE
            case f.Until() | f.Since() | f.Eventually() | f.Always():
                return f.TRUE
            case _:
                assert_never(current)

    return visit(formula, True)


def _has_now(interval: Interval) -> bool:
    return constant_value(interval.low) == 0


def _has_own(part: f.Compare) -> bool:
    return any(isinstance(leaf, t.CustomSignal) for leaf in leaves_of(part))


# ``parameter <= value`` (sign 1) or ``parameter >= value`` (sign -1).
_Bound: TypeAlias = tuple[str, int, Fraction]
_Bounds: TypeAlias = frozenset[_Bound]
_NONE: _Bounds = frozenset()


@memoised
def forced_values(formula: Formula) -> Mapping[str, Fraction]:
    """Return the parameters that have one value wherever ``formula`` is false at time 0, with that value.

    For example ``minDanger = 0.6 s and A -> B`` is false only where minDanger is 0.6 s, so it is valid if and
    only if it is valid with 0.6 s in place of minDanger. A parameter that would need two values is left out.
    """

    @cache
    def implied(formula: Formula, value: bool) -> _Bounds:
        """Return the bounds on parameters that hold where ``formula`` is ``value`` at some instant."""
        match formula:
            case f.Truth() | f.Occupies():
                return _NONE
            case f.Compare(left, op, right):
                return _bounds_from(left, op, right) if value else _NONE
            case f.Application(_, _, body):
                return implied(body, value)
            case f.Not(body):
                return implied(body, not value)
            case f.And(parts) | f.Or(parts):
                bounds_of_parts = [implied(part, value) for part in parts]
                return (
                    _NONE.union(*bounds_of_parts)
                    if isinstance(formula, f.And) == value
                    else reduce(frozenset.intersection, bounds_of_parts)
                )
            case f.Eventually(_, body) | f.Some(_, _, body) | f.Until(_, _, body) | f.Since(_, _, body):
                return implied(body, True) if value else _NONE
            case f.Always(_, body) | f.Every(_, _, body):
                return _NONE if value else implied(body, False)
            case _:
                assert_never(formula)

    bounds = implied(formula, False)
    most = {(name, value) for name, sign, value in bounds if sign == 1}
    least = {(name, value) for name, sign, value in bounds if sign == -1}
    both = sorted(most & least)
    names = [name for name, _ in both]
    return {name: value for name, value in both if names.count(name) == 1}


def _bounds_from(left: Term, op: f.Comparison, right: Term) -> _Bounds:
    number = constant_value(right)
    if number is None:
        left, op, right, number = right, f.MIRRORED[op], left, constant_value(left)
    if number is None or not isinstance(left, Parameter) or op not in ("<=", ">="):
        return _NONE
    return frozenset({(left.name, 1 if op == "<=" else -1, number)})
