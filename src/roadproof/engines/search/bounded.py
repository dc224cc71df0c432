"""Claims about drives up to a horizon: no counterexample within printed limits, or a judged one."""

from collections.abc import Iterable
from dataclasses import replace

from roadproof.engines.search.ask import ask
from roadproof.engines.search.dense_candidates import falsifying_drive
from roadproof.engines.search.limits import PROVE_OPTIONS, Limits
from roadproof.engines.search.outcome import Search
from roadproof.evidence.settled import Settled
from roadproof.library.compose import negation
from roadproof.runtime.records import dataclass
from roadproof.verdict import ClaimVerdict, Verdict
from roadproof.world.drive import Drive


@dataclass(frozen=True)
class BoundedResult(Settled[ClaimVerdict]):
    """PROVED-BOUNDED with its limits, REFUTED with a judged drive, or UNKNOWN with a reason.

    PROVED where the negation is shown to be impossible for all time; ``certificate`` says how.
    """

    limits: Limits | None = None


def check_bounded(search: Search, given: Iterable[Drive] = ()) -> BoundedResult:
    """Check the claim ``search.query`` with dynamics: search for a drive on which it is false.

    PROVED-BOUNDED speaks of the drives within ``limits`` (grid view), after drives within them were judged in
    dense time, those of ``given`` among them, and none falsified the claim. Raises as ``ask``.
    """
    setting = replace(search.setting, natural=False)
    denied = replace(search, query=negation(search.query), setting=setting)
    outcome = ask(denied)
    if outcome.drives:
        return BoundedResult(verdict=Verdict.REFUTED, drive=outcome.drives[0])
    if outcome.impossibility is not None:
        return BoundedResult(verdict=Verdict.PROVED, certificate=outcome.impossibility.certificate)
    if outcome.verdict is Verdict.NONE_WITHIN and outcome.limits is not None:
        drive = falsifying_drive(denied, given)
        if drive is not None:
            return BoundedResult(verdict=Verdict.REFUTED, drive=drive)
        reason = outcome.told(PROVE_OPTIONS)
        return BoundedResult(verdict=Verdict.PROVED_BOUNDED, reason=reason, limits=outcome.limits)
    return BoundedResult(verdict=Verdict.UNKNOWN, reason=outcome.reason)
