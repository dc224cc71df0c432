"""The answer of ``roadproof check``: what evidence shows."""

from collections.abc import Mapping
from typing import Annotated, Final, Literal

from roadproof.evidence.answers.headings import BaseHeading
from roadproof.evidence.answers.shared import Fingerprint, KernelField
from roadproof.evidence.codec import LEFT_OUT, Doc
from roadproof.evidence.finding import Finding
from roadproof.runtime.records import dataclass

SCHEMA: Final = "roadproof/check/2"


@dataclass(frozen=True, kw_only=True)
class ClaimFinding(Finding):
    """One claim of a file."""

    accepted: bool


@dataclass(frozen=True, kw_only=True)
class CheckData(BaseHeading):
    """The findings of a check."""

    schema: Literal["roadproof/check/2"] = SCHEMA
    library: Annotated[
        Fingerprint,
        Doc("Of the library at hand with the files of --spec, without those beside the evidence."),
    ]
    solver: Annotated[Literal["z3", "cvc5", "coq", "extracted"], Doc("Who was asked about certificates.")]
    kernel: Annotated[KernelField | None, LEFT_OUT] = None
    findings: tuple[ClaimFinding, ...]
    not_checked: Annotated[
        Mapping[str, tuple[str, ...]],
        Doc("By folder, the files in it that nothing is compared with."),
    ]
