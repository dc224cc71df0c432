"""The question about a catalogue of tests: which targets they show, and which no test shows."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from typing import Annotated, Any, ClassVar

from roadproof.errors import InputError, UsageError
from roadproof.evidence.answer import ClaimAnswer, JudgedTrace
from roadproof.evidence.answers import shared
from roadproof.evidence.codec import Doc, Rule, read
from roadproof.evidence.finding import Finding
from roadproof.evidence.subject import OTHER, DriverSide, Subject, SubjectKind
from roadproof.extensions.catalogue.abstract_claims import ImplicationBatch, TestBatch, claim_stem
from roadproof.extensions.catalogue.catalogue_data import RequestData
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.concrete_claims import ConcreteBatch
from roadproof.extensions.catalogue.driver_claims import DriverBatch, driver_batches
from roadproof.extensions.catalogue.driver_sides import has_sides
from roadproof.extensions.catalogue.entries import AbstractTest, CatalogueTests, ConcreteTest, Request
from roadproof.extensions.catalogue.fact import CatalogueFact, scenarios_shown, subject_of_fact
from roadproof.extensions.catalogue.figures import CLASSES, SCENARIOS, kind_of
from roadproof.extensions.catalogue.gaps import PREFIX, NamedGapClasses, named_gap_classes
from roadproof.extensions.catalogue.nested import NestedQuestion
from roadproof.extensions.catalogue.ranges import Reach, ReachBatch, reaches_of
from roadproof.extensions.catalogue.reading import read_tests
from roadproof.extensions.catalogue.side_claims import SideBatch
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.catalogue.targets import find_targets, target_titles
from roadproof.extensions.catalogue.view import CatalogueView
from roadproof.extensions.drivers.restriction import restriction_of, unrestricted
from roadproof.extensions.surveys.classify.division import divide_surely
from roadproof.extensions.surveys.survey import replay_steps
from roadproof.extensions.traffic.evaluate.decisions import Drivers, driver_models
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, EvidencePlace, QuestionBatch, walk_batch
from roadproof.reasons import Reason
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass

TESTS_IN_A_BATCH = 20
GAPS = "gaps-"
"""The prefix of names of claims about gaps."""


@dataclass(frozen=True, kw_only=True)
class CatalogueQuestionData:
    """The question about a catalogue as data: the request, and the scenarios."""

    request: RequestData
    scenarios: Annotated[tuple[shared.Number, ...], Rule(least=1), Doc("Numbers of the scenarios.")]


@dataclass(frozen=True)
class CatalogueQuestion:
    """The question which targets tests show. Its tests are read at the first use."""

    kind: ClassVar[str] = "catalogue"
    basis: Basis
    settings: CatalogueQuestionData

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, self.basis.proof, explain=True)

    @classmethod
    def of(cls, basis: Basis, data: object, where: str) -> "CatalogueQuestion":
        """Return the question of plain data. Raises ``InputError``."""
        question = cls(basis, read(CatalogueQuestionData, data, where))
        try:
            _ = question.request, question.tests
        except UsageError as error:
            raise InputError(f"{where}: {error}") from None
        return question

    @cached_property
    def request(self) -> Request:
        """The request for the tests. Raises ``UsageError``."""
        return Request(**vars(self.settings.request))

    @cached_property
    def tests(self) -> CatalogueTests:
        """The tests. Raises ``InputError``, ``TextError``."""
        home = self.basis.specification
        return read_tests(self.request, unrestricted(home), home)

    @cached_property
    def concrete(self) -> tuple[ConcreteTest, ...]:
        """The tests that are drives or samples."""
        return tuple(x for x in self.tests.entries if isinstance(x, ConcreteTest))

    @cached_property
    def abstract(self) -> tuple[AbstractTest, ...]:
        """The tests that are formulas."""
        return tuple(x for x in self.tests.entries if isinstance(x, AbstractTest))

    @cached_property
    def drivers(self) -> Drivers | None:
        """The driver models that are put into tests."""
        return driver_models(self.basis.specification, self.basis.all_values(), self.request.drivers)

    @property
    def is_restricted(self) -> bool:
        """Return whether a driver model restricts how scenarios begin."""
        return restriction_of(self.basis.specification.options) is not None

    @cached_property
    def formula_sets(self) -> tuple[TargetFormulas, ...]:
        """The formulas of targets in each spec set. Raises ``UsageError`` where classes are in doubt."""
        _ = self.gap_classes  # an error of these comes at once; classes may take a minute
        return tuple(map(self._formulas_of, self.request.sets))

    def _formulas_of(self, set_name: str) -> TargetFormulas:
        here = replace(self.basis, specification=self.basis.specification.in_set(set_name), sets=())
        classes = divide_surely(here, self.settings.scenarios) if self.request.classes else None
        return TargetFormulas(here.specification, self.settings.scenarios, classes, here.all_values())

    @cached_property
    def gap_classes(self) -> NamedGapClasses | None:
        """The classes of gaps, where each is required. Raises ``UsageError``."""
        return named_gap_classes(self.basis, self.settings.scenarios) if self.request.gaps else None

    # --- claims ---------------------------------------------------------------------------------------

    def batches(self, known: Answers) -> list[QuestionBatch]:
        """Return the batches of all tests; once these are answered, also the batches that depend on them."""
        first: list[QuestionBatch] = [*self._concrete_batches, *self._test_batches]
        left = [x for x in first if [*walk_batch(x, lambda name, _: known.get(name))]]
        return first if left else [*first, *self._later(known)]

    @cached_property
    def _concrete_batches(self) -> tuple[ConcreteBatch, ...]:
        return tuple(x for k in range(len(self.formula_sets)) for x in self._in_set(k))

    def _in_set(self, place: int) -> list[ConcreteBatch]:
        """The batches of concrete tests in a spec set."""
        drivers = self.drivers if place == 0 or self.is_restricted else None
        chunks = range(0, len(self.concrete), TESTS_IN_A_BATCH)
        return [
            ConcreteBatch(
                self.formula_sets[place],
                self.request.freedom,
                drivers,
                self.concrete[k : k + TESTS_IN_A_BATCH],
            )
            for k in chunks
        ]

    @cached_property
    def _test_batches(self) -> tuple[TestBatch, ...]:
        if not self.abstract:
            return ()
        first, *beside = self.formula_sets
        return tuple(TestBatch(self.basis, first, x, tuple(beside)) for x in self.abstract)

    def _later(self, known: Answers) -> Iterator[QuestionBatch]:
        """Yield the batches that depend on the answers about each test alone."""
        yield from self._driven(known)
        yield from self._pairs_and_sides(known)
        yield from self._reaches(known)
        gaps = self._gaps(known)
        yield from () if gaps is None else gaps.batches(known)

    def _driven(self, known: Answers) -> Iterator[DriverBatch]:
        """Yield the batches about concrete tests in which driver models drive SV."""
        if self.drivers is not None and not self.is_restricted:
            yield from driver_batches(self.basis, self.drivers, self.shown(0, known))

    def _gaps(self, known: Answers) -> NestedQuestion | None:
        """Return the question about classes of gaps that no concrete test shows, if gaps are required."""
        if self.gap_classes is None:
            return None
        shown = {name for x in self.shown(0, known) for name in x.names if name.startswith(PREFIX)}
        return NestedQuestion(GAPS, self.gap_classes.question(shown))

    def _pairs_and_sides(self, known: Answers) -> Iterator[ImplicationBatch | SideBatch]:
        """Yield the batches about pairs of abstract tests, and about sides of driver models."""
        facts = {x.entry.id: replay_steps(x.facts(), known) for x in self._test_batches}
        for one in self.abstract:
            drive = next((x.drive for x in facts[one.id] if x.relation == "runs"), None)
            for other in self.abstract:
                fits = one is not other and {*other.query.vehicles} <= {*one.query.vehicles}
                if fits and drive is not None:
                    yield ImplicationBatch(self.basis, self.formula_sets[0], one, other, drive)
        drivers = None if self.is_restricted else self.drivers
        for entry in self.abstract:
            drives = tuple(x.drive for x in facts[entry.id] if x.drive is not None)
            for scenario in scenarios_shown(facts[entry.id]):
                if drivers is not None and has_sides(drivers, scenario):
                    yield SideBatch(self.basis, self.formula_sets[0], drivers, entry, scenario, drives)

    def _reaches(self, known: Answers) -> Iterator[ReachBatch]:
        """Yield the batches about ranges of tested classes, or of tested scenarios without classes."""
        if not self.request.explore:
            return
        formulas, answers = self.formula_sets[0], self.shown(0, known)
        targets = find_targets(formulas, answers, (), (), target_titles(formulas), 0.0, None).targets
        kind = SCENARIOS if formulas.classes is None else CLASSES
        covered = {x.name: x.covered for x in targets if kind_of(x.name) == kind}
        reaches: Iterator[Reach] = reaches_of(formulas, covered, answers)
        yield from (ReachBatch(self.basis, x) for x in reaches)

    # --- answers --------------------------------------------------------------------------------------

    def shown(self, place: int, known: Answers) -> tuple[ConcreteAnswer, ...]:
        """Return the known answers about concrete tests in a spec set, in order."""
        answers: dict[str, ConcreteAnswer] = {}
        for batch in self._in_set(place):
            answers |= batch.answers(known)
        return tuple(answers[x.id] for x in self.concrete if x.id in answers)

    def facts(self, known: Answers) -> tuple[CatalogueFact, ...]:
        """Return the facts about tests that are formulas, and about ranges."""
        alone = [x for batch in self._test_batches for x in replay_steps(batch.facts(), known)]
        later = [x for batch in self._reaches(known) for x in replay_steps(batch.facts(), known)]
        later += [x for batch in self._pairs_and_sides(known) for x in replay_steps(batch.facts(), known)]
        return (*alone, *later)

    def label(self, name: str) -> str:
        """Return the label of a claim: the test, target or class of gaps that it is about."""
        if self.gap_classes is not None and (gaps := NestedQuestion(GAPS, self.gap_classes.question(()))).has(
            name
        ):
            return gaps.label(name)
        if (fact := self._fact(name)) is not None:
            test, relation, other = fact
            return f"{test} {relation if relation == 'implies' else 'open'} {other}".strip()
        if name in self._judged:
            return f"test {self._judged[name]}"
        if (driven := self._driven_test(name)) is not None:
            test, scenario, driver = driven
            return f"test {test}, {scenario} with {driver} in place of SV"
        return name

    def _driven_test(self, name: str) -> tuple[str, str, str] | None:
        """Return test, scenario and driver model of a claim about a drive of the model; None of another."""
        for test in self._judged.values():
            begin = f"driven-{claim_stem(test)}-"
            if name.startswith(begin):
                scenario, driver, _ = name.removeprefix(begin).split("-")
                return test, scenario, driver
        return None

    @cached_property
    def _judged(self) -> dict[str, str]:
        """The ids of concrete tests by the names of claims about them."""
        return {x.claim_name(entry): entry.id for x in self._concrete_batches for entry in x.entries}

    def subject(self, name: str) -> Subject:
        """Return the test that the claim of a name is about."""
        if name in self._judged:
            return Subject(SubjectKind.TEST, self._judged[name])
        if (driven := self._driven_test(name)) is not None:
            return Subject(SubjectKind.DRIVEN, f"{driven[0]}: {driven[2]}")
        fact = self._fact(name)
        return OTHER if fact is None else subject_of_fact(*fact[:2])

    def annotate(self, name: str, answer: ClaimAnswer, finding: Finding) -> Finding:
        """Return the finding about an answer, with the targets of a test and the sides of driver models."""
        if self.gap_classes is not None and (gaps := NestedQuestion(GAPS, self.gap_classes.question(()))).has(
            name
        ):
            return gaps.annotate(name, answer, finding)
        test = answer.evidence.shows if isinstance(answer.evidence, JudgedTrace) else None
        if not isinstance(test, ConcreteAnswer):
            return self._finding_of_fact(name, answer, finding)
        shown = ", ".join(dict.fromkeys(x.what for x in test.shown)) or "no scenario"
        how = (
            "read again" if test.fault else "judged again in dense time" if test.dense else "monitored again"
        )
        sides = (
            DriverSide(
                driver=x.driver,
                scenario=x.scenario,
                side=x.side,
                gap=x.gap,
                instant=x.instant,
                speed=x.speed,
            )
            for x in test.decisions
        )
        return replace(
            finding,
            verdict="JUDGED",
            label=f"test {test.entry.id}",
            claim=f"cannot be read: {test.fault}" if test.fault else f"shows {shown}",
            checked=("read again" if test.fault else how, "its file is unchanged"),
            shows="unreadable" if test.fault else "scenarios" if test.shown else "nothing",
            drivers=tuple(sides),
        )

    def _fact(self, name: str) -> tuple[str, str, str] | None:
        """Return test, relation and other name of a claim about an abstract test; None of another claim."""
        ids = {x.name: x.entry.id for x in self._test_batches}
        stem = next((x for x in ids if name.startswith(f"{x}-")), None)
        if stem is None:
            return None
        relation, _, other = name.removeprefix(f"{stem}-").partition("-")
        if relation in ("runs", "shows", "implies"):
            return ids[stem], relation, ids.get(other, other.replace("-in-", "@"))
        side, _, model = other.partition("-")
        return ids[stem], "shows", f"{relation} {side} ({model})"

    def _finding_of_fact(self, name: str, answer: ClaimAnswer, finding: Finding) -> Finding:
        """Return the finding about a test that is a formula, labelled with the relation that is shown."""
        fact = self._fact(name)
        if fact is None:
            return finding
        test, relation, other = fact
        if answer.certificate is not None:
            relation = {"runs": "empty", "shows": "excludes"}.get(relation, relation)
        return replace(finding, label=f"{test} {relation} {other}".strip())

    def unknowns(self, known: Answers) -> list[tuple[str, Reason]]:
        """Return the open facts about tests without a claim, and the open classes of gaps."""
        facts = (x for x in self.facts(known) if x.test and x.relation == "open" and x.answer is None)
        gaps = self._gaps(known)
        open_facts = [(f"{x.test} open {x.other}", x.reason) for x in facts]
        return [*open_facts, *(() if gaps is None else gaps.unknowns(known))]

    def view(self, known: Answers) -> CatalogueView:
        """Return the view of the known answers."""
        view = CatalogueView(
            self.basis,
            self.request,
            self.tests,
            self.formula_sets,
            tuple(self.shown(k, known) for k in range(len(self.formula_sets))),
            self.facts(known),
            self.drivers,
            {name: x for name, x in known.items() if name.startswith("driven-")},
        )
        gaps = self._gaps(known)
        if gaps is None or self.gap_classes is None:
            return view
        coverage = gaps.question.view(gaps.own(known))
        gap_answers = self.gap_classes.answers(coverage.survey)
        return replace(view, survey=(gaps, coverage), gap_answers=gap_answers)

    def data(self, view: CatalogueView, place: EvidencePlace, seconds: float) -> Any:
        """Return the view as ``--json`` prints it."""
        return view.data(place, seconds)
