"""What is known of a test or a target, with its evidence, and the same as plain data."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Literal, TypeAlias, get_args

from roadproof.analysis.study.evidence_store import EvidenceStore
from roadproof.errors import InputError
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.strict import rational
from roadproof.library.compose import both, implication, negation
from roadproof.library.elaborate import read_claim
from roadproof.library.query import Query
from roadproof.library.specification import Specification
from roadproof.verdict import Verdict

Relation: TypeAlias = Literal["implies", "excludes", "shows", "runs", "empty", "reaches", "open"]
"""Of a test to a scenario or test: proved, proved, shown by a drive. Of a test alone: a drive, or a proof
that there is none. Of no test, to a scenario or class: a drive at the end of a range. ``open``: nothing of
this was found."""
_VERDICTS: Mapping[Relation, Verdict] = {
    "implies": Verdict.PROVED,
    "excludes": Verdict.PROVED,
    "shows": Verdict.WITNESSED,
    "runs": Verdict.WITNESSED,
    "empty": Verdict.IMPOSSIBLE,
    "reaches": Verdict.WITNESSED,
    "open": Verdict.UNKNOWN,
}


@dataclass(frozen=True)
class Fact:
    """What a test is to ``other``: a scenario, class or test by name, or "" for the test alone.

    ``premise`` is the formula of the test, ``conclusion`` that of the other. ``also``: of a drive, all names
    that it shows. ``term``, ``sense`` and ``at`` (SI): which number of its start is least or greatest there.
    """

    test: str
    other: str
    relation: Relation
    premise: Query
    conclusion: Query | None = None
    reason: str = ""
    certificate: Certificate | None = None
    drive: JudgedDrive | None = None
    also: tuple[str, ...] = ()
    term: str = ""
    sense: str = ""
    at: Fraction | None = None

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


def record_of(fact: Fact, name: str, shelf: EvidenceStore) -> dict[str, Any]:
    """A fact as plain data; its evidence goes to the shelf."""
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
        "term": fact.term,
        "sense": fact.sense,
        "at": None if fact.at is None else str(fact.at),
    }


def read_fact(said: Mapping[str, Any], specification: Specification, shelf: EvidenceStore) -> Fact:
    """The inverse of ``record_of``. Raises ``InputError``."""
    relation = said["relation"]
    if relation not in get_args(Relation):
        raise InputError(f"relation={relation!r} is none of {', '.join(get_args(Relation))}")
    premise = read_claim(specification, said["premise"])
    conclusion = said["conclusion"] and read_claim(specification, said["conclusion"])
    certificate, drive = shelf.read_certificate(said["certificate"]), shelf.read_drive(said["drive"])
    told = said["test"], said["other"], relation, premise, conclusion or None, said["reason"]
    at = None if said.get("at") is None else rational(said["at"], "at")
    measure = said.get("term", ""), said.get("sense", ""), at
    return Fact(*told, certificate, drive, tuple(said["also"]), *measure)
