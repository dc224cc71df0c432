"""The command runs in a process of its own, and this one watches it: so it can always be ended.

A solver may keep Python from seeing a signal for minutes, and z3 takes Ctrl-C as "stop this query".
"""

import contextlib
import os
import select
import signal
import sys
import time
from collections.abc import Callable

from roadproof.frontends.cli import progress
from roadproof.runtime.executors import OUTSIDE, ended_by
from roadproof.runtime.parent_watchdog import die_with
from roadproof.verdict import ExitCode

GRACE = 2.0  # seconds that the command has to remove half-written files when it is to end
BEAT = 30.0  # seconds between two words about how far it is


class _EndedError(Exception):
    def __init__(self, signal_number: int) -> None:
        super().__init__(signal_number)
        self.signal_number = signal_number


def supervise(command: Callable[[], int]) -> int:
    """The exit code of ``command``, done in a child; 130 after SIGINT and 143 after SIGTERM.

    The child and its workers end with this process, whatever ends it. Returns twice, as a fork does.
    """
    if not hasattr(os, "fork"):
        return command()
    signals = {s for s in (signal.SIGINT, signal.SIGTERM) if signal.getsignal(s) is not signal.SIG_IGN}
    signal.pthread_sigmask(signal.SIG_BLOCK, signals)
    told, telling = os.pipe()
    parent = os.getpid()
    child = os.fork()
    if child == 0:
        os.close(told)
        progress.report_to(telling)
        die_with(parent)
        signal.signal(signal.SIGTERM, _interrupt)
        # SIGINT stays blocked, as z3 would answer it; the parent sends SIGTERM instead.
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTERM})
        return command()
    os.close(telling)
    try:
        for number in signals:
            signal.signal(number, _raise_ended)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, signals)
        _listen(told)
        _, status = os.waitpid(child, 0)
    except _EndedError as ended:
        for number in signals:
            signal.signal(number, signal.SIG_IGN)
        return _end(child, ended.signal_number)
    return _code_of(status)


def _interrupt(number: int, frame: object) -> None:
    signal.signal(number, signal.SIG_IGN)
    sys.unraisablehook = lambda unraisable: None  # of objects that this leaves half made, as z3's are
    raise KeyboardInterrupt


def _raise_ended(number: int, frame: object) -> None:
    raise _EndedError(number)


def _end(child: int, number: int) -> int:
    """Ask the child to end, and make it end; 128 and the signal's number, as shells count."""
    with contextlib.suppress(ProcessLookupError, ChildProcessError):
        os.kill(child, signal.SIGTERM)
        latest = time.monotonic() + GRACE
        gone, status = os.waitpid(child, os.WNOHANG)
        while not gone and time.monotonic() < latest:
            time.sleep(0.01)
            gone, status = os.waitpid(child, os.WNOHANG)
        if not gone:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
        if not gone or os.waitstatus_to_exitcode(status) != ExitCode.INTERRUPTED:
            _say("interrupted")
    return 128 + number


def _code_of(status: int) -> int:
    code = os.waitstatus_to_exitcode(status)
    if code >= 0:
        return code
    if code == -signal.SIGKILL:
        told = "what was written before is whole, what is missing is unknown"
        _say(f"ended by {ended_by(code)}, {OUTSIDE}: {told}")
        return ExitCode.UNKNOWN
    _say(f"this is our fault: ended by {ended_by(code)}; report it with the command line.")
    return ExitCode.OUR_FAULT


def _listen(told: int) -> None:
    """Hear how far the command is until it ends; say it now and then, unless a terminal shows it."""
    begun = last = time.monotonic()
    shown = sys.stderr is None or sys.stderr.isatty() or bool(os.environ.get(progress.QUIET))
    word, rest = "still working", b""
    while True:
        ready, _, _ = select.select([told], [], [], max(0.0, last + BEAT - time.monotonic()))
        if ready:
            heard = os.read(told, 65536)
            if not heard:
                return
            *lines, rest = (rest + heard).split(b"\n")
            for text in (line.decode("utf-8", "replace") for line in lines):
                shown = shown or progress.wants_quiet(text)
                word = text
        if time.monotonic() >= last + BEAT:
            last = time.monotonic()
            if not shown:
                _say(f"{word} (after {progress.duration(last - begun)})")


def _say(text: str) -> None:
    with contextlib.suppress(OSError, AttributeError):
        print(f"roadproof: {text}", file=sys.stderr, flush=True)
