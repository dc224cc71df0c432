"""Syntax trees as plain data for JSON: every node is an object whose ``node`` says what it is."""

from fractions import Fraction
from typing import Any, assert_never

from roadproof.logic import syntax
from roadproof.logic.syntax import Binding, Bounds, Claim, Definition, Expression


def tree(of: Expression | Claim | Definition) -> dict[str, Any]:
    """``of`` as dictionaries, lists and strings; numbers are rationals as text, such as ``3/5``."""
    match of:
        case Claim(given, body):
            return {"node": "claim", "given": _bindings(given), "body": tree(body)}
        case Definition(name, parameters, doc, body, _):
            head = {"node": "definition", "name": name, "parameters": _bindings(parameters), "doc": doc}
            return {**head, "body": tree(body)}
        case syntax.Literal_(bool(), _, _):
            return {"node": "truth", "value": of.value}
        case syntax.Literal_(value, unit, _):
            return {"node": "number", "value": str(Fraction(value)), "unit": unit}
        case syntax.Name(name, _):
            return {"node": "name", "name": name}
        case syntax.Call(name, arguments, _):
            return {"node": "call", "name": name, "arguments": [tree(argument) for argument in arguments]}
        case syntax.Prefix(op, body, _):
            return {"node": op, "body": tree(body)}
        case syntax.Binary(op, left, right, _):
            return {"node": op, "left": tree(left), "right": tree(right)}
        case syntax.Chain(op, parts, _):
            return {"node": op, "parts": [tree(part) for part in parts]}
        case syntax.Temporal("U", bounds, left, right, _) if left is not None:
            return {"node": "U", **_interval(bounds), "left": tree(left), "right": tree(right)}
        case syntax.Temporal(op, bounds, _, right, _):
            return {"node": op, **_interval(bounds), "body": tree(right)}
        case syntax.Quantified(kind, variable, domain, body, _):
            return {"node": kind, "variable": variable, "domain": _domain(domain), "body": tree(body)}
        case _:
            assert_never(of)


def _bindings(bindings: tuple[Binding, ...]) -> list[dict[str, str]]:
    return [{"name": binding.name, "sort": binding.sort} for binding in bindings]


def _interval(bounds: Bounds | None) -> dict[str, Any]:
    """Seconds; ``high`` null is without bound."""
    if bounds is None:
        return {"low": tree(syntax.Literal_(Fraction(0))), "high": None}
    return {"low": tree(bounds.low), "high": None if bounds.high is None else tree(bounds.high)}


def _domain(domain: syntax.Name | syntax.Call | syntax.Group) -> dict[str, Any]:
    if isinstance(domain, syntax.Group):
        return {"node": "group", "members": [member.name for member in domain.members]}
    return tree(domain)
