"""Jobs given to processes of this machine, or to a cluster."""

from collections.abc import Callable, Generator, Sequence
from typing import TypeVar

from roadproof.runtime.executors import Executor, LostJob

Job = TypeVar("Job")
Answer = TypeVar("Answer")


def answers_of(
    function: Callable[[Job], Answer], jobs: Sequence[Job], hands: Executor, fresh: bool = False
) -> Generator[tuple[int, Answer | LostJob], None, None]:
    """Yield the place of each job with its answer, in the order in which they end."""
    if hands.cluster is None:
        from roadproof.runtime import process_pool

        yield from process_pool.answers_of(function, jobs, hands.processes, fresh)
        return
    from roadproof.runtime import dask_executor  # dask takes long to import

    yield from dask_executor.answers_of(function, jobs, hands.cluster)
