"""Runs a search for drives and returns a typed outcome."""

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from roadproof.engines.modifier import Modifier, find_modifier
from roadproof.engines.search.initial_candidates import is_encodable
from roadproof.engines.search.outcome import SearchOutcome
from roadproof.engines.search.question import FoundDrive, SearchProblem, pose
from roadproof.engines.search.siblings import drive_of_twin, find_once
from roadproof.engines.setting import Search
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import used_values
from roadproof.reasons import NO_REASON, ReasonKind, joined
from roadproof.runtime.budget import BudgetExceeded, Effort
from roadproof.runtime.progress import about, report_stage
from roadproof.runtime.timing import now, seconds_since
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.engines.search.search import SearchStep

TRIES, AGAIN = 5, 8.0
"""Drives to which a modifier of the question may object, and units of work for each after one."""
# Units of work for a proof that there is none; and where no engine reads all, which is hard to prove, too.
NEVER, NEVER_UNREAD = 10.0, 2.0


def engine_reads_all(search: Search) -> bool:
    """Return whether the engine can encode the question. Raises ``UsageError``, ``InputError``."""
    question = pose(search.specification.library, search.query, search.setting)
    return search.search_options.engine == "smt" or is_encodable(question)


def search_drive(search: Search) -> SearchOutcome:
    """Search for a drive, and else for a proof that there is none.

    Raises ``InputError``, ``UsageError``, ``MissingSolverError``, ``BudgetExceeded``.
    """
    with about(_title(search)):
        return _search_drive(search)


def _title(search: Search) -> str:
    number = search.scenario
    what = search.query.text if number is None else f"scenario {number}"
    return f"{what} {search.specification.set_name}"


def _search_drive(search: Search) -> SearchOutcome:
    started = now()
    options = replace(search.search_options, effort=search.search_options.effort.with_clock_started())
    search = replace(search, search_options=options)
    library = search.specification.library
    question = pose(library, search.query, search.setting)
    objections: list[str] = []
    first = _attempt(question, search, objections)
    judged = () if first.witness is None else (as_judged_drive(search, question, first.witness),)
    impossibility = None
    if first.witness is None and not objections and not search.unlike:
        effort = search.search_options.effort
        most = effort.with_units(
            max(1.0, min(NEVER if is_encodable(question) else NEVER_UNREAD, effort.units))
        )
        report_stage("explain", "is there a proof that there is none")
        from roadproof.engines.search.impossible import show_impossible

        impossibility = show_impossible(search.specification, search.query, most)
    return SearchOutcome(
        search.scenario,
        search.specification.set_name,
        search.query,
        question.road.name,
        Verdict.IMPOSSIBLE if impossibility else first.verdict,
        NO_REASON if impossibility else first.reason,
        judged,
        first.witness is not None and first.witness.assumptions.natural,
        {**first.seconds, "all": seconds_since(started)},
        first.sizes,
        impossibility,
        None if impossibility else first.limits,
        first.exhausted and impossibility is None,
    )


def _attempt(question: SearchProblem, search: Search, objections: list[str]) -> "SearchStep":
    """Search, or take the drive of the scenario's twin where it answers this question, too.

    ``objections`` collects those of a modifier to drives that were found.
    """
    from roadproof.engines.search.search import find_witness  # here: what is known needs no numpy

    modifier = find_modifier(search.specification.options)
    objector = None if modifier is None else modifier.objector(search, question)
    if modifier is not None and objector is not None:
        return _modified(question, search, modifier, objector, objections)
    if search.unlike or search.scenario is None or search.setting.road is not None:
        return find_witness(question, search.search_options, search.unlike)
    started, options = search.search_options.effort.meter(), search.search_options
    sibling = None
    if options.objective != "typical":  # what is typical depends on the road
        sibling = drive_of_twin(search.specification, search.scenario, question, search.setting, options)
    if sibling is None and options.effort.timeout is not None:
        options = replace(options, effort=Effort(options.effort.units, started.seconds_left()))
    return sibling or find_once(question, options)


def _modified(
    question: SearchProblem,
    search: Search,
    modifier: Modifier,
    objector: Callable[[FoundDrive], str],
    objections: list[str],
) -> "SearchStep":
    """Search for a drive to which the modifier does not object; ``objections`` collects its objections."""
    from roadproof.engines.search.search import SearchStep, find_witness

    drives = list(search.unlike)
    options = search.search_options
    late = NO_REASON
    while len(objections) < TRIES:
        if objections:
            options = replace(options, effort=options.effort.with_units(min(AGAIN, options.effort.units)))
        try:
            attempt = find_witness(question, options, tuple(drives))
        except BudgetExceeded as error:
            if not objections:
                raise
            late = error.reason
            break
        if attempt.witness is None:
            if not objections:
                return attempt
            break
        drives.append(attempt.witness.drive)
        objection = objector(attempt.witness)
        if not objection:
            return attempt
        objections.append(objection)
    reason = ReasonKind.NOT_DRIVEN(len(objections), modifier.word, "; ".join(objections))
    return SearchStep(Verdict.UNKNOWN, None, joined((reason, late)))


def as_judged_drive(search: Search, question: SearchProblem, candidate: FoundDrive) -> JudgedDrive:
    """Return a found drive as a drive file that the exact judge confirms once more."""
    library = search.specification.library
    file = DriveFile(
        search.scenario,
        search.specification.set_name,
        search.query.text,
        candidate.grid.horizon,
        candidate.lanes,
        used_values(library, search.query.formula, question.values),
        search.specification.options,
        question.road,
        candidate.drive,
        candidate.assumptions.collisions,
    )
    return JudgedDrive(file, library, candidate.assumptions.natural)
