"""The one loop over claims: what is known is looked up, the rest is settled, and each answer is kept."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import field, replace
from pathlib import Path
from typing import Any, TypeAlias

from roadproof.engines.prove.doubt import Cause, Doubt
from roadproof.errors import SharedError, UsageError
from roadproof.evidence.answer import Answer, Evidence, undecided
from roadproof.evidence.claim import Claim
from roadproof.questions.question import (
    Answers,
    Batch,
    Growing,
    OwnWork,
    Proposing,
    Question,
    Seeded,
    WorkByName,
    walk,
)
from roadproof.questions.store import Store
from roadproof.reasons import Reason
from roadproof.runtime import pool
from roadproof.runtime.archives import Origin, is_off, origins_in_words
from roadproof.runtime.budget import Work
from roadproof.runtime.cost import NO_COST, Cost
from roadproof.runtime.executors import Jobs, Shard, hands_of, is_fork_unsafe
from roadproof.runtime.pool import Progress, Say
from roadproof.runtime.records import dataclass

Priced: TypeAlias = tuple[str, Evidence, Cost]
"""The name of a claim, the evidence for its answer, and what it cost: a claim is not sent back."""


@dataclass(frozen=True)
class Settled:
    """All answers by name, from where those came that were known, and what others cost."""

    answers: Mapping[str, Answer]
    origins: Mapping[str, Origin]
    costs: Mapping[str, Cost] = field(default_factory=dict)


def settle(
    question: Question[Any],
    folder: Path | None = None,
    hands: Jobs = None,
    progress: Progress | None = None,
    what: str = "claims",
    each: Callable[[str, Answer, Cost], None] | None = None,
    fresh: bool = False,
    say: Say | None = None,
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
    work = question.work
    store = Store(folder, question.kind, work, reads_known=not fresh and not is_off())
    store.open(question, say)
    run = _Run(question, store, each or _nobody, say)
    is_ours = share_of(shard, [batch.name for batch in question.batches({})])
    batches = run.open_batches()
    line = origins_in_words([*run.origins.values()], len(run.known) + len(batches))
    if line and say is not None:
        say(line)
    while batches:
        ours = [x for x in batches if is_ours(x.name)]
        if not ours:
            raise SharedError(_told(shard, run.known, len(batches), what))
        run.ask(ours, hands, progress, what)
        batches = run.open_batches()
    store.require_folder()
    if not isinstance(question, Growing):
        store.leave_only(run.known, say)
    store.make_room()
    return Settled(run.known, run.origins, run.costs)


def share_of(shard: Shard | None, first: Sequence[str]) -> Callable[[str], bool]:
    """Return a function that says whether a batch of a name is one of a shard's.

    Batches that are asked ``first`` are dealt out in turn, so shards differ by one at most. Later ones go by
    their names, whatever each of the runs knows by then.
    """
    if shard is None:
        return lambda _: True
    dealt = {*shard.among(first)}
    return lambda name: name in dealt if name in first else shard.has(name)


def _told(shard: Shard | None, known: Answers, left: int, what: str) -> str:
    """How far a run that has its share done is."""
    unsure = sum(not x.is_final for x in known.values())
    doubts = f", {unsure} in doubt, to be computed again" if unsure else ""
    return (
        f"shard {shard} is done: {len(known) - unsure} answers are stored{doubts}; other runs process {left} "
        f"{what}. When all runs are done, run once without --shard to merge"
    )


def look_up(question: Question[Any]) -> Mapping[str, Answer]:
    """Return the answers that are known without engines."""
    run = _Run(question, Store(None, question.kind, question.work, reads_known=not is_off()), _nobody, None)
    run.open_batches()
    return run.known


class _Run:
    """The answers that are known so far."""

    def __init__(
        self,
        question: Question[Any],
        store: Store,
        each: Callable[[str, Answer, Cost], None],
        say: Say | None,
    ) -> None:
        self.question, self.store, self.each, self.say = question, store, each, say
        self.known: dict[str, Answer] = {}
        self.origins: dict[str, Origin] = {}
        self.costs: dict[str, Cost] = {}

    def open_batches(self) -> list[Batch]:
        """Look up claims, and return the batches of which some are not known."""
        seen: set[str] = set()
        left: list[Batch] = []
        while new := [x for x in self.question.batches(self.known) if x.name not in seen]:
            seen |= {x.name for x in new}
            left += [x for x in new if self._left_of(x)]
        return left

    def _left_of(self, batch: Batch) -> list[tuple[str, Claim]]:
        """Look up the claims of a batch, and return the first that is not known."""

        def find(name: str, claim: Claim) -> Answer | None:
            return self._find(store_of(batch, self.store, name), name, claim)

        return [*walk(batch, find)]

    def _find(self, store: Store, name: str, claim: Claim) -> Answer | None:
        if name in self.known:
            return self.known[name]
        found = store.look_up(name, claim, self.say)
        if found is None or not store.stands(found[0]):
            return None
        answer, origin = found
        if origin is not None:
            self.origins[name] = origin
            store.keep(name, answer, is_new=False)
        self._add(name, answer)
        return answer

    def _add(self, name: str, answer: Answer, cost: Cost = NO_COST) -> None:
        self.known[name] = answer
        self.each(name, answer, cost)

    def ask(self, batches: Sequence[Batch], hands: Jobs, progress: Progress | None, what: str) -> None:
        """Settle batches; of one whose process ends, claims are asked one by one."""
        lost: list[Batch] = []

        def lose(job: "_Job", reason: Reason) -> list[Priced]:
            lost.append(job.batch)
            return []

        jobs = [_Job(x, self._known_of(x), self.store) for x in batches]
        fresh = is_fork_unsafe()  # given traces can be tables
        with closing(pool.work(_settle, jobs, hands, lose, progress, what, fresh=fresh)) as answered:
            for place, found in answered:
                self._take(jobs[place], found)
        for batch in lost:
            self._ask_alone(batch, hands)

    def _take(self, job: "_Job", found: Sequence[Priced]) -> None:
        """Keep answers to claims of a batch, which are listed again."""
        new = {name: (evidence, cost) for name, evidence, cost in found}

        def find(name: str, claim: Claim) -> Answer | None:
            if name in new:
                evidence, cost = new.pop(name)
                self._keep(job, name, Answer(claim, evidence), cost)
            return self.known.get(name)

        [*walk(job.batch, find)] if new else []

    def _keep(self, job: "_Job", name: str, answer: Answer, cost: Cost) -> None:
        self.costs[name] = cost
        store_of(job.batch, self.store, name).keep(name, answer)
        self._add(name, answer, cost)

    def _known_of(self, batch: Batch) -> dict[str, Answer]:
        """Return the known answers to claims of a batch."""
        found: dict[str, Answer] = {}

        def find(name: str, claim: Claim) -> Answer | None:
            return found.setdefault(name, self.known[name]) if name in self.known else None

        [*walk(batch, find)]
        return found

    def _ask_alone(self, batch: Batch, hands: Jobs) -> None:
        """Settle each claim of a batch in a process of its own; one whose process ends is in doubt."""
        while left := self._left_of(batch):
            [(name, claim)] = left

            def lose(job: "_Job", reason: Reason, asked: Claim = claim, named: str = name) -> list[Priced]:
                doubt = Doubt(Cause.PROCESS, (), job.store_of(named).work.effort.units, reason).kept
                return [(named, undecided(asked, reason, doubt=doubt).evidence, NO_COST)]

            job = _Job(batch, self._known_of(batch), self.store, alone=True)
            with closing(pool.work(_settle, [job, _NOTHING], hands, lose)) as answered:
                for _, found in answered:
                    self._take(job, found)


def store_of(batch: Batch, store: Store, name: str) -> Store:
    """Return the store with the work for a claim, where a batch has another than its question."""
    if isinstance(batch, WorkByName):
        return replace(store, work=batch.work_of(name))
    return replace(store, work=batch.work) if isinstance(batch, OwnWork) else store


@dataclass(frozen=True)
class _None:
    """No claim."""

    name: str = ""

    def steps(self) -> Any:
        yield from ()


@dataclass(frozen=True)
class _Job:
    """A batch, the answers to its claims that are known, and where further ones may be.

    ``alone``: whether one more claim is settled, and no other.
    """

    batch: Any
    known: Mapping[str, Answer]
    store: Store
    alone: bool = False

    def store_of(self, name: str) -> Store:
        """Return the store with the work that is allowed for a claim."""
        return store_of(self.batch, self.store, name)


_NOTHING = _Job(_None(), {}, Store(None, "", Work()))


def _settle(job: _Job) -> list[Priced]:
    """Settle what is left of a batch."""
    from roadproof.engines.search.batches import Engines  # here: known answers need no solver

    engines, new, known = Engines(job.store_of("").work), list[Priced](), dict(job.known)
    for drive in job.batch.seeds if isinstance(job.batch, Seeded) else ():
        engines.offer(drive)

    def answer_to(name: str, claim: Claim) -> Answer:
        if name in job.known:
            return job.known[name]
        store = job.store_of(name)
        found = store.look_up(name, claim)
        if found is not None and store.stands(found[0]):
            answer, cost = found[0], NO_COST
        else:
            proposed = job.batch.proposed(name, known) if isinstance(job.batch, Proposing) else ()
            answer, cost = replace(engines, work=store.work).settle(claim, proposed)
            answer = store.whole(store.exhausted(answer))
        new.append((name, answer.evidence, cost))
        return answer

    def find(name: str, claim: Claim) -> Answer | None:
        if job.alone and new:
            return None
        known[name] = answer_to(name, claim)
        engines.learn(known[name])
        return known[name]

    [*walk(job.batch, find)]
    return new


def _nobody(name: str, answer: Answer, cost: Cost) -> None:
    """Nobody listens."""
