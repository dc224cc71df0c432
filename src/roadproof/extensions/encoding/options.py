"""The options of ``witness``: take the solution of another solver, and explain that there is no drive."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.frontends.settings.option import Settings, option
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.evidence.answer import ClaimAnswer
    from roadproof.questions.question import Answers, Question


@dataclass(frozen=True, kw_only=True)
class EncodingOptions(Settings):
    """Options about the problem that a search solves."""

    solution: Path | None = option(
        None,
        "--solution FILE",
        "read a solution of the file that compile wrote, and judge its drive, instead of a search",
        read=Path,
        rare=True,
    )

    explain: bool = option(
        False,
        "--explain",
        "of a NONE-WITHIN: print which definitions and limits conflict, and which limit to widen",
        rare=True,
    )

    def remarks(self, question: Question[Any], answers: Answers) -> tuple[str, ...]:
        """Return why there are no drives, for each NONE-WITHIN."""
        if not self.explain:
            return super().remarks(question, answers)
        from roadproof.extensions.encoding.explaining import explanations  # here: it loads the encoder

        return tuple(explanations(answers.values()))

    def given_answers(self, question: Question[Any]) -> Mapping[str, ClaimAnswer]:
        """Return the answer that the solution is. Raises ``InputError``, ``UsageError``."""
        if self.solution is None:
            return super().given_answers(question)
        from roadproof.extensions.encoding.answering import answers_from  # here: it loads the encoder

        return answers_from(question, self.solution)
