"""The data of proved and refuted claims, as ``prove --json`` prints them and ``question.json`` has them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answer_files import UnknownReportData
from roadproof.evidence.answers import headings, shared
from roadproof.evidence.answers.drive import CounterexampleField
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule
from roadproof.evidence.countermodel import trace_data
from roadproof.questions.drive_search_data import DriveSearchData, search_data
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, Verdict

if TYPE_CHECKING:
    from roadproof.evidence.strict import JsonObject
    from roadproof.questions.prove import ClaimResult, ClaimTask
    from roadproof.questions.question import EvidencePlace as Placing

SCHEMA: Final = "roadproof/verdicts/1"
Property: TypeAlias = Annotated[str, Doc("Template property such as P1; claim for one of your own.")]
Part: TypeAlias = Annotated[
    str, Doc("Which part of the property, or which of several claims; empty where there is one.")
]


@dataclass(frozen=True, kw_only=True)
class KernelSays:
    """The ruling of Coq on the proof, with --kernel."""

    says: shared.KernelWord
    reason: shared.Reason
    premises: Annotated[int, Rule(minimum=0), Doc("How many limits of vehicles are premises.")]


@dataclass(frozen=True, kw_only=True)
class ClaimData:
    """A claim, with all that is known of it."""

    property: Property
    part: Part
    scenario: shared.OneScenario
    set: shared.SetName
    claim: shared.Formula
    assuming: Annotated[
        tuple[shared.Formula, ...], Doc("What the claim is said under; empty where it is about all traces.")
    ]
    expected: Annotated[ClaimVerdict, Doc("The verdict with which the exit code is 0.")]
    verdict: ClaimVerdict
    refuted_by: Annotated[
        Literal["drive", "trace"] | None,
        Doc("Of a REFUTED: a drive, or a trace over points in time, which may jump as no vehicle can."),
    ]
    beyond_limits: Annotated[
        str | None,
        Doc("How a refuting drive leaves the limits of the shipped vehicles; null where it keeps them."),
    ]
    view: Annotated[Literal["dense", "grid"], Doc("grid: on samples up to a horizon, within the limits.")]
    seconds: shared.Seconds = 0.0
    reason: shared.Reason
    doubt: Annotated[UnknownReportData | None, LEFT_OUT] = None
    limits: Annotated[shared.LimitsField | None, LEFT_OUT, Doc("Of a PROVED-BOUNDED only.")] = None
    assumptions: Annotated[tuple[str, ...], Doc("Declared bounds that the proof used.")]
    premises: Annotated[
        tuple[str, ...],
        Doc(
            "Limits and facts about motion that the certificate has as premises; empty where the proof uses "
            "none of what is assumed."
        ),
    ]
    evidence: Annotated[
        str | None, Doc("File of the folder that shows it; null without --out, and where there is none.")
    ]
    counterexample: CounterexampleField
    kernel: Annotated[KernelSays | None, LEFT_OUT] = None


@dataclass(frozen=True, kw_only=True)
class ClaimsData(headings.OnRoad, headings.AnswerHeading):
    """Claims, proved or refuted."""

    schema: Literal["roadproof/verdicts/1"] = SCHEMA
    verdicts: tuple[ClaimData, ...]
    kernel: Annotated[shared.KernelField | None, LEFT_OUT] = None


@dataclass(frozen=True, kw_only=True)
class ProofRequest:
    """A claim in a spec set; what it is called follows from it."""

    set: shared.SetName
    claim: shared.Formula
    assuming: Annotated[shared.Assuming, LEFT_OUT] = ()
    expected: Annotated[ClaimVerdict, Doc("The verdict with which the exit code is 0.")] = Verdict.PROVED
    within: Annotated[
        DriveSearchData | None, LEFT_OUT, Doc("Of a claim about drives, how they are looked for.")
    ] = None


@dataclass(frozen=True, kw_only=True)
class ProofRequests:
    """Claims that are to be proved."""

    claims: Annotated[tuple[ProofRequest, ...], Rule(least=1), Doc("The claims, in the order of the answer.")]


def claim_settings(x: ClaimTask) -> ProofRequest:
    """Return a claim as data."""
    task = x.task
    return ProofRequest(
        set=task.set_name,
        claim=task.claim,
        assuming=task.assuming,
        expected=task.expected,
        within=None if x.within is None else search_data(x.within),
    )


def claim_data(x: ClaimResult, place: Placing, kernel: KernelSays | None = None) -> ClaimData:
    """Return a claim as ``--json`` prints it; ``kernel``: what Coq says of its proof."""
    certificate = x.certificate
    shown = x.answer if x.answer is not None and x.answer.is_final else None
    file = None if shown is None else place(x.name, shown)
    return ClaimData(
        property=x.task.id,
        part=x.task.part,
        scenario=x.task.scenario,
        set=x.task.set_name,
        claim=x.task.claim,
        assuming=x.task.assuming,
        expected=x.expected,
        verdict=x.verdict,
        refuted_by=x.refuted_by,
        beyond_limits=x.beyond or None,
        view="grid" if x.verdict is Verdict.PROVED_BOUNDED else "dense",
        seconds=x.seconds,
        reason=x.reason,
        doubt=None if x.open is None else x.open.doubt,
        limits=None if x.open is None else x.open.limits,
        assumptions=() if certificate is None else tuple(certificate.assumptions),
        premises=() if certificate is None else tuple(certificate.assumed.premises),
        evidence=file if isinstance(file, str) else None,
        counterexample=_counterexample(x),
        kernel=kernel,
    )


def _counterexample(x: ClaimResult) -> JsonObject | None:
    """Return the refuting drive, or else the trace, as plain data."""
    if x.drive is not None:
        return {"kind": "drive", "drive": x.drive.as_data()}
    return None if x.trace is None else trace_data(x.trace)
