"""Executors for long questions: local processes, the workers of a cluster, or one shard of several runs.

A job whose process dies is tried again, at last alone.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import field
from typing import TYPE_CHECKING, TypeAlias, TypeVar

from roadproof.errors import UsageError
from roadproof.runtime.records import dataclass

if TYPE_CHECKING:
    from roadproof.reasons import Reason, ReasonKind

Item = TypeVar("Item")

_SHARE = re.compile(r"([0-9]{1,6})/([0-9]{1,6})")
_LOCAL = re.compile(r"local:([0-9]{1,4})")
_ADDRESS = re.compile(r"(tcp|tls|ws|wss)://\S+:[0-9]{1,5}")


@dataclass(frozen=True)
class Shard:
    """The part of a question that one of several independent runs works on.

    ``number`` counts from 1 to ``of``. Raises ``UsageError`` for other numbers.
    """

    number: int
    of: int

    def __post_init__(self) -> None:
        if not 1 <= self.number <= self.of:
            raise UsageError(f"shard={self}: write K/N with K from 1 to N, such as 1/4")

    @classmethod
    def read(cls, text: str) -> Shard:
        """Return the shard that a text such as ``2/4`` names. Raises ``UsageError``."""
        match = _SHARE.fullmatch(text)
        if match is None:
            raise UsageError(f"shard={text[:40]}: write K/N with K from 1 to N, such as 1/4")
        return cls(int(match[1]), int(match[2]))

    def includes(self, name: str) -> bool:
        """Return whether a named piece belongs to this shard; it depends on the name alone."""
        import hashlib  # here, so that --help is fast

        return int(hashlib.sha256(name.encode()).hexdigest()[:12], 16) % self.of == self.number - 1

    def among(self, items: Sequence[Item]) -> Sequence[Item]:
        """Return every ``of``-th item of a list that is the same in all runs."""
        return items[self.number - 1 :: self.of]

    def __str__(self) -> str:
        return f"{self.number}/{self.of}"


@dataclass(frozen=True)
class Cluster:
    """A dask cluster: the ``address`` of its scheduler, or ``local:N`` for a new one with N local processes.

    ``authority``, ``certificate`` and ``key`` are files for TLS; without them, dask's own configuration
    applies. ``tell`` is called with a line that names the dashboard. Raises ``UsageError``.
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
        """The number of local processes of a new cluster; 0 for an existing cluster."""
        match = _LOCAL.fullmatch(self.address)
        return 0 if match is None else int(match[1])


@dataclass(frozen=True)
class Executor:
    """Local ``processes`` (None: one a core) or a ``cluster``, for a whole question or one ``shard``."""

    processes: int | None = None
    cluster: Cluster | None = None
    shard: Shard | None = None


Jobs: TypeAlias = int | Executor | None
"""The number of processes, None for one a core, or an ``Executor``."""


def executor_for(jobs: Jobs) -> Executor:
    """Return an ``Executor`` for a number of processes. Raises ``UsageError`` for a number below 1."""
    executor = jobs if isinstance(jobs, Executor) else Executor(jobs)
    count = executor.processes
    if count is not None and not (isinstance(count, int) and count > 0):
        raise UsageError(f"jobs={count!r}: write a whole number greater than 0")
    return executor


Answer = TypeVar("Answer")
# Yields the answers of jobs at some indices; the mapping gets the cause for each process that died.
RunJobs: TypeAlias = Callable[[Sequence[int], dict[int, str]], Generator[tuple[int, Answer], None, None]]


@dataclass(frozen=True)
class LostJob:
    """A placeholder for an answer: the process of the job died at each attempt, the last time alone."""

    reason: Reason


def run_with_retries(
    attempt: RunJobs[Answer], count: int, lost: ReasonKind
) -> Generator[tuple[int, Answer | LostJob], None, None]:
    """Yield the index and the answer of each of ``count`` jobs.

    Jobs whose process died are tried once more when the others are done. A job that is lost again is then
    tried alone, so that the one that kills its process is identified. ``lost``: the kind of reason for a lost
    job.
    """
    waiting: Sequence[int] = range(count)
    for _ in range(2):
        died: dict[int, str] = {}
        with closing(attempt(waiting, died)) as answers:
            yield from answers
        waiting = sorted(died)
        if len(waiting) < 2:
            break
    for place in waiting:
        died_again: dict[int, str] = {}
        with closing(attempt([place], died_again)) as answers:
            yield from answers
        yield from ((place, LostJob(lost(reason))) for reason in died_again.values())


def is_fork_unsafe() -> bool:
    """Return whether polars is imported: its threads may hold locks while a process forks."""
    return "polars" in sys.modules
