"""Answers to a question of many claims: settled one by one, kept in a folder, and shown as a view."""

import time
from collections.abc import Callable
from functools import cached_property
from pathlib import Path
from typing import ClassVar, Generic, Self, TypeVar

from roadproof.engines.modifier import modifier_of
from roadproof.evidence import answer as answers
from roadproof.evidence.answer_files import Undecided
from roadproof.evidence.kinds import Evidence
from roadproof.evidence.strict import JsonObject
from roadproof.frontends.api.answer import Answer
from roadproof.frontends.settings.groups import Run
from roadproof.library.specification import Library
from roadproof.questions.question import Question
from roadproof.questions.settle import Settled, settle
from roadproof.questions.store import keep_all
from roadproof.questions.views import view_data
from roadproof.runtime.cost import Cost
from roadproof.runtime.files import write_whole
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict

View = TypeVar("View")


@dataclass(frozen=True, repr=False)
class QuestionAnswers(Answer, Generic[View]):
    """The answers to a ``question``; ``folder`` is where they were kept as they came, if anywhere."""

    question: Question[View]
    found: Settled
    seconds: float
    folder: Path | None = None
    pieces: ClassVar[str] = "claims"

    @classmethod
    def settled(
        cls,
        question: Question[View],
        given: Run,
        each: Callable[[str, answers.Answer, Cost], None] | None = None,
    ) -> Self:
        """Settle the claims of a question. Raises as ``questions.settle``."""
        begun = time.monotonic()
        folder = None if given.out is None else Path(given.out)
        found = settle(question, folder, given.jobs, given.progress, cls.pieces, each, given.fresh, given.say)
        return cls(question, found, time.monotonic() - begun, folder)

    @cached_property
    def view(self) -> View:
        """What the answers show together."""
        return self.question.view(self.found.answers)

    @property
    def library(self) -> Library:
        """The definitions that the answers were given with."""
        return self.question.basis.library

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        final = (x for x in self.found.answers.values() if x.is_final)
        return tuple(evidence_of(x) for x in final if not isinstance(x.evidence, answers.Judged))

    @property
    def supposed(self) -> tuple[str, ...]:
        """What a modifier of the question supposes of the drives that are asked about."""
        found = modifier_of(self.question.basis.specification.options)
        return () if found is None else (str(found),)

    @property
    def exit_code(self) -> ExitCode:
        doubt = Verdict.UNKNOWN in self.verdicts.values()
        return ExitCode.UNKNOWN if doubt else ExitCode.AS_EXPECTED

    def as_data(self) -> JsonObject:
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
            write_whole(folder / name, content)


def evidence_of(answer: answers.Answer) -> Evidence:
    """Return the evidence that decides a claim. Raises ``ValueError`` where none does."""
    match answer.evidence:
        case answers.Refutation() as shown:
            return shown.trace
        case Undecided() | answers.Judged():
            raise ValueError(f"{answer.verdict} has no evidence")
        case found:
            return found
