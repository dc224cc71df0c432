"""The question whether claims hold: template properties, or claims of a user."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal

from roadproof.engines.prove.properties import OWN, Task, find_task
from roadproof.evidence.answer import ClaimAnswer, RefutingTrace
from roadproof.evidence.answer_files import UndecidedFile
from roadproof.evidence.assuming import valid_under
from roadproof.evidence.codec import read
from roadproof.library.elaborate import read_claim
from roadproof.logic.custom_names import freedom_lines
from roadproof.logic.first_instant import first_instant_warnings
from roadproof.questions.basis import Basis
from roadproof.questions.question import heading_of
from roadproof.reasons import NO_REASON, Reason
from roadproof.runtime.budget import NO_COST, Cost, Work
from roadproof.runtime.canonical import digest
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, Verdict, claim_verdict

if TYPE_CHECKING:
    from roadproof.evidence.certificate import Certificate
    from roadproof.evidence.claim import Claim, Exists
    from roadproof.evidence.countermodel import Countermodel
    from roadproof.evidence.judged import JudgedDrive
    from roadproof.evidence.subject import Subject
    from roadproof.library.specification import Query, Specification
    from roadproof.questions.prove_data import ClaimsData, ProofRequest, ProofRequests
    from roadproof.questions.question import Answers, Steps
    from roadproof.questions.question import EvidencePlace as Placing
    from roadproof.world.road import Road


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
    answer: ClaimAnswer | None
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
        """Return whether it is about drives on one road up to a horizon."""
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
            case RefutingTrace() as shown:
                return shown.trace
            case _:  # open: any other evidence, or none
                return None

    @property
    def reason(self) -> Reason:
        """Return why there is no better answer."""
        return NO_REASON if self.answer is None else self.answer.reason

    @property
    def open(self) -> UndecidedFile | None:
        """The file of a claim without evidence."""
        evidence = None if self.answer is None else self.answer.evidence
        return evidence if isinstance(evidence, UndecidedFile) else None

    @property
    def refuted_by(self) -> Literal["drive", "trace"] | None:
        """Return whether a vehicle can drive what refutes the claim; None where nothing does."""
        if self.verdict is not Verdict.REFUTED:
            return None
        return "trace" if self.drive is None else "drive"

    @property
    def beyond(self) -> str:
        """Text on how the refuting drive leaves the limits of the usual models; '' without such a drive."""
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
    def settings(self) -> ProofRequests:
        """The claims, without what they are called."""
        from roadproof.questions.prove_data import ProofRequests, claim_settings  # here: for folders alone

        return ProofRequests(claims=tuple(claim_settings(x) for x in self.named.values()))

    @classmethod
    def of(cls, basis: Basis, settings: object, where: str) -> ProveQuestion:
        """Return the question that plain data ask. Raises ``InputError``."""
        from roadproof.questions.prove_data import ProofRequests  # here: for folders alone

        data = read(ProofRequests, settings, where)
        question = cls(basis, tuple(_task(x, where) for x in data.claims))
        _ = question.claims
        return question

    @property
    def are_own(self) -> bool:
        """Return whether the claims are of a user, and not of the list."""
        return any(not x.task.title for x in self.tasks)

    def beside(self, former: ProveQuestion) -> ProveQuestion:
        """Return the question about former claims, too: a folder of claims grows."""
        return replace(self, tasks=tuple({**former.named, **self.named}.values()))

    def displaced(self, former: ProveQuestion) -> list[str]:
        """Return none: the name of an answer says what its claim is."""
        return []

    def specification_of(self, task: Task) -> Specification:
        """Return the definitions that a claim is read with."""
        return self.basis.specification.in_set(task.set_name)

    def query_of(self, task: Task) -> Query:
        """Return a claim as it is read."""
        return read_claim(self.specification_of(task), task.claim)

    def supposed(self, task: Task) -> tuple[str, ...]:
        """Return what is supposed of the custom signals of a claim, and first instants that it asks for."""
        formula = self.query_of(task).formula
        return (*freedom_lines(formula), *first_instant_warnings(formula))

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

    def batches(self, known: Answers) -> Sequence[ClaimBatch]:
        """A batch for each claim; those about no single scenario are first, since they take longest."""
        named = sorted(self.named.items(), key=lambda x: x[1].task.scenario is not None)
        return [ClaimBatch(name, self.claims[name]) for name, _ in named]

    def label(self, name: str) -> str:
        """Return what a claim is called."""
        task = self.named[name].task
        return _label(task) or task.set_name

    def subject(self, name: str) -> Subject:
        """Return what requirements link to: a property of the list."""
        from roadproof.evidence.subject import Subject, SubjectKind  # here: for requirements alone

        task = self.named[name].task
        label = _label(task)
        return Subject(SubjectKind.PROPERTY if label else SubjectKind.OTHER, label, task.set_name)

    def view(self, known: Answers) -> ClaimsView:
        """Return the claims with their answers."""
        return ClaimsView(tuple(self.result(x.name, known.get(x.name)) for x in self.tasks))

    def result(self, name: str, answer: ClaimAnswer | None) -> ClaimResult:
        """Return a claim with its answer."""
        return ClaimResult(self.named[name].task, name, self.claims[name], answer)

    def data(self, view: ClaimsView, place: Placing, seconds: float) -> ClaimsData:
        """Return the view as ``--json`` prints it."""
        from roadproof.questions.prove_data import SCHEMA, ClaimsData, claim_data  # here: for --json alone

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


def _task(settings: ProofRequest, where: str) -> ClaimTask:
    """Return a claim as the list has it, or as a user's. Raises ``InputError``."""
    from roadproof.questions.drive_search_data import search_mode

    within = None if settings.within is None else search_mode(settings.within, where)
    listed = find_task(settings.claim, settings.set)
    if listed is None or settings.expected is not listed.expected:
        own = Task(OWN, "", "", None, settings.set, settings.claim, settings.expected, settings.assuming)
        return ClaimTask(own, within)
    return ClaimTask(replace(listed, assuming=settings.assuming), within)


def _label(task: Task) -> str:
    """Return a property of the list as ``P1 scenario 4 base``; empty for a claim of a user."""
    listed = find_task(task.claim, task.set_name)
    if listed is None:
        return ""
    part = f"-{listed.part}" if listed.part else ""
    scenario = f" scenario {listed.scenario}" if listed.scenario is not None else ""
    return f"{listed.id}{part}{scenario} {task.set_name}"
