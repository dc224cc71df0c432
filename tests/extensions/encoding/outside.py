"""Solvers outside of roadproof that solve files of problems, each where it is installed."""

import importlib.util
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Literal, TypeAlias

Status: TypeAlias = Literal["solved", "infeasible", "open"]
SECONDS = 60


def highs(model: Path, solution: Path) -> Status:
    """HiGHS as it reads the file; its own program where ``highs`` is on the path."""
    if program := shutil.which("highs"):
        command = [program, "--solution_file", str(solution), "--time_limit", str(SECONDS), str(model)]
        told = subprocess.run(command, capture_output=True, text=True, timeout=2 * SECONDS).stdout
        return _of(told, "Status            Optimal", "Status            Infeasible")
    import highspy

    solver = highspy.Highs()
    solver.setOptionValue("output_flag", False)
    solver.setOptionValue("time_limit", float(SECONDS))
    assert solver.readModel(str(model)) == highspy.HighsStatus.kOk
    solver.run()
    solver.writeSolution(str(solution), 0)
    return _of(solver.getModelStatus().name, "kOptimal", "kInfeasible")


def cbc(model: Path, solution: Path) -> Status:
    command = ["cbc", str(model), "sec", str(SECONDS), "solve", "solution", str(solution)]
    subprocess.run(command, capture_output=True, timeout=2 * SECONDS)
    first = solution.read_text().partition("\n")[0] if solution.is_file() else ""
    return _of(first, "Optimal", "nfeasible")


SCIP = """
import sys
from pyscipopt import Model
model = Model()
model.hideOutput()
model.readProblem(sys.argv[1])
model.setParam("limits/time", float(sys.argv[3]))
model.optimize()
print(model.getStatus())
if model.getNSols():
    model.writeBestSol(sys.argv[2])
"""


def scip(model: Path, solution: Path) -> Status:
    command = [scip_python(), "-c", SCIP, str(model), str(solution), str(SECONDS)]
    told = subprocess.run(command, capture_output=True, text=True, timeout=2 * SECONDS).stdout
    return _of(told.split()[-1] if told.split() else "", "optimal", "infeasible")


def scip_python() -> str:
    """An interpreter that has pyscipopt: this one, or the one named in ROADPROOF_SCIP_PYTHON."""
    import os

    return os.environ.get("ROADPROOF_SCIP_PYTHON", sys.executable)


def z3(model: Path, solution: Path) -> Status:
    program = Path(sys.executable).with_name("z3")
    return _smt([str(program), f"-T:{SECONDS}", "dump_models=true", str(model)], solution)


def cvc5(model: Path, solution: Path) -> Status:
    return _smt(["cvc5", f"--tlimit={SECONDS}000", "--dump-models", str(model)], solution)


def _smt(command: list[str], solution: Path) -> Status:
    told = subprocess.run(command, capture_output=True, text=True, timeout=2 * SECONDS).stdout
    solution.write_text(told)
    status = told.split(maxsplit=1)[0] if told else ""
    return "solved" if status == "sat" else "infeasible" if status == "unsat" else "open"


def _of(word: str, solved: str, infeasible: str) -> Status:
    return "solved" if solved in word else "infeasible" if infeasible in word else "open"


Solver: TypeAlias = Callable[[Path, Path], Status]
MIXED: Mapping[str, Solver] = {"highs": highs, "cbc": cbc, "scip": scip}
SMT: Mapping[str, Solver] = {"z3": z3, "cvc5": cvc5}


def is_installed(name: str) -> bool:
    """Whether a solver can be called here."""
    if name == "scip":
        known = importlib.util.find_spec("pyscipopt") is not None
        return known or scip_python() != sys.executable
    return name in ("highs", "z3") or shutil.which(name) is not None
