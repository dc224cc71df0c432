"""Searches a drive in stages, each with work of its own, on a grid that fits the formula's durations.

Bounds of intervals must be multiples of dt. The coarsest dt that divides them is taken; if that would be
too fine, drives are searched at coarser durations nearby, and judged at the exact ones.
"""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from math import ceil
from typing import Literal, TypeAlias

from roadproof.engines.search.drive_search import as_judged_drive
from roadproof.engines.search.known_drive import file_for_claim
from roadproof.engines.search.placing import judge_as
from roadproof.engines.search.question import COARSEST, pose
from roadproof.engines.search.search import SearchStep, find_witness, show_none
from roadproof.engines.setting import Search
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.claim import Claim, Exists
from roadproof.logic.rewrite import is_cubic_state
from roadproof.reasons import Reason, ReasonKind
from roadproof.semantics.exact.replay import first_overlap
from roadproof.verdict import Verdict

MOST_STEPS = 40  # beyond, searches seldom come to an end
Stage: TypeAlias = Literal["natural", "plain", "none"]


def search_in_stages(claim: Claim, search: Search) -> ClaimAnswer:
    """Return the answer to a claim about drives, after one stage or more of the ``search`` for one.

    Raises ``UsageError``, ``MissingSolverError``, ``BudgetExceeded``.
    """
    mode = claim.mode
    assert isinstance(mode, Exists)
    apart = mode.horizon if mode.apart is None else mode.apart
    reason: Reason = ReasonKind.NO_DRIVE()
    for stage in _stages(claim, mode):
        for horizon in _horizons(mode, apart):
            problem = pose(
                claim.home.library,
                claim.query,
                replace(search.setting, natural=stage == "natural", horizon=horizon),
            )
            attempt: SearchStep = (show_none if stage == "none" else find_witness)(
                problem, search.search_options
            )
            if attempt.witness is None:
                reason = attempt.reason
                break
            overlap = first_overlap(attempt.witness.drive, apart)
            if overlap is None or mode.collisions:
                file = file_for_claim(as_judged_drive(search, problem, attempt.witness).file, claim)
                shown = judge_as(file, claim.query, claim.home.library)
                return (
                    undecided(claim, ReasonKind.FOUND_REJECTED())
                    if shown is None
                    else ClaimAnswer(claim, shown)
                )
            reason = ReasonKind.FOUND_OVERLAP(overlap)
        if attempt.verdict is Verdict.NONE_WITHIN and horizon == mode.horizon:
            limits = None if attempt.limits is None else attempt.limits.as_json()
            return undecided(claim, reason, Verdict.NONE_WITHIN, limits)
    return undecided(claim, reason)


def _stages(claim: Claim, mode: Exists) -> Iterator[Stage]:
    """The stages, without the last word of an engine for formulas that have a proof in place of it."""
    none: tuple[Stage, ...] = ("none",) if mode.explain and not is_cubic_state(claim.formula) else ()
    yield from ("natural", "plain", *none) if mode.natural else ("plain", *none, "natural")


def _horizons(mode: Exists, apart: Fraction) -> tuple[Fraction, ...]:
    """The horizon of a claim; then, where boxes overlap soon after it, a longer one."""
    dt = mode.dt or COARSEST
    longer = ceil(apart / dt) * dt
    return (mode.horizon, longer) if longer / dt <= 2 * MOST_STEPS else (mode.horizon,)
