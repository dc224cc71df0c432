"""What a formula demands of its first instant: true there wherever the formula is."""

from hypothesis import given, settings
from hypothesis import strategies as st

from judge.cases import comparisons_of, drives, formulas
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.initial_conditions import conjuncts, demands
from roadproof.semantics.exact.exact import judge

ATOMS = comparisons_of(["s", "d", "v_lon", "v_lat"])
P, Q = (f.Compare(t.Signal("s", name), ">", t.number(0)) for name in "AB")
NOW = f.Interval(t.number(0), t.number(2))
LATER = f.Interval(t.number(1), t.number(2))


@settings(max_examples=300, deadline=None)
@given(formulas(ATOMS), drives)
def test_what_is_demanded_is_so_where_the_formula_is(formula, drive):
    demanded = demands(formula)
    assert f.is_state(demanded)
    if judge(formula, drive).holds:
        assert judge(demanded, drive).holds


@settings(max_examples=100, deadline=None)
@given(formulas(ATOMS).filter(f.is_state), drives)
def test_all_of_a_formula_about_one_instant_is_demanded(formula, drive):
    assert judge(demands(formula), drive).holds == judge(formula, drive).holds


def test_no_more_than_the_first_instant_is_read():
    no_q = f.Compare(Q.left, "<=", Q.right)
    assert demands(f.Always(NOW, P)) == P
    assert demands(f.Always(LATER, P)) == f.TRUE
    assert demands(f.Eventually(NOW, P)) == f.TRUE
    assert demands(f.Not(f.Eventually(NOW, Q))) == no_q
    assert demands(f.Until(P, NOW, Q)) == f.Or((P, Q))
    assert demands(f.Not(f.Until(P, NOW, Q))) == no_q
    assert demands(f.And((f.Application("x", (), P), f.Eventually(NOW, Q)))) == P


@settings(max_examples=100, deadline=None)
@given(st.booleans(), formulas(ATOMS), drives)
def test_parts_together_are_the_formula(positive, formula, drive):
    whole = f.conjunction(*conjuncts(formula, positive))
    assert judge(whole, drive).holds == (judge(formula, drive).holds == positive)
