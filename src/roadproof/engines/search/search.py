"""The search loop: solve, shape, round, replay, judge; without a drive refine the grid, or end UNKNOWN."""

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from fractions import Fraction
from itertools import combinations, product, zip_longest

from roadproof.engines.encode.build import Assumptions, Margin, assemble_problem, encode_formula
from roadproof.engines.encode.motion import ColumnLayout, custom_signal_ranges
from roadproof.engines.encode.problem import Circuit, ColumnInequality, ColumnValues, Problem
from roadproof.engines.encode.unroll import Grid
from roadproof.engines.search.initial_candidates import (
    not_encodable,
    not_encodable_comparisons,
    sampled_starts,
)
from roadproof.engines.search.initial_conditions import differs_from, encode_start
from roadproof.engines.search.limits import SearchLimits
from roadproof.engines.search.question import FoundDrive, SearchProblem
from roadproof.engines.search.shape import reshape, round_drive, violation_depths
from roadproof.engines.search.wishes import wished_formulas
from roadproof.engines.setting import SearchOptions
from roadproof.engines.solve.bounds import TooNonlinearError
from roadproof.engines.solve.exact import solve_exactly
from roadproof.engines.solve.milp import column_box, solve_mixed
from roadproof.errors import UsageError
from roadproof.logic.formula import Formula, conjunction
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.runtime.budget import Effort
from roadproof.runtime.progress import report_stage
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.verdict import DriveVerdict, Verdict
from roadproof.world.drive import Drive

# Units of work: the least for one exact search, and the most for one way to show that there is no drive.
LEAST_EXACT = 2.0
REFUTING = 20.0
WISHING = 10.0  # for one search for a drive that fulfils wishes, too
STARTS = 12  # for each assignment of lanes


@dataclass(frozen=True)
class SearchStep:
    """The result of one search: WITNESSED with a drive, NONE-WITHIN with limits, or UNKNOWN with a reason.

    ``seconds`` by stage. ``exhausted``: an UNKNOWN that used all its countable work, so the same work finds
    the same.
    """

    verdict: DriveVerdict
    witness: FoundDrive | None
    reason: Reason
    seconds: Mapping[str, float] = field(default_factory=dict)
    sizes: Mapping[str, int] = field(default_factory=dict)
    limits: SearchLimits | None = None
    exhausted: bool = False


def find_witness(
    question: SearchProblem, search_options: SearchOptions, unlike: tuple[Drive, ...] = ()
) -> SearchStep:
    """Search for a drive clearly different from those in ``unlike``.

    Every drive found has been judged exactly in dense and unbounded time. NONE-WITHIN means that the problem
    on the grid has no solution for any assignment of lanes. Raises ``UsageError`` for interval bounds off the
    grid, ``MissingSolverError``, and ``BudgetExceeded`` where the clock cuts it off.
    """
    if question.start is None and search_options.engine == "milp":
        parts = [not_encodable(question, lanes) for lanes in question.lanes]
        if any(parts) or any(not_encodable_comparisons(question, lanes) for lanes in question.lanes):
            return _search_from_starts(question, parts, search_options, unlike)
    if search_options.objective == "short":
        return _search_shortest(question, search_options, unlike)
    if search_options.objective == "typical" and question.start is None:
        return _search_typical(question, search_options, unlike)
    return _GridSearch(question, search_options, unlike).run()


def _search_from_starts(
    question: SearchProblem,
    parts: Sequence[tuple[Formula, ...]],
    search_options: SearchOptions,
    unlike: tuple[Drive, ...],
) -> SearchStep:
    """Search from sampled starts in turn; UNKNOWN where none of them gives a drive.

    The starts of all assignments of lanes alternate, so none waits for all of another. At most one start
    per unit of work is tried, but at least one for each assignment.
    """
    meter = search_options.effort.meter()
    report_stage("encode", "starts in place of conditions that no engine reads")
    most = max(1, min(STARTS, int(min(meter.limit, 1e6) / len(parts))))
    each = meter.limit / ((most if any(parts) else 1) * len(parts))
    sequences = [
        sampled_starts(question, lanes, x, most) for lanes, x in zip(question.lanes, parts, strict=True)
    ]
    turns = (start for same in zip_longest(*sequences) for start in same if start is not None)
    tried = 0
    for start in turns:
        tried += 1
        part = Effort(max(1.0, each), meter.seconds_left())
        with_start = replace(question, lanes=(start.lanes,), start=start)
        answer = find_witness(with_start, replace(search_options, effort=part, explain=False), unlike)
        if answer.witness is not None:
            return answer
    return SearchStep(Verdict.UNKNOWN, None, _no_start_reason(tried if any(parts) else None))


def _no_start_reason(tried: int | None) -> Reason:
    """Return the reason for UNKNOWN after ``tried`` starts; None where none is sampled."""
    if tried is None:
        return ReasonKind.UNREAD()
    return ReasonKind.UNREAD_SAMPLED(tried) if tried else ReasonKind.UNREAD_NO_STATE()


def show_none(question: SearchProblem, search_options: SearchOptions) -> SearchStep:
    """Show that no drive on the grid answers the question, within limits that are printed.

    NONE-WITHIN, or WITNESSED where the exact encoding has a solution that is judged a witness after all,
    or UNKNOWN. Raises as ``find_witness``.
    """
    return _GridSearch(replace(question, start=None), search_options, ()).none()


def _search_shortest(
    question: SearchProblem, search_options: SearchOptions, unlike: tuple[Drive, ...]
) -> SearchStep:
    """Find the fewest steps for which a drive exists, by bisection; each drive is judged by itself."""
    search_options = replace(search_options, objective="smooth")
    best = find_witness(question, search_options, unlike)
    if best.witness is None:
        return best
    low, high = 0, question.grid.steps
    while high - low > 1:
        middle = (low + high) // 2
        shorter = replace(question, grid=Grid(question.grid.dt, middle))
        answer = _GridSearch(shorter, replace(search_options, refinements=0, explain=False), unlike).run()
        if (
            answer.witness is not None
            and answer.witness.assumptions.natural == best.witness.assumptions.natural
        ):
            best, high = answer, middle
        else:
            low = middle
    return best


def _search_typical(
    question: SearchProblem, search_options: SearchOptions, unlike: tuple[Drive, ...]
) -> SearchStep:
    """Find a drive that fulfils all wishes, else one that fulfils those that are found together in turn.

    Wishes decide which drive is found, and never whether one is found.
    """
    units = min(WISHING, search_options.effort.units)
    effort = search_options.effort.with_units(units)
    brief = replace(search_options, effort=effort, refinements=1, explain=False)
    wishes = wished_formulas(question.query, question.road, question.values, question.grid)

    def with_wishes(chosen: Sequence[Formula]) -> SearchStep:
        """Search among natural drives for one that fulfils some wishes, too."""
        query = replace(question.query, formula=conjunction(question.query.formula, *chosen))
        return _GridSearch(replace(question, query=query), brief, unlike, only_natural=True).run()

    typical = with_wishes(wishes) if wishes else None
    if typical is not None and typical.witness is not None:
        return typical
    best = _GridSearch(question, search_options, unlike).run()
    chosen: list[Formula] = []
    for wish in wishes if best.witness is not None else ():
        attempt = with_wishes([*chosen, wish]) if len(chosen) + 1 < len(wishes) else None
        if attempt is not None and attempt.witness is not None:
            best, chosen = attempt, [*chosen, wish]
    return best


def complaint_about(
    question: SearchProblem, formula: Formula, drive: Drive, grid: Grid, assumptions: Assumptions
) -> Reason | None:
    """Return why a drive that solves a problem on a grid is no witness of a bound formula, or None."""
    breach = first_breach(drive, question.vehicles, None, question.road.line)
    if breach is not None:
        return ReasonKind.BREACH(breach)
    overlap = None if assumptions.collisions else first_overlap(drive, grid.horizon)
    if overlap is not None:
        return ReasonKind.OVERLAP(overlap)
    if not judge(formula, drive).holds:
        return ReasonKind.BETWEEN_SAMPLES(grid.dt)
    return None


class _GridSearch:
    """One search over assignments of lanes, grids and assumptions."""

    def __init__(
        self,
        question: SearchProblem,
        search_options: SearchOptions,
        unlike: tuple[Drive, ...],
        only_natural: bool = False,
    ) -> None:
        self.question = question
        self.only_natural = only_natural
        self.search_options = search_options
        self.unlike = unlike
        self.seconds: dict[str, float] = {}
        self.sizes: dict[str, int] = {}
        self.meter = search_options.effort.meter()
        self.unknown = NO_REASON
        self.unknowns: list[Reason] = []
        self.encoded: dict[tuple[Formula, Grid, Margin, bool], Circuit[ColumnInequality]] = {}

    def run(self) -> SearchStep:
        """Return the first judged witness, or else NONE-WITHIN or UNKNOWN."""
        for lanes, grid, assumptions in self._attempts():
            if self.meter.is_exhausted():
                return self._answer(Verdict.UNKNOWN, None, self.meter.reason())
            witness = self._attempt(lanes, grid, assumptions)
            if witness is not None:
                return self._answer(Verdict.WITNESSED, witness, NO_REASON)
        if self.meter.is_exhausted():
            return self._answer(Verdict.UNKNOWN, None, self.meter.reason())
        unknown = self.unknowns[-1] if self.unknowns else NO_REASON
        if not self.search_options.explain or self.question.start is not None:
            answer = self._answer(Verdict.UNKNOWN, None, unknown or ReasonKind.NONE_FOUND())
            return replace(answer, exhausted=not unknown)
        answer = self.none()
        return replace(answer, reason=unknown) if unknown and answer.verdict is Verdict.UNKNOWN else answer

    def _answer(self, verdict: DriveVerdict, witness: FoundDrive | None, reason: Reason) -> SearchStep:
        return SearchStep(verdict, witness, reason, self.seconds, self.sizes)

    def _attempts(self) -> Iterator[tuple[Mapping[str, str], Grid, Assumptions]]:
        """Yield natural drives on the grid and on finer ones, then all that the limits allow.

        Where a start at s = 0 does not stand for all, other starts come after it.
        """
        for group in self._groups():
            for lanes, assumptions in product(self.question.lanes, group):
                for halvings in range(self.search_options.refinements + 1):
                    self.unknown = NO_REASON
                    yield lanes, self.question.grid.finer(2**halvings), assumptions
                    if not self.unknown:
                        break
                    self.unknowns.append(self.unknown)

    def _groups(self) -> Iterator[list[Assumptions]]:
        natural = (
            [*self._straightest(), self.question.assumptions] if self.question.assumptions.natural else []
        )
        if natural:
            yield natural
            if self.question.starts is not None:
                yield [replace(assumptions, starts=self.question.starts) for assumptions in natural]
        if self.only_natural:
            return
        yield [replace(self.question.assumptions.without_comfort(), starts=self.question.starts)]

    def _straightest(self) -> Iterator[Assumptions]:
        """Yield assumptions under which few vehicles change lanes first: easier to read, and to find."""
        names = tuple(self.question.vehicles)
        for count in range(len(names)):
            for movers in combinations(names, count):
                yield replace(self.question.assumptions, straight=frozenset(names) - set(movers))

    def _attempt(self, lanes: Mapping[str, str], grid: Grid, assumptions: Assumptions) -> FoundDrive | None:
        start = time.perf_counter()
        description = self._description(lanes, grid, assumptions)
        report_stage("encode", description)
        formula = self.question.bound(lanes)
        problem, layout = self._problem(self.question.formula_for_engine(lanes), grid, assumptions)
        self.sizes = problem.sizes()
        start = self._spent("encode", start)
        report_stage("solve", description)
        solution = self._solve(problem)
        start = self._spent("solve", start)
        if solution.status != "found":
            self.unknown = ReasonKind.SOLVER_GAVE_UP() if solution.status == "unknown" else self.unknown
            return None
        report_stage("shape", description)
        for drive in self._drives(problem, layout, solution, formula):
            start = self._spent("shape", start)
            report_stage("judge", description)
            complaint = complaint_about(self.question, formula, drive, grid, assumptions)
            start = self._spent("judge", start)
            if complaint is None:
                return FoundDrive(drive, lanes, formula, grid, assumptions)
            self.unknown = complaint
        return None

    def _problem(
        self, formula: Formula, grid: Grid, assumptions: Assumptions
    ) -> tuple[Problem, ColumnLayout]:
        vehicles = self.question.vehicles
        layout = ColumnLayout(tuple(vehicles), grid, custom_signal_ranges(formula))
        key = (formula, grid, assumptions.margin, assumptions.last_sample_persists)
        if key not in self.encoded:
            self.encoded[key] = encode_formula(formula, vehicles, layout, assumptions)
        problem = assemble_problem(self.encoded[key], self.question.road, vehicles, layout, assumptions)
        if self.question.start is not None:
            problem = problem.also(encode_start(self.question.start, layout))
        for other in self.unlike:
            problem = problem.also(differs_from(layout, other))
        return problem, layout

    def _solve(self, problem: Problem) -> ColumnValues:
        if self.search_options.engine == "smt":
            return solve_exactly(problem, self.meter.part(max(LEAST_EXACT, self.meter.left() / 3)))
        try:
            return solve_mixed(
                problem, column_box(problem), solver=self.search_options.solver, meter=self.meter
            )
        except TooNonlinearError:
            raise UsageError(
                "the formula has a comparison of degree above 2, which the engine milp cannot bound: "
                "use the engine smt"
            ) from None

    def _drives(
        self, problem: Problem, layout: ColumnLayout, solution: ColumnValues, formula: Formula
    ) -> Iterator[Drive]:
        """Yield the solver's solution in a smoother shape, then unchanged."""
        vehicles = self.question.vehicles
        floats = tuple(float(v) for v in solution.values)
        if self.search_options.objective != "any":
            depths: tuple[ColumnInequality, ...] = ()
            if self.search_options.objective in ("mild", "severe"):
                depths = violation_depths(formula, vehicles, layout, floats)
            objective, road = self.search_options.objective, self.question.road
            shaped = reshape(problem, layout, road, vehicles, floats, objective, depths)
            yield round_drive(layout, vehicles, shaped, fixed_start=self.question.start)
        yield round_drive(layout, vehicles, floats, fixed_start=self.question.start)
        if self.search_options.engine == "smt":
            yield round_drive(layout, vehicles, solution.values, None)

    def none(self) -> SearchStep:
        """Show that no drive exists on the grid: by a relaxation, else by the exact encoding."""
        start = time.perf_counter()
        assumptions = replace(self.question.assumptions.relaxed(), starts=self.question.starts)
        how = set()
        for lanes in self.question.lanes:
            formula = self.question.bound(lanes)
            report_stage("refute", self._description(lanes, self.question.grid, assumptions))
            problem, layout = self._problem(formula, self.question.grid, assumptions)
            by, exact = self._refute(problem)
            start = self._spent("refute", start)
            if exact is not None:
                drive = round_drive(layout, self.question.vehicles, exact, None)
                complaint = complaint_about(self.question, formula, drive, self.question.grid, assumptions)
                if complaint is None:
                    witness = FoundDrive(drive, lanes, formula, self.question.grid, assumptions)
                    return self._answer(Verdict.WITNESSED, witness, NO_REASON)
                return self._answer(Verdict.UNKNOWN, None, complaint)
            if not by:
                shown = ", ".join(f"{k}={v}" for k, v in lanes.items()) or self.question.road.name
                return self._answer(Verdict.UNKNOWN, None, ReasonKind.NEITHER(shown))
            how.add(by)
        limits = self.question.limits(how)
        return replace(self._answer(Verdict.NONE_WITHIN, None, ReasonKind.TOLD(limits.text())), limits=limits)

    def _refute(self, problem: Problem) -> tuple[str, Sequence[float | Fraction] | None]:
        """Return how ``problem`` was shown infeasible ('' if not), and a solution if one was found."""
        if self.search_options.engine == "milp":
            try:
                box = column_box(problem)
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

    def _description(self, lanes: Mapping[str, str], grid: Grid, assumptions: Assumptions) -> str:
        """Return a description of grid, lanes and assumptions for progress messages."""
        among = [f"dt={grid.dt} s up to {grid.horizon} s", *(f"{k}={v}" for k, v in lanes.items())]
        natural = ["natural drives"] if assumptions.natural else []
        straight = [f"{' and '.join(sorted(assumptions.straight))} straight"] if assumptions.straight else []
        return ", ".join([*among, *natural, *straight])

    def _spent(self, stage: str, start: float) -> float:
        now = time.perf_counter()
        self.seconds[stage] = self.seconds.get(stage, 0.0) + now - start
        return now
