"""Work for several processes, its results as they come, and a word about how far it is."""

import argparse
import os
import time
from collections.abc import Callable, Generator, Sequence
from typing import TypeVar

from roadproof.cli.numbers import add_jobs_option
from roadproof.cli.options import add_quiet_option
from roadproof.cli.progress import tell, time_left
from roadproof.errors import LostError, UsageError

Job = TypeVar("Job")
Answer = TypeVar("Answer")


def add_working_options(parser: argparse.ArgumentParser) -> None:
    """``--jobs`` and ``--quiet``."""
    add_jobs_option(parser)
    add_quiet_option(parser)


def work(
    function: Callable[[Job], Answer],
    jobs: Sequence[Job],
    processes: int | None,
    what: str = "",
    lost: Callable[[Job, str], Answer] | None = None,
    known: int = 0,
) -> Generator[Answer, None, None]:
    """``function`` of every job, in the order in which they are done; ``processes`` None is one a core.

    ``what`` is the word for many jobs, and ``known`` how many of them need no work, for the word about
    how far it is. ``lost`` makes the answer, a doubt, of a job whose process ended twice (see
    ``workers``) out of the reason; without it ``LostError`` is raised when all others are done. The
    iterator is to be used up or closed. An error in a job, or an interruption, ends the others.
    """
    for _, answer in _answers(function, jobs, processes, what, lost, known):
        yield answer


def work_in_order(
    function: Callable[[Job], Answer],
    jobs: Sequence[Job],
    processes: int | None,
    what: str = "",
    lost: Callable[[Job, str], Answer] | None = None,
    fresh: bool = False,
) -> Generator[Answer, None, None]:
    """As ``work``, but in the order of ``jobs``; in ``fresh`` processes, see ``workers``."""
    early: dict[int, Answer] = {}
    place = 0
    try:
        for found, answer in _answers(function, jobs, processes, what, lost, fresh=fresh):
            early[found] = answer
            while place in early:
                yield early.pop(place)
                place += 1
    except LostError:
        yield from (early[found] for found in sorted(early))
        raise


def count_workers(jobs: Sequence[object], processes: int | None) -> int:
    """How many processes the jobs are given. Raises ``UsageError`` where none would be left."""
    if processes is not None and processes < 1:
        raise UsageError(f"--jobs {processes} must be greater than 0")
    return min(processes or os.cpu_count() or 1, len(jobs))


def _answers(
    function: Callable[[Job], Answer],
    jobs: Sequence[Job],
    processes: int | None,
    what: str,
    lost: Callable[[Job, str], Answer] | None,
    known: int = 0,
    fresh: bool = False,
) -> Generator[tuple[int, Answer], None, None]:
    workers = count_workers(jobs, processes)
    if len(jobs) > 1:
        from roadproof.workers import Lost, answers_of, is_worker
    if len(jobs) <= 1 or is_worker():
        yield from enumerate(map(function, jobs))
        return
    begun = time.monotonic()
    total = known + len(jobs)
    reasons: list[str] = []
    _tell_count(known, total, what, "")
    found = answers_of(function, jobs, workers, fresh)
    try:
        for done, (place, answer) in enumerate(found, 1):
            left = time_left(time.monotonic() - begun, done, len(jobs))
            _tell_count(known + done, total, what, left)
            if not isinstance(answer, Lost):
                yield place, answer
            elif lost is not None:
                yield place, lost(jobs[place], answer.reason)
            else:
                reasons.append(f"{place + 1} of {len(jobs)} {what or 'jobs'}: {answer.reason}")
    finally:
        found.close()
    if reasons:
        raise LostError("left out: " + "; ".join(reasons))


def _tell_count(done: int, total: int, what: str, left: str) -> None:
    if what:
        tell(f"{done} of {total} {what}{left}", last=done == total)
