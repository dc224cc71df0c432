"""Parallel execution of jobs with progress reports; results come as jobs finish."""

from __future__ import annotations

import os
from collections.abc import Callable, Generator, Sequence
from typing import TYPE_CHECKING, TypeAlias, TypeVar

from roadproof.errors import LostWorkError
from roadproof.runtime.executors import Jobs, executor_for

if TYPE_CHECKING:
    from roadproof.reasons import Reason

Job = TypeVar("Job")
Answer = TypeVar("Answer")

# Called with the number of finished jobs, their total, and the word for many jobs.
Progress: TypeAlias = Callable[[int, int, str], None]
# Called with a line of output that is printed even without progress.
Say: TypeAlias = Callable[[str], None]


def work(
    function: Callable[[Job], Answer],
    jobs: Sequence[Job],
    executor: Jobs,
    lost: Callable[[Job, Reason], Answer] | None = None,
    progress: Progress | None = None,
    what: str = "jobs",
    known: int = 0,
    fresh: bool = False,
) -> Generator[tuple[int, Answer], None, None]:
    """Yield the index of every job and ``function(job)``, as jobs finish.

    Close the iterator, or use it up. An error in a job, or an interruption, ends the other jobs.

    Args:
        executor: Runs the jobs: a number of processes, or an ``Executor``. One job runs in this process.
        lost: Makes an answer (UNKNOWN) for a job whose process died at each attempt, from the reason.
        progress: Called with the number of finished jobs, their total, and ``what``.
        what: The word for many jobs.
        known: The number of further jobs that needed no work.
        fresh: Processes share nothing with this one.

    Raises:
        LostWorkError: Without ``lost``, when all other jobs are finished.
    """
    resolved = executor_for(executor)
    if len(jobs) > 1:
        from roadproof.runtime.dispatch import run_jobs
        from roadproof.runtime.executors import LostJob
        from roadproof.runtime.worker import is_worker
    # A fresh process imports the user's script again; jobs=1 avoids that.
    is_alone = fresh and resolved.processes == 1 and resolved.cluster is None
    if len(jobs) <= 1 or is_worker() or is_alone:
        yield from enumerate(map(function, jobs))
        return
    total = known + len(jobs)
    reasons: list[str] = []
    report = progress or _nobody
    report(known, total, what)
    answers = run_jobs(function, jobs, resolved, fresh)
    try:
        for done, (place, answer) in enumerate(answers, known + 1):
            report(done, total, what)
            if not isinstance(answer, LostJob):
                yield place, answer
            elif lost is not None:
                yield place, lost(jobs[place], answer.reason)
            else:
                reasons.append(f"{place + 1} of {len(jobs)} {what}: {answer.reason}")
    finally:
        answers.close()
    if reasons:
        raise LostWorkError("left out: " + "; ".join(reasons))


def in_order(answers: Generator[tuple[int, Answer], None, None]) -> Generator[Answer, None, None]:
    """Yield the answers of ``work`` in the order of their jobs; those after a lost job come last."""
    early: dict[int, Answer] = {}
    place = 0
    try:
        for answer_place, answer in answers:
            early[answer_place] = answer
            while place in early:
                yield early.pop(place)
                place += 1
    except LostWorkError:
        yield from (early[answer_place] for answer_place in sorted(early))
        raise
    finally:
        answers.close()


def count_workers(jobs: Sequence[object], executor: Jobs) -> int:
    """Return how many local processes work on the jobs. Raises ``UsageError`` if that would be none."""
    return min(executor_for(executor).processes or os.cpu_count() or 1, len(jobs))


def _nobody(done: int, total: int, what: str) -> None:
    """Nobody listens."""
