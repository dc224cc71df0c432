"""Decides claims about drives up to a horizon: PROVED-BOUNDED with limits, or a judged counterexample."""

from collections.abc import Iterable
from dataclasses import replace

from roadproof.engines.search.dense_candidates import falsifying_drive
from roadproof.engines.search.drive_search import search_drive
from roadproof.engines.search.limits import PROVE_OPTIONS, SearchLimits
from roadproof.engines.setting import Search
from roadproof.evidence.verdict_with_evidence import VerdictWithEvidence
from roadproof.library.compose import negation
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, Verdict
from roadproof.world.drive import Drive


@dataclass(frozen=True)
class BoundedResult(VerdictWithEvidence[ClaimVerdict]):
    """PROVED-BOUNDED with its limits, REFUTED with a judged drive, or UNKNOWN with a reason.

    PROVED where the negation is shown to be impossible for all time; ``certificate`` says how.
    """

    limits: SearchLimits | None = None


def check_bounded(search: Search, given: Iterable[Drive] = ()) -> BoundedResult:
    """Search for a drive within the horizon on which the claim ``search.query`` is false.

    PROVED-BOUNDED speaks of the drives within ``limits`` (grid view), after drives within them, those of
    ``given`` among them, were judged in dense time, and none falsified the claim. Raises as ``search_drive``.
    """
    setting = replace(search.setting, natural=False)
    denied = replace(search, query=negation(search.query), setting=setting)
    outcome = search_drive(denied)
    if outcome.drives:
        return BoundedResult(verdict=Verdict.REFUTED, drive=outcome.drives[0])
    if outcome.impossibility is not None:
        return BoundedResult(verdict=Verdict.PROVED, certificate=outcome.impossibility.certificate)
    if outcome.verdict is Verdict.NONE_WITHIN and outcome.limits is not None:
        drive = falsifying_drive(denied, given)
        if drive is not None:
            return BoundedResult(verdict=Verdict.REFUTED, drive=drive)
        reason = outcome.reason_with(PROVE_OPTIONS)
        return BoundedResult(verdict=Verdict.PROVED_BOUNDED, reason=reason, limits=outcome.limits)
    return BoundedResult(verdict=Verdict.UNKNOWN, reason=outcome.reason)
