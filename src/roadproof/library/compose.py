"""Queries put together to larger ones, on trees: what is said and what it means stay side by side.

All parts have to come from one specification. ``text`` of what comes out reads, in that specification,
as the same formula.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Literal

from roadproof.errors import UsageError
from roadproof.library.elaborate import elaborate
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic.formula import Formula
from roadproof.logic.restore import as_syntax
from roadproof.logic.rewrite import rename, rename_vehicles, road_names, vehicles_of
from roadproof.logic.syntax import Binary, BinaryOperator, Binding, Chain, Claim, Expression, Prefix, Temporal
from roadproof.logic.terms import Dimension
from roadproof.world.units import SI


def both(*queries: Query) -> Query:
    """All of ``queries`` hold."""
    return _chained("and", queries, f.conjunction)


def with_parts(query: Query, parts: Sequence[Query]) -> Query:
    """``query`` and all of ``parts``; as it was written where there are none."""
    return both(query, *parts) if parts else query


def either(*queries: Query) -> Query:
    """One of ``queries`` holds, or more."""
    return _chained("or", queries, f.disjunction)


def negation(query: Query) -> Query:
    """``query`` does not hold."""
    body = query.claim.body
    said = body.body if isinstance(body, Prefix) and body.op == "not" else Prefix("not", body)
    return replace(query, claim=Claim(query.claim.given, said), formula=f.negation(query.formula), written="")


def implication(premise: Query, conclusion: Query) -> Query:
    """``premise -> conclusion``."""
    said = Binary("->", premise.claim.body, conclusion.claim.body)
    return _joined((premise, conclusion), said, f.implication(premise.formula, conclusion.formula))


def denied_premise(query: Query) -> Query | None:
    """``not A`` of ``A -> B``; None of other claims."""
    body = query.claim.body
    if not isinstance(body, Binary) or body.op != "->":
        return None
    match query.formula:
        case f.Or((f.Not() as denied, _)):
            formula: Formula = denied
        case whole if body.right == syntax.Literal_(False):
            formula = whole
        case _:
            return None
    return replace(
        query, claim=Claim(query.claim.given, Prefix("not", body.left)), formula=formula, written=""
    )


def never(query: Query) -> Query:
    """``false``, with the names of ``query``."""
    said = syntax.Literal_(False)
    return replace(query, claim=Claim(query.claim.given, said), formula=f.FALSE, written="")


def equivalence(one: Query, other: Query) -> Query:
    """``one <-> other``."""
    said = Binary("<->", one.claim.body, other.claim.body)
    return _joined((one, other), said, f.equivalence(one.formula, other.formula))


def eventually(query: Query) -> Query:
    """``F query``: it holds now or at some later time."""
    claim = Claim(query.claim.given, Temporal("F", None, None, query.claim.body))
    return replace(query, claim=claim, formula=f.Eventually(f.FOREVER, query.formula), written="")


def always(query: Query) -> Query:
    """``G query``: it holds from now on."""
    claim = Claim(query.claim.given, Temporal("G", None, None, query.claim.body))
    return replace(query, claim=claim, formula=f.Always(f.FOREVER, query.formula), written="")


def comparison(
    specification: Specification,
    given: tuple[Binding, ...],
    left: Expression,
    op: BinaryOperator,
    value: Fraction,
    dimension: Dimension,
) -> Query:
    """``left op value`` in the names that are ``given``; ``value`` in SI units of ``dimension``."""
    return elaborate(specification, Claim(given, Binary(op, left, _quantity(value, dimension))))


def _quantity(value: Fraction, dimension: Dimension) -> Expression:
    """A number with its unit; where no unit has that dimension, a product of metres and seconds."""
    unit = SI.get(dimension)
    number: Expression = syntax.Literal_(abs(value), "" if unit in (None, "unitless") else unit or "")
    if unit is None:
        for power, base in zip(dimension, ("m", "s"), strict=True):
            for _ in range(abs(power)):
                number = Binary("*" if power > 0 else "/", number, syntax.Literal_(Fraction(1), base))
    return Prefix("-", number) if value < 0 else number


def with_vehicles(query: Query, roles: Mapping[str, str]) -> Query:
    """``query`` with every vehicle named in ``roles`` replaced by another: roles exchanged, all at once."""
    given = tuple(replace(b, name=roles.get(b.name, b.name)) for b in query.claim.given)
    return replace(
        query,
        claim=Claim(given, _with_names(query.claim.body, roles)),
        formula=rename_vehicles(query.formula, roles),
        vehicles=_ordered(given, {roles.get(v, v) for v in query.vehicles}),
        written="",
    )


def with_lane(query: Query, old: str, new: str) -> Query:
    """``query`` about the lane ``new`` where it is about the free lane ``old``."""
    given = tuple(replace(b, name=new) if b.name == old else b for b in query.claim.given)
    return replace(
        query,
        claim=Claim(given, _with_names(query.claim.body, {old: new})),
        formula=rename(query.formula, old, new),
        lanes=tuple(sorted({new if lane == old else lane for lane in query.lanes})),
        written="",
    )


def in_some_lane(query: Query, lane: str) -> Query:
    """``some M in lanes: query`` with the free lane ``lane`` as M."""
    inside = with_lane(query, lane, "M")
    given = tuple(b for b in inside.claim.given if b.name != "M")
    said = syntax.Quantified("some", "M", syntax.Name("lanes"), inside.claim.body)
    formula = f.Some("M", f.Domain("lanes"), inside.formula)
    lanes = tuple(x for x in inside.lanes if x != "M")
    return replace(inside, claim=Claim(given, said), formula=formula, lanes=lanes)


def taken_from(home: Specification, query: Query, set_name: str) -> Query:
    """``query`` with every definition taken from the spec set ``set_name``, to be read with ``home``."""
    if set_name == home.set_name:
        return query

    def visit(expression: Expression) -> Expression:
        made = syntax.with_parts(expression, visit)
        if isinstance(made, syntax.Call) and made.name in home.definitions:
            return replace(made, name=f"{made.name}@{set_name}")
        return made

    return elaborate(home, Claim(query.claim.given, visit(query.claim.body)))


def of_parts(query: Query, parts: Sequence[Formula]) -> Query:
    """The conjunction of some parts of ``query``, which calls definitions by name."""
    formula = f.conjunction(*parts)
    vehicles, roads = set(vehicles_of(formula)), road_names(formula)
    return Query(
        Claim(query.claim.given, as_syntax(formula)),
        formula,
        tuple(v for v in query.vehicles if v in vehicles),
        tuple(lane for lane in query.lanes if lane in roads),
    )


def _chained(op: Literal["and", "or"], queries: Sequence[Query], join: Callable[..., Formula]) -> Query:
    bodies = [query.claim.body for query in queries]
    said: Expression = bodies[0] if len(bodies) == 1 else Chain(op, tuple(bodies))
    if not bodies:
        said = syntax.Literal_(op == "and")
    return _joined(queries, said, join(*(query.formula for query in queries)))


def _joined(queries: Sequence[Query], said: Expression, formula: Formula) -> Query:
    given: dict[str, Binding] = {}
    for binding in (b for query in queries for b in query.claim.given):
        known = given.setdefault(binding.name, binding)
        if known.sort != binding.sort:
            raise UsageError(
                f"'{binding.name}' is a {known.sort} in one formula and a {binding.sort} in another: "
                "rename it in one of them"
            )
    vehicles = _ordered(tuple(given.values()), {v for query in queries for v in query.vehicles})
    lanes = tuple(sorted({lane for query in queries for lane in query.lanes}))
    return Query(Claim(tuple(given.values()), said), formula, vehicles, lanes)


def _ordered(given: Sequence[Binding], vehicles: set[str]) -> tuple[str, ...]:
    """Vehicles that are declared, in that order, then the others by name."""
    declared = [b.name for b in given if b.sort == "vehicle"]
    return tuple(dict.fromkeys([*declared, *sorted(vehicles)]))


def _with_names(expression: Expression, names: Mapping[str, str]) -> Expression:
    """``expression`` with free names replaced; what a quantifier inside calls by one of them stays."""
    match expression:
        case syntax.Name(name, at):
            return syntax.Name(names.get(name, name), at)
        case Binary(_, left, syntax.Name(), _) if syntax.is_kind(left):
            return replace(expression, left=_with_names(left, names))
        case Binary(_, syntax.Name(), right, _) if syntax.is_kind(right):
            return replace(expression, right=_with_names(right, names))
        case syntax.Quantified(kind, variable, domain, body, at):
            inner = {old: new for old, new in names.items() if old != variable}
            if variable in inner.values():
                raise UsageError(
                    f"'{variable}' is a variable of a quantifier inside, and would be taken for another: "
                    "rename that variable"
                )
            return syntax.Quantified(kind, variable, _in_domain(domain, names), _with_names(body, inner), at)
        case _:
            return syntax.with_parts(expression, lambda part: _with_names(part, names))


def _in_domain(
    domain: syntax.Name | syntax.Call | syntax.Group, names: Mapping[str, str]
) -> syntax.Name | syntax.Call | syntax.Group:
    match domain:
        case syntax.Name():
            return domain
        case syntax.Call(name, arguments, at):
            return syntax.Call(name, tuple(_with_names(a, names) for a in arguments), at)
        case syntax.Group(members, at):
            return syntax.Group(tuple(syntax.Name(names.get(m.name, m.name), m.at) for m in members), at)


def conjuncts(query: Query) -> tuple[Query, ...]:
    """What ``query`` joins by ``and``, each by itself; the query where it joins nothing."""
    match query.formula:
        case f.And(parts):
            return tuple(of_parts(query, (part,)) for part in parts)
        case _:
            return (query,)
