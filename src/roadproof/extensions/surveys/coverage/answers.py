"""Answers about the gaps of a spec set, and counts of gaps in recordings."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypedDict

from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.verdict_with_evidence import ProofResult, VerdictWithEvidence
from roadproof.extensions.surveys.coverage.classes import ScenarioPart
from roadproof.extensions.surveys.coverage.schema import (
    CountedVerdict,
    GapTraceData,
    NeedVerdict,
    SetVerdict,
    Traffic,
)
from roadproof.library.scenarios import LANE, PAIR
from roadproof.library.specification import Query
from roadproof.reasons import ReasonKind
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class NamedAnswer:
    """The answer to a claim, with its name."""

    name: str
    answer: ClaimAnswer

    @property
    def drive(self) -> JudgedDrive:
        """The drive that answers it."""
        assert self.answer.drive is not None
        return self.answer.drive


@dataclass(frozen=True)
class Gap:
    """A judged drive that the set misses: a near miss of a scenario, with its roles and lane.

    ``first``: the first wider set that catches it, or empty; ``caught_by``: the smallest choices of its
    definitions that do. ``classes``: the keys of all parts for which the drive is a near miss. ``elsewhere``:
    for whole components, the same motions as gaps on other roads, by road.
    """

    shown: NamedAnswer
    first: str
    caught_by: tuple[tuple[str, ...], ...]
    classes: tuple[str, ...]
    elsewhere: Mapping[str, NamedAnswer] = field(default_factory=dict)

    @property
    def drive(self) -> JudgedDrive:
        """The drive."""
        return self.shown.drive


@dataclass(frozen=True)
class ClassAnswer(VerdictWithEvidence[CountedVerdict]):
    """The answer about one class; ``part`` None is the class without a single condition to blame.

    WITNESSED: with gaps, one for each wider set that catches it first; ``none_for``: sets without such a gap.
    IMPOSSIBLE: with a certificate of ``claim``. UNKNOWN: with a reason. ``in_traffic``: its count in
    recordings, and ``trace`` the first occurrence. CROSSCHECK-FAILED: it occurs, but is proved empty.
    """

    part: ScenarioPart | None
    gaps: tuple[Gap, ...] = ()
    claim: Query | None = None
    none_for: tuple[str, ...] = ()
    in_traffic: int | None = None
    trace: str = ""
    proof: NamedAnswer | None = None


Answers = tuple[ClassAnswer, ...]


@dataclass(frozen=True)
class Need(VerdictWithEvidence[NeedVerdict]):
    """The answer whether a set needs a definition that it replaces in the set ``parent``.

    WITNESSED: ``drive`` is missed without the definition, and caught with it. PROVED: the set covers
    everything without it, too. UNKNOWN: neither was found. The formula of the drive has all definitions
    written out, because no shipped set lacks just this one.
    """

    definition: str
    parent: str
    shown: NamedAnswer | None = None


class ClassNames(TypedDict):
    """The fields that tell one class of gaps from another."""

    scenario: int | None
    component: str
    description: str
    condition: str


def names_of(part: ScenarioPart | None) -> ClassNames:
    """Return the name of a class: the scenario, component and condition to blame."""
    return {
        "scenario": None if part is None else part.scenario,
        "component": "" if part is None else part.component,
        "description": "" if part is None else part.description,
        "condition": "" if part is None else part.condition,
    }


def in_role(file: DriveFile, turned: bool, lane: str | None) -> DriveFile:
    """Return the drive with ``lane`` for L; ``turned``: with the roles of SV and POV swapped."""
    roles = dict(zip(PAIR, PAIR[::-1] if turned else PAIR, strict=True))
    return replace(file, drive=file.drive.cast(roles), lanes={} if lane is None else {LANE: lane})


@dataclass(frozen=True)
class GapTrace:
    """A disturbance between two vehicles of a recording; ``missed``: no scenario holds on it.

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
        """The keys of its classes; '' is the class without a single condition to blame."""
        return (*self.classes, "") if self.alone else self.classes


@dataclass(frozen=True)
class GapTraffic:
    """The disturbances of recordings; ``repeats``: the number that earlier windows showed already.

    ``left_out``: notes on vehicles that recordings were read without.
    """

    folder: Path
    disturbances: int
    missed: tuple[GapTrace, ...]
    repeats: int
    left_out: tuple[str, ...] = ()

    @property
    def data(self) -> Traffic:
        """The traffic as plain data."""
        traces = tuple(GapTraceData(recording=x.recording, pair=x.pair, classes=x.keys) for x in self.missed)
        return Traffic(
            recordings=str(self.folder), disturbances=self.disturbances, repeats=self.repeats, missed=traces
        )


def with_counts(answer: ClassAnswer, traffic: GapTraffic) -> ClassAnswer:
    """Return the answer with the count of its class; CROSSCHECK-FAILED if it occurs, but is proved empty."""
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
    return replace(seen, verdict=verdict, reason=ReasonKind.OCCURS(where))


# --- all answers together --------------------------------------------------------------------------


@dataclass(frozen=True)
class GapSurvey:
    """The answers about a set: claims of coverage, classes of gaps, and definitions that are needed."""

    claims: tuple[ProofResult[Query], ...]
    classes: tuple[ClassAnswer, ...]
    needs: tuple[Need, ...]
    traffic: GapTraffic | None = None

    @property
    def verdict(self) -> SetVerdict:
        return verdict_on(self.claims, self.classes, self.traffic)


def with_traffic(survey: GapSurvey, traffic: GapTraffic) -> GapSurvey:
    """Return the answers with counts of each class in recordings."""
    classes = tuple(with_counts(x, traffic) for x in survey.classes)
    return replace(survey, classes=classes, traffic=traffic)


def is_covered(claims: Sequence[ProofResult[Query]]) -> bool:
    """Return whether the set is proved to have no gap."""
    return all(claim.verdict is Verdict.PROVED for claim in claims)


def verdict_on(
    claims: Sequence[ProofResult[Query]], classes: Sequence[ClassAnswer], traffic: GapTraffic | None
) -> SetVerdict:
    """Return the verdict on a set: CROSSCHECK-FAILED if traffic contradicts a proof."""
    proved = is_covered(claims)
    if any(x.verdict is Verdict.CROSSCHECK_FAILED for x in classes):
        return Verdict.CROSSCHECK_FAILED
    if proved and traffic is not None and traffic.missed:
        return Verdict.CROSSCHECK_FAILED
    if proved:
        return Verdict.COVERED
    return Verdict.GAPS if any(x.gaps for x in classes) else Verdict.UNKNOWN
