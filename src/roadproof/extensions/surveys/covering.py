"""``roadproof.coverage``: the gaps of a spec set in classes, or proofs that it has none."""

import time
from collections.abc import Iterator, Mapping
from contextlib import closing
from dataclasses import replace
from functools import cached_property, partial
from pathlib import Path
from typing import ClassVar, Unpack

from roadproof.engines.modifier import find_modifier
from roadproof.errors import UsageError
from roadproof.evidence.codec import write
from roadproof.evidence.kinds import Evidence
from roadproof.evidence.strict import JsonObject
from roadproof.extensions.surveys import settings
from roadproof.extensions.surveys.coverage.answers import ClassAnswer, GapSurvey, GapTraffic, with_traffic
from roadproof.extensions.surveys.coverage.cases import coverage_cases
from roadproof.extensions.surveys.coverage.classes import sets_between
from roadproof.extensions.surveys.coverage.data import CoverageData
from roadproof.extensions.surveys.coverage.question import CoverageQuestion, CoverageView, gaps_of
from roadproof.extensions.surveys.coverage.schema import CountedClass, CoverageClaimData
from roadproof.extensions.surveys.coverage.traffic import count_in_traffic, recordings_in
from roadproof.extensions.surveys.keywords import CoverageKeywords
from roadproof.extensions.surveys.report import coverage as report
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.api.definitions import Definitions, definitions_of
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.api.settings import as_road, basis_of
from roadproof.frontends.report.cases import Case
from roadproof.frontends.report.picture import Picture, draws_drives
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings.option import takes
from roadproof.library.words import ScenarioWords, words_by_number
from roadproof.questions.views import placing
from roadproof.runtime import pool
from roadproof.runtime.executors import Jobs, executor_for
from roadproof.runtime.files import lock_folder
from roadproof.runtime.pool import Progress, Say
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict
from roadproof.world.road import Road

ROADS, ELSEWHERE = ("main-2", "main-3"), ("main-3", "merge", "depart")
COMPLETE = "complete"
CODES: Mapping[Verdict, ExitCode] = {  # partial: coverage has no other verdicts
    Verdict.COVERED: ExitCode.AS_EXPECTED,
    Verdict.GAPS: ExitCode.UNEXPECTED,
    Verdict.UNKNOWN: ExitCode.UNKNOWN,
    Verdict.CROSSCHECK_FAILED: ExitCode.CROSSCHECK_FAILED,
}


@dataclass(frozen=True, repr=False)
class Coverages(QuestionAnswers[CoverageView], BuildResult):
    """The gaps of a spec set; ``traffic``: counts of each class of gaps in recordings, with ``on``."""

    question: CoverageQuestion
    traffic: GapTraffic | None = None
    pieces: ClassVar[str] = "parts of the survey"
    command: ClassVar[str] = "coverage"

    @cached_property
    def view(self) -> CoverageView:
        view = self.question.view(self.found.answers)
        return view if self.traffic is None else replace(view, survey=with_traffic(view.survey, self.traffic))

    @property
    def surveyed(self) -> GapSurvey:
        """Claims that there is no gap, the classes of gaps, and the definitions that are needed."""
        return self.view.survey

    @cached_property
    def words(self) -> ScenarioWords:
        """The titles of the scenarios."""
        return words_by_number(self.question.basis.specification)

    @property
    def verdict(self) -> Verdict:
        """COVERED, GAPS, UNKNOWN, or CROSSCHECK-FAILED if traffic contradicts a proof."""
        return self.surveyed.verdict

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """The verdicts on claims, classes of gaps, and definitions that may be needed."""
        verdicts: dict[str, Verdict] = {x.claim.text: x.verdict for x in self.surveyed.claims}
        verdicts |= {_name(x): x.verdict for x in self.surveyed.classes}
        return verdicts | {f"{x.definition} is needed": x.verdict for x in self.surveyed.needs}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        evidence: list[Evidence | None] = [x.certificate for x in self.surveyed.claims]
        for one in self.surveyed.classes:
            evidence += [one.certificate, *(gap.drive for gap in one.gaps)]
        evidence += [x.drive for x in self.surveyed.needs]
        return tuple(x for x in evidence if x is not None)

    @property
    def roads(self) -> tuple[Road, ...]:
        return self.question.where.roads

    @property
    def exit_code(self) -> ExitCode:
        return CODES[self.verdict]

    def _data(self) -> CoverageData:
        return self.question.data(self.view, placing(self.folder), self.seconds)

    def as_data(self) -> JsonObject:
        return write(self._data())

    def cases(self) -> Iterator[Case]:
        files = {
            "" if x.part is None else x.part.key: self.folder / f"{x.gaps[0].shown.name}.json"
            for x in self.surveyed.classes
            if self.folder and x.gaps
        }
        return coverage_cases(self.surveyed, self.question.basis.specification, files)

    @property
    def _sheet(self) -> Sheet[CountedClass] | Sheet[CoverageClaimData]:
        """An entry for each class of gaps; without gaps, for each claim of coverage."""
        data = self._data()
        names = {number: x.name for number, x in self.words.items()}
        return report.sheet_of(data, names) if data.classes else report.sheet_of_claims(data)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Yield a picture of each gap."""
        gaps = ((x, gap) for x in self.surveyed.classes for gap in x.gaps) if draws_drives() else ()
        return ((f"gap-{k}", report.draw_gap(*one, self.library)) for k, one in enumerate(gaps, 1))

    def draw_beside(self, jobs: Jobs = None, progress: Progress | None = None) -> None:
        """Draw each gap beside its file, if answers are in a folder."""
        if self.folder is None:
            return
        pairs = [
            (x, gap, self.folder / f"{gap.shown.name}.json") for x in self.surveyed.classes for gap in x.gaps
        ]
        draw = partial(report.draw_beside, self.library)
        with closing(pool.work(draw, pairs, jobs, None, progress, "pictures")) as done:
            list(done)

    def __str__(self) -> str:
        name = self.question.basis.specification.set_name
        return report.as_text(self.surveyed, self._data(), name, self.words)


def _name(answer: ClassAnswer) -> str:
    part = answer.part
    if part is None:
        return "no single condition"
    return part.component + (f": {part.condition}" if part.condition else "")


@takes(settings.Coverage)
def coverage(
    using: Definitions | None = None, *, tell: Say | None = None, **options: Unpack[CoverageKeywords]
) -> Coverages:
    """Find the disturbances between two vehicles that the spec set of ``using`` misses, in classes.

    ``wider``: the set that catches all (complete, if it extends the set); ``roads``: where drives are
    searched; ``needed``: for a set without gaps, also find a drive for each definition that it needs. ``on``:
    recordings in which to count the classes; ``strict``: refuse files of which vehicles or parts would be
    left out; ``tell`` is called with the progress of counting. ``preventable``, ``unpreventable``: the name
    of a driver model, for drives that begin with a manoeuvre whose collision it prevents, or cannot prevent.
    ``out``: a folder for answers, which are written as they come. Raises ``InputError``, ``UsageError``.
    """
    started = time.monotonic()
    given = settings.Coverage.of(options)
    wider = given.wider
    home = given.modified(definitions_of(using))
    modifier = find_modifier(home.specification.options)
    if modifier is not None:
        modifier.check_drives()
    basis = basis_of(home, given, given.vehicles)
    name = home.alone.set_name
    if wider is not None:
        home.specification.in_set(wider)
    between = sets_between(home.library, name, wider or COMPLETE)
    if wider is not None and not between:
        raise UsageError(f"--wider {wider} does not extend --set {name}: name a set that extends it")
    named = dict.fromkeys(ROADS if given.roads is None else given.roads)
    where = tuple(as_road(road, given.strict) for road in named)
    gap_settings = gaps_of(between, where, tuple(map(as_road, ELSEWHERE)), given.needed)
    recordings = None if given.on is None else recordings_in(Path(given.on), given.strict)

    folder = None if given.out is None else Path(given.out)
    with lock_folder(folder, shared=executor_for(given.jobs).shard is not None):
        result = Coverages.decide(CoverageQuestion(basis, gap_settings), given)
        traffic = None
        if recordings is not None:
            traffic = count_in_traffic(basis, recordings, tell or (lambda line: None))
        return replace(result, traffic=traffic, seconds=time.monotonic() - started)
