"""What helps a claim that ends UNKNOWN: the first option that the program takes for this claim.

Each remedy is tried for acceptance before it is named: limits are put to the claim, and the question about
drives on a road is posed. Only the answer to it is not computed.
"""

from collections.abc import Callable, Sequence
from typing import TypeAlias

from roadproof.engines.prove.doubt import WEAKER, Cause
from roadproof.engines.search.question import Setting, pose, usual_model, usual_road
from roadproof.errors import InputError, UsageError
from roadproof.library.compose import negation
from roadproof.library.motion import MOTION, is_moving, limits_of, limits_said, under_limits, values_said
from roadproof.library.specification import Query, Specification
from roadproof.logic.rewrite import parameters_of

Attempt: TypeAlias = Callable[[], str | None]
# What a user can do in words where no option helps.
_IN_WORDS = {
    Cause.INDUCTION: "bound the time, such as F[0, 10 s] and G[0, 10 s]",
    Cause.ALTERNATION: "bound the time, such as F[0, 10 s] and G[0, 10 s]",
    Cause.LANES: "name the lanes (L, L1) instead of quantifying over them",
    Cause.CERTIFICATE: "state the parts of the claim as claims of their own",
    Cause.SOLVER: "bound the signals in the premise",
}


def remedy_of(specification: Specification, query: Query, said: Sequence[str], cause: Cause) -> str | None:
    """The option or premise that helps, as an imperative; None where the cause alone tells it.

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
    for attempt in (*tries.get(cause, ()), within):
        found = attempt()
        if found is not None:
            return found
    return _IN_WORDS.get(cause, WEAKER)


def _declared(specification: Specification, query: Query, said: Sequence[str]) -> str | None:
    """The declared values of parameters, where some have no value yet."""
    open_ = set(parameters_of(query.formula)) - set(values_said(specification, said))
    return "fix the parameters: --declared" if open_ else None


def _motion(said: Sequence[str]) -> str | None:
    return None if is_moving(said) else "add --assume motion: positions and speeds are then continuous"


def _limits(specification: Specification, query: Query, said: Sequence[str]) -> str | None:
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
        return f"add the limits of a vehicle: --assume motion --vehicle {name}={model.name}"
    return None


def _within(specification: Specification, query: Query, said: Sequence[str]) -> str | None:
    """A question about drives on one road, where it can be posed."""
    road = usual_road(query.formula)
    try:
        question = pose(specification.library, negation(query), Setting(road=road))
        for lanes in question.lanes:
            question.bound(lanes)
    except (InputError, UsageError):
        return None
    option = f"--engine smt --road {road.name}"
    if not said:
        return f"ask about drives on one road: {option}"
    return f"ask about drives on one road, and assume nothing: {option}"
