"""What is done where a process ends before its job is done: the words for it, and one more attempt, alone."""

import signal
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from typing import TypeAlias, TypeVar

Answer = TypeVar("Answer")
# The answers of jobs at some places; where a process ended instead, the mapping gets the reason.
Attempt: TypeAlias = Callable[[Sequence[int], dict[int, str]], Generator[tuple[int, Answer], None, None]]

OUTSIDE = "from outside or for want of memory"


@dataclass(frozen=True)
class LostJob:
    """In place of an answer: the process of the job ended twice, the second time while no other ran."""

    reason: str


def try_twice(
    attempt: Attempt[Answer], count: int, lost: str
) -> Generator[tuple[int, Answer | LostJob], None, None]:
    """The answers of ``count`` jobs, each with its place.

    A job whose process ended is tried again when the others are done, alone, so that no other is taken for
    the one that kills. ``lost`` says in words that it ended again; the reason follows.
    """
    died: dict[int, str] = {}
    with closing(attempt(range(count), died)) as found:
        yield from found
    for place in sorted(died):
        again: dict[int, str] = {}
        with closing(attempt([place], again)) as found:
            yield from found
        yield from ((place, LostJob(lost + reason)) for reason in again.values())


def ended_by(code: int) -> str:
    """What ended a process, from its exit code: ``SIGKILL``, or ``exited with 3``."""
    return signal.Signals(-code).name if code < 0 else f"exited with {code}"
