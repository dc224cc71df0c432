"""Mixed-integer answers against z3's on the same problems, both ways."""

import os
import random
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest

from roadproof.engines.encode.circuit import All, AnyOf, Leaf
from roadproof.engines.encode.polynomial import Inequality, affine, variable
from roadproof.engines.encode.problem import Column, Problem, Unknown
from roadproof.engines.solve import milp
from roadproof.engines.solve.bounds import TooNonlinearError, approximate, value_of
from roadproof.engines.solve.exact import solve_exactly
from roadproof.engines.solve.milp import box_of, find_solver, solve_mixed
from roadproof.errors import MissingSolverError, UsageError
from roadproof.runtime.budget import Effort
from solve import small


def satisfied(problem, values, tolerance=1e-6):
    for row in problem.rows:
        total = sum(float(k) * values[c] for c, k in row.terms.items())
        if (row.low is not None and total < row.low - tolerance) or (
            row.high is not None and total > row.high + tolerance
        ):
            return False
    return small.evaluate(problem.circuit, lambda inequality: value_of(inequality, values) >= -tolerance)


def test_affine_problems_have_the_same_answer_as_z3():
    answers = set()
    for problem in small.problems(40):
        solution = solve_mixed(problem, box_of(problem))
        answers.add(solution.status)
        assert solution.status == solve_exactly(problem).status
        if solution.status == "found":
            assert satisfied(problem, solution.values)
    assert answers == {"found", "infeasible"}


def test_quadratic_problems_are_answered_on_the_safe_side():
    found, none = 0, 0
    for problem in small.problems(16, quadratic=True, seed=2):
        truth = solve_exactly(problem, Effort(5).meter()).status
        inner = solve_mixed(problem, box_of(problem), "inner", 3)
        outer = solve_mixed(problem, box_of(problem), "outer", 3)
        if inner.status == "found":
            found += 1
            assert truth != "infeasible"
            assert satisfied(problem, inner.values)
        if outer.status == "infeasible":
            none += 1
            assert truth != "found"
    assert found >= 4
    assert none >= 2


@pytest.mark.parametrize("pieces", [1, 2, 3])
def test_bounds_are_on_their_side(pieces):
    dice = random.Random(pieces)
    for _ in range(25):
        inequality = small.inequality(dice, True)
        box = [(-3.0, float(dice.randint(-2, 4))) for _ in range(small.COLUMNS)]
        assert small.inner_is_safe(inequality, box, pieces)
        assert small.outer_is_safe(inequality, box, pieces)


def test_more_pieces_are_nearer():
    inequality = Inequality((variable(0) * variable(0)).scaled(Fraction(-1)) + affine([], Fraction(1)), False)
    box = [(-3.0, 5.0)]

    def kept(pieces):
        made = approximate(inequality, box, "inner", pieces)
        return sum(small.approximation_holds(made, p) for p in small.grid_of(box, 161))

    assert kept(1) < kept(8) <= sum(value_of(inequality, p) >= 0 for p in small.grid_of(box, 161))


def test_another_solver_gives_the_same_answers():
    for problem in small.problems(5, seed=3):
        assert solve_mixed(problem, box_of(problem), solver="scipy").status == small.exactly(problem)


def test_solvers_are_silent():
    """Standard output is the command's: HiGHS 1.16.0 writes its version there, so it is left out.

    In a process of its own, since what C writes is seen when it ends.
    """
    code = (
        "from solve import small; from roadproof.engines.solve.milp import box_of, solve_mixed; "
        "[solve_mixed(p, box_of(p)) for p in small.problems(3, seed=4)]"
    )
    path = os.pathsep.join([str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    run = subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True
    )
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "")


def test_degree_three_is_refused():
    cube = variable(0) * variable(0) * variable(0)
    problem = Problem(
        (Column(Unknown("x", "s", 0), Fraction(0), Fraction(1)),), (), Leaf(Inequality(cube, False))
    )
    with pytest.raises(TooNonlinearError):
        solve_mixed(problem, box_of(problem))
    assert solve_exactly(problem).status == "found"


def test_unknown_and_missing_solvers_are_told_apart(monkeypatch):
    with pytest.raises(UsageError, match="choose one of cbc"):
        find_solver("nothing")
    monkeypatch.setattr(milp, "find_spec", lambda name: None)
    with pytest.raises(MissingSolverError, match="pip install cvxpy, or choose the engine smt"):
        find_solver("highs")


def test_nothing_and_everything():
    column = (Column(Unknown("x", "s", 0), Fraction(0), Fraction(1)),)
    assert solve_mixed(Problem(column, (), All(())), [(0.0, 1.0)]).status == "found"
    assert solve_mixed(Problem(column, (), AnyOf(())), [(0.0, 1.0)]).status == "infeasible"
    assert solve_exactly(Problem(column, (), AnyOf(()))).status == "infeasible"
    assert solve_exactly(Problem(column, (), All(()))).status == "found"


def test_strictness_is_exact_for_z3():
    x = affine([(0, Fraction(1))], Fraction(-1))
    column = (Column(Unknown("x", "s", 0), Fraction(0), Fraction(1)),)
    assert solve_exactly(Problem(column, (), Leaf(Inequality(x, False)))).values == (Fraction(1),)
    assert solve_exactly(Problem(column, (), Leaf(Inequality(x, True)))).status == "infeasible"
