"""Runs of a controller in a process of its own, which the controller may end."""

from collections.abc import Generator
from contextlib import closing
from typing import Any, Protocol, TypeVar

from roadproof.reasons import Reason

OutcomeOf = TypeVar("OutcomeOf", covariant=True)
RunOutcome = TypeVar("RunOutcome")


class ControllerRun(Protocol[OutcomeOf]):
    """Work that runs a controller."""

    def run(self) -> OutcomeOf:
        """Return the outcome, in this process."""
        ...

    def lost(self, reason: Reason) -> OutcomeOf:
        """Return the outcome where the process ended."""
        ...


def isolated(work: ControllerRun[RunOutcome]) -> RunOutcome:
    """Return the outcome of a run in a process of its own, unless this is such a process already."""
    from roadproof.runtime import pool
    from roadproof.runtime.worker import is_worker

    if is_worker():
        return work.run()

    def lose(job: Any, reason: Reason) -> RunOutcome:
        return work.lost(reason)

    answers: Generator[tuple[int, RunOutcome | None], None, None]
    answers = pool.work(_run, [work, None], 1, lose)
    with closing(answers):
        return next(x for place, x in answers if place == 0 and x is not None)


def _run(work: Any) -> Any:
    return None if work is None else work.run()
