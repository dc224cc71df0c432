"""All that is known of a catalogue: what its tests show, imply and miss."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import field
from functools import cached_property
from typing import Any

from roadproof.extensions.catalogue import kept
from roadproof.extensions.catalogue.asked import Questions
from roadproof.extensions.catalogue.driven import borne_out, driven_name
from roadproof.extensions.catalogue.driver_sides import decisions_of, read_side_name
from roadproof.extensions.catalogue.entries import Abstract, Catalogue, Concrete, Request
from roadproof.extensions.catalogue.fact import Fact, scenarios_shown
from roadproof.extensions.catalogue.kept import Figure
from roadproof.extensions.catalogue.nested import Nested
from roadproof.extensions.catalogue.ranges import Span, spans_of
from roadproof.extensions.catalogue.showing import ConcreteAnswer
from roadproof.extensions.catalogue.tested import Targets, figures, figures_beside, targets_of, tested
from roadproof.extensions.drivers.restriction import restriction_of
from roadproof.extensions.surveys.coverage import kept as coverage
from roadproof.extensions.surveys.coverage.answers import ClassAnswer
from roadproof.extensions.surveys.coverage.data import claims_data, class_data
from roadproof.extensions.surveys.coverage.question import CoverageView
from roadproof.extensions.traffic.evaluate.decisions import Decision, Drivers, decide_formula
from roadproof.library.bind import values_with
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, Place, heading_of
from roadproof.runtime.records import dataclass
from roadproof.world.unread import left_out_in, unread_of_road


@dataclass(frozen=True)
class CatalogueView:
    """What tests show and mean.

    ``shown``: what concrete tests show, in each spec set; ``facts``: what is known of the others;
    ``survey``: where it was asked, what is known of gaps, with the question inside this one, and
    ``gap_answers``: of each class of gaps, None of those that tests show. ``driven``: the answers about tests
    in which a driver model drives SV, by name.
    """

    basis: Basis
    request: Request
    catalogue: Catalogue
    questions: tuple[Questions, ...]
    shown: tuple[tuple[ConcreteAnswer, ...], ...]
    facts: tuple[Fact, ...]
    drivers: Drivers | None
    driven: Answers = field(default_factory=dict)
    survey: tuple[Nested, CoverageView] | None = None
    gap_answers: Mapping[str, ClassAnswer | None] | None = None

    @property
    def asked(self) -> Questions:
        """What tests are asked in the first spec set."""
        return self.questions[0]

    @property
    def concrete(self) -> tuple[ConcreteAnswer, ...]:
        """What concrete tests show in the first spec set, in order."""
        return self.shown[0]

    @cached_property
    def tested(self) -> Targets:
        """What is tested, what is missing, and what is to be said of tests."""
        abstract = [x for x in self.catalogue.entries if isinstance(x, Abstract)]
        words, near = targets_of(self.asked), self.request.near
        return tested(self.asked, self.concrete, abstract, self.facts, words, near, self.gap_answers)

    @cached_property
    def figures(self) -> tuple[Figure, ...]:
        """How much is tested: by spec set, kind and road sector."""
        set_name = self.basis.specification.set_name
        found = figures(set_name, self.tested.targets, self.tested.gaps)
        pairs = zip(self.questions[1:], self.shown[1:], strict=True)
        return (*found, *(x for asked, answers in pairs for x in figures_beside(asked, answers, self.facts)))

    @cached_property
    def spans(self) -> tuple[Span, ...]:
        """Where it was asked, how tests of each class begin, and how drives of it can."""
        if not self.request.explore:
            return ()
        covered = {x.name: x.covered for x in self.tested.targets}
        return tuple(spans_of(self.basis.specification, covered, self.facts))

    @cached_property
    def decisions(self) -> tuple[tuple[str, Decision], ...]:
        """What becomes of each test, by id, under each driver model, in the order of tests."""
        drivers = self.drivers
        concrete = {
            x.entry.id: [borne_out(x.entry.id, y, self.driven) for y in x.decisions] for x in self.concrete
        }
        if drivers is None:
            return ()
        found: list[tuple[str, Decision]] = []
        for entry in self.catalogue.entries:
            made: Iterable[Decision] = concrete.get(entry.id, ())
            if isinstance(entry, Abstract):
                made = self._of_formula(entry, drivers)
            found += [(entry.id, x) for x in made]
        return tuple(found)

    def _kept(self, test: str, decision: Decision, place: Place) -> kept.KeptDecision:
        """Return a decision as ``--json`` prints it, with its drive."""
        fields = {name: value for name, value in vars(decision).items() if name != "driven"}
        name = driven_name(test, decision)
        drive = place(name, self.driven[name]) if name in self.driven else None
        return kept.KeptDecision(test=test, drive=drive, **fields)

    def _of_formula(self, entry: Abstract, drivers: Drivers) -> Iterator[Decision]:
        """What becomes of an abstract test by the drives of it that were found, each once."""
        facts = [x for x in self.facts if x.test == entry.id]
        drives = {repr(x.drive.file.drive): x.drive for x in facts if x.drive is not None}
        scenarios = scenarios_shown(facts)
        sides = [read_side_name(x.other) for x in facts if x.relation == "open"]
        missed = {(x[0], x[2]) for x in sides if x is not None}
        return decide_formula(decisions_of(drives.values(), scenarios, self.asked, drivers), missed)

    @property
    def missing(self) -> tuple[str, ...]:
        """What is to be tested, and no test shows: scenarios, classes, with ``gaps`` classes of gaps."""
        return tuple(x.name for x in self.tested.missing)

    @property
    def notes(self) -> tuple[str, ...]:
        """On files that are no tests, samples that contradict themselves, drives made with other values."""
        made: dict[tuple[str, ...], list[str]] = {}
        for x in self.concrete:
            if x.made_with:
                made.setdefault(x.made_with, []).append(x.entry.id)
        others = (
            f"made with {', '.join(those)}, and judged with what is asked for: {', '.join(tests)}"
            for those, tests in made.items()
        )
        return (*self.catalogue.notes, *self._noted(lambda note: True), *others, *self._unlike())

    def _unlike(self) -> Iterator[str]:
        """A note where tests are compared of which some are judged from more instants than others."""
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
        """Those of the notes that say which vehicles and parts of files were left out."""
        return self._noted(lambda note: bool(left_out_in([note])))

    def _noted(self, wanted: Callable[[str], bool]) -> tuple[str, ...]:
        """The notes on tests that are wanted, each with the tests that it is about."""
        tests: dict[str, list[str]] = {}
        every = [(x.entry.id, x.notes) for x in self.concrete]
        every += [(x.id, unread_of_road(x.road)) for x in self.catalogue.entries if isinstance(x, Abstract)]
        for own_id, notes in every:
            for note in filter(wanted, notes):
                tests.setdefault(note, []).append(own_id)
        return tuple(f"{', '.join(names)}: {note}" for note, names in tests.items())

    @property
    def in_force(self) -> tuple[str, ...]:
        """What was asked otherwise than by default: spec set, readings, parameters, a driver model."""
        basis = self.basis
        home = basis.specification
        driver = restriction_of(home.options)
        said = [] if home.set_name == "base" else [f"set {home.set_name}"]
        known = {} if driver is None else driver.options
        readings = {k: v for k, v in home.options.items() if k not in known}
        said += [f"{k} = {v}" for k, v in readings.items() if v != home.library.options[k].values[0]]
        declared = values_with(home.library, {})
        said += [f"{k} = {v} (SI)" for k, v in basis.values.items() if v != declared[k]]
        return (*said, *(() if driver is None else (str(driver),)))

    def data(self, place: Place, seconds: float) -> kept.Index:
        """Return the view as ``--json`` prints it."""
        found = self.tested
        said: dict[str, Any] = {"set": self.basis.specification.set_name, **self.basis.said()}
        return kept.Index(
            **heading_of(kept.SCHEMA, self.basis),
            **said,
            scenarios=self.asked.numbers,
            request=self.request.kept,
            tests=tuple(map(self._test, self.catalogue.entries)),
            targets=found.targets,
            gaps=self._gaps(place),
            not_tested=self.missing,
            figures=self.figures,
            decisions=tuple(self._kept(test, x, place) for test, x in self.decisions),
            ranges=tuple(map(_range, self.spans)),
            facts=tuple(fact_data(x, place) for x in self.facts),
            faults=found.faults,
            doubts=found.doubts,
            alike=found.alike,
            contradictions=found.contradictions,
            notes=self.notes,
            left_out=self.left_out,
            seconds=round(seconds, 1),
        )

    def _gaps(self, place: Place) -> kept.Gaps:
        """Return the classes of gaps: those that tests show, or all with what shows that they are empty."""
        gaps, claims, classes = self.tested.gaps, list[coverage.Claim](), list[coverage.KeptClass]()
        if self.survey is not None:
            nested, view = self.survey
            there = nested.place(place)
            claims += claims_data(view, there)
            classes += (class_data(x, there) for x in view.survey.classes)
        return kept.Gaps(
            asked=gaps.asked,
            classes_in_all=gaps.total,
            targets=gaps.targets,
            empty=tuple(x.name for x in gaps.empty),
            open=gaps.open,
            claims=tuple(claims),
            classes=tuple(classes),
        )

    def _test(self, entry: Concrete | Abstract) -> kept.ConcreteTest | kept.AbstractTest:
        if isinstance(entry, Abstract):
            return kept.AbstractTest(
                id=entry.id, title=entry.title, formula=entry.query.text, claims=tuple(entry.claims)
            )
        answer = next(x for x in self.concrete if x.entry == entry)
        return kept.ConcreteTest(
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


def _range(span: Span) -> kept.Range:
    said = {name: x for name, x in vars(span).items() if name != "unit"}
    return kept.Range(**said, untested=span.untested, share=round(span.share, 4))


def fact_data(fact: Fact, place: Place) -> kept.KeptFact:
    """Return a fact as ``--json`` prints it."""
    file = None if fact.answer is None else place(fact.name, fact.answer)
    return kept.KeptFact(
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
