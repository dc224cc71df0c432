"""Texts with parameters ``$name`` and expressions ``${…}`` (ASAM OpenSCENARIO XML 1.3, section 9.1).

Expressions have numbers, pi, parameters, + - * / %, and the functions of ``_FUNCTIONS``.
"""

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping

_NAME = re.compile(r"\$([A-Za-z_][\w.]*)")
_LONGEST = 500
"""Characters of an expression."""
_OPERATORS: Mapping[type[ast.operator], Callable[[float, float], float]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Mod: math.fmod,
}
_FUNCTIONS: Mapping[str, Callable[..., float]] = {
    "round": lambda x: float(math.floor(x + 0.5)),
    "floor": lambda x: float(math.floor(x)),
    "ceil": lambda x: float(math.ceil(x)),
    "sqrt": math.sqrt,
    "pow": math.pow,
    "abs": abs,
    "sign": lambda x: float((x > 0) - (x < 0)),
    "min": lambda x, y: min(x, y),
    "max": lambda x, y: max(x, y),
}


def expression_value(text: str) -> float:
    """The value of an expression of numbers. Raises ``ValueError``."""
    if len(text) > _LONGEST:
        raise ValueError(f"more than {_LONGEST} characters")
    try:
        value = _evaluate(ast.parse(text.strip(), mode="eval").body)
    except (SyntaxError, ArithmeticError, TypeError, RecursionError, MemoryError) as error:
        raise ValueError(f"no expression that can be evaluated ({error})") from None
    if not math.isfinite(value):
        raise ValueError("no finite number")
    return value


def _evaluate(node: ast.expr) -> float:
    match node:
        case ast.Constant(value=int() | float() as value):
            return float(value)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _OPERATORS:
            return _OPERATORS[type(op)](_evaluate(left), _evaluate(right))
        case ast.Name(id="pi"):
            return math.pi
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_evaluate(operand)
        case ast.UnaryOp(op=ast.UAdd(), operand=operand):
            return _evaluate(operand)
        case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](*map(_evaluate, args))
    raise ValueError(f"{ast.unparse(node)[:80]} is not supported in an expression")


def replace_parameters(text: str, values: Mapping[str, str]) -> str:
    """``text`` with parameters and expressions replaced. Raises ``ValueError``."""

    def value_of(match: re.Match[str]) -> str:
        if match[1] not in values:
            raise ValueError(f"there is no parameter {match[1]}")
        return values[match[1]]

    if text.startswith("${") and text.endswith("}"):
        return repr(expression_value(_NAME.sub(value_of, text[2:-1])))
    return _NAME.sub(value_of, text)
