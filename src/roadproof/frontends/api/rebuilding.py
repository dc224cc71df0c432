"""What the answers of a folder show together, made again from its files."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from roadproof.extension import entries, imported
from roadproof.questions.checking import QuestionFolder
from roadproof.questions.settle import Settled

if TYPE_CHECKING:
    from roadproof.frontends.api.questioned import QuestionAnswers

CORE: Mapping[str, str] = {
    "compare": "roadproof.frontends.api.comparing:ComparisonAnswer",
    "order": "roadproof.frontends.api.studies:Orders",
    "overlap": "roadproof.frontends.api.studies:Overlaps",
    "prove": "roadproof.frontends.api.proofs:Proofs",
    "witness": "roadproof.frontends.api.drives:Witnesses",
}
"""The class of the answers to each kind of question; extensions add others."""


def rebuilt(found: QuestionFolder) -> "QuestionAnswers[Any]":
    """Return the answers of a folder as the command that asks the question has them."""
    kind = imported(entries("answers", CORE)[found.question.kind])
    made: QuestionAnswers[Any] = kind(found.question, Settled(found.answers, {}), 0.0)
    return made
