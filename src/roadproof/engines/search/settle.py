"""One claim settled: by a proof, a countermodel, a drive that refutes it, or within bounds.

What searches for drives is imported when one is looked for: most claims are proved without.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

from roadproof.engines.prove.doubt import Stop
from roadproof.engines.prove.induction import prove_by_induction
from roadproof.engines.prove.motion import prove_of_motions
from roadproof.engines.prove.prover import Result, prove
from roadproof.engines.search.constant_motion import steady_drive
from roadproof.engines.search.limits import Limits
from roadproof.errors import InputError, UsageError
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.motion import Assumption, is_moving, under_limits
from roadproof.library.specification import Query, Specification
from roadproof.logic.initial_conditions import pins
from roadproof.logic.rewrite import is_cubic_state
from roadproof.reasons import NO_REASON, Reason, Why, joined
from roadproof.runtime.budget import BudgetExceeded, Effort
from roadproof.runtime.records import dataclass
from roadproof.runtime.timing import now, since
from roadproof.verdict import ClaimVerdict, Verdict
from roadproof.world.drive import Drive

if TYPE_CHECKING:
    from roadproof.engines.search.outcome import Search

# Units of work for a proof, before short drives are looked at, and before a solver looks for a drive.
BRIEF, BEFORE = 0.4, 5.0


@dataclass(frozen=True)
class Settlement:
    """A result; ``drive`` is a judged drive on which the claim is false.

    ``bounded``: asked of drives on one road, up to a horizon; ``limits``: within what PROVED-BOUNDED holds.
    """

    result: Result
    drive: JudgedDrive | None = None
    limits: Limits | None = None
    bounded: bool = False

    @property
    def verdict(self) -> ClaimVerdict:
        """A drive refutes also where no countermodel over points in time was found."""
        return Verdict.REFUTED if self.drive is not None else self.result.verdict

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
        return "" if self.drive is None or self.bounded else _beyond(self.drive)


def settle(
    specification: Specification,
    query: Query,
    effort: Effort,
    label: str = "",
    scenario: int | None = None,
    seek_drive: bool = True,
    said: Sequence[str] = (),
) -> Settlement:
    """Prove or refute a claim; a refuted or undecided one also by a drive, where there is one.

    ``said``: what is assumed, in words; of motions only a drive refutes. UNKNOWN where the clock cuts the
    search off.
    """
    begun, effort = now(), effort.running()
    if seek_drive:
        return _Settler(specification, query, effort, (label, scenario), tuple(said), begun).run()
    try:
        found = prove_claim(specification, query, effort, (label, scenario), tuple(said))
    except BudgetExceeded as late:
        return in_doubt(late.reason, begun)
    if is_moving(said) and not found.holds:
        found = replace(found, reason=joined((found.reason, Why.NO_REFUTATION_SOUGHT())))
    return Settlement(found)


@dataclass(frozen=True)
class _Settler:
    """Proofs and drives in turns, each with more work than before."""

    specification: Specification
    query: Query
    effort: Effort
    called: tuple[str, int | None]
    said: tuple[str, ...]
    begun: float

    @cached_property
    def against(self) -> Query:
        """What a drive refutes."""
        return under_limits(self.specification, self.query, self.said)

    def run(self) -> Settlement:
        try:
            result = self._prove(BRIEF)
        except BudgetExceeded as late:
            return in_doubt(late.reason, self.begun)
        if result.verdict not in (Verdict.REFUTED, Verdict.UNKNOWN):
            return Settlement(result)
        try:
            return self._run(result)
        except BudgetExceeded as late:
            if result.verdict is Verdict.REFUTED:
                return Settlement(result)
            return in_doubt(late.reason, self.begun)

    def _run(self, result: Result) -> Settlement:
        """A quick drive, a longer proof, a drive that takes a search, and the longest proof."""
        quick = self._quick()
        if quick is not None and not _beyond(quick):
            return self._refuted(result, quick)
        if quick is None and self._may_change(result, BRIEF):
            result = self._prove(BEFORE)
        if result.verdict not in (Verdict.REFUTED, Verdict.UNKNOWN):
            return Settlement(result)
        drive = self._searched(quick)
        if drive is not None:
            return self._refuted(result, drive)
        if self._may_change(result, BEFORE):
            result = self._prove(self.effort.units)
        if result.countermodel is not None:
            drive = steady_drive(self.specification, self.against, result.countermodel)
        if result.verdict is Verdict.UNKNOWN and is_moving(self.said):
            result = replace(result, reason=joined((result.reason, Why.NO_REFUTATION())))
        return Settlement(replace(result, seconds=since(self.begun)), drive)

    def _prove(self, units: float) -> Result:
        effort = self.effort.of(min(units, self.effort.units))
        return prove_claim(self.specification, self.query, effort, self.called, self.said)

    def _may_change(self, result: Result, units: float) -> bool:
        """Whether more work than ``units`` may bring another answer."""
        return result.verdict is Verdict.UNKNOWN and units < self.effort.units

    def _refuted(self, result: Result, drive: JudgedDrive) -> Settlement:
        return Settlement(replace(result, reason=NO_REASON, seconds=since(self.begun)), drive)

    def _quick(self) -> JudgedDrive | None:
        """A short or steady drive on which the claim is false, found without a solver; None as below."""
        from roadproof.engines.search.question import Setting
        from roadproof.engines.search.refute import quick_drive, sampled_drive

        if not self.against.vehicles:
            return self._empty() if is_moving(self.said) else None
        try:
            found = quick_drive(self.specification, self.against, self.effort.meter())
            if found is None and is_cubic_state(self.against.formula):
                values = pins(self.against.formula)
                return sampled_drive(self.specification, self.against, values, Setting())
            return found
        except (InputError, UsageError):
            return None

    def _empty(self) -> JudgedDrive | None:
        """A drive of no vehicles on which a claim about none is false, whatever motion is."""
        found = prove(self.specification, self.against, self.effort.of(min(BRIEF, self.effort.units)))
        trace = found.countermodel
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
    said: Sequence[str],
) -> Result:
    """What the prover says. Raises ``BudgetExceeded``."""
    found = prove_by_induction(specification, query, said, effort)
    if found is None and is_moving(said):
        found = prove_of_motions(specification, query, said, effort)
    if found is None:
        found = prove(specification, query, effort, Assumption(tuple(said)))
    return found.called(*called)


def settle_bounded(search: "Search", given: Iterable[Drive] = ()) -> Settlement:
    """Look for a drive that refutes the claim within bounds; where none is possible at all, prove it.

    ``given``: drives that are judged before PROVED-BOUNDED.
    """
    from roadproof.engines.search.bounded import check_bounded

    begun = now()
    options = replace(search.search_options, effort=search.search_options.effort.running())
    search = replace(search, search_options=options)
    try:
        found = check_bounded(search, given)
    except BudgetExceeded as late:
        return replace(in_doubt(late.reason, begun), bounded=True)
    if found.verdict is Verdict.PROVED:
        return settle(search.specification, search.query, search.search_options.effort)
    result = Result(verdict=found.verdict, reason=found.reason, seconds=since(begun))
    return Settlement(result, found.drive, found.limits, bounded=True)


def in_doubt(reason: Reason, begun: float | None = None, stop: Stop = Stop.CLOCK) -> Settlement:
    """What is said of a claim that nothing is known of; ``begun``: since when it was asked."""
    seconds = 0.0 if begun is None else since(begun)
    return Settlement(Result(verdict=Verdict.UNKNOWN, reason=reason, seconds=seconds, stop=stop))
