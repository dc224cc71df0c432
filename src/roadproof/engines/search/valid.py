"""Whether a claim holds on all traces: drives that are known, a proof, a drive or a trace that refutes it."""

from collections.abc import Iterable

from roadproof.engines.prove.prover import Result
from roadproof.engines.search.known_drive import KnownDrive, against, first_refuting
from roadproof.engines.search.settle import Settlement, prove_claim, settle
from roadproof.evidence.answer import Answer, Refutation, assumed_by, undecided
from roadproof.evidence.claim import Claim
from roadproof.runtime.budget import Work
from roadproof.verdict import Verdict


def settle_valid(
    claim: Claim, work: Work, drives: Iterable[KnownDrive], alike: Iterable[KnownDrive] = ()
) -> Answer:
    """Return the answer to a claim.

    ``drives``: they are tried first; those that refute claims which are ``alike`` on other roads, too. Raises
    ``BudgetExceeded``.
    """
    shown = first_refuting(claim, drives)
    for known in alike if shown is None else ():
        shown = shown or known.elsewhere(against(claim), claim)
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
