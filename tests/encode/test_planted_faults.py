"""Deliberate faults in unrolling, facts, motion, bounds and big-M: neighbouring checks catch each."""

from fractions import Fraction

import pytest
from hypothesis import Phase, find, settings
from hypothesis import strategies as st
from hypothesis.errors import NoSuchExample

from encode import cases
from encode.test_motion import columns_of, motions, satisfied
from roadproof.encode import facts, motion, unroll
from roadproof.encode.circuit import All, any_of, evaluate, implicant
from roadproof.encode.polynomial import Fact, affine, variable
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.solve import bounds, milp
from solve.small import exactly, inner_is_safe, outer_is_safe, problems

search = settings(deadline=None, derandomize=True, max_examples=1000, database=None, phases=[Phase.generate])


small_formulas = cases.formulas(leaves=4)


def unrolling_is_wrong():
    """Whether some formula and trace tell the circuit from the definition."""

    def differs(pair):
        formula, trace = pair
        circuit = unroll.unroll(formula, cases.GRID)
        found = evaluate(circuit, lambda at: cases.holds(at.atom, trace, at.step))
        return found != cases.holds(formula, trace)

    try:
        find(st.tuples(small_formulas, cases.traces), differs, settings=search)
    except NoSuchExample:
        return False
    return True


def short_window(self, interval, step):
    low, high = self.grid.window(interval)
    last = self.grid.steps
    first = min(step + low, last)
    return range(first, 1 + (last if high is None else max(first, min(step + high - 1, last))))


def until_asking_for_left_at_the_end(self, left, samples, right, wanted, both, either):
    result = both([self.at(left, wanted, samples[-1]), self.at(right, wanted, samples[-1])])
    for k in reversed(samples[:-1]):
        here = both([self.at(left, wanted, k), self.at(right, wanted, k)])
        result = either([here, both([self.at(left, wanted, k), result])])
    return result


def until_without_left(self, left, samples, right, wanted, both, either):
    return either([self.at(right, wanted, k) for k in samples])


def forgetful_negation(self, formula, wanted, step):
    return self._at(formula, True, step)


UNROLLING = {
    "a window one step short": ("_samples", short_window),
    "until asks for its left side at the end": ("_until", until_asking_for_left_at_the_end),
    "until is eventually": ("_until", until_without_left),
    "polarity is forgotten": ("at", forgetful_negation),
}


@pytest.mark.parametrize("fault", UNROLLING)
def test_faults_in_unrolling_are_caught(fault, monkeypatch):
    name, wrong = UNROLLING[fault]
    monkeypatch.setattr(unroll._Unrolling, name, wrong)
    assert unrolling_is_wrong()


def test_strictness_lost_in_negation_is_caught(monkeypatch):
    monkeypatch.setattr(unroll, "_OPPOSITE", {"<": ">", "<=": ">=", ">": "<", ">=": "<="})
    rises = cases.atom("a_lon", "A", ">", Fraction(0))
    circuit = unroll.unroll(f.Not(rises), cases.GRID)
    still = {w: [0] * cases.STEPS for w in cases.SIGNALS}
    assert not evaluate(circuit, lambda at: cases.holds(at.atom, still, at.step))
    assert cases.holds(f.Not(rises), still)


def test_a_maximum_read_as_a_conjunction_is_caught(monkeypatch):
    monkeypatch.setattr(facts, "any_of", facts.all_of)
    v = t.Signal("v_lon", "A")
    circuit = facts.facts_of(f.Compare(t.Maximum((v, t.number(0))), ">=", t.number(0)), {})
    below = evaluate(circuit, lambda fact: fact.polynomial.value(lambda _: Fraction(-1)) >= 0)
    assert not below  # max(-1, 0) >= 0 holds, so test_facts_are_true_where_the_comparison_is fails


def test_positions_by_the_speed_at_the_start_are_caught(monkeypatch):
    def euler(name, vehicle, layout, natural, inside):
        for k in range(layout.grid.steps):
            for place, speed in (("s", "v_lon"), ("d", "v_lat")):
                moved = [(layout.column(name, place, k + 1), Fraction(1))]
                moved += [(layout.column(name, place, k), Fraction(-1))]
                moved += [(layout.column(name, speed, k), -layout.grid.dt)]
                yield motion.row_of(affine(moved), Fraction(0), Fraction(0))

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
    return Fact(
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
        milp.solve_mixed(problem, milp.box_of(problem)).status != exactly(problem) for problem in problems(12)
    )


def test_a_big_m_that_is_too_small_is_caught(monkeypatch):
    assert not big_m_disagrees()

    def tight(self, affine, guard, margin):
        least = margin - affine.constant
        if guard is None:
            self.add(affine.terms, least, float("inf"))
        else:
            self.add([*affine.terms, (guard, -1.0)], least - 1.0, float("inf"))

    monkeypatch.setattr(milp._Tableau, "_bound", tight)
    assert big_m_disagrees()


def test_a_big_m_without_its_guard_is_caught(monkeypatch):
    def unguarded(self, node, guard, chosen):
        true_hold(self, node, None, chosen)

    true_hold = milp._Tableau._hold
    monkeypatch.setattr(milp._Tableau, "_hold", unguarded)
    assert big_m_disagrees()


def test_a_disjunction_that_asks_for_nothing_is_caught(monkeypatch):
    true_add = milp._Tableau.add

    def lax(self, terms, low, high):
        true_add(self, terms, 0.0 if low == 1.0 and high == float("inf") else low, high)

    monkeypatch.setattr(milp._Tableau, "add", lax)
    assert big_m_disagrees()


def test_an_implicant_of_the_wrong_part_would_not_be_true():
    parts = [facts.Leaf("low"), facts.Leaf("high")]
    assert implicant(any_of(parts), lambda x: 1.0 if x == "high" else -1.0) == ("high",)
    assert implicant(All(()), lambda _: 0.0) == ()
