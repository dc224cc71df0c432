"""Fewer variables for the search of a contradiction: equations solved, directions without effect left out.

What follows from other linear inequalities is left out, too; products of it follow from products of them.

An equation in which a variable has a number as factor gives that variable; constraints become themselves
plus a multiple of the equation. Where all nonlinear constraints depend on differences of variables only, as
on gaps between vehicles, one variable stands for each difference. Not trusted: Coq adds up what comes out.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import log2

from roadproof.extensions.kernel.cone import Constraint, coq, echelon, number, whole_factor
from roadproof.world.polynomial import Polynomial, constant, variable

_SMALL = 1e-6


@dataclass(frozen=True)
class Inequality:
    """``polynomial`` is at least 0, above it where ``strict``; ``written``: why, for Coq.

    ``scale``: how often it contains the polynomial that is written.
    """

    polynomial: Polynomial[int]
    strict: bool
    written: str
    scale: Fraction = Fraction(1)


@dataclass(frozen=True)
class Equation:
    """``polynomial`` is 0; ``times``: why a multiple is 0, for Coq."""

    polynomial: Polynomial[int]
    times: Callable[[Polynomial[int]], str]


@dataclass(frozen=True)
class Reduction:
    """Constraints in fewer variables; ``lifted`` says of each what it is in those that Coq has."""

    inequalities: tuple[Inequality, ...]
    equations: tuple[Equation, ...]
    lifted: Mapping[int, Polynomial[int]]

    def lift(self, polynomial: Polynomial[int]) -> Polynomial[int]:
        return polynomial.substitute(lambda x: self.lifted.get(x, variable(x)))


def reduce_constraints(constraints: Sequence[Constraint]) -> Reduction:
    """The constraints, equations solved and without directions that have no effect."""
    inequalities, equations = _given(constraints)
    left: list[Equation] = []
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


def _given(constraints: Sequence[Constraint]) -> tuple[list[Inequality], list[Equation]]:
    """As they stand; two inequalities that are opposite are an equation, too."""
    inequalities: list[Inequality] = []
    equations: list[Equation] = []
    last = len(constraints) - 1
    seen: dict[frozenset[tuple[tuple[int, ...], Fraction]], str] = {}
    for place, x in enumerate(constraints):
        written = f"(given_ {last - place})"
        if x.kind == "zero":
            equations.append(Equation(x.polynomial, _multiple(written)))
            continue
        inequalities.append(Inequality(x.polynomial, x.kind == "above", written))
        opposite = seen.get(frozenset(x.polynomial.scaled(Fraction(-1)).terms.items()))
        if opposite is not None:
            equations.append(Equation(x.polynomial, _both(written, opposite)))
        seen[frozenset(x.polynomial.terms.items())] = written
    return inequalities, equations


def _multiple(written: str) -> Callable[[Polynomial[int]], str]:
    return lambda factor: f"(times_ {coq(factor)} {written})"


def _both(up: str, down: str) -> Callable[[Polynomial[int]], str]:
    """A multiple c of what is at least and at most 0: (c/2 + 1/2)^2 of one, (c/2 - 1/2)^2 of the other."""

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
    """A variable that stands in one term of the equation, with a number as its only factor."""
    for monomial in sorted(equation.terms, reverse=True):
        if len(monomial) == 1 and sum(monomial[0] in x for x in equation.terms) == 1:
            return monomial[0]
    return None


def _quotient(polynomial: Polynomial[int], equation: Polynomial[int], solved: int) -> Polynomial[int]:
    """The multiple of an equation that takes a variable out of a polynomial where it is subtracted."""
    found: Polynomial[int] = constant(Fraction(0))
    while True:
        rest = polynomial - found * equation
        parts = {m: q for m, q in rest.terms.items() if solved in m}
        if not parts:
            return found
        factor = equation.terms[(solved,)]
        found = found + Polynomial({_once_less(m, solved): q / factor for m, q in parts.items()})


def _once_less(monomial: tuple[int, ...], solved: int) -> tuple[int, ...]:
    place = monomial.index(solved)
    return monomial[:place] + monomial[place + 1 :]


def _without(x: Inequality, equation: Equation, solved: int) -> Inequality:
    factor = _quotient(x.polynomial, equation.polynomial, solved)
    if not factor.terms:
        return x
    minus = factor.scaled(Fraction(-1))
    return replace(
        x,
        polynomial=x.polynomial + minus * equation.polynomial,
        written=f"(sum_ {x.written} {equation.times(minus)})",
    )


def _without_in_equation(x: Equation, equation: Equation, solved: int) -> Equation:
    minus = _quotient(x.polynomial, equation.polynomial, solved).scaled(Fraction(-1))
    if not minus.terms:
        return x

    def times(factor: Polynomial[int]) -> str:
        return f"(sum_ {x.times(factor)} {equation.times(factor * minus)})"

    return Equation(x.polynomial + minus * equation.polynomial, times)


# --- inequalities --------------------------------------------------------------------------------


def _useful(inequalities: Sequence[Inequality]) -> list[Inequality]:
    """In whole numbers, each once, without those that say nothing."""
    found: dict[frozenset[tuple[tuple[int, ...], Fraction]], Inequality] = {}
    for x in inequalities:
        if not x.polynomial.terms:
            continue
        if x.polynomial.degree == 0 and x.polynomial.constant > 0:
            continue
        scale = whole_factor(x.polynomial.terms.values())
        scaled = x.polynomial.scaled(scale)
        key = frozenset(scaled.terms.items())
        if key not in found or x.strict:
            written = x.written if scale == 1 else f"(product_ {number(scale)} {x.written})"
            found[key] = Inequality(scaled, x.strict, written)
    return list(found.values())


# --- directions ----------------------------------------------------------------------------------


def _flat(inequalities: list[Inequality], equations: list[Equation]) -> Reduction:
    """Variables left out along which nothing nonlinear changes, and what is linear and changes there."""
    kept = [x.polynomial for x in inequalities if x.polynomial.degree > 1]
    kept += [x.polynomial for x in equations]
    variables = sorted({v for x in inequalities for v in x.polynomial.variables})
    rows: dict[tuple[int, tuple[int, ...]], dict[int, Fraction]] = {}
    for place, polynomial in enumerate(kept):
        for v in variables:
            for monomial, factor in _derivative(polynomial, v).terms.items():
                rows.setdefault((place, monomial), {})[v] = factor
    pivots = echelon(rows.values(), -1)
    forms = {v: Polynomial({(x,): q for x, q in row.items()}) for v, row in (pivots or {}).items()}
    dropped = {v for v in variables if v not in forms}
    zero: Polynomial[int] = constant(Fraction(0))

    def change(x: Inequality) -> Polynomial[int]:
        """What it is not as a function of the forms; nothing where it is the same as of variables."""
        kept = x.polynomial.substitute(lambda v: zero if v in dropped else forms.get(v, variable(v)))
        return kept - x.polynomial

    def cut(polynomial: Polynomial[int]) -> Polynomial[int]:
        return polynomial.substitute(lambda x: zero if x in dropped else variable(x))

    return _scaled(
        Reduction(
            tuple(
                _independent([replace(x, polynomial=cut(x.polynomial)) for x in _kept(inequalities, change)])
            ),
            tuple(replace(x, polynomial=cut(x.polynomial)) for x in equations),
            forms,
        )
    )


def _derivative(polynomial: Polynomial[int], v: int) -> Polynomial[int]:
    found: Polynomial[int] = constant(Fraction(0))
    for monomial, factor in polynomial.terms.items():
        if v in monomial:
            found = found + Polynomial({_once_less(monomial, v): factor * monomial.count(v)})
    return found


def _kept(
    inequalities: Sequence[Inequality], change: Callable[[Inequality], Polynomial[int]]
) -> Iterator[Inequality]:
    """Those without a change, and sums of two, such as of lengths, in which opposite changes cancel out."""
    changed: list[tuple[Inequality, Polynomial[int]]] = []
    for x in inequalities:
        own = change(x)
        if not own.terms:
            yield x
            continue
        for other, its in changed:
            share = _share(own, its)
            if share is not None and share < 0:
                yield Inequality(
                    x.polynomial + other.polynomial.scaled(-share),
                    x.strict or other.strict,
                    f"(sum_ {x.written} (product_ {number(-share)} {other.written}))",
                )
        changed.append((x, own))


def _share(one: Polynomial[int], other: Polynomial[int]) -> Fraction | None:
    """How often ``one`` contains ``other``, None where it is no multiple of it."""
    monomial = min(one.terms)
    share = one.terms[monomial] / other.terms.get(monomial, Fraction(1))
    return None if (one - other.scaled(share)).terms else share


def _independent(inequalities: Sequence[Inequality]) -> list[Inequality]:
    """Without linear inequalities that follow from other linear ones, as a linear program in floats says."""
    kept = list(inequalities)
    for x in inequalities:
        others = [y for y in kept if y is not x and y.polynomial.degree < 2]
        if x.polynomial.degree < 2 and _follows(x, others):
            kept.remove(x)
    return kept


def _follows(x: Inequality, others: Sequence[Inequality]) -> bool:
    """Whether it is a sum of others and of numbers that are at least 0, above 0 where it is strict."""
    from scipy.optimize import linprog

    monomials = sorted({m for y in (x, *others) for m in y.polynomial.terms} | {()})
    columns = [[float(y.polynomial.terms.get(m, 0)) for y in others] + [float(not m)] for m in monomials]
    strict = [-float(y.strict) for y in others] + [-1.0]
    right = [float(x.polynomial.terms.get(m, 0)) for m in monomials]
    found = linprog(strict, A_eq=columns, b_eq=right, method="highs-ds")
    return bool(found.status == 3 or (found.status == 0 and (not x.strict or found.fun < -_SMALL)))


# --- scales --------------------------------------------------------------------------------------


def _scaled(reduction: Reduction) -> Reduction:
    """Variables and inequalities by powers of 2 that bring coefficients near 1, as solvers need them."""
    polynomials = [x.polynomial for x in reduction.inequalities]
    polynomials += [x.polynomial for x in reduction.equations]
    powers = _powers(polynomials)
    scales = {v: Fraction(2) ** power for v, power in powers.items()}

    def other(polynomial: Polynomial[int]) -> Polynomial[int]:
        return polynomial.substitute(lambda x: variable(x).scaled(scales[x]))

    def near_one(x: Inequality) -> Inequality:
        polynomial = other(x.polynomial)
        top = max(abs(q) for q in polynomial.terms.values())
        scale = Fraction(2) ** -round(log2(top))
        return replace(x, polynomial=polynomial.scaled(scale), scale=scale)

    forms = {v: reduction.lift(variable(v)).scaled(1 / scale) for v, scale in scales.items()}
    return Reduction(
        tuple(map(near_one, reduction.inequalities)),
        tuple(replace(x, polynomial=other(x.polynomial)) for x in reduction.equations),
        forms,
    )


def _powers(polynomials: Sequence[Polynomial[int]]) -> dict[int, int]:
    """By least squares of logarithms: a power for each variable, with one number for each polynomial."""
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
    found = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
    return {v: round(float(x)) for v, x in zip(variables, found, strict=False)}
