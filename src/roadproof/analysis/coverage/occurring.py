"""How often classes of gaps occur in recordings, and whether that fits what is proved of them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from roadproof.analysis.basis import ProofResult
from roadproof.analysis.coverage.answers import ClassAnswer
from roadproof.analysis.coverage.needed import Need
from roadproof.evidence.answers.coverage import MissedTrace, SetVerdict, Traffic
from roadproof.library.specification import Query
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class GapTrace:
    """A disturbance between two vehicles of a recording; ``missed``: no scenario, any lane, either role.

    ``classes``: the keys of the parts without which a scenario would hold; ``alone``: whether no single
    condition is to blame.
    """

    recording: str
    first: int
    second: int
    frames: tuple[int, int]
    missed: bool
    classes: tuple[str, ...]
    alone: bool

    @property
    def pair(self) -> str:
        return f"{self.first} and {self.second}, frames {self.frames[0]} to {self.frames[1]}"

    @property
    def keys(self) -> tuple[str, ...]:
        """Its classes by their keys, that of gaps without a single condition to blame as ''."""
        return (*self.classes, "") if self.alone else self.classes


@dataclass(frozen=True)
class GapTraffic:
    """What recordings hold. ``repeats``: how many disturbances an earlier window has shown already."""

    folder: Path
    disturbances: int
    missed: tuple[GapTrace, ...]
    repeats: int

    @property
    def told(self) -> Traffic:
        """What an index says of it."""
        missed = tuple(MissedTrace(recording=x.recording, pair=x.pair, classes=x.keys) for x in self.missed)
        return Traffic(
            recordings=str(self.folder), disturbances=self.disturbances, repeats=self.repeats, missed=missed
        )


def with_counts(answer: ClassAnswer, traffic: GapTraffic) -> ClassAnswer:
    """The answer with how often its class occurs. One that is proved empty and occurs is our fault."""
    key = "" if answer.part is None else answer.part.key
    traces = [trace for trace in traffic.missed if key in trace.keys]
    if not traces:
        return replace(answer, in_traffic=0)
    where = f"recording {traces[0].recording}, vehicles {traces[0].pair}"
    seen = replace(answer, in_traffic=len(traces), trace=where)
    if answer.verdict is Verdict.WITNESSED:
        return seen
    broken = answer.verdict is Verdict.IMPOSSIBLE
    verdict = Verdict.CROSSCHECK_FAILED if broken else answer.verdict
    return replace(seen, verdict=verdict, reason=f"occurs in {where}")


# --- all answers together --------------------------------------------------------------------------


@dataclass(frozen=True)
class Survey:
    """All answers together: claims that there is no gap, the classes of gaps, definitions that are needed."""

    claims: tuple[ProofResult[Query], ...]
    classes: tuple[ClassAnswer, ...]
    needs: tuple[Need, ...]
    traffic: GapTraffic | None = None

    @property
    def verdict(self) -> SetVerdict:
        return verdict_on(self.claims, self.classes, self.traffic)


def is_covered(claims: Sequence[ProofResult[Query]]) -> bool:
    """Whether the set is proved to have no gap."""
    return all(claim.verdict is Verdict.PROVED for claim in claims)


def verdict_on(
    claims: Sequence[ProofResult[Query]], classes: Sequence[ClassAnswer], traffic: GapTraffic | None
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
