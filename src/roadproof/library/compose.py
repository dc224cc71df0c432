"""Operations on queries that keep syntax tree and formula in step.

All parts must come from one specification. The ``text`` of the result parses, in that specification, to the
same formula.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Literal

from roadproof.errors import UsageError
from roadproof.library.elaborate import elaborate
from roadproof.library.specification import Query, Specification
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic.formula import Formula
from roadproof.logic.restore import as_syntax
from roadproof.logic.rewrite import road_names, vehicles_of
from roadproof.logic.syntax import Binary, Binding, Chain, Claim, Expression, Prefix, Temporal


def both(*queries: Query) -> Query:
    """Return the conjunction of ``queries``."""
    return _chain("and", queries, f.conjunction)


def either(*queries: Query) -> Query:
    """Return the disjunction of ``queries``."""
    return _chain("or", queries, f.disjunction)


def negation(query: Query) -> Query:
    """Return the negation of ``query``."""
    body = query.claim.body
    negated = body.body if isinstance(body, Prefix) and body.op == "not" else Prefix("not", body)
    return replace(
        query, claim=Claim(query.claim.given, negated), formula=f.negation(query.formula), written=""
    )


def implication(premise: Query, conclusion: Query) -> Query:
    """Return ``premise -> conclusion``."""
    combined = Binary("->", premise.claim.body, conclusion.claim.body)
    return join_queries((premise, conclusion), combined, f.implication(premise.formula, conclusion.formula))


def negated_premise(query: Query) -> Query | None:
    """Return ``not A`` for a query ``A -> B``; None for other queries."""
    body = query.claim.body
    if not isinstance(body, Binary) or body.op != "->":
        return None
    match query.formula:
        case f.Or((f.Not() as denied, _)):
            formula: Formula = denied
        case whole if body.right == syntax.Literal_(False):
            formula = whole
        case _:  # open: the formula of another claim
            return None
    return replace(
        query, claim=Claim(query.claim.given, Prefix("not", body.left)), formula=formula, written=""
    )


def contradiction(query: Query) -> Query:
    """Return ``false``, with the names of ``query``."""
    combined = syntax.Literal_(False)
    return replace(query, claim=Claim(query.claim.given, combined), formula=f.FALSE, written="")


def eventually(query: Query) -> Query:
    """Return ``F query``: it holds now or at some later time."""
    claim = Claim(query.claim.given, Temporal("F", None, None, query.claim.body))
    return replace(query, claim=claim, formula=f.Eventually(f.FOREVER, query.formula), written="")


def always(query: Query) -> Query:
    """Return ``G query``: it holds from now on."""
    claim = Claim(query.claim.given, Temporal("G", None, None, query.claim.body))
    return replace(query, claim=claim, formula=f.Always(f.FOREVER, query.formula), written="")


def in_spec_set(home: Specification, query: Query, set_name: str) -> Query:
    """Return ``query`` with all definitions of the spec set ``set_name``, elaborated in ``home``."""
    if set_name == home.set_name:
        return query

    def visit(expression: Expression) -> Expression:
        """Add the spec set to the name of every definition."""
        rebuilt = syntax.with_parts(expression, visit)
        if isinstance(rebuilt, syntax.Call) and rebuilt.name in home.definitions:
            return replace(rebuilt, name=f"{rebuilt.name}@{set_name}")
        return rebuilt

    return elaborate(home, Claim(query.claim.given, visit(query.claim.body)))


def conjunction_of(query: Query, parts: Sequence[Formula]) -> Query:
    """Return the conjunction of some sub-formulas of ``query``, with definitions called by name."""
    formula = f.conjunction(*parts)
    vehicles, roads = set(vehicles_of(formula)), road_names(formula)
    return Query(
        Claim(query.claim.given, as_syntax(formula)),
        formula,
        tuple(v for v in query.vehicles if v in vehicles),
        tuple(lane for lane in query.lanes if lane in roads),
    )


def _chain(op: Literal["and", "or"], queries: Sequence[Query], join: Callable[..., Formula]) -> Query:
    bodies = [query.claim.body for query in queries]
    combined: Expression = bodies[0] if len(bodies) == 1 else Chain(op, tuple(bodies))
    if not bodies:
        combined = syntax.Literal_(op == "and")
    return join_queries(queries, combined, join(*(query.formula for query in queries)))


def join_queries(queries: Sequence[Query], body: Expression, formula: Formula) -> Query:
    """Return a query with all names of ``queries``. Raises ``UsageError`` for a name of two sorts."""
    bindings: dict[str, Binding] = {}
    for binding in (b for query in queries for b in query.claim.given):
        known = bindings.setdefault(binding.name, binding)
        if known.sort != binding.sort:
            raise UsageError(
                f"'{binding.name}' is a {known.sort} in one formula and a {binding.sort} in another: "
                "rename it in one of them"
            )
    vehicles = vehicles_in_order(tuple(bindings.values()), {v for query in queries for v in query.vehicles})
    lanes = tuple(sorted({lane for query in queries for lane in query.lanes}))
    return Query(Claim(tuple(bindings.values()), body), formula, vehicles, lanes)


def vehicles_in_order(bindings: Sequence[Binding], vehicles: set[str]) -> tuple[str, ...]:
    """Return declared vehicles in their order, then the others by name."""
    declared = [b.name for b in bindings if b.sort == "vehicle"]
    return tuple(dict.fromkeys([*declared, *sorted(vehicles)]))


def equivalence(one: Query, other: Query) -> Query:
    """Return ``one <-> other``."""
    combined = Binary("<->", one.claim.body, other.claim.body)
    return join_queries((one, other), combined, f.equivalence(one.formula, other.formula))
