"""Printing of syntax trees with as few parentheses as the grammar allows; the inverse of ``logic.parse``.

``parse_claim(text(claim)) == claim`` for every claim that the parser can return. A formula is printed by
``text(as_syntax(formula))``.
"""

from collections.abc import Iterator
from fractions import Fraction
from itertools import groupby
from typing import assert_never

from roadproof.logic import syntax
from roadproof.logic.syntax import (
    LONGEST_EXPONENT,
    LONGEST_NUMBER,
    Binding,
    Bounds,
    Claim,
    Definition,
    Expression,
)

# Binding strengths of the grammar, weakest first. A quantifier extends as far right as possible.
QUANTIFIED, IFF, IMPLIES, OR, AND, UNTIL, UNARY, COMPARISON, SUM, PRODUCT, SIGNED, POWER, ATOM = range(13)
_LEVEL: dict[syntax.BinaryOperator, int] = {
    "<->": IFF,
    "->": IMPLIES,
    "<": COMPARISON,
    "<=": COMPARISON,
    ">": COMPARISON,
    ">=": COMPARISON,
    "=": COMPARISON,
    "!=": COMPARISON,
    "+": SUM,
    "-": SUM,
    "*": PRODUCT,
    "/": PRODUCT,
    "^": POWER,
}


def declarations_text(bindings: tuple[Binding, ...]) -> str:
    """Return the declarations in front of a claim as text; empty if there are none."""
    return text(Claim(bindings, syntax.Literal_(True))).removesuffix("true") if bindings else ""


def text(tree: Expression | Claim | Definition, width: int | None = None) -> str:
    """Return ``tree`` in the syntax of the parser, on lines of about ``width`` characters if given."""
    match tree:
        case Claim(given, body):
            head = f"given {_bindings(given, '; ')}: " if given else ""
            line = head + _show(body, QUANTIFIED, 0, None)
            if width is None or len(line) <= width:
                return line
            if not given:
                return _show(body, QUANTIFIED, 0, width)
            return f"{head.rstrip()}\n  {_show(body, QUANTIFIED, 2, width)}"
        case Definition():
            return _definition(tree, width)
        case _:  # open: every expression
            return _show(tree, QUANTIFIED, 0, width)


def _definition(definition: Definition, width: int | None) -> str:
    doc = f' "{definition.doc}"' if definition.doc else ""
    head = f"def {definition.name}({_bindings(definition.parameters, ', ')}){doc} := "
    line = head + _show(definition.body, QUANTIFIED, 0, None)
    if width is None or len(line) <= width:
        return line
    return f"{head.rstrip(' :=')}\n  := " + _show(definition.body, QUANTIFIED, 5, width)


def _bindings(bindings: tuple[Binding, ...], between: str) -> str:
    groups = groupby(bindings, key=lambda binding: binding.sort)
    return between.join(f"{', '.join(b.name for b in group)}: {sort}" for sort, group in groups)


def level(expression: Expression) -> int:
    """Return how tightly the outermost operator of ``expression`` binds, as one of QUANTIFIED … ATOM."""
    match expression:
        case syntax.Literal_() | syntax.Name() | syntax.Call():
            return ATOM
        case syntax.Prefix(op, _, _):
            return UNARY if op == "not" else SIGNED
        case syntax.Binary(op, _, _, _):
            return _LEVEL[op]
        case syntax.Chain(op, _, _):
            return AND if op == "and" else OR
        case syntax.Temporal(_, _, left, _, _):
            return UNARY if left is None else UNTIL
        case syntax.Quantified():
            return QUANTIFIED
        case _:
            assert_never(expression)


def operand_levels(op: syntax.BinaryOperator) -> tuple[int, int]:
    """Return the levels that the left and right side of ``op`` need to stand without parentheses."""
    match op:
        case "<->":
            return IFF, IMPLIES
        case "->":
            return OR, IMPLIES
        case "<" | "<=" | ">" | ">=" | "=" | "!=":
            return SUM, SUM
        case "+" | "-":
            return SUM, PRODUCT
        case "*" | "/":
            return PRODUCT, SIGNED
        case "^":
            return ATOM, ATOM
        case _:
            assert_never(op)


def _show(expression: Expression, minimum_level: int, indent: int, width: int | None) -> str:
    """Print ``expression``, in parentheses if it binds less tightly than ``minimum_level``.

    ``indent``: the column in which it begins; ``width``: where lines are broken, None for one line.
    """
    if isinstance(expression, syntax.Literal_):
        expression = _writable(expression)
    if width is not None:
        line = _show(expression, minimum_level, indent, None)
        if indent + len(line) <= width:
            return line
    if level(expression) < minimum_level:
        return f"({_show(expression, QUANTIFIED, indent + 1, width)})"
    broken = " " if width is None else "\n" + " " * indent
    match expression:
        case syntax.Literal_(bool(), _, _):
            return "true" if expression.value else "false"
        case syntax.Literal_(value, unit, _):
            number = decimal(Fraction(value))
            assert number is not None
            return f"{number} {unit}" if unit else number
        case syntax.Name(name, _):
            return name
        case syntax.Call(name, arguments, _):
            return f"{name}({', '.join(_show(a, QUANTIFIED, 0, None) for a in arguments)})"
        case syntax.Prefix(op, body, _):
            head = "not " if op == "not" else "-"
            return head + _show(body, level(expression), indent + len(head), width)
        case syntax.Binary("^", left, right, _):
            # A following ^ would belong to the unit, so (2 m)^2 needs its parentheses.
            base = _show(left, ATOM + 1 if isinstance(left, syntax.Literal_) and left.unit else ATOM, 0, None)
            return f"{base}^{_show(right, ATOM, 0, None)}"
        case syntax.Binary(op, left, right, _):
            left_level, right_level = operand_levels(op)
            first = _show(left, left_level, indent, width)
            if op in ("->", "<->"):
                return f"{first}{broken}{op} {_show(right, right_level, indent + len(op) + 1, width)}"
            space = "" if op in ("*", "/") else " "
            return f"{first}{space}{op}{space}{_show(right, right_level, indent, None)}"
        case syntax.Chain(op, parts, _):
            shown = _show(parts[0], level(expression) + 1, indent, width)
            for part in parts[1:]:
                shown += f"{broken}{op} {_show(part, level(expression) + 1, indent + len(op) + 1, width)}"
            return shown
        case syntax.Temporal(op, bounds, left, right, _):
            head = op + _bounds(bounds) + " "
            if left is None:
                return head + _show(right, UNARY, indent + len(head), width)
            first = _show(left, UNARY, indent, width)
            return f"{first}{broken}{head}{_show(right, UNTIL, indent + len(head), width)}"
        case syntax.Quantified(kind, variable, domain, body, _):
            head = f"{kind} {variable} in {_domain(domain)}: "
            return head + _show(body, QUANTIFIED, indent + 2, width)
        case _:
            assert_never(expression)


def _bounds(bounds: Bounds | None) -> str:
    if bounds is None:
        return ""
    high = "inf" if bounds.high is None else text(bounds.high)
    return f"[{text(bounds.low)}, {high}]"


def _domain(domain: syntax.Name | syntax.Call | syntax.Group) -> str:
    if isinstance(domain, syntax.Group):
        return "{" + ", ".join(member.name for member in domain.members) + "}"
    return text(domain)


def _writable(literal: syntax.Literal_) -> Expression:
    """Return a literal without finite decimals as a quotient, since no text can hold it; others unchanged."""
    value, at = Fraction(literal.value), literal.at
    if decimal(value) is not None:
        return literal
    above, below = (syntax.Literal_(Fraction(x), "", at) for x in (value.numerator, value.denominator))
    quotient = syntax.Binary("/", above, below, at)
    if not literal.unit:
        return quotient
    return syntax.Binary("*", quotient, syntax.Literal_(Fraction(1), literal.unit, at), at)


def decimal(value: Fraction) -> str | None:
    """Return ``value`` >= 0 in decimals, exactly; None if it has no finite decimal.

    >>> decimal(Fraction(3, 5)), decimal(Fraction(1, 3))
    ('0.6', None)
    """
    digits = _decimal_places(value.denominator)
    if digits is None:
        return None
    plain = _with_point(value, digits)
    if len(plain) <= LONGEST_NUMBER:
        return plain
    return min((plain, *_with_exponents(value)), key=len)


def _decimal_places(denominator: int) -> int | None:
    """Return how many decimals 1/denominator has; None if infinitely many."""
    places = {2: 0, 5: 0}
    for prime in places:
        while denominator % prime == 0:
            denominator //= prime
            places[prime] += 1
    return max(places.values()) if denominator == 1 else None


def _with_point(value: Fraction, digits: int) -> str:
    whole, rest = divmod(value.numerator * 10**digits // value.denominator, 10**digits)
    return f"{whole}.{rest:0{digits}}" if digits else str(whole)


def _with_exponents(value: Fraction) -> Iterator[str]:
    for exponent in range(-LONGEST_EXPONENT, LONGEST_EXPONENT + 1):
        shifted = value / Fraction(10) ** exponent
        digits = _decimal_places(shifted.denominator)
        assert digits is not None, "a power of ten changes no finite decimal into another"
        yield f"{_with_point(shifted, digits)}e{exponent}"
