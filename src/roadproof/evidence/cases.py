"""Case distinctions that remove maxima and minima, which nonlinear solvers handle badly."""

from collections.abc import Iterator, Sequence
from itertools import islice

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import map_terms, terms_of
from roadproof.logic.terms import Term

MOST_CASES = 64


def split(formulas: Sequence[Formula]) -> list[list[Formula]]:
    """Return conjunctions without maxima and minima; one of them holds wherever all formulas hold.

    Each conjunction includes the comparisons of its case. With more than ``MOST_CASES`` cases, the only
    result is the formulas themselves.
    """
    lifted = [f.transform(x, _lift) for x in formulas]
    conjunctions = list(islice(_cases(lifted), MOST_CASES + 1))
    return conjunctions if len(conjunctions) <= MOST_CASES else [list(formulas)]


def _lift(formula: Formula) -> Formula:
    """Return a comparison with a maximum as comparisons: x > max(p, q) becomes x > p and x > q."""
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
    """Return the term with a maximum or minimum moved outside of sums and of products with a number."""
    match term:
        case t.Sum(terms):
            summands = [_outward(part) for part in terms]
            for place, part in enumerate(summands):
                if isinstance(part, t.Maximum | t.Minimum):
                    before, after = summands[:place], summands[place + 1 :]
                    return type(part)(tuple(t.Sum((*before, choice, *after)) for choice in part.terms))
        case t.Product((t.Number(factor, _), other)):
            inner = _outward(other)
            if isinstance(inner, t.Maximum | t.Minimum):
                scaled = tuple(t.Product((t.Number(factor), choice)) for choice in inner.terms)
                if factor >= 0:
                    return type(inner)(scaled)
                return t.Minimum(scaled) if isinstance(inner, t.Maximum) else t.Maximum(scaled)
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
    """Return how the first term compares with the others if it is the extremum, and if it is not."""
    return (">=", "<") if isinstance(extremum, t.Maximum) else ("<=", ">")


def _extrema(term: Term) -> Iterator[t.Maximum | t.Minimum]:
    """Yield the maxima and minima in a term, inner ones first."""
    for child in t.children(term):
        yield from _extrema(child)
    if isinstance(term, t.Maximum | t.Minimum):
        yield term


def _replace(formula: Formula, old: Term, new: Term) -> Formula:
    return map_terms(formula, lambda term: t.replace_term(term, old, new))
