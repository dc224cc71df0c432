"""Formulas on a grid: the circuit against a reading by definition, the judge and the monitor."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings

from encode import cases
from roadproof.engines.encode.circuit import Leaf, evaluate, nodes
from roadproof.engines.encode.unroll import Grid, unroll
from roadproof.errors import UsageError
from roadproof.logic import formula as f
from roadproof.semantics.exact import judge
from roadproof.semantics.sampled.batch import Batch
from roadproof.semantics.sampled.compiled import compile as compile_monitor

quiet = settings(deadline=None, derandomize=True)


def circuit_holds(formula, trace):
    return evaluate(unroll(formula, cases.GRID), lambda at: cases.holds(at.atom, trace, at.step))


@settings(quiet, max_examples=400)
@given(cases.formulas(), cases.traces)
def test_circuit_and_definition_and_judge_agree(formula, trace):
    expected = cases.holds(formula, trace)
    assert circuit_holds(formula, trace) == expected
    assert judge(formula, cases.as_drive(trace)).holds == expected


@settings(quiet, max_examples=150)
@given(cases.formulas(cases.bounded), cases.traces)
def test_monitor_agrees_where_windows_are_bounded(formula, trace):
    samples = cases.STEPS + 40
    signals = {
        which: np.array([[float(cases.value_at(trace, *which, k))] for k in range(samples)])
        for which in cases.SIGNALS
    }
    batch = Batch(cases.DT, np.array([samples]), signals)
    answer = compile_monitor({"it": formula}).evaluate(batch).answers["it"]
    expected = circuit_holds(formula, trace)
    assert bool(answer.true[0]) == expected
    assert bool(answer.false[0]) != expected


@settings(quiet, max_examples=100)
@given(cases.formulas())
def test_negation_disappears(formula):
    plain, negated = unroll(formula, cases.GRID), unroll(f.Not(formula), cases.GRID)
    assert sum(isinstance(x, Leaf) for x in nodes(plain)) >= 0
    for seed in range(4):
        trace = {w: [(seed * 7 + k * 3 + len(w[0])) % 5 - 2 for k in range(5)] for w in cases.SIGNALS}

        def truth(at, trace=trace):
            return cases.holds(at.atom, trace, at.step)

        assert evaluate(plain, truth) != evaluate(negated, truth)


def test_until_asks_for_its_left_side_from_the_start_of_the_interval():
    rises = cases.atom("a_lon", "A", ">", Fraction(1, 2))
    falls = cases.atom("a_lon", "A", "<", Fraction(-1, 2))
    late = f.Until(rises, cases.interval(1, 3), falls)
    assert circuit_holds(late, {("a_lon", "A"): [0, 1, 1, -1, 0]})
    assert not circuit_holds(late, {("a_lon", "A"): [1, 0, 1, -1, 0]})


def test_a_bound_off_the_grid_is_refused_with_both_numbers():
    formula = f.Eventually(cases.interval(1, 0), f.TRUE)
    with pytest.raises(UsageError, match=r"0\.5 s is no multiple of dt=0\.3 s"):
        unroll(formula, Grid(Fraction(3, 10), 4))


def test_a_formula_that_is_not_bound_is_refused():
    with pytest.raises(ValueError, match="bind"):
        unroll(f.Occupies("A", "m1"), cases.GRID)
