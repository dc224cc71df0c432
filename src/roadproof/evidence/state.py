"""The SMT-LIB form of a state predicate about one instant: signals are real constants."""

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from typing import assert_never

from roadproof.evidence.times import constant, smt_rational
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.node import memoised
from roadproof.logic.rewrite import leaves_of, terms_of
from roadproof.logic.terms import Term


def symbol(leaf: t.Parameter | t.Variable | t.Signal | t.Size | t.CustomSignal) -> str:
    """Return the SMT-LIB constant of a leaf of a term."""
    match leaf:
        case t.Parameter(name, _) | t.Variable(name, _):
            return constant(name)
        case t.Signal(name, vehicle) | t.Size(name, vehicle) | t.CustomSignal(name, vehicle):
            return f"|{name}({vehicle})|"


def term(expression: Term) -> str:
    """Return a term without ``Inverse`` as an SMT-LIB term of sort Real."""
    match expression:
        case t.Number(value, _):
            return smt_rational(value)
        case t.Parameter() | t.Variable() | t.Signal() | t.Size() | t.CustomSignal():
            return symbol(expression)
        case t.Sum(terms):
            return f"(+ {' '.join(map(term, terms))})"
        case t.Product(factors):
            return f"(* {' '.join(map(term, factors))})"
        case t.Power(base, exponent):
            return "1.0" if exponent == 0 else f"(* 1.0 {' '.join([term(base)] * exponent)})"
        case t.Quotient():
            return _quotient(expression)
        case t.Maximum(terms):
            return _extremum(terms, ">=")
        case t.Minimum(terms):
            return _extremum(terms, "<=")
        case t.Inverse():
            raise ValueError("an inverse stands only alone on one side of a comparison")
        case _:
            assert_never(expression)


def _quotient(quotient: t.Quotient) -> str:
    """Return a quotient; with a symbolic divisor p it is a constant q with q·p = numerator.

    A power is divided through its base, x²/p = x·(x/p), to let equal quotients share their constant.
    Nonlinear solvers can then eliminate x; with divisions they often fail.
    """
    numerator, scale, divisor = _split_divisor(quotient)
    if divisor is None:
        return f"(/ {term(numerator)} {smt_rational(scale)})"
    if isinstance(numerator, t.Power) and numerator.exponent > 1:
        rest = t.Power(numerator.base, numerator.exponent - 1)
        return f"(/ (* {term(rest)} {_ratio(numerator.base, divisor)}) {smt_rational(scale)})"
    return f"(/ {_ratio(numerator, divisor)} {smt_rational(scale)})"


def _split_divisor(quotient: t.Quotient) -> tuple[Term, Fraction, Term | None]:
    """Return the numerator, the divisor's constant part, and its symbolic part (None if it has none)."""
    factors = quotient.denominator.factors if isinstance(quotient.denominator, t.Product) else None
    scale, symbolic = Fraction(1), []
    for factor in factors or (quotient.denominator,):
        value = t.constant_value(factor)
        if value is None:
            symbolic.append(factor)
        else:
            scale *= value
    if not symbolic:
        return quotient.numerator, scale, None
    return quotient.numerator, scale, symbolic[0] if len(symbolic) == 1 else t.Product(tuple(symbolic))


def _ratio(numerator: Term, divisor: Term) -> str:
    """Return the constant that stands for numerator / divisor."""
    shown = f"{term(numerator)} / {term(divisor)}".replace("|", "'")
    return f"|{shown}|"


@memoised
def _ratios(expression: Term) -> tuple[tuple[Term, Term], ...]:
    """Return numerator and divisor of every constant that ``term`` introduces, inner ones first."""
    pairs = [ratio for child in t.children(expression) for ratio in _ratios(child)]
    if isinstance(expression, t.Quotient):
        numerator, _, divisor = _split_divisor(expression)
        if divisor is not None:
            powered = isinstance(numerator, t.Power) and numerator.exponent > 1
            divided = numerator.base if powered and isinstance(numerator, t.Power) else numerator
            pairs.append((divided, divisor))
    return tuple(pairs)


def _extremum(terms: tuple[Term, ...], op: str) -> str:
    best = term(terms[0])
    for other in terms[1:]:
        best = f"(let ((p {best}) (q {term(other)})) (ite ({op} p q) p q))"
    return best


def comparison(compare: f.Compare) -> str:
    """Return a comparison as an SMT-LIB formula; 1/0 is ∞, which is above every number and equals itself.

    Inverses are compared by the signs of their arguments, without a division.
    """
    left, right, op = compare.left, compare.right, compare.op
    if op in ("<", "<="):
        left, right, op = right, left, ">" if op == "<" else ">="
    match left, right:
        case t.Inverse(x), t.Inverse(y):
            return _inverses(term(x), term(y), op)
        case t.Inverse(x), _:
            return _above_finite(term(x), term(right), op)
        case _, t.Inverse(y):
            return _below_inverse(term(left), term(y), op)
        case _:  # open: pairs of terms without an inverse
            return f"({op} {term(left)} {term(right)})"


def _inverses(x: str, y: str, op: str) -> str:
    """Return 1/x op 1/y, where op is > or >=."""
    infinite = "true" if op == ">=" else f"(not (= {y} 0.0))"
    opposite = f"(and (> {x} 0.0) (< {y} 0.0))"
    same_sign = f"(or (and (> {x} 0.0) (> {y} 0.0)) (and (< {x} 0.0) (< {y} 0.0)))"
    return f"(ite (= {x} 0.0) {infinite} (or {opposite} (and {same_sign} ({op} {y} {x}))))"


def _above_finite(x: str, number: str, op: str) -> str:
    """Return 1/x op number, where op is > or >=."""
    positive, negative = f"({op} 1.0 (* {number} {x}))", f"({op} (* {number} {x}) 1.0)"
    return f"(or (= {x} 0.0) (and (> {x} 0.0) {positive}) (and (< {x} 0.0) {negative}))"


def _below_inverse(number: str, y: str, op: str) -> str:
    """Return number op 1/y, where op is > or >=."""
    positive, negative = f"({op} (* {number} {y}) 1.0)", f"({op} 1.0 (* {number} {y}))"
    return f"(or (and (> {y} 0.0) {positive}) (and (< {y} 0.0) {negative}))"


@memoised
def state(formula: Formula) -> str:
    """Return a state formula as SMT-LIB; ``occ`` and quantifiers over the road are opaque constants."""
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
        case f.Application(_, _, body):
            return state(body)
        case f.Until() | f.Since() | f.Eventually() | f.Always():
            raise ValueError("a state formula has no temporal operator")
        case _:
            assert_never(formula)


def opaque(formula: f.Occupies | f.Some | f.Every) -> str:
    """Return the SMT Boolean of a lane predicate; equal predicates get the same name."""
    match formula:
        case f.Occupies(vehicle, lanelet):
            return f"|occ({vehicle}, {lanelet})|"
        case f.Some(variable, domain, body) | f.Every(variable, domain, body):
            kind = "some" if isinstance(formula, f.Some) else "every"
            inner = state(body).replace("|", "'")
            return f"|{kind} {variable} in {domain.kind}({domain.of}): {inner}|"


def declarations(formulas: Iterable[Formula], bounds: Mapping[str, str]) -> list[str]:
    """Return the declarations of all symbols in ``formulas``, with the bounds that always hold.

    ``bounds`` gives the declared bound of each parameter against 0 (``>``, ``>=`` or "").
    """
    reals: dict[str, str] = {}
    custom_signals: dict[t.CustomSignal, None] = {}
    booleans: set[str] = set()
    ratios: dict[tuple[Term, Term], None] = {}
    for formula in formulas:
        for side in terms_of(formula):
            ratios |= dict.fromkeys(_ratios(side))
        for leaf in leaves_of(formula):
            match leaf:
                case t.Number():
                    pass
                case t.Parameter(name, _):
                    reals[symbol(leaf)] = bounds.get(name, "")
                case t.Size():
                    reals[symbol(leaf)] = ">"
                case t.Signal() | t.Variable():
                    reals[symbol(leaf)] = ""
                case t.CustomSignal():
                    reals[symbol(leaf)] = ""
                    custom_signals[leaf] = None
        booleans |= opaque_symbols(formula)
    lines = [f"(declare-const {name} Real)" for name in sorted(_ratio(*r) for r in ratios)]
    solved, equations = _solve(list(ratios))
    lines += [f"(declare-const {name} Real)" for name in sorted(reals) if name not in solved]
    lines += [f"(define-fun {name} () Real {value})" for name, value in solved.items()]
    lines += [f"(assert ({bound} {name} 0.0))" for name, bound in sorted(reals.items()) if bound]
    lines += [bound for leaf in sorted(custom_signals, key=symbol) for bound in _within(leaf)]
    lines += equations
    return lines + [f"(declare-const {name} Bool)" for name in sorted(booleans)]


def _within(signal: t.CustomSignal) -> Iterator[str]:
    """Yield the declared bounds of a custom signal, which hold at every instant."""
    for op, bound in (("<=", signal.low), (">=", signal.high)):
        if bound is not None:
            yield f"(assert ({op} {smt_rational(bound)} {symbol(signal)}))"


def _solve(ratios: list[tuple[Term, Term]]) -> tuple[dict[str, str], list[str]]:
    """Solve the equations q·divisor = numerator for a variable of the numerator where possible.

    An equation is solved if no other solved numerator has its variable: x + r = q·p becomes x = q·p - r.
    Returns the solutions by symbol, and the other equations as assertions.
    """
    solved: dict[str, str] = {}
    equations: list[str] = []
    used: set[t.Leaf] = set()
    for numerator, divisor in ratios:
        product = f"(* {_ratio(numerator, divisor)} {term(divisor)})"
        first, rest = _first_summand(numerator)
        free = isinstance(first, t.Variable | t.Signal) and first not in t.leaves(rest)
        if free and isinstance(first, t.Variable | t.Signal) and not used & set(t.leaves(numerator)):
            solved[symbol(first)] = f"(- {product} {term(rest)})"
            used |= {leaf for leaf in t.leaves(numerator) if isinstance(leaf, t.Variable | t.Signal)}
        else:
            equations.append(f"(assert (= {product} {term(numerator)}))")
    return solved, equations


def _first_summand(expression: Term) -> tuple[Term, Term]:
    """Return the leftmost summand of a sum, and the sum of the rest."""
    if not isinstance(expression, t.Sum) or len(expression.terms) < 2:
        return expression, t.Number(Fraction(0))
    inner, rest = _first_summand(expression.terms[0])
    return inner, t.Sum((rest, *expression.terms[1:]))


@memoised
def opaque_symbols(formula: Formula) -> frozenset[str]:
    """Return the names of all lane predicates in a state formula."""
    if isinstance(formula, f.Occupies | f.Some | f.Every):
        return frozenset({opaque(formula)})
    return frozenset[str]().union(*map(opaque_symbols, f.children(formula)))
