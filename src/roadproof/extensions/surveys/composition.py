"""Operations of surveys on queries: renamed vehicles and lanes, and comparisons."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from roadproof.errors import UsageError
from roadproof.library.compose import both, conjunction_of, vehicles_in_order
from roadproof.library.elaborate import elaborate
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic.rewrite import rename, rename_vehicles
from roadproof.logic.syntax import Binary, BinaryOperator, Binding, Chain, Claim, Expression, Prefix, Temporal
from roadproof.logic.terms import Dimension
from roadproof.world.units import SI


def with_parts(query: Query, parts: Sequence[Query]) -> Query:
    """Return the conjunction of ``query`` and ``parts``; without parts, ``query`` as it was written."""
    return both(query, *parts) if parts else query


def comparison(
    specification: Specification,
    bindings: tuple[Binding, ...],
    left: Expression,
    op: BinaryOperator,
    value: Fraction,
    dimension: Dimension,
) -> Query:
    """Return ``left op value`` in the names that are ``bindings``; ``value`` in SI units of ``dimension``."""
    return elaborate(specification, Claim(bindings, Binary(op, left, _quantity(value, dimension))))


def _quantity(value: Fraction, dimension: Dimension) -> Expression:
    """Return a number with its unit; without a unit of that dimension, a product of metres and seconds."""
    unit = SI.get(dimension)
    number: Expression = syntax.Literal_(abs(value), "" if unit in (None, "unitless") else unit or "")
    if unit is None:
        for power, base in zip(dimension, ("m", "s"), strict=True):
            for _ in range(abs(power)):
                number = Binary("*" if power > 0 else "/", number, syntax.Literal_(Fraction(1), base))
    return Prefix("-", number) if value < 0 else number


def with_vehicles(query: Query, roles: Mapping[str, str]) -> Query:
    """Return ``query`` with the vehicles in ``roles`` renamed at once, so that roles can be exchanged."""
    bindings = tuple(replace(b, name=roles.get(b.name, b.name)) for b in query.claim.given)
    return replace(
        query,
        claim=Claim(bindings, _with_names(query.claim.body, roles)),
        formula=rename_vehicles(query.formula, roles),
        vehicles=vehicles_in_order(bindings, {roles.get(v, v) for v in query.vehicles}),
        written="",
    )


def with_lane(query: Query, old: str, new: str) -> Query:
    """Return ``query`` with the free lane ``old`` renamed to ``new``."""
    bindings = tuple(replace(b, name=new) if b.name == old else b for b in query.claim.given)
    return replace(
        query,
        claim=Claim(bindings, _with_names(query.claim.body, {old: new})),
        formula=rename(query.formula, old, new),
        lanes=tuple(sorted({new if lane == old else lane for lane in query.lanes})),
        written="",
    )


def in_some_lane(query: Query, lane: str) -> Query:
    """Return ``some M in lanes: query``, with M for the free lane ``lane``."""
    inside = with_lane(query, lane, "M")
    bindings = tuple(b for b in inside.claim.given if b.name != "M")
    quantified = syntax.Quantified("some", "M", syntax.Name("lanes"), inside.claim.body)
    formula = f.Some("M", f.Domain("lanes"), inside.formula)
    lanes = tuple(x for x in inside.lanes if x != "M")
    return replace(inside, claim=Claim(bindings, quantified), formula=formula, lanes=lanes)


def _with_names(expression: Expression, names: Mapping[str, str]) -> Expression:
    """Return ``expression`` with free names replaced; names that a quantifier binds stay."""
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
        case Binary() | Chain() | Prefix() | Temporal() | syntax.Call() | syntax.Literal_():
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


def split_conjunction(query: Query) -> tuple[Query, ...]:
    """Return each conjunct of ``query`` as a query; ``query`` alone if it is no conjunction."""
    if isinstance(query.formula, f.And):
        return tuple(conjunction_of(query, (part,)) for part in query.formula.parts)
    return (query,)
