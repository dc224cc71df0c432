"""What came out for a class of gaps, how often it occurs in recordings, and the same as plain data."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypedDict

from roadproof.evidence.answer import Answer
from roadproof.evidence.drive_file import DriveFile
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.settled import Settled
from roadproof.extensions.surveys.coverage.classes import Part
from roadproof.extensions.surveys.coverage.kept import (
    CountedVerdict,
    MissedTrace,
    NeedVerdict,
    SetVerdict,
    Traffic,
)
from roadproof.library.scenarios import LANE, PAIR
from roadproof.library.specification import Query
from roadproof.questions.basis import ProofResult
from roadproof.reasons import Why
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class Shown:
    """The answer to a claim, with its name."""

    name: str
    answer: Answer

    @property
    def drive(self) -> JudgedDrive:
        """The drive that answers it."""
        assert self.answer.drive is not None
        return self.answer.drive


@dataclass(frozen=True)
class Gap:
    """A judged drive that the set misses, near to the scenario of a class in roles and lane of its formula.

    ``first``: the first of the wider sets that catches it, or empty, and ``caught_by`` the smallest choices
    of definitions of that set that do; ``classes``: the keys of all parts for which it is a near miss.
    ``elsewhere``: by road the same motions as gaps there, as near to the scenario's counterpart; they are
    given for whole components.
    """

    shown: Shown
    first: str
    caught_by: tuple[tuple[str, ...], ...]
    classes: tuple[str, ...]
    elsewhere: Mapping[str, Shown] = field(default_factory=dict)

    @property
    def drive(self) -> JudgedDrive:
        """The drive."""
        return self.shown.drive


@dataclass(frozen=True)
class ClassAnswer(Settled[CountedVerdict]):
    """What came out for one class; ``part`` None is the class for which no single condition is to blame.

    WITNESSED with gaps that differ in the wider set that catches them first, ``none_for`` being the sets
    for which none was found; IMPOSSIBLE with a certificate of ``claim``, the answer of that ``name``; UNKNOWN
    with a reason. Where recordings were looked at, ``in_traffic`` says how often it occurs there, and
    ``trace`` where first; CROSSCHECK-FAILED where it does although it is proved empty.
    """

    part: Part | None
    gaps: tuple[Gap, ...] = ()
    claim: Query | None = None
    none_for: tuple[str, ...] = ()
    in_traffic: int | None = None
    trace: str = ""
    proof: Shown | None = None


Answers = tuple[ClassAnswer, ...]


@dataclass(frozen=True)
class Need(Settled[NeedVerdict]):
    """WITNESSED: ``drive`` is missed without the definition, as it is in ``parent``, and caught with it.

    PROVED: the set covers everything without it, too. UNKNOWN: neither was found. The formula of the drive
    says what is missed with all definitions written out, as no shipped set is the one without the definition.
    """

    definition: str
    parent: str
    shown: Shown | None = None


class ClassNames(TypedDict):
    """The fields that tell one class of gaps from another."""

    scenario: int | None
    component: str
    description: str
    condition: str


def names_of(part: Part | None) -> ClassNames:
    """What a class is called: the scenario, component and condition to blame."""
    return {
        "scenario": None if part is None else part.scenario,
        "component": "" if part is None else part.component,
        "description": "" if part is None else part.description,
        "condition": "" if part is None else part.condition,
    }


def in_role(file: DriveFile, turned: bool, lane: str | None) -> DriveFile:
    """The drive in which L is a lane; ``turned``: with SV and POV in each other's role."""
    roles = dict(zip(PAIR, PAIR[::-1] if turned else PAIR, strict=True))
    return replace(file, drive=file.drive.cast(roles), lanes={} if lane is None else {LANE: lane})


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
    """What recordings hold. ``repeats``: how many disturbances an earlier window has shown already.

    ``left_out``: notes on vehicles that recordings were read without.
    """

    folder: Path
    disturbances: int
    missed: tuple[GapTrace, ...]
    repeats: int
    left_out: tuple[str, ...] = ()

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
    return replace(seen, verdict=verdict, reason=Why.OCCURS(where))


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


def with_traffic(survey: Survey, traffic: GapTraffic) -> Survey:
    """Return what is known with how often each class occurs in recordings."""
    classes = tuple(with_counts(x, traffic) for x in survey.classes)
    return replace(survey, classes=classes, traffic=traffic)


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
