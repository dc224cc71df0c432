"""Scenarios that differ only in their road sectors: the drive of the first is offered for the others.

An offer asks no solver: the drive is put on the road of the other scenario, and judged there. So ``witness``
finds the same drive for a scenario whether it is asked for alone or with others.
"""

from dataclasses import replace
from typing import TYPE_CHECKING

from roadproof.engines.encode.build import surroundings
from roadproof.engines.encode.motion import Layout
from roadproof.engines.encode.problem import evaluate
from roadproof.engines.search.question import (
    FoundDrive,
    SearchOptions,
    SearchProblem,
    Setting,
    pose,
    zones_of,
)
from roadproof.engines.solve.bounds import value_of
from roadproof.errors import InputError, UsageError
from roadproof.library.alike import like_of
from roadproof.library.scenarios import Scenario, applied
from roadproof.library.specification import Query, Specification
from roadproof.logic.rewrite import parameters_of
from roadproof.semantics.exact.exact import judge
from roadproof.world.motion import states_at
from roadproof.world.signals import STARTING

if TYPE_CHECKING:
    from roadproof.engines.search.search import Attempt

ROUNDED = 0.01  # m and m/s; by how much a drive of rounded numbers may miss what it was looked for under
MOST = 64  # of the searches whose outcome a process remembers

_remembered: dict[object, "Attempt"] = {}


def find_once(question: SearchProblem, search_options: SearchOptions) -> "Attempt":
    """As ``find_witness``; a process searches once for equal formulas, of several spec sets too.

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


def offered(
    specification: Specification,
    number: int,
    question: SearchProblem,
    setting: Setting,
    search_options: SearchOptions,
) -> "Attempt | None":
    """The drive of the first scenario that differs in its road sector only, judged for this one.

    None where there is no such scenario, where it cannot be asked for with this ``setting`` or is about other
    vehicles, and where its drive does not answer this question. Raises ``MissingSolverError``,
    ``BudgetExceeded``.
    """
    first = _first(specification, number, question.query, setting)
    if first is None:
        return None
    try:
        asked = pose(specification.library, applied(specification, first), setting)
        if asked.vehicles != question.vehicles:
            return None
        attempt = find_once(asked, search_options)
    except (InputError, UsageError):
        return None
    put = None if attempt.found is None else put_on(question, attempt.found)
    return None if put is None else replace(attempt, found=put)


def _first(specification: Specification, number: int, query: Query, setting: Setting) -> Scenario | None:
    """The scenario that is asked first; None on the main road, and where road or lanes are chosen."""
    if setting.road is not None or setting.lanes or zones_of(query.formula) <= {"main"}:
        return None
    first = like_of(specification, number)
    return None if first == number else Scenario(first, specification.set_name)


def put_on(question: SearchProblem, found: FoundDrive) -> FoundDrive | None:
    """The drive on the road of ``question``, where it answers that under the same assumptions; else None."""
    if found.lanes not in question.lanes or not _keeps(question, found):
        return None
    formula = question.bound(found.lanes)
    return replace(found, formula=formula) if judge(formula, found.drive).holds else None


def _keeps(question: SearchProblem, found: FoundDrive) -> bool:
    """Whether the drive is on the road, apart and in lanes as the assumptions say, but for rounding."""
    layout = Layout(tuple(question.vehicles), found.grid)
    times = [step * found.grid.dt for step in range(found.grid.steps + 1)]
    values: list[float] = []
    for name in layout.vehicles:
        states = states_at(found.drive.vehicles[name], times)
        values += [float(getattr(state, signal)) for signal in STARTING for state in states]
    around = surroundings(question.road, question.vehicles, layout, found.assumptions)
    return all(evaluate(part, lambda x: value_of(x, values) >= -ROUNDED) for part in around)
