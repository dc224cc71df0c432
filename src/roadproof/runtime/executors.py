"""Who does the work of a long question: processes here, the workers of a cluster, one of several runs.

A job whose process ends before it is done is tried once more, alone.
"""

import re
import sys
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import field
from typing import TypeAlias, TypeVar

from roadproof.errors import UsageError
from roadproof.reasons import Reason, Why
from roadproof.runtime.records import dataclass

Item = TypeVar("Item")

_SHARE = re.compile(r"([0-9]{1,6})/([0-9]{1,6})")
_LOCAL = re.compile(r"local:([0-9]{1,4})")
_ADDRESS = re.compile(r"(tcp|tls|ws|wss)://\S+:[0-9]{1,5}")


@dataclass(frozen=True)
class Shard:
    """The share of one of several runs that divide a question without talking to each other.

    ``number`` counts from 1 to ``of``. Raises ``UsageError`` for a share that there is none of.
    """

    number: int
    of: int

    def __post_init__(self) -> None:
        if not 1 <= self.number <= self.of:
            raise UsageError(f"shard={self}: write K/N with K from 1 to N, such as 1/4")

    @classmethod
    def read(cls, text: str) -> "Shard":
        """``2/4``. Raises ``UsageError``."""
        found = _SHARE.fullmatch(text)
        if found is None:
            raise UsageError(f"shard={text[:40]}: write K/N with K from 1 to N, such as 1/4")
        return cls(int(found[1]), int(found[2]))

    def has(self, name: str) -> bool:
        """Whether the piece of a name is in this share: the same on every machine, whatever else is known."""
        import hashlib  # here, because --help need not wait for it

        return int(hashlib.sha256(name.encode()).hexdigest()[:12], 16) % self.of == self.number - 1

    def among(self, items: Sequence[Item]) -> Sequence[Item]:
        """Every ``of``-th item, of a list that all runs have alike."""
        return items[self.number - 1 :: self.of]

    def __str__(self) -> str:
        return f"{self.number}/{self.of}"


@dataclass(frozen=True)
class Cluster:
    """A cluster of dask: the ``address`` of its scheduler, or ``local:N`` for one of N processes here.

    ``authority``, ``certificate`` and ``key`` are files for a scheduler that is spoken to with TLS; where
    they are not given dask's own configuration says them. ``tell`` is told where its dashboard is. Raises
    ``UsageError``.
    """

    address: str
    authority: str | None = None
    certificate: str | None = None
    key: str | None = None
    tell: Callable[[str], None] | None = field(default=None, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not (self.local or _ADDRESS.fullmatch(self.address)):
            raise UsageError(
                f"cluster={self.address[:80]}: write the address of a scheduler, such as tcp://host:8786, or "
                "local:N for N processes here"
            )

    @property
    def local(self) -> int:
        """So many processes here; 0 for a cluster that is there already."""
        found = _LOCAL.fullmatch(self.address)
        return 0 if found is None else int(found[1])


@dataclass(frozen=True)
class Executor:
    """``processes`` here, one a core where None; or a ``cluster``; for all of a question or a ``shard``."""

    processes: int | None = None
    cluster: Cluster | None = None
    shard: Shard | None = None


Jobs: TypeAlias = int | Executor | None
"""So many processes, one a core where None, or all that can be said of who does the work."""


def hands_of(jobs: Jobs) -> Executor:
    """Who does the work, in one form. Raises ``UsageError`` where no process would be left."""
    hands = jobs if isinstance(jobs, Executor) else Executor(jobs)
    if hands.processes is not None and not (isinstance(hands.processes, int) and hands.processes > 0):
        raise UsageError(f"jobs={hands.processes!r}: write a whole number greater than 0")
    return hands


Answer = TypeVar("Answer")
# The answers of jobs at some places; where a process ended instead, the mapping gets the reason.
Attempt: TypeAlias = Callable[[Sequence[int], dict[int, str]], Generator[tuple[int, Answer], None, None]]


@dataclass(frozen=True)
class LostJob:
    """In place of an answer: the process of the job ended each time, the last time while no other ran."""

    reason: Reason


def try_again(
    attempt: Attempt[Answer], count: int, lost: Why
) -> Generator[tuple[int, Answer | LostJob], None, None]:
    """The answers of ``count`` jobs, each with its place.

    Jobs whose process ended are tried once more when the others are done. What ends again is tried alone, so
    that no other is taken for the one that kills. ``lost`` says that it ended.
    """
    waiting: Sequence[int] = range(count)
    for _ in range(2):
        died: dict[int, str] = {}
        with closing(attempt(waiting, died)) as found:
            yield from found
        waiting = sorted(died)
        if len(waiting) < 2:
            break
    for place in waiting:
        again: dict[int, str] = {}
        with closing(attempt([place], again)) as found:
            yield from found
        yield from ((place, LostJob(lost(reason))) for reason in again.values())


def is_fork_unsafe() -> bool:
    """Whether polars is imported here, whose threads may hold locks while a process forks."""
    return "polars" in sys.modules
