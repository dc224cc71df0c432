"""The answer of ``roadproof compare``: which of two formulas implies the other."""

from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers.shared import Formula, OnRoad, PlainHeading, Reason, SetName
from roadproof.evidence.codec import Doc
from roadproof.evidence.json_schema import Whole
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict

SCHEMA: Final = "roadproof/compare/2"
Relation: TypeAlias = Literal["equivalent", "stronger", "weaker", "incomparable", "unknown"]


@dataclass(frozen=True, kw_only=True)
class Side:
    """A formula, read in a spec set."""

    formula: Formula
    set: SetName


@dataclass(frozen=True, kw_only=True)
class Direction:
    """Whether one formula implies the other."""

    claim: Formula
    verdict: ClaimVerdict
    reason: Reason
    certificate: Annotated[
        Annotated[object, Whole("certificate.json")] | None,
        Doc("Of a PROVED: of the claim, or that the opposite never holds."),
    ]
    drive: Annotated[
        Annotated[object, Whole("drive.json")] | None,
        Doc("Of a REFUTED: one formula holds on it, the other does not."),
    ]


@dataclass(frozen=True, kw_only=True)
class Answer(OnRoad, PlainHeading):
    """Which of two formulas implies the other."""

    schema: Literal["roadproof/compare/2"] = SCHEMA
    first: Side
    second: Side
    relation: Annotated[Relation, Doc("stronger: the first implies the second, and not the reverse.")]
    forward: Annotated[Direction, Doc("Whether the first implies the second.")]
    backward: Annotated[Direction, Doc("Whether the second implies the first.")]
