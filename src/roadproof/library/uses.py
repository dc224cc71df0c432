"""What a text speaks of: definitions, parameters that occur in them, and where a part of it is said."""

from collections.abc import Iterable
from dataclasses import replace

from roadproof.errors import Position
from roadproof.library.elaborate import notes_of
from roadproof.library.specification import Library, Query, Specification, source_of
from roadproof.logic import syntax
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.parse import parse_claim
from roadproof.logic.syntax import Definition, Expression, ParameterDeclaration
from roadproof.runtime.records import dataclass


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


@dataclass(frozen=True)
class Place:
    """An expression from ``at`` to its end in the text called ``source``, and what it means."""

    source: str
    at: Position
    formula: Formula


def places_of(specification: Specification, query: Query) -> list[Place]:
    """Every formula in the text of ``query``, called "formula", and of the definitions that it uses.

    What has no place, as in a query that was put together, is left out. Raises ``TextError``.
    """
    claim = parse_claim(query.written) if query.written else query.claim
    found: dict[tuple[str, Position, int, int, Formula], Place] = {}
    for note in notes_of(specification, claim):
        if note.at.line:
            inside = note.definition
            name = "formula" if inside is None else source_of(specification.library, inside).name
            key = (name, note.at, note.at.end_line, note.at.end_column, note.formula)
            found[key] = Place(name, note.at, note.formula)
    return list(found.values())


def nearest(places: Iterable[Place], part: Formula) -> list[Place]:
    """Where ``part`` is said; where it is only said in other texts, the shortest places that mean it too."""
    known = list(places)
    exactly = [x for x in known if x.formula == part]
    if exactly:
        return exactly
    around = [x for x in known if part in subformulas(x.formula)]
    least = {x.formula for x in around}
    least -= {x for x in least if any(y != x and y in subformulas(x) for y in least)}
    return [x for x in around if x.formula in least]
