"""Processes for many jobs, of which one that dies costs at most its own job."""

import os
from collections import deque
from collections.abc import Callable, Generator, Sequence
from functools import partial
from multiprocessing.connection import wait
from typing import Any, TypeVar

from roadproof.errors import UsageError
from roadproof.reasons import Why
from roadproof.runtime.executors import LostJob, try_again
from roadproof.runtime.progress import Stage, is_heard, pass_on
from roadproof.runtime.worker import GRACE, DeadWorkerError, Worker, dismiss

Job = TypeVar("Job")
Answer = TypeVar("Answer")


def answers_of(
    function: Callable[[Job], Answer], jobs: Sequence[Job], most: int | None = None, fresh: bool = False
) -> Generator[tuple[int, Answer | LostJob], None, None]:
    """``function`` of every job, each with its place in ``jobs``, in the order in which they are done.

    A job whose process dies is tried again when the others are done. ``fresh``: as for ``Worker``. The
    iterator is to be used up or closed. An error that a job raises is raised here, and ends the others.
    ``most``: processes at once, None for one a core.
    """
    start = partial(Worker, function, fresh, is_heard())

    def attempt(places: Sequence[int], died: dict[int, str]) -> Generator[tuple[int, Answer], None, None]:
        return _try_once(start, jobs, places, min(most or os.cpu_count() or 1, len(places)), died)

    yield from try_again(attempt, len(jobs), Why.PROCESS)


def _try_once(
    start: Callable[[], Worker],
    jobs: Sequence[Job],
    places: Sequence[int],
    processes: int,
    died: dict[int, str],
) -> Generator[tuple[int, Any], None, None]:
    """The answers at ``places``; where a process ended instead, ``died`` says by what."""
    waiting = deque(places)
    team: dict[Worker, int | None] = {}  # the place of the job that each is at
    try:
        while waiting or any(place is not None for place in team.values()):
            while waiting and (free := _free(team, processes, start)) is not None:
                place = waiting.popleft()
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
