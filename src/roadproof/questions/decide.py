"""The one loop over claims: what is known is looked up, the rest is settled, and each answer is kept."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from roadproof.errors import SharedError, UsageError
from roadproof.evidence.answer import ClaimAnswer, Evidence, undecided
from roadproof.evidence.answer_files import UndecidedFile
from roadproof.questions.question import (
    Answers,
    EarlierAnswers,
    Growing,
    Proposing,
    Question,
    QuestionBatch,
    Seeded,
    walk_batch,
    walk_with_earlier,
    work_of,
)
from roadproof.questions.store import Store, keep_all
from roadproof.runtime.archives import Origin, is_off, origins_in_words
from roadproof.runtime.budget import NO_COST, Cost, Work
from roadproof.runtime.executors import Jobs, Shard, executor_for, is_fork_unsafe
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.evidence.claim import Claim
    from roadproof.reasons import Reason
    from roadproof.runtime.pool import Progress, Say

SOON = 1.0
"""The seconds after which progress is reported of answers that are looked up."""
PricedEvidence: TypeAlias = tuple[str, Evidence, Cost]
"""The name of a claim, the evidence for its answer, and what it cost: a claim is not sent back."""


@dataclass(frozen=True)
class Decisions:
    """All answers by name, from where those came that were known, and what others cost."""

    answers: Mapping[str, ClaimAnswer]
    origins: Mapping[str, Origin]
    costs: Mapping[str, Cost] = field(default_factory=dict)


def decide_claims(
    question: Question[Any],
    folder: Path | None = None,
    executor: Jobs = None,
    progress: Progress | None = None,
    what: str = "claims",
    each: Callable[[str, ClaimAnswer, Cost], None] | None = None,
    fresh: bool = False,
    say: Say | None = None,
) -> Decisions:
    """Decide all claims of a question.

    Answers in ``folder`` are taken over, and each new one is written there as it comes, so that a run that
    was broken off goes on. Of several runs that share a folder each does its share. ``fresh``: known answers
    of other runs do not count. Raises ``UsageError`` where the folder is another question's, ``SharedError``
    where the rest is for other runs, and what the engines raise.
    """
    shard = executor_for(executor).shard
    if shard is not None and folder is None:
        raise UsageError(f"--shard {shard} requires --out, the folder that the runs share")
    work = question.work
    store = Store(folder, question.kind, work, reads_known=not fresh and not is_off())
    with store.opened(question, say):
        run = _Run(question, store, each or _ignore, say, progress, what)
        is_ours = shard_filter(shard, [batch.name for batch in question.batches({})])
        batches = run.open_batches()
        line = origins_in_words([*run.origins.values()], len(run.known) + len(batches))
        if line and say is not None:
            say(line)
        while batches:
            ours = [x for x in batches if is_ours(x.name)]
            if not ours:
                raise SharedError(_shard_message(shard, run.known, len(batches), what))
            run.ask(ours, executor, progress, what)
            batches = run.open_batches()
    store.require_folder()
    if not isinstance(question, Growing):
        store.leave_only(run.known, say)
    store.evict_old()
    return Decisions(run.known, run.origins, run.costs)


def take_over(
    question: Question[Any],
    folder: Path | None,
    known: Mapping[str, ClaimAnswer],
    each: Callable[[str, ClaimAnswer, Cost], None] | None = None,
) -> Decisions:
    """Return answers that others gave as decisions, and store them in ``folder`` as a run does.

    Raises ``UsageError`` where the folder is another question's.
    """
    if folder is not None:
        keep_all(folder, question, known)
    for name, answer in known.items():
        (each or _ignore)(name, answer, NO_COST)
    return Decisions(known, {})


def shard_filter(shard: Shard | None, first: Sequence[str]) -> Callable[[str], bool]:
    """Return a function that says whether a batch of a name is one of a shard's.

    Batches that are asked ``first`` are dealt out in turn, so shards differ by one at most. Later ones go by
    their names, whatever each of the runs knows by then.
    """
    if shard is None:
        return lambda _: True
    dealt = {*shard.among(first)}
    return lambda name: name in dealt if name in first else shard.includes(name)


def _shard_message(shard: Shard | None, known: Answers, left: int, what: str) -> str:
    """Return how far a run that has its share done is."""
    unsure = sum(isinstance(x.evidence, UndecidedFile) and x.evidence.work is None for x in known.values())
    again = f", {unsure} in doubt, to be computed again" if unsure else ""
    return (
        f"shard {shard} is done: {len(known) - unsure} answers are stored{again}; other runs process {left} "
        f"{what}. When all runs are done, run once without --shard to merge"
    )


def look_up(question: Question[Any]) -> Mapping[str, ClaimAnswer]:
    """Return the answers that are known without engines."""
    run = _Run(question, Store(None, question.kind, question.work, reads_known=not is_off()), _ignore)
    run.open_batches()
    return run.known


class _Run:
    """The answers that are known so far."""

    def __init__(
        self,
        question: Question[Any],
        store: Store,
        each: Callable[[str, ClaimAnswer, Cost], None],
        say: Say | None = None,
        progress: Progress | None = None,
        what: str = "",
    ) -> None:
        self.question, self.store, self.each, self.say = question, store, each, say
        self.progress, self.what = progress, f"{what} looked up"
        self.known: dict[str, ClaimAnswer] = {}
        self.origins: dict[str, Origin] = {}
        self.costs: dict[str, Cost] = {}

    def open_batches(self) -> list[QuestionBatch]:
        """Look up claims, and return the batches of which some are not known."""
        seen: set[str] = set()
        left: list[QuestionBatch] = []
        start = time.monotonic()
        while new := [x for x in self.question.batches(self.known) if x.name not in seen]:
            seen |= {x.name for x in new}
            for done, batch in enumerate(new):
                if self.progress is not None and time.monotonic() - start >= SOON:
                    self.progress(done, len(new), self.what)
                left += [batch] if self._left_of(batch) else []
        return left

    def _left_of(self, batch: QuestionBatch) -> list[tuple[str, Claim]]:
        """Look up the claims of a batch, and return the first that is not known."""

        def find(name: str, claim: Claim, earlier: EarlierAnswers) -> ClaimAnswer | None:
            return self._find(store_of(batch, self.store, name), name, claim, earlier)

        return [*walk_with_earlier(batch, find)]

    def _find(self, store: Store, name: str, claim: Claim, earlier: EarlierAnswers) -> ClaimAnswer | None:
        if name in self.known:
            return self.known[name]
        stored = store.look_up(name, claim, earlier, self.say)
        if stored is None:
            return None
        answer, origin = stored
        if origin is not None:
            self.origins[name] = origin
            store.keep(name, answer)
        self._add(name, answer)
        return answer

    def _add(self, name: str, answer: ClaimAnswer, cost: Cost = NO_COST) -> None:
        self.known[name] = answer
        self.each(name, answer, cost)

    def ask(
        self, batches: Sequence[QuestionBatch], executor: Jobs, progress: Progress | None, what: str
    ) -> None:
        """Decide batches; where the process of one ends, its claims are decided one by one."""
        lost: list[QuestionBatch] = []

        def lose(job: _BatchJob, reason: Reason) -> list[PricedEvidence]:
            lost.append(job.batch)
            return []

        from roadproof.runtime import pool  # here: known answers need no processes

        jobs = [_BatchJob(x, self._known_of(x), self.store) for x in batches]
        fresh = is_fork_unsafe()  # given traces can be tables
        with closing(pool.work(_decide_job, jobs, executor, lose, progress, what, fresh=fresh)) as answered:
            for place, evidence in answered:
                self._take(jobs[place], evidence)
        for batch in lost:
            self._ask_alone(batch, executor)

    def _take(self, job: _BatchJob, priced: Sequence[PricedEvidence]) -> None:
        """Keep answers to claims of a batch, which are listed again."""
        new = {name: (evidence, cost) for name, evidence, cost in priced}

        def find(name: str, claim: Claim, earlier: EarlierAnswers) -> ClaimAnswer | None:
            """Return the answer to a claim, or None where it is not there yet."""
            if name in new:
                evidence, cost = new.pop(name)
                answer = ClaimAnswer(claim, evidence)
                store_of(job.batch, self.store, name).keep(name, answer, earlier)
                self.costs[name] = cost
                self._add(name, answer, cost)
            return self.known.get(name)

        [*walk_with_earlier(job.batch, find)] if new else []

    def _known_of(self, batch: QuestionBatch) -> dict[str, ClaimAnswer]:
        """Return the known answers to claims of a batch."""
        answers: dict[str, ClaimAnswer] = {}

        def find(name: str, claim: Claim) -> ClaimAnswer | None:
            return answers.setdefault(name, self.known[name]) if name in self.known else None

        [*walk_batch(batch, find)]
        return answers

    def _ask_alone(self, batch: QuestionBatch, executor: Jobs) -> None:
        """Decide each claim of a batch in a process of its own; UNKNOWN where that process ends."""
        from roadproof.engines.prove.unknown import Cause, UnknownReport  # here: few processes end
        from roadproof.runtime import pool

        while left := self._left_of(batch):
            [(name, claim)] = left

            def lose(
                job: _BatchJob, reason: Reason, lost_claim: Claim = claim, named: str = name
            ) -> list[PricedEvidence]:
                """Return the evidence of a claim whose process is lost: it is undecided."""
                report = UnknownReport(Cause.PROCESS, (), job.store_of(named).work.effort.units, reason).data
                return [(named, undecided(lost_claim, reason, report=report).evidence, NO_COST)]

            job = _BatchJob(batch, self._known_of(batch), self.store, alone=True)
            with closing(pool.work(_decide_job, [job, _EMPTY_JOB], executor, lose)) as answered:
                for _, evidence in answered:
                    self._take(job, evidence)


def store_of(batch: QuestionBatch, store: Store, name: str) -> Store:
    """Return the store with the work for a claim, where a batch has another than its question."""
    return replace(store, work=work_of(store.work, batch, name))


@dataclass(frozen=True)
class _EmptyBatch:
    """An empty batch: its one claim is left out."""

    name: str = ""

    def steps(self) -> Any:
        yield from ()


@dataclass(frozen=True)
class _BatchJob:
    """A batch, the answers to its claims that are known, and where further ones may be.

    ``alone``: whether one more claim is settled, and no other.
    """

    batch: Any
    known: Mapping[str, ClaimAnswer]
    store: Store
    alone: bool = False

    def store_of(self, name: str) -> Store:
        """Return the store with the work that is allowed for a claim."""
        return store_of(self.batch, self.store, name)


_EMPTY_JOB = _BatchJob(_EmptyBatch(), {}, Store(None, "", Work()))


def _decide_job(job: _BatchJob) -> list[PricedEvidence]:
    """Decide the open claims of a batch."""
    from roadproof.engines.search.batches import Engines  # here: known answers need no solver

    engines, new, known = Engines(job.store_of("").work), list[PricedEvidence](), dict(job.known)
    for drive in job.batch.seeds if isinstance(job.batch, Seeded) else ():
        engines.offer(drive)

    def answer_to(name: str, claim: Claim, earlier: EarlierAnswers) -> ClaimAnswer:
        """Return the stored answer to a claim, or decide the claim."""
        if name in job.known:
            return job.known[name]
        store = job.store_of(name)
        stored = store.look_up(name, claim, earlier)
        if stored is not None:
            answer, cost = stored[0], NO_COST
        else:
            proposed = job.batch.proposed(name, known) if isinstance(job.batch, Proposing) else ()
            answer, cost = replace(engines, work=store.work).answer_claim(claim, proposed)
            answer = store.whole(store.exhausted(answer))
        new.append((name, answer.evidence, cost))
        return answer

    def find(name: str, claim: Claim, earlier: EarlierAnswers) -> ClaimAnswer | None:
        """Return the answer to a claim, or None where it is not there yet."""
        if job.alone and new:
            return None
        known[name] = answer_to(name, claim, earlier)
        engines.learn(known[name])
        return known[name]

    [*walk_with_earlier(job.batch, find)]
    return new


def _ignore(name: str, answer: ClaimAnswer, cost: Cost) -> None:
    """Nobody listens."""
