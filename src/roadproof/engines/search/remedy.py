"""Finds a remedy for a claim that ends UNKNOWN: the first option that the program accepts for it.

Each remedy is tested for acceptance before it is named: limits are applied to the claim, and the question
about drives on a road is set up. Only its answer is not computed.
"""

from collections.abc import Callable, Sequence
from typing import TypeAlias

from roadproof.engines.prove.unknown import Cause, Remedy
from roadproof.engines.search.question import pose, usual_model
from roadproof.engines.search.usual_road import usual_road
from roadproof.engines.setting import Setting
from roadproof.errors import InputError, UsageError
from roadproof.library.assumption import MOTION, assumes_motion, limits_in
from roadproof.library.compose import negation
from roadproof.library.motion import limits_of, under_limits, values_in
from roadproof.library.specification import Query, Specification
from roadproof.logic.rewrite import parameters_of

RemedyTry: TypeAlias = Callable[[], Remedy | None]


def find_remedy(
    specification: Specification, query: Query, assumed: Sequence[str], cause: Cause
) -> Remedy | None:
    """Return a remedy; None where the cause alone gives it, and where no option is known to help.

    ``assumed``: the assumptions of the claim, in words.
    """
    if cause in (Cause.WORK, Cause.CLOCK, Cause.PROCESS):
        return None
    tries: dict[Cause, tuple[RemedyTry, ...]] = {  # partial: other causes have no remedy of their own
        Cause.SOLVER: (lambda: _declared(specification, query, assumed),),
        Cause.FACTS: (lambda: _limits(specification, query, assumed),),
        Cause.SECOND_ORDER: (lambda: _limits(specification, query, assumed),),
        Cause.FIRST_INSTANT: (lambda: _motion(assumed),),
    }
    within: RemedyTry = lambda: _within(specification, query, assumed)  # noqa: E731
    remedies = (attempt() for attempt in (*tries.get(cause, ()), within))
    return next((x for x in remedies if x is not None), None)


def _declared(specification: Specification, query: Query, assumed: Sequence[str]) -> Remedy | None:
    """The declared values of parameters, where some have no value yet."""
    open_ = set(parameters_of(query.formula)) - set(values_in(specification, assumed))
    return Remedy("fix the parameters: --declared", ("--declared",)) if open_ else None


def _motion(assumed: Sequence[str]) -> Remedy | None:
    if assumes_motion(assumed):
        return None
    return Remedy("add --assume motion: positions and speeds are then continuous", ("--assume", "motion"))


def _limits(specification: Specification, query: Query, assumed: Sequence[str]) -> Remedy | None:
    """The limits of a model for a vehicle that has none yet."""
    limited = {x.partition("(")[2].partition(")")[0] for x in limits_in(tuple(assumed))}
    for name in query.vehicles:
        model = usual_model(negation(query).formula, name)
        more = tuple(limits_of(query, name, model))
        if name in limited or not more:
            continue
        with_motion = tuple(assumed) if assumes_motion(assumed) else (MOTION, *assumed)
        try:
            under_limits(specification, query, (*with_motion, *more))
        except (InputError, UsageError):
            continue
        options = ("--assume", "motion", "--vehicle", f"{name}={model.name}")
        return Remedy(f"add the limits of a vehicle: {' '.join(options)}", options)
    return None


def _within(specification: Specification, query: Query, assumed: Sequence[str]) -> Remedy | None:
    """A question about drives on one road, where it can be posed."""
    road = usual_road(query.formula)
    try:
        question = pose(specification.library, negation(query), Setting(road=road))
        for lanes in question.lanes:
            question.bound(lanes)
    except (InputError, UsageError):
        return None
    options = ("--engine", "smt", "--road", road.name)
    what = "ask about drives on one road" + (", and assume nothing" if assumed else "")
    return Remedy(f"{what}: {' '.join(options)}", options, without_assumptions=bool(assumed))
