"""Formulas that ask for the first instant of an open condition, which has none.

A vehicle occupies a lane only after it has touched it: at each instant in the lane it was in the lane before.
So ``not p U p`` is false in dense time wherever p is false first, though F p holds. Samples have a first one.
"""

from collections.abc import Iterator

from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.motion import is_open
from roadproof.logic.restore import as_syntax
from roadproof.logic.rewrite import without_names
from roadproof.logic.show import text

PAGE = "docs/explanation/entering.md"


def told_first_instants(formula: Formula) -> tuple[str, ...]:
    """A line for each until of ``formula`` that asks for such an instant."""
    found = dict.fromkeys(first_instants(formula))
    return tuple(
        f"'{text(as_syntax(until, expand=False))}' asks for the first instant of "
        f"'{text(as_syntax(condition, expand=False))}', an open condition without one: in dense time it is "
        f"false where the condition comes later, as F says ({PAGE})"
        for until, condition in found
    )


def first_instants(formula: Formula) -> Iterator[tuple[f.Until, Formula]]:
    """Each until whose left side excludes an open condition that its right side needs, with the condition."""
    for part in f.subformulas(formula):
        if isinstance(part, f.Until):
            excluded = {_plain(f.negation(x)) for x in _conjuncts(part.left)}
            for condition in _conjuncts(part.right):
                if f.is_state(condition) and is_open(condition) and _plain(condition) in excluded:
                    yield part, condition
                    break


def _conjuncts(formula: Formula, positive: bool = True) -> Iterator[Formula]:
    """The formula (else its negation), and what it joins by ``and``, through the names of definitions."""
    yield formula if positive else f.negation(formula)
    match formula:
        case f.And(parts) | f.Or(parts) if isinstance(formula, f.And) == positive:
            for part in parts:
                yield from _conjuncts(part, positive)
        case f.Not(body):
            yield from _conjuncts(body, not positive)
        case f.Application(_, _, body):
            yield from _conjuncts(body, positive)
        case _:
            return


def _plain(formula: Formula) -> Formula:
    """The formula without names, and a negated comparison as the opposite one."""
    match without_names(formula):
        case f.Not(f.Compare(left, op, right)):
            return f.Compare(left, f.NEGATED[op], right)
        case plain:
            return plain
