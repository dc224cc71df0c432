"""One claim settled: by a proof, a countermodel, a drive that refutes it, or within bounds.

What searches for drives is imported when one is looked for: most claims are proved without.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from roadproof.effort import Effort, Late
from roadproof.elapsed import now, since
from roadproof.errors import InputError, UsageError
from roadproof.evidence.judged import Judged
from roadproof.logic.fragment import is_cubic_state
from roadproof.logic.pins import pins
from roadproof.proving.doubt import Stop
from roadproof.proving.induction import prove_by_induction
from roadproof.proving.motion import prove_of_motions
from roadproof.proving.prover import Result, prove
from roadproof.searching.limits import Limits
from roadproof.searching.steady import steady_drive
from roadproof.spec.library import Specification
from roadproof.spec.motion import Assumed, is_moving, under_limits
from roadproof.spec.query import Query
from roadproof.verdict import Verdict

if TYPE_CHECKING:
    from roadproof.searching.ask import Search

DRIVE = 5.0  # units of work for a drive that refutes
BRIEF = 0.25  # units for a proof of a claim about one instant, before sampled states are looked at
BEFORE = 5.0  # units for a proof from what is known of motion, before a drive is looked for


@dataclass(frozen=True)
class Settled:
    """A result; ``drive`` is a judged drive on which the claim is false.

    ``bounded``: asked of drives on one road, up to a horizon; ``limits``: within what PROVED-BOUNDED holds.
    """

    result: Result
    drive: Judged | None = None
    limits: Limits | None = None
    bounded: bool = False

    @property
    def verdict(self) -> Verdict:
        """A drive refutes also where no countermodel over points in time was found."""
        return Verdict.REFUTED if self.drive is not None else self.result.verdict

    @property
    def refuted_by(self) -> Literal["drive", "trace"] | None:
        """Whether a vehicle can drive what refutes the claim; None where nothing does."""
        if self.verdict is not Verdict.REFUTED:
            return None
        return "trace" if self.drive is None else "drive"


def settle(
    specification: Specification,
    query: Query,
    effort: Effort,
    label: str = "",
    scenario: int | None = None,
    seek_drive: bool = True,
    said: Sequence[str] = (),
) -> Settled:
    """Prove or refute a claim; a refuted or undecided one also by a drive, where there is one.

    ``said``: what is assumed, in words; of motions only a drive refutes. UNKNOWN where the clock cuts the
    search off.
    """
    begun = now()
    try:
        induced = prove_by_induction(specification, query, said, effort, label, scenario)
    except Late as late:
        return in_doubt(str(late), begun)
    if induced is not None:
        return Settled(induced)
    if is_moving(said):
        return _settle_of_motions(specification, query, said, effort, label, scenario, seek_drive)
    try:
        asked = label, scenario, Assumed(tuple(said))
        brief = seek_drive and effort.units > BRIEF and is_cubic_state(query.formula)
        result = prove(specification, query, effort.of(BRIEF) if brief else effort, *asked)
        if brief and result.verdict is Verdict.UNKNOWN:
            drive = _sampled_against(under_limits(specification, query, said), specification)
            if drive is not None:
                return Settled(replace(result, reason=""), drive)
            result = prove(specification, query, effort, *asked)
    except Late as late:
        return in_doubt(str(late), begun)
    if not seek_drive or result.verdict not in (Verdict.REFUTED, Verdict.UNKNOWN):
        return Settled(result)
    against = under_limits(specification, query, said)
    try:
        drive = _drive_against(against, specification, effort)
    except Late as late:
        if result.verdict is not Verdict.REFUTED:
            return in_doubt(str(late), begun)
        drive = None
    if drive is None and result.countermodel is not None:
        drive = steady_drive(specification, against, result.countermodel)
    return Settled(result, drive)


def _settle_of_motions(
    specification: Specification,
    query: Query,
    said: Sequence[str],
    effort: Effort,
    label: str,
    scenario: int | None,
    seek_drive: bool,
) -> Settled:
    """A quick proof, else a drive on which the claim is false within the limits said, else a long proof."""
    begun = now()
    asked = specification, query, said
    try:
        result = prove_of_motions(*asked, effort.of(min(BEFORE, effort.units)), label, scenario)
        if result.holds:
            return Settled(result)
        drive = _drive_against(under_limits(*asked), specification, effort) if seek_drive else None
        if drive is not None:
            return Settled(replace(result, reason=""), drive)
        if effort.units > BEFORE:
            result = prove_of_motions(*asked, effort, label, scenario)
    except Late as late:
        return in_doubt(str(late), begun)
    sought = "no drive was found that refutes it" if seek_drive else "no drive that refutes it was looked for"
    reason = result.reason if result.holds else f"{result.reason}; {sought}"
    return Settled(replace(result, reason=reason, seconds=since(begun)))


def _drive_against(claim: Query, specification: Specification, effort: Effort) -> Judged | None:
    """A drive on which ``claim`` is false; None where none is found, or it is not about drives."""
    from roadproof.searching.refute import refuting_drive

    try:
        return refuting_drive(specification, claim, effort.of(min(DRIVE, effort.units)))
    except (InputError, UsageError):
        return None


def _sampled_against(claim: Query, specification: Specification) -> Judged | None:
    """Constant motion on which a claim about one instant is false, from a sampled state; None as above."""
    from roadproof.searching.instant import sampled_drive
    from roadproof.searching.question import Setting

    try:
        return sampled_drive(specification, claim, pins(claim.formula), Setting())
    except (InputError, UsageError):
        return None


def settle_bounded(search: "Search") -> Settled:
    """Look for a drive that refutes the claim within bounds; where none is possible at all, prove it."""
    from roadproof.searching.bounded import check_bounded

    begun = now()
    try:
        found = check_bounded(search)
    except Late as late:
        return replace(in_doubt(str(late), begun), bounded=True)
    if found.verdict is Verdict.PROVED:
        return settle(search.specification, search.query, search.search_options.effort)
    result = Result(found.verdict, found.reason, since(begun))
    return Settled(result, found.drive, found.limits, bounded=True)


def in_doubt(reason: str, begun: float | None = None, stop: Stop = Stop.CLOCK) -> Settled:
    """What is said of a claim that nothing is known of; ``begun``: since when it was asked."""
    seconds = 0.0 if begun is None else since(begun)
    return Settled(Result(Verdict.UNKNOWN, reason, seconds, stop=stop))
