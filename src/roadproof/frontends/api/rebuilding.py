"""What the answers of a folder show together, made again from its files."""

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from roadproof.frontends.api.questioned import QuestionAnswers
from roadproof.questions.checking import QuestionFolder
from roadproof.questions.settle import Settled

ANSWERS: Mapping[str, str] = {
    "catalogue": "cataloguing:CatalogueAnswer",
    "classify": "classifying:Classifications",
    "compare": "comparing:ComparisonAnswer",
    "coverage": "covering:Coverages",
    "explore": "exploring:Explorations",
    "order": "studies:Orders",
    "overlap": "studies:Overlaps",
    "preventable": "preventing:Plates",
    "prove": "proofs:Proofs",
    "redundancy": "studies:Redundancies",
    "witness": "drives:Witnesses",
}
"""The class of the answers to each kind of question; of others they are those of a survey."""


def rebuilt(found: QuestionFolder) -> QuestionAnswers[Any]:
    """Return the answers of a folder as the command that asks the question has them."""
    module, _, name = ANSWERS.get(found.question.kind, "surveying:SurveyAnswers").partition(":")
    kind: type[QuestionAnswers[Any]] = getattr(import_module(f"roadproof.frontends.api.{module}"), name)
    return kind(found.question, Settled(found.answers, {}), 0.0)
