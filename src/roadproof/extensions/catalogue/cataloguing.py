"""What a catalogue of tests shows, what it misses, and drives for what is missing."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import ClassVar, Unpack

from roadproof.errors import UsageError
from roadproof.evidence.claim import Objective
from roadproof.extensions.catalogue import kept, report, settings
from roadproof.extensions.catalogue.cases import catalogue_cases
from roadproof.extensions.catalogue.completing import PriorResults, complete
from roadproof.extensions.catalogue.driven import driven_name
from roadproof.extensions.catalogue.entries import Catalogue, Concrete, Request
from roadproof.extensions.catalogue.keywords import CatalogueKeywords
from roadproof.extensions.catalogue.question import AskedTests, CatalogueQuestion
from roadproof.extensions.catalogue.ranges import Span
from roadproof.extensions.catalogue.report_drives import DrivePicture, draw_tests
from roadproof.extensions.catalogue.showing import ConcreteAnswer
from roadproof.extensions.catalogue.tested import SCENARIOS, Targets, kind_of
from roadproof.extensions.catalogue.traces import Courses, courses_of, of_drive
from roadproof.extensions.catalogue.view import CatalogueView
from roadproof.extensions.catalogue.writing import CompletionAnswer, write_completions
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.restricting import restricted
from roadproof.extensions.traffic.evaluate.decisions import Decision
from roadproof.frontends.api.answer import Picture, picture
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.api.definitions import Definitions, definitions_of
from roadproof.frontends.api.pictures import drawn
from roadproof.frontends.api.questioned import QuestionAnswers
from roadproof.frontends.api.settings import basis_of, one_of
from roadproof.frontends.report.cases import Case
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings.option import takes
from roadproof.library.scenarios import number_in, numbers_of
from roadproof.runtime.executors import Jobs
from roadproof.runtime.pool import Progress
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict

MOST_DRIVEN = 20
"""Pictures of drives in which models drive SV."""


@dataclass(frozen=True, repr=False)
class CatalogueAnswer(QuestionAnswers[CatalogueView], BuildResult):
    """What tests show and mean."""

    question: CatalogueQuestion
    pieces: ClassVar[str] = "questions about tests"
    command: ClassVar[str] = "catalogue"

    def cases(self) -> Iterator[Case]:
        home, sources = self.question.basis.specification, self.catalogue.sources
        return catalogue_cases(self.tests, self.tested, sources, home)

    @property
    def catalogue(self) -> Catalogue:
        """The tests, as they were read."""
        return self.view.catalogue

    @property
    def tested(self) -> Targets:
        """What is tested, what is missing, and what is to be said of tests."""
        return self.view.tested

    @property
    def concrete(self) -> tuple[ConcreteAnswer, ...]:
        """What concrete tests show, in order."""
        return self.view.concrete

    @property
    def decisions(self) -> tuple[tuple[str, Decision], ...]:
        """What becomes of each test, by id, under each driver model."""
        return self.view.decisions

    @property
    def missing(self) -> tuple[str, ...]:
        """What is to be tested, and no test shows: scenarios, classes, with ``gaps`` classes of gaps."""
        return self.view.missing

    @property
    def figures(self) -> tuple[kept.Figure, ...]:
        """How much is tested: by spec set, kind and road sector."""
        return self.view.figures

    @property
    def spans(self) -> tuple[Span, ...]:
        """Where it was asked, how tests of each class begin, and how drives of it can."""
        return self.view.spans

    @property
    def notes(self) -> tuple[str, ...]:
        """On files that are no tests, samples that contradict themselves, drives made with other values."""
        return self.view.notes

    @property
    def left_out(self) -> tuple[str, ...]:
        """Those of the notes that say which vehicles and parts of files were left out."""
        return self.view.left_out

    @property
    def in_force(self) -> tuple[str, ...]:
        """What was asked otherwise than by default: spec set, readings, parameters, a driver model."""
        return self.view.in_force

    @property
    def tests(self) -> tuple[str, ...]:
        """The tests by id, in order."""
        return tuple(x.id for x in self.catalogue.entries)

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """COVERED for what a test shows, else GAPS: scenarios, classes, with ``gaps`` classes of gaps.

        Classes of gaps that are proved empty are IMPOSSIBLE; UNKNOWN are those not known to be.
        """
        found = {x.name: Verdict.COVERED if x.tested else Verdict.GAPS for x in self.tested.targets}
        gaps = self.tested.gaps
        if gaps.asked:
            found |= {x.name: Verdict.COVERED if x.tested else Verdict.GAPS for x in gaps.targets}
            found |= dict.fromkeys(gaps.open, Verdict.UNKNOWN)
            found |= {x.name: Verdict.IMPOSSIBLE for x in gaps.empty}
        return found

    @property
    def exit_code(self) -> ExitCode:
        found = self.tested
        if found.contradictions:
            return ExitCode.CROSSCHECK_FAILED
        if found.doubts:
            return ExitCode.UNKNOWN
        return ExitCode.UNEXPECTED if found.missing or found.faults else ExitCode.AS_EXPECTED

    @property
    def _sheet(self) -> Sheet[kept.Target]:
        """An entry for each scenario and class, and for each class of gaps that is shown or asked for."""
        found = self.tested
        return report.sheet_of((*found.all_targets, *found.gaps.empty), self.verdicts)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Which test shows which scenario and gap, how many tests each class has; then all tests, small."""
        yield "matrix", picture(report.draw_matrix(self.tests, self.tested, self.view.in_force))
        for k, page in enumerate(draw_tests(self._drawn()), 1):
            yield f"tests-{k}", picture(page)
        yield from self._driven_pictures()

    def _driven_pictures(self) -> Iterator[tuple[str, Picture]]:
        """The drives in which models drive SV; of many those that touch POV or are undecided."""
        from roadproof.frontends.report.drive import draw_drive

        sides = {driven_name(test, x): x.side for test, x in self.decisions}
        found = {name: x.drive.file for name, x in self.view.driven.items() if x.drive is not None}
        if len(found) > MOST_DRIVEN:
            found = {name: x for name, x in found.items() if sides.get(name) != "preventable"}
        for name, file in [*found.items()][:MOST_DRIVEN]:
            yield name, picture(draw_drive(file, self.library))

    def _drawn(self) -> list[DrivePicture]:
        """The tests to be drawn, by the first scenario that each shows."""
        targets = [x for x in self.tested.targets if kind_of(x.name) == SCENARIOS]
        groups = {
            test: f"{number_in(x.name)} {x.words}"
            for x in reversed(targets)
            for test in (*x.possible, *x.tested)
        }
        runs = {x.test: x.drive for x in self.view.facts if x.relation == "runs"}
        courses: dict[str, Courses | None] = {}
        for entry in self.catalogue.entries:
            if isinstance(entry, Concrete):
                courses[entry.id] = courses_of(entry)
            elif (drive := runs.get(entry.id)) is not None:
                courses[entry.id] = of_drive(drive.file)
        drawn = [
            DrivePicture(test, groups.get(test, "no scenario"), x)
            for test, x in courses.items()
            if x is not None
        ]
        order = [*dict.fromkeys(f"{number_in(x.name)} {x.words}" for x in targets), "no scenario"]
        return sorted(drawn, key=lambda x: order.index(x.group))

    def files(self, pictures: bool) -> dict[str, bytes]:
        """A table for a spreadsheet, a report for CI, and the picture."""
        return report.tables(self.view) | drawn(self.pictures() if pictures else {})

    def to_csv(self) -> str:
        """A row a test, a column a scenario, class, gap: x shown or implied, o by some drives of the test."""
        return report.as_csv(self.tests, self.tested, self.view.in_force)

    def __str__(self) -> str:
        drivers, view = report.driver_lines(self.decisions), self.view
        told = report.as_text(len(self.tests), self.tested, view.notes, view.figures, drivers)
        ranges = report.range_lines(view.spans, self.question.basis.horizon)
        return "\n".join([*ranges, told])

    def complete(
        self,
        out: str | Path,
        objective: Objective = "smooth",
        spread: int = 1,
        formats: str | Iterable[str] = (),
        jobs: Jobs = None,
        progress: Progress | None = None,
        specs: Iterable[str | Path] = (),
    ) -> CompletionAnswer:
        """Write a drive for all that no test shows into a folder, as tests with a ``catalogue.toml``.

        ``objective``: what drives are to be like, as for ``witness``. ``spread``: until each class has so
        many tests, or each scenario where there are no classes, further drives that begin far from all that
        it has (``far.distance``). ``formats``: for which other tools they are written too, as by ``export``,
        each with an entry; ``specs``: specification files that these need. Raises ``InputError``,
        ``UsageError``.
        """
        one_of("objective", objective, Objective)
        if spread < 1:
            raise UsageError(f"spread={spread}: write how many tests each class is to have, 1 or more")
        asked = self.view.asked
        basis = replace(self.question.basis, objective=objective)
        made = complete(basis, asked, self.missing, self._known(), spread, jobs, progress)
        words = {x.name: x.words for x in (*self.tested.all_targets, *self.tested.gaps.empty)}
        like = "" if objective == "smooth" else f", {objective}"
        titles = {
            x.name: words[x.target] + like + (", far from the others" if x.apart is not None else "")
            for x in made
        }
        return write_completions(Path(out), made, titles, asked, formats, specs)

    def _known(self) -> PriorResults:
        """What is known of targets before drives are looked for."""
        begins = {x.name: [y.begins for y in self.concrete if x.name in y.names] for x in self.tested.targets}
        copies = {x.entry.id for x in self.concrete if x.entry.copy_of in self.tests}
        tests = {x.name: len({*x.tested} - copies) for x in self.tested.targets}
        gaps = {name: x for name, x in (self.view.gap_answers or {}).items() if x is not None and x.gaps}
        return PriorResults(begins, tests, gaps)


@takes(settings.Catalogue)
def catalogue(
    *paths: str | Path, using: Definitions | None = None, **options: Unpack[CatalogueKeywords]
) -> CatalogueAnswer:
    """Which scenarios and classes the tests in folders and files show, and which nobody tests.

    The first spec set of ``using`` is asked about; of further ones there are figures. ``classes``: whether
    scenarios are divided into classes (``classify``), which need whole rows of the table in ``among``;
    ``gaps``: whether each class of gaps that there is (``coverage``) is to be tested too; ``explore``: also
    how far drives of each class that is tested can go, and which part of that nobody tests. ``roles``,
    ``lanes``, ``start``: whether those are looked at that a test fixes, or "any". ``near``: how far apart
    tests that say the same may begin, in m and m/s. ``strict``: a test of whose files vehicles or parts
    would be left out has a fault. ``preventable``, ``unpreventable``: as for ``witness``;
    gaps are then a question for ``coverage``. ``drivers``: the driver models that are asked what becomes of
    the scenarios that tests show, all where None. ``out``: a folder for evidence on abstract tests, gaps
    and ranges. Raises ``InputError``, ``TextError``, ``UsageError``.
    """
    given = settings.Catalogue.of(options)
    plain = definitions_of(using)
    wanted = restricted(plain, given, given.among)
    restricting = (x for x in (given.preventable, given.unpreventable) if x is not None)
    models = tuple(dict.fromkeys((*(MODELS if given.drivers is None else given.drivers), *restricting)))
    request = Request(
        tuple(map(str, paths)),
        wanted.sets,
        given.classes,
        given.gaps,
        given.explore,
        given.roles,
        given.lanes,
        given.start,
        float(given.near),
        models,
        given.strict,
    )
    basis = basis_of(replace(wanted, sets=wanted.sets[:1]), given, given.vehicles)
    numbers = wanted.among(given.among) or numbers_of(wanted.specification)
    question = CatalogueQuestion(basis, AskedTests(request=request.kept, scenarios=tuple(numbers)))
    return CatalogueAnswer.settled(question, given)
