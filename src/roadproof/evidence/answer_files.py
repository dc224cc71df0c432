"""Files of answers that are neither certificate, drive nor tree: what is undecided, and refuting traces."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import shared
from roadproof.evidence.answers.doubt import Doubt
from roadproof.evidence.codec import LEFT_OUT, Doc
from roadproof.library.specification import Library
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.evidence.claim import Claim
    from roadproof.evidence.finding import Finding

UNDECIDED: Final = "roadproof/undecided/1"
REFUTATION: Final = "roadproof/refutation/1"
JUDGED: Final = "roadproof/judged/1"
OpenVerdict: TypeAlias = Literal[
    Verdict.UNKNOWN, Verdict.NONE_WITHIN, Verdict.PROVED_BOUNDED, Verdict.CROSSCHECK_FAILED
]


@dataclass(frozen=True, kw_only=True)
class AboutClaim:
    """What a file says of the claim that it is about."""

    set: shared.SetName
    options: shared.Options
    claim: shared.Formula
    assuming: Annotated[shared.Assuming, LEFT_OUT] = ()


@dataclass(frozen=True, kw_only=True)
class Undecided(AboutClaim):
    """Why a claim is undecided, or within which limits the answer was looked for."""

    schema: Literal["roadproof/undecided/1"] = UNDECIDED
    verdict: OpenVerdict
    reason: shared.Reason
    limits: Annotated[shared.KeptLimits | None, LEFT_OUT] = None
    doubt: Annotated[Doubt | None, LEFT_OUT] = None
    work: Annotated[
        str | None, LEFT_OUT, Doc("Digest of the work after which it is undecided; as much finds no more.")
    ] = None
    units: Annotated[
        float | None, LEFT_OUT, Doc("Units of work that were allowed, where a view says how many.")
    ] = None


@dataclass(frozen=True, kw_only=True)
class JudgedFile:
    """What a given trace shows."""

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
    """Evidence of a kind that an extension adds, whose record names the class by its schema."""

    def fault_for(self, claim: "Claim") -> str:
        """Return why it is about another claim; nothing where it is about this one."""
        raise NotImplementedError

    def check(self, path: Path, library: Library) -> "Finding":
        """Return what the file shows, worked out again. Raises ``RoadproofError`` where it shows nothing."""
        raise NotImplementedError
