"""Questions that may take long: a drive, a proof, a comparison."""

import contextlib
import shlex
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import roadproof as rp
from roadproof.evidence.certificate import certificate_data
from roadproof.frontends.api.definitions import Definitions
from roadproof.frontends.api.drafting import BEFORE, EDIT, Draft, place_in
from roadproof.frontends.report.viewer_data import shown_place
from roadproof.frontends.studio.requests import count_of, draft_of, set_of, text_of
from roadproof.frontends.studio.showing import marks_of, view
from roadproof.library.compose import negation
from roadproof.library.specification import Query
from roadproof.library.uses import nearest, places_of
from roadproof.logic.formula import Formula
from roadproof.runtime.progress import Listener

Say = Callable[[str], None]
MOST_DRIVES = 12
FILE = "edit.spec"
_STAGES = {
    "prove": "looking for a proof",
    "encode": "encoding the formula",
    "solve": "looking for a drive",
    "shape": "shaping the drive",
    "judge": "judging the drive",
    "refute": "proving that no drive exists on the grid",
    "explain": "looking for a proof that no drive exists",
}


def find(ask: Mapping[str, Any], say: Say) -> dict[str, Any]:
    """A drive with the question, or without it: the ``count``-th that differs clearly."""
    draft, chosen = draft_of(ask), set_of(ask)
    home, count = draft.definitions(chosen), count_of(ask, "count", MOST_DRIVES)
    query = home.read(text_of(ask, "formula"))
    if ask.get("negated") is True:
        query = negation(query)
    objective = text_of(ask, "objective")
    say("looking for a drive")
    how: Any = {"objective": objective, "count": count, "jobs": 1, "stage": _telling(say)}
    found = rp.witness(query, using=home, **how)
    outcome = found.outcomes[0]
    options = [] if objective == "smooth" else ["--objective", objective]
    options += ["--count", str(count)] if count > 1 else []
    answer: dict[str, Any] = {
        "verdict": str(outcome.verdict),
        "reason": outcome.told(()),
        "formula": query.text,
        "road": outcome.road,
        "core": [] if outcome.impossibility is None else list(outcome.impossibility.told),
        "marks": [] if outcome.impossibility is None else _clash(home, query, outcome.impossibility.core),
        "certificate": None
        if outcome.impossibility is None
        else certificate_data(outcome.impossibility.certificate),
        "drive": None,
        "drives": [x.as_data() for x in outcome.drives],
        "spec": draft.file(),
        "command": command("witness", [query.text], draft, home, options),
    }
    if len(outcome.drives) == count:
        judged = outcome.drives[-1]
        answer["drive"] = judged.as_data()
        say("judging the drive")
        answer["view"] = view(draft, judged.file, ask)
    return answer


class _AnsweredError(Exception):
    """The direction that was asked for has its answer."""


def _first_direction(text: str, home: Definitions, say: Say) -> Any:
    """Whether the formula in the first set implies it in the second; the other direction is another job's."""
    found: list[Any] = []

    def each(name: str, direction: object) -> None:
        found.append(direction)
        raise _AnsweredError

    with contextlib.suppress(_AnsweredError):
        rp.compare(text, text, home, jobs=1, each=each, stage=_telling(say))
    return found[0]


def _telling(say: Say) -> Listener:
    """A listener to stages that says them in words."""
    return lambda stage: say(", ".join(filter(None, (_STAGES.get(stage.name, stage.name), stage.told))))


def _clash(home: Definitions, query: Query, core: Iterable[Formula]) -> list[dict[str, Any]]:
    """Where the parts that clash are said in the texts that the user sees."""
    every = places_of(home.specification, query)
    seen = [x for x in every if place_in(x.source, (x.at.line, x.at.column)) is not None]
    return marks_of((shown_place(x) for part in core for x in nearest(seen, part)), "clash")


def prove(ask: Mapping[str, Any], say: Say) -> dict[str, Any]:
    """The question as a claim: proved with a certificate, or refuted with a drive.

    It is about all values of parameters but those that the page has set; ``declared``: at one value of each.
    """
    draft, chosen = draft_of(ask), set_of(ask)
    home = draft.definitions(chosen)
    declared = ask.get("declared") is True
    say("looking for a proof")
    query, stage = home.read(text_of(ask, "formula")), _telling(say)
    [found] = rp.prove(query, using=home, declared=declared, jobs=1, stage=stage).answers
    settled = found.settled
    answer: dict[str, Any] = {
        "verdict": str(found.verdict),
        "reason": settled.result.reason,
        "formula": found.task.claim,
        "assuming": list(found.task.assuming),
        "refuted_by": settled.refuted_by,
        "certificate": None
        if settled.result.certificate is None
        else certificate_data(settled.result.certificate),
        "drive": None,
        "spec": draft.file(),
        "command": command("prove", [found.task.claim], draft, home, ["--declared"] if declared else []),
    }
    if settled.drive is not None:
        answer["drive"] = settled.drive.as_data()
        answer["view"] = view(draft, settled.drive.file, ask)
    return answer


def compare(ask: Mapping[str, Any], say: Say) -> dict[str, Any]:
    """One direction of before against after the edit: does the one imply the other?

    ``forward``: whether before implies after.
    """
    draft = draft_of(ask)
    below = BEFORE if draft.before is not None else draft.base
    pair = (below, "edit") if ask.get("forward") is True else ("edit", below)
    home = draft.definitions(*pair)
    text = text_of(ask, "formula")
    direction = _first_direction(text, home, say)
    answer: dict[str, Any] = {
        "verdict": str(direction.verdict),
        "reason": direction.reason,
        "formula": direction.claim.text,
        "sets": list(pair),
        "certificate": None if direction.certificate is None else certificate_data(direction.certificate),
        "drive": None,
        "spec": draft.file(),
        "command": command("compare", [text, text], draft, home, []),
    }
    if direction.drive is not None:
        answer["drive"] = direction.drive.as_data()
        answer["view"] = view(draft, direction.drive.file, {**ask, "compare": True})
    return answer


def command(name: str, words: list[str], draft: Draft, home: Definitions, options: list[str]) -> str:
    """The command line that gives the same answer; the draft is in ``edit.spec`` where it says something."""
    said = ["roadproof", name, *words]
    sets = home.sets
    said += [x for one in sets if one != "base" or len(sets) > 1 for x in ("--set", one)]
    said += ["--spec", FILE] if {EDIT, BEFORE} & {*sets} else []
    for option, reading in draft.options.items():
        said += ["--option", f"{option}={reading}"]
    for parameter, value in draft.params.items():
        said += ["--param", f"{parameter}={value}"]
    return shlex.join([*said, *options])
