"""What a text speaks of: the definitions below it, and the parameters that occur in them."""

from collections.abc import Iterable
from dataclasses import replace

from roadproof.library.specification import Library, Specification
from roadproof.logic import syntax
from roadproof.logic.syntax import Definition, Expression, ParameterDeclaration


def definitions_used(specification: Specification, expression: Expression) -> tuple[Definition, ...]:
    """Every definition that ``expression`` calls, and those that they call, once, in reading order.

    One from another spec set that differs from ours is named ``name@set``. Names without a definition
    are passed over: ``spec.elaborate`` complains about them.
    """
    found: dict[str, Definition] = {}

    def visit(home: Specification, current: Expression) -> None:
        for call in syntax.walk(current):
            if not isinstance(call, syntax.Call | syntax.Name):
                continue
            name, _, qualifier = call.name.partition("@")
            there = home.in_set(qualifier) if qualifier else home
            definition = there.definitions.get(name)
            if definition is None or (isinstance(call, syntax.Name) and definition.parameters):
                continue
            ours = definition is specification.definitions.get(name)
            shown = name if ours else f"{name}@{there.set_name}"
            if shown not in found:
                found[shown] = replace(definition, name=shown)
                visit(there, definition.body)

    visit(specification, expression)
    return tuple(found.values())


def parameters_used(
    library: Library, claim: Expression, definitions: Iterable[Definition]
) -> tuple[ParameterDeclaration, ...]:
    """The parameters that occur in ``claim`` and ``definitions``, in the order of the library."""
    names = _free_names(claim, ())
    for definition in definitions:
        names |= _free_names(definition.body, (binding.name for binding in definition.parameters))
    return tuple(declared for name, declared in library.parameters.items() if name in names)


def _free_names(expression: Expression, bound: Iterable[str]) -> set[str]:
    walked = list(syntax.walk(expression))
    names = {part.name for part in walked if isinstance(part, syntax.Name)}
    return names - set(bound) - {part.variable for part in walked if isinstance(part, syntax.Quantified)}
