"""The loop: solve, shape, round, replay, judge; on a no look closer, or say that we do not know."""

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from fractions import Fraction
from itertools import combinations, product, zip_longest

from roadproof.engines.encode.build import Assumptions, Margin, encode_formula, frame
from roadproof.engines.encode.motion import Layout, own_columns
from roadproof.engines.encode.problem import Circuit, ColumnInequality, Problem, Solution
from roadproof.engines.encode.unroll import Grid
from roadproof.engines.search.initial_candidates import closed, starts, unread
from roadproof.engines.search.initial_conditions import differ, encode_start
from roadproof.engines.search.limits import Limits
from roadproof.engines.search.question import FoundDrive, SearchOptions, SearchProblem
from roadproof.engines.search.shape import reshape, round_drive, violation_depths
from roadproof.engines.solve.bounds import TooNonlinearError
from roadproof.engines.solve.exact import solve_exactly
from roadproof.engines.solve.milp import box_of, solve_mixed
from roadproof.errors import UsageError
from roadproof.logic.formula import Formula
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.runtime.budget import Effort
from roadproof.runtime.progress import begin
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.verdict import DriveVerdict, Verdict
from roadproof.world.drive import Drive

# Units of work: the least for one exact search, and the most for one way to show that there is no drive.
LEAST_EXACT = 2.0
REFUTING = 20.0
STARTS = 12  # for each assignment of lanes


@dataclass(frozen=True)
class Attempt:
    """WITNESSED with a drive, NONE-WITHIN with limits, or UNKNOWN; the last two with a reason.

    ``seconds`` by stage. ``exhausted``: of an UNKNOWN, all work that counts was done, so the same work finds
    the same.
    """

    verdict: DriveVerdict
    found: FoundDrive | None
    reason: Reason
    seconds: Mapping[str, float] = field(default_factory=dict)
    sizes: Mapping[str, int] = field(default_factory=dict)
    limits: Limits | None = None
    exhausted: bool = False


def find_witness(
    question: SearchProblem, search_options: SearchOptions, unlike: tuple[Drive, ...] = ()
) -> Attempt:
    """Search for a drive clearly different from those in ``unlike``.

    Whatever is found has been judged exactly in dense and unbounded time. NONE-WITHIN means that
    the problem on the grid has no solution for any assignment of lanes. Raises ``UsageError`` for
    interval bounds off the grid, ``MissingSolverError``, and ``BudgetExceeded`` where the clock cuts it off.
    """
    if question.start is None and search_options.engine == "milp":
        parts = [unread(question, lanes) for lanes in question.lanes]
        if any(parts) or any(closed(question, lanes) for lanes in question.lanes):
            return _from_starts(question, parts, search_options, unlike)
    if search_options.objective == "short":
        return _shortest(question, search_options, unlike)
    return _Search(question, search_options, unlike).run()


def _from_starts(
    question: SearchProblem,
    parts: Sequence[tuple[Formula, ...]],
    search_options: SearchOptions,
    unlike: tuple[Drive, ...],
) -> Attempt:
    """A search from one sampled start after the other; UNKNOWN where none of them gives a drive.

    The starts of all assignments of lanes take turns, so that none has to wait for all of another. There
    are no more of them than units of work, but one for each assignment.
    """
    meter = search_options.effort.meter()
    begin("encode", "starts in place of conditions that no engine reads")
    most = max(1, min(STARTS, int(min(meter.limit, 1e6) / len(parts))))
    each = meter.limit / ((most if any(parts) else 1) * len(parts))
    found = [starts(question, lanes, x, most) for lanes, x in zip(question.lanes, parts, strict=True)]
    turns = (start for same in zip_longest(*found) for start in same if start is not None)
    tried = 0
    for start in turns:
        tried += 1
        part = Effort(max(1.0, each), meter.seconds_left())
        begun = replace(question, lanes=(start.lanes,), start=start)
        answer = find_witness(begun, replace(search_options, effort=part, explain=False), unlike)
        if answer.found is not None:
            return answer
    return Attempt(Verdict.UNKNOWN, None, _untold(tried if any(parts) else None))


def _untold(tried: int | None) -> Reason:
    """Why there is no answer, after so many starts; None where none is sampled."""
    if tried is None:
        return Why.UNREAD()
    return Why.UNREAD_SAMPLED(tried) if tried else Why.UNREAD_NO_STATE()


def show_none(question: SearchProblem, search_options: SearchOptions) -> Attempt:
    """Show that no drive on the grid answers the question, within limits that are printed.

    NONE-WITHIN, or WITNESSED where the exact encoding has a solution that is judged a witness after all,
    or UNKNOWN. Raises as ``find_witness``.
    """
    return _Search(replace(question, start=None), search_options, ()).none()


def _shortest(question: SearchProblem, search_options: SearchOptions, unlike: tuple[Drive, ...]) -> Attempt:
    """The fewest steps for which there is a drive, by halving; each answer is judged by itself."""
    search_options = replace(search_options, objective="smooth")
    best = find_witness(question, search_options, unlike)
    if best.found is None:
        return best
    low, high = 0, question.grid.steps
    while high - low > 1:
        middle = (low + high) // 2
        shorter = replace(question, grid=Grid(question.grid.dt, middle))
        answer = _Search(shorter, replace(search_options, refinements=0, explain=False), unlike).run()
        if answer.found is not None and answer.found.assumptions.natural == best.found.assumptions.natural:
            best, high = answer, middle
        else:
            low = middle
    return best


class _Search:
    def __init__(
        self, question: SearchProblem, search_options: SearchOptions, unlike: tuple[Drive, ...]
    ) -> None:
        self.question = question
        self.search_options = search_options
        self.unlike = unlike
        self.seconds: dict[str, float] = {}
        self.sizes: dict[str, int] = {}
        self.meter = search_options.effort.meter()
        self.doubt = NO_REASON
        self.doubts: list[Reason] = []
        self.encoded: dict[tuple[Formula, Grid, Margin, bool], Circuit[ColumnInequality]] = {}

    def run(self) -> Attempt:
        for lanes, grid, assumptions in self._attempts():
            if self.meter.is_out():
                return self._answer(Verdict.UNKNOWN, None, self.meter.reason())
            found = self._attempt(lanes, grid, assumptions)
            if found is not None:
                return self._answer(Verdict.WITNESSED, found, NO_REASON)
        if self.meter.is_out():
            return self._answer(Verdict.UNKNOWN, None, self.meter.reason())
        doubt = self.doubts[-1] if self.doubts else NO_REASON
        if not self.search_options.explain or self.question.start is not None:
            answer = self._answer(Verdict.UNKNOWN, None, doubt or Why.NONE_FOUND())
            return replace(answer, exhausted=not doubt)
        answer = self.none()
        return replace(answer, reason=doubt) if doubt and answer.verdict is Verdict.UNKNOWN else answer

    def _answer(self, verdict: DriveVerdict, found: FoundDrive | None, reason: Reason) -> Attempt:
        return Attempt(verdict, found, reason, self.seconds, self.sizes)

    def _attempts(self) -> Iterator[tuple[Mapping[str, str], Grid, Assumptions]]:
        """Natural drives first, on the grid and on finer ones; then whatever the limits allow.

        Where a start at s = 0 does not stand for all, other starts come after it.
        """
        for group in self._groups():
            for lanes, assumptions in product(self.question.lanes, group):
                for halvings in range(self.search_options.refinements + 1):
                    self.doubt = NO_REASON
                    yield lanes, self.question.grid.finer(2**halvings), assumptions
                    if not self.doubt:
                        break
                    self.doubts.append(self.doubt)

    def _groups(self) -> Iterator[list[Assumptions]]:
        natural = (
            [*self._straightest(), self.question.assumptions] if self.question.assumptions.natural else []
        )
        if natural:
            yield natural
            if self.question.starts is not None:
                yield [replace(assumptions, starts=self.question.starts) for assumptions in natural]
        yield [replace(self.question.assumptions.plain(), starts=self.question.starts)]

    def _straightest(self) -> Iterator[Assumptions]:
        """The fewer vehicles change lanes, the easier a drive is to read, and to find."""
        names = tuple(self.question.vehicles)
        for count in range(len(names)):
            for movers in combinations(names, count):
                yield replace(self.question.assumptions, straight=frozenset(names) - set(movers))

    def _attempt(self, lanes: Mapping[str, str], grid: Grid, assumptions: Assumptions) -> FoundDrive | None:
        start = time.perf_counter()
        told = self._told(lanes, grid, assumptions)
        begin("encode", told)
        formula = self.question.bound(lanes)
        problem, layout = self._problem(self.question.asked(lanes), grid, assumptions)
        self.sizes = problem.sizes()
        start = self._spent("encode", start)
        begin("solve", told)
        solution = self._solve(problem)
        start = self._spent("solve", start)
        if solution.status != "found":
            self.doubt = Why.SOLVER_GAVE_UP() if solution.status == "unknown" else self.doubt
            return None
        begin("shape", told)
        for drive in self._drives(problem, layout, solution, formula):
            start = self._spent("shape", start)
            begin("judge", told)
            complaint = self._complaint(formula, drive, grid, assumptions)
            start = self._spent("judge", start)
            if complaint is None:
                return FoundDrive(drive, lanes, formula, grid, assumptions)
            self.doubt = complaint
        return None

    def _problem(self, formula: Formula, grid: Grid, assumptions: Assumptions) -> tuple[Problem, Layout]:
        vehicles = self.question.vehicles
        layout = Layout(tuple(vehicles), grid, own_columns(formula))
        key = (formula, grid, assumptions.margin, assumptions.lasting)
        if key not in self.encoded:
            self.encoded[key] = encode_formula(formula, vehicles, layout, assumptions)
        problem = frame(self.encoded[key], self.question.road, vehicles, layout, assumptions)
        if self.question.start is not None:
            problem = problem.also(encode_start(self.question.start, layout))
        for other in self.unlike:
            problem = problem.also(differ(layout, other))
        return problem, layout

    def _solve(self, problem: Problem) -> Solution:
        if self.search_options.engine == "smt":
            return solve_exactly(problem, self.meter.part(max(LEAST_EXACT, self.meter.left() / 3)))
        try:
            return solve_mixed(problem, box_of(problem), solver=self.search_options.solver, meter=self.meter)
        except TooNonlinearError:
            raise UsageError(
                "the formula has a comparison of degree above 2, which the engine milp cannot bound: "
                "use the engine smt"
            ) from None

    def _drives(
        self, problem: Problem, layout: Layout, solution: Solution, formula: Formula
    ) -> Iterator[Drive]:
        """What the solver found in a better shape, then as it is."""
        vehicles = self.question.vehicles
        floats = tuple(float(v) for v in solution.values)
        if self.search_options.objective != "any":
            depths: tuple[ColumnInequality, ...] = ()
            if self.search_options.objective in ("mild", "severe"):
                depths = violation_depths(formula, vehicles, layout, floats)
            objective, road = self.search_options.objective, self.question.road
            shaped = reshape(problem, layout, road, vehicles, floats, objective, depths)
            yield round_drive(layout, vehicles, shaped, begun=self.question.start)
        yield round_drive(layout, vehicles, floats, begun=self.question.start)
        if self.search_options.engine == "smt":
            yield round_drive(layout, vehicles, solution.values, None)

    def _complaint(
        self, formula: Formula, drive: Drive, grid: Grid, assumptions: Assumptions
    ) -> Reason | None:
        """Why a drive is no witness, or None."""
        breach = first_breach(drive, self.question.vehicles, None, self.question.road.line)
        if breach is not None:
            return Why.BREACH(breach)
        overlap = None if assumptions.collisions else first_overlap(drive, grid.horizon)
        if overlap is not None:
            return Why.OVERLAP(overlap)
        if not judge(formula, drive).holds:
            return Why.BETWEEN_SAMPLES(grid.dt)
        return None

    def none(self) -> Attempt:
        """Show that there is none on the grid: by a relaxation, else by the exact encoding."""
        start = time.perf_counter()
        assumptions = replace(self.question.assumptions.loosest(), starts=self.question.starts)
        how = set()
        for lanes in self.question.lanes:
            formula = self.question.bound(lanes)
            begin("refute", self._told(lanes, self.question.grid, assumptions))
            problem, layout = self._problem(formula, self.question.grid, assumptions)
            by, exact = self._refute(problem)
            start = self._spent("refute", start)
            if exact is not None:
                drive = round_drive(layout, self.question.vehicles, exact, None)
                complaint = self._complaint(formula, drive, self.question.grid, assumptions)
                if complaint is None:
                    found = FoundDrive(drive, lanes, formula, self.question.grid, assumptions)
                    return self._answer(Verdict.WITNESSED, found, NO_REASON)
                return self._answer(Verdict.UNKNOWN, None, complaint)
            if not by:
                shown = ", ".join(f"{k}={v}" for k, v in lanes.items()) or self.question.road.name
                return self._answer(Verdict.UNKNOWN, None, Why.NEITHER(shown))
            how.add(by)
        limits = self.question.limits(how)
        return replace(self._answer(Verdict.NONE_WITHIN, None, Why.TOLD(limits.text())), limits=limits)

    def _refute(self, problem: Problem) -> tuple[str, Sequence[float | Fraction] | None]:
        """How it was shown that ``problem`` has no solution (empty where it was not), or a solution."""
        if self.search_options.engine == "milp":
            try:
                box = box_of(problem)
                meter = self.meter.part(REFUTING)
                relaxed = solve_mixed(problem, box, "outer", 2, self.search_options.solver, meter)
                if relaxed.status == "infeasible":
                    return f"a relaxation is infeasible for {self.search_options.solver}", None
            except TooNonlinearError:
                pass
        exact = solve_exactly(problem, self.meter.part(REFUTING))
        if exact.status == "found":
            return "", exact.values
        return ("the exact encoding is unsat for z3" if exact.status == "infeasible" else ""), None

    def _told(self, lanes: Mapping[str, str], grid: Grid, assumptions: Assumptions) -> str:
        """On which grid and under what is searched, in words."""
        among = [f"dt={grid.dt} s up to {grid.horizon} s", *(f"{k}={v}" for k, v in lanes.items())]
        natural = ["natural drives"] if assumptions.natural else []
        straight = [f"{' and '.join(sorted(assumptions.straight))} straight"] if assumptions.straight else []
        return ", ".join([*among, *natural, *straight])

    def _spent(self, stage: str, start: float) -> float:
        now = time.perf_counter()
        self.seconds[stage] = self.seconds.get(stage, 0.0) + now - start
        return now
