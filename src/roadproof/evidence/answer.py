"""Answers: a claim with the evidence that decides it.

The verdict follows from the claim and the kind of evidence, so every verdict has evidence of its kind.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

from roadproof.evidence.answer_files import OpenVerdict, OwnEvidence, UndecidedFile
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.claim import Claim, Exists, Mode, On, OwnMode, TraceJudgement, Valid
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.none_within import NoneWithinFile
from roadproof.library.bind import values_with
from roadproof.logic import formula as f
from roadproof.reasons import NO_REASON, Reason, ReasonKind
from roadproof.runtime.records import dataclass
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.evidence.answer_files import UnknownReportData
    from roadproof.evidence.countermodel import Countermodel
    from roadproof.library.specification import Query
    from roadproof.logic.formula import Formula


@dataclass(frozen=True)
class RefutingTrace:
    """A judged trace on which a claim is false; ``drive_sought``: no refuting drive was found either."""

    trace: Countermodel
    drive_sought: bool = False


@dataclass(frozen=True)
class JudgedTrace:
    """The judgement of a given trace: a recording, a test or a simulation."""

    shows: TraceJudgement


Evidence: TypeAlias = (
    Certificate | JudgedDrive | RefutingTrace | NoneWithinFile | OwnEvidence | JudgedTrace | UndecidedFile
)


@dataclass(frozen=True)
class ClaimAnswer:
    """A claim, and the evidence that decides it.

    Raises ``ValueError`` if evidence of this kind cannot decide a claim of this mode, or if it has other
    values of parameters.
    """

    claim: Claim
    evidence: Evidence

    def __post_init__(self) -> None:
        _ = self.verdict
        match self.evidence:
            case JudgedDrive(file=file) if other := value_mismatch(self.claim, file.values):
                raise ValueError(f"{other} on the drive")
            case NoneWithinFile(values=values) if other := value_mismatch(self.claim, values):
                raise ValueError(f"{other} in the trees")

    @property
    def verdict(self) -> Verdict:
        """The verdict that the evidence shows."""
        match self.claim.mode, self.evidence:
            case mode, UndecidedFile(verdict=open_verdict) if _is_possible(mode, open_verdict):
                return open_verdict
            case Valid(), Certificate():
                return Verdict.VACUOUS if self._denied is not None else Verdict.PROVED
            case Valid(), JudgedDrive():
                return Verdict.REFUTED
            case Valid(moving=False, within=None), RefutingTrace():
                return Verdict.REFUTED
            case Valid(), RefutingTrace():
                raise ValueError("it is a trace, but only a drive refutes the claim")
            case OwnMode() as own, evidence if (verdict := own.verdict_of(evidence)) is not None:
                return verdict
            case Exists(), JudgedDrive():
                return Verdict.WITNESSED
            case Exists(), Certificate():
                return Verdict.IMPOSSIBLE
            case Exists(trees=True), NoneWithinFile():
                return Verdict.NONE_WITHIN
            case On(), JudgedTrace(shows):
                return shows.verdict
            case mode, evidence:
                word = f" {evidence.verdict}" if isinstance(evidence, UndecidedFile) else ""
                raise ValueError(f"{type(evidence).__name__}{word} decides no {type(mode).__name__} claim")

    @property
    def reason(self) -> Reason:
        """The reason why the claim is undecided or vacuous, or a note on the assumptions of its proof."""
        if self._denied is not None:
            return ReasonKind.CONTRADICTION() if self._denied == f.FALSE else ReasonKind.PREMISE()
        if isinstance(self.evidence, Certificate) and self.evidence.assumed.texts != assumed_by(self.claim):
            return ReasonKind.WITH(", ".join(self.evidence.assumed.texts))
        return self.evidence.reason if isinstance(self.evidence, UndecidedFile) else NO_REASON

    @cached_property
    def _denied(self) -> Formula | None:
        """The formula that the certificate of a vacuous claim denies; None for all other evidence."""
        if not isinstance(self.claim.mode, Valid) or not isinstance(self.evidence, Certificate):
            return None
        shown = self.claim.read(self.evidence.claim)
        return next((x.formula for x in vacuities(self.claim) if x.formula == shown), None)

    @property
    def is_final(self) -> bool:
        """Return whether the evidence decides the claim for good."""
        return not isinstance(self.evidence, UndecidedFile)

    @property
    def drive(self) -> JudgedDrive | None:
        """The drive that shows the verdict, if there is one."""
        return self.evidence if isinstance(self.evidence, JudgedDrive) else None

    @property
    def certificate(self) -> Certificate | None:
        """The certificate that shows the verdict, if there is one."""
        return self.evidence if isinstance(self.evidence, Certificate) else None


def _is_possible(mode: Mode, verdict: OpenVerdict) -> bool:
    """Return whether an undecided claim may have this verdict: only drives have verdicts within limits."""
    match verdict:
        case Verdict.NONE_WITHIN:
            return isinstance(mode, Exists)
        case Verdict.PROVED_BOUNDED:
            return isinstance(mode, Valid) and mode.within is not None
        case Verdict.UNKNOWN | Verdict.CROSSCHECK_FAILED:
            return True


def vacuities(claim: Claim) -> Iterator[Query]:
    """Yield the claims that show that a claim is vacuous.

    The first says that its premise never holds, the second that its assumptions contradict each other.
    """
    from roadproof.library.compose import contradiction, negated_premise  # here: for proofs alone

    denied = negated_premise(claim.query)
    if denied is not None:
        yield denied
    if assumed_by(claim):
        yield contradiction(claim.query)


def undecided(
    claim: Claim,
    reason: Reason,
    verdict: OpenVerdict = Verdict.UNKNOWN,
    limits: object = None,
    report: UnknownReportData | None = None,
) -> ClaimAnswer:
    """Return the answer to a claim that no evidence decides.

    Args:
        verdict: UNKNOWN, or a verdict that holds within limits only.
        limits: the limits of that verdict, as ``shared.LimitsData``.
        report: the cause of an UNKNOWN, and the options that help.
    """
    home = claim.home
    file = UndecidedFile(
        set=home.set_name,
        options=dict(home.options),
        claim=claim.query.text,
        assuming=assumed_by(claim),
        verdict=verdict,
        reason=reason,
        limits=limits,
        doubt=report,
    )
    return ClaimAnswer(claim, file)


def assumed_by(claim: Claim) -> tuple[str, ...]:
    """Return the assumptions of a claim as text; only claims about all traces have any."""
    return claim.mode.assuming if isinstance(claim.mode, Valid) else ()


def deciding_formula(claim: Claim) -> Formula:
    """Return the formula of a drive that decides a claim.

    A drive witnesses the formula of an existence claim. It refutes a claim about all traces, under its
    assumptions.
    """
    if isinstance(claim.mode, Valid):
        restricted = claim.mode.restricted
        return f.negation(claim.formula if restricted is None else restricted)
    return claim.formula


def value_mismatch(claim: Claim, values: Mapping[str, Fraction]) -> str:
    """Return a message about the first parameter whose value differs from the claim's; empty if all agree."""
    known = values_with(claim.home.library, values)
    other = ((name, value) for name, value in claim.values.items() if known[name] != value)
    return next((f"it has {name}={known[name]}, and not {value}" for name, value in other), "")
