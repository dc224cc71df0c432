"""What is known of a test or a target, with its evidence, and the same as plain data."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from roadproof.analysis.study.evidence_store import EvidenceStore
from roadproof.evidence.answers.catalogue_index import VERDICTS, FactVerdict, KeptFact, Relation
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.strict import rational
from roadproof.library.compose import both, implication, negation
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Query, Specification
from roadproof.reasons import NO_REASON, Reason


@dataclass(frozen=True)
class Fact:
    """What a test is to ``other``: a scenario, class or test by name, or "" for the test alone.

    ``relation``: to a scenario or a test it is proved (implies, excludes) or shown by a drive (shows); a test
    alone has a drive (runs) or a proof that there is none (empty); of a scenario or class there is a drive at
    the end of a range (reaches); open: none of these was found. ``premise`` is the formula of the test,
    ``conclusion`` that of the other. ``also``: of a drive, all names that it shows. ``term``, ``sense`` and
    ``at`` (SI): which number of its start is least or greatest there. ``exhausted``: left open by a search
    that finds no more with the same work; not kept.
    """

    test: str
    other: str
    relation: Relation
    premise: Query
    conclusion: Query | None = None
    reason: Reason = NO_REASON
    certificate: Certificate | None = None
    drive: JudgedDrive | None = None
    also: tuple[str, ...] = ()
    term: str = ""
    sense: Literal["", "least", "greatest"] = ""
    at: Fraction | None = None
    exhausted: bool = False

    @property
    def verdict(self) -> FactVerdict:
        return VERDICTS[self.relation]

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


def record_of(fact: Fact, name: str, shelf: EvidenceStore) -> KeptFact:
    """A fact as it is kept; its evidence goes to the shelf."""
    return KeptFact(
        test=fact.test,
        other=fact.other,
        relation=fact.relation,
        premise=fact.premise.text,
        conclusion=None if fact.conclusion is None else fact.conclusion.text,
        formula=fact.query.text,
        verdict=fact.verdict,
        reason=fact.reason,
        certificate=shelf.certificate(f"proofs/{name}.json", fact.certificate),
        drive=shelf.drive(f"drives/{name}.json", fact.drive),
        also=fact.also,
        term=fact.term,
        sense=fact.sense,
        at=None if fact.at is None else str(fact.at),
    )


def read_fact(said: KeptFact, specification: Specification, shelf: EvidenceStore) -> Fact:
    """The inverse of ``record_of``. Raises ``InputError``."""
    return Fact(
        said.test,
        said.other,
        said.relation,
        read_claim(specification, said.premise),
        None if said.conclusion is None else read_claim(specification, said.conclusion),
        said.reason,
        shelf.read_certificate(said.certificate),
        shelf.read_drive(said.drive),
        said.also,
        said.term,
        said.sense,
        None if said.at is None else rational(said.at, "at"),
    )
