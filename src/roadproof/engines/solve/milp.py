"""Solves problems with mixed-integer solvers: HiGHS directly, others through cvxpy.

Only this module imports ``cvxpy``.
"""

import gc
import math
import re
import sys
import warnings
from collections.abc import Callable, Mapping
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import Any

import numpy as np

from roadproof.engines.encode.problem import ColumnValues, Problem
from roadproof.engines.solve import highs
from roadproof.engines.solve.big_m import encode_mixed
from roadproof.engines.solve.bounds import Box, Side
from roadproof.engines.solve.highs import MixedIntegerProgram, SolverReply
from roadproof.errors import MissingSolverError, UsageError
from roadproof.runtime.budget import Budget, Effort
from roadproof.runtime.records import dataclass

# A unit of work, about a second: HiGHS does 3,000 to 8,000 iterations a second, and 100 to 500 nodes once
# it branches. Iterations are the better measure, but only nodes can be limited.
ITERATIONS_A_UNIT = 5_000
NODES_A_UNIT = 300
# The only words of cvxpy that say no. It has others, such as infeasible_inaccurate, for solvers that reach
# a limit without a solution.
INFEASIBLE = ("infeasible", "infeasible_or_unbounded")
_STATISTICS = "scipy.stats"
GAP = 0.5  # how far from the best a solution may be
TOLERANCE = 1e-4  # of a row or a bound, relative to its size


@dataclass(frozen=True)
class WorkLimits:
    """The limits of a run: ``units`` of work, ``seconds`` as a backstop, ``gap`` to the best objective."""

    units: float
    seconds: float
    gap: float

    @property
    def nodes(self) -> int:
        return max(1, math.ceil(min(self.units, 1e6) * NODES_A_UNIT))


@dataclass(frozen=True)
class SolverFacts:
    """The entry of a solver: its cvxpy name (None: called directly), the module it needs, its options."""

    cvxpy_name: str | None
    module: str
    options: Callable[[WorkLimits], Mapping[str, object]]


SOLVERS: Mapping[str, SolverFacts] = {
    "highs": SolverFacts(
        None,
        "highspy",
        lambda limits: {
            "mip_max_nodes": limits.nodes,
            "time_limit": limits.seconds,
            "mip_rel_gap": limits.gap,
            "mip_heuristic_effort": 0.3,  # we ask for any solution, so heuristics are most of the work
            # Both solve the root again, which takes longer than the tree below it: for 72 scenarios a third.
            "mip_heuristic_run_rens": False,
            "mip_allow_restart": False,
            # mip_lifting_for_probing stays off: with it HiGHS 1.15.1 calls feasible problems infeasible.
            "random_seed": 1,
            "threads": 1,
            "parallel": "off",
        },
    ),
    "scipy": SolverFacts(
        "SCIPY",
        "scipy",
        lambda limits: {
            "scipy_options": {
                "node_limit": limits.nodes,
                "time_limit": limits.seconds,
                "mip_rel_gap": limits.gap,
            }
        },
    ),
    "scip": SolverFacts(
        "SCIP",
        "pyscipopt",
        lambda limits: {
            "scip_params": {
                "limits/nodes": limits.nodes,
                "limits/time": limits.seconds,
                "limits/gap": limits.gap,
            }
        },
    ),
    "gurobi": SolverFacts(
        "GUROBI",
        "gurobipy",
        lambda limits: {
            "WorkLimit": limits.units,
            "TimeLimit": limits.seconds,
            "MIPGap": limits.gap,
            "Threads": 1,
        },
    ),
    "cbc": SolverFacts(
        "CBC",
        "cylp",
        lambda limits: {
            "maximumNodes": limits.nodes,
            "maximumSeconds": limits.seconds,
            "allowableGap": limits.gap,
        },
    ),
    # It counts nothing that could be limited, so only the clock ends it.
    "glpk": SolverFacts(
        "GLPK_MI",
        "cvxopt",
        lambda limits: {"tm_lim": math.ceil(limits.seconds * 1000), "mip_gap": limits.gap},
    ),
}

OLDEST_CVXPY = (1, 9, 2)


def find_solver(name: str) -> SolverFacts:
    """Return the entry of a solver.

    Raises ``UsageError`` for an unknown name, ``MissingSolverError`` where it is not installed.
    """
    if name not in SOLVERS:
        raise UsageError(f"solver={name}: unknown solver; choose one of {', '.join(sorted(SOLVERS))}")
    needed = ("cvxpy",) if SOLVERS[name].cvxpy_name is not None else ()
    for module in (*needed, SOLVERS[name].module):
        if find_spec(module) is None:
            raise MissingSolverError(
                f"solver={name} needs the module {module}, which is missing here: pip install {module}, or "
                "choose the engine smt, for which z3 is enough"
            )
    return SOLVERS[name]


def solve_mixed(
    problem: Problem,
    box: Box,
    side: Side = "inner",
    pieces: int = 1,
    solver: str = "highs",
    meter: Budget | None = None,
) -> ColumnValues:
    """Solve ``problem`` in ``box`` (a bound pair per column) within what ``meter`` has left.

    On the inner side a solution solves the exact problem up to floating point. On the outer side
    ``infeasible`` shows that the exact problem has no solution: all but equations is loosened by more than
    the solver's tolerances. Raises ``TooNonlinearError`` above degree 2, ``BudgetExceeded``, and the errors
    of ``find_solver``.
    """
    known = find_solver(solver)
    meter = meter or Effort().meter()
    if meter.is_exhausted():
        return ColumnValues("unknown")
    program = encode_mixed(problem, box, side, pieces).program
    return _solve_program(program, len(problem.columns), known, meter)


def _solve_program(
    program: MixedIntegerProgram, count: int, known: SolverFacts, meter: Budget
) -> ColumnValues:
    allowed = WorkLimits(meter.left(), meter.seconds_left(), GAP)
    answer = _solve(program, known, allowed)
    meter.spend(_spent(answer, allowed))
    if answer.status in INFEASIBLE:
        return ColumnValues("infeasible")
    if answer.status != "optimal":
        # What is there when the clock ends the search depends on the machine, so nobody may see it.
        meter.seconds_left()
    values = answer.values
    if values is None or not _fits(values, program):
        return ColumnValues("unknown")
    return ColumnValues("found", tuple(float(v) for v in values[:count]))


def _solve(program: MixedIntegerProgram, known: SolverFacts, allowed: WorkLimits) -> SolverReply:
    """Return a solver's reply; only the statuses of ``INFEASIBLE`` show that there is no solution."""
    options = known.options(allowed)
    if known.cvxpy_name is None:
        return highs.solve(program, options)
    return _through_cvxpy(program, known.cvxpy_name, options)


def _through_cvxpy(program: MixedIntegerProgram, solver: str, options: Mapping[str, object]) -> SolverReply:
    from scipy.sparse import csr_array

    cvxpy = import_cvxpy()
    box, count = program.box, len(program.box)
    shape = len(program.low), count
    matrix = csr_array((program.values, (program.rows, program.columns)), shape=shape)
    boolean = [np.array(program.binaries)] if program.binaries else False
    x = cvxpy.Variable(count, bounds=[box[:, 0], box[:, 1]], boolean=boolean)
    equal, above, below = program.equal, program.above, program.below
    constraints = [matrix[equal] @ x == program.low[equal]] if equal.any() else []
    if above.any():
        constraints.append(matrix[above] @ x >= program.low[above])
    if below.any():
        constraints.append(matrix[below] @ x <= program.high[below])
    model = cvxpy.Problem(cvxpy.Minimize(np.zeros(count) @ x), constraints)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an answer that may be inaccurate is judged anyway
            model.solve(solver=solver, **options)
    except cvxpy.error.SolverError:
        return SolverReply("")
    except ValueError as error:
        if "Cannot unpack invalid solution" in str(error):  # a status of the solver that cvxpy does not know
            return SolverReply("")
        raise
    stats = model.solver_stats.extra_stats if model.solver_stats is not None else None
    nodes = int(stats.get("mip_node_count") or 0) if isinstance(stats, dict) else 0
    return SolverReply(str(model.status), x.value, nodes)


def _spent(answer: SolverReply, allowed: WorkLimits) -> float:
    """Return the units that a solver has worked; all that were allowed where it did not finish."""
    if answer.status != "optimal" and answer.status not in INFEASIBLE:
        return allowed.units
    return max(answer.iterations / ITERATIONS_A_UNIT, answer.nodes / NODES_A_UNIT)


def _fits(x: Any, program: MixedIntegerProgram) -> bool:
    """Return whether ``x`` is a solution: at a limit, solvers may return points that are none."""
    low, high, limits = program.low, program.high, program.box
    rows = np.bincount(program.rows, weights=program.values * x[program.columns], minlength=len(low))
    within = np.concatenate([x - limits[:, 0], limits[:, 1] - x, rows - low, high - rows])
    size = np.concatenate([np.abs(limits).T.ravel(), np.abs(low), np.abs(high)])
    return bool(np.all(within >= -TOLERANCE * (1 + np.where(np.isfinite(size), size, 0))))


def preload_solvers() -> None:
    """Import HiGHS and Clarabel now, before processes are forked."""
    usual, *_ = SOLVERS.values()
    for module in (usual.module, "clarabel"):
        if find_spec(module) is not None:
            import_module(module)


def import_cvxpy() -> Any:
    """Import cvxpy without scipy.stats, which is most of its import time for one function that we never need.

    cvxpy gets a stand-in that imports scipy.stats when it is called. Raises ``MissingSolverError`` before
    version 1.9.2, which loses bounds of partly binary variables and calls feasible problems infeasible.
    """
    if "cvxpy" not in sys.modules and _STATISTICS not in sys.modules:
        known = {*sys.modules}
        stand_in: Any = ModuleType(_STATISTICS)
        stand_in.entropy = lambda *args, **more: import_module(_STATISTICS).entropy(*args, **more)
        sys.modules[_STATISTICS] = stand_in
        try:
            import_module("cvxpy")
        except ImportError:  # another version of cvxpy, which needs more of it
            for name in sys.modules.keys() - known:
                del sys.modules[name]
        finally:
            sys.modules.pop(_STATISTICS, None)
        gc.freeze()  # thousands of objects that stay, which each collection would walk through for 0.1 s
    import cvxpy

    version = str(vars(cvxpy).get("__version__"))
    if tuple(map(int, re.findall(r"\d+", version)[:3])) < OLDEST_CVXPY:
        oldest = ".".join(map(str, OLDEST_CVXPY))
        raise MissingSolverError(
            f"cvxpy={version} calls problems infeasible that are not: pip install 'cvxpy>={oldest}'"
        )
    return cvxpy


def column_box(problem: Problem) -> list[tuple[float, float]]:
    """Return the bounds of a problem's columns as floats."""
    return [(float(c.low), float(c.high)) for c in problem.columns]
