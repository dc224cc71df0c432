"""The one loop over claims: what is known is looked up, the rest is settled, and each answer is kept."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from roadproof.analysis.study import pool
from roadproof.analysis.study.known import Origin, is_off
from roadproof.analysis.study.known import told as told_known
from roadproof.analysis.study.pool import Progress
from roadproof.errors import SharedError, UsageError
from roadproof.evidence.answer import Answer, undecided
from roadproof.questions.question import Batch, Question
from roadproof.questions.store import Store
from roadproof.reasons import Reason
from roadproof.runtime.executors import Jobs, hands_of
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Settled:
    """All answers by name, and from where those came that were known."""

    answers: Mapping[str, Answer]
    origins: Mapping[str, Origin]


def settle(
    question: Question[Any],
    folder: Path | None = None,
    hands: Jobs = None,
    progress: Progress | None = None,
    what: str = "claims",
    each: Callable[[str, Answer], None] | None = None,
    fresh: bool = False,
    say: Callable[[str], None] | None = None,
) -> Settled:
    """Settle all claims of a question.

    Answers in ``folder`` are taken over, and each new one is written there as it comes, so that a run that
    was broken off goes on. Of several runs that share a folder each does its share. ``fresh``: known answers
    of other runs do not count. Raises ``UsageError`` where the folder is another question's, ``SharedError``
    where the rest is for other runs, and what the engines raise.
    """
    shard = hands_of(hands).shard
    if shard is not None and folder is None:
        raise UsageError(f"--shard {shard} requires --out, the folder that the runs share")
    store = Store(folder, question.kind, question.basis.work, reads_known=not fresh and not is_off())
    store.open(question)
    run = _Run(question, store, each or _nobody, say)
    first = {name for batch in question.batches({}) for name in batch}
    dealt = (
        first if shard is None else {name for batch in shard.among(question.batches({})) for name in batch}
    )
    batches = run.open_batches()
    if say is not None:
        listed = len(run.known) + sum(map(len, batches))
        for line in told_known([*run.origins.values()], listed):
            say(line)
    while batches:
        ours = [x for x in batches if shard is None or _is_ours(x, first, dealt, shard.has)]
        if not ours:
            left = sum(len(batch) for batch in batches)
            raise SharedError(
                f"shard {shard} is done: other runs settle {left} {what}; run again to join them"
            )
        run.ask(ours, hands, progress, what)
        batches = run.open_batches()
    store.make_room()
    return Settled(run.known, run.origins)


def _is_ours(batch: Batch, first: set[str], dealt: set[str], has: Callable[[str], bool]) -> bool:
    name = next(iter(batch))
    return name in dealt if name in first else has(name)


class _Run:
    """The answers that are known so far."""

    def __init__(
        self,
        question: Question[Any],
        store: Store,
        each: Callable[[str, Answer], None],
        say: Callable[[str], None] | None,
    ) -> None:
        self.question, self.store, self.each, self.say = question, store, each, say
        self.known: dict[str, Answer] = {}
        self.origins: dict[str, Origin] = {}
        self.doubts: set[str] = set()

    def open_batches(self) -> Sequence[Batch]:
        """Look up claims until none that is listed is known; return those that are left."""
        while batches := self._listed():
            found = [name for batch in batches for name, claim in batch.items() if self._look_up(name, claim)]
            if not found:
                return batches
        return []

    def _listed(self) -> list[Batch]:
        every = self.question.batches(self.known)
        left = ({k: x for k, x in batch.items() if k not in self.known} for batch in every)
        return [batch for batch in left if batch]

    def _look_up(self, name: str, claim: Any) -> bool:
        found = self.store.find(name, claim, self.say)
        if found is None or not found[0].is_final:
            return False
        answer, origin = found
        if origin is not None:
            self.origins[name] = origin
            self.store.keep(name, answer, is_new=False)
        self._add(name, answer)
        return True

    def _add(self, name: str, answer: Answer) -> None:
        self.known[name] = answer
        self.each(name, answer)

    def ask(self, batches: Sequence[Batch], hands: Jobs, progress: Progress | None, what: str) -> None:
        """Settle batches; the claims of one whose process ends are asked alone."""
        alone: list[Batch] = []

        def lose(batch: Batch, reason: Reason) -> list[tuple[str, Answer]]:
            if len(batch) > 1:
                alone.extend({name: claim} for name, claim in batch.items())
                return []
            return [(name, undecided(claim, reason)) for name, claim in batch.items()]

        job = _Job(self.question.basis.work)
        with closing(pool.work(job, batches, hands, lose, progress, what)) as answered:
            for _, answers in answered:
                for name, answer in answers:
                    self.store.keep(name, answer)
                    self._add(name, answer)
        if alone:
            self.ask(alone, hands, progress, what)


@dataclass(frozen=True)
class _Job:
    work: Any

    def __call__(self, batch: Batch) -> list[tuple[str, Answer]]:
        from roadproof.engines.search.batches import settle_batch  # here: known answers need no solver

        return [*zip(batch, settle_batch([*batch.values()], self.work), strict=True)]


def _nobody(name: str, answer: Answer) -> None:
    """Nobody listens."""
