"""The JSON form of syntax trees: every part is an object whose ``node`` names its kind."""

from fractions import Fraction
from typing import Annotated, Literal, TypeAlias, assert_never

from roadproof.evidence.answers.shared import BindingData, BindingField
from roadproof.evidence.codec import Doc, Rule
from roadproof.evidence.schema_notes import SharedType
from roadproof.logic import syntax
from roadproof.logic.syntax import BinaryOperator, Bounds, Expression
from roadproof.runtime.records import dataclass

Low: TypeAlias = Annotated["Node", Doc("Begin of its interval, in s.")]
High: TypeAlias = Annotated["Node | None", Doc("End of its interval, in s; null is without end.")]


@dataclass(frozen=True, kw_only=True)
class TruthNode:
    """A truth value."""

    node: Literal["truth"]
    value: bool


@dataclass(frozen=True, kw_only=True)
class NumberNode:
    """A number."""

    node: Literal["number"]
    value: Fraction
    unit: Annotated[str, Doc("Empty where it has none.")]


@dataclass(frozen=True, kw_only=True)
class NameNode:
    """A name of a parameter, a vehicle or a lane."""

    node: Literal["name"]
    name: str


@dataclass(frozen=True, kw_only=True)
class CallNode:
    """A definition, a signal or a function, applied."""

    node: Literal["call"]
    name: str
    arguments: tuple["Node", ...]


@dataclass(frozen=True, kw_only=True)
class PrefixNode:
    """A negation, or a minus sign."""

    node: Literal["not", "-"]
    body: "Node"


@dataclass(frozen=True, kw_only=True)
class BinaryNode:
    """Two parts with an operator between."""

    node: BinaryOperator
    left: "Node"
    right: "Node"


@dataclass(frozen=True, kw_only=True)
class ChainNode:
    """Two or more parts with one operator between."""

    node: Literal["and", "or"]
    parts: Annotated[tuple["Node", ...], Rule(least=2)]


@dataclass(frozen=True, kw_only=True)
class WithinNode:
    """Eventually, always, once, or historically."""

    node: Literal["F", "G", "O", "H"]
    low: Low
    high: High
    body: "Node"


@dataclass(frozen=True, kw_only=True)
class UntilNode:
    """Until, since, weak until, or release."""

    node: Literal["U", "S", "W", "R"]
    low: Low
    high: High
    left: "Node"
    right: "Node"


@dataclass(frozen=True, kw_only=True)
class GroupNode:
    """A group of vehicles."""

    node: Literal["group"]
    members: Annotated[tuple[str, ...], Rule(least=1)]


@dataclass(frozen=True, kw_only=True)
class QuantifiedNode:
    """A quantifier over a name, a call such as lanelets(L), or a group of vehicles."""

    node: Literal["some", "every"]
    variable: str
    domain: NameNode | CallNode | GroupNode
    body: "Node"


@dataclass(frozen=True, kw_only=True)
class ClaimNode:
    """A claim with the free names that it declares."""

    node: Literal["claim"]
    given: tuple[BindingField, ...]
    body: "Node"


@dataclass(frozen=True, kw_only=True)
class DefinitionNode:
    """A definition."""

    node: Literal["definition"]
    name: str
    parameters: tuple[BindingField, ...]
    doc: str
    body: "Node"


Node: TypeAlias = Annotated[
    TruthNode
    | NumberNode
    | NameNode
    | CallNode
    | PrefixNode
    | BinaryNode
    | ChainNode
    | WithinNode
    | UntilNode
    | QuantifiedNode,
    Doc("A part of a formula or of a term; node says which."),
    SharedType("node"),
]


def claim_node(claim: syntax.Claim) -> ClaimNode:
    """Return the JSON tree of a claim."""
    return ClaimNode(node="claim", given=_bindings(claim.given), body=node(claim.body))


def definition_node(definition: syntax.Definition) -> DefinitionNode:
    """Return the JSON tree of a definition."""
    bindings, body = _bindings(definition.parameters), node(definition.body)
    return DefinitionNode(
        node="definition", name=definition.name, parameters=bindings, doc=definition.doc, body=body
    )


def node(expression: Expression) -> Node:
    """Return the JSON tree of an expression."""
    match expression:
        case syntax.Literal_(bool() as value, _, _):
            return TruthNode(node="truth", value=value)
        case syntax.Literal_(value, unit, _):
            return NumberNode(node="number", value=Fraction(value), unit=unit)
        case syntax.Name():
            return _name(expression)
        case syntax.Call():
            return _call(expression)
        case syntax.Prefix(op, body, _):
            return PrefixNode(node=op, body=node(body))
        case syntax.Binary(op, left, right, _):
            return BinaryNode(node=op, left=node(left), right=node(right))
        case syntax.Chain(op, parts, _):
            return ChainNode(node=op, parts=tuple(map(node, parts)))
        case syntax.Temporal():
            return _temporal(expression)
        case syntax.Quantified(kind, variable, domain, body, _):
            return QuantifiedNode(node=kind, variable=variable, domain=_domain(domain), body=node(body))
        case _:
            assert_never(expression)


def _name(name: syntax.Name) -> NameNode:
    return NameNode(node="name", name=name.name)


def _call(call: syntax.Call) -> CallNode:
    return CallNode(node="call", name=call.name, arguments=tuple(map(node, call.arguments)))


def _temporal(temporal: syntax.Temporal) -> WithinNode | UntilNode:
    bounds = temporal.bounds or Bounds(syntax.Literal_(Fraction(0)), None)
    low, high = node(bounds.low), None if bounds.high is None else node(bounds.high)
    match temporal.op:
        case "F" | "G" | "O" | "H" as op:
            return WithinNode(node=op, low=low, high=high, body=node(temporal.right))
        case "U" | "S" | "W" | "R" as op:
            assert temporal.left is not None  # the grammar
            return UntilNode(
                node=op, low=low, high=high, left=node(temporal.left), right=node(temporal.right)
            )
        case _:
            assert_never(temporal.op)


def _bindings(bindings: tuple[syntax.Binding, ...]) -> tuple[BindingData, ...]:
    return tuple(BindingData(name=x.name, sort=x.sort) for x in bindings)


def _domain(domain: syntax.Name | syntax.Call | syntax.Group) -> NameNode | CallNode | GroupNode:
    match domain:
        case syntax.Name():
            return _name(domain)
        case syntax.Call():
            return _call(domain)
        case syntax.Group(members, _):
            return GroupNode(node="group", members=tuple(x.name for x in members))
