"""Jobs of tests are done in the process of the test, where it does not ask for several processes.

A process for each question costs more than most of the answers: it is a copy of one with all of the package,
or, beside polars, a new one that imports it. Tests of processes, shards and clusters say ``jobs=2`` or more,
or start the command.
"""

from collections.abc import Callable, Generator, Sequence
from typing import TypeVar

from roadproof.runtime import dispatch, worker
from roadproof.runtime.executors import Executor, LostJob

Job = TypeVar("Job")
Answer = TypeVar("Answer")
_in_processes = dispatch.run_jobs


def run_jobs(
    function: Callable[[Job], Answer], jobs: Sequence[Job], hands: Executor, fresh: bool = False
) -> Generator[tuple[int, Answer | LostJob], None, None]:
    """As ``dispatch.run_jobs``; with one process, or as many as there are cores, none is started."""
    if hands.cluster is not None or hands.processes not in (None, 1):
        yield from _in_processes(function, jobs, hands, fresh)
        return
    for place, job in enumerate(jobs):
        before, worker._ends_here = worker._ends_here, True
        try:
            answer = function(job)
        finally:
            worker._ends_here = before
        yield place, answer


def work_here() -> None:
    """Before anything imports ``dispatch.run_jobs`` by name."""
    dispatch.run_jobs = run_jobs
