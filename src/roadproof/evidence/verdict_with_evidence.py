"""The base class of results: a verdict with its evidence. Each analysis adds what the result is about."""

from __future__ import annotations

from typing import TYPE_CHECKING, Generic, TypeVar

from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.records import dataclass
from roadproof.verdict import ProofVerdict, Verdict

if TYPE_CHECKING:
    from roadproof.evidence.certificate import Certificate
    from roadproof.evidence.judged import JudgedDrive

Word = TypeVar("Word", bound=Verdict, covariant=True)
Asked = TypeVar("Asked")


@dataclass(frozen=True, kw_only=True)
class VerdictWithEvidence(Generic[Word]):
    """A verdict with the evidence that shows it, or else a reason; ``seconds``: the time that it took."""

    verdict: Word
    reason: Reason = NO_REASON
    certificate: Certificate | None = None
    drive: JudgedDrive | None = None
    seconds: float = 0.0

    @property
    def holds(self) -> bool:
        """Return whether the claim is proved, possibly because its premise never holds."""
        return self.verdict in (Verdict.PROVED, Verdict.VACUOUS)


@dataclass(frozen=True)
class ProofResult(VerdictWithEvidence[ProofVerdict], Generic[Asked]):
    """The verdict on a claim: a certificate where it is proved, else a reason."""

    claim: Asked
