"""Facts about one instant as proofs/kernel/Products.v sees them: of two parts each, without inverses."""

from collections.abc import Iterator, Sequence

from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.terms import Term


def binary(formula: Formula) -> Formula:
    """A formula as Coq has it: conjunctions of two, without names and without conjunctions of one or none."""
    match formula:
        case f.Application(_, _, body):
            return binary(body)
        case f.Not(body):
            return f.Not(binary(body))
        case f.And(parts) | f.Or(parts):
            if not parts:
                return f.Truth(isinstance(formula, f.And))
            *others, found = map(binary, parts)
            for x in reversed(others):
                found = type(formula)((x, found))
            return found
        case f.Compare(left, op, right):
            return f.Compare(_of_two(left), op, _of_two(right))
        case _:
            return formula


def _of_two(term: Term) -> Term:
    """A term as Coq has it: ((x + y) + z), numbers without units."""
    match term:
        case t.Number(value, _):
            return t.Number(value)
        case t.Sum(parts) | t.Product(parts) | t.Maximum(parts) | t.Minimum(parts) if parts:
            found, *others = map(_of_two, parts)
            for x in others:
                found = type(term)((found, x))
            return found
        case _:
            return t.with_children(term, tuple(map(_of_two, t.children(term))))


def comparisons(formula: Formula) -> Iterator[f.Compare]:
    """All in a formula, those of inverses without them."""
    for x in f.subformulas(formula):
        if isinstance(x, f.Compare):
            inverted = isinstance(x.left, t.Inverse) or isinstance(x.right, t.Inverse)
            yield from (y for y in f.subformulas(plain(x) if inverted else x) if isinstance(y, f.Compare))


def atoms_of(term: Term) -> Iterator[Term]:
    """What is a variable of polynomials, inner quotients first."""
    match term:
        case t.Number():
            return
        case t.Parameter() | t.Variable() | t.Signal() | t.Size() | t.Own():
            yield term
        case t.Quotient(above, t.Number(value, _)) if value:
            yield from atoms_of(above)
        case _:
            for x in t.children(term):
                yield from atoms_of(x)
            if isinstance(term, t.Quotient):
                yield term


def extrema(terms: Sequence[Term]) -> Iterator[t.Maximum | t.Minimum]:
    """Maxima and minima of two, as Coq has them: max(max(x, y), z); inner ones first."""
    for term in terms:
        yield from extrema(t.children(term))
        if isinstance(term, t.Maximum | t.Minimum) and len(term.terms) == 2:
            yield term


def plain(compare: f.Compare) -> Formula:
    """As ``plain`` of Products.v."""
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
