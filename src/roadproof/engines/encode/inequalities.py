"""Rewrites a comparison of terms exactly as a circuit of polynomial inequalities over vehicle signals.

``max`` and ``min`` that enter linearly become disjunctions or conjunctions; inside products and
powers they are split into cases. 1/x is ∞ at 0 (paper, appendix *Robust Semantics*): by sign.
"""

from collections.abc import Mapping
from fractions import Fraction
from itertools import product
from typing import TypeAlias, assert_never

from roadproof.engines.encode.problem import All, AnyOf, Circuit, Inequality, Leaf, all_of, any_of
from roadproof.logic import terms as t
from roadproof.logic.custom_names import code_of
from roadproof.logic.formula import Compare
from roadproof.logic.terms import Term
from roadproof.world.polynomial import Polynomial, constant, variable
from roadproof.world.signals import SIZES, CustomSignalName
from roadproof.world.vehicle import Vehicle

# A vehicle and one of its signals, such as ("SV", "v_lon"); "" and a custom signal of no vehicle.
Quantity: TypeAlias = tuple[str, t.SignalName | CustomSignalName]
KIND: t.SizeName = "kind"
Sizes: TypeAlias = Mapping[tuple[str, t.SizeName], Fraction]
Summands: TypeAlias = tuple[tuple[Fraction, Term], ...]


def sizes_of(vehicles: Mapping[str, Vehicle]) -> Sizes:
    """Return lengths and widths of ``vehicles`` (m), and codes of declared kinds."""
    boxes = {(name, size): getattr(vehicle, size) for name, vehicle in vehicles.items() for size in SIZES}
    kinds = {(n, KIND): Fraction(code_of(v.kind)) for n, v in vehicles.items() if v.kind is not None}
    return {**boxes, **kinds}


def inequalities_of(atom: Compare, sizes: Sizes) -> Circuit[Inequality[Quantity]]:
    """Return a circuit that is true exactly where ``atom`` is; ``sizes``: (vehicle, length or width) to m."""
    if isinstance(atom.left, t.Inverse) or isinstance(atom.right, t.Inverse):
        return _compare_inverses(atom, sizes)
    low, high = (atom.right, atom.left) if atom.op in (">", ">=") else (atom.left, atom.right)
    return _not_negative(t.subtract(high, low), atom.op in ("<", ">"), sizes)


def _compare_inverses(atom: Compare, sizes: Sizes) -> Circuit[Inequality[Quantity]]:
    cases = []
    for left, right in product(_signed(atom.left), _signed(atom.right)):
        conditions = [_not_negative(c, s, sizes) for c, s in (*left[0], *right[0])]
        if left[1] is None or right[1] is None:
            larger = [side for side, value in (("left", left[1]), ("right", right[1])) if value is None]
            only = larger[0] if len(larger) == 1 else None
            holds = {
                "<": only == "right",
                "<=": "right" in larger,
                ">": only == "left",
                ">=": "left" in larger,
            }
            conditions.append(All(()) if holds[atom.op] else AnyOf(()))
        else:
            (top, bottom), (other_top, other_bottom) = left[1], right[1]
            cleared = Compare(t.Product((top, other_bottom)), atom.op, t.Product((other_top, bottom)))
            conditions.append(inequalities_of(cleared, sizes))
        cases.append(all_of(conditions))
    return any_of(cases)


def _signed(side: Term) -> list[tuple[list[tuple[Term, bool]], tuple[Term, Term] | None]]:
    """Cases of a side: conditions (term, strictly above 0), and (numerator, positive denominator) or ∞."""
    one = t.number(1)
    if not isinstance(side, t.Inverse):
        return [([], (side, one))]
    x, minus_x = side.term, t.negate(side.term)
    return [
        ([(x, True)], (one, x)),
        ([(minus_x, True)], (t.number(-1), minus_x)),
        ([(x, False), (minus_x, False)], None),
    ]


def _not_negative(term: Term, strict: bool, sizes: Sizes) -> Circuit[Inequality[Quantity]]:
    """``term > 0`` where strict, else ``term >= 0``."""
    summands = _summands(term, Fraction(1), sizes)
    for k, (factor, summand) in enumerate(summands):
        if isinstance(summand, t.Maximum | t.Minimum):
            rest = _sum(summands[:k] + summands[k + 1 :])
            branches = [t.Sum((rest, t.Product((t.number(factor), b)))) for b in summand.terms]
            join = any_of if isinstance(summand, t.Maximum) == (factor > 0) else all_of
            return join([_not_negative(branch, strict, sizes) for branch in branches])
    plain = _sum(summands)
    extremum = _inner_extremum(plain)
    if extremum is None:
        polynomial = term_polynomial(plain, sizes)
        if polynomial.degree == 0:
            value = polynomial.constant
            return All(()) if value > 0 or (value == 0 and not strict) else AnyOf(())
        return Leaf(Inequality(polynomial, strict))
    cases = []
    for chosen in extremum.terms:
        others = [x for x in extremum.terms if x is not chosen]
        if isinstance(extremum, t.Maximum):
            ordered = [_not_negative(t.subtract(chosen, x), False, sizes) for x in others]
        else:
            ordered = [_not_negative(t.subtract(x, chosen), False, sizes) for x in others]
        cases.append(
            all_of([*ordered, _not_negative(t.replace_term(plain, extremum, chosen), strict, sizes)])
        )
    return any_of(cases)


def _summands(term: Term, factor: Fraction, sizes: Sizes) -> Summands:
    """``factor · term`` as a sum of multiples of terms that are no sums."""
    match term:
        case t.Sum(terms):
            return tuple(s for x in terms for s in _summands(x, factor, sizes))
        case t.Product(factors):
            open_factors = [x for x in factors if not _is_constant(x)]
            for x in factors:
                if _is_constant(x):
                    factor *= term_polynomial(x, sizes).constant
            if len(open_factors) == 1:
                return _summands(open_factors[0], factor, sizes)
            return ((factor, t.Product(tuple(open_factors)) if open_factors else t.number(1)),)
        case t.Quotient(numerator, denominator) if not any(
            isinstance(x, t.Maximum | t.Minimum) for x in _walk(denominator)
        ):
            return _summands(numerator, factor / term_polynomial(denominator, sizes).constant, sizes)
        case t.Quotient() | t.Power() | t.Maximum() | t.Minimum() | t.Inverse():
            return ((factor, term),)
        case t.Number() | t.Parameter() | t.Variable() | t.Signal() | t.Size() | t.CustomSignal():
            return ((factor, term),)


def _sum(summands: Summands) -> Term:
    return t.Sum(tuple(t.Product((t.number(factor), x)) for factor, x in summands))


def _is_constant(term: Term) -> bool:
    return all(isinstance(x, t.Number | t.Size) for x in t.leaves(term)) and not any(
        isinstance(x, t.Maximum | t.Minimum) for x in _walk(term)
    )


def _walk(term: Term) -> list[Term]:
    return [term, *(x for child in t.children(term) for x in _walk(child))]


def _inner_extremum(term: Term) -> t.Maximum | t.Minimum | None:
    extrema = [x for x in _walk(term) if isinstance(x, t.Maximum | t.Minimum)]
    return extrema[-1] if extrema else None


def term_polynomial(term: Term, sizes: Sizes) -> Polynomial[Quantity]:
    """Return a term without extrema as a polynomial of signals. Raises ``ValueError`` for open parameters."""
    match term:
        case t.Number(value, _):
            return constant(value)
        case t.Size(name, vehicle):
            return constant(sizes[vehicle, name])
        case t.Signal(name, vehicle):
            return variable((vehicle, name))
        case t.CustomSignal(name, vehicle):
            return variable((vehicle, CustomSignalName(name)))
        case t.Sum(terms):
            total: Polynomial[Quantity] = constant(Fraction(0))
            for x in terms:
                total = total + term_polynomial(x, sizes)
            return total
        case t.Product(factors):
            result: Polynomial[Quantity] = constant(Fraction(1))
            for x in factors:
                result = result * term_polynomial(x, sizes)
            return result
        case t.Power(base, exponent):
            result = constant(Fraction(1))
            for _ in range(exponent):
                result = result * term_polynomial(base, sizes)
            return result
        case t.Quotient(numerator, denominator):
            divisor = term_polynomial(denominator, sizes)
            if divisor.degree > 0 or divisor.constant == 0:
                raise ValueError("a divisor must be a number other than 0")
            return term_polynomial(numerator, sizes).scaled(1 / divisor.constant)
        case t.Parameter(name, _) | t.Variable(name, _):
            raise ValueError(f"'{name}' has no value: substitute values first")
        case t.Maximum() | t.Minimum() | t.Inverse():
            raise ValueError("extrema and inverses are split before")
        case _:
            assert_never(term)
