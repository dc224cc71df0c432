"""Mixed-integer programs for HiGHS, without a modelling layer between."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from roadproof.engines.solve.sparse import Columns, by_columns
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Program:
    """``low <= matrix · x <= high`` with x in ``box``, a bound pair a column; ``binaries`` are 0 or 1.

    ``rows``, ``columns`` and ``values`` are the entries of the matrix. Any solution will do.
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
        """Which rows are equations."""
        return self.low == self.high

    @property
    def above(self) -> Any:
        """Which rows are no equations, and bounded from below."""
        return ~self.equal & np.isfinite(self.low)

    @property
    def below(self) -> Any:
        """Which rows are no equations, and bounded from above."""
        return ~self.equal & np.isfinite(self.high)


@dataclass(frozen=True)
class Answer:
    """A solver's status in cvxpy's words, "" for any failure; values of the columns, and its work."""

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


def solve(program: Program, options: Mapping[str, object]) -> Answer:
    """The answer of HiGHS with these options. Raises ``ValueError`` for an option that it does not know."""
    import highspy

    made: Any = highspy.Highs
    solver = made()
    for name, value in {"log_to_console": False, **options}.items():
        if solver.setOptionValue(name, value) == highspy.HighsStatus.kError:
            raise ValueError(f"option={name}: HiGHS does not take {value}")
    solver.passModel(_model(program, highspy))
    solver.run()
    info, status = solver.getInfo(), _STATUSES.get(solver.getModelStatus().name, "")
    found = solver.getSolution() if status in ("optimal", "user_limit") else None
    values = np.array(found.col_value) if found is not None else None
    return Answer(status, values, info.mip_node_count, info.simplex_iteration_count)


def _model(program: Program, highspy: Any) -> Any:
    """Equations first, then rows bounded from below as ones from above, then those bounded from above."""
    equal, above, below = program.equal, program.above, program.below
    matrix = _matrix(program, [(equal, 1.0), (above, -1.0), (below, 1.0)])
    right = np.concatenate([program.low[equal], -program.low[above], program.high[below]])
    left = np.full(len(right), -np.inf)
    left[: int(equal.sum())] = program.low[equal]
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


def _matrix(program: Program, parts: Sequence[tuple[Any, float]]) -> Columns:
    """The rows that each part chooses, times its factor, one part below the other."""
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
