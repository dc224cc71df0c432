"""Comparisons as circuits of polynomial inequalities, against the value of the comparison itself."""

from fractions import Fraction
from math import inf

from hypothesis import given, settings
from hypothesis import strategies as st

from roadproof.engines.encode.circuit import evaluate, implicant
from roadproof.engines.encode.inequalities import inequalities_of, polynomial_of
from roadproof.logic import formula as f
from roadproof.logic import terms as t

quiet = settings(deadline=None, derandomize=True)
SIZES = {("A", "length"): Fraction(9, 2), ("A", "width"): Fraction(9, 5)}
LONGER = t.Maximum((t.number(4), t.Sum((t.Size("length", "A"), t.number(1)))))
leaves = st.one_of(
    st.builds(lambda n: t.number(Fraction(n, 2)), st.integers(-4, 4)),
    st.sampled_from([t.Signal("v_lon", "A"), t.Signal("v_lat", "A"), t.Signal("s", "B")]),
    st.sampled_from([t.Size("length", "A"), t.Size("width", "A")]),
)
terms = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.builds(lambda a, b: t.Sum((a, b)), inner, inner),
        st.builds(lambda a, b: t.Product((a, b)), inner, inner),
        st.builds(lambda a, b: t.Maximum((a, b)), inner, inner),
        st.builds(lambda a, b, c: t.Minimum((a, b, c)), inner, inner, inner),
        st.builds(lambda a: t.Power(a, 2), inner),
        st.builds(t.Quotient, inner, st.sampled_from([t.number(3), LONGER])),
    ),
    max_leaves=6,
)
sides = terms | st.builds(t.Inverse, terms)
values = st.fixed_dictionaries(
    {q: st.integers(-3, 3).map(Fraction) for q in (("A", "v_lon"), ("A", "v_lat"), ("B", "s"))}
)


def value(term, at):
    match term:
        case t.Number(number, _):
            return number
        case t.Size(name, vehicle):
            return SIZES[vehicle, name]
        case t.Signal(name, vehicle):
            return at[vehicle, name]
        case t.Sum(parts):
            return sum(value(p, at) for p in parts)
        case t.Product((a, b)):
            return value(a, at) * value(b, at)
        case t.Maximum(parts):
            return max(value(p, at) for p in parts)
        case t.Minimum(parts):
            return min(value(p, at) for p in parts)
        case t.Power(base, exponent):
            return value(base, at) ** exponent
        case t.Quotient(a, b):
            return value(a, at) / value(b, at)
        case t.Inverse(inner):
            return inf if value(inner, at) == 0 else 1 / value(inner, at)
    raise AssertionError(term)


def fact_holds(inequality, at):
    found = inequality.polynomial.value(lambda q: at[q])
    return found > 0 if inequality.strict else found >= 0


@settings(quiet, max_examples=500)
@given(sides, st.sampled_from(["<", "<=", ">", ">="]), sides, values)
def test_facts_are_true_where_the_comparison_is(left, op, right, at):
    a, b = value(left, at), value(right, at)
    expected = {"<": a < b, "<=": a <= b, ">": a > b, ">=": a >= b}[op]
    circuit = inequalities_of(f.Compare(left, op, right), SIZES)
    assert evaluate(circuit, lambda inequality: fact_holds(inequality, at)) == expected


@settings(quiet, max_examples=150)
@given(terms, terms, values)
def test_an_implicant_is_true_and_suffices(left, right, at):
    circuit = inequalities_of(f.Compare(left, ">=", right), SIZES)
    if not evaluate(circuit, lambda inequality: fact_holds(inequality, at)):
        return
    chosen = implicant(circuit, lambda inequality: float(inequality.polynomial.value(lambda q: at[q])))
    assert all(inequality.polynomial.value(lambda q: at[q]) >= 0 for inequality in chosen)
    assert evaluate(circuit, lambda inequality: inequality in chosen)


def test_polynomials_are_expanded():
    v = t.Signal("v_lon", "A")
    polynomial = polynomial_of(t.Power(t.Sum((v, t.number(3))), 2), SIZES)
    q = ("A", "v_lon")
    assert polynomial.terms == {(q, q): 1, (q,): 6, (): 9}
