"""What helps a claim that ends UNKNOWN: the first option that the program takes for this claim.

Each remedy is tried for acceptance before it is named: limits are put to the claim, and the question about
drives on a road is posed. Only the answer to it is not computed.
"""

from collections.abc import Callable, Sequence
from typing import TypeAlias

from roadproof.engines.prove.doubt import Cause, Remedy
from roadproof.engines.search.question import Setting, pose, usual_model, usual_road
from roadproof.errors import InputError, UsageError
from roadproof.library.compose import negation
from roadproof.library.motion import MOTION, is_moving, limits_of, limits_said, under_limits, values_said
from roadproof.library.specification import Query, Specification
from roadproof.logic.rewrite import parameters_of

Attempt: TypeAlias = Callable[[], Remedy | None]


def remedy_of(specification: Specification, query: Query, said: Sequence[str], cause: Cause) -> Remedy | None:
    """What helps; None where the cause alone tells it, and where no option is known to help.

    ``said``: what the claim is asked under, in words.
    """
    if cause in (Cause.WORK, Cause.CLOCK, Cause.PROCESS):
        return None
    tries: dict[Cause, tuple[Attempt, ...]] = {
        Cause.SOLVER: (lambda: _declared(specification, query, said),),
        Cause.FACTS: (lambda: _limits(specification, query, said),),
        Cause.SECOND_ORDER: (lambda: _limits(specification, query, said),),
        Cause.FIRST_INSTANT: (lambda: _motion(said),),
    }
    within: Attempt = lambda: _within(specification, query, said)  # noqa: E731
    found = (attempt() for attempt in (*tries.get(cause, ()), within))
    return next((x for x in found if x is not None), None)


def _declared(specification: Specification, query: Query, said: Sequence[str]) -> Remedy | None:
    """The declared values of parameters, where some have no value yet."""
    open_ = set(parameters_of(query.formula)) - set(values_said(specification, said))
    return Remedy("fix the parameters: --declared", ("--declared",)) if open_ else None


def _motion(said: Sequence[str]) -> Remedy | None:
    if is_moving(said):
        return None
    return Remedy("add --assume motion: positions and speeds are then continuous", ("--assume", "motion"))


def _limits(specification: Specification, query: Query, said: Sequence[str]) -> Remedy | None:
    """The limits of a model for a vehicle that has none yet."""
    limited = {x.partition("(")[2].partition(")")[0] for x in limits_said(tuple(said))}
    for name in query.vehicles:
        model = usual_model(negation(query).formula, name)
        more = tuple(limits_of(query, name, model))
        if name in limited or not more:
            continue
        begun = tuple(said) if is_moving(said) else (MOTION, *said)
        try:
            under_limits(specification, query, (*begun, *more))
        except (InputError, UsageError):
            continue
        options = ("--assume", "motion", "--vehicle", f"{name}={model.name}")
        return Remedy(f"add the limits of a vehicle: {' '.join(options)}", options)
    return None


def _within(specification: Specification, query: Query, said: Sequence[str]) -> Remedy | None:
    """A question about drives on one road, where it can be posed."""
    road = usual_road(query.formula)
    try:
        question = pose(specification.library, negation(query), Setting(road=road))
        for lanes in question.lanes:
            question.bound(lanes)
    except (InputError, UsageError):
        return None
    options = ("--engine", "smt", "--road", road.name)
    what = "ask about drives on one road" + (", and assume nothing" if said else "")
    return Remedy(f"{what}: {' '.join(options)}", options, without_assumptions=bool(said))
