"""Drives for scenarios and formulas."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from dataclasses import field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Unpack

from roadproof.engines.setting import SearchOptions, Setting, exists_mode
from roadproof.errors import UsageError
from roadproof.evidence.codec import write
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.api.settings import searches_of, setting, work_of
from roadproof.frontends.report.witness import Views, as_line, every_view, sheet_of
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.questions import Witness
from roadproof.frontends.settings.readers import formats_in
from roadproof.questions.basis import Basis
from roadproof.questions.decide import look_up
from roadproof.questions.question import walk_batch
from roadproof.questions.store import keep_all
from roadproof.questions.witness import (
    NONE_WITHIN,
    SearchResult,
    SearchTask,
    WitnessQuestion,
    WitnessView,
    name_of,
)
from roadproof.runtime.budget import NO_COST, Cost, sum_of
from roadproof.runtime.files import make_folder, write_atomic
from roadproof.runtime.progress import Listener, listening
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict, exit_code

if TYPE_CHECKING:
    from roadproof.evidence import answer as answers
    from roadproof.evidence.claim import Claim
    from roadproof.evidence.judged import JudgedDrive
    from roadproof.evidence.kinds import Evidence
    from roadproof.evidence.strict import JsonObject
    from roadproof.frontends.report.cases import Case
    from roadproof.frontends.report.picture import Picture
    from roadproof.frontends.report.sheet import Sheet
    from roadproof.frontends.settings.keywords import WitnessKeywords
    from roadproof.library.specification import Library
    from roadproof.world.road import Road

FORMER = (".png",)
"""The endings of files beside a drive that earlier versions wrote."""


@dataclass(frozen=True)
class DriveFolder:
    """Writes samples, pictures and animations of drives into a folder, where they are not there yet."""

    folder: Path
    library: Library
    views: Views

    def __call__(self, named: tuple[str, JudgedDrive]) -> None:
        name, judged = named
        make_folder(self.folder)
        samples = self.folder / f"{name}.csv"
        former = samples.read_bytes() if samples.is_file() else b""
        for ending, content in self.views.of(judged, self.library):
            write_atomic(self.folder / f"{name}{ending}", content)
        if samples.read_bytes() != former:  # the other files are those of a former drive
            for ending in {*every_view().endings, *FORMER} - {*self.views.endings}:
                (self.folder / f"{name}{ending}").unlink(missing_ok=True)

    def lacks(self, name: str) -> bool:
        """Return whether any is not there."""
        return any(not (self.folder / f"{name}{ending}").exists() for ending in self.views.endings)


@dataclass(frozen=True, repr=False)
class Witnesses(QuestionAnswers[WitnessView], BuildResult):
    """Searches for drives, and what came out of each."""

    question: WitnessQuestion
    pieces: ClassVar[str] = "questions"
    command: ClassVar[str] = "witness"

    def cases(self) -> Iterator[Case]:
        from roadproof.frontends.report.question_cases import search_cases  # here: for build servers alone

        return search_cases((x, self._file(name, x)) for name, x in self.named.items())

    def _file(self, name: str, result: SearchResult) -> Path | None:
        first = self.question.claim_names(name)[0]
        shown = result.drives or result.certificate is not None
        return self.folder / f"{first}.json" if self.folder is not None and shown else None

    @cached_property
    def named(self) -> dict[str, SearchResult]:
        """The results by name; a repeated formula occurs once."""
        return {name: self._priced(name) for name in self.question.named}

    def _priced(self, name: str) -> SearchResult:
        costs = [x for y in self.question.claim_names(name) if (x := self.found.costs.get(y)) is not None]
        return replace(self.question.result(name, self.found.answers), cost=sum_of(costs))

    @property
    def outcomes(self) -> tuple[SearchResult, ...]:
        """The results in the order of the request."""
        return tuple(self.named[name] for name in self.question.names)

    @property
    def drives(self) -> tuple[JudgedDrive, ...]:
        """All drives that were found."""
        return tuple(drive for outcome in self.outcomes for drive in outcome.drives)

    @property
    def verdicts(self) -> dict[str, Verdict]:
        return {f"{x.query.text}@{x.set_name}": x.verdict for x in self.outcomes}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        proofs = (x.certificate for x in self.outcomes if x.certificate is not None)
        return (*self.drives, *proofs)

    @property
    def road(self) -> Road | None:
        return self.question.road

    @property
    def exit_code(self) -> ExitCode:
        return exit_code((x.verdict, Verdict.WITNESSED) for x in self.outcomes)

    @property
    def _sheet(self) -> Sheet[SearchResult]:
        return sheet_of([*self.named.values()])

    def as_data(self) -> JsonObject:
        data = self.question.data(WitnessView(self.outcomes), lambda *_: None, self.seconds)
        return write(data)

    def _write(self, folder: Path, pictures: bool) -> None:
        """Write the answers; trees that show a NONE-WITHIN are looked for where they were not."""
        if folder != self.folder:
            from roadproof.engines.search.batches import Engines  # here: known answers need no solver

            tasks = tuple(replace(x, trees=True) for x in self.question.tasks)
            question, known = replace(self.question, tasks=tasks), dict(self.found.answers)
            engines = Engines(question.work)

            def find(name: str, claim: Claim) -> answers.ClaimAnswer:
                if name not in known:
                    known[name], _ = engines.answer_claim(claim)
                return known[name]

            for batch in question.batches(known):
                list(walk_batch(batch, find))
            keep_all(folder, question, known)
        self._add_files(folder, pictures)

    def _add_files(self, folder: Path, pictures: bool) -> None:
        beside = DriveFolder(folder, self.library, Views(pictures))
        for named in self.drive_names:
            beside(named)

    @property
    def drive_names(self) -> Iterator[tuple[str, JudgedDrive]]:
        """Yield each drive with the name of its file."""
        for name, result in self.named.items():
            yield from zip(self.question.claim_names(name), result.drives, strict=False)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        from roadproof.frontends.report.picture import drive_pictures  # here: few answers are drawn

        return drive_pictures(((f"drive-{k}", x) for k, x in enumerate(self.drives, 1)), self.library)

    def __str__(self) -> str:
        lines = [as_line(x) for x in self.named.values()]
        return "\n".join([*lines, *([self.summary] if len(lines) > 1 else [])])

    @property
    def summary(self) -> str:
        """Return how many were found, in words."""
        from roadproof.frontends.report.numbers import took

        count = sum(x.verdict is Verdict.WITNESSED for x in self.outcomes)
        return f"{count} of {len(self.outcomes)} witnessed{took(self.seconds or None)}"


@takes(Witness)
def witness(
    *what: What,
    using: Definitions | None = None,
    stage: Listener | None = None,
    **options: Unpack[WitnessKeywords],
) -> Witnesses:
    """Find a drive for each of some scenarios or formulas, in each spec set; without any, for all scenarios.

    A text such as "1,3-8" stands for several scenarios. Where, with whom and for how long: see ``setting``.
    ``count`` clearly different drives are looked for.
    ``objective``: what a drive should be like: typical, any, smooth, margin, mild, severe or short; the
    ``wishes`` of an outcome say how a drive is typical. ``preventable``,
    ``unpreventable``: the name of a driver model, for scenarios that begin with a manoeuvre whose collision
    it prevents, or cannot prevent . ``effort``: units
    of work for a search, each about a second of a solver; ``timeout``: seconds after which the clock ends it.
    ``out``: a folder in which drives are kept as they come, with samples and ``pictures``; ``animate``:
    formats of animations there, such as "svg,gif" (mp4 needs the program ffmpeg). ``stage`` is told
    of each stage that begins (``stages.Stage``), and ends all by raising.
    Raises ``TextError``, ``InputError``, ``UsageError``, ``MissingSolverError``.

    >>> witness(4, jobs=1).verdict
    <Verdict.WITNESSED: 'WITNESSED'>
    """
    given = Witness.of(options)
    question = witness_question(what, definitions_of(using), given)
    with listening(stage):
        return witness_all(question, given)


def known_drives(numbers: Sequence[int], using: Definitions) -> dict[int, JudgedDrive]:
    """The drives of scenarios, by number, that are known without a search.

    Raises ``InputError`` for a number that the spec set does not have.
    """
    if not numbers:
        return {}
    question = witness_question(numbers, using, Witness())
    answers = look_up(question)
    results = (question.result(name, answers) for name in question.named)
    return {x.scenario: x.drives[0] for x in results if x.scenario is not None and x.drives}


def witness_question(what: Sequence[What], using: Definitions, given: Witness) -> WitnessQuestion:
    """The question that ``witness`` asks. Raises as that does."""
    each = using.each(what)
    home = given.modified(using, what=each)
    options = SearchOptions(given.objective, given.engine, given.solver)
    place = setting(home, given)
    within, trees = exists_mode(place, options), given.out is not None
    tasks = tuple(
        SearchTask(
            name_of(number, x.scenario, x.specification.set_name),
            x.specification,
            x.query,
            x.scenario,
            within,
            given.count,
            trees,
        )
        for number, x in enumerate(searches_of(home, each, place, options), 1)
    )
    if not tasks:
        raise UsageError("the spec set has no scenario: name formulas")
    for task in tasks if len(tasks) > 1 else ():
        _refuse_early(task, place)
    basis = Basis(tasks[0].specification, values=place.values, effort=work_of(given))
    return WitnessQuestion(basis, tasks)


def _refuse_early(task: SearchTask, place: Setting) -> None:
    """Raises ``UsageError`` for one of several formulas that cannot be asked, before others are searched."""
    if task.scenario is None:
        from roadproof.engines.search.question import pose  # here: it encodes the motion

        try:
            pose(task.specification.library, task.query, place)
        except UsageError as error:
            raise UsageError(f"{task.query.text[:80]}: {error}") from None


def witness_all(
    question: WitnessQuestion, given: Witness, each: Callable[[str, SearchResult], None] | None = None
) -> Witnesses:
    """Search drives as ``witness`` does; ``each`` is called with every result and its name."""
    views = views_of(given)
    witnesses = Witnesses.decide(question, given, None if each is None else _Teller(question, each))
    if witnesses.folder is not None:
        from roadproof.runtime import pool  # here: most answers are written nowhere

        beside = DriveFolder(witnesses.folder, witnesses.library, views)
        left = [x for x in witnesses.drive_names if beside.lacks(x[0])]
        with closing(pool.work(beside, left, given.jobs, None, given.progress, "drives")) as done:
            list(done)
    return witnesses


@dataclass
class _Teller:
    """A listener that reports a search once all its claims are answered."""

    question: WitnessQuestion
    each: Callable[[str, SearchResult], None]
    known: dict[str, answers.ClaimAnswer] = field(default_factory=dict)
    cost: dict[str, Cost] = field(default_factory=dict)

    def __call__(self, name: str, answer: answers.ClaimAnswer, cost: Cost) -> None:
        search = self.question.search_named(name)
        self.known[name] = answer
        self.cost[search] = sum_of([self.cost.get(search, NO_COST), cost])
        if self.question.is_last(name, answer):
            self.each(search, replace(self.question.result(search, self.known), cost=self.cost[search]))


def views_of(given: Witness) -> Views:
    """The files that are wanted beside each drive. Raises ``UsageError``, ``MissingSolverError``."""
    if not given.animate:
        return Views(given.pictures, ())
    from roadproof.frontends.report.animations import animations

    known = animations()
    formats = formats_in(given.animate, known)
    if given.out is None:
        raise UsageError(f"animate={','.join(formats)}: name a folder for the animations with --out DIR")
    for name in formats:
        known[name].need()
    return Views(given.pictures, tuple(formats))


def files_written(
    question: WitnessQuestion, name: str, result: SearchResult, views: Views, folder: Path
) -> list[str]:
    """The names of the files that a result has in a folder."""
    names = question.claim_names(name)
    if result.verdict is Verdict.NONE_WITHIN:
        return [x for x in (f"{NONE_WITHIN}-{name}.json",) if (folder / x).is_file()]
    if result.drives:
        shown = names[: len(result.drives)]
        return [f"{stem}{ending}" for stem in shown for ending in (".json", *views.endings)]
    return [f"{names[0]}.json"] if result.certificate is not None else []
