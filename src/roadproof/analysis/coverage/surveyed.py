"""All answers to a survey together, and the verdict on the set."""

from collections.abc import Sequence
from dataclasses import dataclass

from roadproof.analysis.coverage.answers import ClassAnswer
from roadproof.analysis.coverage.claims import CoverageResult
from roadproof.analysis.coverage.needed import Need
from roadproof.analysis.coverage.occurring import GapTraffic
from roadproof.evidence.answers.coverage import SetVerdict
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class Survey:
    """All answers together: claims that there is no gap, the classes of gaps, definitions that are needed."""

    claims: tuple[CoverageResult, ...]
    classes: tuple[ClassAnswer, ...]
    needs: tuple[Need, ...]
    traffic: GapTraffic | None = None

    @property
    def verdict(self) -> SetVerdict:
        return verdict_on(self.claims, self.classes, self.traffic)


def is_covered(claims: Sequence[CoverageResult]) -> bool:
    """Whether the set is proved to have no gap."""
    return all(claim.verdict is Verdict.PROVED for claim in claims)


def verdict_on(
    claims: Sequence[CoverageResult], classes: Sequence[ClassAnswer], traffic: GapTraffic | None
) -> SetVerdict:
    """The verdict on a set: CROSSCHECK-FAILED where traffic shows what is proved not to be."""
    proved = is_covered(claims)
    if any(x.verdict is Verdict.CROSSCHECK_FAILED for x in classes):
        return Verdict.CROSSCHECK_FAILED
    if proved and traffic is not None and traffic.missed:
        return Verdict.CROSSCHECK_FAILED
    if proved:
        return Verdict.COVERED
    return Verdict.GAPS if any(x.gaps for x in classes) else Verdict.UNKNOWN
