"""Mixed-integer solvers, HiGHS and through cvxpy others: one sparse matrix constraint, one-sided big-M.

A disjunction gets one binary column per part, and a chosen part must hold; nothing follows from a
part that is not chosen, so no condition is needed in the other direction. Each big-M is the bound of
its own condition on the box. ``cvxpy`` is imported here only.
"""

import gc
import math
import re
import sys
import warnings
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import Any, assert_never

import numpy as np

from roadproof.engines.encode.problem import (
    All,
    AnyOf,
    Circuit,
    Leaf,
    Problem,
    Solution,
    nodes,
    replace_leaves,
)
from roadproof.engines.solve import highs
from roadproof.engines.solve.bounds import Affine, Bound, Box, Side, approximate, loosened
from roadproof.engines.solve.highs import Answer, Program
from roadproof.engines.solve.sparse import Triplets
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
class Limits:
    """``units`` of work, ``seconds`` as a backstop, and ``gap``: how far from the best an answer may be."""

    units: float
    seconds: float
    gap: float

    @property
    def nodes(self) -> int:
        return max(1, math.ceil(min(self.units, 1e6) * NODES_A_UNIT))


@dataclass(frozen=True)
class SolverFacts:
    """What we know of a solver: cvxpy's name for it, the module it needs, its options.

    The name is None where the solver is asked without cvxpy.
    """

    cvxpy_name: str | None
    module: str
    options: Callable[[Limits], Mapping[str, object]]


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
    """Raises ``UsageError`` for an unknown name, ``MissingSolverError`` where it is not installed."""
    if name not in SOLVERS:
        raise UsageError(f"solver={name}: unknown solver; choose one of {', '.join(sorted(SOLVERS))}")
    needed = ["cvxpy"] if SOLVERS[name].cvxpy_name is not None else []
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
) -> Solution:
    """A solution of ``problem`` in ``box`` (a bound pair per column), within what ``meter`` has left.

    On the inner side a solution solves the exact problem up to floating point; on the outer side
    ``infeasible`` says that the exact problem has no solution: whatever is no equation is loosened by
    more than the solver's tolerances, and equations leave room to keep them. Raises
    ``TooNonlinearError`` for inequalities above degree 2, ``BudgetExceeded``, and as ``find_solver`` does.
    """
    known = find_solver(solver)
    meter = meter or Effort().meter()
    if meter.is_out():
        return Solution("unknown")
    box = loosened(box) if side == "outer" else box
    circuit = replace_leaves(problem.circuit, lambda inequality: approximate(inequality, box, side, pieces))
    tableau = _Tableau(list(box))
    for row in problem.rows:
        affine = Affine(tuple((c, float(k)) for c, k in row.terms.items()), 0.0)
        slack = affine.looseness(box) if side == "outer" and row.low != row.high else 0.0
        low = -np.inf if row.low is None else float(row.low) - slack
        high = np.inf if row.high is None else float(row.high) + slack
        tableau.add(affine.terms, low, high)
    tableau.require(circuit)
    return _run(tableau, len(problem.columns), known, meter)


class _Tableau:
    """Rows and binary columns, written as triplets."""

    def __init__(self, box: list[tuple[float, float]]) -> None:
        self.box = box
        self.binaries: list[int] = []
        self.entries = Triplets()
        self.high: list[float] = []

    def add(self, terms: Sequence[tuple[int, float]], low: float, high: float) -> None:
        self.entries.add(terms, low)
        self.high.append(high)

    def binary(self) -> int:
        self.box.append((0.0, 1.0))
        self.binaries.append(len(self.box) - 1)
        return self.binaries[-1]

    def require(self, circuit: Circuit[Bound]) -> None:
        """Rows for ``circuit``; ``chosen`` holds for each part of a disjunction its binary."""
        chosen: dict[int, int] = {}
        top: list[Circuit[Bound]] = list(circuit.parts) if isinstance(circuit, All) else [circuit]
        for node in nodes(circuit):
            if isinstance(node, AnyOf):
                for part in node.parts:
                    if id(part) not in chosen:
                        chosen[id(part)] = self.binary()
        waiting: list[tuple[Circuit[Bound], int | None]] = [(part, None) for part in top]
        waiting += [(n, chosen[id(n)]) for n in nodes(circuit) if id(n) in chosen]
        for node, guard in waiting:
            self._hold(node, guard, chosen)

    def _hold(self, node: Circuit[Bound], guard: int | None, chosen: Mapping[int, int]) -> None:
        """``node`` holds, if the guard is 1 where there is one."""
        match node:
            case Leaf(bound):
                self._bound(bound.affine, guard, bound.margin)
            case All(parts):
                for part in parts:
                    self._hold(part, guard, chosen)
            case AnyOf(parts):
                picks = [(chosen[id(p)], 1.0) for p in parts]
                if guard is None:
                    self.add(picks, 1.0, np.inf)
                else:
                    self.add([*picks, (guard, -1.0)], 0.0, np.inf)
            case _:
                assert_never(node)

    def _bound(self, affine: Affine, guard: int | None, margin: float) -> None:
        """affine >= margin, relaxed by its own least value where the guard is 0."""
        least = margin - affine.constant
        if guard is None:
            self.add(affine.terms, least, np.inf)
            return
        slack = max(0.0, margin - affine.range(self.box)[0])
        self.add([*affine.terms, (guard, -slack)], least - slack, np.inf)


def _run(tableau: _Tableau, wanted: int, known: SolverFacts, meter: Budget) -> Solution:
    low, high, box = np.array(tableau.entries.right), np.array(tableau.high), np.array(tableau.box)
    program = Program(*tableau.entries.arrays(), low, high, box, tableau.binaries)
    allowed = Limits(meter.left(), meter.seconds_left(), GAP)
    answer = _solve(program, known, allowed)
    meter.spend(_spent(answer, allowed))
    if answer.status in INFEASIBLE:
        return Solution("infeasible")
    if answer.status != "optimal":
        # What is there when the clock ends the search depends on the machine, so nobody may see it.
        meter.seconds_left()
    values = answer.values
    if values is None or not _fits(values, program):
        return Solution("unknown")
    return Solution("found", tuple(float(v) for v in values[:wanted]))


def _solve(program: Program, known: SolverFacts, allowed: Limits) -> Answer:
    """A solver's answer: only the statuses of ``INFEASIBLE`` say that there is no solution."""
    options = known.options(allowed)
    if known.cvxpy_name is None:
        return highs.solve(program, options)
    return _through_cvxpy(program, known.cvxpy_name, options)


def _through_cvxpy(program: Program, solver: str, options: Mapping[str, object]) -> Answer:
    from scipy.sparse import csr_array

    cvxpy = modelling()
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
    asked = cvxpy.Problem(cvxpy.Minimize(np.zeros(count) @ x), constraints)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an answer that may be inaccurate is judged anyway
            asked.solve(solver=solver, **options)
    except cvxpy.error.SolverError:
        return Answer("")
    except ValueError as error:
        if "Cannot unpack invalid solution" in str(error):  # a status of the solver that cvxpy does not know
            return Answer("")
        raise
    stats = asked.solver_stats.extra_stats if asked.solver_stats is not None else None
    nodes = int(stats.get("mip_node_count") or 0) if isinstance(stats, dict) else 0
    return Answer(str(asked.status), x.value, nodes)


def _spent(answer: Answer, allowed: Limits) -> float:
    """The units that a solver has worked; all that were allowed where it came to no end."""
    if answer.status != "optimal" and answer.status not in INFEASIBLE:
        return allowed.units
    return max(answer.iterations / ITERATIONS_A_UNIT, answer.nodes / NODES_A_UNIT)


def _fits(x: Any, program: Program) -> bool:
    """Whether ``x`` is a solution at all: solvers that reach a limit may hand out what they have."""
    low, high, limits = program.low, program.high, program.box
    rows = np.bincount(program.rows, weights=program.values * x[program.columns], minlength=len(low))
    within = np.concatenate([x - limits[:, 0], limits[:, 1] - x, rows - low, high - rows])
    size = np.concatenate([np.abs(limits).T.ravel(), np.abs(low), np.abs(high)])
    return bool(np.all(within >= -TOLERANCE * (1 + np.where(np.isfinite(size), size, 0))))


def prepare() -> None:
    """Import HiGHS and what shapes drives now, not at the first question, for processes to be forked."""
    usual, *_ = SOLVERS.values()
    for module in (usual.module, "clarabel"):
        if find_spec(module) is not None:
            import_module(module)


def modelling() -> Any:
    """cvxpy, without all of scipy.stats: that is most of its import, for one function that nobody here needs.

    cvxpy gets a function in its place that imports scipy.stats when it is called. Raises
    ``MissingSolverError`` where its version is before 1.9.2: it then loses bounds of a variable of which some
    entries are binary, and calls problems infeasible that are not.
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


def box_of(problem: Problem) -> list[tuple[float, float]]:
    """The bounds of a problem's columns as floats."""
    return [(float(c.low), float(c.high)) for c in problem.columns]
