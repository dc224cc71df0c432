"""Deliberate faults in unrolling, inequalities, motion, bounds and big-M: neighbouring checks catch each."""

from dataclasses import replace
from fractions import Fraction
from itertools import product

import pytest
from hypothesis import Phase, find, settings
from hypothesis import strategies as st
from hypothesis.errors import NoSuchExample

from encode import cases
from encode.test_motion import columns_of, motions, satisfied
from planting import plant
from roadproof.engines.encode import inequalities, motion, place, unroll
from roadproof.engines.encode.motion import ColumnLayout
from roadproof.engines.encode.problem import (
    All,
    AnyOf,
    Inequality,
    Leaf,
    Problem,
    RealColumn,
    Row,
    Unknown,
    any_of,
    evaluate,
    implicant,
)
from roadproof.engines.encode.unroll import Grid
from roadproof.engines.solve import big_m, bounds, milp
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.world.models import load_vehicle
from roadproof.world.polynomial import affine, variable
from solve.small import exactly, inner_is_safe, outer_is_safe, problems

search = settings(deadline=None, derandomize=True, max_examples=1000, database=None, phases=[Phase.generate])


small_formulas = cases.formulas(leaves=4)
looking_back_for_ever = st.builds(
    lambda outer, inner, window, atom: outer(f.FOREVER, inner(window, atom)),
    st.sampled_from([f.Always, f.Eventually]),
    st.sampled_from([f.once, f.historically]),
    cases.bounded,
    cases.atoms,
)


def unrolling_is_wrong():
    """Whether some formula and trace tell the circuit from the definition."""

    def differs(pair):
        formula, trace = pair
        circuit = unroll.unroll(formula, cases.GRID)
        found = evaluate(circuit, lambda at: cases.holds(at.atom, trace, at.step))
        return found != cases.holds(formula, trace)

    try:
        find(st.tuples(small_formulas | looking_back_for_ever, cases.traces), differs, settings=search)
    except NoSuchExample:
        return False
    return True


def short_window(self, formula, interval, step):
    low, high = self.grid.window(interval)
    last = self.last(formula)
    first = min(step + low, last)
    return range(first, 1 + (last if high is None else max(first, min(step + high - 1, last))))


def until_asking_for_left_at_the_end(self, left, samples, right, wanted, both, either):
    result = both([self.at(left, wanted, samples[-1]), self.at(right, wanted, samples[-1])])
    for k in reversed(samples[:-1]):
        here = both([self.at(left, wanted, k), self.at(right, wanted, k)])
        result = either([here, both([self.at(left, wanted, k), result])])
    return result


def past_one_step_short(self, interval, step):
    return EARLIER(self, interval, step)[:-1]


def past_before_the_start(self, interval, step):
    """The first sample stands for what was before it."""
    low, high = self.grid.window(interval)
    return range(max(0, step - low), -1 if high is None else max(-1, step - high - 1), -1)


def until_without_left(self, left, samples, right, wanted, both, either):
    return either([self.at(right, wanted, k) for k in samples])


AT = unroll._Unroller._at
EARLIER = unroll._Unroller._earlier


def forgetful_negation(self, formula, wanted, step):
    return AT(self, formula, True, step)


UNROLLING = {
    "a window one step short": ("_samples", short_window),
    "windows end with the grid": ("_last", lambda self, formula: self.grid.steps),
    "a window back is one step short": ("_earlier", past_one_step_short),
    "a window back begins before the start": ("_earlier", past_before_the_start),
    "until asks for its left side at the end": ("_until", until_asking_for_left_at_the_end),
    "until is eventually": ("_until", until_without_left),
    "polarity is forgotten": ("_at", forgetful_negation),
}


@pytest.mark.parametrize("fault", UNROLLING)
def test_faults_in_unrolling_are_caught(fault, monkeypatch):
    name, wrong = UNROLLING[fault]
    monkeypatch.setattr(unroll._Unroller, name, wrong)
    assert unrolling_is_wrong()


def test_strictness_lost_in_negation_is_caught(monkeypatch):
    monkeypatch.setattr(unroll, "NEGATED", {"<": ">", "<=": ">=", ">": "<", ">=": "<="})
    rises = cases.atom("a_lon", "A", ">", Fraction(0))
    circuit = unroll.unroll(f.Not(rises), cases.GRID)
    still = {w: [0] * cases.STEPS for w in cases.SIGNALS}
    assert not evaluate(circuit, lambda at: cases.holds(at.atom, still, at.step))
    assert cases.holds(f.Not(rises), still)


def test_a_maximum_read_as_a_conjunction_is_caught(monkeypatch):
    monkeypatch.setattr(inequalities, "any_of", inequalities.all_of)
    v = t.Signal("v_lon", "A")
    circuit = inequalities.inequalities_of(f.Compare(t.Maximum((v, t.number(0))), ">=", t.number(0)), {})
    below = evaluate(circuit, lambda inequality: inequality.polynomial.value(lambda _: Fraction(-1)) >= 0)
    assert not below  # max(-1, 0) >= 0 holds, so test_facts_are_true_where_the_comparison_is fails


def test_positions_by_the_speed_at_the_start_are_caught(monkeypatch):
    def euler(name, vehicle, layout, natural, inside):
        for k in range(layout.grid.steps):
            for where, speed in (("s", "v_lon"), ("d", "v_lat")):
                moved = [(layout.column(name, where, k + 1), Fraction(1))]
                moved += [(layout.column(name, where, k), Fraction(-1))]
                moved += [(layout.column(name, speed, k), -layout.grid.dt)]
                yield motion.row_of(
                    affine(moved), Fraction(0), Fraction(0), motion.Origin(motion.LimitKind.MOTION, 0)
                )

    driven = columns_of([(Fraction(1), Fraction(0))] * 4) * 2
    assert satisfied(motions(), driven)
    monkeypatch.setattr(motion, "_rows", euler)
    assert not satisfied(motions(), driven)


def test_limits_of_acceleration_left_out_are_caught(monkeypatch):
    true_rows = motion._rows

    def lax(name, vehicle, layout, natural, inside):
        rows = list(true_rows(name, vehicle, layout, natural, inside))
        return [row for row in rows if row.low == row.high]

    hard = columns_of([(Fraction(-7), Fraction(0))] + [(Fraction(0), Fraction(0))] * 3) * 2
    assert not satisfied(motions(), hard)
    monkeypatch.setattr(motion, "_rows", lax)
    assert satisfied(motions(), hard)


def square_of(column, factor):
    return Inequality(
        (variable(column) * variable(column)).scaled(Fraction(factor)) + affine([], Fraction(10)), False
    )


def swapped_sides(factor, form, box, side, pieces):
    other = "outer" if side == "inner" else "inner"
    return true_square(factor, form, box, other, pieces)


true_square = bounds._square


def secant_that_is_too_high(factor, form, box, side, pieces):
    made = true_square(factor, form, box, side, pieces)
    return [(tuple(x + bounds.Affine((), 6.0) for x in every), window) for every, window in made]


@pytest.mark.parametrize("wrong", [swapped_sides, secant_that_is_too_high])
def test_faults_in_bounds_are_caught(wrong, monkeypatch):
    box = [(-3.0, 4.0)]
    every = [square_of(0, factor) for factor in (-1, 1)]
    assert all(inner_is_safe(x, box) and outer_is_safe(x, box) for x in every)
    monkeypatch.setattr(bounds, "_square", wrong)
    assert not all(inner_is_safe(x, box) and outer_is_safe(x, box) for x in every)


def big_m_disagrees():
    return any(
        milp.solve_mixed(problem, milp.column_box(problem)).status != exactly(problem)
        for problem in problems(12)
    )


def test_a_big_m_that_is_too_small_is_caught(monkeypatch):
    assert not big_m_disagrees()

    def tight(self, bound, guard):
        least = bound.margin - bound.affine.constant
        if guard is None:
            self.add(bound.affine.terms, least, float("inf"), None)
        else:
            self.add([*bound.affine.terms, (guard, -1.0)], least - 1.0, float("inf"), None)

    monkeypatch.setattr(big_m._MilpBuilder, "_bound", tight)
    assert big_m_disagrees()


def test_a_big_m_without_its_guard_is_caught(monkeypatch):
    def unguarded(self, node, guard, chosen):
        true_hold(self, node, None, chosen)

    true_hold = big_m._MilpBuilder._hold
    monkeypatch.setattr(big_m._MilpBuilder, "_hold", unguarded)
    assert big_m_disagrees()


def test_a_disjunction_that_asks_for_nothing_is_caught(monkeypatch):
    true_add = big_m._MilpBuilder.add

    def lax(self, terms, low, high, source):
        true_add(self, terms, 0.0 if low == 1.0 and high == float("inf") else low, high, source)

    monkeypatch.setattr(big_m._MilpBuilder, "add", lax)
    assert big_m_disagrees()


def test_an_implicant_of_the_wrong_part_would_not_be_true():
    parts = [inequalities.Leaf("low"), inequalities.Leaf("high")]
    assert implicant(any_of(parts), lambda x: 1.0 if x == "high" else -1.0) == ("high",)
    assert implicant(All(()), lambda _: 0.0) == ()


def decided_wrongly():
    """Inequalities that are 0 at an end of their box, and are said to be true or false all over it."""
    column = (RealColumn(Unknown("x", "s", 0), Fraction(0), Fraction(1)),)
    wrong = set()
    for factor, constant in ((1, -1), (-1, 0), (1, 0), (-1, 1)):
        for strict in (False, True):
            inequality = Inequality(affine([(0, Fraction(factor))], Fraction(constant)), strict)
            somewhere = exactly(Problem(column, (), All((Leaf(inequality),)))) == "found"
            values = (Fraction(constant), Fraction(factor + constant))
            everywhere = all(value > 0 or (value == 0 and not strict) for value in values)
            inner, outer = (
                bounds.affine_bounds(inequality, [(0.0, 1.0)], side) for side in ("inner", "outer")
            )
            if somewhere and AnyOf in (type(inner), type(outer)):
                wrong.add("false")
            if not everywhere and isinstance(inner, All):
                wrong.add("true")
    return wrong


AT_ZERO = {
    "greatest value 0 is false": ("high == 0 and inequality.strict", "high == 0", {"false"}),
    "greatest value 0 is false on the outer side": ("high < -slack", "high <= slack", {"false"}),
    "least value 0 is true": ("low == 0 and not inequality.strict", "low == 0", {"true"}),
    "greatest value 0 is true": ("low > 0 or", "high >= 0 or", {"true"}),
}


@pytest.mark.parametrize("fault", AT_ZERO)
def test_a_fact_that_is_0_at_an_end_is_not_decided_by_it(fault, monkeypatch):
    right, wrong, noticed = AT_ZERO[fault]
    assert decided_wrongly() == set()
    plant(monkeypatch, bounds, "_leaf", right, wrong)
    assert decided_wrongly() == noticed


def relaxation_loses_something():
    """Whether a problem that is feasible by a hair is infeasible once bounds and rows are doubles."""
    third, tenth = Fraction(1, 3), Fraction(1, 10)
    columns = tuple(RealColumn(Unknown("x", "s", k), third * k, third * k + tenth) for k in range(3))
    # x0 is 0 by the first row, x1 is 1/3 and x2 is 2/3 by inequalities.
    rows = (Row({0: third, 1: -third}, None, -(third**2)), Row({0: tenth, 2: third}, None, 2 * third**2))
    inequalities = [affine([(0, Fraction(-1))]), affine([(1, Fraction(-7))], 7 * third)]
    squares = [
        (variable(1) * variable(1)).scaled(Fraction(sign)) + affine([], -sign * third**2) for sign in (1, -1)
    ]
    problem = Problem(
        columns, rows, All(tuple(Leaf(Inequality(p, False)) for p in (*inequalities, *squares)))
    )
    assert exactly(problem) == "found"
    return milp.solve_mixed(problem, milp.column_box(problem), "outer", 2).status == "infeasible"


INWARDS = {
    "rows": (milp, "encode_mixed", "float(row.high) + slack", "float(row.high) - 10 * slack"),
    "bounds of columns": (milp, "encode_mixed", "loosened(box) if", "[(a + 1e-4, b) for a, b in box] if"),
    "inequalities": (bounds, "_leaf", "Bound(affine, -slack,", "Bound(affine, 10 * slack,"),
}


@pytest.mark.parametrize("fault", INWARDS)
def test_rounding_inwards_is_caught(fault, monkeypatch):
    assert not relaxation_loses_something()
    plant(monkeypatch, *INWARDS[fault])
    assert relaxation_loses_something()


def overlap_differs():
    """Whether boxes of a car and a long truck are said to be apart where they overlap, or the reverse.

    They are far from each other at one sample, and at the other somewhere around each other.
    """
    car = load_vehicle("car")
    truck = replace(car, length=Fraction(16), width=Fraction(5, 2))
    layout = ColumnLayout(("A", "B"), Grid(Fraction(1), 1))
    none = (Fraction(0), Fraction(0))
    kept, at_samples = (
        place.stay_apart(layout, ("A", car), ("B", truck), none, between) for between in (True, False)
    )
    for k, along, across in product((0, 1), range(-18, 19), (Fraction(n, 10) for n in range(-30, 31, 2))):
        values = dict.fromkeys(range(16), Fraction(0))
        values[layout.column("B", "s", 1 - k)] = Fraction(1000 if along > 0 else -1000)
        values[layout.column("B", "s", k)] = Fraction(along)
        values[layout.column("B", "d", k)] = across
        overlap = -car.length < along < truck.length and -car.width < across < truck.width

        def holds(inequality, at=values):
            return inequality.polynomial.value(at.__getitem__) >= 0

        if evaluate(at_samples, holds) == overlap or (overlap and evaluate(kept, holds)):
            return True
    return False


APART = {
    "the other vehicle's size": ("(low, _), (high, body)", "(low, body), (high, _)"),
    "lengths for widths": ('("d", "width", gaps[1])', '("d", "length", gaps[1])'),
    "widths for lengths": ('("s", "length", gaps[0])', '("s", "width", gaps[0])'),
    "one side only": ("((first, second), (second, first))", "((first, second),)"),
    "the last sample is left out": ("_step_groups(layout.grid.steps, between)", "_step_groups(0, between)"),
    "the first sample is left out": ("_step_groups(layout.grid.steps, between)", "[(layout.grid.steps,)]"),
}


@pytest.mark.parametrize("fault", APART)
def test_boxes_measured_wrongly_are_caught(fault, monkeypatch):
    assert not overlap_differs()
    plant(monkeypatch, place, "stay_apart", *APART[fault])
    assert overlap_differs()


@pytest.mark.parametrize("signal", ["j_up", "a_up", "v", "x_lat", ""])
def test_a_signal_that_is_not_known_is_refused(signal):
    with pytest.raises(AssertionError, match=f"'{signal}'$"):
        ColumnLayout(("A",), Grid(Fraction(1), 1)).state("A", signal, 0)
