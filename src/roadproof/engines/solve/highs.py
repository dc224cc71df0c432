"""Solves mixed-integer programs with HiGHS directly, without a modelling layer."""

import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np

from roadproof.engines.solve.sparse import Columns, by_columns
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class MixedIntegerProgram:
    """The feasibility problem ``low <= matrix · x <= high``, ``box[:, 0] <= x <= box[:, 1]``.

    ``rows``, ``columns`` and ``values`` are the entries of the matrix; ``binaries`` are columns of 0 or 1.
    """

    rows: Any
    columns: Any
    values: Any
    low: Any
    high: Any
    box: Any
    binaries: Sequence[int]

    @property
    def equal(self) -> Any:
        """The mask of rows that are equations."""
        return self.low == self.high

    @property
    def above(self) -> Any:
        """The mask of rows that are no equations and have a lower bound."""
        return ~self.equal & np.isfinite(self.low)

    @property
    def below(self) -> Any:
        """The mask of rows that are no equations and have an upper bound."""
        return ~self.equal & np.isfinite(self.high)


@dataclass(frozen=True)
class SolverReply:
    """A solver's reply: status in cvxpy's words ("" for any failure), column values, and its work."""

    status: str
    values: Any = None
    nodes: int = 0
    iterations: int = 0


# The statuses of HiGHS that say more than that it failed.
_STATUSES = {
    "kOptimal": "optimal",
    "kInfeasible": "infeasible",
    "kUnboundedOrInfeasible": "infeasible_or_unbounded",
    "kUnbounded": "unbounded",
    "kObjectiveBound": "user_limit",
    "kObjectiveTarget": "user_limit",
    "kTimeLimit": "user_limit",
    "kIterationLimit": "user_limit",
    "kSolutionLimit": "user_limit",
}


def solve(program: MixedIntegerProgram, options: Mapping[str, object]) -> SolverReply:
    """Run HiGHS with these options. Raises ``ValueError`` for an option that HiGHS does not take."""
    import highspy

    made: Any = highspy.Highs
    solver = made()
    for name, value in {"log_to_console": False, **options}.items():
        if solver.setOptionValue(name, value) == highspy.HighsStatus.kError:
            raise ValueError(f"option={name}: HiGHS does not take {value}")
    solver.passModel(_model(program, highspy))
    solver.run()
    info, status = solver.getInfo(), _STATUSES.get(solver.getModelStatus().name, "")
    solution = solver.getSolution() if status in ("optimal", "user_limit") else None
    values = np.array(solution.col_value) if solution is not None else None
    return SolverReply(status, values, info.mip_node_count, info.simplex_iteration_count)


def model_text(
    program: MixedIntegerProgram, columns: Sequence[str], rows: Sequence[str], ending: Literal["mps", "lp"]
) -> str:
    """Return the program as a file with names of ``columns`` and ``rows``: free MPS, or LP."""
    import highspy

    made: Any = highspy.Highs
    solver = made()
    solver.setOptionValue("output_flag", False)
    entries = program.rows, program.columns, program.values
    matrix = by_columns(*entries, (len(program.low), len(program.box)))
    model = _linear_program(program, matrix, program.low, program.high, highspy)
    model.col_names_, model.row_names_ = [*columns], [*rows]
    solver.passModel(model)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"model.{ending}"
        if solver.writeModel(str(path)) == highspy.HighsStatus.kError:
            raise RuntimeError(f"HiGHS does not write a model with the ending {ending}")
        return path.read_text("ascii")


def _model(program: MixedIntegerProgram, highspy: Any) -> Any:
    """Return the HiGHS model: equations first, then rows bounded below (negated), then rows bounded above."""
    equal, above, below = program.equal, program.above, program.below
    matrix = _matrix(program, [(equal, 1.0), (above, -1.0), (below, 1.0)])
    right = np.concatenate([program.low[equal], -program.low[above], program.high[below]])
    left = np.full(len(right), -np.inf)
    left[: int(equal.sum())] = program.low[equal]
    return _linear_program(program, matrix, left, right, highspy)


def _linear_program(
    program: MixedIntegerProgram, matrix: Columns, left: Any, right: Any, highspy: Any
) -> Any:
    lp = highspy.HighsLp()
    lp.num_row_, lp.num_col_ = matrix.shape
    lp.col_cost_ = np.zeros(lp.num_col_)
    lp.col_lower_, lp.col_upper_ = (np.ascontiguousarray(x) for x in program.box.T)
    lp.row_lower_, lp.row_upper_ = left, right
    lp.a_matrix_.format_ = highspy.MatrixFormat.kColwise
    lp.a_matrix_.start_, lp.a_matrix_.index_, lp.a_matrix_.value_ = matrix.indptr, matrix.indices, matrix.data
    if program.binaries:
        kinds = [highspy.HighsVarType.kContinuous] * lp.num_col_
        for column in program.binaries:
            kinds[column] = highspy.HighsVarType.kInteger
        lp.integrality_ = kinds
    return lp


def _matrix(program: MixedIntegerProgram, parts: Sequence[tuple[Any, float]]) -> Columns:
    """Return the rows that each part selects, times its factor, one part below the other."""
    rows, columns, values, total = [], [], [], 0
    for chosen, factor in parts:
        inside = chosen[program.rows]
        places = np.cumsum(chosen) - 1 + total
        rows.append(places[program.rows[inside]])
        columns.append(program.columns[inside])
        values.append(factor * program.values[inside])
        total += int(chosen.sum())
    entries = np.concatenate(rows), np.concatenate(columns), np.concatenate(values)
    return by_columns(*entries, (total, len(program.box)))
