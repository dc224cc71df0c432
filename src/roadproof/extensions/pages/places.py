"""The places of the sub-formulas of a query in its text and in its definitions."""

from collections.abc import Iterable

from roadproof.errors import Position
from roadproof.library.elaborate import elaborate_with_definitions
from roadproof.library.elaboration import Elaborator
from roadproof.library.notes import FormulaNote
from roadproof.library.specification import Query, Specification, source_of
from roadproof.logic import syntax
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.parse import parse_claim
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class FormulaPlace:
    """An expression from ``at`` to its end in the text named ``source``, and its formula."""

    source: str
    at: Position
    formula: Formula


def places_of(specification: Specification, query: Query) -> list[FormulaPlace]:
    """Return the place of every formula in the text of ``query``, named "formula", and in its definitions.

    Formulas without a place, as in a composed query, are left out. Raises ``TextError``.
    """
    claim = parse_claim(query.written) if query.written else query.claim
    used_definitions = [*elaborate_with_definitions(specification, claim)[1].values()]
    places: dict[tuple[str, Position, int, int, Formula], FormulaPlace] = {}
    for note in notes_of(specification, claim):
        definition = note.definition
        if note.at.line and (definition is None or any(definition is x for x in used_definitions)):
            name = "formula" if definition is None else source_of(specification.library, definition).name
            key = (name, note.at, note.at.end_line, note.at.end_column, note.formula)
            places[key] = FormulaPlace(name, note.at, note.formula)
    return list(places.values())


def nearest(places: Iterable[FormulaPlace], part: Formula) -> list[FormulaPlace]:
    """Return the places where ``part`` is written; else the smallest expressions that contain it."""
    all_places = list(places)
    exactly = [x for x in all_places if x.formula == part]
    if exactly:
        return exactly
    around = [x for x in all_places if part in subformulas(x.formula)]
    smallest = {x.formula for x in around}
    smallest -= {x for x in smallest if any(y != x and y in subformulas(x) for y in smallest)}
    return [x for x in around if x.formula in smallest]


def notes_of(specification: Specification, claim: syntax.Claim) -> list[FormulaNote]:
    """Return the formula of every expression in a claim and in definitions that it uses. Raises
    ``TextError``.
    """
    notes: list[FormulaNote] = []
    elaborator = Elaborator(specification, notes=notes)
    elaborator.formula(claim.body, elaborator.claim_scope(claim))
    return notes
