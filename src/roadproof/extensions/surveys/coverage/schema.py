"""The JSON of ``coverage``: claims of coverage, classes of gaps, and definitions that are needed."""

from collections.abc import Mapping
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule
from roadproof.reasons import NO_REASON
from roadproof.runtime.records import dataclass
from roadproof.verdict import ProofVerdict, Verdict

SCHEMA: Final = "roadproof/coverage/2"
ClassVerdict: TypeAlias = Literal[Verdict.WITNESSED, Verdict.IMPOSSIBLE, Verdict.UNKNOWN]
CountedVerdict: TypeAlias = Literal[
    Verdict.WITNESSED, Verdict.IMPOSSIBLE, Verdict.UNKNOWN, Verdict.CROSSCHECK_FAILED
]
NeedVerdict: TypeAlias = Literal[Verdict.WITNESSED, Verdict.PROVED, Verdict.UNKNOWN]
SetVerdict: TypeAlias = Literal[Verdict.COVERED, Verdict.GAPS, Verdict.UNKNOWN, Verdict.CROSSCHECK_FAILED]
Names: TypeAlias = tuple[str, ...]
Road: TypeAlias = Annotated[str, Doc("Name of the road.")]
Position: TypeAlias = Annotated[int, Rule(minimum=1)]


@dataclass(frozen=True, kw_only=True)
class CoverageClaimData:
    """One of the claims that together say that there is no gap."""

    claim: shared.Formula
    verdict: ProofVerdict
    certificate: shared.CertificateField = None
    reason: shared.Reason = NO_REASON


@dataclass(frozen=True, kw_only=True)
class GapData:
    """A drive that the set misses, near to the scenario of a class."""

    road: Road
    formula: shared.Formula
    first: Annotated[str, Doc("The first of the wider sets that catches it; empty where none does.")]
    caught_by: Annotated[
        tuple[Names, ...], Doc("The smallest choices of definitions of that set which catch it.")
    ]
    classes: Annotated[Names, Doc("The parts for which it is a near miss.")]
    drive: shared.DriveField = None
    elsewhere: Annotated[
        Mapping[str, shared.DriveField], Doc("The same motions as gaps on other roads, by road.")
    ]


@dataclass(frozen=True, kw_only=True)
class OrderedEntry:
    """An entry with a rank among all of its kind."""

    number: Annotated[Position, Doc("Its place among all gaps.")]


@dataclass(frozen=True, kw_only=True)
class NumberedGap(GapData, OrderedEntry):
    """A drive that the set misses, by number."""


@dataclass(frozen=True, kw_only=True)
class GapClassData:
    """A class of gaps, by what of a scenario is false."""

    scenario: shared.OneScenario
    component: Annotated[
        str,
        Doc("The definition of the scenario that is false; empty where no single condition is to blame."),
    ]
    description: Annotated[str, Doc("The component in words.")]
    condition: Annotated[str, Doc("The condition of the component; empty where it is the whole.")]
    verdict: CountedVerdict
    gaps: tuple[GapData | int, ...]
    claim: Annotated[str, Doc("Of an IMPOSSIBLE: that the class is empty.")] = ""
    certificate: shared.CertificateField = None
    reason: shared.Reason = NO_REASON
    none_for: Annotated[Names, Doc("Wider sets for which no gap was found that they catch first.")] = ()


@dataclass(frozen=True, kw_only=True)
class GapClassDetail(GapClassData):
    """A class of gaps with its gaps."""

    verdict: ClassVerdict
    gaps: Annotated[tuple[GapData, ...], Doc("Its gaps.")]


@dataclass(frozen=True, kw_only=True)
class CountedClass(GapClassData):
    """A class of gaps in a view, which numbers its gaps."""

    gaps: Annotated[tuple[Position, ...], Doc("Numbers of its gaps.")]
    in_traffic: Annotated[
        shared.Count | None, LEFT_OUT, Doc("With --on: disturbances of the class in recordings.")
    ] = None
    trace: Annotated[str, Rule(least=1), LEFT_OUT, Doc("With --on: where the first of these is.")] = ""


@dataclass(frozen=True, kw_only=True)
class NeedData:
    """The answer whether a set without gaps needs one of its definitions."""

    definition: Annotated[str, Doc("The name of the definition.")]
    extends: Annotated[str, Doc("The set whose definition stands in its place in the formula.")]
    verdict: Annotated[NeedVerdict, Doc("PROVED: without the definition the set covers as much.")]
    road: Road
    formula: Annotated[str, Doc("What holds on the drive; empty where there is none.")]
    drive: shared.DriveField = None


@dataclass(frozen=True, kw_only=True)
class GapTraceData:
    """A disturbance of a recording that the set misses."""

    recording: Annotated[str, Doc("The name of the recording.")]
    pair: Annotated[str, Doc("Ids of two vehicles, and frames, in words.")]
    classes: Annotated[Names, Doc("The parts for which it is a near miss; empty where there is none.")]


@dataclass(frozen=True, kw_only=True)
class Traffic:
    """The disturbances of recordings as data."""

    recordings: Annotated[str, Doc("Their folder.")]
    view: Literal["recorded"] = "recorded"
    disturbances: Annotated[shared.Count, Doc("Disturbances between two vehicles.")]
    repeats: Annotated[shared.Count, Doc("Disturbances that an earlier window has shown already.")] = 0
    missed: Annotated[tuple[GapTraceData, ...], Doc("Those that the set misses.")]


@dataclass(frozen=True, kw_only=True)
class Preamble:
    """The head of a view, for all classes."""

    set: shared.SetName
    wider: Annotated[Names, Doc("Wider sets, from the next to the widest.")]
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications


@dataclass(frozen=True, kw_only=True)
class CoverageData(Preamble, headings.AnswerHeading):
    """The disturbances that a set misses."""

    schema: Literal["roadproof/coverage/2"] = SCHEMA
    view: shared.Dense = "dense"
    verdict: SetVerdict
    claims: Annotated[tuple[CoverageClaimData, ...], Doc("Together they say that there is no gap.")]
    classes: Annotated[tuple[CountedClass, ...], Doc("Classes of gaps, by what of a scenario is false.")]
    gaps: tuple[NumberedGap, ...]
    needs: Annotated[
        tuple[NeedData, ...],
        Doc("With --needed, of a set that covers: a drive for each definition that it needs."),
    ] = ()
    traffic: Annotated[Traffic | None, Doc("With --on: what recordings hold.")] = None
    left_out: headings.LeftOutParts = ()
    seconds: shared.Seconds = 0.0
