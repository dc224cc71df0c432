"""Other solvers read the files: verdicts agree, solutions are judged, and changed rows are noticed."""

import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from extensions.encoding.outside import MIXED, SOLVERS
from extensions.encoding.solver_runs import (
    SETS,
    Problem,
    Run,
    contradicts,
    problems_of,
    read_runs,
    run,
    solve_and_judge,
    solved_here,
)
from extensions.encoding.test_files import LANE, can_break, kind_of, named_everywhere
from roadproof.engines.encode.problem import LimitKind
from roadproof.engines.solve.highs import model_text
from roadproof.errors import InputError
from roadproof.extensions.encoding.encode import Encoding
from roadproof.extensions.encoding.judging import columns_of
from roadproof.extensions.encoding.naming import Naming
from roadproof.extensions.encoding.smt_file import smt_file
from roadproof.extensions.encoding.solutions import read_solution
from roadproof.frontends.cli.main import main

NEVER = "F (v_lon(SV) > 30 m/s and F[0, 1] v_lon(SV) < 20 m/s)"
"""No car brakes so hard."""


def skip_without(name: str) -> None:
    if not SOLVERS[name].is_installed():
        pytest.skip(f"{name} is not installed")


@pytest.mark.parametrize("name", MIXED)
@pytest.mark.parametrize("formula", ["scenario_4(SV, POV, L)", NEVER])
def test_another_solver_says_the_same(tmp_path: Path, name: str, formula: str) -> None:
    skip_without(name)
    kinds = ("natural", "outer") if formula == NEVER else ("natural",)
    for drives in kinds:
        lanes = {} if formula == NEVER else LANE
        encoding = rp.encode(formula, lanes=lanes, drives=drives)
        assert solve_and_judge(tmp_path, encoding, SOLVERS[name])[0] == solved_here(encoding)
    assert solved_here(encoding) == ("infeasible" if formula == NEVER else "solved")


@pytest.mark.parametrize("name", ["z3", "cvc5", "cvc5 package"])
def test_an_smt_solver_says_the_same(name: str) -> None:
    skip_without(name)
    assert run(Problem("base", 9, "merge-1", "infeasible"), SOLVERS[name], "").verdict == "infeasible"
    if name == "z3":  # its drive may fail between samples
        assert run(Problem("base", 5, "main-1", "solved"), SOLVERS[name], "").verdict == "solved"


def is_confirmed(found: Run) -> bool:
    """Whether a run has the verdict of the search, and its solution, if it has one, is a drive.

    SMT solvers are asked on the coarsest grid alone.
    """
    if found.verdict != "solved":
        return not contradicts(found.verdict, found.expected)
    is_drive = found.reading == "witness" or bool(found.finer)
    return found.expected == "solved" and (is_drive or SOLVERS[found.solver].suffix == "smt2")


@pytest.mark.parametrize("number", range(1, 25))
@pytest.mark.parametrize("home", SETS)
def test_all_scenarios_are_solved_elsewhere(home: str, number: int) -> None:
    named_everywhere(rp.encode(number, using=rp.load(home)))
    asked = [*problems_of(home, number)]
    assert "solved" in {x.expected for x in asked}
    for name in MIXED:
        for problem in asked if SOLVERS[name].is_installed() else ():
            assert is_confirmed(found := run(problem, SOLVERS[name], "")), found


def test_a_verdict_that_contradicts_is_a_failure() -> None:
    with pytest.raises(ValueError, match="highs says infeasible of Problem"):
        run(Problem("base", 9, "merge-1", "solved"), SOLVERS["highs"], "")
    assert not contradicts("open", "solved")


def test_the_runs_that_are_kept_contradict_nothing() -> None:
    kept = read_runs()
    assert [x for x in kept if not is_confirmed(x)] == []
    every = {(home, str(number)) for home in SETS for number in range(1, 25)}
    for name in SOLVERS:
        asked = {x.key[:2] for x in kept if x.solver == name and x.expected == "solved"}
        assert asked == every if name in MIXED else asked < every, name
        assert "infeasible" in {x.verdict for x in kept if x.solver == name}, name


def test_an_smt_solver_finds_a_drive_and_names_what_conflicts(tmp_path: Path) -> None:
    encoding = rp.encode("F v_lon(SV) > 30 m/s", horizon=2)
    assert solve_and_judge(tmp_path, encoding, SOLVERS["z3"]) == ("solved", "witness")
    never = rp.encode(NEVER, drives="all", horizon=3)
    script = tmp_path / "core.smt2"
    script.write_text(never.text("smt2") + "(get-unsat-core)\n")
    told = subprocess.run(
        [Path(sys.executable).with_name("z3"), script], capture_output=True, text=True
    ).stdout
    status, core = told.split(maxsplit=1)
    assert status == "unsat"
    named = {x.partition("@")[0] for x in core.strip(" ()\n").split()}
    assert {"acceleration.SV", "formula"} <= named
    assert named <= {"acceleration.SV", "formula", "motion.SV", "lateral_share.SV", "bounds.SV.v_lon"}


def test_a_model_of_a_formula_of_degree_three_is_read_back(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    cubic = "F v_lon(SV)^3 > 30 m/s * v_lon(SV)^2"
    encoding = rp.encode(cubic, horizon=1)
    assert solve_and_judge(tmp_path, encoding, SOLVERS["z3"]) == ("solved", "witness")
    line = ["witness", cubic, "--horizon", "1", "--no-pictures", "--jobs", "1"]
    assert main([*line, "--solution", str(tmp_path / "solution")]) == 0
    assert "WITNESSED" in capsys.readouterr().out


# --- Files with a changed row -----------------------------------------------------------------------

TOGETHER = "F (atLane(SV, L) and v_lat(POV) > 0.2 m/s)"
THIRD = "given C: vehicle: F (v_lon(SV) > v_lon(POV) and v_lon(POV) > v_lon(C))"
WRITTEN = {*LimitKind} - {LimitKind.STEADY, LimitKind.START, LimitKind.OTHER_DRIVE}
"""The kinds of rows that files have; the others are those of searches that go on from a drive."""
KINDS = (*sorted(x.replace(" ", "_") for x in WRITTEN), "comparison")


def encoding_with(kind: str) -> Encoding:
    """A small problem that has rows of a kind."""
    match kind:
        case "reach":
            return rp.encode(THIRD, horizon="1.2")
        case "road":
            return rp.encode("F inMergeZone(SV)", drives="all", horizon="1.2")
        case "acceleration" | "lateral_share":
            return rp.encode(TOGETHER, drives="all", horizon="1.8", lanes=LANE)
        case _:
            return rp.encode(TOGETHER, horizon="1.8", lanes=LANE)


def with_a_row_changed(naming: Naming, kind: str, count: int) -> Iterator[tuple[str, str]]:
    """Yield the names of some rows of a kind, each with the file in which it asks for the opposite."""
    program = naming.posed.program.program
    names = [name for name, _ in naming.rows]
    rows = [k for k, (_, part) in enumerate(naming.rows) if kind_of(part) == kind]
    of_kind = [k for k in rows if can_break(program, k)]
    for k in np.random.default_rng(2).permutation(of_kind)[:count]:
        low, high = program.low.copy(), program.high.copy()
        if low[k] == high[k]:
            low[k], high[k] = low[k] + 0.2, high[k] + 0.2
        elif np.isfinite(low[k]):
            low[k], high[k] = -np.inf, low[k] - 0.2
        else:
            low[k], high[k] = high[k] + 0.2, np.inf
        yield names[k], model_text(replace(program, low=low, high=high), naming.columns, names, "mps")


def refusal(naming: Naming, solution: Path) -> str:
    """The row of which a message speaks that refuses a solution, or nothing."""
    try:
        columns_of(naming, read_solution(solution))
    except InputError as error:
        return str(error).partition("row ")[2].partition(":")[0]
    return ""


@pytest.mark.parametrize("name", MIXED)
@pytest.mark.parametrize("kind", KINDS)
def test_a_changed_row_of_an_mps_file_is_noticed(tmp_path: Path, name: str, kind: str) -> None:
    """Its solution is refused with the name of the row, or there is none."""
    skip_without(name)
    encoding = encoding_with(kind)
    naming, noticed = Naming(encoding.posed), []
    assert solve_and_judge(tmp_path, encoding, SOLVERS[name])[0] == "solved"
    for k, (row, text) in enumerate(with_a_row_changed(naming, kind, 3)):
        model, solution = tmp_path / f"{k}.mps", tmp_path / f"{k}.sol"
        model.write_text(text)
        status = SOLVERS[name].solve(model, solution)
        noticed.append("" if status == "infeasible" else refusal(naming, solution))
        assert status == "infeasible" or noticed[-1] == row
    assert any(noticed), kind


NAMED = re.compile(r"^\(assert \(! (.+) :named ([^ ()]+)\)\)$", re.M)


@pytest.mark.parametrize("kind", KINDS)
def test_a_changed_assertion_of_an_smt_file_is_noticed(tmp_path: Path, kind: str) -> None:
    """A model of the file with one assertion negated is refused, or there is none."""
    encoding = encoding_with(kind)
    naming = Naming(encoding.posed)
    file = smt_file(naming)
    rows = [name for name, part in file.assertions if kind_of(part) == kind]
    statuses = set()
    for k, row in enumerate(np.random.default_rng(2).permutation(rows)[:6]):
        model, solution = tmp_path / f"{k}.smt2", tmp_path / f"{k}.sol"
        changed = NAMED.sub(lambda x, row=row: opposite(x, row), file.text)
        assert changed != file.text
        model.write_text(changed)
        statuses.add(status := SOLVERS["z3"].solve(model, solution))
        assert status == "infeasible" or (status == "solved" and refusal(naming, solution)), row
    assert "solved" in statuses, kind


def opposite(assertion: re.Match[str], row: str) -> str:
    """Return an assertion, negated where it has the name of the row."""
    condition, name = assertion.groups()
    return f"(assert (! (not {condition}) :named {name}))" if name == row else assertion.group()
