"""A search for drives of values, and its typed outcome."""

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

from roadproof.drivers.restriction import restriction_of
from roadproof.engines.search.driven import Driven
from roadproof.engines.search.initial_candidates import is_read
from roadproof.engines.search.outcome import Outcome, Search, undecided
from roadproof.engines.search.question import FoundDrive, SearchProblem, pose
from roadproof.engines.search.siblings import find_once, offered
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import telling_values
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.runtime.budget import BudgetExceeded, Effort
from roadproof.runtime.progress import about, begin
from roadproof.runtime.timing import now, since
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive

if TYPE_CHECKING:
    from roadproof.engines.search.search import Attempt

TRIES, AGAIN = 5, 8.0
"""Drives of a restricted search to which a driver model may object, and units of work for each after one."""
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
    answers = list(_answers(question, search, objections))
    first = answers[0]
    judged = tuple(judge_found(search, question, a.found) for a in answers if a.found is not None)
    impossibility = None
    if first.found is None and not objections:
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
        NO_REASON if impossibility else _reason(answers, search.count),
        judged,
        first.found is not None and first.found.assumptions.natural,
        {**first.seconds, "all": since(begun)},
        first.sizes,
        impossibility,
        None if impossibility else first.limits,
        first.exhausted and impossibility is None,
    )


def _answers(question: SearchProblem, search: Search, objections: list[str]) -> Iterator["Attempt"]:
    """The answers to a search; a scenario takes the drive of its sibling where that answers it too.

    ``objections`` of a driver model to drives that were found are added.
    """
    restriction = restriction_of(search.specification.options)
    if restriction is not None and restriction.scenarios:
        yield from _driven(question, search, Driven(search, question, restriction), objections)
        return
    if search.count > 1 or search.scenario is None or search.setting.road is not None:
        yield from _clearly_different(question, search)
        return
    begun, options = search.search_options.effort.meter(), search.search_options
    sibling = offered(search.specification, search.scenario, question, search.setting, options)
    if sibling is None and options.effort.timeout is not None:
        options = replace(options, effort=Effort(options.effort.units, begun.seconds_left()))
    yield sibling or find_once(question, options)


def _clearly_different(question: SearchProblem, search: Search) -> Iterator["Attempt"]:
    """The answers to one search after the other, each for a drive unlike those found before it.

    Where the clock cuts a later one off, the drives that were found still stand.
    """
    from roadproof.engines.search.search import Attempt, find_witness  # here: what is known needs no numpy

    drives: list[Drive] = []
    while len(drives) < search.count:
        try:
            answer = find_witness(question, search.search_options, tuple(drives))
        except BudgetExceeded as late:
            if not drives:
                raise
            yield Attempt(Verdict.UNKNOWN, None, late.reason)
            return
        yield answer
        if answer.found is None:
            return
        drives.append(answer.found.drive)


def _driven(
    question: SearchProblem, search: Search, driven: Driven, objections: list[str]
) -> Iterator["Attempt"]:
    """The answers as of ``_clearly_different``, without drives to which a driver model objects."""
    from roadproof.engines.search.search import Attempt, find_witness

    drives: list[Drive] = []
    options, shown = search.search_options, 0
    while shown < search.count and len(objections) < TRIES:
        if objections:
            options = replace(options, effort=options.effort.of(min(AGAIN, options.effort.units)))
        try:
            attempt = find_witness(question, options, tuple(drives))
        except BudgetExceeded:
            if not drives:
                raise
            break
        if attempt.found is None:
            if not drives:
                yield attempt
                return
            break
        drives.append(attempt.found.drive)
        objection = driven.objection(attempt.found)
        if objection:
            objections.append(objection)
        else:
            shown += 1
            yield attempt
    if shown < search.count:
        model = driven.restriction.model
        yield Attempt(Verdict.UNKNOWN, None, Why.NOT_DRIVEN(len(objections), model, "; ".join(objections)))


def _reason(answers: list["Attempt"], count: int) -> Reason:
    found = sum(a.found is not None for a in answers)
    if 0 < found < count:
        return Why.FEWER_DRIVES(found, count, answers[-1].reason)
    return answers[0].reason


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
