"""Decides whether a claim holds on all traces: by known drives, a proof, a drive or a trace."""

from collections.abc import Iterable
from dataclasses import replace

from roadproof.engines.modifier import find_modifier
from roadproof.engines.prove.induction import prove_via_opaque_driver
from roadproof.engines.prove.unknown import unknown_report
from roadproof.engines.search.claim_search import search_for_claim
from roadproof.engines.search.decide import ClaimDecision, decide_bounded, decide_claim
from roadproof.engines.search.known_drive import KnownDrive, first_refuting, negated_claim
from roadproof.engines.search.remedy import find_remedy
from roadproof.engines.search.shipped_drives import shipped_drives
from roadproof.evidence.answer import ClaimAnswer, RefutingTrace, assumed_by, undecided, vacuities
from roadproof.evidence.claim import Claim, Valid
from roadproof.logic.formula import FALSE
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime.budget import NO_COST, Cost, Work
from roadproof.verdict import Verdict


def decide_valid(
    claim: Claim, work: Work, drives: Iterable[KnownDrive] = (), alike: Iterable[KnownDrive] = ()
) -> tuple[ClaimAnswer, Cost]:
    """Return the answer to a claim and its cost.

    ``drives`` are tried first, then those that refute ``alike`` claims on other roads.
    """
    assert isinstance(claim.mode, Valid)
    if claim.mode.within is not None:
        bounded = decide_bounded(search_for_claim(claim, work), shipped_drives())
        return _answer_from_decision(claim, work, bounded), NO_COST
    shown = first_refuting(claim, drives)
    for known in alike if shown is None else ():
        shown = shown or known.elsewhere(negated_claim(claim), claim)
    if shown is not None:
        return ClaimAnswer(claim, shown), NO_COST
    effort = work.effort if work.seek_drive else work.effort.with_units(work.proof)
    if not work.seek_drive and not assumed_by(claim) and find_modifier(claim.home.options) is not None:
        return _answer_from_decision(
            claim, work, ClaimDecision(prove_via_opaque_driver(claim.home, claim.query, effort))
        ), NO_COST
    decision = decide_claim(
        claim.home, claim.query, effort, seek_drive=work.seek_drive, assumed=assumed_by(claim)
    )
    return _answer_from_decision(claim, work, decision), Cost(work=decision.result.work or None)


def _answer_from_decision(claim: Claim, work: Work, decision: ClaimDecision) -> ClaimAnswer:
    if decision.drive is not None:
        return ClaimAnswer(claim, decision.drive)
    result = decision.result
    match decision.verdict:
        case Verdict.VACUOUS if result.certificate is not None:
            return _vacuous(claim, work, result.reason) or ClaimAnswer(claim, result.certificate)
        case Verdict.PROVED if result.certificate is not None:
            return ClaimAnswer(claim, result.certificate)
        case Verdict.REFUTED if result.countermodel is not None:
            return ClaimAnswer(claim, RefutingTrace(result.countermodel, work.seek_drive))
        case Verdict.PROVED_BOUNDED if decision.limits is not None:
            return undecided(claim, result.reason, Verdict.PROVED_BOUNDED, decision.limits.as_json())
        case Verdict.CROSSCHECK_FAILED:
            return undecided(claim, result.reason, Verdict.CROSSCHECK_FAILED)
        case Verdict.PROVED | Verdict.PROVED_BOUNDED | Verdict.REFUTED | Verdict.VACUOUS | Verdict.UNKNOWN:
            return _unknown_answer(claim, work, decision)


def _vacuous(claim: Claim, work: Work, reason: Reason) -> ClaimAnswer | None:
    """Return the proof that a claim says nothing for this reason, where there is one."""
    is_contradiction = reason == ReasonKind.CONTRADICTION()
    for denied in vacuities(claim):
        if (denied.formula == FALSE) is is_contradiction:
            decision = decide_claim(
                claim.home, denied, work.effort, seek_drive=False, assumed=assumed_by(claim)
            )
            if decision.result.holds and decision.result.certificate is not None:
                return ClaimAnswer(claim, decision.result.certificate)
    return None


def _unknown_answer(claim: Claim, work: Work, decision: ClaimDecision) -> ClaimAnswer:
    """Return that a claim is in doubt; with the cause and what helps where that is to be explained."""
    result, assumed = decision.result, assumed_by(claim)
    if not work.explain or result.stop is None:
        return undecided(claim, result.reason)
    report = unknown_report(claim.query, assumed, result.stop, work.effort, work.seek_drive, result.reason)
    report = replace(report, option=find_remedy(claim.home, claim.query, assumed, report.cause))
    return undecided(claim, ReasonKind.TOLD(report), report=report.data)
