"""Where in the texts of a formula and of its definitions a part of it is said."""

from collections.abc import Iterable
from dataclasses import dataclass

from roadproof.errors import Position
from roadproof.library.elaborate import notes_of
from roadproof.library.query import Query
from roadproof.library.specification import Specification, source_of
from roadproof.logic.formula import Formula, subformulas
from roadproof.logic.parse import parse_claim


@dataclass(frozen=True)
class Place:
    """An expression from ``at`` to its end in the text called ``source``, and what it means."""

    source: str
    at: Position
    formula: Formula


def places_of(specification: Specification, query: Query, source: str = "formula") -> list[Place]:
    """Every formula in the text of ``query``, called ``source``, and of the definitions that it uses.

    What has no place, as in a query that was put together, is left out. Raises ``TextError``.
    """
    claim = parse_claim(query.written) if query.written else query.claim
    found: dict[tuple[str, Position, int, int, Formula], Place] = {}
    for note in notes_of(specification, claim):
        if note.at.line:
            inside = note.definition
            name = source if inside is None else source_of(specification.library, inside).name
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
