"""The view of the answers about a catalogue: tested and missing targets, remarks, figures, decisions."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import field
from functools import cached_property

from roadproof.extensions.catalogue import catalogue_data
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.driver_claims import confirmed_decision, driver_claim_name
from roadproof.extensions.catalogue.driver_sides import decisions_of, read_side_name
from roadproof.extensions.catalogue.entries import AbstractTest, CatalogueTests, ConcreteTest, Request
from roadproof.extensions.catalogue.fact import CatalogueFact, scenarios_shown
from roadproof.extensions.catalogue.figures import figures, figures_of_set
from roadproof.extensions.catalogue.nested import NestedQuestion
from roadproof.extensions.catalogue.ranges import InitialValueRange, ranges_of
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.catalogue.targets import Targets, find_targets, target_titles
from roadproof.extensions.drivers.restriction import restriction_of
from roadproof.extensions.surveys.coverage import schema as coverage
from roadproof.extensions.surveys.coverage.answers import ClassAnswer
from roadproof.extensions.surveys.coverage.data import claims_data, class_data
from roadproof.extensions.surveys.coverage.question import CoverageView
from roadproof.extensions.traffic.evaluate.decisions import Decision, Drivers, decide_formula
from roadproof.library.bind import values_with
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, EvidencePlace, heading_of
from roadproof.runtime.records import dataclass
from roadproof.world.not_read import left_out_in, road_not_read_note


@dataclass(frozen=True)
class CatalogueView:
    """The view of the answers about a catalogue.

    ``formula_sets`` and ``shown``: the formulas and the answers of concrete tests in each spec set.
    ``facts``: those about abstract tests and ranges. ``survey``: where gaps are required, the question about
    them with its view; ``gap_answers``: then the answer about each class of gaps, None for those that tests
    show. ``driven``: the answers about tests in which a driver model drives SV, by name.
    """

    basis: Basis
    request: Request
    catalogue: CatalogueTests
    formula_sets: tuple[TargetFormulas, ...]
    shown: tuple[tuple[ConcreteAnswer, ...], ...]
    facts: tuple[CatalogueFact, ...]
    drivers: Drivers | None
    driven: Answers = field(default_factory=dict)
    survey: tuple[NestedQuestion, CoverageView] | None = None
    gap_answers: Mapping[str, ClassAnswer | None] | None = None

    @property
    def formulas(self) -> TargetFormulas:
        """The formulas of the first spec set."""
        return self.formula_sets[0]

    @property
    def concrete(self) -> tuple[ConcreteAnswer, ...]:
        """The answers of concrete tests in the first spec set, in order."""
        return self.shown[0]

    @cached_property
    def tested(self) -> Targets:
        """The tested and missing targets, with remarks on tests."""
        abstract = [x for x in self.catalogue.entries if isinstance(x, AbstractTest)]
        return find_targets(
            self.formulas,
            self.concrete,
            abstract,
            self.facts,
            target_titles(self.formulas),
            self.request.near,
            self.gap_answers,
        )

    @cached_property
    def figures(self) -> tuple[catalogue_data.Figure, ...]:
        """The numbers of tested and of all targets, by spec set, kind and road sector."""
        set_name = self.basis.specification.set_name
        first = figures(set_name, self.tested.targets, self.tested.gaps)
        others = zip(self.formula_sets[1:], self.shown[1:], strict=True)
        return (
            *first,
            *(x for formulas, shown in others for x in figures_of_set(formulas, shown, self.facts)),
        )

    @cached_property
    def spans(self) -> tuple[InitialValueRange, ...]:
        """The tested and the reached range of each initial value of each class, with ``explore``."""
        if not self.request.explore:
            return ()
        covered = {x.name: x.covered for x in self.tested.targets}
        return tuple(ranges_of(self.basis.specification, covered, self.facts))

    @cached_property
    def decisions(self) -> tuple[tuple[str, Decision], ...]:
        """The decisions of each driver model in each test, with the id of the test, in order."""
        drivers = self.drivers
        if drivers is None:
            return ()
        concrete = {
            x.entry.id: [confirmed_decision(x.entry.id, y, self.driven) for y in x.decisions]
            for x in self.concrete
        }
        decisions: list[tuple[str, Decision]] = []
        for entry in self.catalogue.entries:
            of_test: Iterable[Decision] = concrete.get(entry.id, ())
            if isinstance(entry, AbstractTest):
                of_test = self._of_formula(entry, drivers)
            decisions += [(entry.id, x) for x in of_test]
        return tuple(decisions)

    def _decision_data(
        self, test: str, decision: Decision, place: EvidencePlace
    ) -> catalogue_data.DecisionData:
        """Return a decision as ``--json`` prints it, with its drive."""
        fields = {name: value for name, value in vars(decision).items() if name != "driven"}
        name = driver_claim_name(test, decision)
        drive = place(name, self.driven[name]) if name in self.driven else None
        return catalogue_data.DecisionData(test=test, drive=drive, **fields)

    def _of_formula(self, entry: AbstractTest, drivers: Drivers) -> Iterator[Decision]:
        """Yield the decisions on an abstract test by the drives found for it, each once."""
        facts = [x for x in self.facts if x.test == entry.id]
        drives = {repr(x.drive.file.drive): x.drive for x in facts if x.drive is not None}
        scenarios = scenarios_shown(facts)
        sides = [read_side_name(x.other) for x in facts if x.relation == "open"]
        open_sides = {(x[0], x[2]) for x in sides if x is not None}
        return decide_formula(decisions_of(drives.values(), scenarios, self.formulas, drivers), open_sides)

    @property
    def missing(self) -> tuple[str, ...]:
        """The targets that no test shows: scenarios, classes, and with ``gaps`` classes of gaps."""
        return tuple(x.name for x in self.tested.missing)

    @property
    def notes(self) -> tuple[str, ...]:
        """The notes on files that are no tests, contradictory samples, and drives made with other values."""
        made: dict[tuple[str, ...], list[str]] = {}
        for x in self.concrete:
            if x.made_with:
                made.setdefault(x.made_with, []).append(x.entry.id)
        others = (
            f"made with {', '.join(those)}, and judged with what is asked for: {', '.join(tests)}"
            for those, tests in made.items()
        )
        return (
            *self.catalogue.notes,
            *self._notes_on_tests(lambda note: True),
            *others,
            *self._unequal_notes(),
        )

    def _unequal_notes(self) -> Iterator[str]:
        """Yield a note where some tests are judged from more instants or lanes than others."""
        freedom = self.request.freedom
        if {x.dense for x in self.concrete if not x.fault} == {True, False} and not (
            freedom.lanes and freedom.start
        ):
            yield (
                "drive files are judged from their start in their lane, samples from every instant in "
                "every lane; --start any --lanes any judges both so"
            )

    @property
    def left_out(self) -> tuple[str, ...]:
        """The notes on vehicles and parts of files that were left out."""
        return self._notes_on_tests(lambda note: bool(left_out_in([note])))

    def _notes_on_tests(self, predicate: Callable[[str], bool]) -> tuple[str, ...]:
        """Return the notes on tests for which a predicate holds, each with the tests that have it."""
        tests: dict[str, list[str]] = {}
        every = [(x.entry.id, x.notes) for x in self.concrete]
        every += [
            (x.id, road_not_read_note(x.road)) for x in self.catalogue.entries if isinstance(x, AbstractTest)
        ]
        for own_id, notes in every:
            for note in filter(predicate, notes):
                tests.setdefault(note, []).append(own_id)
        return tuple(f"{', '.join(names)}: {note}" for note, names in tests.items())

    @property
    def in_force(self) -> tuple[str, ...]:
        """The settings that differ from the defaults: spec set, readings, parameters, a driver model."""
        basis = self.basis
        home = basis.specification
        driver = restriction_of(home.options)
        settings = [] if home.set_name == "base" else [f"set {home.set_name}"]
        known = {} if driver is None else driver.options
        readings = {k: v for k, v in home.options.items() if k not in known}
        settings += [f"{k} = {v}" for k, v in readings.items() if v != home.library.options[k].values[0]]
        declared = values_with(home.library, {})
        settings += [f"{k} = {v} (SI)" for k, v in basis.values.items() if v != declared[k]]
        return (*settings, *(() if driver is None else (str(driver),)))

    def data(self, place: EvidencePlace, seconds: float) -> catalogue_data.CatalogueData:
        """Return the view as ``--json`` prints it."""
        targets = self.tested
        return catalogue_data.CatalogueData(
            **heading_of(catalogue_data.SCHEMA, self.basis),
            set=self.basis.specification.set_name,
            **self.basis.common_data(),
            scenarios=self.formulas.numbers,
            request=self.request.data,
            tests=tuple(map(self._test, self.catalogue.entries)),
            targets=targets.targets,
            gaps=self._gaps(place),
            not_tested=self.missing,
            figures=self.figures,
            decisions=tuple(self._decision_data(test, x, place) for test, x in self.decisions),
            ranges=tuple(map(range_data, self.spans)),
            facts=tuple(fact_data(x, place) for x in self.facts),
            faults=targets.faults,
            doubts=targets.doubts,
            alike=targets.alike,
            contradictions=targets.contradictions,
            notes=self.notes,
            left_out=self.left_out,
            seconds=round(seconds, 1),
        )

    def _gaps(self, place: EvidencePlace) -> catalogue_data.GapsData:
        """Return the classes of gaps as data: those that tests show, or all with their evidence."""
        gaps, claims, classes = (
            self.tested.gaps,
            list[coverage.CoverageClaimData](),
            list[coverage.GapClassDetail](),
        )
        if self.survey is not None:
            nested, view = self.survey
            there = nested.place(place)
            claims += claims_data(view, there)
            classes += (class_data(x, there) for x in view.survey.classes)
        return catalogue_data.GapsData(
            asked=gaps.required,
            classes_in_all=gaps.total,
            targets=gaps.targets,
            empty=tuple(x.name for x in gaps.empty),
            open=gaps.open,
            claims=tuple(claims),
            classes=tuple(classes),
        )

    def _test(
        self, entry: ConcreteTest | AbstractTest
    ) -> catalogue_data.ConcreteTestData | catalogue_data.AbstractTestData:
        if isinstance(entry, AbstractTest):
            return catalogue_data.AbstractTestData(
                id=entry.id, title=entry.title, formula=entry.query.text, claims=tuple(entry.claims)
            )
        answer = next(x for x in self.concrete if x.entry == entry)
        return catalogue_data.ConcreteTestData(
            id=entry.id,
            title=entry.title,
            file=entry.place,
            sha256=answer.sha256,
            copy_of=entry.copy_of,
            roles=dict(answer.roles),
            claims=tuple(answer.claims),
            dense=answer.dense,
            shown=tuple(answer.shown),
            begins=dict(answer.begins),
            fault=answer.fault,
            why=answer.why,
        )


def range_data(values: InitialValueRange) -> catalogue_data.RangeData:
    """Return a range as ``--json`` prints it."""
    fields = {name: x for name, x in vars(values).items() if name != "unit"}
    return catalogue_data.RangeData(**fields, untested=values.untested, share=round(values.share, 4))


def fact_data(fact: CatalogueFact, place: EvidencePlace) -> catalogue_data.FactData:
    """Return a fact as ``--json`` prints it."""
    file = None if fact.answer is None else place(fact.name, fact.answer)
    return catalogue_data.FactData(
        test=fact.test,
        other=fact.other,
        relation=fact.relation,
        premise=fact.premise.text,
        conclusion=None if fact.conclusion is None else fact.conclusion.text,
        formula=fact.query.text,
        verdict=fact.verdict,
        reason=fact.reason,
        certificate=file if fact.certificate is not None else None,
        drive=file if fact.drive is not None else None,
        also=fact.also,
        term=fact.term,
        sense=fact.sense,
        at=None if fact.at is None else str(fact.at),
    )
