"""What a state predicate says about one instant, as SMT-LIB: signals are real constants."""

from collections.abc import Iterable, Mapping
from typing import assert_never

from roadproof.evidence.times import rational
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import terms_of
from roadproof.logic.terms import Term


def symbol(leaf: t.Parameter | t.Variable | t.Signal | t.Size) -> str:
    """The SMT-LIB constant for a leaf of a term."""
    match leaf:
        case t.Parameter(name, _) | t.Variable(name, _):
            return name
        case t.Signal(name, vehicle) | t.Size(name, vehicle):
            return f"|{name}({vehicle})|"


def term(expression: Term) -> str:
    """A term without ``Inverse`` as an SMT-LIB term of sort Real."""
    match expression:
        case t.Number(value, _):
            return rational(value)
        case t.Parameter() | t.Variable() | t.Signal() | t.Size():
            return symbol(expression)
        case t.Sum(terms):
            return f"(+ {' '.join(map(term, terms))})"
        case t.Product(factors):
            return f"(* {' '.join(map(term, factors))})"
        case t.Power(base, exponent):
            return "1.0" if exponent == 0 else f"(* 1.0 {' '.join([term(base)] * exponent)})"
        case t.Quotient(numerator, denominator):
            return f"(/ {term(numerator)} {term(denominator)})"
        case t.Maximum(terms):
            return _extremum(terms, ">=")
        case t.Minimum(terms):
            return _extremum(terms, "<=")
        case t.Inverse():
            raise ValueError("an inverse stands only alone on one side of a comparison")
        case _:
            assert_never(expression)


def _extremum(terms: tuple[Term, ...], op: str) -> str:
    best = term(terms[0])
    for other in terms[1:]:
        best = f"(let ((p {best}) (q {term(other)})) (ite ({op} p q) p q))"
    return best


def comparison(compare: f.Compare) -> str:
    """A comparison as an SMT-LIB formula; 1/0 is ∞, which is above every number and equals itself."""
    left, right, op = compare.left, compare.right, compare.op
    if op in ("<", "<="):
        left, right, op = right, left, ">" if op == "<" else ">="
    at_infinity = [f"(= {term(side.term)} 0.0)" for side in (left, right) if isinstance(side, t.Inverse)]
    finite = f"({op} {_finite(left)} {_finite(right)})"
    if isinstance(left, t.Inverse) and isinstance(right, t.Inverse):
        both = "true" if op == ">=" else f"(not {at_infinity[1]})"
        return f"(ite {at_infinity[0]} {both} (and (not {at_infinity[1]}) {finite}))"
    if isinstance(left, t.Inverse):
        return f"(or {at_infinity[0]} {finite})"
    if isinstance(right, t.Inverse):
        return f"(and (not {at_infinity[0]}) {finite})"
    return finite


def _finite(side: Term) -> str:
    return f"(/ 1.0 {term(side.term)})" if isinstance(side, t.Inverse) else term(side)


def state(formula: Formula) -> str:
    """A state formula as SMT-LIB; ``occ`` and quantifiers over the road stay opaque constants."""
    match formula:
        case f.Truth(value):
            return "true" if value else "false"
        case f.Compare():
            return comparison(formula)
        case f.Occupies() | f.Some() | f.Every():
            return opaque(formula)
        case f.Not(body):
            return f"(not {state(body)})"
        case f.And(parts):
            return f"(and {' '.join(map(state, parts))})"
        case f.Or(parts):
            return f"(or {' '.join(map(state, parts))})"
        case f.Named(_, _, body):
            return state(body)
        case f.Until() | f.Eventually() | f.Always():
            raise ValueError("a state formula has no temporal operator")
        case _:
            assert_never(formula)


def opaque(formula: f.Occupies | f.Some | f.Every) -> str:
    """One Boolean constant for what only the road decides; alike in structure, alike in name."""
    match formula:
        case f.Occupies(vehicle, lanelet):
            return f"|occ({vehicle}, {lanelet})|"
        case f.Some(variable, domain, body) | f.Every(variable, domain, body):
            kind = "some" if isinstance(formula, f.Some) else "every"
            inner = state(body).replace("|", "'")
            return f"|{kind} {variable} in {domain.kind}({domain.of}): {inner}|"


def declarations(formulas: Iterable[Formula], bounds: Mapping[str, str]) -> list[str]:
    """Declarations for all that ``formulas`` speak of, with what is always known of it.

    ``bounds`` gives the declared bound of a parameter against 0 (``>``, ``>=`` or '').
    """
    reals: dict[str, str] = {}
    booleans: set[str] = set()
    for formula in formulas:
        for leaf in (leaf for side in terms_of(formula) for leaf in t.leaves(side)):
            match leaf:
                case t.Number():
                    pass
                case t.Parameter(name, _):
                    reals[symbol(leaf)] = bounds.get(name, "")
                case t.Size():
                    reals[symbol(leaf)] = ">"
                case t.Signal() | t.Variable():
                    reals[symbol(leaf)] = ""
        booleans |= set(opaque_symbols(formula))
    lines = [f"(declare-const {name} Real)" for name in sorted(reals)]
    lines += [f"(assert ({bound} {name} 0.0))" for name, bound in sorted(reals.items()) if bound]
    return lines + [f"(declare-const {name} Bool)" for name in sorted(booleans)]


def opaque_symbols(formula: Formula) -> Iterable[str]:
    """The constants of all that only the road decides in a state formula."""
    if isinstance(formula, f.Occupies | f.Some | f.Every):
        yield opaque(formula)
        return
    for child in f.children(formula):
        yield from opaque_symbols(child)
