"""Solvers outside of roadproof that solve files of problems, each where it is installed.

Each has a limit that it counts itself, so that a verdict does not depend on the machine. The clock is only a
backstop.
"""

import importlib.util
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias

Status: TypeAlias = Literal["solved", "infeasible", "open", "clock"]
"""The verdict of a solver: open where it reaches its limit, clock where the backstop ends it."""
SECONDS, SMT_SECONDS = 600, 120
"""The backstop for solvers of linear rows, and for those of SMT-LIB."""
CLOCK = "ended by the clock"
NODES = 10_000
"""How many nodes HiGHS, CBC and SCIP may branch on."""
Z3_UNITS, CVC5_UNITS = 10_000_000, 100_000
"""How many units of resource z3 and cvc5 may use; a unit of one is no unit of the other."""


@dataclass(frozen=True)
class Solver:
    """A solver of files. ``limit``: what it counts, as its own option; ``version`` asks for its version."""

    name: str
    title: str
    suffix: Literal["mps", "smt2"]
    limit: str
    solve: Callable[[Path, Path], Status]
    version: Callable[[], str]
    is_installed: Callable[[], bool]


def _output(command: list[str], folder: Path | None = None, seconds: int = SECONDS) -> str:
    """Return the standard output of a command, or ``CLOCK`` where the clock ends it."""
    try:
        return subprocess.run(command, capture_output=True, text=True, timeout=seconds, cwd=folder).stdout
    except subprocess.TimeoutExpired:
        return CLOCK


def _number_in(text: str) -> str:
    """Return the first version number of a text."""
    found = re.search(r"\d+\.\d+(\.\d+)?", text)
    return found.group() if found else "unknown"


# --- Mixed-integer programs ------------------------------------------------------------------------


def highs(model: Path, solution: Path) -> Status:
    """HiGHS as it reads the file; its own program where ``highs`` is on the path."""
    if program := shutil.which("highs"):
        options = solution.with_suffix(".options")
        options.write_text(f"mip_max_nodes = {NODES}\n")
        command = [program, "--options_file", str(options), "--solution_file", str(solution), str(model)]
        told = _output(command, model.parent)  # it writes a log where it runs
        return _of(told, "Status            Optimal", "Status            Infeasible")
    import highspy

    solver = highspy.Highs()
    solver.setOptionValue("output_flag", False)
    solver.setOptionValue("mip_max_nodes", NODES)
    assert solver.readModel(str(model)) == highspy.HighsStatus.kOk
    solver.run()
    solver.writeSolution(str(solution), 0)
    return _of(solver.getModelStatus().name, "kOptimal", "kInfeasible")


def _highs_version() -> str:
    if program := shutil.which("highs"):
        return _number_in(_output([program, "--version"]))
    import highspy

    return _number_in(highspy.Highs().version())


def cbc(model: Path, solution: Path) -> Status:
    told = _output(["cbc", str(model), "maxNodes", str(NODES), "solve", "solution", str(solution)])
    first = solution.read_text().partition("\n")[0] if solution.is_file() else ""
    return _of(told if told == CLOCK else first, "Optimal", "nfeasible")


SCIP = """
import sys
from pyscipopt import Model
model = Model()
model.hideOutput()
model.readProblem(sys.argv[1])
model.setParam("limits/totalnodes", int(sys.argv[3]))
model.optimize()
print(model.getStatus())
if model.getNSols():
    model.writeBestSol(sys.argv[2])
"""


def scip(model: Path, solution: Path) -> Status:
    told = _output([scip_python(), "-c", SCIP, str(model), str(solution), str(NODES)])
    last = told.split()[-1] if told.split() else ""
    return _of(told if told == CLOCK else last, "optimal", "infeasible")


def _scip_version() -> str:
    asked = "from pyscipopt import Model; m = Model(); print(m.version(), m.getMajorVersion(), "
    asked += "m.getMinorVersion(), m.getTechVersion(), sep='.')"
    return _output([scip_python(), "-c", asked]).strip().partition(".")[2].partition(".")[2]


def scip_python() -> str:
    """An interpreter that has pyscipopt: this one, or the one named in ROADPROOF_SCIP_PYTHON."""
    return os.environ.get("ROADPROOF_SCIP_PYTHON", sys.executable)


def _has_scip() -> bool:
    return importlib.util.find_spec("pyscipopt") is not None or scip_python() != sys.executable


def _of(word: str, solved: str, infeasible: str) -> Status:
    if word == CLOCK:
        return "clock"
    return "solved" if solved in word else "infeasible" if infeasible in word else "open"


# --- SMT-LIB ---------------------------------------------------------------------------------------


def z3(model: Path, solution: Path) -> Status:
    return _smt([_z3_program(), f"rlimit={Z3_UNITS}", "dump_models=true", str(model)], solution)


def _z3_program() -> str:
    return str(Path(sys.executable).with_name("z3"))


def cvc5(model: Path, solution: Path) -> Status:
    """The program of cvc5; ``justification`` decides the circuit from its root."""
    limit = f"--rlimit={CVC5_UNITS}"
    return _smt(["cvc5", limit, "--decision=justification", "--dump-models", str(model)], solution)


CVC5 = """
import sys
import cvc5
solver = cvc5.Solver(cvc5.TermManager())
for name, value in (("rlimit", sys.argv[2]), ("decision", "justification"), ("dump-models", "true")):
    solver.setOption(name, value)
parser = cvc5.InputParser(solver)
parser.setFileInput(cvc5.InputLanguage.SMT_LIB_2_6, sys.argv[1])
symbols = parser.getSymbolManager()
while not (command := parser.nextCommand()).isNull():
    print(command.invoke(solver, symbols), end="")
"""


def cvc5_package(model: Path, solution: Path) -> Status:
    """The Python package of cvc5, which roadproof uses."""
    return _smt([sys.executable, "-c", CVC5, str(model), str(CVC5_UNITS)], solution)


def _smt(command: list[str], solution: Path) -> Status:
    told = _output(command, seconds=SMT_SECONDS)
    solution.write_text(told)
    if told == CLOCK:
        return "clock"
    status = told.split(maxsplit=1)[0] if told else ""
    return "solved" if status == "sat" else "infeasible" if status == "unsat" else "open"


def _package_version() -> str:
    from importlib.metadata import version

    return version("cvc5")


# --- All of them -----------------------------------------------------------------------------------

_ALL = (
    Solver("highs", "HiGHS", "mps", f"mip_max_nodes = {NODES}", highs, _highs_version, lambda: True),
    Solver(
        "cbc",
        "CBC",
        "mps",
        f"maxNodes {NODES}",
        cbc,
        lambda: _number_in(_output(["cbc", "-quit"])),
        lambda: shutil.which("cbc") is not None,
    ),
    Solver("scip", "SCIP", "mps", f"limits/totalnodes = {NODES}", scip, _scip_version, _has_scip),
    Solver(
        "z3",
        "z3",
        "smt2",
        f"rlimit={Z3_UNITS}",
        z3,
        lambda: _number_in(_output([_z3_program(), "--version"])),
        lambda: True,
    ),
    Solver(
        "cvc5",
        "cvc5",
        "smt2",
        f"--rlimit={CVC5_UNITS}",
        cvc5,
        lambda: _number_in(_output(["cvc5", "--version"])),
        lambda: shutil.which("cvc5") is not None,
    ),
    Solver(
        "cvc5 package",
        "cvc5 (Python package)",
        "smt2",
        f"rlimit={CVC5_UNITS}",
        cvc5_package,
        _package_version,
        lambda: importlib.util.find_spec("cvc5") is not None,
    ),
)
SOLVERS: Mapping[str, Solver] = {x.name: x for x in _ALL}
MIXED = tuple(x.name for x in _ALL if x.suffix == "mps")
SMT = tuple(x.name for x in _ALL if x.suffix == "smt2")
