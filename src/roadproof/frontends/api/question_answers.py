"""Answers to a question of many claims: decided one by one, stored in a folder, and shown as a view."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Generic, Self, TypeVar

from roadproof.engines.modifier import find_modifier
from roadproof.evidence import answer as answers
from roadproof.evidence.answer_files import UndecidedFile
from roadproof.extension import entries, imported
from roadproof.frontends.api.answer import BaseAnswer
from roadproof.questions.decide import Decisions, decide_claims, take_over
from roadproof.questions.store import keep_all
from roadproof.runtime.files import write_atomic
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict

if TYPE_CHECKING:
    from roadproof.evidence.kinds import Evidence
    from roadproof.evidence.strict import JsonObject
    from roadproof.frontends.settings.groups import Run
    from roadproof.library.specification import Library
    from roadproof.questions.question import Question
    from roadproof.runtime.budget import Cost

View = TypeVar("View")


@dataclass(frozen=True, repr=False)
class QuestionAnswers(BaseAnswer, Generic[View]):
    """The answers to a ``question``; ``folder`` is where they were kept as they came, if anywhere."""

    question: Question[View]
    found: Decisions
    seconds: float
    folder: Path | None = None
    pieces: ClassVar[str] = "claims"

    @classmethod
    def decide(
        cls,
        question: Question[View],
        given: Run,
        each: Callable[[str, answers.ClaimAnswer, Cost], None] | None = None,
    ) -> Self:
        """Decide the claims of a question. Raises as ``questions.decide``."""
        start = time.monotonic()
        folder = None if given.out is None else Path(given.out)
        if known := given.given_answers(question):
            return cls(question, take_over(question, folder, known, each), time.monotonic() - start, folder)
        decisions = decide_claims(
            question, folder, given.jobs, given.progress, cls.pieces, each, given.fresh, given.say
        )
        return cls(question, decisions, time.monotonic() - start, folder)

    @cached_property
    def view(self) -> View:
        """The view of all answers."""
        return self.question.view(self.found.answers)

    @property
    def library(self) -> Library:
        """The definitions that the answers were given with."""
        return self.question.basis.library

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        final = (x for x in self.found.answers.values() if x.is_final)
        return tuple(evidence_of(x) for x in final if not isinstance(x.evidence, answers.JudgedTrace))

    @property
    def supposed(self) -> tuple[str, ...]:
        """The assumptions of a modifier of the question about its drives."""
        modifier = find_modifier(self.question.basis.specification.options)
        return () if modifier is None else (str(modifier),)

    @property
    def exit_code(self) -> ExitCode:
        is_unknown = Verdict.UNKNOWN in self.verdicts.values()
        return ExitCode.UNKNOWN if is_unknown else ExitCode.AS_EXPECTED

    def as_data(self) -> JsonObject:
        from roadproof.questions.views import view_data  # here: for data alone

        return view_data(self.question, self.found.answers, self.folder, round(self.seconds, 2))

    def files(self, pictures: bool) -> dict[str, bytes]:
        """Return what is written beside the evidence to be looked at, by name."""
        return {}

    def _write(self, folder: Path, pictures: bool) -> None:
        if folder != self.folder:
            keep_all(folder, self.question, self.found.answers)
        self._add_files(folder, pictures)

    def add_files(self, pictures: bool) -> None:
        """Write what is to be looked at beside the evidence that was kept as it came."""
        if self.folder is not None:
            self._add_files(self.folder, pictures)

    def _add_files(self, folder: Path, pictures: bool) -> None:
        for name, content in self.files(pictures).items():
            write_atomic(folder / name, content)
        if pictures and self.question.kind in entries("pages"):
            imported("pages", self.question.kind)(folder)


def evidence_of(answer: answers.ClaimAnswer) -> Evidence:
    """Return the evidence that decides a claim. Raises ``ValueError`` where none does."""
    match answer.evidence:
        case answers.RefutingTrace() as shown:
            return shown.trace
        case UndecidedFile() | answers.JudgedTrace():
            raise ValueError(f"{answer.verdict} has no evidence")
        case found:
            return found
