"""A solver that reaches a limit knows nothing: no answer of it is a no, nor a yes that time has made."""

import random
from dataclasses import replace
from fractions import Fraction

import cvxpy
import pytest

from roadproof.engines.encode.problem import (
    ColumnValues,
    Inequality,
    Leaf,
    Problem,
    RealColumn,
    Row,
    Unknown,
    all_of,
    any_of,
)
from roadproof.engines.solve import exact, milp, smt
from roadproof.engines.solve.exact import solve_exactly
from roadproof.engines.solve.highs import SolverReply
from roadproof.engines.solve.milp import column_box, solve_mixed
from roadproof.engines.solve.recall import find_model
from roadproof.engines.solve.smt import Session, check_sat
from roadproof.runtime import budget
from roadproof.runtime.budget import BudgetExceeded, Effort
from roadproof.world.polynomial import affine

COLUMNS, ROWS = 40, 4
LITTLE = Effort(0.001)
# What cvxpy calls the answers that are none: limits, failures, and what it takes for almost an answer.
NO_ANSWERS = (
    "user_limit",
    "infeasible_inaccurate",
    "unbounded",
    "unbounded_inaccurate",
    "optimal_inaccurate",
    "",
)


def either(column):
    """A column is 0 or 1."""
    low = Leaf(Inequality(affine([(column, Fraction(-1))], Fraction(0)), False))
    high = Leaf(Inequality(affine([(column, Fraction(1))], Fraction(-1)), False))
    return any_of([low, high])


def split(seed=7):
    """Which columns sum up to numbers that some of them are known to sum up to: there are, hard to find."""
    dice = random.Random(seed)
    columns = tuple(RealColumn(Unknown("x", "s", k), Fraction(0), Fraction(1)) for k in range(COLUMNS))
    answer = [dice.randint(0, 1) for _ in range(COLUMNS)]
    rows = []
    for _ in range(ROWS):
        weights = [Fraction(dice.randint(1, 10**6)) for _ in range(COLUMNS)]
        total = sum((w for w, chosen in zip(weights, answer, strict=True) if chosen), Fraction(0))
        rows.append(Row(dict(enumerate(weights)), total, total))
    return Problem(columns, tuple(rows), all_of(either(k) for k in range(COLUMNS)))


def pigeons(count, holes):
    """So many pigeons in so many holes, at most one in each, in SMT-LIB: slow where there are too few."""
    names = [[f"p{pigeon}_{hole}" for hole in range(holes)] for pigeon in range(count)]
    lines = [f"(declare-const {name} Bool)" for row in names for name in row]
    lines += [f"(assert (or {' '.join(row)}))" for row in names]
    for k, row in enumerate(names):
        for other in names[:k]:
            lines += [f"(assert (not (and {a} {b})))" for a, b in zip(row, other, strict=True)]
    return "\n".join(lines)


def cut_off():
    """The answers of every solver to questions that have one, with hardly any work allowed."""
    session = Session()
    session.tell(pigeons(15, 14))
    yield session.check(meter=LITTLE.meter())
    yield session.check_plainly(LITTLE.meter())
    yield check_sat(pigeons(7, 7) + "(check-sat)", meter=LITTLE.meter())
    yield check_sat(pigeons(15, 14) + "(check-sat)", "cvc5", LITTLE.meter())
    yield "unknown" if find_model(pigeons(7, 7) + "(check-sat)", ["p0_0"], LITTLE.meter()) is None else "sat"
    yield solve_exactly(split(), LITTLE.meter()).status
    for solver in ("highs", "scipy"):
        problem = split()
        yield solve_mixed(problem, column_box(problem), solver=solver, meter=LITTLE.meter()).status


def says_more_than_unknown():
    """Whether some solver answers although it was cut off, or is asked for values that it does not have."""
    try:
        return set(cut_off()) != {"unknown"}
    except smt.SolverError:
        return True


def test_what_is_cut_off_by_work_is_unknown():
    assert not says_more_than_unknown()


def test_the_same_questions_have_answers():
    """Else the test above would show nothing."""
    assert check_sat(pigeons(7, 7) + "(check-sat)", meter=Effort(60).meter()) == "sat"
    assert check_sat(pigeons(8, 7) + "(check-sat)", meter=Effort(60).meter()) == "unsat"
    few = split()
    small = Problem(few.columns[:8], (), all_of(either(k) for k in range(8)))
    assert solve_exactly(small).status == solve_mixed(small, column_box(small)).status == "found"


def test_work_is_counted_and_is_the_same_each_time():
    spent = []
    for _ in range(2):
        meter = Effort(5).meter()
        check_sat(pigeons(8, 7) + "(check-sat)", meter=meter)
        spent.append(meter.spent)
    assert spent[0] == spent[1] > 0.01
    meter = LITTLE.meter()
    check_sat(pigeons(15, 14) + "(check-sat)", meter=meter)
    assert meter.left() == 0


def test_a_check_without_work_left_is_not_one_without_a_limit():
    meter = Effort(1).meter()
    meter.spend(1)
    session = Session()
    assert session.check(meter=meter) == check_sat("(check-sat)", meter=meter) == "unknown"
    assert check_sat("(check-sat)", "cvc5", meter) == solve_exactly(split(), meter).status == "unknown"
    assert solve_mixed(split(), column_box(split()), meter=meter).status == "unknown"


def test_more_work_than_z3_can_count_is_as_much_as_it_can():
    """It counts in 32 bits: with one more than these hold, it would stop at once."""
    assert check_sat(pigeons(7, 7) + "(check-sat)", meter=Effort((2**32 + 1) / smt.UNIT).meter()) == "sat"


def test_an_exact_search_starts_again_with_another_seed_and_twice_the_work(monkeypatch):
    tried = []

    def give_up(self, meter, seed=0):
        tried.append((seed, meter.limit))
        meter.spend(meter.left())
        return "unknown"

    monkeypatch.setattr(Session, "check_plainly", give_up)
    assert solve_exactly(split(), Effort(10).meter()).status == "unknown"
    assert tried == [(0, 1.0), (1, 2.0), (2, 4.0), (3, 8.0)]


@pytest.mark.parametrize("solver", ["z3", "cvc5"])
def test_what_is_cut_off_by_the_clock_says_so(solver):
    with pytest.raises(BudgetExceeded, match="cut off by the clock"):
        check_sat(pigeons(15, 14) + "(check-sat)", solver, Effort(4000, 0.2).meter())


def test_a_mixed_integer_search_cut_off_by_the_clock_says_so():
    problem = split()
    with pytest.raises(BudgetExceeded):
        solve_mixed(problem, column_box(problem), meter=Effort(4000, 0.5).meter())


@pytest.mark.parametrize("status", NO_ANSWERS)
def test_no_status_but_infeasible_is_a_no(monkeypatch, status):
    monkeypatch.setattr(milp, "_solve", lambda program, known, allowed: SolverReply(status))
    problem = split()
    meter = Effort(3).meter()
    assert solve_mixed(problem, column_box(problem), meter=meter) == ColumnValues("unknown")
    assert meter.left() == 0


@pytest.mark.parametrize("status", [*NO_ANSWERS, "optimal"])
def test_what_is_no_solution_is_not_handed_out(monkeypatch, status):
    """HiGHS hands out a vector of zeros where it reaches a limit before it has found any."""

    def stop(program, known, allowed):
        return SolverReply(status, 0 * program.box[:, 0])

    monkeypatch.setattr(milp, "_solve", stop)
    problem = split()
    assert solve_mixed(problem, column_box(problem)).status == "unknown"


def test_what_was_found_when_the_clock_ended_the_search_is_not_used(monkeypatch):
    """It would be there on one machine, and not on another."""
    column = (RealColumn(Unknown("x", "s", 0), Fraction(0), Fraction(1)),)
    problem = Problem(column, (), either(0))
    now = [0.0]
    monkeypatch.setattr(budget.time, "monotonic", lambda: now[0])
    true_solve = milp._solve

    def solve_until(status, end):
        def run(program, known, allowed):
            answer = true_solve(program, known, allowed)
            assert answer.status == "optimal"
            now[0] = end
            return replace(answer, status=status)

        return run

    monkeypatch.setattr(milp, "_solve", solve_until("user_limit", 5.0))
    with pytest.raises(BudgetExceeded):
        solve_mixed(problem, column_box(problem), meter=Effort(1, 4.0).meter())
    assert solve_mixed(problem, column_box(problem), meter=Effort(1, 40.0).meter()).status == "found"
    monkeypatch.setattr(milp, "_solve", solve_until("optimal", 50.0))
    assert solve_mixed(problem, column_box(problem), meter=Effort(1, 4.0).meter()).status == "found"


# --- planted faults ----------------------------------------------------------------------------------


def limits_as_infeasible(monkeypatch):
    monkeypatch.setattr(milp, "INFEASIBLE", (*milp.INFEASIBLE, "user_limit", ""))


def failures_as_infeasible(monkeypatch):
    monkeypatch.setattr(milp, "INFEASIBLE", (*milp.INFEASIBLE, ""))
    monkeypatch.setattr(cvxpy.Problem, "solve", _fail)


def _fail(self, *arguments, **named):
    raise cvxpy.error.SolverError("a limit was reached")


def silence_as_unsat(monkeypatch):
    monkeypatch.setattr(smt, "parse_satisfiability", lambda text: "sat" if "sat" in text.split() else "unsat")


def unknown_as_sat(monkeypatch):
    monkeypatch.setattr(
        smt, "parse_satisfiability", lambda text: "unsat" if "unsat" in text.split() else "sat"
    )


def unknown_as_infeasible(monkeypatch):
    true_check = exact.Session.check_plainly

    def check(self, meter, seed=0):
        answer = true_check(self, meter, seed)
        return "unsat" if answer == "unknown" else answer

    monkeypatch.setattr(exact.Session, "check_plainly", check)


FAULTS = [
    limits_as_infeasible,
    failures_as_infeasible,
    silence_as_unsat,
    unknown_as_sat,
    unknown_as_infeasible,
]


@pytest.mark.parametrize("plant", FAULTS)
def test_a_limit_taken_for_an_answer_is_seen(monkeypatch, plant):
    plant(monkeypatch)
    assert says_more_than_unknown()
