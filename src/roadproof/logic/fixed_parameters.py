"""Which parameters a formula leaves one value only: all that is to be asked of it is asked at that value."""

from collections.abc import Iterable
from fractions import Fraction
from functools import reduce
from typing import TypeAlias, assert_never

from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.terms import Parameter, Term, constant_value

# ``parameter <= value`` (sign 1) or ``parameter >= value`` (sign -1).
_Bound: TypeAlias = tuple[str, int, Fraction]
_Bounds: TypeAlias = frozenset[_Bound]
_NONE: _Bounds = frozenset()
_TURNED = {"<": ">", "<=": ">=", ">": "<", ">=": "<="}


def pins(formula: Formula) -> dict[str, Fraction]:
    """The parameters that have one value wherever ``formula`` is false at time 0, with that value.

    Those that a premise pins: ``minDanger = 0.6 s and A -> B`` is false only where minDanger is 0.6 s, so it
    is valid if and only if it is with 0.6 s in place of minDanger. A parameter that would need two values at
    once is left out.
    """
    bounds = _Reader().implied(formula, False)
    most = {(name, value) for name, sign, value in bounds if sign == 1}
    least = {(name, value) for name, sign, value in bounds if sign == -1}
    both = sorted(most & least)
    names = [name for name, _ in both]
    return {name: value for name, value in both if names.count(name) == 1}


class _Reader:
    def __init__(self) -> None:
        self.known: dict[tuple[Formula, bool], _Bounds] = {}

    def implied(self, formula: Formula, value: bool) -> _Bounds:
        """What holds of parameters, which never change, where ``formula`` is ``value`` at some instant."""
        key = (formula, value)
        if key not in self.known:
            self.known[key] = self._implied(formula, value)
        return self.known[key]

    def _implied(self, formula: Formula, value: bool) -> _Bounds:
        match formula:
            case f.Truth() | f.Occupies():
                return _NONE
            case f.Compare(left, op, right):
                return _compared(left, op, right) if value else _NONE
            case f.Application(_, _, body):
                return self.implied(body, value)
            case f.Not(body):
                return self.implied(body, not value)
            case f.And(parts) | f.Or(parts):
                found = [self.implied(part, value) for part in parts]
                return _all(found) if isinstance(formula, f.And) == value else _common(found)
            case f.Eventually(_, body) | f.Some(_, _, body) | f.Until(_, _, body):
                return self.implied(body, True) if value else _NONE
            case f.Always(_, body) | f.Every(_, _, body):
                return _NONE if value else self.implied(body, False)
            case _:
                assert_never(formula)


def _compared(left: Term, op: str, right: Term) -> _Bounds:
    number = constant_value(right)
    if number is None:
        left, op, right, number = right, _TURNED[op], left, constant_value(left)
    if number is None or not isinstance(left, Parameter) or op not in ("<=", ">="):
        return _NONE
    return frozenset({(left.name, 1 if op == "<=" else -1, number)})


def _all(found: Iterable[_Bounds]) -> _Bounds:
    return _NONE.union(*found)


def _common(found: Iterable[_Bounds]) -> _Bounds:
    return reduce(frozenset.intersection, found)
