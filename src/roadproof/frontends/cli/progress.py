"""Progress messages on stderr: on a terminal one line that changes, else one every half minute.

The lines of every half minute are printed by the process that watches this one (``cli.supervising``), so
they come also while a solver keeps this one busy.
"""

import contextlib
import os
import sys
import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from roadproof.runtime.progress import Stage
    from roadproof.world.road import Road

QUIET = "ROADPROOF_QUIET"
_BE_QUIET = "quiet"


class _Listeners:
    """The receivers of progress messages; ``pipe`` leads to the supervising process."""

    pipe: int | None = None
    quiet: bool = False


_listeners = _Listeners()


def report_to(pipe: int) -> None:
    """Tell the process at the other end of ``pipe``, too."""
    _listeners.pipe = pipe


def be_quiet(quiet: bool = True) -> None:
    """Suppress progress messages from now on."""
    _listeners.quiet = quiet or bool(os.environ.get(QUIET))
    if _listeners.quiet:
        _report(_BE_QUIET)


def tell(text: str, last: bool = False) -> None:
    """Return how far it is now, in one line; with ``last`` the line is left standing on a terminal."""
    if _listeners.quiet:
        return
    _report(text)
    if _is_terminal():
        import shutil

        columns = shutil.get_terminal_size().columns
        print(f"\r\033[K{text[: columns - 1]}", end="\n" if last else "", file=sys.stderr, flush=True)


def note(line: str) -> None:
    """A line of its own for something that is done."""
    if _listeners.quiet:
        return
    _report(line)
    clear()
    print(line, file=sys.stderr, flush=True)


def warn(line: str) -> None:
    """A line that is said in any case, as it is about what was found and not about how far it is."""
    clear()
    print(line, file=sys.stderr, flush=True)


def warn_of_drive_pictures(pictures: bool) -> None:
    """Print that drives are written without ``pictures``, where no extension draws them."""
    from roadproof.frontends.report.picture import NO_DRIVE_PICTURES, draws_drives

    if pictures and not draws_drives():
        warn(NO_DRIVE_PICTURES)


def tell_road(road: "Road | None") -> None:
    """Print what was left out of a road's map, and how far the road bends."""
    if road is None:
        return
    from roadproof.world.not_read import road_not_read_note

    for text in road_not_read_note(road):
        warn(f"note: {text}")
    tell_bends(road)


def tell_bends(road: "Road | None") -> None:
    """Print how far lengths in lanes are from those in s, on a road with bends."""
    from roadproof.world.length_error import bend_note

    text = bend_note(road)
    if text:
        warn(text)


ALIKE = ("recordings",)
"""Pieces that take about as long as each other. One claim or search may take as long as all others."""
LEAST_DONE = 2
"""So many pieces must be done before the time for the others is estimated from them."""


class Counter:
    """A counter that prints how many parts are done; for equal parts also the remaining time."""

    def __init__(self) -> None:
        self.begun = time.monotonic()
        self.known: int | None = None

    def __call__(self, done: int, total: int, what: str) -> None:
        """Print how many are done of all; ``what`` is the plural of the things counted."""
        if self.known is None or done < self.known:
            self.begun, self.known = time.monotonic(), done
        known = what in ALIKE and done - self.known >= LEAST_DONE
        seconds = time.monotonic() - self.begun
        left = time_left(seconds, done - self.known, total - self.known) if known else ""
        tell(f"{done} of {total} {what}{left}", last=done == total)


def tell_stage(stage: "Stage") -> None:
    """Print the stage of the run."""
    tell(str(stage))


def clear() -> None:
    """Make room for a line of results on a terminal."""
    if not _listeners.quiet and _is_terminal():
        print("\r\033[K", end="", file=sys.stderr, flush=True)


def _is_terminal() -> bool:
    return sys.stderr is not None and sys.stderr.isatty()


def _report(text: str) -> None:
    if _listeners.pipe is not None:
        with contextlib.suppress(OSError):
            os.write(_listeners.pipe, text.replace("\n", " ").encode()[:1000] + b"\n")


def wants_quiet(text: str) -> bool:
    """Return whether a line that came through the pipe asks for silence."""
    return text == _BE_QUIET


def time_left(seconds: float, done: int, total: int) -> str:
    """``, about 3 min left`` after so many seconds for ``done`` of ``total`` jobs; empty where unknown."""
    if not 0 < done < total:
        return ""
    return f", about {duration(seconds / done * (total - done))} left"


def duration(seconds: float) -> str:
    """Seconds in words: 40 s, 3 min, 2 h 10 min."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 90 else f"{minutes // 60} h {minutes % 60} min"
