"""Maxima and minima resolved by cases: nonlinear solvers settle polynomials, and get lost in choices."""

from collections.abc import Iterator, Sequence
from itertools import islice

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import map_terms, terms_of
from roadproof.logic.terms import Term

MOST_CASES = 64


def split(formulas: Sequence[Formula]) -> list[list[Formula]]:
    """Conjunctions without maxima and minima, one of which holds wherever all ``formulas`` do.

    Each adds the comparisons that it assumes. Where there would be more than ``MOST_CASES``, the
    formulas come back as they are.
    """
    lifted = [f.transform(x, _lift) for x in formulas]
    made = list(islice(_cases(lifted), MOST_CASES + 1))
    return made if len(made) <= MOST_CASES else [list(formulas)]


def _lift(formula: Formula) -> Formula:
    """A comparison with a maximum as a summand is one of comparisons: x > max(p, q) is x > p and x > q."""
    if not isinstance(formula, f.Compare):
        return formula
    left, right = _outward(formula.left), _outward(formula.right)
    if isinstance(left, t.Maximum | t.Minimum):
        parts = [_lift(f.Compare(part, formula.op, right)) for part in left.terms]
        some = isinstance(left, t.Maximum) == (formula.op in (">", ">="))
    elif isinstance(right, t.Maximum | t.Minimum):
        parts = [_lift(f.Compare(left, formula.op, part)) for part in right.terms]
        some = isinstance(right, t.Maximum) == (formula.op in ("<", "<="))
    else:
        return formula
    return f.disjunction(*parts) if some else f.conjunction(*parts)


def _outward(term: Term) -> Term:
    """``term`` with a maximum or minimum that is added or scaled by a number moved to the outside."""
    match term:
        case t.Sum(terms):
            moved = [_outward(part) for part in terms]
            for place, part in enumerate(moved):
                if isinstance(part, t.Maximum | t.Minimum):
                    before, after = moved[:place], moved[place + 1 :]
                    return type(part)(tuple(t.Sum((*before, choice, *after)) for choice in part.terms))
        case t.Product((t.Number(factor, _), other)):
            inner = _outward(other)
            if isinstance(inner, t.Maximum | t.Minimum):
                scaled = tuple(t.Product((t.Number(factor), choice)) for choice in inner.terms)
                if factor >= 0:
                    return type(inner)(scaled)
                return t.Minimum(scaled) if isinstance(inner, t.Maximum) else t.Maximum(scaled)
        case _:
            pass
    return term


def _cases(formulas: list[Formula]) -> Iterator[list[Formula]]:
    chosen = next((e for x in formulas for side in terms_of(x) for e in _extrema(side)), None)
    if chosen is None:
        yield formulas
        return
    first, *others = chosen.terms
    if not others:
        yield from _cases([_replace(x, chosen, first) for x in formulas])
        return
    rest = others[0] if len(others) == 1 else type(chosen)(tuple(others))
    wins, loses = _comparisons(chosen)
    for condition, winner in ((f.Compare(first, wins, rest), first), (f.Compare(first, loses, rest), rest)):
        yield from _cases([*(_replace(x, chosen, winner) for x in formulas), condition])


def _comparisons(extremum: t.Maximum | t.Minimum) -> tuple[f.Comparison, f.Comparison]:
    """How the first term compares with the others where it is the extremum, and where it is not."""
    return (">=", "<") if isinstance(extremum, t.Maximum) else ("<=", ">")


def _extrema(term: Term) -> Iterator[t.Maximum | t.Minimum]:
    """The maxima and minima in ``term``, inner ones first."""
    for child in t.children(term):
        yield from _extrema(child)
    if isinstance(term, t.Maximum | t.Minimum):
        yield term


def _replace(formula: Formula, old: Term, new: Term) -> Formula:
    return map_terms(formula, lambda term: t.put(term, old, new))
