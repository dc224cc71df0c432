"""Drives for scenarios and formulas."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import field, replace
from functools import partial
from itertools import product
from pathlib import Path
from typing import ClassVar, Unpack

from roadproof.analysis.study import pool
from roadproof.analysis.study.frame import StudyResult, look_up, put_away
from roadproof.analysis.witnesses import WitnessStudy, evidence_files, none_within_file, stems
from roadproof.engines.search.outcome import Outcome, Search
from roadproof.engines.search.question import SearchOptions, pose
from roadproof.errors import UsageError
from roadproof.evidence.answers import drives as kept
from roadproof.evidence.answers.drives import Answer
from roadproof.evidence.codec import write
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.kinds import Evidence
from roadproof.evidence.strict import JsonObject
from roadproof.frontends.api.answer import Picture
from roadproof.frontends.api.ci import BuildResult
from roadproof.frontends.api.definitions import Definitions, What, definitions_of
from roadproof.frontends.api.restricting import restricted
from roadproof.frontends.api.settings import searches_of, setting, work_of
from roadproof.frontends.api.studied import StudyAnswers, drive_pictures
from roadproof.frontends.report.animation import ENDINGS
from roadproof.frontends.report.ci.cases import Case
from roadproof.frontends.report.ci.questions import search_cases
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.report.witness import EVERY_VIEW, SearchedFor, Views, as_line, sheet_of
from roadproof.frontends.settings.keywords import WitnessKeywords
from roadproof.frontends.settings.option import takes
from roadproof.frontends.settings.questions import Witness
from roadproof.library.specification import Library
from roadproof.runtime.files import json_bytes, make_folder, write_whole
from roadproof.runtime.progress import Listener, listening
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict, exit_code
from roadproof.world.road import Road


@dataclass(frozen=True)
class DriveFolder:
    """Writes samples, pictures and animations of drives into a folder, where they are not there yet."""

    folder: Path
    library: Library
    views: Views
    searches: Mapping[str, Search] = field(default_factory=dict)

    def __call__(self, name: str, outcome: Outcome) -> None:
        make_folder(self.folder)
        if name in self.searches:
            self._show_none(name, outcome)
        for stem, judged in zip(stems(name, outcome), outcome.drives, strict=True):
            samples = self.folder / f"{stem}.csv"
            former = samples.read_bytes() if samples.is_file() else b""
            for ending, content in self.views.of(judged, self.library):
                write_whole(self.folder / f"{stem}{ending}", content)
            if samples.read_bytes() != former:  # the other files are those of a former drive
                for ending in {*EVERY_VIEW.endings} - {*self.views.endings}:
                    (self.folder / f"{stem}{ending}").unlink(missing_ok=True)

    def _show_none(self, name: str, outcome: Outcome) -> None:
        """Evidence of a NONE-WITHIN, where a tree is found; none of a former answer is left."""
        path = self.folder / none_within_file(name)
        path.unlink(missing_ok=True)
        if outcome.verdict is Verdict.NONE_WITHIN:
            from roadproof.engines.search.none_within import refute
            from roadproof.evidence.none_within import none_within_data

            found = refute(self.searches[name])
            if found is not None:
                write_whole(path, json_bytes(none_within_data(found)))

    def lacks(self, name: str, outcome: Outcome) -> bool:
        """Whether any is not there."""
        every = product(stems(name, outcome), self.views.endings)
        return any(not (self.folder / f"{stem}{ending}").exists() for stem, ending in every)


@dataclass(frozen=True, repr=False)
class Witnesses(StudyAnswers[WitnessStudy, Outcome, kept.Record], BuildResult):
    """Searches for drives, and what came out of each."""

    pieces: ClassVar[str] = "questions"
    command: ClassVar[str] = "witness"

    def cases(self) -> Iterator[Case]:
        named = self.study.named
        searches = ((name, self.found.answers[name]) for name in named)
        return search_cases((x, named[name].specification, self._file(name, x)) for name, x in searches)

    def _file(self, name: str, outcome: Outcome) -> Path | None:
        files = evidence_files(name, outcome)
        return self.folder / files[0] if self.folder is not None and files else None

    @property
    def library(self) -> Library:
        return self.study.question.library

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """What came out, in the order in which it was asked."""
        return tuple(self.found.answers[name] for name in self.study.names)

    @property
    def drives(self) -> tuple[JudgedDrive, ...]:
        """All drives that were found."""
        return tuple(drive for outcome in self.outcomes for drive in outcome.drives)

    @property
    def verdicts(self) -> dict[str, Verdict]:
        return {f"{x.query.text}@{x.set_name}": x.verdict for x in self.outcomes}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        proofs = (x.impossibility.certificate for x in self.outcomes if x.impossibility is not None)
        return (*self.drives, *proofs)

    @property
    def road(self) -> Road | None:
        return self.study.searches[0].setting.road

    @property
    def exit_code(self) -> ExitCode:
        return exit_code((x.verdict, Verdict.WITNESSED) for x in self.outcomes)

    @property
    def _sheet(self) -> Sheet[SearchedFor]:
        homes = (search.specification for search in self.study.named.values())
        return sheet_of([*zip(self.outcomes, homes, strict=True)])

    def as_data(self) -> JsonObject:
        return write(self._index(self.found.records))

    def _index(self, records: Mapping[str, kept.Record]) -> Answer:
        verdicts = tuple(x.kept for x in self.outcomes)
        return Answer(**self.study.question.beginning, **Answer.of_road(self.road), verdicts=verdicts)

    def _write_index(self, folder: Path, found: StudyResult[Outcome, kept.Record]) -> None:
        """There is none: drive files and proofs stand for themselves."""

    def _write(self, folder: Path, pictures: bool) -> None:
        make_folder(folder)
        answers = {name: self.found.answers[name] for name in self.study.named}
        searches = self.study.named if folder != self.folder else {}
        if searches and self.evidence:
            put_away(self.study, answers, folder)
        beside = DriveFolder(folder, self.library, Views(pictures), searches)
        for name, outcome in answers.items():
            beside(name, outcome)
        if searches and not self.evidence and any(folder.glob(none_within_file("*"))):
            put_away(self.study, answers, folder)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        return drive_pictures(((f"drive-{k}", x) for k, x in enumerate(self.drives, 1)), self.library)

    def __str__(self) -> str:
        answers, searches = self.found.answers, self.study.named
        lines = [as_line(answers[name], search.specification) for name, search in searches.items()]
        return "\n".join([*lines, *([self.summary] if len(lines) > 1 else [])])

    @property
    def summary(self) -> str:
        """How many were found, in words."""
        found = sum(x.verdict is Verdict.WITNESSED for x in self.outcomes)
        return f"{found} of {len(self.outcomes)} witnessed in {self.seconds:.1f} s"


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
    ``objective``: what a drive should be like: any, smooth, margin, mild, severe or short. ``preventable``,
    ``unpreventable``: the name of a driver model, for scenarios that begin with a manoeuvre whose collision
    it prevents, or cannot prevent (``preventing.restriction``). ``effort``: units
    of work for a search, each about a second of a solver; ``timeout``: seconds after which the clock ends it.
    ``out``: a folder in which drives are kept as they come, with samples and ``pictures``; ``animate``:
    formats of animations there, such as "svg,gif" (mp4 needs the program ffmpeg). ``stage`` is told
    of each stage that begins (``stages.Stage``), and ends all by raising.
    Raises ``TextError``, ``InputError``, ``UsageError``, ``MissingSolverError``.

    >>> witness(4, jobs=1).verdict
    <Verdict.WITNESSED: 'WITNESSED'>
    """
    given = Witness.of(options)
    searches = searches_for(what, definitions_of(using), given)
    with listening(stage):
        return witness_all(searches, given)


def known_drives(numbers: Sequence[int], using: Definitions) -> dict[int, JudgedDrive]:
    """The drives of scenarios, by number, that are known without a search (``study.known``).

    Raises ``InputError`` for a number that the spec set does not have.
    """
    study = WitnessStudy(tuple(searches_for(numbers, using, Witness())))
    found = look_up(study) if study.searches else {}
    return {x.scenario: x.drives[0] for x in found.values() if x.scenario is not None and x.drives}


def searches_for(what: Sequence[What], using: Definitions, given: Witness) -> list[Search]:
    """The searches that ``witness`` makes. Raises as that does."""
    each = using.each(what)
    home = restricted(using, given, what=each)
    search_options = SearchOptions(given.objective, given.engine, given.solver, work_of(given))
    found = list(searches_of(home, each, setting(home, given), search_options, given.count))
    for search in found if len(found) > 1 else ():
        _refuse_early(search)
    return found


def _refuse_early(search: Search) -> None:
    """Raises ``UsageError`` for one of several formulas that cannot be asked, before others are searched."""
    if search.scenario is None:
        try:
            pose(search.specification.library, search.query, search.setting)
        except UsageError as error:
            raise UsageError(f"{search.query.text[:80]}: {error}") from None


def witness_all(
    searches: Sequence[Search], given: Witness, each: Callable[[str, Outcome], None] | None = None
) -> Witnesses:
    """As ``witness``, with searches as values; ``each`` is told of every outcome under its name."""
    if not searches:
        raise UsageError("the spec set has no scenario: name formulas")
    library, out, views = searches[0].specification.library, given.out, views_of(given)
    study = WitnessStudy(tuple(searches))
    beside = None if out is None else DriveFolder(Path(out), library, views, study.named)
    study = replace(study, finish=beside)
    found = Witnesses.asked(study, given, each)
    if beside is not None:
        left = [(name, x) for name in study.named if beside.lacks(name, x := found.found.answers[name])]
        finish = partial(_finish, beside)
        with closing(pool.work(finish, left, given.jobs, None, given.progress, "drives")) as done:
            list(done)
    return found


def _finish(beside: DriveFolder, of: tuple[str, Outcome]) -> None:
    beside(*of)


def views_of(given: Witness) -> Views:
    """The files that are wanted beside each drive. Raises ``UsageError``, ``MissingSolverError``."""
    if not given.animate:
        return Views(given.pictures, ())
    from roadproof.frontends.api.exporting import formats_in
    from roadproof.frontends.report.film import need

    wanted = formats_in(given.animate, ENDINGS)
    if given.out is None:
        raise UsageError(f"animate={','.join(wanted)}: name a folder for the animations with --out DIR")
    need(wanted)
    return Views(given.pictures, tuple(wanted))


def files_written(name: str, outcome: Outcome, views: Views, folder: Path) -> list[str]:
    """The names of the files that an outcome has in a folder."""
    if outcome.verdict is Verdict.NONE_WITHIN:
        return [x for x in (none_within_file(name),) if (folder / x).is_file()]
    every = (f"{stem}{ending}" for stem in stems(name, outcome) for ending in (".json", *views.endings))
    return list(every) if outcome.drives else evidence_files(name, outcome)
