"""A question inside another one: its claims with a prefix before their names."""

from collections.abc import Sequence
from typing import Any

from roadproof.evidence.answer import Answer
from roadproof.questions.question import Answers, Batch, OwnWork, Question, Steps, WorkByName
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Nested:
    """A question whose claims have names that begin with ``prefix``."""

    prefix: str
    question: Question[Any]

    def batches(self, known: Answers) -> Sequence[Batch]:
        """Return its batches, given what is known of the whole question."""
        return [
            NestedBatch(self.prefix, x, self.question.work) for x in self.question.batches(self.own(known))
        ]

    def own(self, known: Answers) -> dict[str, Answer]:
        """Return the answers to its own claims, by their own names."""
        return {n.removeprefix(self.prefix): x for n, x in known.items() if n.startswith(self.prefix)}

    def label(self, name: str) -> str:
        """Return what one of its claims is about."""
        return self.question.label(name.removeprefix(self.prefix))


@dataclass(frozen=True)
class NestedBatch:
    """A batch with a prefix before the names of its claims."""

    prefix: str
    batch: Batch
    allowed: Work

    @property
    def name(self) -> str:
        """The name of the batch with the prefix."""
        return f"{self.prefix}{self.batch.name}"

    def work_of(self, name: str) -> Work:
        """Return the work that the nested question allows for a claim."""
        match self.batch:
            case WorkByName():
                return self.batch.work_of(name.removeprefix(self.prefix))
            case OwnWork():
                return self.batch.work
            case _:
                return self.allowed

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        steps = self.batch.steps()
        try:
            name, claim = next(steps)
            while True:
                name, claim = steps.send((yield f"{self.prefix}{name}", claim))
        except StopIteration:
            return
