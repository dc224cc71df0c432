"""Jobs of the studio that may take long: finding a drive, proving a claim, comparing two drafts."""

import contextlib
from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from typing import Any, Literal, TypeAlias

import roadproof as rp
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.certificate_file import certificate_data
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.pages.command_lines import command_line
from roadproof.extensions.pages.places import nearest, places_of
from roadproof.extensions.pages.studio.drafting import BEFORE, EDIT, place_in
from roadproof.extensions.pages.studio.requests import Answer, StudioQuestion
from roadproof.extensions.pages.studio.showing import marks_of, view
from roadproof.frontends.api.definitions import Definitions
from roadproof.frontends.settings import groups
from roadproof.frontends.settings.option import Settings
from roadproof.frontends.settings.questions import CompareSettings, Prove, Witness
from roadproof.library.compose import negation
from roadproof.library.scenarios import scenario_number
from roadproof.library.specification import Query
from roadproof.logic.formula import Formula
from roadproof.runtime.progress import report_stage
from roadproof.verdict import Verdict

FILE = "edit.spec"
Origin: TypeAlias = Literal["shipped", "cache"]


@dataclass(frozen=True)
class AnswerCost:
    """The cost of an answer when it was computed: seconds, and units of effort where they were counted.

    ``known``: the origin of an answer that was known before; None for a computed one.
    """

    known: Origin | None
    seconds: float
    effort: float | None = None


@dataclass(frozen=True)
class _JobAnswer:
    """A verdict with its evidence, and the command line that reproduces it."""

    verdict: Verdict
    reason: str
    formula: str
    command: str
    certificate: Certificate | None
    drive: JudgedDrive | None
    cost: AnswerCost | None = None

    def shown(self, question: StudioQuestion) -> Answer:
        """Return the answer for the page, with a document for the viewer where there is a drive."""
        proof, drive = self.certificate, self.drive
        return {
            "verdict": str(self.verdict),
            "reason": self.reason,
            "formula": self.formula,
            "certificate": None if proof is None else certificate_data(proof),
            "drive": None if drive is None else drive.as_data(),
            "spec": question.draft.file(),
            "command": self.command,
            "cost": None if self.cost is None else asdict(self.cost),
            **({} if drive is None else {"view": view(question, drive.file)}),
        }


def find(question: StudioQuestion) -> Answer:
    """Find a drive that satisfies the question, or its negation; return the ``count``-th clearly different
    one.
    """
    home, options = question.home, {**question.options("find"), "count": question.count}
    query = home.read(question.formula)
    query = negation(query) if question.negated else query
    what = _number_or_query(home, query)
    report_stage("looking for a drive")
    answers = rp.witness(what, using=home, jobs=1, fresh=question.fresh, **options)
    outcome = answers.outcomes[0]
    drive = outcome.drives[-1] if len(outcome.drives) == question.count else None
    if drive is not None:
        report_stage("judging the drive")
    words = [query.text if what is query else str(what)]
    command = _command("witness", words, question, home, Witness.of(options))
    cost = AnswerCost(next(iter(answers.found.origins.values()), None), outcome.cost.seconds)
    reason = outcome.reason_without_options
    reply = _JobAnswer(outcome.verdict, reason, query.text, command, outcome.certificate, drive, cost)
    return reply.shown(question) | {
        "road": outcome.road,
        "core": list(outcome.core_texts),
        "marks": _clash(home, query, outcome.core),
        "drives": [x.as_data() for x in outcome.drives],
    }


def _number_or_query(home: Definitions, query: Query) -> int | Query:
    """Return the number of the scenario that a query is, under which its drive may be known; else
    the query.
    """
    number = scenario_number(query)
    same = number is not None and home.read(number).formula == query.formula
    return number if number is not None and same else query


class _AnsweredError(Exception):
    """Raised to stop a comparison after its first direction."""


def _first_direction(text: str, home: Definitions) -> Any:
    """Decide whether the formula in the first set implies it in the second; another job does the other
    direction.
    """
    directions: list[object] = []

    def each(name: str, direction: object) -> None:
        directions.append(direction)
        raise _AnsweredError

    with contextlib.suppress(_AnsweredError):
        rp.compare(text, text, home, jobs=1, each=each)
    return directions[0]


def _clash(home: Definitions, query: Query, core: Iterable[Formula]) -> list[Answer]:
    """Return marks for the conflicting parts in the texts that the user sees."""
    every = places_of(home.specification, query)
    seen = [x for x in every if place_in(x.source, (x.at.line, x.at.column)) is not None]
    return marks_of((x for part in core for x in nearest(seen, part)), "clash")


def prove(question: StudioQuestion) -> Answer:
    """Prove the question as a claim, with a certificate, or refute it with a drive.

    It is about all parameter values except those that the page has set; ``declared``: only the declared
    values.
    """
    home, options = question.home, question.options("prove")
    report_stage("looking for a proof")
    claim = home.read(question.formula)
    answers = rp.prove(claim, using=home, jobs=1, fresh=question.fresh, **options)
    [result] = answers.answers
    task = result.task
    cost = AnswerCost(next(iter(answers.found.origins.values()), None), result.seconds, result.cost.work)
    command = _command("prove", [task.claim], question, home, Prove.of(options))
    reply = _JobAnswer(
        result.verdict, result.reason, task.claim, command, result.certificate, result.drive, cost
    )
    return reply.shown(question) | {"assuming": list(task.assuming), "refuted_by": result.refuted_by}


def compare(question: StudioQuestion) -> Answer:
    """Decide one direction of a comparison: does the formula before the edit imply the one after it?

    ``forward``: from before to after, else the reverse.
    """
    below = BEFORE if question.draft.before is not None else question.draft.base
    pair = (below, EDIT) if question.forward else (EDIT, below)
    home = question.draft.definitions(*pair)
    result = _first_direction(question.formula, home)
    command = _command("compare", [question.formula, question.formula], question, home, CompareSettings())
    reply = _JobAnswer(
        result.verdict, result.reason, result.claim.text, command, result.certificate, result.drive
    )
    return reply.shown(replace(question, compare=True)) | {"sets": list(pair)}


def _command(
    name: str, words: list[str], question: StudioQuestion, home: Definitions, settings: Settings
) -> str:
    """Return the command line that gives the same answer; it reads the draft, if any, from ``edit.spec``."""
    definitions = groups.DefinitionsSettings(
        sets=home.sets,
        specs=(FILE,) if {EDIT, BEFORE} & {*home.sets} else (),
        readings=question.draft.options or None,
        params=question.draft.params or None,
    )
    return command_line(name, words, definitions, settings)
