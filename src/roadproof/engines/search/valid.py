"""Whether a claim holds on all traces: drives that are known, a proof, a drive or a trace that refutes it."""

from collections.abc import Iterable

from roadproof.engines.prove.prover import Result
from roadproof.engines.search.placing import judged_as, placed
from roadproof.engines.search.settle import Settlement, prove_claim, settle
from roadproof.evidence.answer import Answer, Refutation, assumed_by, sought_by, undecided
from roadproof.evidence.claim import Claim
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import bind, values_with
from roadproof.library.compose import negation
from roadproof.library.motion import under_limits
from roadproof.library.specification import Query
from roadproof.runtime.budget import Work
from roadproof.semantics.exact.exact import judge
from roadproof.verdict import Verdict


def settle_valid(
    claim: Claim, work: Work, drives: Iterable[JudgedDrive], alike: Iterable[JudgedDrive] = ()
) -> Answer:
    """Return the answer to a claim.

    ``drives``: they are tried first; those that refute claims which are ``alike`` on other roads, too. Raises
    ``BudgetExceeded``.
    """
    shown = _refuting(claim, drives)
    for known in alike if shown is None else ():
        shown = shown or placed(known.file, _against(claim), claim.home.library)
    if shown is not None:
        return Answer(claim, shown)
    if work.seek_drive:
        found = settle(claim.home, claim.query, work.effort, said=assumed_by(claim))
    else:
        effort = work.effort.of(work.proof)
        found = Settlement(prove_claim(claim.home, claim.query, effort, ("", None), assumed_by(claim)))
    if found.drive is not None:
        return Answer(claim, found.drive)
    return _answer(claim, found.result)


def _refuting(claim: Claim, drives: Iterable[JudgedDrive]) -> JudgedDrive | None:
    """Return the first drive on which a claim is false, as evidence of that."""
    for known in drives:
        if is_refuted_by(claim, known):
            return judged_as(known.file, _against(claim), claim.home.library)
    return None


def is_refuted_by(claim: Claim, drive: JudgedDrive) -> bool:
    """Return whether a claim is false on a drive, judged exactly."""
    file = drive.file
    if not ({*claim.vehicles} <= {*file.drive.vehicles} and {*claim.lanes} <= {*file.lanes}):
        return False
    values = values_with(claim.home.library, file.values)
    return judge(bind(sought_by(claim), file.road, file.lanes, values), file.drive).holds


def _against(claim: Claim) -> Query:
    """Return that a claim is false within the limits that it assumes."""
    return negation(under_limits(claim.home, claim.query, assumed_by(claim)))


def _answer(claim: Claim, result: Result) -> Answer:
    match result.verdict:
        case Verdict.PROVED | Verdict.VACUOUS if result.certificate is not None:
            return Answer(claim, result.certificate)
        case Verdict.REFUTED if result.countermodel is not None:
            return Answer(claim, Refutation(result.countermodel))
        case Verdict.CROSSCHECK_FAILED:
            return undecided(claim, result.reason, Verdict.CROSSCHECK_FAILED)
        case _:
            return undecided(claim, result.reason)
