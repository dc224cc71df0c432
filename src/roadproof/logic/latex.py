"""LaTeX of syntax trees in the paper's style: names in \\mathit, operators as in its Table of formulas."""

import re
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import assert_never

from roadproof.logic import show, syntax
from roadproof.logic.syntax import Bounds, Claim, Definition, Expression
from roadproof.logic.terms import SIGNAL_DIMENSIONS

_RELATION: Mapping[syntax.BinaryOperator, str] = {  # partial: * / ^ are written without a sign
    "<": "<",
    "<=": r"\le",
    ">": ">",
    ">=": r"\ge",
    "=": "=",
    "!=": r"\neq",
    "->": r"\Rightarrow",
    "<->": r"\Leftrightarrow",
    "+": "+",
    "-": "-",
}
_GREEK = {"rho", "alpha", "beta", "gamma", "delta", "epsilon", "theta", "lambda", "mu", "tau"}
_EXTREME = ("min", "max")
_WORDS = re.compile("([a-z]+)")


def latex(tree: Expression | Claim | Definition) -> str:
    """Return ``tree`` for LaTeX's mathematics mode; a definition becomes ``head \\;:=\\; body``."""
    match tree:
        case Claim(_, body):
            return _show(body, show.QUANTIFIED)
        case Definition(name, parameters, _, body, _):
            return (
                rf"{_call(name, [symbol(b.name) for b in parameters])} \;:=\; {_show(body, show.QUANTIFIED)}"
            )
        case _:  # open: every expression
            return _show(tree, show.QUANTIFIED)


def align(definitions: Iterable[Definition]) -> str:
    """Return the definitions below each other, in an ``align*`` environment."""
    rows = (latex(definition).replace(r" \;:=\; ", r" &\;:=\; ", 1) for definition in definitions)
    return "\\begin{align*}\n" + " \\\\\n".join(rows) + "\n\\end{align*}"


def _show(expression: Expression, minimum_level: int) -> str:
    shown = _operator(expression)
    return rf"\left({shown}\right)" if _level(expression) < minimum_level else shown


def _level(expression: Expression) -> int:
    """Return how tightly an expression binds in LaTeX, where a fraction needs no parentheses."""
    return (
        show.POWER
        if isinstance(expression, syntax.Binary) and expression.op == "/"
        else show.level(expression)
    )


def _operator(expression: Expression) -> str:
    match expression:
        case syntax.Literal_(bool(), _, _):
            return r"\top" if expression.value else r"\bot"
        case syntax.Literal_(value, unit, _):
            shown = "".join(_roman(part) if part.isalpha() else part for part in _WORDS.split(unit))
            return _number(Fraction(value)) + (rf"\,{shown}" if unit else "")
        case syntax.Name(name, _):
            return symbol(name)
        case syntax.Call():
            return _application(expression)
        case syntax.Prefix("not", body, _):
            return rf"\neg {_show(body, show.UNARY)}"
        case syntax.Prefix(_, body, _):
            return f"-{_show(body, show.SIGNED)}"
        case syntax.Binary("/", left, right, _):
            return rf"\frac{{{_show(left, show.QUANTIFIED)}}}{{{_show(right, show.QUANTIFIED)}}}"
        case syntax.Binary("^", left, right, _):
            return f"{_show(left, show.ATOM)}^{{{_show(right, show.QUANTIFIED)}}}"
        case syntax.Binary("*", left, right, _):
            between = r" \cdot " if _begins_with_digit(right) else " "
            return f"{_show(left, show.PRODUCT)}{between}{_show(right, show.SIGNED + 1)}"
        case syntax.Binary(op, left, right, _):
            left_level, right_level = show.operand_levels(op)
            return f"{_show(left, left_level)} {_RELATION[op]} {_show(right, right_level)}"
        case syntax.Chain(op, parts, _):
            join, inner = (r" \wedge ", show.AND) if op == "and" else (r" \vee ", show.OR)
            return join.join(_show(part, inner + 1) for part in parts)
        case syntax.Temporal(op, bounds, left, right, _) if left is not None:
            between = rf"\mathbin{{\mathcal{{{op}}}{_bounds(bounds)}}}"
            return f"{_show(left, show.UNARY)} {between} {_show(right, show.UNTIL)}"
        case syntax.Temporal(op, bounds, _, right, _):
            return rf"\mathcal{{{op}}}{_bounds(bounds)} {_show(right, show.UNARY)}"
        case syntax.Quantified(kind, variable, domain, body, _):
            big = r"\bigvee" if kind == "some" else r"\bigwedge"
            return rf"{big}_{{{_range(symbol(variable), domain)}}} {_show(body, show.UNARY)}"
        case _:
            assert_never(expression)


def _begins_with_digit(expression: Expression) -> bool:
    while isinstance(expression, syntax.Binary) and expression.op in ("*", "^"):
        expression = expression.left
    return isinstance(expression, syntax.Literal_)


def _application(call: syntax.Call) -> str:
    shown = [_show(argument, show.QUANTIFIED) for argument in call.arguments]
    if call.name in SIGNAL_DIMENSIONS and len(shown) == 1:
        letter, _, direction = call.name.partition("_")
        return f"{letter}_{{{_italic(direction)},{shown[0]}}}" if direction else f"{letter}_{{{shown[0]}}}"
    if call.name == "inverse" and len(shown) == 1:
        return rf"\frac{{1}}{{{shown[0]}}}"
    if call.name == "abs" and len(shown) == 1:
        return rf"\left|{shown[0]}\right|"
    if call.name in _EXTREME:
        return rf"\{call.name}\left({','.join(shown)}\right)"
    return _call(call.name, shown)


def _call(name: str, arguments: Iterable[str]) -> str:
    return f"{symbol(name)}({','.join(arguments)})"


def _range(variable: str, domain: syntax.Name | syntax.Call | syntax.Group) -> str:
    match domain:
        case syntax.Group(members, _):
            return rf"{variable}\in\{{{','.join(symbol(member.name) for member in members)}\}}"
        case syntax.Call("zone", (syntax.Name(zone, _),), _):
            return rf"\mathit{{zone}}({variable})={_italic(zone)}"
        case syntax.Call("lanelets", (syntax.Name(lane, _),), _):
            return rf"{variable}\in {symbol(lane)}"
        case syntax.Call("adjacentLanes", (syntax.Name(lane, _),), _):
            return rf"{variable}\in\mathit{{adjLanes}}({symbol(lane)})"
        case syntax.Name() | syntax.Call():
            return rf"{variable}\in {_show(domain, show.ATOM)}"


def _bounds(bounds: Bounds | None) -> str:
    if bounds is None:
        return ""
    high = r"\infty" if bounds.high is None else _show(bounds.high, show.QUANTIFIED)
    return rf"_{{[{_show(bounds.low, show.QUANTIFIED)},{high}]}}"


def _number(value: Fraction) -> str:
    return show.decimal(value) or rf"\frac{{{value.numerator}}}{{{value.denominator}}}"


def symbol(name: str) -> str:
    """Return a name as the paper sets it: ``a_max_lat`` as a_max with lat above, ``POV1`` with index 1.

    >>> symbol("behaviourSV_4")
    '\\\\mathit{behaviourSV}_{4}'
    """
    stem, at, qualifier = name.partition("@")
    stem, *below = [part for part in stem.split("_") if part] or [stem]
    numbered = re.fullmatch(r"(\D+)(\d+)", stem)
    if numbered and not below:
        stem, below = numbered[1], [numbered[2]]
    above = [qualifier] if at else []
    if below and below[0] in _EXTREME:
        above = [*below[1:], *above]
        lower = _roman(below[0])
    else:
        lower = ",".join(_italic(part) for part in below)
    upper = ",".join(_italic(part) for part in above)
    return _italic(stem) + (f"_{{{lower}}}" if lower else "") + (f"^{{{upper}}}" if upper else "")


def _italic(word: str) -> str:
    if word in _GREEK:
        return rf"\{word}"
    escaped = word.replace("{", r"\{").replace("}", r"\}")
    return escaped if len(word) == 1 or word.isdigit() else rf"\mathit{{{escaped}}}"


def _roman(word: str) -> str:
    return rf"\mathrm{{{word}}}"
