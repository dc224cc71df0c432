"""The search for simulations that show a target, and in which the controller fails though a driver would not.

CMA-ES with restarts on robustness; the same seed gives the same search on every machine. Work is counted in
simulations.
"""

from collections.abc import Iterator, Sequence
from dataclasses import field
from typing import Any, Final

import numpy as np

from roadproof.errors import MissingSolverError
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.closed_loop.data import Method, Wanted
from roadproof.extensions.closed_loop.errors import ControllerError
from roadproof.extensions.closed_loop.search.boundary import boundary_line, is_prevented
from roadproof.extensions.closed_loop.search.problem import TargetProblem, Trial, prevents, severity
from roadproof.extensions.closed_loop.search.reducing import Reduced, reduced
from roadproof.extensions.closed_loop.simulation import ControlLoop, exact_drive
from roadproof.extensions.drivers.outcome import Result
from roadproof.extensions.traffic.evaluate.decisions import Decision
from roadproof.runtime.progress import report_stage
from roadproof.runtime.records import dataclass

POPULATION: Final = 32
_STALE = 6  # generations without an improvement, after which the search starts again
_NEAR, _WIDE = 0.12, 0.3  # standard deviations in units of the range of a knob
_CONFIRMED = 24  # failures that are judged, at most
_HIDDEN, _SAFE = 300.0, 100.0  # costs of a simulation without the target, and without a failure
_BISECTIONS, _BOUNDARY = 7, 8  # steps to the boundary of a driver model; points beside it


@dataclass
class FailureSearchOutcome:
    """The outcome of a search.

    ``count``: simulations; ``first_failure``, ``first_preventable``: the number of simulations up to the
    first one, 0 for none. ``nearest``: the greatest margin of the target. ``fault``: the error by which the
    controller ended the search. ``reductions``: further simulations that made the failure simple.
    ``points``: for each simulation the values of two knobs and its outcome; ``boundary``: where a driver
    model begins to prevent a collision, over these knobs.
    """

    count: int = 0
    first_failure: int = 0
    first_preventable: int = 0
    nearest: float = float("-inf")
    best: float = float("inf")
    failing: JudgedDrive | None = None
    failing_values: tuple[float, ...] = ()
    decisions: tuple[Decision, ...] = ()
    shown: JudgedDrive | None = None
    shown_values: tuple[float, ...] = ()
    fault: str = ""
    reductions: int = 0
    points: list[tuple[float, float, str]] = field(default_factory=list)
    boundary: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True)
class Searching:
    """A search: ``budget`` simulations at most; ``wanted``: the failures after which it ends.

    ``starts``: values of the knobs that the first generation has, besides its own.
    """

    problem: TargetProblem
    budget: int
    seed: int
    method: Method = "cma"
    wanted: Wanted = "any"
    starts: tuple[tuple[float, ...], ...] = ()

    def run(self, loop: ControlLoop) -> FailureSearchOutcome:
        """Return what is found; a controller that fails to answer ends the search, which says so."""
        outcome = FailureSearchOutcome()
        state = _SearchState(self, loop, outcome)
        try:
            state.search()
        except ControllerError as error:
            outcome.fault = str(error)
        try:
            state.reduce()
            state.judge_shown()
            state.draw_boundary()
        except ControllerError as error:
            outcome.fault = outcome.fault or str(error)
        return outcome


class _SearchState:
    """The state of a search."""

    def __init__(self, searching: Searching, loop: ControlLoop, outcome: FailureSearchOutcome) -> None:
        self.searching, self.loop, self.outcome = searching, loop, outcome
        self.problem = searching.problem
        knobs = self.problem.shape.knobs
        self.low = np.array([x.low for x in knobs])
        self.wide = np.array([x.high - x.low for x in knobs])
        self.random = np.random.default_rng([searching.seed, *self.problem.name.encode()])
        self.best: tuple[float, np.ndarray[Any, np.dtype[np.float64]]] | None = None
        self.showing: list[Trial] = []
        self.confirmed = 0

    # --- generations ---------------------------------------------------------------------------------

    def search(self) -> None:
        """Simulate generation after generation until the budget is spent or a wanted failure is found.

        Before, the controller drives twice in the pattern, since it has to do the same both times.
        """
        shape = self.problem.shape
        exact_drive(self.loop, shape.situation(self._values(self._unit(shape.seed))))
        self._evaluate(self._first())
        if self.searching.method == "random":
            while not self._is_over:
                self._evaluate(self.random.random((POPULATION, len(self.low))))
            return
        restarts = 0
        while not self._is_over:
            mean = self._mean(restarts)
            self._evolve(mean, _NEAR if restarts == 0 else _WIDE)
            restarts += 1

    def _evolve(self, mean: Any, sigma: float) -> None:
        """Run CMA-ES from a point of the unit cube until it does not improve any more."""
        made = _cma()(
            mean=mean,
            sigma=sigma,
            bounds=np.array([[0.0, 1.0]] * len(mean)),
            seed=int(self.random.integers(2**31)),
            population_size=POPULATION,
        )
        best, stale = float("inf"), 0
        while not self._is_over and not made.should_stop() and stale < _STALE:
            points = [made.ask() for _ in range(POPULATION)]
            costs = self._evaluate(np.array(points))
            if len(costs) < POPULATION:
                return
            made.tell(list(zip(points, costs, strict=True)))
            stale = 0 if min(costs) < best - 1e-3 else stale + 1
            best = min(best, *costs)

    def _mean(self, restarts: int) -> Any:
        """Return where CMA-ES starts: at the best point, then at random ones, then at the best again."""
        if self.best is not None and restarts % 2 == 0:
            return np.clip(self.best[1], 0.01, 0.99)
        return self.random.random(len(self.low))

    def _first(self) -> Any:
        """Return the first generation: the pattern, points near it, random and boundary points."""
        count, width = POPULATION, len(self.low)
        seed = self._unit(self.problem.shape.seed)
        near = np.clip(seed + self.random.normal(0, _NEAR, (count // 2 - 1, width)), 0, 1)
        far = self.random.random((count // 2, width))
        others = [*map(self._unit, self.searching.starts), *self._boundary()]
        return np.vstack([seed, near, far, *([np.array(others)] if others else [])])

    def _unit(self, values: Sequence[float]) -> Any:
        return np.clip((np.array(values) - self.low) / self.wide, 0, 1)

    def _boundary(self) -> Iterator[Any]:
        """Yield points on the preventable side of the boundary of the first driver model.

        On lines along which the first gap grows, SV is driven by nobody; the model is put into its place.
        """
        gaps = [k for k, x in enumerate(self.problem.shape.knobs) if x.name.endswith(".gap")]
        if not gaps or not self.problem.models or self.problem.fails is None:
            return
        for _ in range(_BOUNDARY):
            point = self.random.random(len(self.low))
            low, high = 0.0, 1.0
            for _ in range(_BISECTIONS):
                point[gaps[-1]] = (low + high) / 2
                [is_far] = is_prevented(self.problem, [self._values(point)])
                low, high = (low, point[gaps[-1]]) if is_far else (point[gaps[-1]], high)
            point[gaps[-1]] = high
            yield point.copy()

    def _values(self, point: Any) -> tuple[float, ...]:
        """Return the values of the knobs at a point of the unit cube, rounded to their grains."""
        return tuple(
            float(knob.value(x))
            for knob, x in zip(self.problem.shape.knobs, self.low + self.wide * point, strict=True)
        )

    @property
    def _is_over(self) -> bool:
        outcome = self.outcome
        if outcome.count >= self.searching.budget:
            return True
        if outcome.first_preventable:
            return True
        return outcome.first_failure > 0 and self.searching.wanted == "any" and not self.problem.models

    def _evaluate(self, points: Any) -> list[float]:
        """Simulate points, and return their costs; fewer where the budget ends or a failure is found."""
        left = self.searching.budget - self.outcome.count
        every = [self._values(x) for x in points[:left]]
        if not every:
            return []
        trials = self.problem.run(self.loop, every)
        costs: list[float] = []
        for point, trial in zip(points, trials, strict=False):
            self.outcome.count += 1
            costs.append(self._cost(trial))
            if self.best is None or costs[-1] < self.best[0]:
                self.best = costs[-1], point
            if self.outcome.first_preventable:
                break
        report_stage(
            "simulate", f"{self.outcome.count} of {self.searching.budget}, best {self.outcome.best:.3g}"
        )
        return costs

    # --- costs ---------------------------------------------------------------------------------------

    def _cost(self, trial: Trial) -> float:
        """Return the cost of a simulation: it falls towards the target, towards a failure, and towards a
        failure that a driver prevents.
        """
        outcome = self.outcome
        outcome.nearest = max(outcome.nearest, trial.shows)
        x, y = self._plane(trial)
        if trial.shows <= 0:
            outcome.points.append((x, y, "other"))
            return _HIDDEN + min(-trial.shows, 1e3) / 10
        if trial.breaks <= 0:
            self._note_shown(trial)
            outcome.points.append((x, y, "shown"))
            outcome.best = min(outcome.best, -trial.breaks)
            return _SAFE + min(-trial.breaks, 100.0) if self.problem.fails is not None else 0.0
        outcome.best = min(outcome.best, -trial.breaks)
        foretold = self.problem.foretold(trial)
        cost = severity(foretold)
        is_hoped = foretold is None or foretold.result is not Result.COLLIDES
        if (is_hoped or outcome.failing is None) and self.confirmed < _CONFIRMED:
            self._confirm(trial)
        outcome.points.append((x, y, "fails" if cost > 0 else "preventable" if foretold else "fails"))
        return cost

    def _plane(self, trial: Trial) -> tuple[float, float]:
        """Return the values of two knobs: the last gap, and the speed of SV minus that of POV."""
        known = dict(zip((k.name for k in self.problem.shape.knobs), trial.values, strict=True))
        gap = [x for name, x in known.items() if name.endswith(".gap")]
        faster = [x for name, x in known.items() if name.endswith(".faster")]
        return (gap[-1] if gap else 0.0), (-faster[-1] if faster else 0.0)

    def _note_shown(self, trial: Trial) -> None:
        """Remember the simulations that show the target by the greatest margins."""
        self.showing.append(trial)
        self.showing.sort(key=lambda x: -x.shows)
        del self.showing[4:]

    def _confirm(self, trial: Trial) -> None:
        """Judge the exact drive of a failure; remember the first, and the first that a driver prevents."""
        problem, outcome = self.problem, self.outcome
        assert problem.fails is not None
        self.confirmed += 1
        situation = problem.shape.situation(trial.values)
        judged = problem.judged(situation, self.loop, problem.fails, may_overlap=True)
        if judged is None:
            return
        decisions = problem.decisions(judged)
        is_prevented = prevents(decisions)
        if outcome.failing is None or is_prevented:
            outcome.failing, outcome.decisions = judged, decisions
            outcome.failing_values = trial.values
        outcome.first_failure = outcome.first_failure or outcome.count
        if is_prevented:
            outcome.first_preventable = outcome.count

    def reduce(self) -> None:
        """Make the failure simple."""
        outcome = self.outcome
        if outcome.failing is not None:
            first = Reduced(outcome.failing_values, outcome.failing, outcome.decisions, 0)
            last = reduced(self.problem, self.loop, first)
            outcome.failing, outcome.failing_values = last.drive, last.values
            outcome.decisions, outcome.reductions = last.decisions, last.simulations

    def draw_boundary(self) -> None:
        """Work out the boundary of the driver model, the other knobs as in the failing drive."""
        if self.problem.fails is not None:
            values = self.outcome.failing_values or self._values(self._unit(self.problem.shape.seed))
            self.outcome.boundary = boundary_line(self.problem, values)

    def judge_shown(self) -> None:
        """Judge the drives that show the target most clearly; a failing drive shows it, too."""
        outcome = self.outcome
        every = [(x.values, False) for x in self.showing]
        if outcome.failing is not None:
            every.append((outcome.failing_values, True))
        for values, may_overlap in every:
            situation = self.problem.shape.situation(values)
            judged = self.problem.judged(situation, self.loop, self.problem.shown, may_overlap)
            if judged is not None:
                outcome.shown, outcome.shown_values = judged, values
                return


def _cma() -> Any:
    try:
        from cmaes import CMA
    except ImportError:
        raise MissingSolverError(
            "the search needs cmaes: pip install cmaes, or choose --method random"
        ) from None
    return CMA
