"""Reuses drives between scenarios that differ only in their road sectors.

Reuse needs no solver: the drive of the first scenario is put on the road of the other and judged there.
So ``witness`` finds the same drive for a scenario whether it runs alone or with others.
"""

from dataclasses import replace
from typing import TYPE_CHECKING

from roadproof.engines.encode.build import road_constraints
from roadproof.engines.encode.motion import ColumnLayout
from roadproof.engines.encode.problem import evaluate
from roadproof.engines.search.question import FoundDrive, SearchProblem, pose
from roadproof.engines.search.usual_road import zones_of
from roadproof.engines.setting import SearchOptions, Setting
from roadproof.engines.solve.bounds import polynomial_value
from roadproof.errors import InputError, UsageError
from roadproof.library.scenarios import Scenario, apply_scenario
from roadproof.library.sector_twins import sector_twin
from roadproof.library.specification import Query, Specification
from roadproof.logic.rewrite import parameters_of
from roadproof.semantics.exact.judging import judge
from roadproof.world.motion import states_at
from roadproof.world.signals import STARTING

if TYPE_CHECKING:
    from roadproof.engines.search.search import SearchStep

ROUNDED = 0.01  # m and m/s; by how much a drive of rounded numbers may miss what it was looked for under
MOST = 64  # of the searches whose outcome a process remembers

_remembered: dict[object, "SearchStep"] = {}


def find_once(question: SearchProblem, search_options: SearchOptions) -> "SearchStep":
    """Run ``find_witness`` with a cache: one search for equal formulas, also of several spec sets.

    Only for questions on the usual road, which have no start.
    """
    key = _key(question, search_options)
    if key in _remembered:
        return _remembered[key]
    from roadproof.engines.search.search import find_witness  # here: what is known needs no numpy

    attempt = find_witness(question, search_options)
    if len(_remembered) >= MOST:
        _remembered.clear()
    _remembered[key] = replace(attempt, seconds={})
    return attempt


def _key(question: SearchProblem, search_options: SearchOptions) -> object:
    """All that an outcome of ``find_witness`` depends on."""
    bound = tuple((tuple(lanes.items()), question.bound(lanes)) for lanes in question.lanes)
    place = question.road, tuple(question.vehicles.items()), question.grid, question.assumptions
    spoken = {name: question.values[name] for name in sorted(parameters_of(question.query.formula))}
    return bound, place, tuple(spoken.items()), search_options


def drive_of_twin(
    specification: Specification,
    number: int,
    question: SearchProblem,
    setting: Setting,
    search_options: SearchOptions,
) -> "SearchStep | None":
    """Return the drive of the first scenario that differs only in its road sector, judged for this question.

    None where no such scenario exists, where it cannot be posed with this ``setting`` or has other vehicles,
    and where its drive does not answer this question. Raises ``MissingSolverError``, ``BudgetExceeded``.
    """
    first = _first_twin(specification, number, question.query, setting)
    if first is None:
        return None
    try:
        twin_question = pose(specification.library, apply_scenario(specification, first), setting)
        if twin_question.vehicles != question.vehicles:
            return None
        attempt = find_once(twin_question, search_options)
    except (InputError, UsageError):
        return None
    put = None if attempt.witness is None else move_to_road(question, attempt.witness)
    return None if put is None else replace(attempt, witness=put)


def _first_twin(specification: Specification, number: int, query: Query, setting: Setting) -> Scenario | None:
    """The scenario that is asked first; None on the main road, and where road or lanes are chosen."""
    if setting.road is not None or setting.lanes or zones_of(query.formula) <= {"main"}:
        return None
    first = sector_twin(specification, number)
    return None if first == number else Scenario(first, specification.set_name)


def move_to_road(question: SearchProblem, candidate: FoundDrive) -> FoundDrive | None:
    """Return the candidate with the formula of ``question``, or None where its drive does not answer that.

    The drive stays as it is. It must satisfy the formula, and its lanes must be a choice of the question.
    At samples it must keep that road and the candidate's own assumptions, up to ``ROUNDED``. Both must
    have the same vehicles, which is not checked.
    """
    if candidate.lanes not in question.lanes or not _keeps(question, candidate):
        return None
    formula = question.bound(candidate.lanes)
    return replace(candidate, formula=formula) if judge(formula, candidate.drive).holds else None


def _keeps(question: SearchProblem, candidate: FoundDrive) -> bool:
    """Return whether the drive keeps road, clearance and lanes as assumed, up to rounding."""
    layout = ColumnLayout(tuple(question.vehicles), candidate.grid)
    times = [step * candidate.grid.dt for step in range(candidate.grid.steps + 1)]
    values: list[float] = []
    for name in layout.vehicles:
        states = states_at(candidate.drive.vehicles[name], times)
        values += [float(getattr(state, signal)) for signal in STARTING for state in states]
    around = road_constraints(question.road, question.vehicles, layout, candidate.assumptions)
    return all(evaluate(part, lambda x: polynomial_value(x, values) >= -ROUNDED) for part in around)
