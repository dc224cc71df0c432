"""Questions that may take long: a drive, a proof, a comparison."""

import shlex
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import roadproof as rp
from roadproof.api.definitions import Definitions
from roadproof.api.drafting import BEFORE, Draft, place_in
from roadproof.evidence.certificate import certificate_data
from roadproof.logic.formula import Formula
from roadproof.report.viewer_data import shown_place
from roadproof.spec.compose import negation
from roadproof.spec.places import nearest, places_of
from roadproof.spec.query import Query
from roadproof.studio.asked import count_of, draft_of, set_of, text_of
from roadproof.studio.showing import marks_of, view

Say = Callable[[str], None]
MOST_DRIVES = 12
FILE = "edit.spec"


def find(ask: Mapping[str, Any], say: Say) -> dict[str, Any]:
    """A drive with the question, or without it: the ``count``-th that differs clearly."""
    draft, chosen = draft_of(ask), set_of(ask)
    home, count = draft.definitions(chosen), count_of(ask, "count", MOST_DRIVES)
    query = home.read(text_of(ask, "formula"))
    if ask.get("negated") is True:
        query = negation(query)
    objective = text_of(ask, "objective")
    say("looking for a drive")
    found = rp.witness(query, using=home, objective=objective, count=count, jobs=1)  # type: ignore[arg-type]
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
        "count": len(outcome.drives),
        "spec": draft.file(),
        "command": command("witness", [query.text], draft, home, options),
    }
    if len(outcome.drives) == count:
        judged = outcome.drives[-1]
        answer["drive"] = judged.as_data()
        say("judging it")
        answer["view"] = view(draft, judged.file, ask)
    return answer


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
    [found] = rp.prove(home.read(text_of(ask, "formula")), using=home, declared=declared, jobs=1).answers
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
    say(f"does {pair[0]} imply {pair[1]}?")
    found = rp.compare(text, text, home)
    direction = found.comparison.forward
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
    is_needed = any(x in ("edit", BEFORE) for x in home.sets) and (draft.text.strip() or draft.before)
    sets = [draft.base if x == "edit" and not is_needed else x for x in home.sets]
    said += [x for one in sets if one != "base" or len(sets) > 1 for x in ("--set", one)]
    said += ["--spec", FILE] if is_needed else []
    for option, reading in draft.options.items():
        said += ["--option", f"{option}={reading}"]
    for parameter, value in draft.params.items():
        said += ["--param", f"{parameter}={value}"]
    return shlex.join([*said, *options])
