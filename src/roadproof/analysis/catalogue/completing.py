"""Drives for what a catalogue does not test: each is looked for, judged, and described as a test."""

from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass, replace

from roadproof.analysis.basis import Basis
from roadproof.analysis.catalogue.asked import Asked
from roadproof.analysis.catalogue.showing import Freedom, shown_by
from roadproof.analysis.classify.classes import Class
from roadproof.analysis.classify.drives import Example, find_examples
from roadproof.analysis.classify.text import with_classes, write_classes
from roadproof.analysis.placing import judged_as
from roadproof.effort import Late
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import Judged
from roadproof.hands import Jobs
from roadproof.searching.ask import answer
from roadproof.spec.library import Specification
from roadproof.spec.scenarios import Scenario, applied, name_of, number_in
from roadproof.study import pool
from roadproof.study.pool import Progress


@dataclass(frozen=True)
class Completion:
    """A drive that shows ``target``, or the proof that nothing does, or the reason why there is neither."""

    target: str
    drive: Judged | None = None
    empty: Certificate | None = None
    reason: str = ""


@dataclass(frozen=True)
class _Completing:
    """Jobs for other processes: classes in which the same happens, or one scenario."""

    basis: Basis
    classes: Basis
    asked: Asked

    def settled(self, job: tuple[Class, ...] | int) -> list[Completion]:
        if isinstance(job, int):
            return [self._scenario(job)]
        return [self._of_class(x) for x in find_examples(self.classes, job)]

    def _of_class(self, found: Example) -> Completion:
        """Its drive as one of the formula that makes up the class, which needs no definition of classes."""
        if found.drive is None:
            return Completion(found.one.name, reason=found.reason)
        home = self.basis.specification
        here = replace(found.drive.file, set_name=home.set_name)
        judged = judged_as(here, self.asked.class_query(found.one.name), home.library)
        return Completion(found.one.name, judged, reason="" if judged else "the judge rejects its drive")

    def _scenario(self, number: int) -> Completion:
        home = self.basis.specification
        scenario = Scenario(number, home.set_name)
        query = applied(home, scenario)
        name = name_of(number)
        try:
            outcome = answer(replace(self.basis.search(query, explain=True), scenario=number))
        except Late as late:
            return Completion(name, reason=str(late))
        proof = None if outcome.impossibility is None else outcome.impossibility.certificate
        return Completion(name, next(iter(outcome.drives), None), proof, outcome.told(()))


def complete(
    basis: Basis,
    asked: Asked,
    missing: Sequence[str],
    hands: Jobs = None,
    progress: Progress | None = None,
) -> dict[str, Completion]:
    """By name, a drive for each class and each scenario among ``missing``.

    Scenarios that a drive for a class shows are not looked for again.
    """
    found: dict[str, Completion] = {}
    jobs = _of_classes(asked, missing)
    working = _Completing(basis, replace(basis, specification=specification_of(asked), sets=()), asked)
    with closing(pool.work(working.settled, jobs, hands, _lost, progress, "drives")) as done:
        for _, made in done:
            found |= {x.target: x for x in made}
    shown = {
        shown.what for x in found.values() if x.drive for shown in shown_by(x.drive.file, asked, Freedom())
    }
    numbers = [n for name in missing if name not in shown and (n := number_in(name)) is not None]
    with closing(pool.work(working.settled, numbers, hands, _lost, progress, "drives")) as done:
        for _, made in done:
            found |= {x.target: x for x in made}
    return found


def specification_of(asked: Asked) -> Specification:
    """The set in which classes have names; that of the scenarios where there are none."""
    if asked.classes is None:
        return asked.specification
    return with_classes(write_classes(asked.classes, asked.specification), asked.specification)


def _of_classes(asked: Asked, missing: Sequence[str]) -> list[tuple[Class, ...]]:
    if asked.classes is None:
        return []
    wanted = {*missing}
    groups = (tuple(x for x in alike if x.name in wanted) for alike in asked.classes.alike())
    return [x for x in groups if x]


def _lost(job: tuple[Class, ...] | int, reason: str) -> list[Completion]:
    names = [name_of(job)] if isinstance(job, int) else [x.name for x in job]
    return [Completion(name, reason=reason) for name in names]
