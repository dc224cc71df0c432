"""Claims that a search in stages answers, on grids that fit the durations of a formula."""

from dataclasses import replace
from fractions import Fraction
from math import ceil, floor

from roadproof.engines.encode.unroll import common_step
from roadproof.engines.search.question import COARSEST, coarsest, durations
from roadproof.engines.search.stages import MOST_STEPS
from roadproof.engines.setting import Search, Setting, exists_mode
from roadproof.errors import UsageError
from roadproof.evidence.claim import Claim, Means, claim_of
from roadproof.library.bind import values_with
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import intervals_of
from roadproof.logic.terms import Parameter, leaves

REFINEMENTS = 2


def staged_claim(search: Search, natural: bool = True, by: Means = "search", explain: bool = True) -> Claim:
    """Return the claim that a search in stages answers.

    ``natural``: natural drives come first, and not last. ``explain``: that there is none is looked for, too.
    Boxes stay apart until the horizon and, after it, the longest duration: so a danger that begins by then
    does not last because vehicles drive through each other.
    """
    setting = search.setting
    halvings = floor(dt_of(setting) / finest(setting)).bit_length() - 1
    mode = replace(
        exists_mode(setting, search.search_options),
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
    searches: list[Search] = []
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
        searches.append(fitting)
    return searches


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
