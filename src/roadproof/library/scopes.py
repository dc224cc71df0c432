"""Scopes: the vehicles, lanes, lanelets, groups of vehicles and numbers that names in a claim stand for."""

import re
from collections.abc import Collection, Iterator, Mapping
from typing import TypeAlias, get_args

from roadproof.errors import Position, TextError
from roadproof.library.quantity import DURATION, Quantity, dimension_of
from roadproof.library.specification import unknown_name
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic import terms as t
from roadproof.logic.syntax import Binding, Definition, Expression
from roadproof.runtime.records import dataclass
from roadproof.world.road import Zone
from roadproof.world.units import UNITS

SORTS = ("vehicle", "vehicles", "lane", "lanelet")
_FREE = {"vehicle": re.compile(r"SV|POV[0-9]?"), "lane": re.compile(r"L[0-9]?")}  # library.ROLE


def sort_of_free(name: str) -> str | None:
    """Return the sort of a name that needs no declaration, such as SV, else None."""
    return next((sort for sort, pattern in _FREE.items() if pattern.fullmatch(name)), None)


@dataclass(frozen=True)
class Ref:
    """A reference to a vehicle, lane or lanelet."""

    sort: str
    name: str


@dataclass(frozen=True)
class Vehicles:
    """A group of vehicles."""

    names: tuple[str, ...]


Value: TypeAlias = Ref | Vehicles | Quantity
Scope: TypeAlias = Mapping[str, Value]
# Undeclared names of vehicles and lanes in a claim, by sort; they are added when they are met.
Free: TypeAlias = Mapping[str, set[str]]


def check_sort(binding: Binding) -> None:
    if binding.sort not in SORTS and binding.sort != DURATION and binding.sort not in UNITS:
        raise TextError(unknown_name("sort or unit", binding.sort, (*SORTS, DURATION, *UNITS)), binding.at)


def refuse_signal(name: str, signals: Collection[str], at: Position) -> None:
    """Raise ``TextError`` if a name that a claim declares is the name of a signal."""
    if name in signals:
        raise TextError(
            f"'{name}' is a signal of the specification", at, "Give what is declared another name."
        )


def value_of(binding: Binding) -> Value:
    """Return what a declared name stands for: itself, or a variable number."""
    if binding.sort in SORTS:
        return Ref(binding.sort, binding.name)
    dimension = dimension_of(binding.sort)
    return Quantity(t.Variable(binding.name, dimension), dimension)


def typical_value(binding: Binding) -> Value:
    """Return what a declared name stands for where any value will do; a duration is 1 s."""
    if binding.sort != DURATION:
        return value_of(binding)
    dimension = dimension_of(DURATION)
    return Quantity(t.number(1, dimension), dimension)


def claim_scope(bindings: tuple[Binding, ...], parameters: Collection[str], free: Free) -> Scope:
    """Return the declarations in front of a claim as a scope, and add its vehicles and lanes to ``free``.

    ``parameters``: those of the specification, which may not be declared again. Raises ``TextError``.
    """
    scope: dict[str, Value] = {}
    for binding in bindings:
        if binding.name in scope:
            raise TextError(f"'{binding.name}' is given twice", binding.at)
        check_sort(binding)
        if binding.sort == DURATION:
            raise TextError(
                f"'{binding.name}' is declared a duration, which only arguments of definitions are",
                binding.at,
                f"Declare a parameter in a specification file: param {binding.name} = 2 s where "
                f"{binding.name} >= 0. A claim is proved for all its values.",
            )
        if binding.sort in UNITS and binding.name in parameters:
            raise TextError(
                f"'{binding.name}' is a parameter of the specification",
                binding.at,
                "Give the variable another name.",
            )
        scope[binding.name] = value_of(binding)
        if binding.sort in free:
            free[binding.sort].add(binding.name)
    return scope


def reference(expression: Expression | Ref, sort: str, scope: Scope, free: Free | None) -> Ref:
    """Return the vehicle, lane or lanelet that an expression names. Raises ``TextError`` for another sort.

    ``free``: collects names that need no declaration; None inside definitions, which have none.
    """
    if isinstance(expression, Ref) and expression.sort == sort:
        return expression
    if isinstance(expression, Ref):
        raise TextError(f"'{expression.name}' is a {expression.sort}, but a {sort} is expected here")
    if not isinstance(expression, syntax.Name):
        raise TextError(f"a {sort} is expected here, not an expression", expression.at)
    value = scope.get(expression.name)
    if value is None:
        if free is not None and sort in _FREE and _FREE[sort].fullmatch(expression.name):
            free[sort].add(expression.name)
            return Ref(sort, expression.name)
        raise TextError(
            unknown_name(sort, expression.name, [n for n, v in scope.items() if sort_of(v) == sort]),
            expression.at,
            f"Declare it in front of the claim: given {expression.name}: {sort}: …"
            if free is not None and sort in free
            else "",
        )
    if not isinstance(value, Ref) or value.sort != sort:
        raise TextError(
            f"'{expression.name}' is a {sort_of(value)}, but a {sort} is expected here", expression.at
        )
    return value


def assign_arguments(
    definition: Definition, call: syntax.Call, scope: Scope
) -> Iterator[tuple[Binding, list[Expression | Ref]]]:
    """Yield each parameter of a definition with its arguments; a group of vehicles gets all left by the
    others.

    Raises ``TextError`` for a wrong number of arguments.
    """
    parameters = definition.parameters
    rest = _spread(call.arguments, scope)
    groups = [b for b in parameters if b.sort == "vehicles"]
    if len(groups) > 1:
        raise TextError(f"'{definition.name}' has more than one parameter of sort vehicles", call.at)
    left_over = len(rest) - len(parameters) + len(groups)
    if (groups and left_over < 1) or (not groups and left_over != 0):
        names = ", ".join(f"{b.name}: {b.sort}" for b in parameters)
        raise TextError(
            f"'{definition.name}' takes {'at least ' if groups else ''}{len(parameters)} "
            f"argument{'s' if len(parameters) != 1 else ''} but got {len(rest)}",
            call.at,
            f"It is {definition.name}({names}).",
        )
    for binding in parameters:
        count = left_over if binding.sort == "vehicles" else 1
        yield binding, rest[:count]
        rest = rest[count:]


def _spread(arguments: tuple[Expression, ...], scope: Scope) -> list[Expression | Ref]:
    """Return arguments with each group of vehicles replaced by its members."""
    spread: list[Expression | Ref] = []
    for argument in arguments:
        value = scope.get(argument.name) if isinstance(argument, syntax.Name) else None
        if isinstance(value, Vehicles):
            spread += [Ref("vehicle", name) for name in value.names]
        else:
            spread.append(argument)
    return spread


def vehicles_in(
    domain: syntax.Name | syntax.Call | syntax.Group, scope: Scope, free: Free | None
) -> list[Ref] | None:
    """Return the vehicles of a quantifier's domain; None for a domain of lanes or lanelets."""
    if isinstance(domain, syntax.Group):
        return [reference(member, "vehicle", scope, free) for member in domain.members]
    value = scope.get(domain.name) if isinstance(domain, syntax.Name) else None
    return [Ref("vehicle", name) for name in value.names] if isinstance(value, Vehicles) else None


def domain_of(domain: syntax.Name | syntax.Call | syntax.Group, scope: Scope, free: Free | None) -> f.Domain:
    """Return the lanes or lanelets of a quantifier's domain. Raises ``TextError`` for another domain."""
    if isinstance(domain, syntax.Name) and domain.name == "lanes":
        return f.Domain("lanes")
    if isinstance(domain, syntax.Call):
        argument = domain.arguments[0]
        if domain.name == "zone" and isinstance(argument, syntax.Name):
            if argument.name not in get_args(Zone):
                raise TextError(unknown_name("zone", argument.name, get_args(Zone)), argument.at)
            return f.Domain("zone", argument.name)
        if domain.name == "lanelets":
            return f.Domain("lanelets", reference(argument, "lane", scope, free).name)
        if domain.name == "adjacentLanes":
            return f.Domain("adjacent", reference(argument, "lane", scope, free).name)
    raise TextError(
        "this is no domain to quantify over",
        domain.at,
        "Use lanes, lanelets(L), zone(main), adjacentLanes(L), a group of vehicles, or {SV, POV}.",
    )


def sort_of(value: Value) -> str:
    """Return the sort of a value, for messages."""
    match value:
        case Ref(sort, _):
            return sort
        case Vehicles():
            return "group of vehicles"
        case Quantity():
            return "number"


def names_in(bound: Scope) -> tuple[str, ...]:
    """Return the arguments of an application as ``Application`` shows them."""
    names: list[str] = []
    for value in bound.values():
        match value:
            case Ref(_, name):
                names.append(name)
            case Vehicles(members):
                names += members
            case Quantity():
                names.append("…")
    return tuple(names)
