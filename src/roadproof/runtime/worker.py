"""A process that works for another: how it begins, how it is asked and heard, and how it ends.

Pools of processes, the studio and the supervisor of a command all use it. A process ends when the one that
has started it ends, in whatever way. It leaves Ctrl-C to that one, since z3 would take it as its own. Asked
to end by SIGTERM it has a moment to remove half-written files.
"""

import contextlib
import gc
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from roadproof.runtime.memory import collect_rarely
from roadproof.runtime.progress import Stage, listening
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess

OUTSIDE = "from outside or for want of memory"
GRACE = 0.5  # seconds that a worker has to remove half-written files when it is dismissed
_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of prctl(2)


@dataclass
class Fork:
    """A child that ``os.fork`` has made, with what is needed of a process of ``multiprocessing``."""

    pid: int
    exitcode: int | None = None

    def join(self, timeout: float | None = None) -> None:
        latest = None if timeout is None else time.monotonic() + timeout
        while self.exitcode is None:
            gone, status = os.waitpid(self.pid, 0 if latest is None else os.WNOHANG)
            if gone:
                self.exitcode = os.waitstatus_to_exitcode(status)
            elif latest is not None and time.monotonic() >= latest:
                return
            else:
                time.sleep(0.01)

    def terminate(self) -> None:
        os.kill(self.pid, signal.SIGTERM)

    def kill(self) -> None:
        os.kill(self.pid, signal.SIGKILL)


def dismiss(processes: "Sequence[Fork | BaseProcess]", grace: float) -> None:
    """Ask processes to end, and kill those that live after ``grace`` seconds."""
    for process in processes:
        if process.exitcode is None:
            process.terminate()
    latest = time.monotonic() + grace
    for process in processes:
        process.join(max(0.0, latest - time.monotonic()))
        if process.exitcode is None:
            process.kill()
            process.join()


def ended_by(code: int) -> str:
    """What ended a process, from its exit code: ``SIGKILL``, or ``exited with 3``."""
    return signal.Signals(-code).name if code < 0 else f"exited with {code}"


def work_for(parent: int, terminate: Callable[[int, object], object]) -> None:
    """In a child of ``parent``, before it does anything: it ends with its parent, and hears only SIGTERM.

    ``terminate`` is what it does then.
    """
    collect_rarely()
    signal.signal(signal.SIGTERM, terminate)
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})
    if sys.platform == "linux":
        import ctypes

        ctypes.CDLL(None).prctl(_DEATH_SIGNAL, int(signal.SIGKILL))
    else:
        threading.Thread(target=_look_for, args=(parent,), daemon=True).start()
    if os.getppid() != parent:
        os._exit(128 + signal.SIGKILL)


def _look_for(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(1)
    os._exit(128 + signal.SIGKILL)


@dataclass(frozen=True)
class Reply:
    """The last word of a worker about a job: its answer, or the error that it has raised."""

    answer: Any = None
    error: Exception | None = None


class DeadWorkerError(Exception):
    """A worker has ended; the message says by what."""


class Worker:
    """A process that does one job after another: ``function`` of each.

    ``fresh``: it shares nothing with this process, for libraries whose threads hold locks. ``heard``: it
    tells the stages of its jobs. Raises ``OSError`` where no process can be started.
    """

    def __init__(self, function: Callable[[Any], object], fresh: bool = False, heard: bool = True) -> None:
        import multiprocessing  # here, because --help need not wait for it

        context = multiprocessing.get_context("spawn" if fresh or sys.platform != "linux" else "fork")
        self.connection, other = context.Pipe()
        self.process = context.Process(  # type: ignore[attr-defined]
            target=_serve, args=(other, function, os.getpid(), heard), daemon=True
        )
        try:
            self.process.start()
        finally:
            other.close()

    def ask(self, job: object) -> None:
        """Give it a job. It may have died, which is told where its reply is heard."""
        with contextlib.suppress(OSError):
            self.connection.send(job)

    def hear(self) -> Stage | Reply:
        """Wait for its next word. Raises ``DeadWorkerError``."""
        try:
            said: Stage | Reply = self.connection.recv()
        except (EOFError, OSError):
            raise DeadWorkerError(self._cause_of_death()) from None
        return said

    def _cause_of_death(self) -> str:
        self.process.join(GRACE)
        code = self.process.exitcode
        if code is None:
            return "its pipe was closed"
        return f"{ended_by(code)} ({OUTSIDE})" if code == -signal.SIGKILL else ended_by(code)


def _serve(connection: "Connection", function: Callable[[Any], object], parent: int, heard: bool) -> None:
    """What a worker does all its life."""
    work_for(parent, lambda number, frame: sys.exit(128 + number))
    sys.unraisablehook = _end_soon
    gc.freeze()  # what was there before the fork stays, and is not walked through at each collection
    while True:
        try:
            job = connection.recv()
        except (EOFError, OSError):
            return
        try:
            with listening(connection.send if heard else _nobody):
                reply = Reply(function(job))
        except Exception as error:
            reply = Reply(error=error)
        try:
            connection.send(reply)
        except OSError:
            return
        except Exception as error:  # what cannot be pickled
            told = f"{type(error).__name__}: {error}; of {reply.error or reply.answer!r:.200}"
            connection.send(Reply(error=RuntimeError(told)))


def _end_soon(ignored: Any) -> None:
    """An exit that came while an object was removed is lost there: ask for it again a moment later."""
    if not isinstance(ignored.exc_value, SystemExit):
        sys.__unraisablehook__(ignored)
    elif hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, lambda number, frame: sys.exit(128 + signal.SIGTERM))
        signal.setitimer(signal.ITIMER_REAL, 0.01)


def _nobody(stage: Stage) -> None:
    """Nobody listens; the listener of the process that this one is a copy of is no longer there."""


_ends_here = False


def end_here() -> None:
    """This process works for another, whoever started it: what it is asked is not divided again."""
    global _ends_here
    _ends_here = True


def is_worker() -> bool:
    """Whether this process is one of several that work for another."""
    import multiprocessing

    return _ends_here or multiprocessing.parent_process() is not None
