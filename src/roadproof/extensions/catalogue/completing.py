"""Drives for the missing targets of a catalogue: each is searched for, judged, and becomes a test."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeAlias

from roadproof.engines.search.drive_search import search_drive
from roadproof.engines.search.outcome import SearchOutcome
from roadproof.engines.search.placing import judge_as
from roadproof.engines.search.usual_road import usual_road
from roadproof.engines.setting import Search
from roadproof.errors import UsageError
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.drive_targets import names_shown
from roadproof.extensions.catalogue.gaps import PREFIX
from roadproof.extensions.catalogue.initial_values import (
    FACTORS,
    InitialValues,
    distance_to_nearest,
    far_from,
    initial_values,
)
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.surveys.classify.classes import Class
from roadproof.extensions.surveys.classify.drives import ClassExample, find_examples
from roadproof.extensions.surveys.classify.text import with_classes, write_classes
from roadproof.extensions.surveys.composition import with_parts
from roadproof.extensions.surveys.coverage.answers import ClassAnswer
from roadproof.library.bind import used_values
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import Scenario, apply_scenario, name_of, number_in
from roadproof.library.specification import Query, Specification
from roadproof.questions.basis import Basis
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.runtime import pool
from roadproof.runtime.budget import BudgetExceeded
from roadproof.runtime.executors import Jobs
from roadproof.runtime.pool import Progress
from roadproof.runtime.timing import now, seconds_since
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class Completion:
    """A drive that shows ``target``, or the proof that no drive does, or the reason why there is neither.

    ``name``: the name of the drive; ``apart``: in a search for drives far apart, how far it begins from the
    nearest test of the target (``initial_values.distance``).
    """

    target: str
    drive: JudgedDrive | None = None
    empty: Certificate | None = None
    reason: Reason = NO_REASON
    name: str = ""
    apart: float | None = None


@dataclass(frozen=True)
class PriorResults:
    """The results for targets before the search for drives.

    By target, ``tests``: the number of tests that show it; ``begins``: initial values of each concrete one;
    ``gaps``: the answers about classes of gaps.
    """

    begins: Mapping[str, Sequence[InitialValues]] = field(default_factory=dict)
    tests: Mapping[str, int] = field(default_factory=dict)
    gaps: Mapping[str, ClassAnswer] = field(default_factory=dict)


@dataclass(frozen=True)
class _SpreadJob:
    """A request for ``count`` drives of a target, far from tests that begin at ``points``.

    ``first``: the number of the first drive.
    """

    target: str
    first: int
    count: int
    points: tuple[InitialValues, ...]


_Job: TypeAlias = tuple[Class, ...] | int | _SpreadJob


@dataclass(frozen=True)
class _CompletionJobs:
    """The jobs for other processes: classes with the same disturbances, one scenario, or drives far apart.

    ``classes``: the basis whose spec set defines the classes.
    """

    basis: Basis
    classes: Basis
    formulas: TargetFormulas

    def run(self, job: _Job) -> list[Completion]:
        match job:
            case int():
                return [self._scenario(job)]
            case _SpreadJob():
                return self._spread(job)
            case tuple():
                return [self._of_class(x) for x in find_examples(self.classes, job)]

    def _of_class(self, example: ClassExample) -> Completion:
        name = example.one.name
        if example.drive is None:
            return Completion(name, reason=example.reason)
        judged = self._as_target(example.drive.file, name)
        return Completion(name, judged, reason=NO_REASON if judged else ReasonKind.DRIVE_REJECTED())

    def _as_target(self, file: DriveFile, target: str) -> JudgedDrive | None:
        """Return a drive judged by the formula of a target, which needs no definition of classes."""
        home, query = self.basis.specification, self.formulas.query_of(target)
        values = used_values(home.library, query.formula, self.basis.all_values())
        return judge_as(replace(file, set_name=home.set_name, values=values), query, home.library)

    def _scenario(self, number: int) -> Completion:
        home = self.basis.specification
        scenario = Scenario(number, home.set_name)
        query = apply_scenario(home, scenario)
        name = name_of(number)
        try:
            outcome = search_drive_or_unknown(
                replace(self.basis.search(query, explain=True), scenario=number)
            )
        except BudgetExceeded as late:
            return Completion(name, reason=late.reason)
        proof = None if outcome.impossibility is None else outcome.impossibility.certificate
        return Completion(name, next(iter(outcome.drives), None), proof, outcome.reason_with(()))

    def _spread(self, job: _SpreadJob) -> list[Completion]:
        """Search for drives one after the other, each far from those before it, until a search fails."""
        points, made = [*job.points], list[Completion]()
        for k in range(job.first, job.first + job.count):
            drive = self._far_drive(job.target, points)
            if drive is None:
                reason = ReasonKind.NONE_APART(float(FACTORS[-1]))
                return [*made, Completion(job.target, reason=reason, name=f"{job.target}-{k}")]
            begins = initial_values(drive.file)
            apart = distance_to_nearest(begins, points)
            made.append(Completion(job.target, drive, name=f"{job.target}-{k}", apart=apart))
            points.append(begins)
        return made

    def _far_drive(self, target: str, points: Sequence[InitialValues]) -> JudgedDrive | None:
        """Return a drive of a target as far from the points as one is found."""
        for factor in FACTORS if points else FACTORS[-1:]:
            more = far_from(points, factor, self.classes.specification)
            file = self._search(target, more)
            judged = None if file is None else self._as_target(file, target)
            if judged is not None:
                return judged
        return None

    def _search(self, target: str, more: Query | None) -> DriveFile | None:
        """Search for a drive of a target on which the formula ``more`` holds too."""
        if number_in(target) is None:
            assert self.formulas.classes is not None
            one = next(x for x in self.formulas.classes.all() if x.name == target)
            [example] = find_examples(self.classes, [one], (), more)
            return None if example.drive is None else example.drive.file
        query = with_parts(self.formulas.query_of(target), [] if more is None else [more])
        outcome = search_drive_or_unknown(self.basis.search(query))
        return outcome.drives[0].file if outcome.drives else None


def complete(
    basis: Basis,
    formulas: TargetFormulas,
    missing: Sequence[str],
    prior: PriorResults | None = None,
    spread: int = 1,
    executor: Jobs = None,
    progress: Progress | None = None,
) -> list[Completion]:
    """Return a drive for each class, each scenario and each class of gaps among ``missing``, with names.

    Scenarios and gaps that a drive for another target shows are not searched for again. With ``spread``, each
    class has so many tests in the end, or each scenario where there are no classes; drives are like
    ``basis.objective``.
    """
    prior = prior or PriorResults()
    divided = replace(basis, specification=specification_of(formulas), sets=())
    jobs_of = _CompletionJobs(basis, divided, formulas)
    made: list[Completion] = []

    def run(jobs: Sequence[_Job]) -> None:
        done = pool.work(jobs_of.run, jobs, executor, _lost, progress, "drives")
        made.extend(x for completions in pool.in_order(done) for x in completions)

    run(_class_jobs(formulas, missing))
    shown = {x for one in made if one.drive for x in names_shown(one.drive, formulas)}
    run([n for name in missing if name not in shown and (n := number_in(name)) is not None])
    made += _of_gaps(basis, formulas, [x for x in missing if x.startswith(PREFIX)], prior)
    if spread > 1:
        run(_spread_jobs(formulas, made, prior, spread))
    return [replace(x, name=x.name or x.target) for x in made]


def specification_of(formulas: TargetFormulas) -> Specification:
    """Return the spec set that defines the classes; that of the scenarios where there are none."""
    if formulas.classes is None:
        return formulas.specification
    return with_classes(write_classes(formulas.classes, formulas.specification), formulas.specification)


def _class_jobs(formulas: TargetFormulas, missing: Sequence[str]) -> list[tuple[Class, ...]]:
    """Return the missing classes, those with the same disturbances as one job."""
    if formulas.classes is None:
        return []
    groups = (tuple(x for x in alike if x.name in missing) for alike in formulas.classes.alike())
    return [x for x in groups if x]


def _of_gaps(
    basis: Basis, formulas: TargetFormulas, missing: Sequence[str], prior: PriorResults
) -> list[Completion]:
    """Return the drives from the search for empty classes; one may show several classes."""
    made: list[Completion] = []
    shown: set[str] = set()
    for name in missing:
        if name in shown:
            continue
        drive = prior.gaps[name].gaps[0].drive
        if basis.objective != "smooth":
            drive = _reshape(basis, drive, name, formulas) or drive
        shown.update(names_shown(drive, formulas))
        reason = NO_REASON if name in shown else ReasonKind.NO_GAP()
        made.append(Completion(name, drive if name in shown else None, reason=reason))
    return made


def _reshape(basis: Basis, drive: JudgedDrive, name: str, formulas: TargetFormulas) -> JudgedDrive | None:
    """Search for another drive of the same gap with the objective of the basis."""
    query = read_claim(basis.specification, drive.file.formula)
    try:
        outcome = search_drive_or_unknown(basis.search(query, drive.file.road))
    except UsageError:  # a grid that is too fine, a comparison too steep
        return None
    return next((x for x in outcome.drives if name in names_shown(x, formulas)), None)


def _spread_jobs(
    formulas: TargetFormulas, made: Sequence[Completion], prior: PriorResults, spread: int
) -> list[_SpreadJob]:
    """Return the jobs until each class, or each scenario without classes, has ``spread`` tests."""
    if formulas.classes is None:
        names = [name_of(number) for number in formulas.numbers]
    else:
        names = [one.name for one in formulas.classes.all()]
    jobs = []
    for name in names:
        drives = [x.drive for x in made if x.drive is not None and name in names_shown(x.drive, formulas)]
        points = (*prior.begins.get(name, ()), *(initial_values(x.file) for x in drives))
        tests = prior.tests.get(name, 0) + len(drives)
        if 0 < tests < spread:
            jobs.append(_SpreadJob(name, tests + 1, spread - tests, points))
    return jobs


def _lost(job: _Job, reason: Reason) -> list[Completion]:
    """Return the completions of a job whose process was lost."""
    match job:
        case int():
            return [Completion(name_of(job), reason=reason)]
        case _SpreadJob():
            return [Completion(job.target, reason=reason, name=f"{job.target}-{job.first}")]
        case tuple():
            return [Completion(x.name, reason=reason) for x in job]


def search_drive_or_unknown(search: Search) -> SearchOutcome:
    """Run ``search_drive``, but return UNKNOWN with the reason where the clock cuts it off."""
    started = now()
    try:
        return search_drive(search)
    except BudgetExceeded as late:
        return unknown_outcome(search, late.reason, seconds_since(started))


def unknown_outcome(search: Search, reason: Reason, seconds: float = 0.0) -> SearchOutcome:
    """Return an UNKNOWN outcome of a search with this reason."""
    road = search.setting.road or usual_road(search.query.formula)
    fields = (search.scenario, search.specification.set_name, search.query, road.name)
    return SearchOutcome(*fields, Verdict.UNKNOWN, reason, seconds={"all": seconds})
