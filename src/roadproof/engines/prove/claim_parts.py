"""The parts of a claim that are proved one at a time, and its premise."""

from collections.abc import Iterator

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
