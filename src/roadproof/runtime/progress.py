"""What a question is at, for whoever wants to know: told whenever a stage begins.

Whoever listens ends the question by raising ``Cancelled``, or anything else. What workers are at is told by
the process that they work for, so that there it ends them too, whatever they are busy with.
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
    """``name``: prove, encode, solve, shape, judge, refute or explain; ``told``: on which grid, and so on.

    ``of``: of which question or part of one; ``seconds`` since somebody listens.
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
    """Whoever listened to the stages of a question wanted no more of it."""

    exit_code = 130


_listener: ContextVar[tuple[Listener, float] | None] = ContextVar("listener", default=None)
_about: ContextVar[str] = ContextVar("about", default="")


@contextmanager
def listening(listener: Listener | None) -> Iterator[None]:
    """``listener`` is told of all stages that begin inside; where it is None things stay as they are."""
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
    """Stages inside are of ``question``, unless they are of something narrower that was said before."""
    token = _about.set(_about.get() or question)
    try:
        yield
    finally:
        _about.reset(token)


def begin(name: str, told: str = "") -> None:
    """A stage begins now. Raises what the listener raises."""
    pass_on(Stage(name, told, _about.get(), 0.0))


def is_heard() -> bool:
    """Whether anybody listens."""
    return _listener.get() is not None


def pass_on(stage: Stage) -> None:
    """Tell of a stage, which may be one that another process has begun, at the time that it is here."""
    heard = _listener.get()
    if heard is not None:
        listener, since = heard
        listener(Stage(stage.name, stage.told, stage.of, time.monotonic() - since))
