"""The definitions and parameters that a claim is made of, as elaboration reports them, and their places."""

from collections.abc import Iterable, Mapping
from dataclasses import replace

from roadproof.errors import Position
from roadproof.library.elaborate import entered_in, notes_of
from roadproof.library.specification import Query, Specification, source_of
from roadproof.logic import syntax
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import parameters_of
from roadproof.logic.syntax import Definition, ParameterDeclaration
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Used:
    """A claim as it is read, with the definitions, in reading order, and the parameters that it is made of.

    ``named``: each definition as it is written, by name; one of another set that differs from ours is named
    ``name@set``.
    """

    query: Query
    named: Mapping[str, Definition]
    parameters: tuple[ParameterDeclaration, ...]

    @property
    def definitions(self) -> tuple[Definition, ...]:
        """The definitions under their names."""
        return tuple(replace(x, name=name) for name, x in self.named.items())


def used_in(specification: Specification, claim: syntax.Claim) -> Used:
    """Everything that a claim is made of. Raises ``TextError``."""
    query, entered = entered_in(specification, claim)
    found: dict[str, Definition] = {}
    for (set_name, name), definition in entered.items():
        is_ours = definition is specification.definitions.get(name)
        found.setdefault(name if is_ours else f"{name}@{set_name}", definition)
    occurring = {*parameters_of(query.formula)}
    parameters = (x for name, x in specification.library.parameters.items() if name in occurring)
    return Used(query, found, tuple(parameters))


@dataclass(frozen=True)
class Place:
    """An expression from ``at`` to its end in the text called ``source``, and what it means."""

    source: str
    at: Position
    formula: Formula


def places_of(specification: Specification, query: Query) -> list[Place]:
    """Every formula in the text of ``query``, called "formula", and of the definitions that it is made of.

    What has no place, as in a query that was put together, is left out. Raises ``TextError``.
    """
    claim = parse_claim(query.written) if query.written else query.claim
    entered = [*entered_in(specification, claim)[1].values()]
    found: dict[tuple[str, Position, int, int, Formula], Place] = {}
    for note in notes_of(specification, claim):
        inside = note.definition
        if note.at.line and (inside is None or any(inside is x for x in entered)):
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
