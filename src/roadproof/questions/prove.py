"""Whether claims hold: template properties, or claims of a user."""

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import Annotated, ClassVar, Final, Literal, TypeAlias

from roadproof.engines.prove.properties import OWN, Task, find_task
from roadproof.evidence.answer import Answer, Refutation
from roadproof.evidence.answer_files import Undecided
from roadproof.evidence.answers import shared
from roadproof.evidence.answers.doubt import Doubt
from roadproof.evidence.answers.drive import KeptCounterexample
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.claim import Claim, Exists, valid_under
from roadproof.evidence.codec import LEFT_OUT, Doc, Rule, read
from roadproof.evidence.countermodel import Countermodel, trace_data
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.strict import JsonObject
from roadproof.evidence.subject import Subject, SubjectKind
from roadproof.library.elaborate import read_claim
from roadproof.library.specification import Query, Specification
from roadproof.logic.custom_names import told_freedom
from roadproof.logic.first_instant import told_first_instants
from roadproof.questions.basis import Basis
from roadproof.questions.place import Place, mode_of, place_of
from roadproof.questions.question import Answers, Steps, heading_of
from roadproof.questions.question import Place as Placing
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.budget import Work
from roadproof.runtime.canonical import digest
from roadproof.runtime.cost import NO_COST, Cost
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, Verdict, claim_verdict
from roadproof.world.road import Road

SCHEMA: Final = "roadproof/verdicts/1"
Property: TypeAlias = Annotated[str, Doc("Template property such as P1; claim for one of your own.")]
Part: TypeAlias = Annotated[
    str, Doc("Which part of the property, or which of several claims; empty where there is one.")
]


@dataclass(frozen=True, kw_only=True)
class AskedClaim:
    """A claim in a spec set; what it is called follows from it."""

    set: shared.SetName
    claim: shared.Formula
    assuming: Annotated[shared.Assuming, LEFT_OUT] = ()
    expected: Annotated[ClaimVerdict, Doc("The verdict with which the exit code is 0.")] = Verdict.PROVED
    within: Annotated[Place | None, LEFT_OUT, Doc("Of a claim about drives, how they are looked for.")] = None


@dataclass(frozen=True, kw_only=True)
class AskedClaims:
    """Claims that are to be proved."""

    claims: Annotated[tuple[AskedClaim, ...], Rule(least=1), Doc("The claims, in the order of the answer.")]


@dataclass(frozen=True)
class ClaimTask:
    """A claim of the list or of a user; ``within``: about drives only, as they are looked for."""

    task: Task
    within: Exists | None = None

    @cached_property
    def name(self) -> str:
        """The name of its answer, whoever asks: a claim of the list is named as the list does."""
        under = "" if self.within is None else f"-within-{digest(self.within)[:8]}"
        listed = find_task(self.task.claim, self.task.set_name)
        named = self.task if listed is None else replace(listed, assuming=self.task.assuming)
        return f"{named.name}{under}"


@dataclass(frozen=True)
class ClaimResult:
    """A claim of the list or of a user with its answer; None where it is not settled.

    ``name`` of the answer; ``cost`` in this run.
    """

    task: Task
    name: str
    claim: Claim
    answer: Answer | None
    cost: Cost = NO_COST

    @property
    def seconds(self) -> float:
        """The seconds that it took in this run."""
        return self.cost.seconds

    @property
    def verdict(self) -> ClaimVerdict:
        """The verdict; UNKNOWN where there is no answer."""
        return Verdict.UNKNOWN if self.answer is None else claim_verdict(self.answer.verdict)

    @property
    def is_bounded(self) -> bool:
        """Whether it is about drives on one road up to a horizon."""
        return _within(self.claim) is not None

    @property
    def expected(self) -> ClaimVerdict:
        """PROVED-BOUNDED is as good as PROVED where the claim is about drives up to a horizon."""
        weaker = self.is_bounded and self.task.expected is Verdict.PROVED
        return Verdict.PROVED_BOUNDED if weaker else self.task.expected

    @property
    def certificate(self) -> Certificate | None:
        """The proof, if there is one."""
        return None if self.answer is None else self.answer.certificate

    @property
    def drive(self) -> JudgedDrive | None:
        """The drive that refutes the claim, if one does."""
        return None if self.answer is None else self.answer.drive

    @property
    def trace(self) -> Countermodel | None:
        """The trace over points in time that refutes the claim, if one does."""
        match None if self.answer is None else self.answer.evidence:
            case Refutation() as shown:
                return shown.trace
            case _:
                return None

    @property
    def reason(self) -> Reason:
        """Why there is no better answer."""
        return NO_REASON if self.answer is None else self.answer.reason

    @property
    def open(self) -> Undecided | None:
        """What is said of a claim without evidence."""
        found = None if self.answer is None else self.answer.evidence
        return found if isinstance(found, Undecided) else None

    @property
    def refuted_by(self) -> Literal["drive", "trace"] | None:
        """Whether a vehicle can drive what refutes the claim; None where nothing does."""
        if self.verdict is not Verdict.REFUTED:
            return None
        return "trace" if self.drive is None else "drive"

    @property
    def beyond(self) -> str:
        """How the refuting drive leaves the limits of the usual models; '' where there is none, or it keeps
        them, or was looked for within limits of the user's own.
        """
        if self.drive is None or self.is_bounded:
            return ""
        from roadproof.engines.search.refute import beyond_limits  # here: proofs need no numpy

        return beyond_limits(self.drive)


def _within(claim: Claim) -> Exists | None:
    within: Exists | None = getattr(claim.mode, "within", None)
    return within


@dataclass(frozen=True)
class ClaimsView:
    """The claims in the order in which they were asked."""

    claims: tuple[ClaimResult, ...]


@dataclass(frozen=True)
class ProveQuestion:
    """The question whether claims hold. ``seek_drive``: whether a drive is looked for that refutes one."""

    kind: ClassVar[str] = "prove"
    basis: Basis
    tasks: tuple[ClaimTask, ...]
    seek_drive: bool = True

    @property
    def work(self) -> Work:
        """The work that is allowed for a claim."""
        effort = self.basis.effort
        return Work(effort, effort.units, seek_drive=self.seek_drive, explain=True)

    @property
    def asked(self) -> AskedClaims:
        """The claims, without what they are called."""
        return AskedClaims(claims=tuple(_asked(x) for x in self.named.values()))

    @classmethod
    def of(cls, basis: Basis, asked: object, where: str) -> "ProveQuestion":
        """Return the question that plain data ask. Raises ``InputError``."""
        data = read(AskedClaims, asked, where)
        found = cls(basis, tuple(_task(x, where) for x in data.claims))
        _ = found.claims
        return found

    @property
    def are_own(self) -> bool:
        """Whether the claims are of a user, and not of the list."""
        return any(not x.task.title for x in self.tasks)

    def beside(self, former: "ProveQuestion") -> "ProveQuestion":
        """Return the question about former claims, too: a folder of claims grows."""
        return replace(self, tasks=tuple({**former.named, **self.named}.values()))

    def displaced(self, former: "ProveQuestion") -> list[str]:
        """Return none: the name of an answer says what its claim is."""
        return []

    def specification_of(self, task: Task) -> Specification:
        """Return the definitions that a claim is read with."""
        return self.basis.specification.in_set(task.set_name)

    def query_of(self, task: Task) -> Query:
        """Return a claim as it is read."""
        return read_claim(self.specification_of(task), task.claim)

    def supposed(self, task: Task) -> tuple[str, ...]:
        """Return what is supposed of the own signals of a claim, and first instants that it asks for."""
        formula = self.query_of(task).formula
        return (*told_freedom(formula), *told_first_instants(formula))

    @cached_property
    def named(self) -> dict[str, ClaimTask]:
        """The claims by the names of their answers; what is asked twice is there once."""
        return {x.name: x for x in self.tasks}

    @cached_property
    def claims(self) -> dict[str, Claim]:
        """The claims as engines are asked, by name."""
        return {name: self._claim(x) for name, x in self.named.items()}

    def _claim(self, x: ClaimTask) -> Claim:
        home, query = self.specification_of(x.task), self.query_of(x.task)
        return valid_under(home, query, x.task.assuming, x.within, self.basis.values)

    def batches(self, known: Answers) -> Sequence["ClaimBatch"]:
        """A batch for each claim; those about no single scenario are first, since they take longest."""
        named = sorted(self.named.items(), key=lambda x: x[1].task.scenario is not None)
        return [ClaimBatch(name, self.claims[name]) for name, _ in named]

    def label(self, name: str) -> str:
        """Return what a claim is called."""
        task = self.named[name].task
        return _label(task) or task.set_name

    def subject(self, name: str) -> Subject:
        """Return what requirements link to: a property of the list."""
        task = self.named[name].task
        label = _label(task)
        return Subject(SubjectKind.PROPERTY if label else SubjectKind.OTHER, label, task.set_name)

    def view(self, known: Answers) -> ClaimsView:
        """Return the claims with their answers."""
        return ClaimsView(tuple(self.result(x.name, known.get(x.name)) for x in self.tasks))

    def result(self, name: str, answer: Answer | None) -> ClaimResult:
        """Return a claim with its answer."""
        return ClaimResult(self.named[name].task, name, self.claims[name], answer)

    def data(self, view: ClaimsView, place: Placing, seconds: float) -> "ClaimsData":
        """Return the view as ``--json`` prints it."""
        return ClaimsData(
            **heading_of(SCHEMA, self.basis),
            **ClaimsData.of_road(self.road),
            verdicts=tuple(claim_data(x, place) for x in view.claims),
        )

    @property
    def road(self) -> Road | None:
        """The road on which drives are looked for, where one was chosen."""
        return next((x.within.road for x in self.tasks if x.within is not None), None)


@dataclass(frozen=True)
class ClaimBatch:
    """One claim."""

    name: str
    claim: Claim

    def steps(self) -> Steps:
        """Yield the claim."""
        yield self.name, self.claim


def _asked(x: ClaimTask) -> AskedClaim:
    task = x.task
    return AskedClaim(
        set=task.set_name,
        claim=task.claim,
        assuming=task.assuming,
        expected=task.expected,
        within=None if x.within is None else place_of(x.within),
    )


def _task(asked: AskedClaim, where: str) -> ClaimTask:
    """Return a claim as the list has it, or as a user's. Raises ``InputError``."""
    within = None if asked.within is None else mode_of(asked.within, where)
    listed = find_task(asked.claim, asked.set)
    if listed is None or asked.expected is not listed.expected:
        own = Task(OWN, "", "", None, asked.set, asked.claim, asked.expected, asked.assuming)
        return ClaimTask(own, within)
    return ClaimTask(replace(listed, assuming=asked.assuming), within)


def _label(task: Task) -> str:
    """Return a property of the list as ``P1 scenario 4 base``; empty for a claim of a user."""
    listed = find_task(task.claim, task.set_name)
    if listed is None:
        return ""
    part = f"-{listed.part}" if listed.part else ""
    scenario = f" scenario {listed.scenario}" if listed.scenario is not None else ""
    return f"{listed.id}{part}{scenario} {task.set_name}"


def claim_data(x: ClaimResult, place: Placing, kernel: "KernelSays | None" = None) -> "ClaimData":
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


@dataclass(frozen=True, kw_only=True)
class KernelSays:
    """What Coq says of the proof, with --kernel."""

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
    evidence: Annotated[
        str | None, Doc("File of the folder that shows it; null without --out, and where there is none.")
    ]
    counterexample: KeptCounterexample
    kernel: Annotated[KernelSays | None, LEFT_OUT] = None


@dataclass(frozen=True, kw_only=True)
class ClaimsData(shared.OnRoad, shared.Heading):
    """Claims, proved or refuted."""

    schema: Literal["roadproof/verdicts/1"] = SCHEMA
    verdicts: tuple[ClaimData, ...]
    kernel: Annotated[shared.KeptKernel | None, LEFT_OUT] = None
