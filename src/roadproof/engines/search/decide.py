"""Decides one claim: by a proof, a countermodel, a drive that refutes it, or within bounds.

The search for drives is imported only when needed: most claims are proved without.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from roadproof.engines.prove.induction import prove_by_induction
from roadproof.engines.prove.motion import prove_for_motions
from roadproof.engines.prove.prover import ProverResult, prove
from roadproof.engines.prove.unknown import StopPoint
from roadproof.engines.search.constant_motion import steady_drive
from roadproof.engines.search.limits import SearchLimits
from roadproof.errors import InputError, UsageError
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.assumption import Assumption, assumes_motion
from roadproof.library.motion import under_limits
from roadproof.library.specification import Query, Specification
from roadproof.logic.initial_conditions import forced_values
from roadproof.logic.rewrite import is_cubic_state
from roadproof.reasons import NO_REASON, Reason, ReasonKind, joined
from roadproof.runtime.budget import BudgetExceeded, Effort
from roadproof.runtime.records import dataclass
from roadproof.runtime.timing import now, seconds_since
from roadproof.verdict import ClaimVerdict, Verdict
from roadproof.world.drive import Drive

if TYPE_CHECKING:
    from roadproof.engines.setting import Search

# Units of work for a proof, before short drives are looked at, and before a solver looks for a drive.
BRIEF, BEFORE = 0.4, 5.0


@dataclass(frozen=True)
class ClaimDecision:
    """The decision on a claim; ``drive`` is a judged drive on which it is false.

    ``bounded``: the claim is about drives on one road up to a horizon; ``limits``: those of PROVED-BOUNDED.
    """

    result: ProverResult
    drive: JudgedDrive | None = None
    limits: SearchLimits | None = None
    bounded: bool = False

    @property
    def verdict(self) -> ClaimVerdict:
        """The verdict; a drive refutes also where no countermodel over points in time was found."""
        return Verdict.REFUTED if self.drive is not None else self.result.verdict

    @property
    def refuted_by(self) -> Literal["drive", "trace"] | None:
        """Return whether a vehicle can drive the counterexample; None where nothing refutes the claim."""
        if self.verdict is not Verdict.REFUTED:
            return None
        return "trace" if self.drive is None else "drive"

    @property
    def beyond(self) -> str:
        """Text on how the refuting drive leaves the limits of the usual models; '' without such a drive."""
        return "" if self.drive is None or self.bounded else _beyond(self.drive)


def decide_claim(
    specification: Specification,
    query: Query,
    effort: Effort,
    label: str = "",
    scenario: int | None = None,
    seek_drive: bool = True,
    assumed: Sequence[str] = (),
) -> ClaimDecision:
    """Prove or refute a claim; refuted or undecided ones are also tested against drives.

    ``assumed``: assumptions in words; claims about motions are refuted by drives only. UNKNOWN where the
    clock cuts the search off.
    """
    started, effort = now(), effort.with_clock_started()
    if seek_drive:
        return _Decider(specification, query, effort, (label, scenario), tuple(assumed), started).run()
    try:
        result = prove_claim(specification, query, effort, (label, scenario), tuple(assumed))
    except BudgetExceeded as late:
        return unknown_decision(late.reason, started)
    if assumes_motion(assumed) and not result.holds:
        result = replace(result, reason=joined((result.reason, ReasonKind.NO_REFUTATION_SOUGHT())))
    return ClaimDecision(result)


@dataclass(frozen=True)
class _Decider:
    """Proofs and drives in turns, each with more work than before."""

    specification: Specification
    query: Query
    effort: Effort
    called: tuple[str, int | None]
    assumed: tuple[str, ...]
    started: float

    @cached_property
    def against(self) -> Query:
        """The negated claim within its limits, which a drive must satisfy."""
        return under_limits(self.specification, self.query, self.assumed)

    def run(self) -> ClaimDecision:
        """Decide the claim; UNKNOWN where the clock cuts it off."""
        try:
            result = self._prove(BRIEF)
        except BudgetExceeded as late:
            return unknown_decision(late.reason, self.started)
        if result.verdict not in (Verdict.REFUTED, Verdict.UNKNOWN):
            return ClaimDecision(result)
        try:
            return self._run(result)
        except BudgetExceeded as late:
            if result.verdict is Verdict.REFUTED:
                return ClaimDecision(result)
            return unknown_decision(late.reason, self.started)

    def _run(self, result: ProverResult) -> ClaimDecision:
        """A quick drive, a longer proof, a drive that takes a search, and the longest proof."""
        quick = self._quick()
        if quick is not None and not _beyond(quick):
            return self._refuted(result, quick)
        if quick is None and self._may_change(result, BRIEF):
            result = self._prove(BEFORE)
        if result.verdict not in (Verdict.REFUTED, Verdict.UNKNOWN):
            return ClaimDecision(result)
        drive = self._searched(quick)
        if drive is not None:
            return self._refuted(result, drive)
        if self._may_change(result, BEFORE):
            result = self._prove(self.effort.units)
        if result.countermodel is not None:
            drive = steady_drive(self.specification, self.against, result.countermodel)
        if result.verdict is Verdict.UNKNOWN and assumes_motion(self.assumed):
            result = replace(result, reason=joined((result.reason, ReasonKind.NO_REFUTATION())))
        return ClaimDecision(replace(result, seconds=seconds_since(self.started)), drive)

    def _prove(self, units: float) -> ProverResult:
        effort = self.effort.with_units(min(units, self.effort.units))
        return prove_claim(self.specification, self.query, effort, self.called, self.assumed)

    def _may_change(self, result: ProverResult, units: float) -> bool:
        """Return whether more work than ``units`` may bring another answer."""
        return result.verdict is Verdict.UNKNOWN and units < self.effort.units

    def _refuted(self, result: ProverResult, drive: JudgedDrive) -> ClaimDecision:
        return ClaimDecision(replace(result, reason=NO_REASON, seconds=seconds_since(self.started)), drive)

    def _quick(self) -> JudgedDrive | None:
        """A short or steady drive on which the claim is false, found without a solver; None as below."""
        from roadproof.engines.search.refute import quick_drive, sampled_drive
        from roadproof.engines.setting import Setting

        if not self.against.vehicles:
            return self._empty() if assumes_motion(self.assumed) else None
        try:
            drive = quick_drive(self.specification, self.against, self.effort.meter())
            if drive is None and is_cubic_state(self.against.formula):
                values = forced_values(self.against.formula)
                return sampled_drive(self.specification, self.against, values, Setting())
            return drive
        except (InputError, UsageError):
            return None

    def _empty(self) -> JudgedDrive | None:
        """A drive of no vehicles on which a claim about none is false, whatever motion is."""
        result = prove(
            self.specification, self.against, self.effort.with_units(min(BRIEF, self.effort.units))
        )
        trace = result.countermodel
        if trace is None:
            return None
        return steady_drive(self.specification, self.against, trace, trace.parameters)

    def _searched(self, known: JudgedDrive | None) -> JudgedDrive | None:
        """A drive on which the claim is false; ``known`` or None where none is found that is better."""
        from roadproof.engines.search.refute import refuting_drive

        try:
            return refuting_drive(self.specification, self.against, self.effort, known)
        except (InputError, UsageError):
            return known


def _beyond(drive: JudgedDrive) -> str:
    from roadproof.engines.search.refute import beyond_limits

    return beyond_limits(drive)


def prove_claim(
    specification: Specification,
    query: Query,
    effort: Effort,
    called: tuple[str, int | None],
    assumed: Sequence[str],
) -> ProverResult:
    """Return the prover's result. Raises ``BudgetExceeded``."""
    result = prove_by_induction(specification, query, assumed, effort)
    if result is None and assumes_motion(assumed):
        result = prove_for_motions(specification, query, assumed, effort)
    if result is None:
        result = prove(specification, query, effort, Assumption(tuple(assumed)))
    return result.called(*called)


def decide_bounded(search: "Search", given: Iterable[Drive] = ()) -> ClaimDecision:
    """Search a drive that refutes the claim within bounds; prove the claim if no drive is possible at all.

    ``given``: drives that are judged before PROVED-BOUNDED.
    """
    from roadproof.engines.search.bounded import check_bounded

    started = now()
    options = replace(search.search_options, effort=search.search_options.effort.with_clock_started())
    search = replace(search, search_options=options)
    try:
        bounded_result = check_bounded(search, given)
    except BudgetExceeded as late:
        return replace(unknown_decision(late.reason, started), bounded=True)
    if bounded_result.verdict is Verdict.PROVED:
        return decide_claim(search.specification, search.query, search.search_options.effort)
    result = ProverResult(
        verdict=bounded_result.verdict, reason=bounded_result.reason, seconds=seconds_since(started)
    )
    return ClaimDecision(result, bounded_result.drive, bounded_result.limits, bounded=True)


def unknown_decision(
    reason: Reason, started: float | None = None, stop: StopPoint = StopPoint.CLOCK
) -> ClaimDecision:
    """Return an UNKNOWN decision; ``started``: the time at which the question began."""
    seconds = 0.0 if started is None else seconds_since(started)
    return ClaimDecision(ProverResult(verdict=Verdict.UNKNOWN, reason=reason, seconds=seconds, stop=stop))
