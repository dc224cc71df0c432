"""A pool of local processes that survives the death of any of them."""

import os
import sys
from collections import deque
from collections.abc import Callable, Generator, Hashable, Sequence
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import wait
from typing import Any, Generic, Protocol, TypeVar, runtime_checkable

from roadproof.errors import UsageError
from roadproof.reasons import ReasonKind
from roadproof.runtime.executors import LostJob, run_with_retries
from roadproof.runtime.progress import Stage, forward, has_listener
from roadproof.runtime.worker import GRACE, DeadWorkerError, Worker, dismiss

Job = TypeVar("Job")
Answer = TypeVar("Answer")


@runtime_checkable
class HasAffinity(Protocol):
    """A job that is faster on a worker that has done a related job."""

    @property
    def affinity(self) -> Hashable:
        """A value that is equal for related jobs."""


def run_jobs(
    function: Callable[[Job], Answer], jobs: Sequence[Job], most: int | None = None, fresh: bool = False
) -> Generator[tuple[int, Answer | LostJob], None, None]:
    """Yield the index and the answer of every job, as jobs finish.

    Jobs start in order, but related jobs go to one worker while there is enough other work. A job whose
    process dies is tried again when the others are done. An error that a job raises is raised here, and ends
    the others. Close the iterator, or use it up.

    Args:
        most: The largest number of processes, None for one a core.
        fresh: As for ``Worker``.
    """
    is_copy = not fresh and sys.platform == "linux"
    task: Callable[[Any], Answer] = _JobAtPlace(function, jobs) if is_copy else function
    start = partial(Worker, task, fresh, has_listener())
    requests: Sequence[object] = range(len(jobs)) if is_copy else jobs

    def attempt(places: Sequence[int], died: dict[int, str]) -> Generator[tuple[int, Answer], None, None]:
        waiting = _Waiting(jobs, places)
        return _run_once(start, requests, waiting, min(most or os.cpu_count() or 1, len(places)), died)

    yield from run_with_retries(attempt, len(jobs), ReasonKind.PROCESS)


@dataclass(frozen=True)
class _JobAtPlace(Generic[Job, Answer]):
    """A function that does the job at an index; a forked process has the jobs already, so none is sent."""

    function: Callable[[Job], Answer]
    jobs: Sequence[Job]

    def __call__(self, place: int) -> Answer:
        return self.function(self.jobs[place])


def _run_once(
    start: Callable[[], Worker],
    jobs: Sequence[object],
    waiting: "_Waiting",
    processes: int,
    died: dict[int, str],
) -> Generator[tuple[int, Any], None, None]:
    """Yield the answers at the waiting indices; if a process dies, ``died`` gets the index and the cause.

    ``jobs``: the request that is sent to a worker for each index.
    """
    team: dict[Worker, int | None] = {}  # the index of each worker's current job
    try:
        while waiting or any(place is not None for place in team.values()):
            while waiting and (free := _free(team, processes, start)) is not None:
                place = waiting.pop(free)
                team[free] = place
                free.send_job(jobs[place])
            busy = {worker.connection: (worker, at) for worker, at in team.items() if at is not None}
            for connection in wait(list(busy)):
                worker, place = busy[connection]  # type: ignore[index]
                try:
                    message = worker.receive()
                except DeadWorkerError as death:
                    died[place] = str(death)
                    del team[worker]
                    continue
                if isinstance(message, Stage):
                    forward(message)
                elif message.error is not None:
                    raise message.error
                else:
                    team[worker] = None
                    yield place, message.answer
    finally:
        dismiss([worker.process for worker in team], GRACE)
        for worker in team:
            worker.connection.close()


class _Waiting:
    """The indices of jobs that no worker has started."""

    def __init__(self, jobs: Sequence[object], places: Sequence[int]) -> None:
        self.affinity = {x: job.affinity for x in places if isinstance(job := jobs[x], HasAffinity)}
        self.places = deque(places)
        self.last: dict[object, Hashable] = {}  # the affinity of the last job of each worker

    def __bool__(self) -> bool:
        return bool(self.places)

    def pop(self, worker: object) -> int:
        """Return the next index for a worker: a related job, else one unrelated to any worker's last job."""
        if not self.affinity:
            return self.places.popleft()
        claimed, last_affinity = {*self.last.values()}, self.last.get(worker)
        related = (x for x in self.places if worker in self.last and self.affinity.get(x) == last_affinity)
        unclaimed = (x for x in self.places if self.affinity.get(x) not in claimed)
        place = next(related, next(unclaimed, self.places[0]))
        self.places.remove(place)
        self.last[worker] = self.affinity.get(place)
        return place


def _free(team: dict[Worker, int | None], processes: int, start: Callable[[], Worker]) -> Worker | None:
    """Return an idle worker, a new one if the limit allows it, or None."""
    for worker in [worker for worker, place in team.items() if place is None]:
        if worker.process.is_alive():
            return worker
        del team[worker]
    if len(team) >= processes:
        return None
    try:
        new_worker = start()
    except OSError as error:
        if team:
            return None
        raise UsageError(f"cannot start processes: {error.strerror}; use fewer with --jobs") from None
    team[new_worker] = None
    return new_worker
