"""Mixed-integer answers against z3's on the same problems, both ways."""

import os
import random
import re
import subprocess
import sys
import warnings
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis.errors import NonInteractiveExampleWarning

from encode import cases
from roadproof.engines.encode.build import NO_MARGIN, ground_atoms
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
    all_of,
    any_of,
    evaluate,
    nodes,
)
from roadproof.engines.encode.unroll import unroll
from roadproof.engines.solve import milp, smooth
from roadproof.engines.solve.bounds import (
    ROUNDING,
    TOLERANCE,
    Affine,
    Bound,
    TooNonlinearError,
    affine_bounds,
    loosened,
    polynomial_value,
    split_squares,
)
from roadproof.engines.solve.exact import solve_exactly
from roadproof.engines.solve.milp import column_box, find_solver, solve_mixed
from roadproof.engines.solve.recall import find_model
from roadproof.engines.solve.smooth import Square, linearise_at, minimise, trust_box
from roadproof.engines.solve.smt import Session, check_sat, parse_sexpression, read_value
from roadproof.errors import MissingSolverError, UsageError
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact import judge
from roadproof.world.models import load_vehicle
from roadproof.world.motion import state_at
from roadproof.world.polynomial import affine, constant, variable
from solve import small
from tables import read_table


def satisfied(problem, values, tolerance=1e-6):
    for row in problem.rows:
        total = sum(float(k) * values[c] for c, k in row.terms.items())
        if (row.low is not None and total < row.low - tolerance) or (
            row.high is not None and total > row.high + tolerance
        ):
            return False
    return small.evaluate(
        problem.circuit, lambda inequality: polynomial_value(inequality, values) >= -tolerance
    )


def test_affine_problems_have_the_same_answer_as_z3():
    answers = set()
    for problem in small.problems(40):
        solution = solve_mixed(problem, column_box(problem))
        answers.add(solution.status)
        assert solution.status == solve_exactly(problem).status
        if solution.status == "found":
            assert satisfied(problem, solution.values)
    assert answers == {"found", "infeasible"}


def test_quadratic_problems_are_answered_on_the_safe_side():
    found, none = 0, 0
    for problem in small.problems(16, quadratic=True, seed=2):
        truth = solve_exactly(problem, Effort(5).meter()).status
        inner = solve_mixed(problem, column_box(problem), "inner", 3)
        outer = solve_mixed(problem, column_box(problem), "outer", 3)
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
        made = affine_bounds(inequality, box, "inner", pieces)
        return sum(small.approximation_holds(made, p) for p in small.grid_of(box, 161))

    assert kept(1) < kept(8) <= sum(polynomial_value(inequality, p) >= 0 for p in small.grid_of(box, 161))


def test_another_solver_gives_the_same_answers():
    for problem in small.problems(5, seed=3):
        assert solve_mixed(problem, column_box(problem), solver="scipy").status == small.exactly(problem)


def test_solvers_are_silent():
    """Standard output is the command's: HiGHS 1.16.0 writes its version there, so it is left out.

    In a process of its own, since what C writes is seen when it ends.
    """
    code = (
        "from solve import small; from roadproof.engines.solve.milp import column_box, solve_mixed; "
        "[solve_mixed(p, column_box(p)) for p in small.problems(3, seed=4)]"
    )
    path = os.pathsep.join([str(Path(__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    run = subprocess.run(
        [sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": path}, capture_output=True, text=True
    )
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "")


def test_degree_three_is_refused():
    cube = variable(0) * variable(0) * variable(0)
    problem = Problem(
        (RealColumn(Unknown("x", "s", 0), Fraction(0), Fraction(1)),), (), Leaf(Inequality(cube, False))
    )
    with pytest.raises(TooNonlinearError):
        solve_mixed(problem, column_box(problem))
    assert solve_exactly(problem).status == "found"


def test_unknown_and_missing_solvers_are_told_apart(monkeypatch):
    with pytest.raises(UsageError, match="choose one of cbc"):
        find_solver("nothing")
    monkeypatch.setattr(milp, "find_spec", lambda name: None)
    with pytest.raises(MissingSolverError, match="pip install highspy, or choose the engine smt"):
        find_solver("highs")


def test_nothing_and_everything():
    column = (RealColumn(Unknown("x", "s", 0), Fraction(0), Fraction(1)),)
    assert solve_mixed(Problem(column, (), All(())), [(0.0, 1.0)]).status == "found"
    assert solve_mixed(Problem(column, (), AnyOf(())), [(0.0, 1.0)]).status == "infeasible"
    assert solve_exactly(Problem(column, (), AnyOf(()))).status == "infeasible"
    assert solve_exactly(Problem(column, (), All(()))).status == "found"


def test_strictness_is_exact_for_z3():
    x = affine([(0, Fraction(1))], Fraction(-1))
    column = (RealColumn(Unknown("x", "s", 0), Fraction(0), Fraction(1)),)
    assert solve_exactly(Problem(column, (), Leaf(Inequality(x, False)))).values == (Fraction(1),)
    assert solve_exactly(Problem(column, (), Leaf(Inequality(x, True)))).status == "infeasible"


# --- z3, the mixed-integer solver, the judge and the definition on 500 random formulas and traces ---
# A trace is fixed by rows, not by bounds, so that every big-M is at work. The circuits of all formulas that
# hold on it have to be satisfiable together, and those of the others must not be, not even one.

GROUPS, EACH = 10, 50
LAYOUT = ColumnLayout(("A", "B"), cases.GRID)
CARS = dict.fromkeys(LAYOUT.vehicles, load_vehicle("car"))


def groups():
    """Traces with the formulas that are tried on them, the same on every run."""
    from hypothesis import Phase, given, seed, settings
    from hypothesis import strategies as st

    made = []

    @seed(7)
    @settings(max_examples=GROUPS * 3, database=None, phases=[Phase.generate], deadline=None)
    @given(cases.traces, st.lists(cases.formulas(leaves=5, past=False), min_size=EACH, max_size=EACH))
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
                columns.append((column, RealColumn(Unknown(name, signal, k), Fraction(-200), Fraction(200))))
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
            circuits[expected].append(ground_atoms(unroll(formula, cases.GRID), CARS, LAYOUT, NO_MARGIN))
        every_true = problem(trace, all_of(circuits[True]))
        some_false = problem(trace, any_of(circuits[False]))
        assert solve_exactly(every_true).status == "found"
        assert solve_exactly(some_false).status == "infeasible"
        assert solve_mixed(every_true, column_box(every_true)).status == "found"
        assert solve_mixed(some_false, column_box(some_false)).status == "infeasible"


# --- Affine forms, squares split off, and conditions on either side of an inequality: small cases by hand

BOX = [(-1.0, 3.0), (2.0, 5.0)]
FORM = Affine(((0, 2.0), (1, -1.0)), 0.5)


def test_affine_forms():
    assert FORM.range(BOX) == (2 * -1 - 5 + 0.5, 2 * 3 - 2 + 0.5)
    assert FORM.value([3.0, 4.0]) == 2.5
    assert FORM.scaled(-2.0) == Affine(((0, -4.0), (1, 2.0)), -1.0)
    assert FORM + Affine(((1, 3.0), (2, 1.0)), 1.0) == Affine(((0, 2.0), (1, 2.0), (2, 1.0)), 1.5)
    assert FORM.looseness(BOX) == TOLERANCE + ROUNDING * (0.5 + 2 * 3 + 5)


def test_a_loosened_box_keeps_single_values():
    (fixed, wide) = loosened([(7.0, 7.0), (-2.0, 3.0)])
    assert fixed == (7.0, 7.0)
    assert wide == (-2 - TOLERANCE - 2 * ROUNDING, 3 + TOLERANCE + 3 * ROUNDING)


def test_a_polynomial_is_an_affine_part_and_squares():
    x, y = variable(0), variable(1)
    polynomial = x * x + (x * y).scaled(Fraction(6)) + affine([(0, Fraction(-3))], Fraction(7))
    linear, squares = split_squares(Inequality(polynomial, False))
    assert linear == Affine(((0, -3.0),), 7.0)
    for point in ([0.0, 0.0], [1.0, 2.0], [-2.0, 3.5]):
        total = linear.value(point) + sum(factor * form.value(point) ** 2 for factor, form in squares)
        assert total == pytest.approx(polynomial_value(Inequality(polynomial, False), point))
    assert polynomial_value(Inequality(polynomial, False), [1.0, 2.0]) == 1 + 12 - 3 + 7
    with pytest.raises(TooNonlinearError):
        split_squares(Inequality(x * x * y, False))


@pytest.mark.parametrize(
    ("shift", "strict", "inner", "outer"),
    read_table(__file__, "what_the_box_decides"),
)
def test_what_the_box_decides(shift: int, strict: bool, inner: str, outer: str):
    """The polynomial is x + 1 + shift on [-1, 3], so from shift to 4 + shift."""
    inequality = Inequality(affine([(0, Fraction(1))], Fraction(1 + shift)), strict, Fraction(1, 8))
    for side, expected in (("inner", inner), ("outer", outer)):
        made = affine_bounds(inequality, BOX, side)
        found = (
            "leaf"
            if isinstance(made, Leaf)
            else "true"
            if made.parts == () and isinstance(made, All)
            else "false"
        )
        assert found == expected, side
        if isinstance(made, Leaf):
            slack = -made.content.affine.looseness(BOX)
            assert made.content.margin == (0.125 if side == "inner" else slack)


def bounds_of(polynomial, side, pieces):
    made = affine_bounds(Inequality(polynomial, False), [(-2.0, 4.0)], side, pieces)
    return made, [node.content for node in nodes(made) if isinstance(node, Leaf)]


def test_a_tangent_is_below_a_square_and_a_secant_above():
    square = variable(0) * variable(0)
    low, high = square + constant(Fraction(-3)), square.scaled(Fraction(-1)) + constant(Fraction(9))
    assert bounds_of(low, "inner", 1)[1] == [Bound(Affine(((0, 2.0),), -1.0 - 3.0), 0.0)]
    assert bounds_of(high, "inner", 1)[1] == [Bound(Affine(((0, -2.0),), 9.0 - 8.0), 0.0)]
    (above,) = bounds_of(square + constant(Fraction(-9)), "outer", 1)[1]
    assert above.affine == Affine(((0, 2.0),), 8.0 - 9.0)
    assert above.margin == -above.affine.looseness([(-2.0, 4.0)])


def test_pieces_are_tangents_to_choose_from_and_windows():
    square = variable(0) * variable(0)
    made, tangents = bounds_of(square + constant(Fraction(-3)), "inner", 3)
    assert isinstance(made, AnyOf)
    assert [b.affine for b in tangents] == [Affine(((0, 2.0 * p),), -p * p - 3.0) for p in (-1.0, 1.0, 3.0)]
    made, windows = bounds_of(square.scaled(Fraction(-1)) + constant(Fraction(3)), "inner", 2)
    assert isinstance(made, AnyOf)
    ends = [(b.affine.terms, b.affine.constant) for b in windows if abs(b.affine.terms[0][1]) == 1.0]
    assert {(((0, 1.0),), -1.0), (((0, -1.0),), 1.0)} <= set(ends)


def test_windows_of_outer_secants_overlap():
    """At an end or a cut, a solver that is a little off finds a window; else it would say a wrong no."""
    made, _ = bounds_of(variable(0) * variable(0) + constant(Fraction(-1, 2)), "outer", 2)
    for x in (-2.0, 1 - TOLERANCE, 1.0, 1 + TOLERANCE, 4.0):
        assert evaluate(made, lambda bound, x=x: bound.affine.value([x]) >= bound.margin + TOLERANCE / 10)


def test_outer_tangents_are_all_asked_for():
    square = variable(0) * variable(0)
    made, bounds = bounds_of(square.scaled(Fraction(-1)) + constant(Fraction(2)), "outer", 3)
    assert isinstance(made, All)
    assert len(bounds) == 3


def test_a_square_of_one_value_is_a_number():
    square = variable(0) * variable(0)
    made = affine_bounds(Inequality(square + constant(Fraction(-9)), False), [(3.0, 3.0)], "inner")
    assert isinstance(made, All)
    assert made.parts == ()


# --- Convex programs: optima that are known, and inequalities near a point --------------------------

UNIT = [(-10.0, 10.0), (-10.0, 10.0)]
X, Y = Affine(((0, 1.0),), 0.0), Affine(((1, 1.0),), 0.0)


def test_a_least_square_within_rows_and_bounds():
    row = Row({0: Fraction(1), 1: Fraction(1)}, Fraction(4), Fraction(4))
    found = minimise([row], UNIT, [Bound(X, 3.0)], [Square(1.0, X), Square(1.0, Y)])
    assert found == pytest.approx((3.0, 1.0), abs=1e-4)


def test_a_cost_beside_squares():
    found = minimise(
        [], UNIT, [], [Square(0.5, X + Affine((), -1.0)), Square(1.0, Y)], Affine(((0, 2.0),), 0.0)
    )
    assert found == pytest.approx((-1.0, 0.0), abs=1e-4)


def test_a_cost_alone_ends_at_the_ends_of_the_box():
    found = minimise([], [(-1.0, 2.0), (-3.0, 4.0)], [], [], Affine(((0, -1.0), (1, 1.0)), 0.0))
    assert found == pytest.approx((2.0, -3.0), abs=1e-4)


def test_what_cannot_be_is_none():
    assert minimise([], UNIT, [Bound(X, 3.0), Bound(X.scaled(-1.0), 0.0)], [Square(1.0, X)]) is None


def test_fixed_columns_stay():
    assert minimise([], [(2.0, 2.0), (-1.0, 1.0)], [], [Square(1.0, X), Square(1.0, Y)]) == pytest.approx(
        (2.0, 0.0), abs=1e-4
    )


def test_near_a_point_a_fact_is_approximated_from_inside():
    dice = random.Random(5)
    for _ in range(60):
        inequality = small.inequality(dice, True)
        point = [dice.uniform(-3, 3) for _ in range(small.COLUMNS)]
        box = trust_box([(-4.0, 4.0)] * small.COLUMNS, point, [0.5] * small.COLUMNS)
        bound = linearise_at(inequality, point, box)
        for p in small.grid_of(box, 5):
            assert bound.affine.value(p) <= polynomial_value(inequality, p) + 1e-9


def test_narrow_stays_inside_and_around():
    assert trust_box([(0.0, 10.0), (0.0, 1.0)], [9.5, 1.0000001], [1.0, 5.0]) == [(8.5, 10.0), (0.0, 1.0)]


def test_a_missing_solver_is_named(monkeypatch):
    monkeypatch.setattr(smooth, "find_spec", lambda name: None)
    with pytest.raises(MissingSolverError, match="clarabel"):
        minimise([], UNIT, [], [])


# --- What is read of a solver's answer, and which solver is asked -----------------------------------

SCRIPT = "(declare-const x Real)(assert (> x 1.0))(check-sat)"


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("true", True),
        ("false", False),
        ("(- 2.5)", Fraction(-5, 2)),
        ("(/ (- 1.0) 3.0)", Fraction(-1, 3)),
        ("(- (/ 1.0 3.0))", Fraction(-1, 3)),
        ("(root-obj (+ (^ x 2) (- 2)) 2)", None),
        ("(- (root-obj (+ (^ x 2) (- 2)) 2))", None),
        ("(/ (root-obj (+ (^ x 2) (- 2)) 2) 2.0)", None),
        ("(/ 2.0 (root-obj (+ (^ x 2) (- 2)) 2))", None),
    ],
)
def test_values(text: str, value: Fraction | bool | None) -> None:
    (read,) = parse_sexpression(f"({text})")
    assert read_value(read) == value


def test_a_value_that_is_not_rational_is_left_out() -> None:
    told = "(declare-const x Real)(declare-const p Bool)(assert (and p (< x 0.0) (= (* x x) 2.0)))"
    session = Session()
    session.tell(told)
    assert session.check() == "sat"
    assert session.values(["x", "p", "(* x x)"]) == [None, True, Fraction(2)]
    assert find_model(f"{told}(check-sat)", ["x", "p"], Effort().meter()) == {"p": True}


def test_z3_needs_no_other_solver(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cvc5", None)
    assert check_sat(SCRIPT) == check_sat(SCRIPT, "z3") == "sat"
    with pytest.raises(MissingSolverError, match="solver=cvc5 is not installed"):
        check_sat(SCRIPT, "cvc5")


def test_cvc5_is_asked_where_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Session, "answer", None)
    assert check_sat(SCRIPT, "cvc5") == "sat"


@pytest.mark.parametrize("version", ["1.5.4", "1.9.1"])
def test_cvxpy_that_loses_bounds_is_refused(version: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(milp.import_cvxpy(), "__version__", version)
    with pytest.raises(MissingSolverError, match=re.escape(f"cvxpy={version} calls problems infeasible")):
        milp.import_cvxpy()


@pytest.mark.parametrize("version", ["1.9.2", "1.10.0", "2.0.0rc1"])
def test_later_versions_of_cvxpy_are_taken(version: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(milp.import_cvxpy(), "__version__", version)
    assert milp.import_cvxpy().__version__ == version
