"""What a formula says of the instant that it begins with, and which parameters it leaves one value only."""

from collections.abc import Collection, Iterator, Mapping
from fractions import Fraction
from functools import cache, reduce
from typing import TypeAlias, assert_never

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula, Interval
from roadproof.logic.node import once
from roadproof.logic.rewrite import leaves_of
from roadproof.logic.terms import Parameter, Term, constant_value


def conjuncts(formula: Formula, positive: bool = True) -> Iterator[Formula]:
    """What ``formula`` (else its negation) joins by ``and``, through the names of definitions.

    What a quantifier or time stands before is one part.
    """
    match formula:
        case f.And(parts) | f.Or(parts) if isinstance(formula, f.And) == positive:
            for part in parts:
                yield from conjuncts(part, positive)
        case f.Not(body):
            yield from conjuncts(body, not positive)
        case f.Application(_, _, body):
            yield from conjuncts(body, positive)
        case _:
            yield formula if positive else f.negation(formula)


def compared(formula: Formula) -> Iterator[f.Compare]:
    """The comparisons of a bound formula that are about the instant that it begins with, and no other."""
    match formula:
        case f.Compare():
            yield formula
        case f.And() | f.Or() | f.Not() | f.Application():
            for part in f.children(formula):
                yield from compared(part)
        case _:
            return


def narrowed(formula: Formula, without: Collection[f.Compare], positive: bool = True) -> Formula:
    """What implies a bound formula (where it is not ``positive``, what it implies) and has not these
    comparisons: none of them helps it to be true. Those at other instants stay.
    """
    match formula:
        case f.Compare() if formula in without:
            return f.FALSE if positive else f.TRUE
        case f.And(parts):
            return f.conjunction(*(narrowed(part, without, positive) for part in parts))
        case f.Or(parts):
            return f.disjunction(*(narrowed(part, without, positive) for part in parts))
        case f.Not(body):
            return f.negation(narrowed(body, without, not positive))
        case f.Application(_, _, body) if any(x in without for x in compared(body)):
            return narrowed(body, without, positive)
        case _:
            return formula


def demands(formula: Formula) -> Formula:
    """A formula about one instant, without names, that is true at 0 wherever the bound ``formula`` is.

    What it says of later times only, and of own signals, is left out.
    """

    @cache
    def visit(current: Formula, positive: bool) -> Formula:
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
            case f.Compare(left, op, right) if not _has_own(current):
                return current if positive else f.Compare(left, f.NEGATED[op], right)
            case f.Truth():
                return current if positive else f.negation(current)
            case _:
                return f.TRUE

    return visit(formula, True)


def _has_now(interval: Interval) -> bool:
    return constant_value(interval.low) == 0


def _has_own(part: f.Compare) -> bool:
    return any(isinstance(leaf, t.Own) for leaf in leaves_of(part))


# ``parameter <= value`` (sign 1) or ``parameter >= value`` (sign -1).
_Bound: TypeAlias = tuple[str, int, Fraction]
_Bounds: TypeAlias = frozenset[_Bound]
_NONE: _Bounds = frozenset()


@once
def pins(formula: Formula) -> Mapping[str, Fraction]:
    """The parameters that have one value wherever ``formula`` is false at time 0, with that value.

    Those that a premise pins: ``minDanger = 0.6 s and A -> B`` is false only where minDanger is 0.6 s, so it
    is valid if and only if it is with 0.6 s in place of minDanger. A parameter that would need two values at
    once is left out.
    """

    @cache
    def implied(formula: Formula, value: bool) -> _Bounds:
        """What holds of parameters, which never change, where a formula is ``value`` at some instant."""
        match formula:
            case f.Truth() | f.Occupies():
                return _NONE
            case f.Compare(left, op, right):
                return _compared(left, op, right) if value else _NONE
            case f.Application(_, _, body):
                return implied(body, value)
            case f.Not(body):
                return implied(body, not value)
            case f.And(parts) | f.Or(parts):
                found = [implied(part, value) for part in parts]
                return (
                    _NONE.union(*found)
                    if isinstance(formula, f.And) == value
                    else reduce(frozenset.intersection, found)
                )
            case f.Eventually(_, body) | f.Some(_, _, body) | f.Until(_, _, body):
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


def _compared(left: Term, op: f.Comparison, right: Term) -> _Bounds:
    number = constant_value(right)
    if number is None:
        left, op, right, number = right, f.MIRRORED[op], left, constant_value(left)
    if number is None or not isinstance(left, Parameter) or op not in ("<=", ">="):
        return _NONE
    return frozenset({(left.name, 1 if op == "<=" else -1, number)})
