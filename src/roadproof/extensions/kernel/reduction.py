"""Fewer variables for the search of a contradiction: solve equations, and drop directions without effect.

An equation in which a variable has a constant factor gives that variable; a multiple of the equation is added
to each constraint. If all nonlinear constraints depend only on differences of variables, such as gaps between
vehicles, one variable stands for each difference. Linear inequalities that follow from others are dropped.
Not trusted: Coq adds the result up.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import log2

from roadproof.extensions.kernel.cone import Constraint, coq, echelon, number, whole_factor
from roadproof.world.polynomial import Polynomial, constant, variable

_SMALL = 1e-6


@dataclass(frozen=True)
class PolynomialInequality:
    """The condition that ``polynomial`` is at least 0, or above 0 if ``strict``, with a proof for Coq.

    ``scale``: the factor between this polynomial and the proved one.
    """

    polynomial: Polynomial[int]
    strict: bool
    proof_text: str
    scale: Fraction = Fraction(1)


@dataclass(frozen=True)
class PolynomialEquation:
    """The condition that ``polynomial`` is 0; ``times``: the proof for Coq that a multiple is 0."""

    polynomial: Polynomial[int]
    times: Callable[[Polynomial[int]], str]


@dataclass(frozen=True)
class Reduction:
    """Constraints in fewer variables; ``lifted``: each variable as a polynomial in Coq's variables."""

    inequalities: tuple[PolynomialInequality, ...]
    equations: tuple[PolynomialEquation, ...]
    lifted: Mapping[int, Polynomial[int]]

    def lift(self, polynomial: Polynomial[int]) -> Polynomial[int]:
        """Return a polynomial in Coq's variables."""
        return polynomial.substitute(lambda x: self.lifted.get(x, variable(x)))


def reduce_constraints(constraints: Sequence[Constraint]) -> Reduction:
    """Return consequences of the constraints in fewer variables, with proofs for Coq.

    Equations are solved where possible; then variables are dropped along which no nonlinear constraint or
    equation changes. Linear inequalities that change along these are lost, except sums of two whose
    changes cancel. So a contradiction of the result is one of the constraints, but not always conversely.
    """
    inequalities, equations = _given(constraints)
    left: list[PolynomialEquation] = []
    while equations:
        equation = equations.pop(0)
        solved = _solvable(equation.polynomial)
        if solved is None:
            left.append(equation)
            continue
        inequalities = [_without(x, equation, solved) for x in inequalities]
        equations, left = (
            [_without_in_equation(x, equation, solved) for x in some] for some in (equations, left)
        )
        equations, left = equations + left, []
    return _flat(_useful(inequalities), [x for x in left if x.polynomial.terms])


def _given(constraints: Sequence[Constraint]) -> tuple[list[PolynomialInequality], list[PolynomialEquation]]:
    """Return inequalities and equations; two opposite inequalities also give an equation."""
    inequalities: list[PolynomialInequality] = []
    equations: list[PolynomialEquation] = []
    last = len(constraints) - 1
    by_terms: dict[frozenset[tuple[tuple[int, ...], Fraction]], str] = {}
    for place, constraint in enumerate(constraints):
        proof_text = f"(given_ {last - place})"
        if constraint.kind == "zero":
            equations.append(PolynomialEquation(constraint.polynomial, _multiple(proof_text)))
            continue
        inequalities.append(
            PolynomialInequality(constraint.polynomial, constraint.kind == "above", proof_text)
        )
        opposite = by_terms.get(frozenset(constraint.polynomial.scaled(Fraction(-1)).terms.items()))
        if opposite is not None:
            equations.append(PolynomialEquation(constraint.polynomial, _both(proof_text, opposite)))
        by_terms[frozenset(constraint.polynomial.terms.items())] = proof_text
    return inequalities, equations


def _multiple(proof_text: str) -> Callable[[Polynomial[int]], str]:
    return lambda factor: f"(times_ {coq(factor)} {proof_text})"


def _both(up: str, down: str) -> Callable[[Polynomial[int]], str]:
    """Return the proof of a multiple c of two opposites: (c/2 + 1/2)^2 of one, (c/2 - 1/2)^2 of the other."""

    def times(factor: Polynomial[int]) -> str:
        half: Polynomial[int] = constant(Fraction(1, 2))
        if factor.degree == 0:
            q = factor.constant
            return f"(product_ {number(abs(q))} {up if q >= 0 else down})"
        plus, minus = factor * half + half, factor * half - half
        return f"(sum_ (product_ (square_ {coq(plus)}) {up}) (product_ (square_ {coq(minus)}) {down}))"

    return times


# --- equations -----------------------------------------------------------------------------------


def _solvable(equation: Polynomial[int]) -> int | None:
    """Return a variable that occurs in one term of the equation, with a number as its only factor."""
    for monomial in sorted(equation.terms, reverse=True):
        if len(monomial) == 1 and sum(monomial[0] in x for x in equation.terms) == 1:
            return monomial[0]
    return None


def _quotient(polynomial: Polynomial[int], equation: Polynomial[int], solved: int) -> Polynomial[int]:
    """Return the multiple of an equation that, subtracted from a polynomial, eliminates a variable."""
    result: Polynomial[int] = constant(Fraction(0))
    while True:
        rest = polynomial - result * equation
        parts = {m: q for m, q in rest.terms.items() if solved in m}
        if not parts:
            return result
        factor = equation.terms[(solved,)]
        result = result + Polynomial({_once_less(m, solved): q / factor for m, q in parts.items()})


def _once_less(monomial: tuple[int, ...], solved: int) -> tuple[int, ...]:
    place = monomial.index(solved)
    return monomial[:place] + monomial[place + 1 :]


def _without(x: PolynomialInequality, equation: PolynomialEquation, solved: int) -> PolynomialInequality:
    factor = _quotient(x.polynomial, equation.polynomial, solved)
    if not factor.terms:
        return x
    minus = factor.scaled(Fraction(-1))
    return replace(
        x,
        polynomial=x.polynomial + minus * equation.polynomial,
        proof_text=f"(sum_ {x.proof_text} {equation.times(minus)})",
    )


def _without_in_equation(
    x: PolynomialEquation, equation: PolynomialEquation, solved: int
) -> PolynomialEquation:
    minus = _quotient(x.polynomial, equation.polynomial, solved).scaled(Fraction(-1))
    if not minus.terms:
        return x

    def times(factor: Polynomial[int]) -> str:
        return f"(sum_ {x.times(factor)} {equation.times(factor * minus)})"

    return PolynomialEquation(x.polynomial + minus * equation.polynomial, times)


# --- inequalities --------------------------------------------------------------------------------


def _useful(inequalities: Sequence[PolynomialInequality]) -> list[PolynomialInequality]:
    """Return distinct inequalities with whole coefficients, without trivial ones."""
    useful: dict[frozenset[tuple[tuple[int, ...], Fraction]], PolynomialInequality] = {}
    for inequality in inequalities:
        if not inequality.polynomial.terms:
            continue
        if inequality.polynomial.degree == 0 and inequality.polynomial.constant > 0:
            continue
        scale = whole_factor(inequality.polynomial.terms.values())
        scaled = inequality.polynomial.scaled(scale)
        key = frozenset(scaled.terms.items())
        if key not in useful or inequality.strict:
            proof_text = (
                inequality.proof_text if scale == 1 else f"(product_ {number(scale)} {inequality.proof_text})"
            )
            useful[key] = PolynomialInequality(scaled, inequality.strict, proof_text)
    return list(useful.values())


# --- directions ----------------------------------------------------------------------------------


def _flat(inequalities: list[PolynomialInequality], equations: list[PolynomialEquation]) -> Reduction:
    """Drop variables along which no nonlinear constraint changes, and what is linear and changes there."""
    nonlinear = [x.polynomial for x in inequalities if x.polynomial.degree > 1]
    nonlinear += [x.polynomial for x in equations]
    variables = sorted({v for x in inequalities for v in x.polynomial.variables})
    rows: dict[tuple[int, tuple[int, ...]], dict[int, Fraction]] = {}
    for place, polynomial in enumerate(nonlinear):
        for v in variables:
            for monomial, factor in _derivative(polynomial, v).terms.items():
                rows.setdefault((place, monomial), {})[v] = factor
    pivots = echelon(rows.values(), -1)
    forms = {v: Polynomial({(x,): q for x, q in row.items()}) for v, row in (pivots or {}).items()}
    dropped = {v for v in variables if v not in forms}
    zero: Polynomial[int] = constant(Fraction(0))

    def change(x: PolynomialInequality) -> Polynomial[int]:
        """Return the difference that the change of variables makes; 0 if the inequality is unchanged."""
        projected = x.polynomial.substitute(lambda v: zero if v in dropped else forms.get(v, variable(v)))
        return projected - x.polynomial

    def cut(polynomial: Polynomial[int]) -> Polynomial[int]:
        return polynomial.substitute(lambda x: zero if x in dropped else variable(x))

    return _scaled(
        Reduction(
            tuple(
                _independent(
                    [replace(x, polynomial=cut(x.polynomial)) for x in _invariant(inequalities, change)]
                )
            ),
            tuple(replace(x, polynomial=cut(x.polynomial)) for x in equations),
            forms,
        )
    )


def _derivative(polynomial: Polynomial[int], v: int) -> Polynomial[int]:
    derivative: Polynomial[int] = constant(Fraction(0))
    for monomial, factor in polynomial.terms.items():
        if v in monomial:
            derivative = derivative + Polynomial({_once_less(monomial, v): factor * monomial.count(v)})
    return derivative


def _invariant(
    inequalities: Sequence[PolynomialInequality], change: Callable[[PolynomialInequality], Polynomial[int]]
) -> Iterator[PolynomialInequality]:
    """Yield inequalities without a change, and sums of two with opposite changes, such as of lengths."""
    changed: list[tuple[PolynomialInequality, Polynomial[int]]] = []
    for inequality in inequalities:
        own_change = change(inequality)
        if not own_change.terms:
            yield inequality
            continue
        for other, other_change in changed:
            share = _share(own_change, other_change)
            if share is not None and share < 0:
                yield PolynomialInequality(
                    inequality.polynomial + other.polynomial.scaled(-share),
                    inequality.strict or other.strict,
                    f"(sum_ {inequality.proof_text} (product_ {number(-share)} {other.proof_text}))",
                )
        changed.append((inequality, own_change))


def _share(one: Polynomial[int], other: Polynomial[int]) -> Fraction | None:
    """Return the factor q with ``one`` = q·``other``; None if it is no multiple."""
    monomial = min(one.terms)
    share = one.terms[monomial] / other.terms.get(monomial, Fraction(1))
    return None if (one - other.scaled(share)).terms else share


def _independent(inequalities: Sequence[PolynomialInequality]) -> list[PolynomialInequality]:
    """Return inequalities without linear ones that follow from others, by a linear program in floats."""
    remaining = list(inequalities)
    for inequality in inequalities:
        others = [y for y in remaining if y is not inequality and y.polynomial.degree < 2]
        if inequality.polynomial.degree < 2 and _follows(inequality, others):
            remaining.remove(inequality)
    return remaining


def _follows(x: PolynomialInequality, others: Sequence[PolynomialInequality]) -> bool:
    """Return whether an inequality is a nonnegative combination of others and constants."""
    from scipy.optimize import linprog

    monomials = sorted({m for y in (x, *others) for m in y.polynomial.terms} | {()})
    columns = [[float(y.polynomial.terms.get(m, 0)) for y in others] + [float(not m)] for m in monomials]
    strict = [-float(y.strict) for y in others] + [-1.0]
    right = [float(x.polynomial.terms.get(m, 0)) for m in monomials]
    solution = linprog(strict, A_eq=columns, b_eq=right, method="highs-ds")
    return bool(solution.status == 3 or (solution.status == 0 and (not x.strict or solution.fun < -_SMALL)))


# --- scales --------------------------------------------------------------------------------------


def _scaled(reduction: Reduction) -> Reduction:
    """Scale variables and inequalities by powers of 2 to bring coefficients near 1, as solvers need."""
    polynomials = [x.polynomial for x in reduction.inequalities]
    polynomials += [x.polynomial for x in reduction.equations]
    powers = _powers(polynomials)
    scales = {v: Fraction(2) ** power for v, power in powers.items()}

    def rescale(polynomial: Polynomial[int]) -> Polynomial[int]:
        return polynomial.substitute(lambda x: variable(x).scaled(scales[x]))

    def near_one(x: PolynomialInequality) -> PolynomialInequality:
        """Return the inequality with its largest coefficient near 1."""
        polynomial = rescale(x.polynomial)
        top = max(abs(q) for q in polynomial.terms.values())
        scale = Fraction(2) ** -round(log2(top))
        return replace(x, polynomial=polynomial.scaled(scale), scale=scale)

    forms = {v: reduction.lift(variable(v)).scaled(1 / scale) for v, scale in scales.items()}
    return Reduction(
        tuple(map(near_one, reduction.inequalities)),
        tuple(replace(x, polynomial=rescale(x.polynomial)) for x in reduction.equations),
        forms,
    )


def _powers(polynomials: Sequence[Polynomial[int]]) -> dict[int, int]:
    """Return a power of 2 for each variable, by least squares of logarithms of the coefficients."""
    import numpy as np

    variables = sorted({v for x in polynomials for v in x.variables})
    rows: list[list[float]] = []
    right: list[float] = []
    for place, polynomial in enumerate(polynomials):
        for monomial, q in polynomial.terms.items():
            own = [float(place == other) for other in range(len(polynomials))]
            rows.append([*(float(monomial.count(v)) for v in variables), *own])
            right.append(-log2(abs(q)))
    if not rows:
        return {}
    powers = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
    return {v: round(float(x)) for v, x in zip(variables, powers, strict=False)}
