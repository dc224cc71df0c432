"""Decides one claim that there is a drive, without help from other claims."""

from dataclasses import replace

from roadproof.engines.search.claim_search import search_for_claim
from roadproof.engines.search.drive_search import engine_reads_all, search_drive
from roadproof.engines.search.outcome import SearchOutcome
from roadproof.engines.search.placing import judge_as
from roadproof.engines.setting import Search
from roadproof.errors import UsageError
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.answer_files import OpenVerdict
from roadproof.evidence.assuming import values_of
from roadproof.evidence.claim import Claim
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.assumption import Assumption
from roadproof.library.bind import values_with
from roadproof.library.compose import negation
from roadproof.logic.formula import is_state
from roadproof.logic.rewrite import is_cubic_state
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime.budget import NO_COST, Cost, Work
from roadproof.verdict import Verdict

BRIEF = 0.25  # units of work for a proof before sampled states are looked at


def decide_existence(claim: Claim, work: Work) -> tuple[ClaimAnswer, Cost]:
    """Return the result of a search; if ``work`` includes proofs, a proof that there is no drive comes first.

    Raises ``BudgetExceeded``.
    """
    effort = work.effort.with_clock_started()
    search = search_for_claim(claim, replace(work, effort=effort))
    first = _decide_without_search(claim, search, work) if work.proof else None
    if first is not None:
        return first, NO_COST
    outcome = search_drive(search)
    drive = None
    if work.proof and outcome.verdict is Verdict.NONE_WITHIN:
        from roadproof.engines.search.dense_candidates import falsifying_drive

        drive = falsifying_drive(search)
    stages = {name: x for name, x in outcome.seconds.items() if name != "all"}
    cost = Cost(stages=stages, sizes=outcome.sizes)
    return (
        ClaimAnswer(claim, drive)
        if drive is not None
        else answer_from_outcome(claim, outcome, outcome.reason)
    ), cost


def decide_existence_simply(claim: Claim, work: Work) -> tuple[ClaimAnswer, Cost]:
    """Return the result of a search with a simplified drive; UNKNOWN where no search can be set up.

    Raises ``BudgetExceeded``.
    """
    try:
        answer, cost = decide_existence(claim, work)
    except UsageError as error:  # a grid that is too fine, a comparison too steep
        return undecided(claim, ReasonKind.NO_SEARCH(error)), NO_COST
    if answer.drive is None:
        return answer, cost
    from roadproof.engines.search.minimal import simplest

    file = simplest(answer.drive.file, claim.query, claim.home.library)
    shown = judge_as(file, claim.query, claim.home.library)
    return (answer if shown is None else ClaimAnswer(claim, shown)), cost


def _decide_without_search(claim: Claim, search: Search, work: Work) -> ClaimAnswer | None:
    """Decide by constant motion or by a proof, before any search; None where neither does."""
    from roadproof.engines.prove.prover import prove  # here: a search without proofs needs no prover

    effort, never = search.search_options.effort, negation(claim.query)
    drive = _constant_motion(claim, search)
    if drive is not None:
        return ClaimAnswer(claim, drive)
    proof = prove(claim.home, never, effort.with_units(min(work.proof, effort.units)))
    if proof.holds and proof.certificate is not None:
        return ClaimAnswer(claim, proof.certificate)
    if is_state(claim.formula) and not engine_reads_all(search):
        return _decide_at_values(claim, search) or undecided(claim, ReasonKind.NO_STATE())
    return None


def _constant_motion(claim: Claim, search: Search) -> JudgedDrive | None:
    """Return a drive of constant motion for a claim about one instant that the engine cannot encode."""
    from roadproof.engines.prove.prover import prove
    from roadproof.engines.search.refute import sampled_drive

    never = negation(claim.query)
    if not is_cubic_state(never.formula) or engine_reads_all(search):
        return None
    effort = search.search_options.effort
    if prove(claim.home, never, effort.with_units(min(BRIEF, effort.units))).holds:
        return None
    known = values_with(claim.home.library, search.setting.values)
    return sampled_drive(claim.home, never, known, search.setting)


def _decide_at_values(claim: Claim, search: Search) -> ClaimAnswer | None:
    """Decide a claim about one instant that no engine can encode, with its parameter values put in."""
    from roadproof.engines.prove.prover import prove
    from roadproof.engines.search.constant_motion import steady_drive

    never, effort = negation(claim.query), search.search_options.effort
    result = prove(claim.home, never, effort, assumed=Assumption(values_of(claim)))
    if result.holds and result.certificate is not None:
        return ClaimAnswer(claim, result.certificate)
    if result.countermodel is None:
        return None
    known = values_with(claim.home.library, search.setting.values)
    drive = steady_drive(claim.home, never, result.countermodel, known)
    return None if drive is None else ClaimAnswer(claim, drive)


def refute_with_trees(claim: Claim, work: Work) -> ClaimAnswer:
    """Return NONE-WITHIN with refutation trees, or UNKNOWN where none are found."""
    from roadproof.engines.search.none_within import refute_with_trees

    trees = refute_with_trees(search_for_claim(claim, work))
    return undecided(claim, ReasonKind.NO_TREES()) if trees is None else ClaimAnswer(claim, trees)


def answer_from_outcome(claim: Claim, outcome: SearchOutcome, reason: Reason) -> ClaimAnswer:
    """Return the outcome of a search as an answer."""
    if outcome.drives:
        return ClaimAnswer(claim, outcome.drives[0])
    if outcome.impossibility is not None:
        return ClaimAnswer(claim, outcome.impossibility.of_core)
    limits = None if outcome.limits is None else outcome.limits.as_json()
    verdict: OpenVerdict = Verdict.NONE_WITHIN if outcome.verdict is Verdict.NONE_WITHIN else Verdict.UNKNOWN
    return undecided(claim, reason, verdict, limits)
