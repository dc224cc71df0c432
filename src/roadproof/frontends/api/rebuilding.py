"""Makes the view of a folder's answers again from its files."""

from typing import TYPE_CHECKING, Any

from roadproof.extension import imported
from roadproof.questions.checking import QuestionFolder
from roadproof.questions.decide import Decisions

if TYPE_CHECKING:
    from roadproof.frontends.api.question_answers import QuestionAnswers


def rebuilt(stored: QuestionFolder) -> "QuestionAnswers[Any]":
    """Return the answers of a folder as the command that asks the question has them."""
    kind = imported("answers", stored.question.kind)
    made: QuestionAnswers[Any] = kind(stored.question, Decisions(stored.answers, {}), 0.0)
    return made
