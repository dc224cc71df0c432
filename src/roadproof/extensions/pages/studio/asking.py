"""Questions that may take long: a drive, a proof, a comparison."""

import contextlib
from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from typing import Any, Literal, TypeAlias

import roadproof as rp
from roadproof.evidence.certificate import Certificate, certificate_data
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.pages.studio.drafting import BEFORE, EDIT, place_in
from roadproof.extensions.pages.studio.requests import Answer, Ask
from roadproof.extensions.pages.studio.showing import marks_of, view
from roadproof.frontends.api.definitions import Definitions
from roadproof.frontends.settings import groups
from roadproof.frontends.settings.flags import command_line
from roadproof.frontends.settings.option import Settings
from roadproof.frontends.settings.questions import Compare, Prove, Witness
from roadproof.library.compose import negation
from roadproof.library.scenarios import scenario_number
from roadproof.library.specification import Query
from roadproof.library.uses import nearest, places_of
from roadproof.logic.formula import Formula
from roadproof.runtime.progress import begin
from roadproof.verdict import Verdict

FILE = "edit.spec"
Origin: TypeAlias = Literal["shipped", "cache"]


@dataclass(frozen=True)
class Cost:
    """What an answer cost when it was computed: seconds of the clock, and units of effort where counted.

    ``known``: where it is from, if it was known before it was asked for.
    """

    known: Origin | None
    seconds: float
    effort: float | None = None


@dataclass(frozen=True)
class _Settled:
    """A verdict with its evidence, and the command line that gives the same."""

    verdict: Verdict
    reason: str
    formula: str
    command: str
    certificate: Certificate | None
    drive: JudgedDrive | None
    cost: Cost | None = None

    def shown(self, ask: Ask) -> Answer:
        """The answer for the page, with the document of the viewer where there is a drive."""
        proof, drive = self.certificate, self.drive
        return {
            "verdict": str(self.verdict),
            "reason": self.reason,
            "formula": self.formula,
            "certificate": None if proof is None else certificate_data(proof),
            "drive": None if drive is None else drive.as_data(),
            "spec": ask.draft.file(),
            "command": self.command,
            "cost": None if self.cost is None else asdict(self.cost),
            **({} if drive is None else {"view": view(ask, drive.file)}),
        }


def find(ask: Ask) -> Answer:
    """A drive with the question, or without it: the ``count``-th that differs clearly."""
    home, how = ask.home, {**ask.options("find"), "count": ask.count}
    query = home.read(ask.formula)
    query = negation(query) if ask.negated else query
    what = _shortly(home, query)
    begin("looking for a drive")
    answers = rp.witness(what, using=home, jobs=1, fresh=ask.fresh, **how)
    outcome = answers.outcomes[0]
    drive = outcome.drives[-1] if len(outcome.drives) == ask.count else None
    if drive is not None:
        begin("judging the drive")
    words = [query.text if what is query else str(what)]
    command = _command("witness", words, ask, home, Witness.of(how))
    cost = Cost(next(iter(answers.found.origins.values()), None), outcome.cost.seconds)
    reason = outcome.told_without_options
    found = _Settled(outcome.verdict, reason, query.text, command, outcome.certificate, drive, cost)
    return found.shown(ask) | {
        "road": outcome.road,
        "core": list(outcome.told),
        "marks": _clash(home, query, outcome.core),
        "drives": [x.as_data() for x in outcome.drives],
    }


def _shortly(home: Definitions, query: Query) -> int | Query:
    """The number of the scenario that a query is, under which its drive may be known; else the query."""
    number = scenario_number(query)
    same = number is not None and home.read(number).formula == query.formula
    return number if number is not None and same else query


class _AnsweredError(Exception):
    """The direction that was asked for has its answer."""


def _first_direction(text: str, home: Definitions) -> Any:
    """Whether the formula in the first set implies it in the second; the other direction is another job's."""
    found: list[object] = []

    def each(name: str, direction: object) -> None:
        found.append(direction)
        raise _AnsweredError

    with contextlib.suppress(_AnsweredError):
        rp.compare(text, text, home, jobs=1, each=each)
    return found[0]


def _clash(home: Definitions, query: Query, core: Iterable[Formula]) -> list[Answer]:
    """Where the parts that clash are said in the texts that the user sees."""
    every = places_of(home.specification, query)
    seen = [x for x in every if place_in(x.source, (x.at.line, x.at.column)) is not None]
    return marks_of((x for part in core for x in nearest(seen, part)), "clash")


def prove(ask: Ask) -> Answer:
    """The question as a claim: proved with a certificate, or refuted with a drive.

    It is about all values of parameters but those that the page has set; ``declared``: at one value of each.
    """
    home, how = ask.home, ask.options("prove")
    begin("looking for a proof")
    claim = home.read(ask.formula)
    answers = rp.prove(claim, using=home, jobs=1, fresh=ask.fresh, **how)
    [found] = answers.answers
    task = found.task
    cost = Cost(next(iter(answers.found.origins.values()), None), found.seconds, found.cost.work)
    command = _command("prove", [task.claim], ask, home, Prove.of(how))
    one = _Settled(found.verdict, found.reason, task.claim, command, found.certificate, found.drive, cost)
    return one.shown(ask) | {"assuming": list(task.assuming), "refuted_by": found.refuted_by}


def compare(ask: Ask) -> Answer:
    """One direction of before against after the edit: does the one imply the other?

    ``forward``: whether before implies after.
    """
    below = BEFORE if ask.draft.before is not None else ask.draft.base
    pair = (below, EDIT) if ask.forward else (EDIT, below)
    home = ask.draft.definitions(*pair)
    found = _first_direction(ask.formula, home)
    command = _command("compare", [ask.formula, ask.formula], ask, home, Compare())
    one = _Settled(found.verdict, found.reason, found.claim.text, command, found.certificate, found.drive)
    return one.shown(replace(ask, compare=True)) | {"sets": list(pair)}


def _command(name: str, words: list[str], ask: Ask, home: Definitions, asked: Settings) -> str:
    """The command line that gives the same answer; the draft is in ``edit.spec`` where it says something."""
    definitions = groups.Definitions(
        sets=home.sets,
        specs=(FILE,) if {EDIT, BEFORE} & {*home.sets} else (),
        readings=ask.draft.options or None,
        params=ask.draft.params or None,
    )
    return command_line(name, words, definitions, asked)
