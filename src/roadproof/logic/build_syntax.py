"""Conversion of lark's parse trees to syntax trees."""

from fractions import Fraction
from typing import Any, Literal, cast

from lark import Token, v_args
from lark.tree import Meta
from lark.visitors import Transformer_NonRecursive

from roadproof.errors import Position, TextError
from roadproof.logic import syntax
from roadproof.logic.instances import expand_each
from roadproof.logic.syntax import LONGEST_EXPONENT, LONGEST_NUMBER, Expression, Statement
from roadproof.world.units import UNITS

GREATEST_POWER = 8


def short_token(token: str) -> str:
    """Return a token for a message, cut after 30 characters."""
    return token if len(token) <= 30 else token[:30] + "…"


def _at(meta: Meta) -> Position:
    begin = getattr(meta, "line", 1), getattr(meta, "column", 1)
    return Position(*begin, getattr(meta, "end_line", 0) or 0, getattr(meta, "end_column", 0) or 0)


def _token_at(token: Token) -> Position:
    return Position(token.line or 1, token.column or 1, token.end_line or 0, token.end_column or 0)


def _rational(token: Token) -> Fraction:
    exponent = token.lower().partition("e")[2]
    if len(exponent) > 4 or abs(int(exponent or 0)) > LONGEST_EXPONENT or len(token) > LONGEST_NUMBER:
        raise TextError(
            f"the number {short_token(str(token))} is out of range: write at most {LONGEST_NUMBER} digits "
            f"and an exponent between -{LONGEST_EXPONENT} and {LONGEST_EXPONENT}",
            _token_at(token),
        )
    return Fraction(str(token))


def _integer(token: Token, greatest: int) -> int:
    value = _rational(token)
    if value.denominator != 1 or value > greatest:
        raise TextError(
            f"{short_token(str(token))} cannot stand here: use a whole number from 0 to {greatest}",
            _token_at(token),
        )
    return int(value)


def _written_out(items: list[Any]) -> tuple[syntax.Definition, ...]:
    """Return the definitions of a block, with ``each`` blocks in it expanded."""
    several = (expand_each(x) if isinstance(x, syntax.EachBlock) else [x] for x in items)
    return tuple(definition for some in several for definition in some)


def _doc(token: Token | None) -> str:
    return "" if token is None else str(token)[1:-1]


def _range(name: str, sort: str, within: tuple[Any, Any], at: Position) -> tuple[Any, Any]:
    """Return both bounds of a signal in its unit, None if unbounded."""
    ends: list[Fraction | None] = []
    for end, without in zip(within, ("-inf", "inf"), strict=True):
        if isinstance(end, str):
            if end != without:
                raise TextError(f"signal '{name}' has no values: its bounds are the wrong way round", at)
            ends.append(None)
            continue
        value, unit, place = end
        factor, dimension = UNITS[unit or sort]
        if dimension != UNITS[sort][1]:
            raise TextError(f"signal '{name}' is in {sort}, but its bound is in {unit}", place)
        ends.append(value * factor / UNITS[sort][0])
    low, high = ends
    if low is not None and high is not None and low >= high:
        raise TextError(
            f"signal '{name}' has no room: low={low} is not below high={high}",
            at,
            "Write the smaller bound first.",
        )
    return low, high


@v_args(meta=True)
class SyntaxBuilder(Transformer_NonRecursive[Token, Any]):
    """Converter of a parse tree, bottom up; each method makes the node of the grammar rule of its name.

    It is not recursive, so that deeply nested input cannot exhaust the stack.
    """

    def literal(self, meta: Meta, items: list[Token]) -> Expression:
        unit = str(items[1]) if len(items) > 1 and items[1] is not None else ""
        return syntax.Literal_(_rational(items[0]), unit, _at(meta))

    def true(self, meta: Meta, _: list[Token]) -> Expression:
        return syntax.Literal_(True, "", _at(meta))

    def false(self, meta: Meta, _: list[Token]) -> Expression:
        return syntax.Literal_(False, "", _at(meta))

    def name(self, meta: Meta, items: list[Token]) -> syntax.Name:
        return syntax.Name(str(items[0]), _at(meta))

    def call(self, meta: Meta, items: list[Any]) -> Expression:
        arguments = tuple(i for i in items[1:] if i is not None)
        return syntax.Call(str(items[0]), arguments, _at(meta))

    def _binary(self, meta: Meta, items: list[Any]) -> Expression:
        return syntax.Binary(cast(syntax.BinaryOperator, str(items[1])), items[0], items[2], _at(meta))

    comparison = sum = product = _binary

    def power(self, meta: Meta, items: list[Any]) -> Expression:
        exponent = syntax.Literal_(Fraction(_integer(items[1], GREATEST_POWER)), "", _at(meta))
        return syntax.Binary("^", items[0], exponent, _at(meta))

    def minus(self, meta: Meta, items: list[Any]) -> Expression:
        return syntax.Prefix("-", items[-1], _at(meta))

    def negation(self, meta: Meta, items: list[Any]) -> Expression:
        return syntax.Prefix("not", items[0], _at(meta))

    def iff(self, meta: Meta, items: list[Any]) -> Expression:
        return syntax.Binary("<->", items[0], items[1], _at(meta))

    def implies(self, meta: Meta, items: list[Any]) -> Expression:
        return syntax.Binary("->", items[0], items[1], _at(meta))

    def _chain(self, meta: Meta, items: list[Any], op: Literal["and", "or"]) -> Expression:
        return syntax.Chain(op, tuple(items), _at(meta))

    def or_(self, meta: Meta, items: list[Any]) -> Expression:
        return self._chain(meta, items, "or")

    def and_(self, meta: Meta, items: list[Any]) -> Expression:
        return self._chain(meta, items, "and")

    def _infix(self, meta: Meta, items: list[Any], op: syntax.TemporalOperator) -> Expression:
        return syntax.Temporal(op, items[1], items[0], items[2], _at(meta))

    def _prefix(self, meta: Meta, items: list[Any], op: syntax.TemporalOperator) -> Expression:
        return syntax.Temporal(op, items[0], None, items[1], _at(meta))

    def until(self, meta: Meta, items: list[Any]) -> Expression:
        return self._infix(meta, items, "U")

    def since(self, meta: Meta, items: list[Any]) -> Expression:
        return self._infix(meta, items, "S")

    def weak_until(self, meta: Meta, items: list[Any]) -> Expression:
        return self._infix(meta, items, "W")

    def release(self, meta: Meta, items: list[Any]) -> Expression:
        return self._infix(meta, items, "R")

    def eventually(self, meta: Meta, items: list[Any]) -> Expression:
        return self._prefix(meta, items, "F")

    def always(self, meta: Meta, items: list[Any]) -> Expression:
        return self._prefix(meta, items, "G")

    def once(self, meta: Meta, items: list[Any]) -> Expression:
        return self._prefix(meta, items, "O")

    def historically(self, meta: Meta, items: list[Any]) -> Expression:
        return self._prefix(meta, items, "H")

    def interval(self, meta: Meta, items: list[Any]) -> syntax.Bounds:
        high = None if isinstance(items[1], Token) else items[1]
        return syntax.Bounds(items[0], high, _at(meta))

    def quantified(self, meta: Meta, items: list[Any]) -> Expression:
        kind: Literal["some", "every"] = "some" if items[0] == "some" else "every"
        return syntax.Quantified(kind, str(items[1]), items[2], items[3], _at(meta))

    def lane_at_start(self, meta: Meta, items: list[Any]) -> Expression:
        """Return ``let L = lane of a at start: p`` as "a is in some lanelet of some lane L, and p"."""
        lane, vehicle, body = items
        where, at = f"{lane}_lanelet", _token_at(vehicle)
        occupies = syntax.Call("occ", (syntax.Name(str(vehicle), at), syntax.Name(where, at)), at)
        lanelets = syntax.Call("lanelets", (syntax.Name(str(lane), at),), at)
        inside = syntax.Quantified("some", where, lanelets, occupies, at)
        both = syntax.Chain("and", (inside, body), _at(meta))
        return syntax.Quantified("some", str(lane), syntax.Name("lanes"), both, _at(meta), at_start=True)

    def domain_of(self, meta: Meta, items: list[Token]) -> syntax.Call:
        inner = syntax.Name(str(items[1]), _token_at(items[1]))
        return syntax.Call(str(items[0]), (inner,), _at(meta))

    def group(self, meta: Meta, items: list[Token]) -> syntax.Group:
        return syntax.Group(tuple(syntax.Name(str(t), _token_at(t)) for t in items), _at(meta))

    def sort(self, _: Meta, items: list[Token]) -> str:
        return str(items[0])

    def binding(self, _: Meta, items: list[Any]) -> tuple[syntax.Binding, ...]:
        *names, sort = items
        return tuple(syntax.Binding(str(n), sort, _token_at(n)) for n in names)

    def bindings(self, _: Meta, items: list[Any]) -> tuple[syntax.Binding, ...]:
        return tuple(b for group in items if group is not None for b in group)

    given = bindings

    def claim(self, _: Meta, items: list[Any]) -> syntax.Claim:
        return syntax.Claim(items[0] or (), items[1])

    def signed(self, _: Meta, items: list[Any]) -> Fraction:
        value = _rational(items[1])
        return value if items[0] is None else -value

    def bound(self, _: Meta, items: list[Token]) -> tuple[Token, str]:
        return items[0], str(items[1])

    def parameter(self, meta: Meta, items: list[Any]) -> Statement:
        """Return a parameter declaration. Raises ``TextError`` if ``where`` is about another name."""
        name, value, unit, bound, doc = items
        if bound is not None and str(bound[0]) != str(name):
            raise TextError(
                f"'where {bound[0]}' speaks of another parameter than '{name}'",
                _token_at(bound[0]),
                f"Write where {name} {bound[1]} 0.",
            )
        comparison: syntax.ParameterBound = "" if bound is None else bound[1]
        return syntax.ParameterDeclaration(str(name), value, str(unit), comparison, _doc(doc), _at(meta))

    def edge(self, meta: Meta, items: list[Any]) -> tuple[Fraction, str, Position]:
        return items[0], "" if items[1] is None else str(items[1]), _at(meta)

    def no_edge(self, _: Meta, items: list[Token | None]) -> str:
        return "inf" if items[0] is None else "-inf"

    def within(self, _: Meta, items: list[Any]) -> tuple[Any, Any]:
        return items[0], items[1]

    def signal(self, meta: Meta, items: list[Any]) -> Statement:
        """Return a signal declaration. Raises ``TextError`` for a wrong unit, range or number of vehicles."""
        name, bindings, sort, within, doc, *rest = items
        body = rest[0] if rest else None
        vehicle = ""
        if bindings is not None:
            if len(bindings) != 1 or bindings[0].sort != "vehicle":
                raise TextError(
                    f"signal '{name}' is of one vehicle or of none",
                    bindings[0].at,
                    f"Write signal {name}(a: vehicle): {sort}, or signal {name}: {sort}.",
                )
            vehicle = bindings[0].name
        if sort not in UNITS and sort != "bool":
            raise TextError(
                f"'{sort}' is no unit of a signal", _at(meta), f"There are {', '.join((*UNITS, 'bool'))}."
            )
        if within is not None and (sort == "bool" or body is not None):
            why = "is true or false" if sort == "bool" else "is derived, so its bounds follow"
            raise TextError(f"signal '{name}' {why}", _at(meta), "Leave out in […].")
        low, high = (None, None) if within is None else _range(str(name), sort, within, _at(meta))
        return syntax.SignalDeclaration(str(name), vehicle, sort, low, high, _doc(doc), body, _token_at(name))

    def option(self, meta: Meta, items: list[Any]) -> Statement:
        *names, doc = items
        values = tuple(str(v) for v in names[1:])
        return syntax.OptionDeclaration(str(names[0]), values, _doc(doc), _at(meta))

    def definition(self, meta: Meta, items: list[Any]) -> syntax.Definition:
        name, bindings, doc, body = items
        return syntax.Definition(str(name), bindings, _doc(doc), body, _token_at(name))

    def range(self, _: Meta, items: list[Any]) -> tuple[int, ...]:
        """Return the numbers from low to high, both included. Raises ``TextError`` for none or too many."""
        low = _integer(items[0], 10_000)
        high = low if items[1] is None else _integer(items[1], 10_000)
        if high < low or high - low > 1_000:
            raise TextError(
                f"the range {low}..{high} is empty or too long: write low..high, at most 1,000 apart",
                _token_at(items[0]),
            )
        return tuple(range(low, high + 1))

    def each(self, meta: Meta, items: list[Any]) -> Statement:
        """Return a block of definitions with its indices; ``expand_each`` expands it."""
        ranges = [i for i in items[1:] if isinstance(i, tuple)]
        definitions = tuple(i for i in items[1:] if isinstance(i, syntax.Definition))
        indices = tuple(index for r in ranges for index in r)
        return syntax.EachBlock(str(items[0]), indices, definitions, _at(meta))

    def set(self, meta: Meta, items: list[Any]) -> Statement:
        """Return a spec set with its parent ('' for none)."""
        name, parent, doc, *definitions = items
        return syntax.SetBlock(
            str(name), "" if parent is None else str(parent), _doc(doc), _written_out(definitions), _at(meta)
        )

    def when(self, meta: Meta, items: list[Any]) -> Statement:
        option, value, *definitions = items
        return syntax.WhenBlock(str(option), str(value), _written_out(definitions), _at(meta))

    def lane(self, meta: Meta, items: list[Any]) -> Statement:
        vehicle, *ranges, doc = items
        numbers = tuple(number for r in ranges for number in r)
        return syntax.LaneDeclaration(str(vehicle), numbers, _doc(doc), _at(meta))

    def title(self, meta: Meta, items: list[Any]) -> Statement:
        *ranges, title, sentence = items
        numbers = tuple(number for r in ranges for number in r)
        return syntax.TitleDeclaration(numbers, _doc(title), _doc(sentence), _at(meta))

    def library(self, _: Meta, items: list[Any]) -> tuple[Statement, ...]:
        return tuple(items)


setattr(SyntaxBuilder, "or", SyntaxBuilder.or_)
setattr(SyntaxBuilder, "and", SyntaxBuilder.and_)
