"""One claim of ``roadproof prove`` settled, in a process of its own: proof, countermodel, refuting drive."""

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from roadproof.effort import Effort, Late
from roadproof.errors import InputError, UsageError
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.prove.properties import Task
    from roadproof.prove.prover import Result

DRIVE = 5.0  # units of work for a drive that refutes


@dataclass(frozen=True)
class Bounded:
    """How to look for a drive that refutes a claim, up to a horizon; ``horizon`` and ``dt`` in seconds."""

    engine: str
    horizon: Fraction
    dt: Fraction
    road: str | None


@dataclass(frozen=True)
class Job:
    """A task with all that a process needs to settle it."""

    task: "Task"
    specs: tuple[Path, ...]
    options: Mapping[str, str]
    effort: Effort
    seek_drive: bool
    bounded: "Bounded | None" = None


@dataclass(frozen=True)
class Settled:
    """A task with its result; ``drive`` is a judged drive on which the claim is false.

    ``limits``: within what a PROVED-BOUNDED claim holds; ``bounded``: asked of drives on one road, up to a
    horizon.
    """

    task: "Task"
    result: "Result"
    drive: Mapping[str, Any] | None
    limits: Mapping[str, Any] | None = None
    bounded: bool = False

    @property
    def verdict(self) -> Verdict:
        """A drive refutes also where no countermodel over points in time was found."""
        return Verdict.REFUTED if self.drive is not None else self.result.verdict


def settle(job: Job) -> Settled:
    """Prove or refute one claim; a refuted or undecided one also by a drive, where there is one.

    UNKNOWN where the clock cuts the search off.
    """
    begun = time.monotonic()
    try:
        return _settle(job)
    except Late as late:
        from roadproof.prove.prover import Result

        seconds = time.monotonic() - begun
        result = Result(job.task.claim, job.task.set_name, Verdict.UNKNOWN, str(late), seconds)
        return Settled(job.task, result, None, bounded=job.bounded is not None)


def _settle(job: Job) -> Settled:
    if job.bounded is not None:
        return _settle_bounded(job, job.bounded)
    from roadproof.prove.prover import prove
    from roadproof.spec.library import load_library

    specification = load_library(job.specs).select(job.task.set_name, job.options)
    task = job.task
    label = task.id + (f"-{task.part}" if task.part else "")
    result = prove(specification, task.claim, job.effort, label, task.scenario)
    drive = None
    if job.seek_drive and result.verdict in (Verdict.REFUTED, Verdict.UNKNOWN):
        try:
            drive = _refuting_drive(job)
        except Late:
            if result.verdict is Verdict.UNKNOWN:
                raise
    return Settled(task, result, drive)


def undecided(job: Job, reason: str) -> Settled:
    """What is said of a claim that nothing is known of."""
    from roadproof.prove.prover import Result

    return Settled(job.task, Result(job.task.claim, job.task.set_name, Verdict.UNKNOWN, reason, 0.0), None)


def _settle_bounded(job: Job, bounded: Bounded) -> Settled:
    """Look for a drive that refutes the claim within bounds; where none is possible at all, prove it."""
    from roadproof.prove.prover import Result
    from roadproof.spec.bind import default_values
    from roadproof.spec.library import load_library
    from roadproof.witness.ask import Request
    from roadproof.witness.bounded import check_bounded
    from roadproof.witness.question import Means

    begun = time.monotonic()
    request = Request(
        job.task.claim,
        job.task.set_name,
        job.options,
        job.specs,
        default_values(load_library(job.specs)),
        bounded.road,
        horizon=bounded.horizon,
        dt=bounded.dt,
        means=Means("any", "smt" if bounded.engine == "smt" else "milp", effort=job.effort),
    )
    found = check_bounded(request)
    if found.verdict is Verdict.PROVED:
        return _settle(replace(job, bounded=None))
    expected = Verdict.PROVED_BOUNDED if job.task.expected is Verdict.PROVED else job.task.expected
    seconds = time.monotonic() - begun
    result = Result(job.task.claim, job.task.set_name, found.verdict, found.reason, seconds)
    limits = None if found.limits is None else found.limits.as_json()
    return Settled(replace(job.task, expected=expected), result, found.drive, limits, bounded=True)


def _refuting_drive(job: Job) -> Mapping[str, Any] | None:
    """A judged drive on a reference road on which the claim is false, at declared parameter values."""
    try:
        from roadproof.witness.refute import refuting_drive
    except ImportError:
        return None
    try:
        return refuting_drive(
            job.task.claim,
            job.task.set_name,
            job.options,
            job.specs,
            job.effort.of(min(DRIVE, job.effort.units)),
        )
    except (InputError, UsageError):
        return None
