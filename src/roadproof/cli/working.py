"""Work for several processes, its results as they come, and a word about how far it is."""

import os
import sys
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from typing import TypeVar

from roadproof.errors import UsageError

Job = TypeVar("Job")
Answer = TypeVar("Answer")


def work(
    function: Callable[[Job], Answer], jobs: Sequence[Job], processes: int | None
) -> Generator[Answer, None, None]:
    """``function`` of every job, in the order in which they are done; ``processes`` None is one a core.

    The iterator is to be used up or closed. An error in a job, or an interruption, ends the others.
    """
    workers = count_workers(jobs, processes)
    if workers <= 1:
        yield from map(function, jobs)
        return
    with _pool(workers) as pool:
        for future in as_completed([pool.submit(function, job) for job in jobs]):
            yield future.result()


def work_in_order(
    function: Callable[[Job], Answer], jobs: Sequence[Job], processes: int | None
) -> Generator[Answer, None, None]:
    """As ``work``, but in the order of ``jobs``."""
    workers = count_workers(jobs, processes)
    if workers <= 1:
        yield from map(function, jobs)
        return
    with _pool(workers) as pool:
        yield from pool.map(function, jobs, chunksize=4 if len(jobs) > 100 else 1)


def count_workers(jobs: Sequence[object], processes: int | None) -> int:
    """How many processes the jobs are given. Raises ``UsageError`` where none would be left."""
    if processes is not None and processes < 1:
        raise UsageError(f"--jobs {processes} must be greater than 0")
    return min(processes or os.cpu_count() or 1, len(jobs))


@contextmanager
def _pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    pool = ProcessPoolExecutor(workers)
    try:
        yield pool
    except BaseException:
        # Without this, a run that failed or was interrupted would wait for every job still queued.
        for process in list((pool._processes or {}).values()):
            process.kill()
        raise
    finally:
        pool.shutdown(cancel_futures=True)


def tell(text: str, last: bool = False) -> None:
    """Progress on stderr: one line that changes, and nothing where nobody looks."""
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="\n" if last else "", file=sys.stderr, flush=True)
