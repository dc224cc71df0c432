"""The problem of a search in Python: a problem of cvxpy with named variables, and drives from its values."""

from collections.abc import Iterable, Mapping
from dataclasses import field
from fractions import Fraction
from functools import cached_property
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray

from roadproof.engines.encode.motion import ColumnLayout
from roadproof.engines.solve.milp import import_cvxpy
from roadproof.errors import UsageError
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.encoding.files import pose_formula, problem_text
from roadproof.extensions.encoding.judging import columns_of, judged
from roadproof.extensions.encoding.keywords import EncodeKeywords
from roadproof.extensions.encoding.kinds import Target
from roadproof.extensions.encoding.naming import Naming
from roadproof.extensions.encoding.posed import PosedSearch
from roadproof.extensions.encoding.settings import Encode
from roadproof.extensions.encoding.solutions import Solution, SolutionFormat
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.settings.option import takes
from roadproof.runtime.records import dataclass
from roadproof.world.signals import STARTING, SignalName

SOURCE = "the values"


@dataclass(frozen=True, repr=False)
class Encoding:
    """The mixed-integer problem of a search for drives on a grid, under one assignment of lanes.

    ``constraints`` has the constraints of cvxpy by the part of the question that they encode, such as
    ``motion.POV`` or ``dangerAhead``; the names are those in the table that ``compile`` writes.
    """

    posed: PosedSearch
    others: tuple[PosedSearch, ...] = field(default=())

    @property
    def lanes(self) -> Mapping[str, str]:
        """The lanes of the road that free lanes of the formula stand for."""
        return self.posed.lanes

    @property
    def times(self) -> NDArray[np.float64]:
        """The times of the samples in s, of shape (steps + 1,)."""
        grid = self.posed.question.grid
        return np.array([float(k * grid.dt) for k in range(grid.steps + 1)])

    def variable(self, vehicle: str, signal: SignalName) -> Any:
        """Return a signal of a vehicle as an expression of cvxpy, in SI units.

        ``s``, ``d``, ``v_lon`` and ``v_lat`` are variables of shape (steps + 1,). ``a_lon`` and ``a_lat``
        have the shape (steps,): the acceleration from a sample to the next. Raises ``UsageError``.
        """
        if vehicle not in self.posed.layout.vehicles:
            raise UsageError(f"vehicle={vehicle}: the problem has {', '.join(self.posed.layout.vehicles)}")
        match signal:
            case "s" | "d" | "v_lon" | "v_lat":
                return self._model.variables[f"{vehicle}.{signal}"]
            case "a_lon" | "a_lat":
                speed = self._model.variables[f"{vehicle}.v{signal[1:]}"]
                return (speed[1:] - speed[:-1]) / float(self.posed.question.grid.dt)
            case _:  # open: a user's word
                raise UsageError(f"signal={signal}: write s, d, v_lon, v_lat, a_lon or a_lat")

    @property
    def constraints(self) -> Mapping[str, Iterable[Any]]:
        """The constraints of cvxpy by the part of the question that they encode."""
        return self._model.constraints

    def problem(self) -> Any:
        """Return a ``cvxpy.Problem`` without objective; its constraints can be those of another problem.

        Each solution is a drive up to rounding and to what happens between samples, which ``drive`` judges.
        With ``drives="outer"`` the problem has a solution for each drive, and solutions that are no drive.
        Raises ``MissingSolverError`` where cvxpy is too old.
        """
        cvxpy = import_cvxpy()
        every = [x for some in self.constraints.values() for x in some]
        return cvxpy.Problem(cvxpy.Minimize(0), every)

    def drive(self, values: Mapping[str, float | Fraction] | None = None) -> JudgedDrive:
        """Return the drive of a solution, judged in dense time.

        ``values`` by the name of their column (``POV.s@3``), in SI units; None takes those of the variables.
        Raises ``InputError`` with the row that they break or with what the judge says, ``UsageError`` where
        the variables have no values.
        """
        entries = self._model.values() if values is None else values
        known = {name: Fraction(x) for name, x in entries.items()}
        naming = self._naming
        return judged(self.posed, columns_of(naming, Solution(SOURCE, SolutionFormat.GUROBI, known)), SOURCE)

    def text(self, to: Target = "mps") -> str:
        """Return the problem as MPS, LP or SMT-LIB (smt2), as ``compile`` writes it."""
        return problem_text(self._naming, to)[0]

    @cached_property
    def _naming(self) -> Naming:
        return Naming(self.posed)

    @cached_property
    def _model(self) -> "_Model":
        return _Model(self._naming)

    def __repr__(self) -> str:
        lanes = ", ".join(f"{name}={lane}" for name, lane in self.lanes.items())
        sizes = (
            f"{len(self.posed.problem.columns)} unknowns, {len(self.posed.program.program.binaries)} choices"
        )
        others = f"; {len(self.others)} other assignments of lanes" if self.others else ""
        return f"<Encoding of {self.posed.query.text}: {lanes}{', ' * bool(lanes)}{sizes}{others}>"


class _Model:
    """The variables and constraints of cvxpy for a program."""

    def __init__(self, naming: Naming) -> None:
        self.naming = naming
        self.cvxpy = import_cvxpy()
        posed = naming.posed
        self.program = posed.program.program
        self.variables = {name: self._variable(name, columns) for name, columns in _series(posed.layout)}
        count = len(posed.problem.columns)
        choices = len(self.program.box) - count
        self.choice = self.cvxpy.Variable(choices, boolean=True, name="choice") if choices else None
        parts = [*self.variables.values(), *([] if self.choice is None else [self.choice])]
        self.columns = self.cvxpy.hstack(parts)
        self.constraints = self._constraints()

    def _variable(self, name: str, columns: range) -> Any:
        low, high = self.program.box[columns.start : columns.stop].T
        return self.cvxpy.Variable(len(columns), name=name, bounds=[low, high])

    def _constraints(self) -> dict[str, list[Any]]:
        from scipy.sparse import csr_array

        program = self.program
        entries = (program.values, (program.rows, program.columns))
        matrix = csr_array(entries, shape=(len(program.low), len(program.box)))
        rows_of: dict[str, list[int]] = {}
        for k, (_, part) in enumerate(self.naming.rows):
            rows_of.setdefault(part.name, []).append(k)
        made: dict[str, list[Any]] = {}
        for name, rows in rows_of.items():
            mask = np.zeros(len(program.low), bool)
            mask[rows] = True
            equal, above, below = (mask & x for x in (program.equal, program.above, program.below))
            made[name] = [matrix[equal] @ self.columns == program.low[equal]] if equal.any() else []
            if above.any():
                made[name].append(matrix[above] @ self.columns >= program.low[above])
            if below.any():
                made[name].append(matrix[below] @ self.columns <= program.high[below])
        return made

    def values(self) -> dict[str, float]:
        """Return the values of the variables by column, without choices. Raises ``UsageError``."""
        if any(x.value is None for x in self.variables.values()):
            raise UsageError("drive: the variables have no values; solve a problem first")
        return {
            f"{name}@{step}": float(value)
            for name, x in self.variables.items()
            for step, value in enumerate(np.atleast_1d(x.value))
        }


def _series(layout: ColumnLayout) -> Iterable[tuple[str, range]]:
    """Yield the name and the columns of each signal in time, in the order of the columns."""
    samples = layout.grid.steps + 1
    names = [f"{vehicle}.{signal}" for vehicle in layout.vehicles for signal in STARTING]
    names += [f"{x.signal.vehicle}.{x.signal.name}" for x in layout.custom_signals]
    for k, name in enumerate(names):
        yield name, range(k * samples, (k + 1) * samples)


@takes(Encode)
def encode(what: What, using: Definitions | None = None, **options: Unpack[EncodeKeywords]) -> Encoding:
    """Return the problem that a search for drives of a scenario or formula solves.

    Of several assignments of lanes it is the first that a search tries; ``lanes`` chooses another one.
    ``road``, ``vehicles``, ``horizon`` (s), ``dt`` (s), ``reach`` (m): as for ``witness``. ``drives``:
    natural as a search tries first, all within the limits, or outer, a relaxation that has no solution only
    where there is no drive. Raises ``UsageError`` for formulas that no row bounds, ``TextError``,
    ``InputError``.

    >>> encode(4).problem().size_metrics.num_scalar_variables
    328
    """
    settings, home = Encode.of(options), definitions_of(using)
    first, *others = pose_formula(home, what, settings, settings.drives)
    return Encoding(first, tuple(others))
