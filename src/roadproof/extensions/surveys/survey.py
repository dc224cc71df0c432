"""A base class of surveys, which ask for each of several formulas whether it can hold on a drive."""

from abc import ABC, abstractmethod
from collections.abc import Generator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, ClassVar, Final, Literal, Self

from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.answers import headings, shared
from roadproof.evidence.claim import Claim
from roadproof.evidence.codec import Doc, Rule, read
from roadproof.library.specification import Query
from roadproof.questions.basis import Basis
from roadproof.questions.question import Answers, EvidencePlace, Steps, heading_of
from roadproof.reasons import NO_REASON
from roadproof.runtime.budget import Work
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict, Verdict

if TYPE_CHECKING:
    from roadproof.questions.basis import Basis
    from roadproof.runtime.budget import Work
from roadproof.questions.question import T

SCHEMA: Final = "roadproof/survey/1"


@dataclass(frozen=True, kw_only=True)
class Among:
    """The scenarios of a survey."""

    numbers: Annotated[tuple[shared.Number, ...], Rule(least=1), Doc("Numbers of scenarios.")]


@dataclass(frozen=True)
class Survey(ABC):
    """A question about several formulas by name: can each hold on a drive?

    A survey of your own is a subclass that defines ``kind`` and ``queries``.
    """

    kind: ClassVar[str]
    basis: Basis
    settings: Among

    @property
    @abstractmethod
    def queries(self) -> Mapping[str, Query]:
        """The formulas by name; the names are used for files."""

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        return Work(self.basis.effort, self.basis.proof, explain=True)

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> Self:
        """Return the survey that plain data ask. Raises ``InputError``."""
        return cls(basis, read(Among, settings, where))

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

    def view(self, known: Answers) -> Mapping[str, ClaimAnswer | None]:
        """Return the answers by name; None where a claim is not settled."""
        return {name: known.get(name) for name in self.claims}

    def data(
        self, view: Mapping[str, ClaimAnswer | None], place: EvidencePlace, seconds: float
    ) -> "SurveyData":
        """Return the answers as ``--json`` prints them."""
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
            **heading_of(SCHEMA, self.basis),
            set=self.basis.specification.set_name,
            **self.basis.common_data(),
            survey=self.kind,
            seconds=seconds,
            verdicts=verdicts,
        )


@dataclass(frozen=True)
class SurveyBatch:
    """One claim."""

    name: str
    claim: Claim

    def steps(self) -> Steps:
        """Yield the claim."""
        yield self.name, self.claim


def verdict_of(answer: ClaimAnswer | None) -> DriveVerdict:
    """Return the verdict on a formula; UNKNOWN where it is not settled."""
    match Verdict.UNKNOWN if answer is None else answer.verdict:
        case Verdict.WITNESSED | Verdict.IMPOSSIBLE | Verdict.NONE_WITHIN as found:
            return found
        case Verdict.PROVED | Verdict.PROVED_BOUNDED | Verdict.REFUTED | Verdict.VACUOUS | Verdict.UNKNOWN:
            return Verdict.UNKNOWN
        case Verdict.DERIVED | Verdict.COVERED | Verdict.GAPS | Verdict.CROSSCHECK_FAILED:
            return Verdict.UNKNOWN


@dataclass(frozen=True, kw_only=True)
class SurveyEntry:
    """The answer whether a formula can hold on a drive."""

    name: str
    formula: shared.Formula
    verdict: DriveVerdict
    evidence: Annotated[object, Doc("A drive, or a certificate that parts of the formula clash; or null.")]
    reason: shared.Reason = NO_REASON


@dataclass(frozen=True, kw_only=True)
class SurveyData(headings.AnswerHeading):
    """The answers whether formulas can hold on drives."""

    schema: Literal["roadproof/survey/1"] = SCHEMA
    survey: Annotated[str, Doc("The command that asks it.")]
    set: shared.SetName
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    verdicts: tuple[SurveyEntry, ...]


def replay_steps(asking: Generator[tuple[str, Claim], ClaimAnswer, T], known: Answers) -> T:
    """Return what answers show; claims without one are in doubt."""
    try:
        name, claim = next(asking)
        while True:
            name, claim = asking.send(known.get(name) or undecided(claim, NO_REASON))
    except StopIteration as end:
        result: T = end.value
        return result
