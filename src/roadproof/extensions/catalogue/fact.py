"""What is known of a test or a target, with its evidence."""

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from roadproof.evidence.answer import Answer
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import JudgedDrive
from roadproof.extensions.catalogue.kept import VERDICTS, FactVerdict, Relation
from roadproof.library.compose import both, implication, negation
from roadproof.library.scenarios import number_in
from roadproof.library.specification import Query
from roadproof.reasons import NO_REASON, Reason


@dataclass(frozen=True)
class Fact:
    """What a test is to ``other``: a scenario, class or test by name, or "" for the test alone.

    ``relation``: to a scenario or a test it is proved (implies, excludes) or shown by a drive (shows); a test
    alone has a drive (runs) or a proof that there is none (empty); of a scenario or class there is a drive at
    the end of a range (reaches); open: none of these was found. ``premise`` is the formula of the test,
    ``conclusion`` that of the other. ``also``: of a drive, all names that it shows. ``term``, ``sense`` and
    ``at`` (SI): which number of its start is least or greatest there. ``name`` and ``answer``: of the claim
    that shows it.
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
    answer: Answer | None = None

    @property
    def certificate(self) -> Certificate | None:
        """The proof, if there is one."""
        return None if self.answer is None else self.answer.certificate

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


def scenarios_shown(facts: Iterable[Fact]) -> tuple[str, ...]:
    """The scenarios that a test implies, or that the first drive of it shows."""
    named = [
        (x.other,) if x.relation == "implies" else x.also for x in facts if x.relation in ("implies", "runs")
    ]
    shown = [name for those in named for name in those]
    return tuple(dict.fromkeys(x for x in shown if number_in(x) is not None))
