"""Conversion of formulas and terms back to syntax trees, so that computed formulas can be printed and read.

Elaborating the result gives the same formula, up to constants: a number without a finite decimal, such as 1/3
s, becomes the quotient 1/3 * 1 s, and a sum of three terms becomes nested sums of two.
"""

import re
from collections.abc import Sequence
from fractions import Fraction
from functools import reduce
from typing import Literal, assert_never

from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.syntax import Binary, BinaryOperator, Bounds, Call, Expression, Literal_, Name, Prefix
from roadproof.logic.terms import Dimension, Term
from roadproof.world.signals import KINDS, Kind
from roadproof.world.units import SI

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


def as_syntax(formula: Formula, expand: bool = False) -> Expression:
    """Return the syntax tree of ``formula``; definitions are called by name, or written out with ``expand``.

    A definition is always written out if an argument, such as a lane of a road file, is no name of the
    language.
    """
    match formula:
        case f.Truth(value):
            return Literal_(value)
        case f.Compare(t.CustomSignal(truth=True) as own, op, _):
            return term_as_syntax(own) if op == ">" else Prefix("not", term_as_syntax(own))
        case f.Compare(t.Size("kind", vehicle), op, t.Number(value, _)):
            return _kind_from(vehicle, op, value)
        case f.Compare(left, op, right):
            return Binary(op, term_as_syntax(left), term_as_syntax(right))
        case f.Occupies(vehicle, lanelet):
            return Call("occ", (Name(vehicle), Name(lanelet)))
        case f.Some(variable, domain, body) | f.Every(variable, domain, body):
            kind: Literal["some", "every"] = "some" if isinstance(formula, f.Some) else "every"
            return syntax.Quantified(kind, variable, _domain(domain), as_syntax(body, expand))
        case f.Not(f.Since(f.Truth(True), interval, f.Not(body))):
            return syntax.Temporal("H", _bounds(interval), None, as_syntax(body, expand))
        case f.Not(body):
            return Prefix("not", as_syntax(body, expand))
        case f.And((f.Compare(a, "<=", b), f.Compare(c, ">=", d))) if (a, b) == (c, d):
            return Binary("=", term_as_syntax(a), term_as_syntax(b))
        case f.Or((f.Compare(a, "<", b), f.Compare(c, ">", d))) if (a, b) == (c, d):
            return Binary("!=", term_as_syntax(a), term_as_syntax(b))
        case f.And(
            (f.Compare(t.Size("kind", a), ">=", t.Number(low, _)), f.Compare(t.Size("kind", b), "<", high))
        ) if (a, t.number(low + 1)) == (b, high):
            return _kind(a, "=", KINDS[int(low)])
        case f.Or(
            (f.Compare(t.Size("kind", a), "<", t.Number(low, _)), f.Compare(t.Size("kind", b), ">=", high))
        ) if (a, t.number(low + 1)) == (b, high):
            return _kind(a, "!=", KINDS[int(low)])
        case f.And(parts) | f.Or(parts):
            word: Literal["and", "or"] = "and" if isinstance(formula, f.And) else "or"
            return _chain(word, [as_syntax(part, expand) for part in parts])
        case f.Until(left, interval, right):
            return syntax.Temporal("U", _bounds(interval), as_syntax(left, expand), as_syntax(right, expand))
        case f.Since(f.Truth(True), interval, body):
            return syntax.Temporal("O", _bounds(interval), None, as_syntax(body, expand))
        case f.Since(left, interval, right):
            return syntax.Temporal("S", _bounds(interval), as_syntax(left, expand), as_syntax(right, expand))
        case f.Eventually(interval, body):
            return syntax.Temporal("F", _bounds(interval), None, as_syntax(body, expand))
        case f.Always(interval, body):
            return syntax.Temporal("G", _bounds(interval), None, as_syntax(body, expand))
        case f.Application(name, arguments, body):
            if expand or not all(_NAME.fullmatch(argument) for argument in arguments):
                return as_syntax(body, expand)
            return Call(name, tuple(Name(argument) for argument in arguments))
        case _:
            assert_never(formula)


def _kind(vehicle: str, op: BinaryOperator, kind: Kind) -> Expression:
    return Binary(op, Call("kind", (Name(vehicle),)), Name(kind))


def _kind_from(vehicle: str, op: f.Comparison, bound: Fraction) -> Expression:
    """Return one comparison of a kind (``logic.custom_names``), as an equality if about the first or last."""
    first, last = bound == Fraction(3, 2), bound == len(KINDS) - Fraction(1, 2)
    if first:
        return _kind(vehicle, "=" if op == "<" else "!=", KINDS[0])
    if last:
        return _kind(vehicle, "!=" if op == "<" else "=", KINDS[-1])
    return _kind(vehicle, op, KINDS[int(bound)])


def _chain(op: Literal["and", "or"], parts: Sequence[Expression]) -> Expression:
    if not parts:
        return Literal_(op == "and")
    return parts[0] if len(parts) == 1 else syntax.Chain(op, tuple(parts))


def _domain(domain: f.Domain) -> Name | Call:
    match domain.kind:
        case "lanes":
            return Name("lanes")
        case "adjacent":
            return Call("adjacentLanes", (Name(domain.of),))
        case "lanelets" | "zone":
            return Call(domain.kind, (Name(domain.of),))
        case _:
            assert_never(domain.kind)


def _bounds(interval: f.Interval) -> Bounds | None:
    if interval == f.FOREVER:
        return None
    return Bounds(_bound(interval.low), None if interval.high is None else _bound(interval.high))


def _bound(term: Term) -> Expression:
    """Return the bound of an interval, where 0 needs no unit."""
    return Literal_(Fraction(0)) if t.constant_value(term) == 0 else term_as_syntax(term)


def term_as_syntax(term: Term) -> Expression:
    """Return the syntax tree of a term; numbers keep their unit."""
    match term:
        case t.Number(value, dimension):
            return _number(value, dimension)
        case t.Parameter(name, _) | t.Variable(name, _):
            return Name(name)
        case t.Signal(name, vehicle) | t.Size(name, vehicle):
            return Call(name, (Name(vehicle),))
        case t.CustomSignal(name, vehicle):
            return Call(name, (Name(vehicle),)) if vehicle else Name(name)
        case t.Sum(terms):
            return _sum(terms)
        case t.Product((t.Number(Fraction(numerator=-1, denominator=1), (0, 0)), factor)) if not isinstance(
            factor, t.Number
        ):
            return Prefix("-", term_as_syntax(factor))
        case t.Product(factors):
            return _product([term_as_syntax(factor) for factor in factors])
        case t.Power(inner, exponent):
            return Binary("^", term_as_syntax(inner), Literal_(Fraction(exponent)))
        case t.Quotient(numerator, denominator):
            return Binary("/", term_as_syntax(numerator), term_as_syntax(denominator))
        case t.Maximum(terms) | t.Minimum(terms):
            return Call("max" if isinstance(term, t.Maximum) else "min", tuple(map(term_as_syntax, terms)))
        case t.Inverse(inner):
            return Call("inverse", (term_as_syntax(inner),))
        case _:
            assert_never(term)


def _sum(terms: Sequence[Term]) -> Expression:
    """Return a sum; terms with a minus sign in front are subtracted."""
    if not terms:
        return _number(Fraction(0))
    total = term_as_syntax(terms[0])
    for term in terms[1:]:
        operand = term_as_syntax(term)
        total = (
            Binary("-", total, operand.body) if isinstance(operand, Prefix) else Binary("+", total, operand)
        )
    return total


def _product(factors: Sequence[Expression]) -> Expression:
    return reduce(lambda left, right: Binary("*", left, right), factors) if factors else _number(Fraction(1))


def _number(value: Fraction, dimension: Dimension = (0, 0)) -> Expression:
    if dimension in SI:
        written: Expression = Literal_(abs(value), SI[dimension] if dimension != (0, 0) else "")
    else:
        written = Binary("*", Literal_(abs(value)), _unit(dimension))
    return Prefix("-", written) if value < 0 else written


def _unit(dimension: Dimension) -> Expression:
    """Return one unit of a dimension without a name, as powers of 1 m and 1 s: (2, -2) is (1 m)^2/(1 s)^2."""
    above: list[Expression] = []
    below: list[Expression] = []
    for unit, exponent in zip(("m", "s"), dimension, strict=True):
        if exponent:
            one = Literal_(Fraction(1), unit)
            (above if exponent > 0 else below).append(Binary("^", one, Literal_(Fraction(abs(exponent)))))
    return reduce(lambda left, right: Binary("/", left, right), below, _product(above))
