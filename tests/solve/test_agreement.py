"""z3, the mixed-integer solver, the judge and the definition on 500 random formulas and traces.

A trace is fixed by rows, not by bounds, so that every big-M is at work. The circuits of all formulas
that hold on it have to be satisfiable together, and those of the others must not be, not even one.
"""

import warnings
from fractions import Fraction

import pytest
from hypothesis.errors import NonInteractiveExampleWarning

from encode import cases
from roadproof.engines.encode.build import NONE, ground
from roadproof.engines.encode.circuit import all_of, any_of
from roadproof.engines.encode.motion import Layout
from roadproof.engines.encode.problem import Column, Problem, Row, Unknown
from roadproof.engines.encode.unroll import unroll
from roadproof.engines.solve.exact import solve_exactly
from roadproof.engines.solve.milp import box_of, solve_mixed
from roadproof.semantics.exact import judge
from roadproof.world.models import load_vehicle
from roadproof.world.motion import state_at

GROUPS, EACH = 10, 50
LAYOUT = Layout(("A", "B"), cases.GRID)
CARS = dict.fromkeys(LAYOUT.vehicles, load_vehicle("car"))


def groups():
    """Traces with the formulas that are tried on them, the same on every run."""
    from hypothesis import Phase, given, seed, settings
    from hypothesis import strategies as st

    made = []

    @seed(7)
    @settings(max_examples=GROUPS * 3, database=None, phases=[Phase.generate], deadline=None)
    @given(cases.traces, st.lists(cases.formulas(leaves=5), min_size=EACH, max_size=EACH))
    def collect(trace, formulas):
        made.append((trace, formulas))

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", NonInteractiveExampleWarning)
        collect()
    return made[-GROUPS:]


def problem(trace, circuit):
    """Columns with wide bounds, fixed by rows to the drive of ``trace``."""
    drive = cases.as_drive(trace)
    columns, rows = [], []
    for name in LAYOUT.vehicles:
        for signal in ("s", "d", "v_lon", "v_lat"):
            for k in range(cases.STEPS + 1):
                value = getattr(state_at(drive.vehicles[name], k * cases.DT), signal)
                column = LAYOUT.column(name, signal, k)
                columns.append((column, Column(Unknown(name, signal, k), Fraction(-200), Fraction(200))))
                rows.append(Row({column: Fraction(1)}, value, value))
    return Problem(tuple(c for _, c in sorted(columns, key=lambda x: x[0])), tuple(rows), circuit)


@pytest.fixture(scope="module")
def every_group():
    return groups()


def test_there_are_500_of_both_kinds(every_group):
    truths = [cases.holds(f, trace) for trace, formulas in every_group for f in formulas]
    assert len(truths) == GROUPS * EACH == 500
    assert 100 < sum(truths) < 400


def test_solvers_judge_and_definition_agree(every_group):
    for trace, formulas in every_group:
        circuits = {True: [], False: []}
        for formula in formulas:
            expected = cases.holds(formula, trace)
            assert judge(formula, cases.as_drive(trace)).holds == expected
            circuits[expected].append(ground(unroll(formula, cases.GRID), CARS, LAYOUT, NONE))
        every_true = problem(trace, all_of(circuits[True]))
        some_false = problem(trace, any_of(circuits[False]))
        assert solve_exactly(every_true).status == "found"
        assert solve_exactly(some_false).status == "infeasible"
        assert solve_mixed(every_true, box_of(every_true)).status == "found"
        assert solve_mixed(some_false, box_of(some_false)).status == "infeasible"
