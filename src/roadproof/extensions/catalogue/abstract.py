"""Claims about a test that is a formula: whether it can be run, and what it implies, excludes and can show.

A drive of the test is looked for first. Of each scenario that it does not show it is asked whether a drive of
the test shows it, which a proof that the two clash answers, too. Only what all these drives show may be
implied.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property

from roadproof.engines.search.impossible import at_start
from roadproof.evidence.answer import Answer
from roadproof.evidence.claim import Claim, Exists, claim_of, valid_under
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.asked import Questions
from roadproof.extensions.catalogue.candidates import CandidateDrives
from roadproof.extensions.catalogue.entries import Abstract, Freedom
from roadproof.extensions.catalogue.fact import Fact
from roadproof.extensions.catalogue.showing import names_shown, shown_by
from roadproof.extensions.surveys.extremes.points import Asking
from roadproof.library.bind import bind
from roadproof.library.compose import both, implication
from roadproof.library.scenarios import Scenario, applied, name_of
from roadproof.library.specification import Query
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, Steps
from roadproof.reasons import Why
from roadproof.runtime.budget import Work
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass
from roadproof.semantics.exact.exact import DriveJudge, LazyJudge
from roadproof.verdict import Verdict


def stem_of(test: str) -> str:
    """Return how names of claims about a test begin, fit for files."""
    plain = "".join(x if x.isascii() and (x.isalnum() or x in "_-") else "-" for x in test)[:40]
    return f"test-{plain}-{digest(test)[:6]}"


@dataclass(frozen=True)
class TestBatch:
    """The claims about a test with a formula; ``beside``: what is asked in further spec sets.

    ``shipped``: the shipped drives as drives of the test, once its first drive is known.
    """

    basis: Basis
    asked: Questions
    entry: Abstract
    beside: tuple[Questions, ...] = ()
    shipped: list[CandidateDrives] = field(default_factory=list, compare=False, repr=False)

    @property
    def name(self) -> str:
        """How the names of its claims begin."""
        return stem_of(self.entry.id)

    def work_of(self, name: str) -> Work:
        """Return the work that is allowed for a claim; why there is no drive is asked of the test alone."""
        return Work(self.basis.effort, self.basis.proof, explain=name == self._runs)

    def steps(self) -> Steps:
        """Yield each claim, and be sent its answer."""
        yield from self.facts()

    def facts(self) -> Asking[tuple[Fact, ...]]:
        """Ask all of the test, and return what is known of it, in the order of the scenarios."""
        entry, runs = self.entry, self._runs
        first = yield runs, self.exists(entry.query)
        if first.drive is None:
            return (_alone(entry, runs, first),)
        shown = names_shown(first.drive, self.asked)
        drives, others = [shown], dict[str, Fact]()
        for name, query in self.scenarios.items():
            if name not in shown:
                others[name] = yield from self._shown(name, query)
                drives += [others[name].also] if others[name].drive is not None else []
        facts = [
            Fact(entry.id, "", "runs", entry.query, drive=first.drive, also=shown, name=runs, answer=first)
        ]
        for name, query in self.scenarios.items():
            fact = others.get(name)
            if fact is None:
                fact = (yield from self._implied(name, query, drives)) or (
                    yield from self._shown(name, query)
                )
            facts.append(fact)
        for asked in self.beside:
            facts += yield from self._in_set(asked, first.drive)
        for name in (x for x in shown if x in {*self.asked.named.values()}):
            implied = yield from self._implied(name, self.asked.class_query(name), drives)
            facts += [] if implied is None else [implied]
        return tuple(facts)

    @property
    def _runs(self) -> str:
        """The name of the claim that there is a drive of the test."""
        return f"{self.name}-runs"

    def proposed(self, name: str, known: Answers) -> Iterator[JudgedDrive]:
        """Yield a shipped drive that shows a scenario in the test, for the claim that there is one."""
        found = (x for x in self.scenarios if self.named("shows", x) == name)
        scenario, first = next(found, None), known.get(self._runs)
        if scenario is None or first is None or first.drive is None:
            return
        if not self.shipped:
            shown = names_shown(first.drive, self.asked)
            self.shipped.append(CandidateDrives(self.basis, self.entry, first.drive, shown))
        drive = self.shipped[0].find(scenario, self.scenarios[scenario])
        yield from () if drive is None else (drive,)

    def _shown(self, name: str, query: Query) -> Asking[Fact]:
        """Ask for a drive of the test that shows a scenario, or a proof that the two clash."""
        fact = Fact(self.entry.id, name, "open", self.entry.query, query)
        asked = self.named("shows", name)
        answer = yield asked, self.exists(both(self.entry.query, query))
        fact = replace(fact, name=asked, answer=answer)
        if answer.drive is not None:
            also = names_shown(answer.drive, self.asked)
            return replace(fact, relation="shows", drive=answer.drive, also=also)
        if answer.certificate is not None:
            return replace(fact, relation="excludes")
        return replace(fact, reason=answer.reason or Why.NO_DRIVE())

    def _implied(self, name: str, query: Query, drives: Sequence[Sequence[str]]) -> Asking[Fact | None]:
        """Ask whether the test implies what all its drives show."""
        if not all(name in x for x in drives):
            return None
        asked = self.named("implies", name)
        answer = yield asked, self.implies(query)
        if answer.verdict is not Verdict.PROVED:
            return None
        return Fact(self.entry.id, name, "implies", self.entry.query, query, name=asked, answer=answer)

    def _in_set(self, asked: Questions, drive: JudgedDrive) -> Asking[list[Fact]]:
        """Ask which scenarios of another set the test implies, among those that its drive shows."""
        there = {x.what for x in shown_by(drive.file, asked, Freedom())}
        facts, set_name = list[Fact](), asked.specification.set_name
        for number in asked.numbers:
            if name_of(number) in there:
                query = applied(self.basis.specification, Scenario(number, set_name))
                fact = yield from self._implied(f"{name_of(number)}@{set_name}", query, ())
                facts += [] if fact is None else [fact]
        return facts

    @cached_property
    def scenarios(self) -> Mapping[str, Query]:
        """The scenarios of its vehicles, by name."""
        return self.asked.scenarios_of(self.entry.query.vehicles)

    def named(self, relation: str, other: str) -> str:
        """Return the name of a claim about another name."""
        return f"{self.name}-{relation}-{other.replace('@', '-in-')}"

    def exists(self, query: Query) -> Claim:
        """Return the claim that there is a drive of the test, on its road and with its vehicles."""
        vehicles = {x: y for x, y in self.entry.vehicles.items() if not x or x in query.vehicles}
        mode = Exists(road=self.entry.road, vehicles=vehicles, horizon=self.basis.horizon)
        return claim_of(self.basis.specification, query, mode, self.basis.values)

    def implies(self, query: Query) -> Claim:
        """Return the claim that every drive of the test shows another formula."""
        return valid_under(self.basis.specification, implication(self.entry.query, query))


def _alone(entry: Abstract, name: str, answer: Answer) -> Fact:
    """Return what is known of a test of which there is no drive."""
    if answer.certificate is not None:
        return Fact(entry.id, "", "empty", entry.query, name=name, answer=answer)
    reason = answer.reason or Why.NO_DRIVE()
    return Fact(entry.id, "", "open", entry.query, reason=reason, name=name, answer=answer)


@dataclass(frozen=True)
class PairBatch:
    """The claim that a test implies another one; ``drive`` is one of the first."""

    basis: Basis
    asked: Questions
    one: Abstract
    other: Abstract
    drive: JudgedDrive

    @property
    def name(self) -> str:
        """The name of its claim."""
        return f"{stem_of(self.one.id)}-implies-{stem_of(self.other.id)}"

    def steps(self) -> Steps:
        """Yield the claim, where the drive of the first is one of the second."""
        yield from self.facts()

    def facts(self) -> Asking[tuple[Fact, ...]]:
        """Ask, and return that the first implies the second, where that is proved."""
        file = self.drive.file
        formula = bind(self.other.query.formula, file.road, file.lanes, self.asked.values)
        judge = (LazyJudge if self.asked.is_always_judged else DriveJudge).on(file.drive)
        if not (judge.holds(at_start(formula)) and judge.holds(formula)):
            return ()
        claim = valid_under(self.basis.specification, implication(self.one.query, self.other.query))
        answer = yield self.name, claim
        if answer.verdict is not Verdict.PROVED:
            return ()
        fact = Fact(self.one.id, self.other.id, "implies", self.one.query, self.other.query)
        return (replace(fact, name=self.name, answer=answer),)
