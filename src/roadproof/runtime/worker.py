"""A worker process: how it starts, receives jobs, replies, and ends.

Process pools, the studio and the supervisor of a command use it. A process ends when its parent ends, for
whatever reason. It ignores Ctrl-C, which z3 would handle itself, and leaves it to its parent. After SIGTERM
it has a moment to remove half-written files.
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

from roadproof.runtime.progress import Stage, listening
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess

OUTSIDE = "from outside or for want of memory"
GRACE = 0.5  # seconds that a worker has to remove half-written files when it is dismissed
_THRESHOLDS = 5000, 20, 50  # of generations of Python's garbage collector
_DEATH_SIGNAL = 1  # PR_SET_PDEATHSIG of prctl(2)


@dataclass
class Fork:
    """A child process made by ``os.fork``, with the used methods of a ``multiprocessing`` process."""

    pid: int
    exitcode: int | None = None

    def join(self, timeout: float | None = None) -> None:
        """Wait until the process has ended, at most ``timeout`` seconds."""
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


def describe_exit(code: int) -> str:
    """Return the cause of a process's end from its exit code: ``SIGKILL``, or ``exited with 3``."""
    return signal.Signals(-code).name if code < 0 else f"exited with {code}"


def collect_rarely() -> None:
    """Make Python look for cycles less often: trees of formulas have none, and a look walks through them."""
    gc.set_threshold(*_THRESHOLDS)


def become_child_of(parent: int, terminate: Callable[[int, object], object]) -> None:
    """Make this process end with ``parent`` and react to SIGTERM alone; call it before anything else.

    ``terminate``: the handler of SIGTERM.
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
    """The reply of a worker to a job: its answer, or the error that it has raised."""

    answer: Any = None
    error: Exception | None = None


class DeadWorkerError(Exception):
    """The error for a worker that has ended; the message names the cause."""


class Worker:
    """A process that applies ``function`` to one job after another.

    ``fresh``: it shares nothing with this process, for libraries whose threads hold locks. ``heard``: it
    reports the stages of its jobs. Raises ``OSError`` if no process can be started.
    """

    def __init__(
        self, function: Callable[[Any], object], fresh: bool = False, reporting: bool = True
    ) -> None:
        import multiprocessing  # here, so that --help is fast

        context = multiprocessing.get_context("spawn" if fresh or sys.platform != "linux" else "fork")
        self.connection, other = context.Pipe()
        self.process = context.Process(  # type: ignore[attr-defined]
            target=_serve, args=(other, function, os.getpid(), reporting), daemon=True
        )
        try:
            self.process.start()
        finally:
            other.close()

    def send_job(self, job: object) -> None:
        """Send a job. If the process has died, ``receive`` raises the error."""
        with contextlib.suppress(OSError):
            self.connection.send(job)

    def receive(self) -> Stage | Reply:
        """Wait for a stage or the reply. Raises ``DeadWorkerError``."""
        try:
            message: Stage | Reply = self.connection.recv()
        except (EOFError, OSError):
            raise DeadWorkerError(self._cause_of_death()) from None
        return message

    def _cause_of_death(self) -> str:
        self.process.join(GRACE)
        code = self.process.exitcode
        if code is None:
            return "its pipe was closed"
        return f"{describe_exit(code)} ({OUTSIDE})" if code == -signal.SIGKILL else describe_exit(code)


def _serve(connection: "Connection", function: Callable[[Any], object], parent: int, reporting: bool) -> None:
    """Run jobs until the connection closes; the main function of a worker."""
    become_child_of(parent, lambda number, frame: sys.exit(128 + number))
    sys.unraisablehook = _end_soon
    gc.freeze()  # objects from before the fork are excluded from garbage collection
    while True:
        try:
            job = connection.recv()
        except (EOFError, OSError):
            return
        try:
            with listening(connection.send if reporting else _nobody):
                reply = Reply(function(job))
        except Exception as error:
            reply = Reply(error=error)
        try:
            connection.send(reply)
        except OSError:
            return
        except Exception as error:  # an answer that cannot be pickled
            message = f"{type(error).__name__}: {error}; of {reply.error or reply.answer!r:.200}"
            connection.send(Reply(error=RuntimeError(message)))


def _end_soon(ignored: Any) -> None:
    """Repeat an exit request that was lost because it came while an object was removed."""
    if not isinstance(ignored.exc_value, SystemExit):
        sys.__unraisablehook__(ignored)
    elif hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, lambda number, frame: sys.exit(128 + signal.SIGTERM))
        signal.setitimer(signal.ITIMER_REAL, 0.01)


def _nobody(stage: Stage) -> None:
    """Ignore a stage; a forked process must not call the listener that it has inherited."""


_ends_here = False


def mark_as_worker() -> None:
    """Mark this process as a worker, so that its jobs start no further processes."""
    global _ends_here
    _ends_here = True


def is_worker() -> bool:
    """Return whether this process works for another one."""
    import multiprocessing

    return _ends_here or multiprocessing.parent_process() is not None
