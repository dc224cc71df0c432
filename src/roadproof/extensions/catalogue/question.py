"""The question what a catalogue of tests shows, means and misses."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Annotated, Any, ClassVar

from roadproof.errors import InputError, RoadproofError, UsageError
from roadproof.evidence.answer import Answer, Judged
from roadproof.evidence.answers import shared
from roadproof.evidence.codec import Doc, Rule, read
from roadproof.evidence.finding import Finding
from roadproof.evidence.subject import OTHER, DriverSide, Subject, SubjectKind, subject_of_fact
from roadproof.extensions.catalogue.abstract import PairBatch, TestBatch, stem_of
from roadproof.extensions.catalogue.asked import Questions
from roadproof.extensions.catalogue.concrete import ConcreteBatch
from roadproof.extensions.catalogue.driven import DrivenBatch, driven_batches
from roadproof.extensions.catalogue.driver_sides import has_sides
from roadproof.extensions.catalogue.entries import Abstract, Catalogue, Concrete, Request
from roadproof.extensions.catalogue.fact import Fact, scenarios_shown
from roadproof.extensions.catalogue.gaps import PREFIX, GapKinds, gap_kinds
from roadproof.extensions.catalogue.kept import KeptRequest
from roadproof.extensions.catalogue.nested import Nested
from roadproof.extensions.catalogue.ranges import Reach, ReachBatch, reaches_of
from roadproof.extensions.catalogue.reading import read_tests
from roadproof.extensions.catalogue.showing import ConcreteAnswer
from roadproof.extensions.catalogue.sides import SidesBatch
from roadproof.extensions.catalogue.tested import CLASSES, SCENARIOS, kind_of, targets_of, tested
from roadproof.extensions.catalogue.view import CatalogueView
from roadproof.extensions.drivers.restriction import restriction_of, unrestricted
from roadproof.extensions.surveys.classify.classes import Classes, plan_of
from roadproof.extensions.surveys.classify.division import divide
from roadproof.extensions.traffic.evaluate.decisions import Drivers, drivers_in
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, Batch, Place, seen, walk
from roadproof.reasons import Reason
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass

TESTS_IN_A_BATCH = 20
GAPS = "gaps-"
"""How names of claims about gaps begin."""


@dataclass(frozen=True, kw_only=True)
class AskedTests:
    """The tests, and the scenarios that they are asked about."""

    request: KeptRequest
    scenarios: Annotated[tuple[shared.Number, ...], Rule(least=1), Doc("Numbers of the scenarios.")]


@dataclass(frozen=True)
class CatalogueQuestion:
    """The question what tests show and mean. Its tests are read when they are asked for first."""

    kind: ClassVar[str] = "catalogue"
    basis: Basis
    asked: AskedTests

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, self.basis.proof, explain=True)

    @classmethod
    def of(cls, basis: Basis, asked: object, where: str) -> "CatalogueQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        question = cls(basis, read(AskedTests, asked, where))
        try:
            _ = question.request, question.tests
        except UsageError as error:
            raise InputError(f"{where}: {error}") from None
        return question

    @cached_property
    def request(self) -> Request:
        """What is asked of the tests. Raises ``UsageError``."""
        return Request(**vars(self.asked.request))

    @cached_property
    def tests(self) -> Catalogue:
        """The tests. Raises ``InputError``, ``TextError``."""
        home = self.basis.specification
        return read_tests(self.request, unrestricted(home), home)

    @cached_property
    def concrete(self) -> tuple[Concrete, ...]:
        """The tests whose vehicles move as they say."""
        return tuple(x for x in self.tests.entries if isinstance(x, Concrete))

    @cached_property
    def abstract(self) -> tuple[Abstract, ...]:
        """The tests that are formulas."""
        return tuple(x for x in self.tests.entries if isinstance(x, Abstract))

    @cached_property
    def drivers(self) -> Drivers | None:
        """The driver models that are asked what becomes of tests."""
        return drivers_in(self.basis.specification, self.basis.all_values(), self.request.drivers)

    @property
    def is_restricted(self) -> bool:
        """Whether a driver model says how scenarios begin."""
        return restriction_of(self.basis.specification.options) is not None

    @cached_property
    def questions(self) -> tuple[Questions, ...]:
        """What tests are asked, in each spec set. Raises ``UsageError`` where classes are in doubt."""
        return tuple(map(self._questions_in, self.request.sets))

    def _questions_in(self, set_name: str) -> Questions:
        here = replace(self.basis, specification=self.basis.specification.in_set(set_name), sets=())
        classes = _divided(here, self.asked.scenarios) if self.request.classes else None
        return Questions(here.specification, self.asked.scenarios, classes, here.all_values())

    @cached_property
    def kinds(self) -> GapKinds | None:
        """The classes of gaps, where each is to be tested. Raises ``UsageError``."""
        return gap_kinds(self.basis, self.asked.scenarios) if self.request.gaps else None

    # --- claims ---------------------------------------------------------------------------------------

    def batches(self, known: Answers) -> list[Batch]:
        """Batches of concrete tests, and one for each other test; later ones for what follows from these."""
        first: list[Batch] = [*self._concrete_batches, *self._test_batches]
        left = [x for x in first if [*walk(x, lambda name, _: known.get(name))]]
        return first if left else [*first, *self._later(known)]

    @cached_property
    def _concrete_batches(self) -> tuple[ConcreteBatch, ...]:
        return tuple(x for k in range(len(self.questions)) for x in self._in_set(k))

    def _in_set(self, place: int) -> list[ConcreteBatch]:
        """The batches of concrete tests in a spec set."""
        drivers = self.drivers if place == 0 or self.is_restricted else None
        chunks = range(0, len(self.concrete), TESTS_IN_A_BATCH)
        return [
            ConcreteBatch(
                self.questions[place], self.request.freedom, drivers, self.concrete[k : k + TESTS_IN_A_BATCH]
            )
            for k in chunks
        ]

    @cached_property
    def _test_batches(self) -> tuple[TestBatch, ...]:
        asked, *beside = self.questions if self.abstract else (None,)
        if asked is None:
            return ()
        return tuple(TestBatch(self.basis, asked, x, tuple(y for y in beside if y)) for x in self.abstract)

    def _later(self, known: Answers) -> Iterator[Batch]:
        """Yield what is asked when all is known of each test by itself."""
        yield from self._driven(known)
        yield from self._pairs_and_sides(known)
        yield from self._reaches(known)
        gaps = self._gaps(known)
        yield from () if gaps is None else gaps.batches(known)

    def _driven(self, known: Answers) -> Iterator[DrivenBatch]:
        """Yield what is asked of concrete tests in which driver models drive SV."""
        if self.drivers is not None and not self.is_restricted:
            yield from driven_batches(self.basis, self.drivers, self.shown(0, known))

    def _gaps(self, known: Answers) -> Nested | None:
        """Return the question about the classes of gaps that no concrete test shows, where they are asked."""
        if self.kinds is None:
            return None
        shown = {name for x in self.shown(0, known) for name in x.names if name.startswith(PREFIX)}
        return Nested(GAPS, self.kinds.question(shown))

    def _pairs_and_sides(self, known: Answers) -> "Iterator[PairBatch | SidesBatch]":
        facts = {x.entry.id: seen(x.facts(), known) for x in self._test_batches}
        for one in self.abstract:
            drive = next((x.drive for x in facts[one.id] if x.relation == "runs"), None)
            for other in self.abstract:
                fits = one is not other and {*other.query.vehicles} <= {*one.query.vehicles}
                if fits and drive is not None:
                    yield PairBatch(self.basis, self.questions[0], one, other, drive)
        drivers = None if self.is_restricted else self.drivers
        for entry in self.abstract:
            drives = tuple(x.drive for x in facts[entry.id] if x.drive is not None)
            for scenario in scenarios_shown(facts[entry.id]):
                if drivers is not None and has_sides(drivers, scenario):
                    yield SidesBatch(self.basis, self.questions[0], drivers, entry, scenario, drives)

    def _reaches(self, known: Answers) -> Iterator[ReachBatch]:
        """Yield how far drives can go of what concrete tests show: classes, or scenarios without them."""
        if not self.request.explore:
            return
        asked, answers = self.questions[0], self.shown(0, known)
        found = tested(asked, answers, (), (), targets_of(asked), 0.0, None).targets
        kind = SCENARIOS if asked.classes is None else CLASSES
        covered = {x.name: x.covered for x in found if kind_of(x.name) == kind}
        reaches: Iterator[Reach] = reaches_of(asked, covered, answers)
        yield from (ReachBatch(self.basis, x) for x in reaches)

    # --- what answers show ----------------------------------------------------------------------------

    def shown(self, place: int, known: Answers) -> tuple[ConcreteAnswer, ...]:
        """Return what concrete tests show in a spec set, in order; those that are not judged are left out."""
        found: dict[str, ConcreteAnswer] = {}
        for batch in self._in_set(place):
            found |= batch.answers(known)
        return tuple(found[x.id] for x in self.concrete if x.id in found)

    def facts(self, known: Answers) -> tuple[Fact, ...]:
        """Return what is known of tests that are formulas, and of ranges."""
        alone = [x for batch in self._test_batches for x in seen(batch.facts(), known)]
        later = [x for batch in self._reaches(known) for x in seen(batch.facts(), known)]
        later += [x for batch in self._pairs_and_sides(known) for x in seen(batch.facts(), known)]
        return (*alone, *later)

    def label(self, name: str) -> str:
        """Return which test, target or class of gaps the claim of a name is about."""
        if self.kinds is not None and (gaps := Nested(GAPS, self.kinds.question(()))).has(name):
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
            begin = f"driven-{stem_of(test)}-"
            if name.startswith(begin):
                scenario, driver, _ = name.removeprefix(begin).split("-")
                return test, scenario, driver
        return None

    @cached_property
    def _judged(self) -> dict[str, str]:
        """The ids of concrete tests by the names of claims about them."""
        return {x.named(entry): entry.id for x in self._concrete_batches for entry in x.entries}

    def subject(self, name: str) -> Subject:
        """Return the test that the claim of a name is about."""
        if name in self._judged:
            return Subject(SubjectKind.TEST, self._judged[name])
        if (driven := self._driven_test(name)) is not None:
            return Subject(SubjectKind.DRIVEN, f"{driven[0]}: {driven[2]}")
        fact = self._fact(name)
        return OTHER if fact is None else subject_of_fact(*fact[:2])

    def tell(self, name: str, answer: Answer, found: Finding) -> Finding:
        """Return what was found of a test, with what it shows and what becomes of it under driver models."""
        if self.kinds is not None and (gaps := Nested(GAPS, self.kinds.question(()))).has(name):
            return gaps.tell(name, answer, found)
        test = answer.evidence.shows if isinstance(answer.evidence, Judged) else None
        if not isinstance(test, ConcreteAnswer):
            return self._told(name, answer, found)
        shown = ", ".join(dict.fromkeys(x.what for x in test.shown)) or "no scenario"
        how = (
            "read again" if test.fault else "judged again in dense time" if test.dense else "monitored again"
        )
        sides = (DriverSide(driver=x.driver, scenario=x.scenario, side=x.side) for x in test.decisions)
        return replace(
            found,
            verdict="JUDGED",
            label=f"test {test.entry.id}",
            claim=f"cannot be read: {test.fault}" if test.fault else f"shows {shown}",
            checked=("read again" if test.fault else how, "its file is unchanged"),
            shows="unreadable" if test.fault else "scenarios" if test.shown else "nothing",
            drivers=tuple(sides),
        )

    def _fact(self, name: str) -> tuple[str, str, str] | None:
        """Return what the claim of a name says: that a test stands in a relation to another name."""
        ids = {x.name: x.entry.id for x in self._test_batches}
        stem = next((x for x in ids if name.startswith(f"{x}-")), None)
        if stem is None:
            return None
        relation, _, other = name.removeprefix(f"{stem}-").partition("-")
        if relation in ("runs", "shows", "implies"):
            return ids[stem], relation, ids.get(other, other.replace("-in-", "@"))
        side, _, model = other.partition("-")
        return ids[stem], "shows", f"{relation} {side} ({model})"

    def _told(self, name: str, answer: Answer, found: Finding) -> Finding:
        """Return what was found of a test that is a formula, in the relation that is shown."""
        fact = self._fact(name)
        if fact is None:
            return found
        test, relation, other = fact
        if answer.certificate is not None:
            relation = {"runs": "empty", "shows": "excludes"}.get(relation, relation)
        return replace(found, label=f"{test} {relation} {other}".strip())

    def doubts(self, known: Answers) -> list[tuple[str, Reason]]:
        """Return the facts of tests that no claim was asked for, and the classes of gaps in doubt."""
        facts = (x for x in self.facts(known) if x.test and x.relation == "open" and x.answer is None)
        gaps = self._gaps(known)
        found = [(f"{x.test} open {x.other}", x.reason) for x in facts]
        return [*found, *(() if gaps is None else gaps.doubts(known))]

    def view(self, known: Answers) -> CatalogueView:
        """Return what tests show, mean and miss."""
        made = CatalogueView(
            self.basis,
            self.request,
            self.tests,
            self.questions,
            tuple(self.shown(k, known) for k in range(len(self.questions))),
            self.facts(known),
            self.drivers,
            {name: x for name, x in known.items() if name.startswith("driven-")},
        )
        gaps = self._gaps(known)
        if gaps is None or self.kinds is None:
            return made
        view = gaps.question.view(gaps.own(known))
        return replace(made, survey=(gaps, view), gap_answers=self.kinds.answers(view.survey))

    def data(self, view: CatalogueView, place: Place, seconds: float) -> Any:
        """Return the view as ``--json`` prints it."""
        return view.data(place, seconds)


def _divided(basis: Basis, numbers: Sequence[int]) -> Classes:
    """Return the classes of scenarios. Raises ``UsageError`` where it is in doubt which there are."""
    try:
        plan = plan_of(basis.specification, numbers)
    except RoadproofError as error:
        raise UsageError(f"{error}; or leave out classes with --no-classes") from None
    division = divide(basis, plan, None, None, in_few_words=False)
    if division.cut_off:
        told = "; ".join(x.reason for x in division.doubts)
        raise UsageError(f"the classes are in doubt ({told}): give more work, or use --no-classes")
    return division.classes
