"""A search for drives of values, and its typed outcome."""

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from roadproof.engines.modifier import Modifier, modifier_of
from roadproof.engines.search.initial_candidates import is_read
from roadproof.engines.search.outcome import Outcome, Search, undecided
from roadproof.engines.search.question import FoundDrive, SearchProblem, pose
from roadproof.engines.search.siblings import find_once, offered
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import telling_values
from roadproof.reasons import NO_REASON, Why
from roadproof.runtime.budget import BudgetExceeded, Effort
from roadproof.runtime.progress import about, begin
from roadproof.runtime.timing import now, since
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.engines.search.search import Attempt

TRIES, AGAIN = 5, 8.0
"""Drives to which a modifier of the question may object, and units of work for each after one."""
# Units of work for a proof that there is none; and where no engine reads all, which is hard to prove, too.
NEVER, NEVER_UNREAD = 10.0, 2.0


def answer(search: Search) -> Outcome:
    """As ``ask``, but UNKNOWN with that reason where the clock cuts it off."""
    begun = now()
    try:
        return ask(search)
    except BudgetExceeded as late:
        return undecided(search, late.reason, since(begun))


def reads_all(search: Search) -> bool:
    """Whether the engine can read what is asked. Raises ``UsageError``, ``InputError``."""
    question = pose(search.specification.library, search.query, search.setting)
    return search.search_options.engine == "smt" or is_read(question)


def ask(search: Search) -> Outcome:
    """Search. Raises ``InputError``, ``UsageError``, ``MissingSolverError``, ``BudgetExceeded``."""
    with about(_called(search)):
        return _ask(search)


def _called(search: Search) -> str:
    number = search.scenario
    what = search.query.text if number is None else f"scenario {number}"
    return f"{what} {search.specification.set_name}"


def _ask(search: Search) -> Outcome:
    begun = now()
    options = replace(search.search_options, effort=search.search_options.effort.running())
    search = replace(search, search_options=options)
    library = search.specification.library
    question = pose(library, search.query, search.setting)
    objections: list[str] = []
    first = _attempt(question, search, objections)
    judged = () if first.found is None else (judge_found(search, question, first.found),)
    impossibility = None
    if first.found is None and not objections and not search.unlike:
        effort = search.search_options.effort
        most = effort.of(max(1.0, min(NEVER if is_read(question) else NEVER_UNREAD, effort.units)))
        begin("explain", "is there a proof that there is none")
        from roadproof.engines.search.impossible import show_impossible

        impossibility = show_impossible(search.specification, search.query, most)
    return Outcome(
        search.scenario,
        search.specification.set_name,
        search.query,
        question.road.name,
        Verdict.IMPOSSIBLE if impossibility else first.verdict,
        NO_REASON if impossibility else first.reason,
        judged,
        first.found is not None and first.found.assumptions.natural,
        {**first.seconds, "all": since(begun)},
        first.sizes,
        impossibility,
        None if impossibility else first.limits,
        first.exhausted and impossibility is None,
    )


def _attempt(question: SearchProblem, search: Search, objections: list[str]) -> "Attempt":
    """What a search comes to; a scenario takes the drive of its sibling where that answers it too.

    ``objections`` of a modifier to drives that were found are added.
    """
    from roadproof.engines.search.search import find_witness  # here: what is known needs no numpy

    modifier = modifier_of(search.specification.options)
    objector = None if modifier is None else modifier.objector(search, question)
    if modifier is not None and objector is not None:
        return _modified(question, search, modifier, objector, objections)
    if search.unlike or search.scenario is None or search.setting.road is not None:
        return find_witness(question, search.search_options, search.unlike)
    begun, options = search.search_options.effort.meter(), search.search_options
    sibling = offered(search.specification, search.scenario, question, search.setting, options)
    if sibling is None and options.effort.timeout is not None:
        options = replace(options, effort=Effort(options.effort.units, begun.seconds_left()))
    return sibling or find_once(question, options)


def _modified(
    question: SearchProblem,
    search: Search,
    modifier: Modifier,
    objector: Callable[[FoundDrive], str],
    objections: list[str],
) -> "Attempt":
    """What a search comes to without drives to which a modifier of the question objects."""
    from roadproof.engines.search.search import Attempt, find_witness

    drives = list(search.unlike)
    options = search.search_options
    while len(objections) < TRIES:
        if objections:
            options = replace(options, effort=options.effort.of(min(AGAIN, options.effort.units)))
        try:
            attempt = find_witness(question, options, tuple(drives))
        except BudgetExceeded:
            if not objections:
                raise
            break
        if attempt.found is None:
            if not objections:
                return attempt
            break
        drives.append(attempt.found.drive)
        objection = objector(attempt.found)
        if not objection:
            return attempt
        objections.append(objection)
    reason = Why.NOT_DRIVEN(len(objections), modifier.word, "; ".join(objections))
    return Attempt(Verdict.UNKNOWN, None, reason)


def judge_found(search: Search, question: SearchProblem, found: FoundDrive) -> JudgedDrive:
    """A drive that was found as a drive file, judged once more from what it says."""
    library = search.specification.library
    file = DriveFile(
        search.scenario,
        search.specification.set_name,
        search.query.text,
        found.grid.horizon,
        found.lanes,
        telling_values(library, search.query.formula, question.values),
        search.specification.options,
        question.road,
        found.drive,
        found.assumptions.collisions,
    )
    return JudgedDrive(file, library, found.assumptions.natural)
