"""Facts about one instant in the form of proofs/kernel/Products.v: binary operators only, no inverses."""

from collections.abc import Iterator, Sequence

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.terms import Term


def binary(formula: Formula) -> Formula:
    """Return a formula in Coq's form: binary conjunctions and disjunctions, definitions expanded."""
    match formula:
        case f.Application(_, _, body):
            return binary(body)
        case f.Not(body):
            return f.Not(binary(body))
        case f.And(parts) | f.Or(parts):
            if not parts:
                return f.Truth(isinstance(formula, f.And))
            *others, nested = map(binary, parts)
            for x in reversed(others):
                nested = type(formula)((x, nested))
            return nested
        case f.Compare(left, op, right):
            return f.Compare(_binary_term(left), op, _binary_term(right))
        case (
            f.Truth()
            | f.Occupies()
            | f.Some()
            | f.Every()
            | f.Until()
            | f.Since()
            | f.Eventually()
            | f.Always()
        ):
            return formula


def _binary_term(term: Term) -> Term:
    """Return a term in Coq's form: ((x + y) + z), numbers without units."""
    match term:
        case t.Number(value, _):
            return t.Number(value)
        case t.Sum(parts) | t.Product(parts) | t.Maximum(parts) | t.Minimum(parts) if parts:
            nested, *others = map(_binary_term, parts)
            for x in others:
                nested = type(term)((nested, x))
            return nested
        case _:  # open: terms of other shapes
            return t.with_children(term, tuple(map(_binary_term, t.children(term))))


def comparisons(formula: Formula) -> Iterator[f.Compare]:
    """Yield all comparisons in a formula; those of inverses are rewritten without them."""
    for part in f.subformulas(formula):
        if isinstance(part, f.Compare):
            inverted = isinstance(part.left, t.Inverse) or isinstance(part.right, t.Inverse)
            yield from (
                y for y in f.subformulas(plain(part) if inverted else part) if isinstance(y, f.Compare)
            )


def atoms_of(term: Term) -> Iterator[Term]:
    """Yield the terms that are variables of polynomials, inner quotients first."""
    match term:
        case t.Number():
            return
        case t.Parameter() | t.Variable() | t.Signal() | t.Size() | t.CustomSignal():
            yield term
        case t.Quotient(above, t.Number(value, _)) if value:
            yield from atoms_of(above)
        case t.Sum() | t.Product() | t.Power() | t.Quotient() | t.Maximum() | t.Minimum() | t.Inverse():
            for x in t.children(term):
                yield from atoms_of(x)
            if isinstance(term, t.Quotient):
                yield term


def extrema(terms: Sequence[Term]) -> Iterator[t.Maximum | t.Minimum]:
    """Yield binary maxima and minima, inner ones first."""
    for term in terms:
        yield from extrema(t.children(term))
        if isinstance(term, t.Maximum | t.Minimum) and len(term.terms) == 2:
            yield term


def plain(compare: f.Compare) -> Formula:
    """Return a comparison without inverses: ``plain`` of Products.v."""
    if compare.op in (">", ">="):
        return _lower("<" if compare.op == ">" else "<=", compare.right, compare.left)
    return _lower(compare.op, compare.left, compare.right)


def _lower(op: f.Comparison, a: Term, b: Term) -> Formula:
    below = f.Compare(_inverted(a), op, _inverted(b))
    zero, other = (_is_zero(x.term) if isinstance(x, t.Inverse) else None for x in (b, a))
    if other is None:
        return below if zero is None else f.Or((zero, below))
    if zero is None:
        return f.And((f.Not(other), below))
    if op == "<=":
        return f.Or((zero, f.And((f.Not(other), below))))
    return f.And((f.Not(other), f.Or((zero, below))))


def _inverted(term: Term) -> Term:
    return t.Quotient(t.number(1), term.term) if isinstance(term, t.Inverse) else term


def _is_zero(term: Term) -> Formula:
    return f.And((f.Compare(t.number(0), "<=", term), f.Compare(term, "<=", t.number(0))))
