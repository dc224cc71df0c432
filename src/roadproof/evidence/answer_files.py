"""The files of answers that are neither certificates, drives nor trees: undecided claims and traces."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, TypeAlias

from roadproof.core_record import JUDGED, REFUTATION, UNDECIDED
from roadproof.evidence.answers import shared
from roadproof.evidence.codec import LEFT_OUT, Doc
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.evidence.claim import Claim
    from roadproof.evidence.finding import Finding

OpenVerdict: TypeAlias = Literal[
    Verdict.UNKNOWN, Verdict.NONE_WITHIN, Verdict.PROVED_BOUNDED, Verdict.CROSSCHECK_FAILED
]


class Cause(StrEnum):
    """The cause of an UNKNOWN."""

    WORK = "work"
    CLOCK = "clock"
    PROCESS = "process"
    SOLVER = "solver"
    PLACE = "place"
    FACTS = "facts"
    CERTIFICATE = "certificate"
    LANES = "lanes"
    INDUCTION = "induction"
    ALTERNATION = "alternation"
    FIRST_INSTANT = "first-instant"
    SECOND_ORDER = "second-order"
    PAST = "past"


Tried: TypeAlias = Literal["proof", "traces", "drives"]


@dataclass(frozen=True, kw_only=True)
class UnknownReportData:
    """The cause of an UNKNOWN, the attempts, and the options that help."""

    cause: Cause
    tried: tuple[Tried, ...]
    effort_helps: Annotated[bool, Doc("Whether a higher --effort or --timeout can change the answer.")]
    remedy: Annotated[str, Doc("What helps, as an imperative; empty where no option is known to help.")]
    options: Annotated[tuple[str, ...], Doc("Options of the command that follow the remedy.")]
    without_assumptions: Annotated[
        bool, Doc("Whether the remedy is to ask the claim without what it is assumed under.")
    ]
    detail: Annotated[str, Doc("What a solver or process said; else empty.")]


@dataclass(frozen=True, kw_only=True)
class AboutClaim:
    """The fields by which a file names its claim."""

    set: shared.SetName
    options: shared.Options
    claim: shared.Formula
    assuming: Annotated[shared.Assuming, LEFT_OUT] = ()


@dataclass(frozen=True, kw_only=True)
class UndecidedFile(AboutClaim):
    """The reason why a claim is undecided, or the limits within which the verdict holds."""

    schema: Literal["roadproof/undecided/1"] = UNDECIDED
    verdict: OpenVerdict
    reason: shared.Reason
    limits: Annotated[shared.LimitsField | None, LEFT_OUT] = None
    doubt: Annotated[UnknownReportData | None, LEFT_OUT] = None
    work: Annotated[
        str | None, LEFT_OUT, Doc("Digest of the work after which it is undecided; as much finds no more.")
    ] = None
    units: Annotated[
        float | None, LEFT_OUT, Doc("Units of work that were allowed, where a view says how many.")
    ] = None


@dataclass(frozen=True, kw_only=True)
class JudgedFile:
    """The judgement of a given trace."""

    schema: Literal["roadproof/judged/1"] = JUDGED
    files: Annotated[tuple[str, ...], Doc("SHA-256 of every file that the trace is read from.")]
    asked: Annotated[str, Doc("A digest of all else that it depends on.")]
    shows: Annotated[object, Doc("What it shows.")]


@dataclass(frozen=True, kw_only=True)
class RefutationFile(AboutClaim):
    """A trace on which a claim is false at time 0."""

    schema: Literal["roadproof/refutation/1"] = REFUTATION
    drive_sought: Annotated[bool, LEFT_OUT, Doc("Whether a drive was looked for in vain, too.")] = False
    trace: Annotated[object, Doc("The trace: instants, values and a road.")]


@dataclass(frozen=True, kw_only=True)
class OwnEvidence(AboutClaim):
    """Evidence of a kind that an extension adds; the extension's record names the class by its schema."""

    def fault_for(self, claim: "Claim") -> str:
        """Return why the file is about another claim; empty if it is about this one."""
        raise NotImplementedError

    def check(self, path: Path, library: Library) -> "Finding":
        """Return the finding of the file, recomputed. Raises ``RoadproofError`` if the file shows nothing."""
        raise NotImplementedError
