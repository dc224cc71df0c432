"""Whether a claim holds on all traces: drives that are known, a proof, a drive or a trace that refutes it."""

from collections.abc import Iterable
from dataclasses import replace

from roadproof.engines.modifier import modifier_of
from roadproof.engines.prove.doubt import doubt_of
from roadproof.engines.prove.induction import prove_of_scenarios
from roadproof.engines.search.known_drive import KnownDrive, against, first_refuting
from roadproof.engines.search.looking import search_of
from roadproof.engines.search.remedy import remedy_of
from roadproof.engines.search.settle import Settlement, settle, settle_bounded
from roadproof.engines.search.shipped_drives import shipped_drives
from roadproof.evidence.answer import Answer, Refutation, assumed_by, undecided, vacuities
from roadproof.evidence.claim import Claim, Valid
from roadproof.logic.formula import FALSE
from roadproof.reasons import Reason, Why
from roadproof.runtime.budget import Work
from roadproof.runtime.cost import NO_COST, Cost
from roadproof.verdict import Verdict


def settle_valid(
    claim: Claim, work: Work, drives: Iterable[KnownDrive] = (), alike: Iterable[KnownDrive] = ()
) -> tuple[Answer, Cost]:
    """Return the answer to a claim, and what it cost.

    ``drives``: they are tried first; those that refute claims which are ``alike`` on other roads, too.
    """
    assert isinstance(claim.mode, Valid)
    if claim.mode.within is not None:
        bounded = settle_bounded(search_of(claim, work), shipped_drives())
        return _answer(claim, work, bounded), NO_COST
    shown = first_refuting(claim, drives)
    for known in alike if shown is None else ():
        shown = shown or known.elsewhere(against(claim), claim)
    if shown is not None:
        return Answer(claim, shown), NO_COST
    effort = work.effort if work.seek_drive else work.effort.of(work.proof)
    if not work.seek_drive and not assumed_by(claim) and modifier_of(claim.home.options) is not None:
        return _answer(claim, work, Settlement(prove_of_scenarios(claim.home, claim.query, effort))), NO_COST
    found = settle(claim.home, claim.query, effort, seek_drive=work.seek_drive, said=assumed_by(claim))
    return _answer(claim, work, found), Cost(work=found.result.work or None)


def _answer(claim: Claim, work: Work, found: Settlement) -> Answer:
    if found.drive is not None:
        return Answer(claim, found.drive)
    result = found.result
    match found.verdict:
        case Verdict.VACUOUS if result.certificate is not None:
            return _vacuous(claim, work, result.reason) or Answer(claim, result.certificate)
        case Verdict.PROVED if result.certificate is not None:
            return Answer(claim, result.certificate)
        case Verdict.REFUTED if result.countermodel is not None:
            return Answer(claim, Refutation(result.countermodel, work.seek_drive))
        case Verdict.PROVED_BOUNDED if found.limits is not None:
            return undecided(claim, result.reason, Verdict.PROVED_BOUNDED, found.limits.as_json())
        case Verdict.CROSSCHECK_FAILED:
            return undecided(claim, result.reason, Verdict.CROSSCHECK_FAILED)
        case _:
            return _in_doubt(claim, work, found)


def _vacuous(claim: Claim, work: Work, reason: Reason) -> Answer | None:
    """Return the proof that a claim says nothing for this reason, where there is one."""
    is_contradiction = reason == Why.CONTRADICTION()
    for denied in vacuities(claim):
        if (denied.formula == FALSE) is is_contradiction:
            found = settle(claim.home, denied, work.effort, seek_drive=False, said=assumed_by(claim))
            if found.result.holds and found.result.certificate is not None:
                return Answer(claim, found.result.certificate)
    return None


def _in_doubt(claim: Claim, work: Work, found: Settlement) -> Answer:
    """Return that a claim is in doubt; with the cause and what helps where that is to be explained."""
    result, said = found.result, assumed_by(claim)
    if not work.explain or result.stop is None:
        return undecided(claim, result.reason)
    doubt = doubt_of(claim.query, said, result.stop, work.effort, work.seek_drive, result.reason)
    doubt = replace(doubt, option=remedy_of(claim.home, claim.query, said, doubt.cause))
    return undecided(claim, Why.TOLD(doubt), doubt=doubt.kept)
