"""Splits a claim into parts that are proved one at a time, finds its premise and other readings."""

from collections import Counter
from collections.abc import Iterator

from roadproof.evidence.atoms import Reading, is_atom, is_temporal_name
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic import syntax
from roadproof.logic.formula import Formula


def claim_conjuncts(formula: Formula) -> Iterator[Formula]:
    """Yield the parts of nested conjunctions."""
    if isinstance(formula, f.And):
        for part in formula.parts:
            yield from claim_conjuncts(part)
    else:
        yield formula


def premise_of(query: Query, formula: Formula) -> Formula | None:
    """Return A of a claim ``A -> B``, built as ``not A or B``, or as ``not A`` where B is ``false``."""
    match query.claim.body:
        case syntax.Binary("->", _, syntax.Literal_(value)) if value is False:
            return f.negation(formula)
    match formula:
        case f.Or((f.Not(premise), _)):
            return premise
        case _:  # open: formulas of another shape are no implications
            return None


def other_readings(formula: Formula) -> Iterator[Reading]:
    """Yield alternative choices of atoms that may bring a proof.

    ``names``, where a definition about several instants occurs twice; ``lanelets``, where a predicate hides
    quantifiers over lanelets.
    """
    if any(count > 1 for count in Counter(_temporal_names(formula)).values()):
        yield "names"
    if any(isinstance(x, f.Some | f.Every) and is_atom(x) for x in f.subformulas(formula)):
        yield "lanelets"


def _temporal_names(formula: Formula) -> Iterator[Formula]:
    """Yield every occurrence of an outermost definition about several instants."""
    if is_temporal_name(formula):
        yield formula
    else:
        for part in f.children(formula):
            yield from _temporal_names(part)
