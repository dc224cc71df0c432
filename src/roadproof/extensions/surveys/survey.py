"""Surveys: whether each of some formulas can hold on a drive, by name."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from functools import cached_property
from typing import Annotated, Any, ClassVar, Final, Literal, Self

from roadproof.evidence.answer import Answer
from roadproof.evidence.answers import shared
from roadproof.evidence.claim import Claim
from roadproof.evidence.codec import Doc, Rule, read
from roadproof.library.specification import Query
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, Place, Steps, heading_of
from roadproof.reasons import NO_REASON
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict, Verdict

SCHEMA: Final = "roadproof/survey/1"


@dataclass(frozen=True, kw_only=True)
class Among:
    """Which scenarios a survey is about."""

    numbers: Annotated[tuple[shared.Number, ...], Rule(least=1), Doc("Numbers of scenarios.")]


@dataclass(frozen=True)
class Survey(ABC):
    """A question with a formula for each of some names.

    A survey of your own is a subclass that says ``kind`` and ``queries``.
    """

    kind: ClassVar[str]
    basis: Basis
    asked: Among

    @property
    @abstractmethod
    def queries(self) -> Mapping[str, Query]:
        """The formulas, each of which may hold on a drive, by name. Names are those of files."""

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, self.basis.proof, explain=True)

    @classmethod
    def of(cls, basis: Basis, asked: object, where: str) -> Self:
        """Return the survey that plain data ask. Raises ``InputError``."""
        return cls(basis, read(Among, asked, where))

    @cached_property
    def claims(self) -> Mapping[str, Claim]:
        """The claims that there are drives, by name."""
        return {name: self.basis.claim(query) for name, query in self.queries.items()}

    def batches(self, known: Answers) -> list["SurveyBatch"]:
        """A batch for each claim."""
        return [SurveyBatch(name, claim) for name, claim in self.claims.items()]

    def label(self, name: str) -> str:
        """Return the name."""
        return name

    def view(self, known: Answers) -> Mapping[str, Answer | None]:
        """Return the answers by name; None where a claim is not settled."""
        return {name: known.get(name) for name in self.claims}

    def data(self, view: Mapping[str, Answer | None], place: Place, seconds: float) -> "SurveyData":
        """Return the answers as ``--json`` prints them."""
        said: dict[str, Any] = {"set": self.basis.specification.set_name, **self.basis.said()}
        verdicts = tuple(
            SurveyEntry(
                name=name,
                formula=self.claims[name].text,
                verdict=verdict_of(x),
                evidence=place(name, x) if x is not None and x.is_final else None,
                reason=NO_REASON if x is None else x.reason,
            )
            for name, x in view.items()
        )
        return SurveyData(
            **heading_of(SCHEMA, self.basis), **said, survey=self.kind, seconds=seconds, verdicts=verdicts
        )


@dataclass(frozen=True)
class SurveyBatch:
    """One claim."""

    name: str
    claim: Claim

    def steps(self) -> Steps:
        """Yield the claim."""
        yield self.name, self.claim


def verdict_of(answer: Answer | None) -> DriveVerdict:
    """Return the verdict on a formula; UNKNOWN where it is not settled."""
    match Verdict.UNKNOWN if answer is None else answer.verdict:
        case Verdict.WITNESSED | Verdict.IMPOSSIBLE | Verdict.NONE_WITHIN as found:
            return found
        case _:
            return Verdict.UNKNOWN


@dataclass(frozen=True, kw_only=True)
class SurveyEntry:
    """Whether a formula can hold on a drive."""

    name: str
    formula: shared.Formula
    verdict: DriveVerdict
    evidence: Annotated[object, Doc("A drive, or a certificate that parts of the formula clash; or null.")]
    reason: shared.Reason = NO_REASON


@dataclass(frozen=True, kw_only=True)
class SurveyData(shared.Heading):
    """Which of some formulas can hold on a drive."""

    schema: Literal["roadproof/survey/1"] = SCHEMA
    survey: Annotated[str, Doc("The command that asks it.")]
    set: shared.SetName
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    verdicts: tuple[SurveyEntry, ...]
