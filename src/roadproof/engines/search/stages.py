"""A search for a drive in stages, each with work of its own, on a grid that fits the durations of a formula.

Bounds of intervals have to be multiples of dt. The coarsest dt that divides them is taken; where that would
be too fine, drives are looked for at coarser durations nearby, and judged at the exact ones.
"""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from math import ceil, floor
from typing import Literal, TypeAlias

from roadproof.engines.encode.unroll import common_step
from roadproof.engines.search.ask import judge_found
from roadproof.engines.search.known_drive import offered
from roadproof.engines.search.outcome import Search
from roadproof.engines.search.placing import judged_as
from roadproof.engines.search.question import COARSEST, Setting, coarsest, durations, exists, pose
from roadproof.engines.search.search import Attempt, find_witness, show_none
from roadproof.errors import UsageError
from roadproof.evidence.answer import Answer, undecided
from roadproof.evidence.claim import Claim, Exists, Means, claim_of
from roadproof.library.bind import values_with
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import intervals_of, is_cubic_state
from roadproof.logic.terms import Parameter, leaves
from roadproof.reasons import Reason, Why
from roadproof.semantics.exact.replay import first_overlap
from roadproof.verdict import Verdict

MOST_STEPS = 40  # beyond, searches seldom come to an end
REFINEMENTS = 2
Stage: TypeAlias = Literal["natural", "plain", "none"]


def look(claim: Claim, search: Search) -> Answer:
    """Return the answer to a claim about drives, after one stage or more of the ``search`` for one.

    Raises ``UsageError``, ``MissingSolverError``, ``BudgetExceeded``.
    """
    mode = claim.mode
    assert isinstance(mode, Exists)
    apart = mode.horizon if mode.apart is None else mode.apart
    reason: Reason = Why.NO_DRIVE()
    for stage in _stages(claim, mode):
        for horizon in _horizons(mode, apart):
            problem = pose(
                claim.home.library,
                claim.query,
                replace(search.setting, natural=stage == "natural", horizon=horizon),
            )
            attempt: Attempt = (show_none if stage == "none" else find_witness)(
                problem, search.search_options
            )
            if attempt.found is None:
                reason = attempt.reason
                break
            overlap = first_overlap(attempt.found.drive, apart)
            if overlap is None or mode.collisions:
                file = offered(judge_found(search, problem, attempt.found).file, claim)
                shown = judged_as(file, claim.query, claim.home.library)
                return undecided(claim, Why.FOUND_REJECTED()) if shown is None else Answer(claim, shown)
            reason = Why.FOUND_OVERLAP(overlap)
        if attempt.verdict is Verdict.NONE_WITHIN and horizon == mode.horizon:
            limits = None if attempt.limits is None else attempt.limits.as_json()
            return undecided(claim, reason, Verdict.NONE_WITHIN, limits)
    return undecided(claim, reason)


def _stages(claim: Claim, mode: Exists) -> Iterator[Stage]:
    """The stages, without the last word of an engine for formulas that have a proof in place of it."""
    none: list[Stage] = ["none"] if mode.explain and not is_cubic_state(claim.formula) else []
    yield from ("natural", "plain", *none) if mode.natural else ("plain", *none, "natural")


def _horizons(mode: Exists, apart: Fraction) -> tuple[Fraction, ...]:
    """The horizon of a claim; then, where boxes overlap soon after it, a longer one."""
    dt = mode.dt or COARSEST
    longer = ceil(apart / dt) * dt
    return (mode.horizon, longer) if longer / dt <= 2 * MOST_STEPS else (mode.horizon,)


def staged_claim(search: Search, natural: bool = True, by: Means = "search", explain: bool = True) -> Claim:
    """Return the claim that a search in stages answers.

    ``natural``: natural drives come first, and not last. ``explain``: that there is none is looked for, too.
    Boxes stay apart until the horizon and, after it, the longest duration: so a danger that begins by then
    does not last because vehicles drive through each other.
    """
    setting = search.setting
    halvings = floor(dt_of(setting) / finest(setting)).bit_length() - 1
    mode = replace(
        exists(setting, search.search_options),
        natural=natural,
        by=by,
        explain=explain,
        refinements=min(REFINEMENTS, halvings),
        apart=setting.horizon + max(_durations(search), default=Fraction(0)),
    )
    return claim_of(search.specification, search.query, mode, setting.values)


def _durations(search: Search) -> set[Fraction]:
    return durations(search.query.formula, values_of(search))


def values_of(search: Search) -> dict[str, Fraction]:
    """The value of every parameter."""
    return values_with(search.specification.library, search.setting.values)


def fit_grid(search: Search) -> Search | None:
    """The search on the coarsest grid, of at most its dt, that its durations are multiples of.

    The horizon grows to a multiple of dt. None where that grid would have more than ``MOST_STEPS``.
    """
    step = Fraction(0)
    for duration in _durations(search):
        step = common_step(step, duration)
    setting = search.setting
    dt = coarsest(step, dt_of(setting))
    if dt < finest(setting):
        return None
    return replace(search, setting=replace(setting, dt=dt, horizon=ceil(setting.horizon / dt) * dt))


def stand_ins(search: Search) -> list[Search]:
    """The search with the parameters that are durations rounded up, and down, to half its dt.

    Raises ``UsageError`` where that does not make a grid either.
    """
    grain = dt_of(search.setting) / 2
    found: list[Search] = []
    for rounding in (ceil, floor):
        values = values_of(search)
        for name in duration_parameters(search.query.formula):
            values[name] = rounding(values[name] / grain) * grain
        fitting = fit_grid(replace(search, setting=replace(search.setting, values=values)))
        if fitting is None:
            raise UsageError(
                f"the intervals of the formula have no common step of {float(finest(search.setting)):g} s "
                "or more, whatever its parameters are: use bounds that are multiples of one time"
            )
        found.append(fitting)
    return found


def dt_of(setting: Setting) -> Fraction:
    """The coarsest step that may be taken, in s."""
    return setting.dt or COARSEST


def finest(setting: Setting) -> Fraction:
    """The finest step that is taken, in s."""
    return min(dt_of(setting), setting.horizon / MOST_STEPS)


def duration_parameters(formula: Formula) -> tuple[str, ...]:
    """The parameters that bounds of intervals are made of, sorted."""
    terms = [t for x in intervals_of(formula) for t in (x.low, x.high) if t is not None]
    return tuple(sorted({leaf.name for t in terms for leaf in leaves(t) if isinstance(leaf, Parameter)}))
