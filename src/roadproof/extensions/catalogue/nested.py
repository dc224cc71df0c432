"""A question inside another one, with a prefix before the names of its claims."""

from collections.abc import Sequence
from typing import Any

from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import HELP
from roadproof.evidence.finding import Finding
from roadproof.questions.question import (
    Annotating,
    Answers,
    EvidencePlace,
    FindsUnknowns,
    OwnWork,
    Question,
    QuestionBatch,
    Steps,
    WorkByName,
)
from roadproof.reasons import Reason
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class NestedQuestion:
    """A question whose claims have names with ``prefix``, after ``HELP`` where a claim only helps."""

    prefix: str
    question: Question[Any]

    def batches(self, known: Answers) -> Sequence[QuestionBatch]:
        """Return its batches, given the known answers of the whole question."""
        return [
            NestedBatch(self.prefix, x, self.question.work) for x in self.question.batches(self.own(known))
        ]

    def own(self, known: Answers) -> dict[str, ClaimAnswer]:
        """Return the answers to its own claims, by their own names."""
        return {own_name(self.prefix, n): x for n, x in known.items() if self.has(n)}

    def has(self, name: str) -> bool:
        """Return whether the claim of a name is one of its own."""
        return name.removeprefix(HELP).startswith(self.prefix)

    def label(self, name: str) -> str:
        """Return the label of one of its claims."""
        return self.question.label(own_name(self.prefix, name))

    def place(self, place: EvidencePlace) -> EvidencePlace:
        """Return the place of evidence by its own names."""
        return lambda name, answer: place(full_name(self.prefix, name), answer)

    def annotate(self, name: str, answer: ClaimAnswer, finding: Finding) -> Finding:
        """Return the finding about one of its answers, with what the answer shows."""
        question = self.question
        return (
            question.annotate(own_name(self.prefix, name), answer, finding)
            if isinstance(question, Annotating)
            else finding
        )

    def unknowns(self, known: Answers) -> Sequence[tuple[str, Reason]]:
        """Return what its answers leave in doubt, given the known answers of the whole question."""
        return self.question.unknowns(self.own(known)) if isinstance(self.question, FindsUnknowns) else ()


def full_name(prefix: str, name: str) -> str:
    """Return the name of a nested claim in the whole question."""
    help = HELP if name.startswith(HELP) else ""
    return f"{help}{prefix}{name.removeprefix(HELP)}"


def own_name(prefix: str, name: str) -> str:
    """Return the name of a claim in the nested question."""
    help = HELP if name.startswith(HELP) else ""
    return f"{help}{name.removeprefix(HELP).removeprefix(prefix)}"


@dataclass(frozen=True)
class NestedBatch:
    """A batch with a prefix before the names of its claims."""

    prefix: str
    batch: QuestionBatch
    allowed: Work

    @property
    def name(self) -> str:
        """The name of the batch with the prefix."""
        return f"{self.prefix}{self.batch.name}"

    def work_of(self, name: str) -> Work:
        """Return the work that the nested question allows for a claim."""
        match self.batch:
            case WorkByName():
                return self.batch.work_of(own_name(self.prefix, name))
            case OwnWork():
                return self.batch.work
            case _:  # open: any other batch
                return self.allowed

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        steps = self.batch.steps()
        try:
            name, claim = next(steps)
            while True:
                name, claim = steps.send((yield full_name(self.prefix, name), claim))
        except StopIteration:
            return
