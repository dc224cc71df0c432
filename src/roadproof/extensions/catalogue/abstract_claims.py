"""Claims about a test that is a formula: whether it has a drive, and the scenarios that it shows or implies.

The first claim is that a drive of the test exists. For each scenario that it does not show, the next claim is
that a drive of the test shows it; a proof that test and scenario exclude each other answers it too. The test
can imply only scenarios that all these drives show.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property

from roadproof.engines.search.impossible import at_start
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.assuming import valid_under
from roadproof.evidence.claim import Claim, Exists, claim_of
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.candidates import CandidateDrives
from roadproof.extensions.catalogue.drive_targets import names_shown, targets_shown
from roadproof.extensions.catalogue.entries import AbstractTest, Freedom
from roadproof.extensions.catalogue.fact import CatalogueFact
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.surveys.extremes.points import ClaimGenerator
from roadproof.library.bind import bind
from roadproof.library.compose import both, implication
from roadproof.library.scenarios import Scenario, apply_scenario, name_of
from roadproof.library.specification import Query
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, Steps
from roadproof.reasons import ReasonKind
from roadproof.runtime.budget import Work
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.judging import DriveJudge, LazyJudge
from roadproof.verdict import Verdict


def claim_stem(test: str) -> str:
    """Return the stem of names of claims about a test, fit for files."""
    plain = "".join(x if x.isascii() and (x.isalnum() or x in "_-") else "-" for x in test)[:40]
    return f"test-{plain}-{digest(test)[:6]}"


@dataclass(frozen=True)
class TestBatch:
    """The claims about a test that is a formula; ``beside``: the formulas of further spec sets.

    ``shipped``: the shipped drives as drives of the test, once its first drive is known.
    """

    basis: Basis
    formulas: TargetFormulas
    entry: AbstractTest
    beside: tuple[TargetFormulas, ...] = ()
    shipped: list[CandidateDrives] = field(default_factory=list, compare=False, repr=False)

    @property
    def name(self) -> str:
        """The stem of the names of its claims."""
        return claim_stem(self.entry.id)

    def work_of(self, name: str) -> Work:
        """Return the work that is allowed for a claim; only the first one explains why there is no drive.

        Drives of a test that names its road stay on it.
        """
        moves = self.entry.road is None
        return Work(self.basis.effort, self.basis.proof, explain=name == self._runs, moves=moves)

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        yield from self.facts()

    def facts(self) -> ClaimGenerator[tuple[CatalogueFact, ...]]:
        """Yield the claims, and return the facts in the order of the scenarios."""
        entry, runs = self.entry, self._runs
        first = yield runs, self.exists(entry.query)
        if first.drive is None:
            return (_fact_without_drive(entry, runs, first),)
        shown = names_shown(first.drive, self.formulas)
        drives, others = [shown], dict[str, CatalogueFact]()
        for name, query in self.scenarios.items():
            if name not in shown:
                others[name] = yield from self._decide_shows(name, query)
                drives += [others[name].also] if others[name].drive is not None else []
        facts = [
            CatalogueFact(
                entry.id, "", "runs", entry.query, drive=first.drive, also=shown, name=runs, answer=first
            )
        ]
        for name, query in self.scenarios.items():
            fact = others.get(name)
            if fact is None:
                fact = (yield from self._decide_implies(name, query, drives)) or (
                    yield from self._decide_shows(name, query)
                )
            facts.append(fact)
        for formulas in self.beside:
            facts += yield from self._decide_in_set(formulas, first.drive)
        for name in (x for x in shown if x in {*self.formulas.class_names.values()}):
            implied = yield from self._decide_implies(name, self.formulas.class_query(name), drives)
            facts += [] if implied is None else [implied]
        return tuple(facts)

    @property
    def _runs(self) -> str:
        """The name of the claim that there is a drive of the test."""
        return f"{self.name}-runs"

    def proposed(self, name: str, known: Answers) -> Iterator[JudgedDrive]:
        """Yield a shipped drive for the claim that a drive of the test shows a scenario."""
        scenarios = (x for x in self.scenarios if self.claim_name("shows", x) == name)
        scenario, first = next(scenarios, None), known.get(self._runs)
        if scenario is None or first is None or first.drive is None:
            return
        if not self.shipped:
            shown = names_shown(first.drive, self.formulas)
            self.shipped.append(CandidateDrives(self.basis, self.entry, first.drive, shown))
        drive = self.shipped[0].find(scenario, self.scenarios[scenario])
        yield from () if drive is None else (drive,)

    def _decide_shows(self, name: str, query: Query) -> ClaimGenerator[CatalogueFact]:
        """Claim that a drive of the test shows a scenario, and return the fact."""
        fact = CatalogueFact(self.entry.id, name, "open", self.entry.query, query)
        claim = self.claim_name("shows", name)
        answer = yield claim, self.exists(both(self.entry.query, query))
        fact = replace(fact, name=claim, answer=answer)
        if answer.drive is not None:
            also = names_shown(answer.drive, self.formulas)
            return replace(fact, relation="shows", drive=answer.drive, also=also)
        if answer.certificate is not None:
            return replace(fact, relation="excludes")
        return replace(fact, reason=answer.reason or ReasonKind.NO_DRIVE())

    def _decide_implies(
        self, name: str, query: Query, drives: Sequence[Sequence[str]]
    ) -> ClaimGenerator[CatalogueFact | None]:
        """Claim that the test implies a target that all its ``drives`` show, and return the fact."""
        if not all(name in x for x in drives):
            return None
        claim = self.claim_name("implies", name)
        answer = yield claim, self.implies(query)
        if answer.verdict is not Verdict.PROVED:
            return None
        return CatalogueFact(
            self.entry.id, name, "implies", self.entry.query, query, name=claim, answer=answer
        )

    def _decide_in_set(
        self, formulas: TargetFormulas, drive: JudgedDrive
    ) -> ClaimGenerator[list[CatalogueFact]]:
        """Claim that the test implies each scenario of another set that its drive shows; return the facts."""
        there = {x.what for x in targets_shown(drive.file, formulas, Freedom())}
        facts, set_name = list[CatalogueFact](), formulas.specification.set_name
        for number in formulas.numbers:
            if name_of(number) in there:
                query = apply_scenario(self.basis.specification, Scenario(number, set_name))
                fact = yield from self._decide_implies(f"{name_of(number)}@{set_name}", query, ())
                facts += [] if fact is None else [fact]
        return facts

    @cached_property
    def scenarios(self) -> Mapping[str, Query]:
        """The scenarios of its vehicles, by name."""
        return self.formulas.scenarios_of(self.entry.query.vehicles)

    def claim_name(self, relation: str, other: str) -> str:
        """Return the name of the claim about a relation to another name."""
        return f"{self.name}-{relation}-{other.replace('@', '-in-')}"

    def exists(self, query: Query) -> Claim:
        """Return the claim that there is a drive of the test, on its road and with its vehicles."""
        vehicles = {x: y for x, y in self.entry.vehicles.items() if not x or x in query.vehicles}
        mode = Exists(road=self.entry.road, vehicles=vehicles, horizon=self.basis.horizon)
        return claim_of(self.basis.specification, query, mode, self.basis.values)

    def implies(self, query: Query) -> Claim:
        """Return the claim that every drive of the test shows another formula."""
        return valid_under(self.basis.specification, implication(self.entry.query, query))


def _fact_without_drive(entry: AbstractTest, name: str, answer: ClaimAnswer) -> CatalogueFact:
    """Return the fact about a test without a drive."""
    if answer.certificate is not None:
        return CatalogueFact(entry.id, "", "empty", entry.query, name=name, answer=answer)
    reason = answer.reason or ReasonKind.NO_DRIVE()
    return CatalogueFact(entry.id, "", "open", entry.query, reason=reason, name=name, answer=answer)


@dataclass(frozen=True)
class ImplicationBatch:
    """The claim that a test implies another one; ``drive``: a drive of the first test."""

    basis: Basis
    formulas: TargetFormulas
    one: AbstractTest
    other: AbstractTest
    drive: JudgedDrive

    @property
    def name(self) -> str:
        """The name of its claim."""
        return f"{claim_stem(self.one.id)}-implies-{claim_stem(self.other.id)}"

    def steps(self) -> Steps:
        """Yield the claim, where the drive of the first test is one of the second."""
        yield from self.facts()

    def facts(self) -> ClaimGenerator[tuple[CatalogueFact, ...]]:
        """Yield the claim, and return the fact that the first test implies the second, where it is proved."""
        file = self.drive.file
        formula = bind(self.other.query.formula, file.road, file.lanes, self.formulas.values)
        judge = (LazyJudge if self.formulas.is_always_judged else DriveJudge).on(file.drive)
        if not (judge.holds(at_start(formula)) and judge.holds(formula)):
            return ()
        claim = valid_under(self.basis.specification, implication(self.one.query, self.other.query))
        answer = yield self.name, claim
        if answer.verdict is not Verdict.PROVED:
            return ()
        fact = CatalogueFact(self.one.id, self.other.id, "implies", self.one.query, self.other.query)
        return (replace(fact, name=self.name, answer=answer),)
