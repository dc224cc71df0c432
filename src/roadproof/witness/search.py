"""The loop: solve, shape, round, replay, judge; on a no look closer, or say that we do not know."""

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import combinations, product

from roadproof.encode.build import Manners, Margin, encode_formula, frame
from roadproof.encode.circuit import Circuit
from roadproof.encode.motion import Layout
from roadproof.encode.problem import ColumnFact, Problem
from roadproof.encode.unroll import Grid
from roadproof.errors import UsageError
from roadproof.judge.exact import judge
from roadproof.judge.replay import first_breach, first_overlap
from roadproof.logic.formula import Formula
from roadproof.solve.bounds import TooNonlinearError
from roadproof.solve.exact import solve_exactly
from roadproof.solve.milp import Solution, box_of, solve_mixed
from roadproof.verdict import Verdict
from roadproof.witness.limits import Limits
from roadproof.witness.question import Found, Means, Question
from roadproof.witness.rounding import round_drive
from roadproof.witness.shape import reshape, violation_depths
from roadproof.witness.variety import differ
from roadproof.world.drive import Drive

# Units of work: the least for one exact search, and the most for one way to show that there is no drive.
LEAST_EXACT = 2.0
REFUTING = 20.0


@dataclass(frozen=True)
class Answer:
    """WITNESSED with a drive, NONE-WITHIN with limits, or UNKNOWN; the last two with a reason.

    ``seconds`` by stage.
    """

    verdict: Verdict
    found: Found | None
    reason: str
    seconds: Mapping[str, float] = field(default_factory=dict)
    sizes: Mapping[str, int] = field(default_factory=dict)
    limits: Limits | None = None


def find_witness(question: Question, means: Means, unlike: tuple[Drive, ...] = ()) -> Answer:
    """Search for a drive clearly different from those in ``unlike``.

    Whatever is found has been judged exactly in dense and unbounded time. NONE-WITHIN means that
    the problem on the grid has no solution for any assignment of lanes. Raises ``UsageError`` for
    interval bounds off the grid, ``MissingSolverError``, and ``Late`` where the clock cuts it off.
    """
    if means.objective == "short":
        return _shortest(question, means, unlike)
    return _Search(question, means, unlike).run()


def show_none(question: Question, means: Means) -> Answer:
    """Show that no drive on the grid answers the question, within limits that are printed.

    NONE-WITHIN, or WITNESSED where the exact encoding has a solution that is judged a witness after all,
    or UNKNOWN. Raises as ``find_witness``.
    """
    return _Search(question, means, ()).none()


def _shortest(question: Question, means: Means, unlike: tuple[Drive, ...]) -> Answer:
    """The fewest steps for which there is a drive, by halving; each answer is judged by itself."""
    means = replace(means, objective="smooth")
    best = find_witness(question, means, unlike)
    if best.found is None:
        return best
    low, high = 0, question.grid.steps
    while high - low > 1:
        middle = (low + high) // 2
        shorter = replace(question, grid=Grid(question.grid.dt, middle))
        answer = _Search(shorter, replace(means, refinements=0, explain=False), unlike).run()
        if answer.found is not None and answer.found.manners.natural == best.found.manners.natural:
            best, high = answer, middle
        else:
            low = middle
    return best


class _Search:
    def __init__(self, question: Question, means: Means, unlike: tuple[Drive, ...]) -> None:
        self.question = question
        self.means = means
        self.unlike = unlike
        self.seconds: dict[str, float] = {}
        self.sizes: dict[str, int] = {}
        self.meter = means.effort.meter()
        self.doubt = ""
        self.doubts: list[str] = []
        self.encoded: dict[tuple[Formula, Grid, Margin, bool], Circuit[ColumnFact]] = {}

    def run(self) -> Answer:
        for lanes, grid, manners in self._attempts():
            if self.meter.is_out():
                return self._answer(Verdict.UNKNOWN, None, self.meter.reason())
            found = self._attempt(lanes, grid, manners)
            if found is not None:
                return self._answer(Verdict.WITNESSED, found, "")
        if self.meter.is_out():
            return self._answer(Verdict.UNKNOWN, None, self.meter.reason())
        doubt = self.doubts[-1] if self.doubts else ""
        if not self.means.explain:
            return self._answer(Verdict.UNKNOWN, None, doubt or "none was found")
        answer = self.none()
        return replace(answer, reason=doubt) if doubt and answer.verdict is Verdict.UNKNOWN else answer

    def _answer(self, verdict: Verdict, found: Found | None, reason: str) -> Answer:
        return Answer(verdict, found, reason, self.seconds, self.sizes)

    def _attempts(self) -> Iterator[tuple[Mapping[str, str], Grid, Manners]]:
        """Natural drives first, on the grid and on finer ones; then whatever the limits allow.

        Where a start at s = 0 does not stand for all, other starts come after it.
        """
        for group in self._groups():
            for lanes, manners in product(self.question.lanes, group):
                for halvings in range(self.means.refinements + 1):
                    self.doubt = ""
                    yield lanes, self.question.grid.finer(2**halvings), manners
                    if not self.doubt:
                        break
                    self.doubts.append(self.doubt)

    def _groups(self) -> Iterator[list[Manners]]:
        natural = [*self._straightest(), self.question.manners] if self.question.manners.natural else []
        if natural:
            yield natural
            if self.question.starts is not None:
                yield [replace(manners, starts=self.question.starts) for manners in natural]
        yield [replace(self.question.manners.plain(), starts=self.question.starts)]

    def _straightest(self) -> Iterator[Manners]:
        """The fewer vehicles change lanes, the easier a drive is to read, and to find."""
        names = tuple(self.question.vehicles)
        for count in range(len(names)):
            for movers in combinations(names, count):
                yield replace(self.question.manners, straight=frozenset(names) - set(movers))

    def _attempt(self, lanes: Mapping[str, str], grid: Grid, manners: Manners) -> Found | None:
        start = time.perf_counter()
        formula = self.question.bound(lanes)
        problem, layout = self._problem(formula, grid, manners)
        self.sizes = problem.sizes()
        start = self._spent("encode", start)
        solution = self._solve(problem)
        start = self._spent("solve", start)
        if solution.status != "found":
            self.doubt = "the solver gave up" if solution.status == "unknown" else self.doubt
            return None
        for drive in self._drives(problem, layout, solution, formula):
            start = self._spent("shape", start)
            complaint = self._complaint(formula, drive, grid, manners)
            start = self._spent("judge", start)
            if complaint is None:
                return Found(drive, lanes, formula, grid, manners)
            self.doubt = complaint
        return None

    def _problem(self, formula: Formula, grid: Grid, manners: Manners) -> tuple[Problem, Layout]:
        vehicles = self.question.vehicles
        layout = Layout(tuple(vehicles), grid)
        key = (formula, grid, manners.margin, manners.lasting)
        if key not in self.encoded:
            self.encoded[key] = encode_formula(formula, vehicles, layout, manners)
        problem = frame(self.encoded[key], self.question.road, vehicles, layout, manners)
        for other in self.unlike:
            problem = problem.also(differ(layout, other))
        return problem, layout

    def _solve(self, problem: Problem) -> Solution:
        if self.means.engine == "smt":
            exact = solve_exactly(problem, self.meter.part(max(LEAST_EXACT, self.meter.left() / 3)))
            return Solution(exact.status, exact.values)
        try:
            return solve_mixed(problem, box_of(problem), solver=self.means.solver, meter=self.meter)
        except TooNonlinearError:
            raise UsageError(
                "the formula has a comparison of degree above 2, which the engine milp cannot bound: "
                "the engine smt can"
            ) from None

    def _drives(
        self, problem: Problem, layout: Layout, solution: Solution, formula: Formula
    ) -> Iterator[Drive]:
        """What the solver found in a better shape, then as it is."""
        vehicles = self.question.vehicles
        floats = tuple(float(v) for v in solution.values)
        if self.means.objective != "any":
            depths: tuple[ColumnFact, ...] = ()
            if self.means.objective in ("mild", "severe"):
                depths = violation_depths(formula, vehicles, layout, floats)
            objective, road = self.means.objective, self.question.road
            shaped = reshape(problem, layout, road, vehicles, floats, objective, depths)
            yield round_drive(layout, vehicles, shaped)
        yield round_drive(layout, vehicles, floats)
        if self.means.engine == "smt":
            yield round_drive(layout, vehicles, solution.values, None)

    def _complaint(self, formula: Formula, drive: Drive, grid: Grid, manners: Manners) -> str | None:
        """Why a drive is no witness, or None."""
        breach = first_breach(drive, self.question.vehicles, None)
        if breach is not None:
            return f"after rounding, {breach}"
        overlap = None if manners.collisions else first_overlap(drive, grid.horizon)
        if overlap is not None:
            return f"between the samples, {overlap}"
        if not judge(formula, drive).holds:
            return f"the drives that were found fail the formula between the samples of dt={grid.dt} s"
        return None

    def none(self) -> Answer:
        """Show that there is none on the grid: by a relaxation, else by the exact encoding."""
        start = time.perf_counter()
        manners = replace(self.question.manners.loosest(), starts=self.question.starts)
        how = set()
        for lanes in self.question.lanes:
            formula = self.question.bound(lanes)
            problem, layout = self._problem(formula, self.question.grid, manners)
            by, exact = self._refute(problem)
            start = self._spent("refute", start)
            if exact is not None:
                drive = round_drive(layout, self.question.vehicles, exact, None)
                complaint = self._complaint(formula, drive, self.question.grid, manners)
                if complaint is None:
                    found = Found(drive, lanes, formula, self.question.grid, manners)
                    return self._answer(Verdict.WITNESSED, found, "")
                return self._answer(Verdict.UNKNOWN, None, complaint)
            if not by:
                shown = ", ".join(f"{k}={v}" for k, v in lanes.items()) or self.question.road.name
                reason = f"neither a drive nor a refutation was found with the work given for {shown}"
                return self._answer(Verdict.UNKNOWN, None, reason)
            how.add(by)
        limits = self.question.limits(how)
        return replace(self._answer(Verdict.NONE_WITHIN, None, limits.text()), limits=limits)

    def _refute(self, problem: Problem) -> tuple[str, tuple[Fraction, ...] | None]:
        """How it was shown that ``problem`` has no solution (empty where it was not), or a solution."""
        if self.means.engine == "milp":
            try:
                box = box_of(problem)
                meter = self.meter.part(REFUTING)
                relaxed = solve_mixed(problem, box, "outer", 2, None, self.means.solver, meter)
                if relaxed.status == "infeasible":
                    return f"a relaxation is infeasible for {self.means.solver}", None
            except TooNonlinearError:
                pass
        exact = solve_exactly(problem, self.meter.part(REFUTING))
        if exact.status == "found":
            return "", exact.values
        return ("the exact encoding is unsat for z3" if exact.status == "infeasible" else ""), None

    def _spent(self, stage: str, start: float) -> float:
        now = time.perf_counter()
        self.seconds[stage] = self.seconds.get(stage, 0.0) + now - start
        return now
