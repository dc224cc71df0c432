"""Tries to falsify a bounded claim between its samples, with drives judged in dense, unbounded time.

A search on a grid reads a formula at samples. Before it answers that no drive within its limits falsifies
a claim, drives within these limits are judged: given ones, sampled ones, and solutions of weaker problems,
which close the inequalities of one part of the denied claim or read all of it twice as often.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction
from itertools import combinations, permutations

from roadproof.engines.encode.build import assemble_problem, encode_formula, road_constraints
from roadproof.engines.encode.motion import ColumnLayout, custom_signal_ranges
from roadproof.engines.encode.problem import (
    Circuit,
    ColumnInequality,
    ColumnValues,
    Leaf,
    LimitKind,
    Origin,
    Problem,
    Row,
    all_of,
    evaluate,
    replace_leaves,
    row_of,
)
from roadproof.engines.encode.unroll import Grid
from roadproof.engines.search.drive_search import as_judged_drive
from roadproof.engines.search.enumeration import short_satisfying_drive
from roadproof.engines.search.question import FoundDrive, SearchProblem, pose
from roadproof.engines.search.shape import round_drive
from roadproof.engines.setting import Search
from roadproof.engines.solve.bounds import TooNonlinearError
from roadproof.engines.solve.exact import solve_exactly
from roadproof.engines.solve.milp import column_box, solve_mixed
from roadproof.errors import UsageError
from roadproof.evidence.judged import JudgedDrive
from roadproof.logic.custom_names import custom_signals_of
from roadproof.logic.formula import Formula
from roadproof.logic.initial_conditions import top_level_conjuncts
from roadproof.runtime.budget import Budget
from roadproof.runtime.progress import report_stage
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.world.drive import Drive
from roadproof.world.motion import piece_starts, states_at
from roadproof.world.polynomial import affine
from roadproof.world.signals import STARTING, SignalName

# Units of work for all weaker problems, and for one of them.
WEAKER, EACH = 6.0, 1.5
MOST_PARTS = 8  # of a denied claim that are closed one at a time


def falsifying_drive(search: Search, given: Iterable[Drive] = ()) -> JudgedDrive | None:
    """Return a judged drive within the limits of ``search`` on which its formula holds, or None.

    ``given``: drives that are tried first, under every naming of their vehicles. Raises ``BudgetExceeded``,
    ``MissingSolverError``.
    """
    question = pose(search.specification.library, search.query, search.setting)
    report_stage("judge", "drives within the limits, in dense time")
    clock = search.search_options.effort.meter()
    has_own = bool(custom_signals_of([search.query.formula]))
    for drive in () if has_own else _cast(given, tuple(question.vehicles)):
        clock.seconds_left()
        judged = _judged(search, question, drive)
        if judged is not None:
            return judged
    if not has_own:
        sampled = short_satisfying_drive(
            search.specification, question, lambda drive: keeps_limits(question, drive), clock
        )
        if sampled is not None:
            return sampled
    meter = clock.part(WEAKER)
    for drive in _weaker_solutions(search, question, meter):
        judged = _judged(search, question, drive)
        if judged is not None:
            return judged
    return None


def keeps_limits(question: SearchProblem, drive: Drive) -> bool:
    """Return whether a NONE-WITHIN of ``question`` excludes this drive, whatever its pieces.

    Sizes, speeds and accelerations are those of the vehicles; starts are within reach; nothing accelerates
    after the horizon; at the samples boxes are on the road and, unless collisions are allowed, apart.
    """
    if drive.vehicles.keys() != question.vehicles.keys():
        return False
    for name, model in question.vehicles.items():
        motion = drive.vehicles[name]
        *_, last = piece_starts(motion)
        if (motion.length, motion.width, motion.kind) != (model.length, model.width, model.kind):
            return False
        if motion.has_jerk or last.time > question.grid.horizon or last.a_lon or last.a_lat:
            return False
    fronts = [motion.s for motion in drive.vehicles.values()]
    reach = question.assumptions.reach
    if any(abs(a - b) > reach for a, b in combinations(fronts, 2)):
        return False
    if question.starts is not None and not all(question.starts[0] <= s <= question.starts[1] for s in fronts):
        return False
    if not question.assumptions.collisions and first_overlap(drive, question.grid.horizon) is not None:
        return False
    breach = first_breach(drive, question.vehicles, None, question.road.line)
    return breach is None and _is_on_road(question, drive)


def _is_on_road(question: SearchProblem, drive: Drive) -> bool:
    """Return whether boxes are where they have to be at all samples, exactly."""
    grid = question.grid
    layout = ColumnLayout(tuple(question.vehicles), grid)
    times = [step * grid.dt for step in range(grid.steps + 1)]
    values: list[Fraction] = []
    for name in layout.vehicles:
        states = list(states_at(drive.vehicles[name], times))
        values += [getattr(state, signal) for signal in STARTING for state in states]

    def holds(inequality: ColumnInequality) -> bool:
        value = inequality.polynomial.value(lambda column: values[column])
        return value > 0 if inequality.strict else value >= 0

    around = road_constraints(question.road, question.vehicles, layout, question.assumptions.relaxed())
    return all(evaluate(part, holds) for part in around)


def _cast(given: Iterable[Drive], names: tuple[str, ...]) -> Iterator[Drive]:
    """The drives with their vehicles called by ``names`` in every way, each naming once."""
    for drive in given:
        if drive.custom_signals:
            continue
        for chosen in permutations(drive.vehicles, len(names)):
            yield drive.cast(dict(zip(names, chosen, strict=True)))


def _judged(search: Search, question: SearchProblem, drive: Drive) -> JudgedDrive | None:
    """The drive as judged evidence where it keeps the limits and the formula holds on it."""
    for lanes in question.lanes:
        formula = question.bound(lanes)
        if judge(formula, drive).holds and keeps_limits(question, drive):
            candidate = FoundDrive(drive, lanes, formula, question.grid, question.assumptions)
            return as_judged_drive(search, question, candidate)
    return None


# --- solutions of weaker problems -------------------------------------------------------------------


def _weaker_solutions(search: Search, question: SearchProblem, meter: Budget) -> Iterator[Drive]:
    """Drives that satisfy weaker problems than the formula on its grid, as found and with rounded speeds."""
    vehicles = question.vehicles
    for problem, layout in _weaker_problems(question):
        if meter.is_exhausted():
            return
        try:
            solution = _solve(search, problem, meter)
        except (TooNonlinearError, UsageError):
            continue
        if solution.status != "found":
            continue
        for grain in (Fraction(1, 1000), None):
            yield round_drive(layout, vehicles, solution.values, grain)


def _solve(search: Search, problem: Problem, meter: Budget) -> ColumnValues:
    options = search.search_options
    if options.engine == "smt":
        return solve_exactly(problem, meter.part(EACH))
    return solve_mixed(problem, column_box(problem), solver=options.solver, meter=meter.part(EACH))


def _weaker_problems(question: SearchProblem) -> Iterator[tuple[Problem, ColumnLayout]]:
    for lanes in question.lanes:
        formula = question.bound(lanes)
        parts = tuple(top_level_conjuncts(formula))
        choices: list[frozenset[Formula]] = [frozenset({part}) for part in parts[:MOST_PARTS]]
        for closed in dict.fromkeys([*choices, frozenset(parts)]):
            yield _problem(question, formula, question.grid, lambda x, c=closed: x in c)  # type: ignore[misc]
        problem, layout = _problem(question, formula, question.grid.finer(2), lambda _: False)
        yield Problem(problem.columns, (*problem.rows, *_steady_pairs(layout)), problem.circuit), layout


def _problem(
    question: SearchProblem, formula: Formula, grid: Grid, is_closed: Callable[[Formula], bool]
) -> tuple[Problem, ColumnLayout]:
    """The formula on a grid, those of its parts closed that ``is_closed`` chooses."""
    vehicles: Mapping[str, object] = question.vehicles
    layout = ColumnLayout(tuple(vehicles), grid, custom_signal_ranges(formula))
    assumptions = replace(question.assumptions.without_comfort(), starts=question.starts)
    circuits: list[Circuit[ColumnInequality]] = []
    for part in top_level_conjuncts(formula):
        circuit = encode_formula(part, question.vehicles, layout, assumptions)
        circuits.append(_closed(circuit) if is_closed(part) else circuit)
    return assemble_problem(all_of(circuits), question.road, question.vehicles, layout, assumptions), layout


def _closed(circuit: Circuit[ColumnInequality]) -> Circuit[ColumnInequality]:
    """Every strict inequality with its boundary, which samples may lie on."""
    return replace_leaves(circuit, lambda x: Leaf(replace(x, strict=False, margin=Fraction(0))))


def _steady_pairs(layout: ColumnLayout) -> Iterator[Row]:
    """Yield rows that equate the accelerations of two successive steps, as on a grid of twice the step."""
    rates: tuple[SignalName, ...] = ("v_lon", "v_lat")
    for name in layout.vehicles:
        for signal in rates:
            for step in range(0, layout.grid.steps, 2):
                before, between, after = (layout.column(name, signal, step + k) for k in range(3))
                ends = [(before, Fraction(1)), (between, Fraction(-2)), (after, Fraction(1))]
                yield row_of(affine(ends), Fraction(0), Fraction(0), Origin(LimitKind.STEADY, step, (name,)))
