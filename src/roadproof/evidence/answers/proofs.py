"""The index that ``roadproof prove`` writes, and its answer: claims with their verdicts."""

from collections.abc import Iterator
from dataclasses import replace
from enum import StrEnum
from functools import partial
from typing import Annotated, Final, Literal, TypeAlias

from roadproof.evidence.answers import shared
from roadproof.evidence.answers.drive import KeptCounterexample, KeptTrace
from roadproof.evidence.answers.entry import Common, Entry, evidence_name, shows_of
from roadproof.evidence.answers.reader import Background, Reader
from roadproof.evidence.codec import ABSENT, LEFT_OUT, UNCHECKED, Doc, Rule
from roadproof.evidence.json_schema import File
from roadproof.evidence.subject import Subject, SubjectKind
from roadproof.library.elaborate import read_claim
from roadproof.library.motion import is_moving, under_limits
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, Verdict

SCHEMA: Final = "roadproof/index/1"
ANSWER_SCHEMA: Final = "roadproof/verdicts/1"
OWN = "claim"  # what a claim is called that is no template property
Property: TypeAlias = Annotated[str, Doc("Template property such as P1; claim for one of your own.")]
Part: TypeAlias = Annotated[
    str, Doc("Which part of the property, or which of several claims; empty where there is one.")
]


@dataclass(frozen=True, kw_only=True)
class Claim:
    """A claim, with what shows its verdict."""

    property: Property
    part: Part
    scenario: shared.OneScenario
    set: shared.SetName
    claim: shared.Formula
    assuming: Annotated[shared.Assuming, LEFT_OUT] = ()
    verdict: ClaimVerdict
    evidence: Annotated[object, File(), Doc("Certificate or drive file beside the index.")]
    counterexample: Annotated[
        KeptTrace | None, LEFT_OUT, Doc("Where there is no file: the trace that refutes the claim, or null.")
    ] = ABSENT

    def expected(self, common: Common) -> list[Formula]:
        """What is proved; or of a claim that is refuted what holds on the drive."""
        claim = read_claim(common.specification, self.claim)
        if self.verdict is not Verdict.REFUTED:
            return [claim.formula]
        return [f.negation(under_limits(common.specification, claim, self.assuming).formula)]


def _trace_of(claim: Claim) -> object:
    """The trace that refutes a claim, or None."""
    return None if claim.counterexample is ABSENT else claim.counterexample


@dataclass(frozen=True, kw_only=True)
class Preamble:
    """What an index says once for all claims."""

    options: shared.Options
    specs: shared.Specifications


@dataclass(frozen=True, kw_only=True)
class Index(Preamble, shared.Heading):
    """Claims with the files that show them."""

    schema: Literal["roadproof/index/1"] = SCHEMA
    claims: tuple[Claim, ...]


@dataclass(frozen=True, kw_only=True)
class Record:
    """A kept answer."""

    claim: Claim
    reason: shared.Reason
    seconds: shared.Seconds = 0.0
    asked: Annotated[
        str,
        UNCHECKED,
        Rule(pattern="^(trace|trace or drive|(smt|milp) [0-9a-f]{16})$"),
        Doc(
            "What a counterexample was looked for among: traces, also drives, or drives within limits, of "
            "which this is a fingerprint."
        ),
    ]


def _entries(answer: Index | Record, background: Background) -> Iterator[Entry]:
    where = f"{background.where}, claim"
    if isinstance(answer, Record):
        yield _entry(answer.claim, where, background)
        return
    for number, claim in enumerate(answer.claims, 1):
        yield _entry(claim, f"{where} {number}", background)


def _entry(claim: Claim, where: str, background: Background) -> Entry:
    told = (claim.property, claim.part, claim.scenario)
    moving = is_moving(claim.assuming)
    label = None if moving else background.find_label(claim.claim, claim.set)
    own = told[0] == OWN and claim.scenario is None and (not claim.part or claim.part.isdecimal())
    fault = "" if told == label or own else misnamed(where, told, label)
    if moving and _trace_of(claim) is not None:
        fault = f"{where} assumes motion, so that only a drive refutes it: a trace may jump"
    common = background.at(claim.set)
    return Entry(
        common,
        where,
        (" ".join(claim.claim.split()), claim.set, claim.assuming),
        claim.verdict,
        shown(label, claim.set),
        shows_of(claim.verdict, where),
        claim.claim,
        evidence_name(where, "evidence", claim.evidence),
        _trace_of(claim),
        unchecked=unchecked_of(claim.verdict),
        subject=Subject() if label is None else Subject(SubjectKind.PROPERTY, shown(label, claim.set)),
        fault=fault,
        assuming=claim.assuming,
        expected=partial(claim.expected, common),
    )


def unchecked_of(verdict: str) -> tuple[str, ...]:
    """What a verdict says beyond what its evidence shows."""
    return ("that its premise never holds",) if verdict == "VACUOUS" else ()


def shown(label: tuple[str, str, int | None] | None, set_name: str) -> str:
    """A label as text: ``P1 scenario 1 base``."""
    name, part, scenario = label or ("", "", None)
    middle = f" scenario {scenario}" if scenario is not None else ""
    return f"{name}{'-' + part if part else ''}{middle} {set_name}".strip()


def misnamed(where: str, told: tuple[str, str, int | None], label: tuple[str, str, int | None] | None) -> str:
    """Why a claim is not what it is called."""
    right = "no template property" if label is None else f"that of {shown(label, '')}"
    return f"{where} is called {shown(told, '')[:60]}, but its claim is {right}"


READER = replace(Reader.of(Index, Preamble, Record, _entries), unchecked_kept=("reason", "seconds", "asked"))


# --- the answer ------------------------------------------------------------------------------------


class Cause(StrEnum):
    """Why there is no answer."""

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


Tried: TypeAlias = Literal["proof", "traces", "drives"]


@dataclass(frozen=True, kw_only=True)
class Doubt:
    """Of an UNKNOWN: its cause, what was tried, and the options that help."""

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
class KernelSays:
    """What Coq says of the proof, with --kernel."""

    says: shared.KernelWord
    reason: shared.Reason
    premises: Annotated[int, Rule(minimum=0), Doc("How many limits of vehicles are premises.")]


@dataclass(frozen=True, kw_only=True)
class ClaimAnswer:
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
    doubt: Annotated[Doubt | None, LEFT_OUT] = None
    limits: Annotated[shared.KeptLimits | None, LEFT_OUT, Doc("Of a PROVED-BOUNDED only.")] = None
    assumptions: Annotated[tuple[str, ...], Doc("Declared bounds that the proof used.")]
    premises: Annotated[
        tuple[str, ...],
        Doc(
            "Limits and facts about motion that the certificate has as premises; empty where the proof uses "
            "none of what is assumed."
        ),
    ]
    certificate: Annotated[
        str | None, Doc("File with the certificate; null without --out, and where there is none.")
    ]
    counterexample: KeptCounterexample
    kernel: Annotated[KernelSays | None, LEFT_OUT] = None


@dataclass(frozen=True, kw_only=True)
class Answer(shared.OnRoad, shared.Heading):
    """Claims, proved or refuted."""

    schema: Literal["roadproof/verdicts/1"] = ANSWER_SCHEMA
    verdicts: tuple[ClaimAnswer, ...]
    kernel: Annotated[shared.KeptKernel | None, LEFT_OUT] = None
