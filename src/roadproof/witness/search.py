"""The loop: solve, shape, round, replay, judge; on a no look closer, or say that we do not know."""

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import combinations, product

from roadproof.encode.build import Manners, build_problem
from roadproof.encode.motion import Layout
from roadproof.encode.problem import Problem
from roadproof.encode.unroll import Grid
from roadproof.errors import UsageError
from roadproof.judge.exact import judge
from roadproof.judge.replay import first_breach, first_overlap
from roadproof.logic.formula import Formula
from roadproof.solve.bounds import TooNonlinearError
from roadproof.solve.milp import Solution, box_of, solve_mixed
from roadproof.spec.bind import bind
from roadproof.spec.elaborate import Query
from roadproof.verdict import Verdict
from roadproof.witness.rounding import round_drive
from roadproof.witness.shape import Objective, reshape
from roadproof.world.drive import Drive
from roadproof.world.road import Road
from roadproof.world.vehicle import Vehicle


@dataclass(frozen=True)
class Question:
    """For which drive does ``query`` hold on ``road``? ``lanes`` are the assignments to be tried, in order."""

    query: Query
    road: Road
    vehicles: Mapping[str, Vehicle]
    values: Mapping[str, Fraction]
    lanes: tuple[Mapping[str, str], ...]
    grid: Grid
    manners: Manners = Manners()

    def bound(self, lanes: Mapping[str, str]) -> Formula:
        """The formula under one assignment of lanes."""
        return bind(self.query.formula, self.road, lanes, self.values)


@dataclass(frozen=True)
class Means:
    """How to search: engine, solver, objective, seconds for one answer, finer grids to try."""

    objective: Objective = "smooth"
    engine: str = "milp"
    solver: str = "highs"
    time_limit: float = 60.0
    refinements: int = 2


@dataclass(frozen=True)
class Found:
    """A judged drive, with the lanes it was judged under and the manners it keeps."""

    drive: Drive
    lanes: Mapping[str, str]
    formula: Formula
    grid: Grid
    manners: Manners


@dataclass(frozen=True)
class Answer:
    """WITNESSED with a drive, NONE-WITHIN or UNKNOWN with a reason; ``seconds`` by stage."""

    verdict: Verdict
    found: Found | None
    reason: str
    seconds: Mapping[str, float]
    sizes: Mapping[str, int]


def assignments(query: Query, road: Road, chosen: Mapping[str, str]) -> tuple[dict[str, str], ...]:
    """Every way to give the free lanes of ``query`` lanes of ``road`` that agrees with ``chosen``.

    Raises ``UsageError`` for a lane that the road does not have or the query does not speak of.
    """
    for name, lane in chosen.items():
        if lane not in road.lanes:
            raise UsageError(f"lane {name}={lane}: road '{road.name}' has the lanes {', '.join(road.lanes)}")
        if name not in query.lanes:
            known = ", ".join(query.lanes) or "no lane"
            raise UsageError(f"lane {name}={lane}: the formula speaks of {known}")
    options = [[chosen[name]] if name in chosen else list(road.lanes) for name in query.lanes]
    return tuple(dict(zip(query.lanes, lanes, strict=True)) for lanes in product(*options))


def find_witness(question: Question, means: Means) -> Answer:
    """Search for a drive; whatever is found has been judged exactly in dense and unbounded time."""
    return _Search(question, means).run()


class _Search:
    def __init__(self, question: Question, means: Means) -> None:
        self.question = question
        self.means = means
        self.seconds: dict[str, float] = {}
        self.sizes: dict[str, int] = {}
        self.deadline = time.monotonic() + means.time_limit
        self.rejected = ""

    def run(self) -> Answer:
        for lanes, grid, manners in self._attempts():
            if time.monotonic() > self.deadline:
                return self._answer(Verdict.UNKNOWN, None, f"no answer within {self.means.time_limit:g} s")
            found = self._attempt(lanes, grid, manners)
            if found is not None:
                return self._answer(Verdict.WITNESSED, found, "")
        return self._answer(Verdict.UNKNOWN, None, self.rejected or "no drive was found")

    def _answer(self, verdict: Verdict, found: Found | None, reason: str) -> Answer:
        return Answer(verdict, found, reason, self.seconds, self.sizes)

    def _attempts(self) -> Iterator[tuple[Mapping[str, str], Grid, Manners]]:
        """Natural drives first, on the grid and on finer ones; then whatever the limits allow."""
        plain = replace(self.question.manners, natural=False, margin=Fraction(1, 100))
        every = [plain]
        if self.question.manners.natural:
            every = [*self._straightest(), self.question.manners, plain]
        for manners in every:
            for halvings in range(self.means.refinements + 1):
                grid = Grid(self.question.grid.dt / 2**halvings, self.question.grid.steps * 2**halvings)
                before = self.rejected
                for lanes in self.question.lanes:
                    yield lanes, grid, manners
                if self.rejected == before:
                    break

    def _straightest(self) -> Iterator[Manners]:
        """The fewer vehicles change lanes, the easier a drive is to read, and to find."""
        names = tuple(self.question.vehicles)
        for count in range(len(names)):
            for movers in combinations(names, count):
                yield replace(self.question.manners, straight=frozenset(names) - set(movers))

    def _attempt(self, lanes: Mapping[str, str], grid: Grid, manners: Manners) -> Found | None:
        start = time.perf_counter()
        formula = self.question.bound(lanes)
        problem, layout = build_problem(formula, self.question.road, self.question.vehicles, grid, manners)
        self.sizes = problem.sizes()
        start = self._spent("encode", start)
        solution = self._solve(problem)
        start = self._spent("solve", start)
        if solution.status != "found":
            if solution.status == "unknown":
                self.rejected = "the solver gave up"
            return None
        for values in self._shapes(problem, layout, solution):
            start = self._spent("shape", start)
            drive = round_drive(layout, self.question.vehicles, values)
            complaint = self._complaint(formula, drive, grid, manners)
            start = self._spent("judge", start)
            if complaint is None:
                return Found(drive, lanes, formula, grid, manners)
            self.rejected = complaint
        return None

    def _solve(self, problem: Problem) -> Solution:
        left = max(0.1, self.deadline - time.monotonic())
        try:
            return solve_mixed(problem, box_of(problem), solver=self.means.solver, time_limit=left)
        except TooNonlinearError:
            raise UsageError(
                "the formula has a comparison of degree above 2, which --engine milp cannot bound: "
                "use --engine smt"
            ) from None

    def _shapes(self, problem: Problem, layout: Layout, solution: Solution) -> Iterator[tuple[float, ...]]:
        if self.means.objective != "any":
            yield reshape(
                problem,
                layout,
                self.question.road,
                self.question.vehicles,
                solution.values,
                self.means.objective,
            )
        yield solution.values

    def _complaint(self, formula: Formula, drive: Drive, grid: Grid, manners: Manners) -> str | None:
        """Why a drive is no witness, or None."""
        breach = first_breach(drive, self.question.vehicles, None)
        if breach is not None:
            return f"after rounding, {breach}"
        overlap = None if manners.collisions else first_overlap(drive, grid.horizon)
        if overlap is not None:
            return f"between the samples, {overlap}"
        if not judge(formula, drive).holds:
            return f"between the samples of dt={grid.dt} s the formula fails"
        return None

    def _spent(self, stage: str, start: float) -> float:
        now = time.perf_counter()
        self.seconds[stage] = self.seconds.get(stage, 0.0) + now - start
        return now
