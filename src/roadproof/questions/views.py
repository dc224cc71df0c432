"""The view of a question as plain data: what ``--json`` prints, and what a page and a report are made of."""

from pathlib import Path
from typing import Any

from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.answer_codec import answer_data
from roadproof.evidence.codec import write
from roadproof.evidence.strict import JsonObject
from roadproof.questions.question import Answers, EvidencePlace, Question


def view_data(
    question: Question[Any], known: Answers, folder: Path | None, seconds: float = 0.0
) -> JsonObject:
    """Return the view as plain data; evidence is named by its path, or is inside where there is no folder."""

    return write(question.data(question.view(known), placing(folder), seconds))


def placing(folder: Path | None) -> EvidencePlace:
    """Return where evidence is: the path of its file, or itself where there is no folder."""

    def place(name: str, answer: ClaimAnswer) -> object:
        return inside(answer) if folder is None else str(folder / f"{name}.json")

    return place


def inside(answer: ClaimAnswer) -> JsonObject:
    """Return evidence as it is inside an answer: without the tableau, which only files have."""
    data = answer_data(answer)
    return {**data, "tableau": None} if "tableau" in data else data
