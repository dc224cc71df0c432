"""Progress of a question: a listener is called at the beginning of every stage.

The listener ends the question by raising ``Cancelled``, or anything else. The stages of a worker process are
reported in the process that started it, so that an exception there also ends the worker, even inside a
solver.
"""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeAlias

from roadproof.errors import RoadproofError
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Stage:
    """A stage of a question that has begun.

    ``name``: prove, encode, solve, shape, judge, refute or explain. ``told``: details, such as the grid.
    ``of``: the question, or the part of one. ``seconds``: time since the listener was installed.
    """

    name: str
    told: str
    of: str
    seconds: float

    def __str__(self) -> str:
        where = f", {self.told}" if self.told else ""
        return f"{self.of + ': ' if self.of else ''}{self.name}{where} (after {self.seconds:.0f} s)"


Listener: TypeAlias = Callable[[Stage], object]


class Cancelled(RoadproofError):
    """The exception by which a listener ends a question."""

    exit_code = 130


_listener: ContextVar[tuple[Listener, float] | None] = ContextVar("listener", default=None)
_about: ContextVar[str] = ContextVar("about", default="")


@contextmanager
def listening(listener: Listener | None) -> Iterator[None]:
    """Install ``listener`` for all stages that begin inside; None changes nothing."""
    if listener is None:
        yield
        return
    token = _listener.set((listener, time.monotonic()))
    try:
        yield
    finally:
        _listener.reset(token)


@contextmanager
def about(question: str) -> Iterator[None]:
    """Make stages inside name ``question``, unless an outer ``about`` named one already."""
    token = _about.set(_about.get() or question)
    try:
        yield
    finally:
        _about.reset(token)


def report_stage(name: str, detail: str = "") -> None:
    """Report that a stage begins. Raises what the listener raises."""
    forward(Stage(name, detail, _about.get(), 0.0))


def has_listener() -> bool:
    """Return whether a listener is installed."""
    return _listener.get() is not None


def forward(stage: Stage) -> None:
    """Report a stage, perhaps of another process, with the time since our listener was installed."""
    current = _listener.get()
    if current is not None:
        listener, since = current
        listener(Stage(stage.name, stage.told, stage.of, time.monotonic() - since))
