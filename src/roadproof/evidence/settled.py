"""What is known of a question that was settled, or is in doubt: each analysis adds what it is about."""

from typing import Generic, TypeVar

from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import JudgedDrive
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

Word = TypeVar("Word", bound=Verdict, covariant=True)


@dataclass(frozen=True, kw_only=True)
class Settled(Generic[Word]):
    """A verdict with the evidence that shows it, else with a reason; ``seconds`` that it took."""

    verdict: Word
    reason: Reason = NO_REASON
    certificate: Certificate | None = None
    drive: JudgedDrive | None = None
    seconds: float = 0.0

    @property
    def holds(self) -> bool:
        """Whether a claim is proved, be it because its premise never holds."""
        return self.verdict in (Verdict.PROVED, Verdict.VACUOUS)
