"""A claim that there is a drive, settled by itself."""

from dataclasses import replace

from roadproof.engines.search.ask import ask, reads_all
from roadproof.engines.search.looking import mode_of, search_of
from roadproof.engines.search.outcome import Outcome, Search
from roadproof.engines.search.placing import judged_as
from roadproof.errors import UsageError
from roadproof.evidence.answer import Answer, undecided, values_of
from roadproof.evidence.answer_files import OpenVerdict
from roadproof.evidence.claim import Claim
from roadproof.evidence.judged import JudgedDrive
from roadproof.library.bind import values_with
from roadproof.library.compose import negation
from roadproof.library.motion import Assumption
from roadproof.logic.formula import is_state
from roadproof.logic.rewrite import is_cubic_state
from roadproof.reasons import Reason, Why
from roadproof.runtime.budget import Work
from roadproof.runtime.cost import NO_COST, Cost
from roadproof.verdict import Verdict

BRIEF = 0.25  # units of work for a proof before sampled states are looked at


def seek(claim: Claim, work: Work) -> tuple[Answer, Cost]:
    """Return what a search comes to; where ``work`` has proofs, one that there is no drive is tried first.

    Raises ``BudgetExceeded``.
    """
    effort = work.effort.running()
    search = search_of(claim, replace(work, effort=effort))
    first = _decided(claim, search, work) if work.proof else None
    if first is not None:
        return first, NO_COST
    found = ask(search)
    drive = None
    if work.proof and found.verdict is Verdict.NONE_WITHIN:
        from roadproof.engines.search.dense_candidates import falsifying_drive

        drive = falsifying_drive(search)
    stages = {name: x for name, x in found.seconds.items() if name != "all"}
    cost = Cost(stages=stages, sizes=found.sizes)
    return (Answer(claim, drive) if drive is not None else answer_of(claim, found, found.reason)), cost


def seek_simple(claim: Claim, work: Work) -> tuple[Answer, Cost]:
    """Return what a search comes to, with a simpler drive; in doubt where no search can be set up.

    Raises ``BudgetExceeded``.
    """
    try:
        answer, cost = seek(claim, work)
    except UsageError as error:  # a grid that is too fine, a comparison too steep
        road = mode_of(claim).road
        return undecided(claim, Why.NO_SEARCH("it" if road is None else road.name, error)), NO_COST
    if answer.drive is None:
        return answer, cost
    from roadproof.engines.search.minimal import simplest

    file = simplest(answer.drive.file, claim.query, claim.home.library)
    shown = judged_as(file, claim.query, claim.home.library)
    return (answer if shown is None else Answer(claim, shown)), cost


def _decided(claim: Claim, search: Search, work: Work) -> Answer | None:
    """Return what is decided before a search: by constant motion, or by a proof."""
    from roadproof.engines.prove.prover import prove  # here: a search without proofs needs no prover

    effort, never = search.search_options.effort, negation(claim.query)
    drive = _constant(claim, search)
    if drive is not None:
        return Answer(claim, drive)
    proof = prove(claim.home, never, effort.of(min(work.proof, effort.units)))
    if proof.holds and proof.certificate is not None:
        return Answer(claim, proof.certificate)
    if is_state(claim.formula) and not reads_all(search):
        return _at_values(claim, search) or undecided(claim, Why.NO_STATE())
    return None


def _constant(claim: Claim, search: Search) -> JudgedDrive | None:
    """Return constant motion, of a claim about one instant that no engine reads."""
    from roadproof.engines.prove.prover import prove
    from roadproof.engines.search.refute import sampled_drive

    never = negation(claim.query)
    if not is_cubic_state(never.formula) or reads_all(search):
        return None
    effort = search.search_options.effort
    if prove(claim.home, never, effort.of(min(BRIEF, effort.units))).holds:
        return None
    known = values_with(claim.home.library, search.setting.values)
    return sampled_drive(claim.home, never, known, search.setting)


def _at_values(claim: Claim, search: Search) -> Answer | None:
    """Return the answer to a claim about one instant that no engine can search: with its values put in."""
    from roadproof.engines.prove.prover import prove
    from roadproof.engines.search.constant_motion import steady_drive

    never, effort = negation(claim.query), search.search_options.effort
    result = prove(claim.home, never, effort, assumed=Assumption(values_of(claim)))
    if result.holds and result.certificate is not None:
        return Answer(claim, result.certificate)
    if result.countermodel is None:
        return None
    known = values_with(claim.home.library, search.setting.values)
    drive = steady_drive(claim.home, never, result.countermodel, known)
    return None if drive is None else Answer(claim, drive)


def with_trees(claim: Claim, work: Work) -> Answer:
    """Return that there is no drive within limits, with trees that show it, where they are found."""
    from roadproof.engines.search.none_within import refute

    trees = refute(search_of(claim, work))
    return undecided(claim, Why.NO_TREES()) if trees is None else Answer(claim, trees)


def answer_of(claim: Claim, found: Outcome, reason: Reason) -> Answer:
    """Return what a search came to as an answer."""
    if found.drives:
        return Answer(claim, found.drives[0])
    if found.impossibility is not None:
        return Answer(claim, found.impossibility.of_core)
    limits = None if found.limits is None else found.limits.as_json()
    verdict: OpenVerdict = Verdict.NONE_WITHIN if found.verdict is Verdict.NONE_WITHIN else Verdict.UNKNOWN
    return undecided(claim, reason, verdict, limits)
