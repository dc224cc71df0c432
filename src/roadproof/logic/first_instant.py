"""Detection of formulas that require the first instant of an open condition, which does not exist.

A vehicle occupies a lane at all instants after it has touched it, and so at no first instant. In dense time
``not p U p`` is therefore false wherever p is false at first, although F p may hold. Samples have a first
instant.
"""

from collections.abc import Iterator
from typing import assert_never

from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.logic.show import text

PAGE = "docs/explanation/entering.md"


def first_instant_warnings(formula: Formula) -> tuple[str, ...]:
    """Return a warning for each *until* of ``formula`` that requires such an instant."""
    matches = dict.fromkeys(first_instants(formula))
    if not matches:
        return ()
    from roadproof.logic.restore import as_syntax

    return tuple(
        f"'{text(as_syntax(until, expand=False))}' asks for the first instant of "
        f"'{text(as_syntax(condition, expand=False))}', an open condition without one: in dense time it is "
        f"false where the condition comes later, as F says ({PAGE})"
        for until, condition in matches
    )


def first_instants(formula: Formula) -> Iterator[tuple[f.Until, Formula]]:
    """Yield each *until* whose left side excludes an open condition of its right side, and the condition."""
    for part in f.subformulas(formula):
        if isinstance(part, f.Until):
            excluded = {_without_names(f.negation(x)) for x in _conjuncts(part.left)}
            for condition in _conjuncts(part.right):
                if f.is_state(condition) and _without_names(condition) in excluded and _is_open(condition):
                    yield part, condition
                    break


def _is_open(state: Formula) -> bool:
    from roadproof.logic.motion import is_open  # here: few formulas exclude a state and require it

    return is_open(state)


def _conjuncts(formula: Formula, positive: bool = True) -> Iterator[Formula]:
    """Yield the formula (its negation if not ``positive``) and its conjuncts, also inside definitions."""
    yield formula if positive else f.negation(formula)
    match formula:
        case f.And(parts) | f.Or(parts) if isinstance(formula, f.And) == positive:
            for part in parts:
                yield from _conjuncts(part, positive)
        case f.Not(body):
            yield from _conjuncts(body, not positive)
        case f.Application(_, _, body):
            yield from _conjuncts(body, positive)
        case f.Truth() | f.Compare() | f.Occupies() | f.Some() | f.Every() | f.And() | f.Or():
            return
        case f.Until() | f.Since() | f.Eventually() | f.Always():
            return
        case _:
            assert_never(formula)


def _without_names(formula: Formula) -> Formula:
    """Return the formula without names; a negated comparison becomes the opposite comparison."""
    match without_names(formula):
        case f.Not(f.Compare(left, op, right)):
            return f.Compare(left, f.NEGATED[op], right)
        case plain:
            return plain
