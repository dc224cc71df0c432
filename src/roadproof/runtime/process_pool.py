"""Processes for many jobs: they end when their parent ends, and one that dies costs at most its own job."""

import contextlib
import gc
import multiprocessing
import os
import signal
import sys
import time
from collections import deque
from collections.abc import Callable, Generator, Sequence
from functools import partial
from multiprocessing.connection import wait
from typing import Any, TypeVar

from roadproof.errors import UsageError
from roadproof.runtime.executors import OUTSIDE, LostJob, ended_by, try_twice
from roadproof.runtime.parent_watchdog import die_with
from roadproof.runtime.progress import Stage, is_heard, listening, pass_on

Job = TypeVar("Job")
Answer = TypeVar("Answer")

_PATIENCE = 0.5  # seconds that a worker has to remove half-written files when it is dismissed


def answers_of(
    function: Callable[[Job], Answer], jobs: Sequence[Job], most: int | None = None, fresh: bool = False
) -> Generator[tuple[int, Answer | LostJob], None, None]:
    """``function`` of every job, each with its place in ``jobs``, in the order in which they are done.

    A job whose process dies is tried again when the others are done, alone. ``fresh`` processes share
    nothing with this one, for libraries whose threads hold locks. The iterator is to be used up or closed.
    An error that a job raises is raised here, and ends the others. ``most``: processes at once, None for one
    a core.
    """
    start = partial(_Worker, function, fresh)

    def attempt(places: Sequence[int], died: dict[int, str]) -> Generator[tuple[int, Answer], None, None]:
        return _try_once(start, jobs, places, min(most or os.cpu_count() or 1, len(places)), died)

    yield from try_twice(attempt, len(jobs), "its process ended twice, the second time alone: ")


def _try_once(
    start: "Callable[[], _Worker]",
    jobs: Sequence[Job],
    places: Sequence[int],
    processes: int,
    died: dict[int, str],
) -> Generator[tuple[int, Any], None, None]:
    """The answers at ``places``; where a process ended instead, ``died`` says by what."""
    waiting = deque(places)
    team: list[_Worker] = []
    try:
        while waiting or any(worker.place is not None for worker in team):
            while waiting and (worker := _free(team, processes, start)) is not None:
                worker.take(waiting[0], jobs[waiting[0]])
                waiting.popleft()
            busy = {worker.connection: worker for worker in team if worker.place is not None}
            for connection in wait(list(busy)):
                worker = busy[connection]  # type: ignore[index]
                place = worker.place
                assert place is not None
                try:
                    well, answer = worker.connection.recv()
                except (EOFError, OSError):
                    died[place] = worker.cause_of_death()
                    team.remove(worker)
                    continue
                if isinstance(answer, Stage):
                    pass_on(answer)
                    continue
                if not well:
                    raise answer
                worker.place = None
                yield place, answer
    finally:
        _dismiss(team)


def _free(team: "list[_Worker]", processes: int, start: "Callable[[], _Worker]") -> "_Worker | None":
    """A worker without a job, a new one if there may be one more, or None."""
    for worker in list(team):
        if worker.place is None and worker.process.is_alive():
            return worker
        if worker.place is None:
            team.remove(worker)
    if len(team) >= processes:
        return None
    try:
        team.append(start())
    except OSError as error:
        if team:
            return None
        raise UsageError(f"cannot start processes: {error.strerror}; use fewer with --jobs") from None
    return team[-1]


class _Worker:
    """A process that does one job after another; ``place`` is that of the job it is at."""

    def __init__(self, function: Callable[..., object], fresh: bool) -> None:
        context = multiprocessing.get_context("spawn" if fresh or sys.platform != "linux" else "fork")
        self.place: int | None = None
        self.connection, other = context.Pipe()
        self.process = context.Process(  # type: ignore[attr-defined]
            target=_serve, args=(other, function, os.getpid(), is_heard()), daemon=True
        )
        try:
            self.process.start()
        finally:
            other.close()

    def take(self, place: int, job: object) -> None:
        self.place = place
        with contextlib.suppress(OSError):  # it has died, which is seen where its answer is read
            self.connection.send(job)

    def cause_of_death(self) -> str:
        self.process.join(_PATIENCE)
        code = self.process.exitcode
        if code is None:
            return "its pipe was closed"
        return f"{ended_by(code)} ({OUTSIDE})" if code == -signal.SIGKILL else ended_by(code)


def _dismiss(team: "Sequence[_Worker]") -> None:
    """End all workers: the idle at once, the others after they had time to remove half-written files."""
    for worker in team:
        if worker.process.is_alive():
            worker.process.terminate()
    latest = time.monotonic() + _PATIENCE
    for worker in team:
        worker.process.join(max(0.0, latest - time.monotonic()))
        if worker.process.is_alive():
            worker.process.kill()
            worker.process.join()
        worker.connection.close()


def _end_soon(ignored: Any) -> None:
    """An exit that came while an object was removed is lost there: ask for it again a moment later."""
    if not isinstance(ignored.exc_value, SystemExit):
        sys.__unraisablehook__(ignored)
    elif hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, lambda number, frame: sys.exit(128 + signal.SIGTERM))
        signal.setitimer(signal.ITIMER_REAL, 0.01)


def _serve(connection: Any, function: Callable[[Any], object], parent: int, heard: bool) -> None:
    """What a worker does all its life. Ctrl-C is its parent's business, which z3 would take as its own."""
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(128 + number))
    sys.unraisablehook = _end_soon
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})
    die_with(parent)
    gc.freeze()  # what was there before the fork stays, and is not walked through at each collection
    while True:
        try:
            job = connection.recv()
        except (EOFError, OSError):
            return
        try:
            with listening(partial(_send_stage, connection) if heard else _nobody):
                reply: tuple[bool, object] = True, function(job)
        except Exception as error:
            reply = False, error
        try:
            connection.send(reply)
        except OSError:
            return
        except Exception as error:  # what cannot be pickled
            connection.send((False, RuntimeError(f"{type(error).__name__}: {error}; of {reply[1]!r:.200}")))


def _send_stage(connection: Any, stage: Stage) -> None:
    connection.send((True, stage))


def _nobody(stage: Stage) -> None:
    """Nobody listens; the listener of the process that this one is a copy of is no longer there."""


_ends_here = False


def end_here() -> None:
    """This process works for another, whoever started it: what it is asked is not divided again."""
    global _ends_here
    _ends_here = True


def is_worker() -> bool:
    """Whether this process is one of several that work for another."""
    return _ends_here or multiprocessing.parent_process() is not None
