"""What abstract tests mean: which scenarios and tests each implies or excludes, and what it can show.

Each test is asked by itself (``formula_facts``), then pairs of tests and the sides of driver models.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, TypeAlias, TypeVar

from roadproof.analysis.basis import Basis
from roadproof.analysis.catalogue.asked import Questions
from roadproof.analysis.catalogue.decisions import Drivers, content_of
from roadproof.analysis.catalogue.entries import Abstract
from roadproof.analysis.catalogue.fact import Fact, read_fact, record_of
from roadproof.analysis.catalogue.formula_facts import FormulaFacts, facts_of_pair
from roadproof.analysis.catalogue.gaps import GapKinds
from roadproof.analysis.catalogue.ranges import Reach, reached
from roadproof.analysis.catalogue.sides import Sides, facts_on_sides, has_sides, unanswered_sides
from roadproof.analysis.coverage import answers as survey
from roadproof.analysis.coverage.found import mixed_definitions
from roadproof.analysis.coverage.study import Coverage
from roadproof.analysis.study.evidence_store import EvidenceStore, Question
from roadproof.analysis.study.frame import Unprepared
from roadproof.errors import InputError
from roadproof.evidence.answers import catalogue_index as kept
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.strict import JsonObject
from roadproof.library.scenarios import Scenario, applied, name_of, number_in
from roadproof.reasons import Reason
from roadproof.runtime.canonical import digest


@dataclass(frozen=True)
class Pair:
    """Two abstract tests, of which the first may imply the second; ``drive`` is one of the first."""

    one: Abstract
    other: Abstract
    drive: JudgedDrive


@dataclass(frozen=True)
class GapPiece:
    """A part of the survey of gaps."""

    piece: survey.Piece


Piece: TypeAlias = Abstract | Pair | Sides | GapPiece | Reach
Facts: TypeAlias = tuple[Fact, ...]


@dataclass(frozen=True)
class AboutGaps:
    """An answer of the survey of gaps."""

    answer: survey.Kept


Kept: TypeAlias = Facts | AboutGaps
GAPS = "gaps-"
"""How the names of answers to the survey of gaps begin."""
Names: TypeAlias = tuple[str, ...]
T = TypeVar("T")


@dataclass(frozen=True)
class Meanings(Unprepared):
    """The question for all that is known of abstract tests, as a ``study.frame.Study``.

    ``beside``: what is asked in further sets. ``gaps``: classes of gaps of which it is asked which are empty,
    but for those that tests have ``shown``. ``reaches``: how far drives can go that show what tests show.
    ``drivers``: the models of which it is asked whether a test has drives on both sides.
    """

    record_type: ClassVar[type[kept.Record]] = kept.Record
    basis: Basis
    entries: tuple[Abstract, ...]
    asked: Questions
    beside: tuple[Questions, ...] = ()
    gaps: GapKinds | None = None
    shown: frozenset[str] = frozenset()
    reaches: tuple[Reach, ...] = ()
    drivers: Drivers | None = None

    @property
    def question(self) -> Question:
        """What is asked about gaps is kept by itself, and whether it is asked changes nothing else."""
        said: JsonObject = {"set": self.basis.specification.set_name, "scenarios": list(self.asked.numbers)}
        more = {f"set {x.specification.set_name}": "" for x in self.beside} | self.basis.limits
        of_some = {x.id: _said(self.basis, x) for x in self.entries}
        if self.entries and self.drivers is not None:
            of_some |= {"drivers": content_of(self.drivers)}
        return Question(kept.SCHEMA, said | self.basis.said(), more, self.basis.library, of_some=of_some)

    @cached_property
    def survey(self) -> Coverage | None:
        """The question for the classes of gaps."""
        return None if self.gaps is None else self.gaps.study()

    def pieces(self, known: Mapping[str, Kept]) -> Sequence[Piece]:
        """Each test and what is asked about gaps. When all are known, the sides of driver models and pairs of
        tests: what a drive does not share is not implied."""
        left: list[Piece] = [entry for entry in self.entries if _name(entry.id) not in known]
        left += [reach for reach in self.reaches if _name(reach.target, reach.term) not in known]
        left += self._about_gaps(known)
        return left or [x for name, x in self._later(known).items() if name not in known]

    def _later(self, known: Mapping[str, Kept]) -> dict[str, Pair | Sides]:
        """What is asked when all is known of each test by itself, by the names of the answers."""
        facts = {entry.id: facts_in(known[_name(entry.id)]) for entry in self.entries}
        drives = {
            name: next((x.drive for x in those if x.relation == "runs"), None)
            for name, those in facts.items()
        }
        pairs = {
            _name(one.id, other.id): Pair(one, other, drive)
            for one in self.entries
            for other in self.entries
            if one is not other
            and set(other.query.vehicles) <= set(one.query.vehicles)
            and (drive := drives[one.id]) is not None
        }
        sides = (x for entry in self.entries for x in self._sides(entry, facts[entry.id]))
        return {**pairs, **{_name(x.entry.id, x.scenario): x for x in sides}}

    def wanted(self, known: Mapping[str, Kept]) -> Collection[str]:
        names = [_name(entry.id) for entry in self.entries]
        return names if any(x not in known for x in names) else [*names, *self._later(known)]

    def key(self, name: str) -> str | None:
        """What an answer about tests depends on: their formulas, all scenarios, and models of its sides."""
        about = self._subjects.get(name)
        if about is None or self.basis.effort.timeout is not None:  # a clock may cut off proofs
            return None
        tests, is_of_drivers = about
        drivers = None if self.drivers is None or not is_of_drivers else content_of(self.drivers)
        said = [_said(self.basis, x) for x in tests]
        return self.basis.key((x.query for x in tests), self._said_of_all, said, drivers)

    @cached_property
    def _subjects(self) -> Mapping[str, tuple[tuple[Abstract, ...], bool]]:
        """By the name of an answer the tests that it is about, and whether it is about driver models too."""
        found: dict[str, tuple[tuple[Abstract, ...], bool]] = {
            _name(x.id): ((x,), False) for x in self.entries
        }
        for one in self.entries:
            found |= {_name(one.id, x.id): ((one, x), False) for x in self.entries if x is not one}
        for one in self.entries:
            found |= {_name(one.id, name_of(x)): ((one,), True) for x in self.asked.numbers}
        return found

    def in_order(self, answers: Mapping[str, T]) -> dict[str, T]:
        """Answers by name as one process gives them, whichever came first; those about gaps as they came."""
        alone = [*(_name(x.id) for x in self.entries), *(_name(x.target, x.term) for x in self.reaches)]
        places = {name: k for k, name in enumerate(dict.fromkeys([*alone, GAPS, *self._subjects]))}
        names = sorted(answers, key=lambda x: places[GAPS if x.startswith(GAPS) else x])
        return {name: answers[name] for name in names}

    @cached_property
    def _said_of_all(self) -> str:
        """All that tests are asked, with the definitions that it uses."""
        home, asked = self.basis.specification, (self.asked, *self.beside)
        queries = [applied(home, Scenario(n, x.specification.set_name)) for x in asked for n in x.numbers]
        queries += [x.class_query(name) for x in asked for name in x.named.values()]
        bodies = [sorted(mixed_definitions(x.specification, x.specification).items()) for x in asked]
        classes = [x.named for x in asked]
        return self.basis.key(queries, bodies, classes, self.basis.all_values(), bool(home.library.files))

    def _sides(self, entry: Abstract, facts: Facts) -> Iterator[Sides]:
        """A piece for each scenario of a test of which a driver model speaks."""
        drives = tuple(x.drive for x in facts if x.drive is not None)
        for scenario in scenarios_shown(facts):
            if self.drivers is not None and has_sides(self.drivers, scenario):
                yield Sides(entry, scenario, drives)

    def _about_gaps(self, known: Mapping[str, Kept]) -> Iterator[GapPiece]:
        """The pieces of the survey, without the classes that tests show."""
        if self.survey is None or self.gaps is None:
            return
        names = {None if part is None else part.key: name for name, part in self.gaps.parts.items()}
        for piece in self.survey.pieces(gap_answers(known)):
            if isinstance(piece, survey.Component):
                parts = self.survey.groups[piece.name].parts
                if all(names[None if part is None else part.key] in self.shown for part in parts):
                    continue
            yield GapPiece(piece)

    def settle(self, piece: Piece) -> dict[str, Kept]:
        match piece:
            case GapPiece(inside):
                assert self.survey is not None
                return {GAPS + name: AboutGaps(x) for name, x in self.survey.settle(inside).items()}
            case Pair(one, other, drive):
                return {_name(one.id, other.id): facts_of_pair(self.basis, self.asked, one, other, drive)}
            case Sides(entry, scenario):
                assert self.drivers is not None
                facts = facts_on_sides(self.basis, self.asked, self.drivers, piece)
                return {_name(entry.id, scenario): facts}
            case Abstract():
                return {_name(piece.id): FormulaFacts(self.basis, self.asked, piece, self.beside).all()}
            case Reach(target, term):
                return {_name(target, term): reached(self.basis, piece)}

    def doubt(self, piece: Piece, reason: Reason) -> dict[str, Kept]:
        match piece:
            case GapPiece(inside):
                assert self.survey is not None
                return {GAPS + name: AboutGaps(x) for name, x in self.survey.doubt(inside, reason).items()}
            case Pair(one, other):
                return {_name(one.id, other.id): ()}
            case Sides(entry, scenario):
                assert self.drivers is not None
                return {_name(entry.id, scenario): unanswered_sides(self.drivers, piece, reason)}
            case Abstract():
                return {_name(piece.id): (Fact(piece.id, "", "open", piece.query, reason=reason),)}
            case Reach(target, term, query):
                return {_name(target, term): (Fact("", target, "open", query, reason=reason, term=term),)}

    def is_sure(self, answer: Kept) -> bool:
        if isinstance(answer, AboutGaps):
            return self.survey is not None and self.survey.is_sure(answer.answer)
        return all(fact.relation != "open" for fact in answer)

    def is_lasting(self, answer: Kept) -> bool:
        """Sure ones, and those with scenarios of which all work that counts found neither drive nor proof."""
        if isinstance(answer, AboutGaps):
            return self.is_sure(answer)
        return all(x.relation != "open" or (x.other and x.exhausted) for x in answer)

    def record(self, name: str, answer: Kept, shelf: EvidenceStore) -> kept.Record:
        if isinstance(answer, AboutGaps):
            assert self.survey is not None
            gaps = self.survey.record(name.removeprefix(GAPS), answer.answer, shelf)
            return kept.Record(name=name, facts=(), gaps=gaps)
        facts = tuple(record_of(fact, f"{name}-{k}", shelf) for k, fact in enumerate(answer))
        return kept.Record(name=name, facts=facts, gaps=None)

    def recall(self, record: kept.Record, shelf: EvidenceStore) -> tuple[str, Kept]:
        if record.gaps is None:
            return record.name, tuple(read_fact(x, self.basis.specification, shelf) for x in record.facts)
        kinds = self.gaps or self.asked.gaps
        if kinds is None:
            raise InputError("there are no classes of gaps here")
        name, answer = kinds.study().recall(record.gaps, shelf)
        return GAPS + name, AboutGaps(answer)


def facts_in(answer: Kept) -> Facts:
    """What an answer says about tests."""
    return () if isinstance(answer, AboutGaps) else answer


def scenarios_shown(facts: Iterable[Fact]) -> tuple[str, ...]:
    """The scenarios that a test implies, or that the first drive of it shows."""
    named = [
        (x.other,) if x.relation == "implies" else x.also for x in facts if x.relation in ("implies", "runs")
    ]
    shown = [name for those in named for name in those]
    return tuple(dict.fromkeys(x for x in shown if number_in(x) is not None))


def gap_answers(known: Mapping[str, Kept]) -> dict[str, survey.Kept]:
    """What is known of gaps, by the names of the survey."""
    return {n.removeprefix(GAPS): x.answer for n, x in known.items() if isinstance(x, AboutGaps)}


def _name(one: str, other: str = "") -> str:
    """A name for the answers about a test, or two, fit for a file."""
    return f"test-{digest(one, other)[:12]}"


def _said(basis: Basis, entry: Abstract) -> str:
    """A digest that changes with all that drives of a test depend on, and with its text."""
    return digest(basis.claim(entry.query), entry.query.text, entry.road, entry.vehicles)
