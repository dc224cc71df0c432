"""The analysis of a catalogue of tests: scenarios shown and missing, and drives for the missing ones."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import ClassVar, Unpack

from roadproof.errors import UsageError
from roadproof.evidence.claim import Objective
from roadproof.extensions.catalogue import catalogue_data, report, settings
from roadproof.extensions.catalogue.cases import catalogue_cases
from roadproof.extensions.catalogue.completing import PriorResults, complete
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.curves import DriveCurves, curves_of, curves_of_drive
from roadproof.extensions.catalogue.driver_claims import driver_claim_name
from roadproof.extensions.catalogue.entries import CatalogueTests, ConcreteTest, Request
from roadproof.extensions.catalogue.figures import SCENARIOS, kind_of
from roadproof.extensions.catalogue.keywords import CatalogueKeywords
from roadproof.extensions.catalogue.question import CatalogueQuestion, CatalogueQuestionData
from roadproof.extensions.catalogue.ranges import InitialValueRange
from roadproof.extensions.catalogue.report_drives import DrivePicture, draw_tests
from roadproof.extensions.catalogue.targets import Targets
from roadproof.extensions.catalogue.view import CatalogueView
from roadproof.extensions.catalogue.writing import CompletionAnswer, write_completions
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.restricting import restricted
from roadproof.extensions.traffic.evaluate.decisions import Decision
from roadproof.frontends.api.build_result import BuildResult
from roadproof.frontends.api.definitions import Definitions, definitions_of
from roadproof.frontends.api.question_answers import QuestionAnswers
from roadproof.frontends.api.settings import basis_of, one_of
from roadproof.frontends.report.cases import Case
from roadproof.frontends.report.picture import Picture, draw_drive, drawn, draws_drives, picture
from roadproof.frontends.report.sheet import Sheet
from roadproof.frontends.settings.option import takes
from roadproof.library.scenarios import number_in, numbers_of
from roadproof.runtime.executors import Jobs
from roadproof.runtime.pool import Progress
from roadproof.runtime.records import dataclass
from roadproof.verdict import ExitCode, Verdict

MOST_DRIVEN = 20
"""The most pictures of drives in which driver models drive SV."""


@dataclass(frozen=True, repr=False)
class CatalogueAnswer(QuestionAnswers[CatalogueView], BuildResult):
    """The answer about a catalogue of tests."""

    question: CatalogueQuestion
    pieces: ClassVar[str] = "questions about tests"
    command: ClassVar[str] = "catalogue"

    def cases(self) -> Iterator[Case]:
        """Yield a case for each test and each target."""
        home, sources = self.question.basis.specification, self.catalogue.sources
        return catalogue_cases(self.tests, self.tested, sources, home)

    @property
    def catalogue(self) -> CatalogueTests:
        """The tests, as they were read."""
        return self.view.catalogue

    @property
    def tested(self) -> Targets:
        """The tested and missing targets, with remarks on tests."""
        return self.view.tested

    @property
    def concrete(self) -> tuple[ConcreteAnswer, ...]:
        """The answers of concrete tests, in order."""
        return self.view.concrete

    @property
    def decisions(self) -> tuple[tuple[str, Decision], ...]:
        """The decisions of each driver model in each test, with the id of the test."""
        return self.view.decisions

    @property
    def missing(self) -> tuple[str, ...]:
        """The targets that no test shows: scenarios, classes, and with ``gaps`` classes of gaps."""
        return self.view.missing

    @property
    def figures(self) -> tuple[catalogue_data.Figure, ...]:
        """The numbers of tested and of all targets, by spec set, kind and road sector."""
        return self.view.figures

    @property
    def spans(self) -> tuple[InitialValueRange, ...]:
        """The tested and the reached range of each initial value of each class, with ``explore``."""
        return self.view.spans

    @property
    def notes(self) -> tuple[str, ...]:
        """The notes on files that are no tests, contradictory samples, and drives made with other values."""
        return self.view.notes

    @property
    def left_out(self) -> tuple[str, ...]:
        """The notes on vehicles and parts of files that were left out."""
        return self.view.left_out

    @property
    def in_force(self) -> tuple[str, ...]:
        """The settings that differ from the defaults: spec set, readings, parameters, a driver model."""
        return self.view.in_force

    @property
    def tests(self) -> tuple[str, ...]:
        """The tests by id, in order."""
        return tuple(x.id for x in self.catalogue.entries)

    @property
    def verdicts(self) -> dict[str, Verdict]:
        """COVERED for each target that a test shows, else GAPS; with ``gaps`` also for classes of gaps.

        A class of gaps that is proved empty is IMPOSSIBLE, one with neither proof nor drive is UNKNOWN.
        """
        verdicts = {x.name: Verdict.COVERED if x.tested else Verdict.GAPS for x in self.tested.targets}
        gaps = self.tested.gaps
        if gaps.required:
            verdicts |= {x.name: Verdict.COVERED if x.tested else Verdict.GAPS for x in gaps.targets}
            verdicts |= dict.fromkeys(gaps.open, Verdict.UNKNOWN)
            verdicts |= {x.name: Verdict.IMPOSSIBLE for x in gaps.empty}
        return verdicts

    @property
    def exit_code(self) -> ExitCode:
        """The exit code of a contradiction, else of an open claim, else of a fault or a missing target."""
        targets = self.tested
        if targets.contradictions:
            return ExitCode.CROSSCHECK_FAILED
        if targets.doubts:
            return ExitCode.UNKNOWN
        return ExitCode.UNEXPECTED if targets.missing or targets.faults else ExitCode.AS_EXPECTED

    @property
    def _sheet(self) -> Sheet[catalogue_data.TargetData]:
        """An entry for each scenario and class, and for each class of gaps that is shown or required."""
        targets = self.tested
        return report.sheet_of((*targets.all_targets, *targets.gaps.empty), self.verdicts)

    def each_picture(self) -> Iterator[tuple[str, Picture]]:
        """Yield the matrix of tests and targets, small pictures of all tests, and drives of driver models."""
        yield "matrix", picture(report.draw_matrix(self.tests, self.tested, self.view.in_force))
        for k, page in enumerate(draw_tests(self._drawn()), 1):
            yield f"tests-{k}", picture(page)
        yield from self._driven_pictures()

    def _driven_pictures(self) -> Iterator[tuple[str, Picture]]:
        """Yield drives in which driver models drive SV; of many only those that are not preventable."""
        sides = {driver_claim_name(test, x): x.side for test, x in self.decisions}
        files = {name: x.drive.file for name, x in self.view.driven.items() if x.drive is not None}
        if len(files) > MOST_DRIVEN:
            files = {name: x for name, x in files.items() if sides.get(name) != "preventable"}
        for name, file in [*files.items()][:MOST_DRIVEN] if draws_drives() else ():
            yield name, draw_drive(file, self.library)

    def _drawn(self) -> list[DrivePicture]:
        """Return the pictures of tests, by the first scenario that each shows."""
        targets = [x for x in self.tested.targets if kind_of(x.name) == SCENARIOS]
        groups = {
            test: f"{number_in(x.name)} {x.words}"
            for x in reversed(targets)
            for test in (*x.possible, *x.tested)
        }
        runs = {x.test: x.drive for x in self.view.facts if x.relation == "runs"}
        curves: dict[str, DriveCurves | None] = {}
        for entry in self.catalogue.entries:
            if isinstance(entry, ConcreteTest):
                curves[entry.id] = curves_of(entry)
            elif (drive := runs.get(entry.id)) is not None:
                curves[entry.id] = curves_of_drive(drive.file)
        wrong = self.tested.wrong
        fails = {x.entry.id: x.why.at for x in self.concrete if x.why is not None}
        pictures = [
            DrivePicture(test, groups.get(test, "no scenario"), x, wrong.get(test, ""), fails.get(test))
            for test, x in curves.items()
            if x is not None
        ]
        order = [*dict.fromkeys(f"{number_in(x.name)} {x.words}" for x in targets), "no scenario"]
        return sorted(pictures, key=lambda x: order.index(x.group))

    def files(self, pictures: bool) -> dict[str, bytes]:
        """Return tables for a spreadsheet, a report for CI, and with ``pictures`` those, by file name."""
        return report.tables(self.view) | drawn(self.pictures() if pictures else {})

    def to_csv(self) -> str:
        """Return a row for each test and a column for each target: x shown or implied, o by some drives."""
        return report.as_csv(self.tests, self.tested, self.view.in_force)

    def __str__(self) -> str:
        """Return the report as text."""
        drivers, view = report.driver_lines(self.decisions), self.view
        text = report.as_text(len(self.tests), self.tested, view.notes, view.figures, drivers)
        ranges = report.range_lines(view.spans, self.question.basis.horizon)
        return "\n".join([*ranges, text])

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
        """Write a drive for each target that no test shows into a folder, as tests with a ``catalogue.toml``.

        ``objective``: that of the search, as for ``witness``. ``spread``: the number of tests that each class
        is to have, or each scenario where there are no classes; further drives begin far from all its tests
        (``initial_values.distance``). ``formats``: other formats of ``export``, each copy with an entry;
        ``specs``: specification files that these need. Raises ``InputError``, ``UsageError``.
        """
        one_of("objective", objective, Objective)
        if spread < 1:
            raise UsageError(f"spread={spread}: write how many tests each class is to have, 1 or more")
        formulas = self.view.formulas
        basis = replace(self.question.basis, objective=objective)
        made = complete(basis, formulas, self.missing, self._prior_results(), spread, jobs, progress)
        words = {x.name: x.words for x in (*self.tested.all_targets, *self.tested.gaps.empty)}
        style = "" if objective == "smooth" else f", {objective}"
        titles = {
            x.name: words[x.target] + style + (", far from the others" if x.apart is not None else "")
            for x in made
        }
        return write_completions(Path(out), made, titles, formulas, formats, specs)

    def _prior_results(self) -> PriorResults:
        """The results for targets before the search for drives."""
        begins = {x.name: [y.begins for y in self.concrete if x.name in y.names] for x in self.tested.targets}
        copies = {x.entry.id for x in self.concrete if x.entry.copy_of in self.tests}
        tests = {x.name: len({*x.tested} - copies) for x in self.tested.targets}
        gaps = {name: x for name, x in (self.view.gap_answers or {}).items() if x is not None and x.gaps}
        return PriorResults(begins, tests, gaps)


@takes(settings.Catalogue)
def catalogue(
    *paths: str | Path, using: Definitions | None = None, **options: Unpack[CatalogueKeywords]
) -> CatalogueAnswer:
    """Return the scenarios and classes that the tests in folders and files show, and the missing ones.

    Targets are those of the first spec set of ``using``; further sets have figures only. ``classes``: whether
    scenarios are divided into classes (``classify``), which need whole rows of the table in ``among``;
    ``gaps``: whether each class of gaps (``coverage``) is to be tested too; ``explore``: also the range of
    initial values of each tested class, and the part that no test covers. ``roles``, ``lanes``, ``start``:
    "fixed" for those of a test, or "any". ``near``: the largest difference of the initial values of duplicate
    tests (m, m/s). ``strict``: a test has a fault where vehicles or parts of its files would be left out.
    ``preventable``, ``unpreventable``: as for ``witness``; gaps are then a question for ``coverage``.
    ``drivers``: the driver models that are put into tests, all where None. ``out``: a folder for evidence.
    Raises ``InputError``, ``TextError``, ``UsageError``.
    """
    given = settings.Catalogue.of(options)
    plain = definitions_of(using)
    definitions = restricted(plain, given, given.among)
    restricting = (x for x in (given.preventable, given.unpreventable) if x is not None)
    models = tuple(dict.fromkeys((*(MODELS if given.drivers is None else given.drivers), *restricting)))
    request = Request(
        tuple(map(str, paths)),
        definitions.sets,
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
    basis = basis_of(replace(definitions, sets=definitions.sets[:1]), given, given.vehicles)
    numbers = definitions.among(given.among) or numbers_of(definitions.specification)
    question = CatalogueQuestion(basis, CatalogueQuestionData(request=request.data, scenarios=tuple(numbers)))
    return CatalogueAnswer.decide(question, given)
