"""The data of overlaps, as ``overlap --json`` prints them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Final, Literal

from roadproof.evidence.answers import headings, shared
from roadproof.evidence.codec import Doc, Rule
from roadproof.reasons import NO_REASON
from roadproof.runtime.records import dataclass
from roadproof.verdict import DriveVerdict

if TYPE_CHECKING:
    from roadproof.questions.overlap import PairVerdict
    from roadproof.questions.question import EvidencePlace

SCHEMA: Final = "roadproof/overlap/2"


@dataclass(frozen=True, kw_only=True)
class Clash:
    """Parts of a conjunction that contradict each other."""

    formula: shared.Formula
    parts: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class PairData:
    """The answer whether two scenarios can hold together."""

    a: shared.Number
    b: shared.Number
    set_a: shared.SetName
    set_b: shared.SetName
    verdict: DriveVerdict
    formula: Annotated[
        str,
        Doc(
            "Of a WITNESSED what holds on the drive; of an IMPOSSIBLE what is proved; else what is in doubt."
        ),
    ]
    core: Annotated[tuple[str, ...], Doc("Parts that clash, of all cores.")]
    cores: Annotated[tuple[Clash, ...], Doc("For each way in which the two can meet, parts that clash.")]
    evidence: Annotated[
        tuple[shared.EvidenceField, ...],
        Doc("A drive; or for each way in which the two can meet, a certificate that its core clashes."),
    ]
    reason: shared.Reason = NO_REASON


@dataclass(frozen=True, kw_only=True)
class OverlapData(headings.AnswerHeading):
    """The pairs of scenarios that can hold together."""

    schema: Literal["roadproof/overlap/2"] = SCHEMA
    set: Annotated[str, Rule(least=1), Doc("The spec set, or two with a comma between.")]
    lanes: Annotated[shared.Choice, Doc("Whether both speak of one lane, or each of its own.")]
    roles: Annotated[shared.Choice, Doc("Whether vehicles play the same parts in both.")]
    start: Annotated[shared.Choice, Doc("Whether both start at 0, or one then or later.")]
    options: shared.Options
    parameters: shared.Parameters
    specs: shared.Specifications
    view: shared.Dense = "dense"
    seconds: shared.Seconds = 0.0
    verdicts: tuple[PairData, ...]


def pair_data(pair: PairVerdict, place: EvidencePlace) -> PairData:
    """Return the verdict on a pair as data."""
    return PairData(
        a=pair.a.number,
        b=pair.b.number,
        set_a=pair.a.set_name,
        set_b=pair.b.set_name,
        verdict=pair.verdict,
        formula=pair.query.text,
        core=pair.core_texts,
        cores=tuple(Clash(formula=x.whole.text, parts=x.parts) for x in pair.cores),
        evidence=tuple(place(name, x) for name, x in pair.evidence.items()),
        reason=pair.reason,
    )
