"""Execution of jobs in processes of this machine, or on a cluster."""

from collections.abc import Callable, Generator, Sequence
from typing import TypeVar

from roadproof.runtime.executors import Executor, LostJob

Job = TypeVar("Job")
Answer = TypeVar("Answer")


def run_jobs(
    function: Callable[[Job], Answer], jobs: Sequence[Job], executor: Executor, fresh: bool = False
) -> Generator[tuple[int, Answer | LostJob], None, None]:
    """Yield the index of each job with its answer, as jobs finish.

    ``fresh``: processes share nothing with this one (see ``worker.Worker``).
    """
    if executor.cluster is None:
        from roadproof.runtime import process_pool

        yield from process_pool.run_jobs(function, jobs, executor.processes, fresh)
        return
    from roadproof.runtime import dask_executor  # dask takes long to import

    yield from dask_executor.run_jobs(function, jobs, executor.cluster)
