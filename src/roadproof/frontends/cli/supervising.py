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
from roadproof.runtime.worker import OUTSIDE, Fork, become_child_of, describe_exit, dismiss
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
    read_end, write_end = os.pipe()
    parent = os.getpid()
    child = Fork(os.fork())
    if child.pid == 0:
        os.close(read_end)
        progress.report_to(write_end)
        become_child_of(parent, _interrupt)
        return command()
    os.close(write_end)
    try:
        for number in signals:
            signal.signal(number, _raise_ended)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, signals)
        _listen(read_end)
        child.join()
    except _EndedError as ended:
        for number in signals:
            signal.signal(number, signal.SIG_IGN)
        return _end(child, ended.signal_number)
    return _code_of(child)


def _interrupt(number: int, frame: object) -> None:
    signal.signal(number, signal.SIG_IGN)
    sys.unraisablehook = lambda unraisable: None  # of objects that this leaves half made, as z3's are
    raise KeyboardInterrupt


def _raise_ended(number: int, frame: object) -> None:
    raise _EndedError(number)


def _end(child: Fork, number: int) -> int:
    """End the child; 128 and the signal's number, as shells count."""
    with contextlib.suppress(ProcessLookupError, ChildProcessError):
        dismiss([child], GRACE)
        if child.exitcode != ExitCode.INTERRUPTED:
            _say("interrupted")
    return 128 + number


def _code_of(child: Fork) -> int:
    code = child.exitcode
    assert code is not None
    if code >= 0:
        return code
    if code == -signal.SIGKILL:
        remark = "what was written before is whole, what is missing is unknown"
        _say(f"ended by {describe_exit(code)}, {OUTSIDE}: {remark}")
        return ExitCode.UNKNOWN
    _say(f"this is our fault: ended by {describe_exit(code)}; report it with the command line.")
    return ExitCode.OUR_FAULT


def _listen(read_end: int) -> None:
    """Hear how far the command is until it ends; say it now and then, unless a terminal shows it."""
    start = last = time.monotonic()
    shown = sys.stderr is None or sys.stderr.isatty() or bool(os.environ.get(progress.QUIET))
    word, rest = f"{' '.join(sys.argv[1:2]) or 'the command'} is running, and has not said how far it is", b""
    while True:
        ready, _, _ = select.select([read_end], [], [], max(0.0, last + BEAT - time.monotonic()))
        if ready:
            heard = os.read(read_end, 65536)
            if not heard:
                return
            *lines, rest = (rest + heard).split(b"\n")
            for text in (line.decode("utf-8", "replace") for line in lines):
                shown = shown or progress.wants_quiet(text)
                word = text
        if time.monotonic() >= last + BEAT:
            last = time.monotonic()
            if not shown:
                _say(f"{word} (after {progress.duration(last - start)})")


def _say(text: str) -> None:
    with contextlib.suppress(OSError, AttributeError):
        print(f"roadproof: {text}", file=sys.stderr, flush=True)
