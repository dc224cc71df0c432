"""Whole problems: which drives are among their solutions."""

from dataclasses import replace
from fractions import Fraction
from math import inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from encode import cases
from examples import some
from planting import plant
from roadproof.engines.encode import shift_invariance
from roadproof.engines.encode.build import (
    NO_MARGIN,
    Assumptions,
    assemble_problem,
    encode_formula,
    ground_atoms,
)
from roadproof.engines.encode.inequalities import inequalities_of, term_polynomial
from roadproof.engines.encode.motion import ColumnLayout
from roadproof.engines.encode.problem import All, AnyOf, Leaf, all_of, any_of, evaluate, implicant, nodes
from roadproof.engines.encode.unroll import Grid, unroll
from roadproof.errors import UsageError
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim, signature
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.semantics.exact import judge
from roadproof.semantics.sampled.batch import Batch
from roadproof.semantics.sampled.compiled import compile as compile_monitor
from roadproof.world.drive import Drive
from roadproof.world.models import load_road, load_vehicle
from searching.known import BASE, CAR, ROADS, VALUES, holds_on_samples, known
from tables import read_table

GRID = Grid(Fraction(1, 2), 4)
CARS = dict.fromkeys(("A", "B", "C"), load_vehicle("car"))
ROAD = load_road("main-2")
REACH = Assumptions().reach


def steady(layout, places):
    """Column values where each vehicle goes 20 m/s straight on from its place (s, d)."""
    values = {}
    for name, (s, d) in places.items():
        for k in range(layout.grid.steps + 1):
            state = {"s": s + 20 * k * layout.grid.dt, "d": d, "v_lon": 20, "v_lat": 0}
            values |= {layout.column(name, signal, k): Fraction(x) for signal, x in state.items()}
    return values


def build_problem(assumptions):
    """The problem of any drive at all."""
    layout = ColumnLayout(tuple(CARS), GRID)
    wanted = encode_formula(f.Truth(True), CARS, layout, assumptions)
    return assemble_problem(wanted, ROAD, CARS, layout, assumptions), layout


def is_solution(problem, values):
    for row in problem.rows:
        total = sum(factor * values[column] for column, factor in row.terms.items())
        if (row.low is not None and total < row.low) or (row.high is not None and total > row.high):
            return False
    if not all(c.low <= values[k] <= c.high for k, c in enumerate(problem.columns)):
        return False
    return evaluate(problem.circuit, lambda x: x.polynomial.value(lambda k: values[k]) >= x.margin)


@pytest.mark.parametrize(
    ("b", "c", "possible"),
    [
        ((30, 3), (-30, 3), True),
        ((REACH / 2, 3), (-REACH / 2, 3), True),
        ((REACH / 2, 3), (-REACH / 2 - 1, 3), False),  # B and C too far apart
        ((30, 3), (REACH + 1, 3), False),  # A and C
        ((30, 3), (REACH, 3), True),
        ((10, 3), (30, 3), False),  # less than 8 m from B to A
        ((10, 6), (30, 3), True),
        ((10, "21/5"), (30, 6), False),  # beside A, by less than 0.7 m
        ((30, 3), (-30, 8), False),  # off the road
    ],
)
def test_drives_within_the_reach_apart_and_on_the_road(b, c, possible):
    problem, layout = build_problem(Assumptions(natural=False))
    places = {"A": (0, Fraction(3)), "B": (b[0], Fraction(b[1])), "C": (c[0], Fraction(c[1]))}
    assert is_solution(problem, steady(layout, places)) == possible


def test_columns_across_end_where_the_road_does():
    """How strong a linear relaxation is follows from these."""
    problem, layout = build_problem(Assumptions())
    for name, car in CARS.items():
        column = problem.columns[layout.column(name, "d", 2)]
        assert (column.low, column.high) == (car.width, 7)


def test_what_holds_at_the_last_sample_holds_for_ever_unless_told_otherwise():
    layout = ColumnLayout(("A",), GRID)
    near = f.Compare(t.Signal("s", "A"), "<=", t.number(50))  # at 40 m at the end
    circuit = unroll(f.Always(f.Interval(t.number(0), None), near), GRID)
    values = steady(layout, {"A": (0, Fraction(3))})
    found = [
        evaluate(made, lambda x: x.polynomial.value(lambda k: values[k]) >= 0)
        for made in (
            ground_atoms(circuit, CARS, layout, NO_MARGIN),
            ground_atoms(circuit, CARS, layout, NO_MARGIN, False),
        )
    ]
    assert found == [False, True]


# --- Where a start at s = 0 stands for all starts: by example, and on drives that are moved along ---

HALVES = Grid(Fraction(3, 5), 10)


def bound(text, road="main-2", lane="main-1"):
    query = read_claim(BASE, text)
    lanes = dict.fromkeys(query.lanes, lane)
    return bind(query.formula, ROADS[road], lanes, VALUES), dict.fromkeys(query.vehicles, CAR)


def same(text, road="main-2"):
    formula, cars = bound(text, road)
    return shift_invariance.is_shift_invariant(formula, ROADS[road], cars)


def starts(text, road="main-2"):
    formula, cars = bound(text, road)
    return shift_invariance.starting_range([formula], ROADS[road], cars, HALVES, Fraction(80))


@pytest.mark.parametrize(
    "text",
    [
        "s(SV) - s(POV) > 10 m",
        "F G v_lon(SV) > 20 m/s",
        "j_lon(SV) > 1 m/s^3",
        "rear(SV) > front(POV) and d(SV) > 3 m",
        "max(s(SV), s(POV)) - s(SV) < 3 m",
        "(s(SV) - s(POV))^2 > 9 * 1 m * 1 m",
        "s(SV)^2 - 2 * s(SV) * s(POV) + s(POV)^2 > 9 * 1 m * 1 m",
        "inverse(s(SV) - s(POV)) > inverse(3 m)",
        "atLane(SV, L) and danger(SV, POV)",
        *(f"scenario_{k}(SV, POV, L)" for k in (1, 3, 4, 5, 6, 7, 8)),
    ],
)
def test_differences_along_are_the_same_everywhere_on_an_endless_road(text):
    assert same(text)
    assert starts(text) is None
    assert not same(text, "merge")  # where a lane ends


@pytest.mark.parametrize(
    "text",
    read_table(__file__, "places_along_are_not_the_same_everywhere"),
)
def test_places_along_are_not_the_same_everywhere(text):
    assert not same(text)
    assert starts(text) is not None


def test_what_is_named_is_within_a_drive_of_the_starts():
    fast, around = 40 * HALVES.horizon, 1000
    assert starts("s(SV) = 500 m") == (-fast - around, 500 + CAR.length + around)
    assert starts("rear(SV) < -500 m") == (-500 + CAR.length - fast - around, CAR.length + around)
    assert starts("v_lon(SV) > 20 m/s", "merge") == (-100 - fast - around, 300 + CAR.length + around)
    far = "s(SV) = 30000000 m or s(SV) = 9000 m"
    assert starts(far) == (-fast - around, 9000 + CAR.length + around)


def is_right_about_moved_drives():
    """A drive moved along answers as before, wherever that is said of its formula."""
    for seed in range(25):
        case = known(seed)
        query = read_claim(BASE, case.text)
        lanes = {name: case.lanes[name] for name in query.lanes}
        formula = bind(query.formula, ROADS[case.road], lanes, VALUES)
        if shift_invariance.is_shift_invariant(formula, ROADS[case.road], dict.fromkeys(query.vehicles, CAR)):
            for by in (Fraction(-1000, 3), Fraction(1, 10), Fraction(250)):
                cars = {n: replace(m, s=m.s + by) for n, m in case.drive.vehicles.items()}
                if not holds_on_samples(case.text, case.road, Drive(cars), case.grid, case.lanes):
                    return False
    return True


FAULTS = {
    "every road is endless": ("is_shift_invariant", "endless and", "True and"),
    "places are no matter": ("is_shift_invariant", "and not depends_on_place(formula, vehicles)", ""),
    "each vehicle for itself": ("depends_on_place", "any(", "all("),
    "the first factor only": (
        "growth_along",
        "if _is_moved(signal, place):",
        "if _is_moved(signal, place) and k == 0 and 1 > 2:",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_faults_in_symmetry_are_caught(fault, monkeypatch):
    def right():
        texts = ("s(SV) = 30 m", "s(SV)^2 > 9 * 1 m * 1 m", "F v_lon(SV) > 20 m/s and s(POV) < 1 m")
        named = not any(same(text) for text in texts)
        return is_right_about_moved_drives() and named and not same("s(SV) > s(POV)", "merge")

    if fault == next(iter(FAULTS)):
        assert right()
    plant(monkeypatch, shift_invariance, *FAULTS[fault])
    assert not right()


@pytest.mark.parametrize("number", range(9, 25))
def test_sectors_of_the_road_are_places(number):
    name = f"scenario_{number}"
    call = f"{name}({', '.join(signature(BASE, name))})"
    assert not same(call, "merge" if number < 17 else "depart")


# --- Conjunctions and disjunctions: what is decided is seen at once, and nothing is nested without need

A, B, C = Leaf("a"), Leaf("b"), Leaf("c")
TRUE, FALSE = All(()), AnyOf(())


def test_parts_of_the_same_kind_are_flattened():
    assert all_of([A, all_of([B, C])]).parts == (A, B, C)
    assert any_of([any_of([A, B]), C]).parts == (A, B, C)
    assert all_of([A, any_of([B, C])]).parts[0] is A


def test_what_is_decided_leaves_no_trace():
    assert all_of([TRUE, A, TRUE]) is any_of([FALSE, A, FALSE]) is A
    assert all_of([A, FALSE]) is FALSE
    assert any_of([A, TRUE]) is TRUE
    assert any_of([A, all_of([TRUE, TRUE])]).parts == ()


def test_the_same_part_is_there_once():
    assert all_of([A, A]) is any_of([A, A]) is A


# --- Comparisons as circuits of polynomial inequalities, against the value of the comparison itself

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


@settings(quiet, max_examples=some(500))
@given(sides, st.sampled_from(["<", "<=", ">", ">="]), sides, values)
def test_facts_are_true_where_the_comparison_is(left, op, right, at):
    a, b = value(left, at), value(right, at)
    expected = {"<": a < b, "<=": a <= b, ">": a > b, ">=": a >= b}[op]
    circuit = inequalities_of(f.Compare(left, op, right), SIZES)
    assert evaluate(circuit, lambda inequality: fact_holds(inequality, at)) == expected


@settings(quiet, max_examples=some(150))
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
    polynomial = term_polynomial(t.Power(t.Sum((v, t.number(3))), 2), SIZES)
    q = ("A", "v_lon")
    assert polynomial.terms == {(q, q): 1, (q,): 6, (): 9}


# --- Formulas on a grid: the circuit against a reading by definition, the judge and the monitor -----


def circuit_holds(formula, trace):
    return evaluate(unroll(formula, cases.GRID), lambda at: cases.holds(at.atom, trace, at.step))


@settings(quiet, max_examples=some(400))
@given(cases.formulas(), cases.traces)
def test_circuit_and_definition_and_judge_agree(formula, trace):
    expected = cases.holds(formula, trace)
    assert circuit_holds(formula, trace) == expected
    assert judge(formula, cases.as_drive(trace)).holds == expected


@settings(quiet, max_examples=some(150))
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


@settings(quiet, max_examples=some(100))
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
