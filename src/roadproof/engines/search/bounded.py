"""Claims about drives up to a horizon: no counterexample within printed limits, or a judged one."""

from dataclasses import dataclass, replace

from roadproof.engines.search.ask import Search, ask
from roadproof.engines.search.limits import PROVE_OPTIONS, Limits
from roadproof.evidence.certificate import Certificate
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.compose import negation
from roadproof.verdict import ClaimVerdict, Verdict


@dataclass(frozen=True)
class BoundedResult:
    """PROVED-BOUNDED with its limits, REFUTED with a judged drive, or UNKNOWN with a reason.

    PROVED where the negation is shown to be impossible for all time; ``certificate`` says how.
    """

    verdict: ClaimVerdict
    reason: str = ""
    drive: JudgedDrive | None = None
    certificate: Certificate | None = None
    limits: Limits | None = None


def check_bounded(search: Search) -> BoundedResult:
    """Check the claim ``search.query`` with dynamics: search for a drive on which it is false.

    PROVED-BOUNDED speaks of the drives within ``limits`` (grid view); a counterexample that is found has
    been judged in dense time. Raises as ``ask``.
    """
    setting = replace(search.setting, natural=False)
    outcome = ask(replace(search, query=negation(search.query), setting=setting, count=1))
    if outcome.drives:
        return BoundedResult(Verdict.REFUTED, drive=outcome.drives[0])
    if outcome.impossibility is not None:
        return BoundedResult(Verdict.PROVED, certificate=outcome.impossibility.certificate)
    if outcome.verdict is Verdict.NONE_WITHIN and outcome.limits is not None:
        reason = outcome.limits.text(PROVE_OPTIONS)
        return BoundedResult(Verdict.PROVED_BOUNDED, reason, limits=outcome.limits)
    return BoundedResult(Verdict.UNKNOWN, outcome.reason)
