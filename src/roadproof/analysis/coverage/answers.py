"""What came out for a class of gaps, how often it occurs in recordings, and the same as plain data."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeAlias, TypedDict

from roadproof.analysis.basis import ProofResult
from roadproof.analysis.coverage.classes import GapGroup, Part
from roadproof.analysis.coverage.found import FoundGap, Need
from roadproof.analysis.study.evidence_store import EvidenceStore
from roadproof.errors import InputError
from roadproof.evidence.answers import coverage as kept
from roadproof.evidence.answers.coverage import MissedTrace, SetVerdict, Traffic
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.settled import Settled
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Query, Specification
from roadproof.reasons import NO_REASON, Reason, Why
from roadproof.verdict import Verdict


@dataclass(frozen=True)
class Gap:
    """A judged drive that the set misses, near to the scenario of a class in roles and lane of its formula.

    ``first``: the first of the wider sets that catches it, or empty, and ``caught_by`` the smallest choices
    of definitions of that set that do; ``classes``: the keys of all parts for which it is a near miss.
    ``elsewhere``: by road the same motions as gaps there, as near to the scenario's counterpart; they are
    given for whole components.
    """

    drive: JudgedDrive
    first: str
    caught_by: tuple[tuple[str, ...], ...]
    classes: tuple[str, ...]
    elsewhere: Mapping[str, JudgedDrive] = field(default_factory=dict)


@dataclass(frozen=True)
class ClassAnswer(Settled[kept.CountedVerdict]):
    """What came out for one class; ``part`` None is the class for which no single condition is to blame.

    WITNESSED with gaps that differ in the wider set that catches them first, ``none_for`` being the sets
    for which none was found; IMPOSSIBLE with a certificate of ``claim``; UNKNOWN with a reason. Where
    recordings were looked at, ``in_traffic`` says how often it occurs there, and ``trace`` where first;
    CROSSCHECK-FAILED where it does although it is proved empty.
    """

    part: Part | None
    gaps: tuple[Gap, ...] = ()
    claim: Query | None = None
    none_for: tuple[str, ...] = ()
    in_traffic: int | None = None
    trace: str = ""


Answers = tuple[ClassAnswer, ...]


def group_name(group: GapGroup) -> str:
    """Under which name the answers for a group are kept."""
    return group.title.replace(" ", "-")


def record_of(group: GapGroup, answers: Answers, shelf: EvidenceStore) -> kept.Record:
    """The answers for a group as they are kept; their evidence goes to the shelf."""
    stems = (f"{group_name(group)}-{k}" for k in range(len(answers)))
    classes = tuple(_kept_class(x, stem, shelf) for stem, x in zip(stems, answers, strict=True))
    return kept.Record(group=group.title, classes=classes)


def _kept_class(answer: ClassAnswer, stem: str, shelf: EvidenceStore) -> kept.KeptClass:
    assert answer.verdict is not Verdict.CROSSCHECK_FAILED  # that is said of recordings alone
    return kept.KeptClass(
        **names_of(answer.part),
        verdict=answer.verdict,
        gaps=tuple(_kept_gap(gap, f"gap-{stem}-{n}", shelf) for n, gap in enumerate(answer.gaps, 1)),
        claim="" if answer.claim is None else answer.claim.text,
        certificate=shelf.certificate(f"empty-{stem}.json", answer.certificate),
        reason=answer.reason,
        none_for=answer.none_for,
    )


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


def _kept_gap(gap: Gap, name: str, shelf: EvidenceStore) -> kept.Gap:
    file = gap.drive.file
    return kept.Gap(
        road=file.road.name,
        formula=file.formula,
        first=gap.first,
        caught_by=gap.caught_by,
        classes=gap.classes,
        drive=shelf.drive(f"{name}.json", gap.drive),
        elsewhere={road: shelf.drive(f"{name}-{road}.json", drive) for road, drive in gap.elsewhere.items()},
    )


def answers_in(
    classes: Sequence[kept.KeptClass], group: GapGroup, specification: Specification, shelf: EvidenceStore
) -> Answers:
    """The inverse of ``record_of``, with every drive judged again. Raises ``InputError``."""
    named = [{name: getattr(x, name) for name in names_of(None)} for x in classes]
    if named != [names_of(part) for part in group.parts]:
        raise InputError(f"the classes that are kept of {group.title} are not its own")
    found = zip(group.parts, classes, strict=True)
    return tuple(_read_class(part, said, specification, shelf) for part, said in found)


def _read_class(
    part: Part | None, said: kept.KeptClass, specification: Specification, shelf: EvidenceStore
) -> ClassAnswer:
    return ClassAnswer(
        part,
        verdict=said.verdict,
        gaps=tuple(_read_gap(gap, shelf) for gap in said.gaps),
        claim=read_claim(specification, said.claim) if said.claim else None,
        certificate=shelf.read_certificate(said.certificate),
        reason=said.reason,
        none_for=said.none_for,
    )


def _read_gap(said: kept.Gap, shelf: EvidenceStore) -> Gap:
    drives = {road: shelf.read_drive(file) for road, file in said.elsewhere.items()}
    drive = shelf.read_drive(said.drive)
    assert drive is not None
    there = {road: judged for road, judged in drives.items() if judged is not None}
    return Gap(drive, said.first, said.caught_by, said.classes, there)


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


@dataclass(frozen=True)
class CoverageClaim:
    number: int
    query: Query


@dataclass(frozen=True)
class NeededDefinition:
    name: str


@dataclass(frozen=True)
class Chunk:
    """Some of the simple drives, on one of the survey's roads."""

    road: int
    number: int


@dataclass(frozen=True)
class Component:
    """A group of classes by name, with gaps to begin with; ``lost``: why there may be too few of these."""

    name: str
    known: tuple[FoundGap, ...]
    lost: tuple[Reason, ...] = ()


@dataclass(frozen=True)
class GapScan:
    """The gaps in some of the simple drives; ``lost``: why it was not looked through."""

    found: tuple[FoundGap, ...]
    lost: Reason = NO_REASON


Piece: TypeAlias = CoverageClaim | NeededDefinition | Chunk | Component
Kept: TypeAlias = ProofResult[Query] | Need | GapScan | Answers


def name_of(piece: Piece) -> str:
    """Under which name the answer to a piece is known."""
    match piece:
        case CoverageClaim(number):
            return f"covered-{number}"
        case NeededDefinition(name):
            return f"needed-{name}"
        case Chunk(road, number):
            return f"simple-{road}-{number}"
        case Component(name):
            return name
