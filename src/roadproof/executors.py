"""Who does many jobs: local processes, or a cluster."""

from collections.abc import Callable, Generator, Sequence
from typing import TypeVar

from roadproof import workers
from roadproof.hands import Hands
from roadproof.workers import Lost

Job = TypeVar("Job")
Answer = TypeVar("Answer")


def answers_of(
    function: Callable[[Job], Answer], jobs: Sequence[Job], hands: Hands, fresh: bool = False
) -> Generator[tuple[int, Answer | Lost], None, None]:
    """``function`` of every job with its place, as ``answers_of`` of ``workers`` or ``cluster`` give it."""
    if hands.cluster is None:
        yield from workers.answers_of(function, jobs, hands.processes, fresh)
        return
    from roadproof import cluster  # dask takes long to import

    yield from cluster.answers_of(function, jobs, hands.cluster)
