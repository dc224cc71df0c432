"""Facts about a test with a formula or about a target, with evidence."""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.subject import OTHER, Subject, SubjectKind
from roadproof.extensions.catalogue.catalogue_data import VERDICTS, FactVerdict, Relation
from roadproof.library.compose import both, implication, negation
from roadproof.library.scenarios import number_in
from roadproof.library.specification import Query
from roadproof.reasons import NO_REASON, Reason


@dataclass(frozen=True)
class CatalogueFact:
    """A relation of a test to ``other``: a scenario, class or test by name, or "" for the test alone.

    ``relation``: implies and excludes are proved, shows has a drive. A test alone runs, with a drive, or is
    empty, with a proof. A target reaches the end of a range, with a drive. A relation without evidence is
    open. ``premise``: the formula of the test; ``conclusion``: that of the other. ``also``: the names of all
    targets that the drive shows. ``term``, ``sense`` and ``at`` (SI): the initial value that is least or
    greatest. ``name`` and ``answer``: those of the claim.
    """

    test: str
    other: str
    relation: Relation
    premise: Query
    conclusion: Query | None = None
    reason: Reason = NO_REASON
    drive: JudgedDrive | None = None
    also: tuple[str, ...] = ()
    term: str = ""
    sense: Literal["", "least", "greatest"] = ""
    at: Fraction | None = None
    name: str = ""
    answer: ClaimAnswer | None = None

    @property
    def certificate(self) -> Certificate | None:
        """The proof, if any."""
        return None if self.answer is None else self.answer.certificate

    @property
    def verdict(self) -> FactVerdict:
        """The verdict that the relation implies."""
        return VERDICTS[self.relation]

    @property
    def query(self) -> Query:
        """The formula of the evidence."""
        if self.conclusion is None:
            return self.premise
        match self.relation:
            case "implies":
                return implication(self.premise, self.conclusion)
            case "excludes":
                return implication(self.premise, negation(self.conclusion))
            case "shows" | "runs" | "empty" | "reaches" | "open":
                return both(self.premise, self.conclusion)


def scenarios_shown(facts: Iterable[CatalogueFact]) -> tuple[str, ...]:
    """Return the scenarios that a test implies, or that its first drive shows."""
    named = [
        (x.other,) if x.relation == "implies" else x.also for x in facts if x.relation in ("implies", "runs")
    ]
    shown = [name for those in named for name in those]
    return tuple(dict.fromkeys(x for x in shown if number_in(x) is not None))


def subject_of_fact(test: str, relation: str) -> Subject:
    """Return the subject of a fact of a catalogue; a fact without a test is about a scenario."""
    if not test:
        return OTHER
    return Subject(SubjectKind.RUN if relation == "runs" else SubjectKind.FACT, test)
