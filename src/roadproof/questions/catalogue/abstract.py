"""Claims about a test that is a formula: whether it can be run, and what it implies, excludes and can show.

A drive of the test is looked for first. Of each scenario that it does not show it is asked whether a drive of
the test shows it, which a proof that the two clash answers, too. Only what all these drives show may be
implied.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

from roadproof.analysis.basis import Basis
from roadproof.analysis.catalogue.asked import Questions
from roadproof.analysis.catalogue.entries import Abstract, Freedom
from roadproof.analysis.catalogue.fact import Fact
from roadproof.analysis.catalogue.showing import names_shown, shown_by
from roadproof.engines.search.impossible import at_start
from roadproof.evidence.answer import Answer
from roadproof.evidence.claim import Claim, Exists, claim_of, valid_under
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import bind
from roadproof.library.compose import both, implication
from roadproof.library.scenarios import Scenario, applied, name_of
from roadproof.library.specification import Query
from roadproof.questions.question import Answers, Steps
from roadproof.reasons import NO_REASON, Why
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
    """The claims about a test with a formula; ``beside``: what is asked in further spec sets."""

    basis: Basis
    asked: Questions
    entry: Abstract
    beside: tuple[Questions, ...] = ()

    @property
    def name(self) -> str:
        """How the names of its claims begin."""
        return stem_of(self.entry.id)

    def steps(self) -> Steps:
        """Yield the claim that it can be run, then what it shows, then what it implies."""
        first = yield f"{self.name}-runs", self.exists(self.entry.query)
        if first.drive is None:
            return
        shown = names_shown(first.drive, self.asked)
        every = [shown]
        for name, query in self.scenarios.items():
            if name not in shown:
                found = yield self.named("shows", name), self.exists(both(self.entry.query, query))
                every += [] if found.drive is None else [names_shown(found.drive, self.asked)]
        for name, query in self.implied(shown, every, first.drive):
            found = yield self.named("implies", name), self.implies(query)
            if found.verdict is not Verdict.PROVED and name in self.scenarios:
                yield self.named("shows", name), self.exists(both(self.entry.query, query))

    @cached_property
    def scenarios(self) -> Mapping[str, Query]:
        """The scenarios of its vehicles, by name."""
        return self.asked.scenarios_of(self.entry.query.vehicles)

    def named(self, relation: str, other: str) -> str:
        """Return the name of a claim about another name."""
        return f"{self.name}-{relation}-{other.replace('@', '-in-')}"

    def implied(
        self, shown: Sequence[str], every: Sequence[Sequence[str]], drive: JudgedDrive
    ) -> Iterator[tuple[str, Query]]:
        """Yield what the test may imply: what all its drives show, in further sets what the first shows."""
        home = self.basis.specification
        common = [x for x in shown if all(x in names for names in every)]
        yield from ((x, self.scenarios[x]) for x in common if x in self.scenarios)
        for asked in self.beside:
            set_name = asked.specification.set_name
            there = {x.what for x in shown_by(drive.file, asked, Freedom())}
            for number in asked.numbers:
                if name_of(number) in there:
                    yield f"{name_of(number)}@{set_name}", applied(home, Scenario(number, set_name))
        classes = {*self.asked.named.values()}
        yield from ((x, self.asked.class_query(x)) for x in common if x in classes)

    def exists(self, query: Query) -> Claim:
        """Return the claim that there is a drive of the test, on its road and with its vehicles."""
        vehicles = {x: y for x, y in self.entry.vehicles.items() if not x or x in query.vehicles}
        mode = Exists(road=self.entry.road, vehicles=vehicles, horizon=self.basis.horizon)
        return claim_of(self.basis.specification, query, mode, self.basis.values)

    def implies(self, query: Query) -> Claim:
        """Return the claim that every drive of the test shows another formula."""
        return valid_under(self.basis.specification, implication(self.entry.query, query))

    # --- what the answers say -------------------------------------------------------------------------

    def facts(self, known: Answers) -> tuple[Fact, ...]:
        """Return what is known of the test, in the order of the scenarios."""
        entry, alone = self.entry, known.get(f"{self.name}-runs")
        if alone is None or alone.drive is None:
            return (_alone(entry, alone),)
        shown = names_shown(alone.drive, self.asked)
        facts = [Fact(entry.id, "", "runs", entry.query, drive=alone.drive, also=shown)]
        facts += [self._fact(name, query, known) for name, query in self.scenarios.items()]
        implied = self.implied(shown, self._drives(known), alone.drive)
        others = ((name, query) for name, query in implied if name not in self.scenarios)
        facts += [x for name, query in others if (x := self._proved(name, query, known)) is not None]
        return tuple(facts)

    def _drives(self, known: Answers) -> list[Sequence[str]]:
        """What each drive of the test shows."""
        names = [f"{self.name}-runs", *(self.named("shows", x) for x in self.scenarios)]
        drives = (known[x].drive for x in names if x in known)
        return [names_shown(x, self.asked) for x in drives if x is not None]

    def _proved(self, name: str, query: Query, known: Answers) -> Fact | None:
        answer = known.get(self.named("implies", name))
        if answer is None or answer.verdict is not Verdict.PROVED:
            return None
        return Fact(self.entry.id, name, "implies", self.entry.query, query, certificate=answer.certificate)

    def _fact(self, name: str, query: Query, known: Answers) -> Fact:
        """Return what the test is to a scenario."""
        implied = self._proved(name, query, known)
        if implied is not None:
            return implied
        answer = known.get(self.named("shows", name))
        fact = Fact(self.entry.id, name, "open", self.entry.query, query)
        if answer is None:
            return fact
        if answer.drive is not None:
            also = names_shown(answer.drive, self.asked)
            return replace(fact, relation="shows", drive=answer.drive, also=also)
        if answer.certificate is not None:
            return replace(fact, relation="excludes", certificate=answer.certificate)
        return replace(fact, reason=answer.reason or Why.NO_DRIVE())


def _alone(entry: Abstract, answer: Answer | None) -> Fact:
    """Return what is known of a test of which there is no drive."""
    if answer is not None and answer.certificate is not None:
        return Fact(entry.id, "", "empty", entry.query, certificate=answer.certificate)
    reason = NO_REASON if answer is None else answer.reason or Why.NO_DRIVE()
    return Fact(entry.id, "", "open", entry.query, reason=reason)


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
        file = self.drive.file
        formula = bind(self.other.query.formula, file.road, file.lanes, self.asked.values)
        judge = (LazyJudge if self.asked.is_always_judged else DriveJudge).on(file.drive)
        if judge.holds(at_start(formula)) and judge.holds(formula):
            yield (
                self.name,
                valid_under(self.basis.specification, implication(self.one.query, self.other.query)),
            )

    def facts(self, known: Answers) -> tuple[Fact, ...]:
        """Return that the first implies the second, where that is proved."""
        answer = known.get(self.name)
        if answer is None or answer.verdict is not Verdict.PROVED:
            return ()
        return (
            Fact(
                self.one.id,
                self.other.id,
                "implies",
                self.one.query,
                self.other.query,
                certificate=answer.certificate,
            ),
        )
