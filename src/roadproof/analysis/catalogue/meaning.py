"""What abstract tests mean: which scenarios and tests each implies or excludes, and what it can show.

A test is run once, by a drive that is looked for. What that drive shows may be implied by the test, what it
does not show may be excluded: both are for the prover, in dense time and on all roads. Where a scenario is
not excluded, a drive of the test is looked for that shows it.
"""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, TypeAlias, get_args

from roadproof.analysis.basis import Basis
from roadproof.analysis.catalogue.asked import Asked
from roadproof.analysis.catalogue.entries import Abstract
from roadproof.analysis.catalogue.showing import Freedom, shown_by
from roadproof.analysis.placing import judged_as
from roadproof.effort import Late
from roadproof.errors import InputError
from roadproof.evidence.answers.catalogue import SCHEMA
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import Judged
from roadproof.judge.exact import judge
from roadproof.searching.ask import Outcome, Search, answer
from roadproof.searching.question import SearchOptions, Setting
from roadproof.spec.bind import bind
from roadproof.spec.compose import both, implication, negation
from roadproof.spec.elaborate import read_claim
from roadproof.spec.query import Query
from roadproof.study.shelf import Question, Shelf
from roadproof.verdict import Verdict

Relation: TypeAlias = Literal["implies", "excludes", "shows", "runs", "empty", "open"]
"""Of a test to a scenario or test: proved, proved, shown by a drive. Of a test alone: a drive, or a proof
that there is none. ``open``: nothing of this was found."""
_VERDICTS: Mapping[Relation, Verdict] = {
    "implies": Verdict.PROVED,
    "excludes": Verdict.PROVED,
    "shows": Verdict.WITNESSED,
    "runs": Verdict.WITNESSED,
    "empty": Verdict.IMPOSSIBLE,
    "open": Verdict.UNKNOWN,
}


@dataclass(frozen=True)
class Fact:
    """What a test is to ``other``: a scenario, class or test by name, or "" for the test alone.

    ``premise`` is the formula of the test, ``conclusion`` that of the other. ``also``: of a drive, all names
    that it shows.
    """

    test: str
    other: str
    relation: Relation
    premise: Query
    conclusion: Query | None = None
    reason: str = ""
    certificate: Certificate | None = None
    drive: Judged | None = None
    also: tuple[str, ...] = ()

    @property
    def verdict(self) -> Verdict:
        return _VERDICTS[self.relation]

    @property
    def query(self) -> Query:
        """What the evidence is about."""
        if self.conclusion is None:
            return self.premise
        match self.relation:
            case "implies":
                return implication(self.premise, self.conclusion)
            case "excludes":
                return implication(self.premise, negation(self.conclusion))
            case _:
                return both(self.premise, self.conclusion)


@dataclass(frozen=True)
class Pair:
    """Two abstract tests, of which the first may imply the second; ``drive`` is one of the first."""

    one: Abstract
    other: Abstract
    drive: Judged


Piece: TypeAlias = Abstract | Pair
Facts: TypeAlias = tuple[Fact, ...]
Names: TypeAlias = tuple[str, ...]


@dataclass(frozen=True)
class Meanings:
    """The question for all that is known of abstract tests, as a ``study.frame.Study``."""

    basis: Basis
    entries: tuple[Abstract, ...]
    asked: Asked

    @property
    def question(self) -> Question:
        said = {"set": self.basis.specification.set_name, "scenarios": list(self.asked.numbers)}
        tests = {x.id: repr((x.query.text, x.road, sorted(x.vehicles.items()))) for x in self.entries}
        return Question(SCHEMA, said | self.basis.said(), tests, self.basis.library)

    def pieces(self, known: Mapping[str, Facts]) -> Sequence[Piece]:
        """Each test; when all are known, pairs of them: what a drive does not share is not implied."""
        left = [entry for entry in self.entries if _name(entry.id) not in known]
        if left:
            return left
        drives = {entry.id: _drive(known[_name(entry.id)]) for entry in self.entries}
        return [
            Pair(one, other, drive)
            for one in self.entries
            for other in self.entries
            if one is not other
            and set(other.query.vehicles) <= set(one.query.vehicles)
            and (drive := drives[one.id]) is not None
            and _name(one.id, other.id) not in known
        ]

    def settle(self, piece: Piece) -> dict[str, Facts]:
        match piece:
            case Pair(one, other, drive):
                return {_name(one.id, other.id): self._implied(one, other, drive)}
            case Abstract():
                return {_name(piece.id): self._of_test(piece)}

    def _of_test(self, entry: Abstract) -> Facts:
        outcome = self._search(entry, entry.query, explain=True)
        if not outcome.drives:
            return (self._without_drive(entry, outcome),)
        drive = outcome.drives[0]
        shown = self._shown(drive)
        alone = Fact(entry.id, "", "runs", entry.query, drive=drive, also=shown)
        scenarios = self.asked.scenarios_of(entry.query.vehicles)
        found = [self._of_scenario(entry, name, query, drive, shown) for name, query in scenarios.items()]
        for name in (x for x in shown if x in self.asked.named.values()):
            implied = self._proved(entry, name, "implies", self.asked.class_query(name))
            found += [] if implied is None else [implied]
        return (alone, *found)

    def _without_drive(self, entry: Abstract, outcome: Outcome) -> Fact:
        if outcome.impossibility is None:
            reason = outcome.told(()) or "no drive was found"
            return Fact(entry.id, "", "open", entry.query, reason=reason)
        return Fact(entry.id, "", "empty", entry.query, certificate=outcome.impossibility.certificate)

    def _of_scenario(self, entry: Abstract, name: str, query: Query, drive: Judged, shown: Names) -> Fact:
        if name in shown:
            here = Fact(entry.id, name, "shows", entry.query, query, also=shown)
            judged = judged_as(drive.file, here.query, self.basis.library)
            return self._proved(entry, name, "implies", query) or replace(here, drive=judged)
        return self._proved(entry, name, "excludes", query) or self._looked_for(entry, name, query)

    def _looked_for(self, entry: Abstract, name: str, query: Query) -> Fact:
        outcome = self._search(entry, both(entry.query, query), explain=False)
        if not outcome.drives:
            reason = outcome.told(()) or "no drive was found"
            return Fact(entry.id, name, "open", entry.query, query, reason)
        drive = outcome.drives[0]
        return Fact(entry.id, name, "shows", entry.query, query, drive=drive, also=self._shown(drive))

    def _implied(self, one: Abstract, other: Abstract, drive: Judged) -> Facts:
        formula = bind(other.query.formula, drive.file.road, drive.file.lanes, self.asked.values)
        if not judge(formula, drive.file.drive).holds:
            return ()
        implied = self._proved(one, other.id, "implies", other.query)
        return () if implied is None else (implied,)

    def _proved(self, entry: Abstract, name: str, relation: Relation, conclusion: Query) -> Fact | None:
        fact = Fact(entry.id, name, relation, entry.query, conclusion)
        try:
            result = self.basis.proof_of(fact.query)
        except Late:
            return None
        return replace(fact, certificate=result.certificate) if result.verdict is Verdict.PROVED else None

    def _search(self, entry: Abstract, query: Query, explain: bool) -> Outcome:
        setting = Setting(entry.road, vehicles=entry.vehicles, values=self.basis.values)
        options = SearchOptions("smooth", effort=self.basis.effort, explain=explain)
        return answer(Search(self.basis.specification, query, setting, options))

    def _shown(self, drive: Judged) -> tuple[str, ...]:
        return tuple(sorted({x.what for x in shown_by(drive.file, self.asked, Freedom())}))

    def doubt(self, piece: Piece, reason: str) -> dict[str, Facts]:
        match piece:
            case Pair(one, other):
                return {_name(one.id, other.id): ()}
            case Abstract():
                return {_name(piece.id): (Fact(piece.id, "", "open", piece.query, reason=reason),)}

    def is_sure(self, answer: Facts) -> bool:
        return all(fact.relation != "open" for fact in answer)

    def record(self, name: str, answer: Facts, shelf: Shelf) -> dict[str, Any]:
        return {"name": name, "facts": [_record(fact, f"{name}-{k}", shelf) for k, fact in enumerate(answer)]}

    def recall(self, record: Mapping[str, Any], shelf: Shelf) -> tuple[str, Facts]:
        return record["name"], tuple(self._recall(said, shelf) for said in record["facts"])

    def _recall(self, said: Mapping[str, Any], shelf: Shelf) -> Fact:
        relation = said["relation"]
        if relation not in get_args(Relation):
            raise InputError(f"relation={relation!r} is none of {', '.join(get_args(Relation))}")
        premise = read_claim(self.basis.specification, said["premise"])
        conclusion = said["conclusion"] and read_claim(self.basis.specification, said["conclusion"])
        certificate, drive = shelf.read_certificate(said["certificate"]), shelf.read_drive(said["drive"])
        told = said["test"], said["other"], relation, premise, conclusion or None, said["reason"]
        return Fact(*told, certificate, drive, tuple(said["also"]))


def _record(fact: Fact, name: str, shelf: Shelf) -> dict[str, Any]:
    return {
        "test": fact.test,
        "other": fact.other,
        "relation": fact.relation,
        "premise": fact.premise.text,
        "conclusion": None if fact.conclusion is None else fact.conclusion.text,
        "formula": fact.query.text,
        "verdict": str(fact.verdict),
        "reason": fact.reason,
        "certificate": shelf.certificate(f"proofs/{name}.json", fact.certificate),
        "drive": shelf.drive(f"drives/{name}.json", fact.drive),
        "also": list(fact.also),
    }


def _name(one: str, other: str = "") -> str:
    """A name for the answers about a test, or two, fit for a file."""
    digest = hashlib.sha256(json.dumps([one, other]).encode()).hexdigest()
    return f"test-{digest[:12]}"


def _drive(facts: Facts) -> Judged | None:
    return next((fact.drive for fact in facts if fact.relation == "runs"), None)
