"""Which disturbances a spec set misses: proofs that it misses none, or its gaps in classes."""

import time
from collections.abc import Iterator, Mapping
from contextlib import closing
from functools import cached_property, partial
from pathlib import Path
from typing import ClassVar, Unpack

from roadproof.analysis.coverage.answers import ClassAnswer, GapTraffic, Kept, Survey
from roadproof.analysis.coverage.classes import GapSurvey, sets_between
from roadproof.analysis.coverage.study import Coverage
from roadproof.analysis.coverage.traffic import count_in_traffic, recordings_in
from roadproof.analysis.study import pool
from roadproof.analysis.study.pool import Progress, Say
from roadproof.drivers.restriction import check_drives
from roadproof.errors import UsageError
from roadproof.evidence.answers import coverage as kept
from roadproof.evidence.kinds import Evidence
from roadproof.frontends.api.answer import Picture, picture
from roadproof.frontends.api.ci import BuildResult
from roadproof.frontends.api.definitions import Definitions, definitions_of
from roadproof.frontends.api.restricting import restricted
from roadproof.frontends.api.settings import as_road, basis_of
from roadproof.frontends.api.studied import StudyAnswers
from roadproof.frontends.report import coverage as report
from roadproof.frontends.report.ci.cases import Case
from roadproof.frontends.report.ci.questions import coverage_cases
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings import studies as settings
from roadproof.frontends.settings.keywords import CoverageKeywords
from roadproof.frontends.settings.option import takes
from roadproof.library.words import Called, called
from roadproof.runtime.executors import Jobs, hands_of
from roadproof.runtime.files import hold_folder
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict
from roadproof.world.road import Road

ROADS, ELSEWHERE = ("main-2", "main-3"), ("main-3", "merge", "depart")
COMPLETE = "complete"
CODES = {
    Verdict.COVERED: ExitCode.AS_EXPECTED,
    Verdict.GAPS: ExitCode.UNEXPECTED,
    Verdict.UNKNOWN: ExitCode.UNKNOWN,
    Verdict.CROSSCHECK_FAILED: ExitCode.CROSSCHECK_FAILED,
}


@dataclass(frozen=True, repr=False)
class Coverages(StudyAnswers[Coverage, Kept, kept.Record], BuildResult):
    """What a spec set misses; ``traffic``: how often each class of gaps occurs in recordings, if asked."""

    traffic: GapTraffic | None = None
    pieces: ClassVar[str] = "parts of the survey"
    command: ClassVar[str] = "coverage"

    @cached_property
    def surveyed(self) -> Survey:
        """Claims that there is no gap, the classes of gaps, and the definitions that are needed."""
        return self.study.together(self.found.answers, self.traffic)

    @cached_property
    def words(self) -> Called:
        """What the scenarios are called."""
        return called(self.study.survey.basis.specification)

    @property
    def verdict(self) -> Verdict:
        """COVERED, GAPS, UNKNOWN, or CROSSCHECK-FAILED where traffic shows what is proved not to be."""
        return self.surveyed.verdict

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """Of each claim, each class of gaps, and each definition that may be needed."""
        found: dict[str, Verdict] = {x.claim.text: x.verdict for x in self.surveyed.claims}
        found |= {_name(x): x.verdict for x in self.surveyed.classes}
        return found | {f"{x.definition} is needed": x.verdict for x in self.surveyed.needs}

    @property
    def evidence(self) -> tuple[Evidence, ...]:
        found: list[Evidence | None] = [x.certificate for x in self.surveyed.claims]
        for one in self.surveyed.classes:
            found += [one.certificate, *(gap.drive for gap in one.gaps)]
        found += [x.drive for x in self.surveyed.needs]
        return tuple(x for x in found if x is not None)

    @property
    def roads(self) -> tuple[Road, ...]:
        return tuple(self.study.survey.roads)

    @property
    def exit_code(self) -> ExitCode:
        return CODES[self.verdict]

    def cases(self) -> Iterator[Case]:
        index = self._index(self.found.records)
        keys = ["" if x.part is None else x.part.key for x in self.surveyed.classes]
        files = {
            key: self.folder / str(index.gaps[said.gaps[0] - 1].drive)
            for key, said in zip(keys, index.classes, strict=True)
            if self.folder and said.gaps
        }
        return coverage_cases(self.surveyed, self.study.survey.basis.specification, files)

    @property
    def _sheet(self) -> Sheet[kept.CountedClass] | Sheet[kept.Claim]:
        """An entry for each class of gaps, and where there is none, for each claim that shows so."""
        index = self._index(self.found.records)
        names = {number: x.name for number, x in self.words.items()}
        return report.sheet_of(index, names) if index.classes else report.sheet_of_claims(index)

    def _index(self, records: Mapping[str, kept.Record]) -> kept.Index:
        return self.study.index(self.surveyed, self.found.answers, records, self.seconds)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """A picture of each gap."""
        library = self.study.survey.basis.library
        gaps = ((x, gap) for x in self.surveyed.classes for gap in x.gaps)
        return ((f"gap-{k}", picture(report.draw_gap(*one, library))) for k, one in enumerate(gaps, 1))

    def draw_beside(self, jobs: Jobs = None, progress: Progress | None = None) -> None:
        """A picture of each gap beside its file, where answers were kept in a folder."""
        if self.folder is None:
            return
        library, kept = self.study.survey.basis.library, self._index(self.found.records).gaps
        shown = [(x, gap) for x in self.surveyed.classes for gap in x.gaps]
        pairs = [(*one, self.folder / str(said.drive)) for one, said in zip(shown, kept, strict=True)]
        draw = partial(report.draw_beside, library)
        with closing(pool.work(draw, pairs, jobs, None, progress, "pictures")) as done:
            list(done)

    def __str__(self) -> str:
        name = self.study.survey.basis.specification.set_name
        return report.as_text(self.surveyed, self._index(self.found.records), name, self.words)


def _name(answer: ClassAnswer) -> str:
    part = answer.part
    if part is None:
        return "no single condition"
    return part.component + (f": {part.condition}" if part.condition else "")


@takes(settings.Coverage)
def coverage(
    using: Definitions | None = None, *, tell: Say | None = None, **options: Unpack[CoverageKeywords]
) -> Coverages:
    """Which disturbances between two vehicles the spec set of ``using`` misses, in classes.

    ``wider``: the set that catches all (complete, where it extends the set); ``roads``: where drives are
    looked for; ``needed``: of a set that covers, also a drive for each definition that it needs. ``on``:
    recordings in which the classes are counted; ``strict``: no file of which vehicles or parts would be
    left out; ``tell`` is told how far that is. ``preventable``,
    ``unpreventable``: the name of a driver model, for drives that begin with a manoeuvre whose collision it
    prevents, or cannot prevent. ``out``: a folder in which
    answers are kept as they come. Raises ``InputError``, ``UsageError``.
    """
    begun = time.monotonic()
    given = settings.Coverage.of(options)
    wider = given.wider
    home = restricted(definitions_of(using), given, about="drives")
    check_drives(home.specification.options)
    basis = basis_of(home, given, given.vehicles)
    name = home.alone.set_name
    if wider is not None:
        home.specification.in_set(wider)
    between = sets_between(home.library, name, wider or COMPLETE)
    if wider is not None and not between:
        raise UsageError(f"--wider {wider} does not extend --set {name}: name a set that extends it")
    named = dict.fromkeys(ROADS if given.roads is None else given.roads)
    where = tuple(as_road(road, given.strict) for road in named)
    study = Coverage(GapSurvey(basis, between, where, tuple(map(as_road, ELSEWHERE))), given.needed)
    recordings = None if given.on is None else recordings_in(Path(given.on), given.strict)

    def count() -> dict[str, GapTraffic]:
        if recordings is None:
            return {}
        return {"traffic": count_in_traffic(basis, recordings, tell or (lambda line: None))}

    folder = None if given.out is None else Path(given.out)
    with hold_folder(folder, shared=hands_of(given.jobs).shard is not None):
        return Coverages.asked(study, given, more=count, begun=begun)
