"""Work for several processes, its results as they come, and word of how far it is."""

import os
from collections.abc import Callable, Generator, Sequence
from typing import TypeAlias, TypeVar

from roadproof.errors import LostError
from roadproof.reasons import Reason
from roadproof.runtime.executors import Jobs, hands_of

Job = TypeVar("Job")
Answer = TypeVar("Answer")

# Told of so many jobs that are done, of so many in all, and of the word for many of them.
Progress: TypeAlias = Callable[[int, int, str], None]
# Told what is said in any case, in a line.
Say: TypeAlias = Callable[[str], None]


def work(
    function: Callable[[Job], Answer],
    jobs: Sequence[Job],
    hands: Jobs,
    lost: Callable[[Job, Reason], Answer] | None = None,
    progress: Progress | None = None,
    what: str = "jobs",
    known: int = 0,
    fresh: bool = False,
) -> Generator[tuple[int, Answer], None, None]:
    """``function`` of every job with its place, in the order in which they are done.

    ``hands``: who does them; ``known``: how many jobs more needed no work. ``lost`` makes the
    answer, a doubt, of a job whose process ended each time (see ``workers``) out of the reason; without it
    ``LostError`` is raised when all others are done. The iterator is to be used up or closed. An error
    in a job, or an interruption, ends the others.
    """
    who = hands_of(hands)
    if len(jobs) > 1:
        from roadproof.runtime.dispatch import answers_of
        from roadproof.runtime.executors import LostJob
        from roadproof.runtime.worker import is_worker
    # A fresh process imports the script of the user again, who asks for none with one job at a time.
    is_alone = fresh and who.processes == 1 and who.cluster is None
    if len(jobs) <= 1 or is_worker() or is_alone:
        yield from enumerate(map(function, jobs))
        return
    total = known + len(jobs)
    reasons: list[str] = []
    told = progress or _nobody
    told(known, total, what)
    found = answers_of(function, jobs, who, fresh)
    try:
        for done, (place, answer) in enumerate(found, known + 1):
            told(done, total, what)
            if not isinstance(answer, LostJob):
                yield place, answer
            elif lost is not None:
                yield place, lost(jobs[place], answer.reason)
            else:
                reasons.append(f"{place + 1} of {len(jobs)} {what}: {answer.reason}")
    finally:
        found.close()
    if reasons:
        raise LostError("left out: " + "; ".join(reasons))


def in_order(answers: Generator[tuple[int, Answer], None, None]) -> Generator[Answer, None, None]:
    """The answers of ``work`` in the order of their jobs; those that wait for a lost one come last."""
    early: dict[int, Answer] = {}
    place = 0
    try:
        for found, answer in answers:
            early[found] = answer
            while place in early:
                yield early.pop(place)
                place += 1
    except LostError:
        yield from (early[found] for found in sorted(early))
        raise
    finally:
        answers.close()


def count_workers(jobs: Sequence[object], hands: Jobs) -> int:
    """How many processes here the jobs are given. Raises ``UsageError`` where none would be left."""
    return min(hands_of(hands).processes or os.cpu_count() or 1, len(jobs))


def _nobody(done: int, total: int, what: str) -> None:
    """Nobody listens."""
