"""Claims about drives up to a horizon: no counterexample within printed limits, or a judged one."""

from dataclasses import dataclass, replace
from typing import Any

from roadproof.spec.library import load_library
from roadproof.verdict import Verdict
from roadproof.witness.ask import Request, as_formula, ask
from roadproof.witness.limits import PROVE_OPTIONS, Limits
from roadproof.witness.refute import negated


@dataclass(frozen=True)
class BoundedResult:
    """PROVED-BOUNDED with its limits, REFUTED with a drive file, or UNKNOWN with a reason.

    PROVED where the negation is shown to be impossible for all time; ``certificate`` says how.
    """

    claim: str
    verdict: Verdict
    reason: str
    drive: dict[str, Any] | None
    certificate: Any | None
    limits: Limits | None = None


def check_bounded(request: Request) -> BoundedResult:
    """Check the claim ``request.what`` with dynamics, on the request's road, vehicles, grid and engine.

    PROVED-BOUNDED speaks of the drives within ``limits`` (grid view); a counterexample that is found has
    been judged in dense time. Raises as ``ask``.
    """
    specification = load_library(request.specs).select(request.set_name, request.options)
    claim = as_formula(specification, request.what)[1]
    outcome = ask(replace(request, what=negated(claim), natural=False, count=1))
    if outcome.drives:
        return BoundedResult(claim, Verdict.REFUTED, "", outcome.drives[0], None)
    if outcome.impossibility is not None:
        certificate = outcome.impossibility.certificate
        return BoundedResult(claim, Verdict.PROVED, "", None, certificate)
    if outcome.verdict is Verdict.NONE_WITHIN and outcome.limits is not None:
        reason = outcome.limits.text(PROVE_OPTIONS)
        return BoundedResult(claim, Verdict.PROVED_BOUNDED, reason, None, None, outcome.limits)
    return BoundedResult(claim, Verdict.UNKNOWN, outcome.reason, None, None)
