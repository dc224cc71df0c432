"""Work for several processes, its results as they come, and a word about how far it is."""

import argparse
from collections.abc import Callable, Generator, Sequence
from typing import TypeVar

from roadproof.cli.numbers import add_jobs_option
from roadproof.cli.options import add_quiet_option
from roadproof.cli.progress import Counter
from roadproof.study import pool

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
    for _, answer in pool.work(function, jobs, processes, lost, _counter(what), what or "jobs", known):
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
    answers = pool.work(function, jobs, processes, lost, _counter(what), what or "jobs", fresh=fresh)
    return pool.in_order(answers)


def _counter(what: str) -> Counter | None:
    """Who tells how far it is; nobody where there is no word for the jobs."""
    return Counter() if what else None
