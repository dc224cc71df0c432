"""What one test with a formula implies, excludes and can show.

A drive of the test is looked for first. Scenarios that it does not show may be excluded, which is for the
prover; where they are not, a drive is looked for that shows them. Only what all these drives show may be
implied.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property

from roadproof.analysis.basis import Basis
from roadproof.analysis.catalogue.asked import Questions
from roadproof.analysis.catalogue.candidates import CandidateDrives
from roadproof.analysis.catalogue.entries import Abstract, Freedom
from roadproof.analysis.catalogue.fact import Fact
from roadproof.analysis.catalogue.showing import names_shown, shown_by
from roadproof.engines.prove.prover import SharedPremise
from roadproof.engines.search.ask import answer
from roadproof.engines.search.impossible import at_start
from roadproof.engines.search.outcome import Outcome, Search
from roadproof.engines.search.placing import judged_as
from roadproof.engines.search.question import SearchOptions, Setting
from roadproof.evidence.answers.catalogue_index import Relation
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import bind
from roadproof.library.compose import both
from roadproof.library.scenarios import Scenario, applied, name_of
from roadproof.library.specification import Query
from roadproof.reasons import Why
from roadproof.runtime.budget import BudgetExceeded
from roadproof.semantics.exact.exact import DriveJudge, LazyJudge
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class FormulaFacts:
    """A test with a formula, and what it is ``asked``; ``beside``: what is asked in further spec sets.

    ``found``: drives of the test, the first one first, each with the names of all that it shows. ``shared``:
    what proofs about the test learn from each other.
    """

    basis: Basis
    asked: Questions
    entry: Abstract
    beside: tuple[Questions, ...] = ()
    found: list[tuple[JudgedDrive, tuple[str, ...]]] = field(default_factory=list)
    shared: SharedPremise = field(default_factory=SharedPremise)

    def all(self) -> tuple[Fact, ...]:
        """All that is known of the test, but for other tests."""
        entry, outcome = self.entry, self._search(self.entry.query, explain=True)
        if not outcome.drives:
            return (self._without_drive(outcome),)
        drive = outcome.drives[0]
        shown = self._add(drive)
        alone = Fact(entry.id, "", "runs", entry.query, drive=drive, also=shown)
        scenarios = self.asked.scenarios_of(entry.query.vehicles)
        others = {name: self._of_another(name, x) for name, x in scenarios.items() if name not in shown}
        facts = [others.get(name) or self._of_shown(name, x) for name, x in scenarios.items()]
        facts += [fact for asked in self.beside for fact in self._in_set(asked, drive)]
        for name in (x for x in shown if x in self.asked.named.values()):
            implied = self._implied(name, self.asked.class_query(name))
            facts += [] if implied is None else [implied]
        return (alone, *facts)

    def _add(self, drive: JudgedDrive) -> tuple[str, ...]:
        """Keep a drive of the test; what it shows."""
        self.found.append((drive, names_shown(drive, self.asked)))
        return self.found[-1][1]

    def _without_drive(self, outcome: Outcome) -> Fact:
        entry = self.entry
        if outcome.impossibility is None:
            reason = outcome.told(()) or Why.NO_DRIVE()
            return Fact(entry.id, "", "open", entry.query, reason=reason)
        return Fact(entry.id, "", "empty", entry.query, certificate=outcome.impossibility.certificate)

    def _of_shown(self, name: str, query: Query) -> Fact:
        """A scenario that the first drive shows."""
        drive, names = self.found[0]
        fact = Fact(self.entry.id, name, "shows", self.entry.query, query, also=names)
        judged = judged_as(drive.file, fact.query, self.basis.library)
        return self._implied(name, query) or replace(fact, drive=judged)

    def _of_another(self, name: str, query: Query) -> Fact:
        """A scenario that the first drive does not show."""
        candidate = self._candidates.find(name, query)
        if candidate is not None:
            return self._shown_by(name, query, candidate)
        return self._proved(name, "excludes", query) or self._looked_for(name, query)

    @cached_property
    def _candidates(self) -> CandidateDrives:
        return CandidateDrives(self.basis, self.entry, *self.found[0])

    def _shown_by(self, name: str, query: Query, drive: JudgedDrive) -> Fact:
        """A scenario that a drive shows which is not known yet."""
        entry = self.entry
        return Fact(entry.id, name, "shows", entry.query, query, drive=drive, also=self._add(drive))

    def _looked_for(self, name: str, query: Query) -> Fact:
        entry, outcome = self.entry, self._search(both(self.entry.query, query), explain=False)
        if not outcome.drives:
            reason = outcome.told(()) or Why.NO_DRIVE()
            return Fact(entry.id, name, "open", entry.query, query, reason, exhausted=outcome.exhausted)
        return self._shown_by(name, query, outcome.drives[0])

    def _in_set(self, asked: Questions, drive: JudgedDrive) -> Iterator[Fact]:
        """The scenarios of another set that a test implies, among those that its drive shows."""
        shown = {x.what for x in shown_by(drive.file, asked, Freedom())}
        set_name = asked.specification.set_name
        for number in asked.numbers:
            if name_of(number) in shown:
                query = applied(self.basis.specification, Scenario(number, set_name))
                implied = self._proved(f"{name_of(number)}@{set_name}", "implies", query)
                yield from [] if implied is None else [implied]

    def _implied(self, name: str, query: Query) -> Fact | None:
        """That the test implies a scenario or a class, which all its drives show then."""
        if any(name not in names for _, names in self.found):
            return None
        return self._proved(name, "implies", query)

    def _proved(self, name: str, relation: Relation, conclusion: Query) -> Fact | None:
        return proved(
            self.basis, Fact(self.entry.id, name, relation, self.entry.query, conclusion), self.shared
        )

    def _search(self, query: Query, explain: bool) -> Outcome:
        setting = Setting(self.entry.road, vehicles=self.entry.vehicles, values=self.basis.values)
        options = SearchOptions("smooth", effort=self.basis.effort, explain=explain)
        return answer(Search(self.basis.specification, query, setting, options))


def proved(basis: Basis, fact: Fact, shared: SharedPremise) -> Fact | None:
    """The fact with a certificate; None where no proof is found. A drive satisfies its premise."""
    try:
        result = basis.proof_of(fact.query, shared=shared)
    except BudgetExceeded:
        return None
    return replace(fact, certificate=result.certificate) if result.verdict is Verdict.PROVED else None


def facts_of_pair(
    basis: Basis, asked: Questions, one: Abstract, other: Abstract, drive: JudgedDrive
) -> tuple[Fact, ...]:
    """That a test implies another one, where this is proved; ``drive`` is one of the first."""
    formula = bind(other.query.formula, drive.file.road, drive.file.lanes, asked.values)
    judge = (LazyJudge if asked.is_always_judged else DriveJudge).on(drive.file.drive)
    if not (judge.holds(at_start(formula)) and judge.holds(formula)):
        return ()
    implied = proved(basis, Fact(one.id, other.id, "implies", one.query, other.query), SharedPremise())
    return () if implied is None else (implied,)
