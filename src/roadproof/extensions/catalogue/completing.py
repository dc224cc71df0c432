"""Drives for what a catalogue does not test: each is looked for, judged, and described as a test."""

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TypeAlias

from roadproof.engines.search.ask import answer
from roadproof.engines.search.initial_conditions import CLEARLY
from roadproof.engines.search.placing import judged_as
from roadproof.errors import UsageError
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.asked import Questions
from roadproof.extensions.catalogue.entries import Concrete
from roadproof.extensions.catalogue.gaps import PREFIX
from roadproof.extensions.catalogue.showing import begins_of, names_shown, signal_of
from roadproof.extensions.surveys.classify.classes import Class
from roadproof.extensions.surveys.classify.drives import Example, find_examples
from roadproof.extensions.surveys.classify.text import with_classes, write_classes
from roadproof.extensions.surveys.coverage.answers import ClassAnswer
from roadproof.library.compose import both, with_parts
from roadproof.library.elaborate import read_claim, read_term
from roadproof.library.scenarios import Scenario, applied, name_of, number_in
from roadproof.library.specification import Query, Specification
from roadproof.questions.basis import Basis
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.runtime import pool
from roadproof.runtime.budget import BudgetExceeded
from roadproof.runtime.executors import Jobs
from roadproof.runtime.pool import Progress
from roadproof.world.units import unit_text

Begins: TypeAlias = Mapping[str, float]


@dataclass(frozen=True)
class Completion:
    """A drive that shows ``target``, or the proof that nothing does, or the reason why there is neither.

    ``name``: what the drive is called; ``apart``: how far it begins from the nearest test that shows the same
    (``far.distance``), where drives far apart were asked for.
    """

    target: str
    drive: JudgedDrive | None = None
    empty: Certificate | None = None
    reason: Reason = NO_REASON
    name: str = ""
    apart: float | None = None


@dataclass(frozen=True)
class PriorResults:
    """What is known before drives are looked for.

    By target, ``tests``: how many show it, and ``begins``: how each concrete one of these begins; ``gaps``:
    what was found for classes of gaps.
    """

    begins: Mapping[str, Sequence[Begins]] = field(default_factory=dict)
    tests: Mapping[str, int] = field(default_factory=dict)
    gaps: Mapping[str, ClassAnswer] = field(default_factory=dict)


@dataclass(frozen=True)
class _Further:
    """So many drives more for a target, far from tests that begin at ``points``."""

    target: str
    first: int
    count: int
    points: tuple[Begins, ...]


_Job: TypeAlias = tuple[Class, ...] | int | _Further


@dataclass(frozen=True)
class _CompletionJobs:
    """Jobs for other processes: classes in which the same happens, one scenario, or drives far apart."""

    basis: Basis
    classes: Basis
    asked: Questions

    def settled(self, job: _Job) -> list[Completion]:
        match job:
            case int():
                return [self._scenario(job)]
            case _Further():
                return self._further(job)
            case _:
                return [self._of_class(x) for x in find_examples(self.classes, job)]

    def _of_class(self, found: Example) -> Completion:
        name = found.one.name
        if found.drive is None:
            return Completion(name, reason=found.reason)
        judged = self._as_target(found.drive.file, name)
        return Completion(name, judged, reason=NO_REASON if judged else Why.DRIVE_REJECTED())

    def _as_target(self, file: DriveFile, target: str) -> JudgedDrive | None:
        """A drive as one of the formula of a target, which needs no definition of classes."""
        home = self.basis.specification
        here = replace(file, set_name=home.set_name, values=self.basis.all_values())
        return judged_as(here, self.asked.query_of(target), home.library)

    def _scenario(self, number: int) -> Completion:
        home = self.basis.specification
        scenario = Scenario(number, home.set_name)
        query = applied(home, scenario)
        name = name_of(number)
        try:
            outcome = answer(replace(self.basis.search(query, explain=True), scenario=number))
        except BudgetExceeded as late:
            return Completion(name, reason=late.reason)
        proof = None if outcome.impossibility is None else outcome.impossibility.certificate
        return Completion(name, next(iter(outcome.drives), None), proof, outcome.told(()))

    def _further(self, job: _Further) -> list[Completion]:
        """Drives one after the other, each far from those before it; as many as are found."""
        points, found = [*job.points], list[Completion]()
        for k in range(job.first, job.first + job.count):
            drive = self._far(job.target, points)
            if drive is None:
                told = Why.NONE_APART(float(FACTORS[-1]))
                return [*found, Completion(job.target, reason=told, name=f"{job.target}-{k}")]
            begins = begins_of(drive.file)
            apart = nearest(begins, points)
            found.append(Completion(job.target, drive, name=f"{job.target}-{k}", apart=apart))
            points.append(begins)
        return found

    def _far(self, target: str, points: Sequence[Begins]) -> JudgedDrive | None:
        for factor in FACTORS if points else FACTORS[-1:]:
            more = far_from(points, factor, self.classes.specification)
            file = self._found(target, more)
            judged = None if file is None else self._as_target(file, target)
            if judged is not None:
                return judged
        return None

    def _found(self, target: str, more: Query | None) -> DriveFile | None:
        if number_in(target) is None:
            assert self.asked.classes is not None
            one = next(x for x in self.asked.classes.all() if x.name == target)
            [example] = find_examples(self.classes, [one], (), more)
            return None if example.drive is None else example.drive.file
        query = with_parts(self.asked.query_of(target), [] if more is None else [more])
        outcome = answer(self.basis.search(query))
        return outcome.drives[0].file if outcome.drives else None


def complete(
    basis: Basis,
    asked: Questions,
    missing: Sequence[str],
    known: PriorResults | None = None,
    spread: int = 1,
    hands: Jobs = None,
    progress: Progress | None = None,
) -> list[Completion]:
    """A drive for each class, each scenario and each class of gaps among ``missing``, each with a name.

    Scenarios and gaps that a drive for another target shows are not looked for again. With ``spread``, each
    class has so many tests in the end, or each scenario where there are no classes; drives are like
    ``basis.objective``.
    """
    known = known or PriorResults()
    working = _CompletionJobs(basis, replace(basis, specification=specification_of(asked), sets=()), asked)
    found: list[Completion] = []

    def ask(jobs: Sequence[_Job]) -> None:
        done = pool.work(working.settled, jobs, hands, _lost, progress, "drives")
        found.extend(x for made in pool.in_order(done) for x in made)

    ask(_of_classes(asked, missing))
    shown = {x for one in found if one.drive for x in names_shown(one.drive, asked)}
    ask([n for name in missing if name not in shown and (n := number_in(name)) is not None])
    found += _of_gaps(basis, asked, [x for x in missing if x.startswith(PREFIX)], known)
    if spread > 1:
        ask(_further(asked, found, known, spread))
    return [replace(x, name=x.name or x.target) for x in found]


def specification_of(asked: Questions) -> Specification:
    """The set in which classes have names; that of the scenarios where there are none."""
    if asked.classes is None:
        return asked.specification
    return with_classes(write_classes(asked.classes, asked.specification), asked.specification)


def _of_classes(asked: Questions, missing: Sequence[str]) -> list[tuple[Class, ...]]:
    if asked.classes is None:
        return []
    wanted = {*missing}
    groups = (tuple(x for x in alike if x.name in wanted) for alike in asked.classes.alike())
    return [x for x in groups if x]


def _of_gaps(basis: Basis, asked: Questions, missing: Sequence[str], known: PriorResults) -> list[Completion]:
    """The drives that were found when it was asked which classes are empty; one may be for several."""
    found: list[Completion] = []
    shown: set[str] = set()
    for name in missing:
        if name in shown:
            continue
        drive = known.gaps[name].gaps[0].drive
        if basis.objective != "smooth":
            drive = _reshaped(basis, drive, name, asked) or drive
        shown.update(names_shown(drive, asked))
        reason = NO_REASON if name in shown else Why.NO_GAP()
        found.append(Completion(name, drive if name in shown else None, reason=reason))
    return found


def _reshaped(basis: Basis, drive: JudgedDrive, name: str, asked: Questions) -> JudgedDrive | None:
    """Another drive of the same gap, as the basis wants them."""
    query = read_claim(basis.specification, drive.file.formula)
    try:
        outcome = answer(basis.search(query, drive.file.road))
    except UsageError:  # a grid that is too fine, a comparison too steep
        return None
    return next((x for x in outcome.drives if name in names_shown(x, asked)), None)


def _further(
    asked: Questions, found: Sequence[Completion], known: PriorResults, spread: int
) -> list[_Further]:
    """What is asked for until each class has so many tests; or each scenario, where there are no classes."""
    if asked.classes is None:
        names = [name_of(number) for number in asked.numbers]
    else:
        names = [one.name for one in asked.classes.all()]
    jobs = []
    for name in names:
        made = [x.drive for x in found if x.drive is not None and name in names_shown(x.drive, asked)]
        points = (*known.begins.get(name, ()), *(begins_of(x.file) for x in made))
        tests = known.tests.get(name, 0) + len(made)
        if 0 < tests < spread:
            jobs.append(_Further(name, tests + 1, spread - tests, points))
    return jobs


def _lost(job: _Job, reason: Reason) -> list[Completion]:
    match job:
        case int():
            return [Completion(name_of(job), reason=reason)]
        case _Further():
            return [Completion(job.target, reason=reason, name=f"{job.target}-{job.first}")]
        case _:
            return [Completion(x.name, reason=reason) for x in job]


# --- catalogue.toml of drives that complete a catalogue --------------------------------------------


def catalogue_text(tests: Iterable[Concrete]) -> str:
    """Tests as TOML; basic strings and arrays of some are written as in JSON."""
    return "\n".join(
        "[[test]]\n" + "".join(f"{x} = {json.dumps(y, ensure_ascii=False)}\n" for x, y in _said(test).items())
        for test in tests
    )


def _said(test: Concrete) -> dict[str, object]:
    said: dict[str, object] = {"id": test.id, "title": test.title, "file": test.place, "claims": test.claims}
    return said | ({"copy_of": test.copy_of} if test.copy_of else {})


# --- how far apart drives begin --------------------------------------------------------------------

FACTORS = (Fraction(6), Fraction(3), Fraction(3, 2), Fraction(3, 4))
"""How far is tried, from the farthest on."""
MOST_POINTS = 8
"""From so many drives, those that are farthest apart, a search is told to keep away."""


def distance(one: Mapping[str, float], other: Mapping[str, float]) -> float:
    """How far apart two drives begin: 1 for 15 m along, 2.5 m across or 4 m/s in one of the numbers.

    Numbers that only one of them has do not count. Infinite where they have none in common.
    """
    apart = (abs(one[n] - other[n]) / float(_clearly(n)) for n in one if n in other)
    return max(apart, default=float("inf"))


def nearest(begins: Mapping[str, float], points: Iterable[Mapping[str, float]]) -> float:
    """How far a drive begins from the nearest of others."""
    return min((distance(begins, point) for point in points), default=float("inf"))


def far_from(
    points: Sequence[Mapping[str, float]], factor: Fraction, specification: Specification
) -> Query | None:
    """That a drive begins ``factor`` or more from each of the points; None where there are none."""
    parts = [read_claim(specification, _apart(specification, point, factor)) for point in _spread(points)]
    return both(*parts) if parts else None


def _apart(specification: Specification, point: Mapping[str, float], factor: Fraction) -> str:
    """That one of the numbers differs by ``factor`` times what is clearly different, as text."""
    either_side = []
    for name, value in point.items():
        by, unit = factor * _clearly(name), unit_text(read_term(specification, name)[1])
        middle = Fraction(value).limit_denominator(1000)
        either_side.append(f"{name} - ({_number(middle + by)}) * 1 {unit} >= 0 {unit}")
        either_side.append(f"({_number(middle - by)}) * 1 {unit} - ({name}) >= 0 {unit}")
    return " or ".join(either_side)


def _number(value: Fraction) -> str:
    return str(value) if value >= 0 else f"0 - {-value}"


def _spread(points: Sequence[Mapping[str, float]]) -> list[Mapping[str, float]]:
    """At most ``MOST_POINTS`` of the points: the first, and in turn the one that is farthest from these."""
    chosen, left = [*points[:1]], [*points[1:]]
    while left and len(chosen) < MOST_POINTS:
        farthest = max(left, key=lambda point: nearest(point, chosen))
        left.remove(farthest)
        chosen.append(farthest)
    return chosen


def _clearly(name: str) -> Fraction:
    """What is clearly different in a number of a beginning."""
    return CLEARLY[signal_of(name)]
