"""The parts of a claim that are proved one at a time, its premise, and readings that may bring a proof."""

from collections import Counter
from collections.abc import Iterator

from roadproof.evidence.atoms import Reading, is_atom, is_temporal_name
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic.formula import Formula


def conjuncts(formula: Formula) -> Iterator[Formula]:
    """The parts of a conjunction, of its conjunctions, and so on."""
    if isinstance(formula, f.And):
        for part in formula.parts:
            yield from conjuncts(part)
    else:
        yield formula


def premise_of(query: Query, formula: Formula) -> Formula | None:
    """A of a claim ``A -> B``, which is built as ``not A or B``, and as ``not A`` where B is ``false``."""
    match query.claim.body:
        case syntax.Binary("->", _, syntax.Literal_(value)) if value is False:
            return f.negation(formula)
    match formula:
        case f.Or((f.Not(premise), _)):
            return premise
        case _:
            return None


def other_readings(formula: Formula) -> Iterator[Reading]:
    """Readings other than the usual one that the claim gives a reason to try.

    By names where a definition about several instants is met twice; by lanelets where a predicate hides them.
    """
    if any(count > 1 for count in Counter(_temporal_names(formula)).values()):
        yield "names"
    if any(isinstance(x, f.Some | f.Every) and is_atom(x) for x in f.subformulas(formula)):
        yield "lanelets"


def _temporal_names(formula: Formula) -> Iterator[Formula]:
    """Definitions about several instants that are part of no other, as often as they are met."""
    if is_temporal_name(formula):
        yield formula
    else:
        for part in f.children(formula):
            yield from _temporal_names(part)
