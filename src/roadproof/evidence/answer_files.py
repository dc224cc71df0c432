"""Files of answers that are neither certificate, drive nor tree: what is undecided, and refuting traces."""

from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import shared
from roadproof.evidence.answers.doubt import Doubt
from roadproof.evidence.codec import LEFT_OUT, Doc
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

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
