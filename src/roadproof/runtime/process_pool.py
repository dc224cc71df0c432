"""Processes for many jobs, of which one that dies costs at most its own job."""

import os
import sys
from collections import deque
from collections.abc import Callable, Generator, Hashable, Sequence
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import wait
from typing import Any, Generic, Protocol, TypeVar, runtime_checkable

from roadproof.errors import UsageError
from roadproof.reasons import Why
from roadproof.runtime.executors import LostJob, try_again
from roadproof.runtime.progress import Stage, is_heard, pass_on
from roadproof.runtime.worker import GRACE, DeadWorkerError, Worker, dismiss

Job = TypeVar("Job")
Answer = TypeVar("Answer")


@runtime_checkable
class Kindred(Protocol):
    """A job of which a worker that did another of its kin may have done a part."""

    @property
    def kin(self) -> Hashable:
        """What is equal for jobs that have much in common."""


def answers_of(
    function: Callable[[Job], Answer], jobs: Sequence[Job], most: int | None = None, fresh: bool = False
) -> Generator[tuple[int, Answer | LostJob], None, None]:
    """``function`` of every job, each with its place in ``jobs``, in the order in which they are done.

    They are given out in order, but kin to one worker as far as others have work. A job whose process dies is
    tried again when the others are done. ``fresh``: as for ``Worker``. The iterator is to be used up or
    closed. An error that a job raises is raised here, and ends the others. ``most``: processes at once, None
    for one a core.
    """
    is_copy = not fresh and sys.platform == "linux"
    does: Callable[[Any], Answer] = _AtPlace(function, jobs) if is_copy else function
    start = partial(Worker, does, fresh, is_heard())
    asked: Sequence[object] = range(len(jobs)) if is_copy else jobs

    def attempt(places: Sequence[int], died: dict[int, str]) -> Generator[tuple[int, Answer], None, None]:
        waiting = _Waiting(jobs, places)
        return _try_once(start, asked, waiting, min(most or os.cpu_count() or 1, len(places)), died)

    yield from try_again(attempt, len(jobs), Why.PROCESS)


@dataclass(frozen=True)
class _AtPlace(Generic[Job, Answer]):
    """Does the job at a place. A process that is a copy of this one has the jobs, so none is sent."""

    function: Callable[[Job], Answer]
    jobs: Sequence[Job]

    def __call__(self, place: int) -> Answer:
        return self.function(self.jobs[place])


def _try_once(
    start: Callable[[], Worker],
    jobs: Sequence[object],
    waiting: "_Waiting",
    processes: int,
    died: dict[int, str],
) -> Generator[tuple[int, Any], None, None]:
    """The answers at places that are waiting; where a process ended instead, ``died`` says by what.

    ``jobs``: what a worker is asked at each place.
    """
    team: dict[Worker, int | None] = {}  # the place of the job that each is at
    try:
        while waiting or any(place is not None for place in team.values()):
            while waiting and (free := _free(team, processes, start)) is not None:
                place = waiting.pop(free)
                team[free] = place
                free.ask(jobs[place])
            busy = {worker.connection: (worker, at) for worker, at in team.items() if at is not None}
            for connection in wait(list(busy)):
                worker, place = busy[connection]  # type: ignore[index]
                try:
                    said = worker.hear()
                except DeadWorkerError as death:
                    died[place] = str(death)
                    del team[worker]
                    continue
                if isinstance(said, Stage):
                    pass_on(said)
                elif said.error is not None:
                    raise said.error
                else:
                    team[worker] = None
                    yield place, said.answer
    finally:
        dismiss([worker.process for worker in team], GRACE)
        for worker in team:
            worker.connection.close()


class _Waiting:
    """The places of jobs that no worker was given yet."""

    def __init__(self, jobs: Sequence[object], places: Sequence[int]) -> None:
        self.kin = {x: job.kin for x in places if isinstance(job := jobs[x], Kindred)}
        self.places = deque(places)
        self.last: dict[object, Hashable] = {}  # of what kin the last job of each worker was

    def __bool__(self) -> bool:
        return bool(self.places)

    def pop(self, worker: object) -> int:
        """The first of the kin that a worker did last, else the first of a kin that no worker did last."""
        if not self.kin:
            return self.places.popleft()
        taken, mine = {*self.last.values()}, self.last.get(worker)
        alike = (x for x in self.places if worker in self.last and self.kin.get(x) == mine)
        new = (x for x in self.places if self.kin.get(x) not in taken)
        place = next(alike, next(new, self.places[0]))
        self.places.remove(place)
        self.last[worker] = self.kin.get(place)
        return place


def _free(team: dict[Worker, int | None], processes: int, start: Callable[[], Worker]) -> Worker | None:
    """A worker without a job, a new one if there may be one more, or None."""
    for worker in [worker for worker, place in team.items() if place is None]:
        if worker.process.is_alive():
            return worker
        del team[worker]
    if len(team) >= processes:
        return None
    try:
        made = start()
    except OSError as error:
        if team:
            return None
        raise UsageError(f"cannot start processes: {error.strerror}; use fewer with --jobs") from None
    team[made] = None
    return made
