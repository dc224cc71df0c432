"""Claims about one instant that no engine reads: constant motion against them, from sampled states."""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from roadproof.engines.search.constant_motion import steady_drive
from roadproof.engines.search.initial_candidates import space_of
from roadproof.engines.search.question import Setting, pose
from roadproof.engines.search.sampling import Space, states
from roadproof.evidence.judged import JudgedDrive
from roadproof.evidence.refutation import Countermodel, Instant
from roadproof.library.bind import bind, values_with
from roadproof.library.compose import negation
from roadproof.library.specification import Query, Specification
from roadproof.logic.fragment import is_cubic_state
from roadproof.logic.terms import Signal
from roadproof.world.vehicle import Range


def sampled_drive(
    specification: Specification, claim: Query, values: Mapping[str, Fraction], setting: Setting
) -> JudgedDrive | None:
    """A drive of constant motion on which ``claim`` is false at time 0, or None where none was found.

    States are looked for within what the vehicles of ``setting`` can do, then around that; the drive need
    not keep their limits. ``values`` of parameters, SI. Only for claims about one instant that speak of the
    signals of vehicles and of nothing else; of others it is None.
    """
    against = negation(claim)
    if not claim.vehicles or not is_cubic_state(claim.formula):
        return None
    library = specification.library
    question = pose(library, against, replace(setting, values=values))
    formula = bind(against.formula, question.road, {}, question.values)
    inside = space_of(question)
    for space in (inside, _around(inside)):
        for state in states(formula, space, 1):
            now = {f"{x.name}({x.vehicle})": value for x, value in state.items()}
            now |= {f"{x.name}({x.vehicle})": value for x, value in space.sizes.items()}
            found = Countermodel((Instant(Fraction(0), now, {}),), values_with(library, values), "before")
            drive = steady_drive(specification, claim, found, values_with(library, values))
            if drive is not None:
                return drive
    return None


def _around(space: Space) -> Space:
    """As much again on both sides of every range; no vehicle reverses."""

    def wider(signal: Signal, ends: Range) -> Range:
        low, high = ends
        below = low - (high - low)
        return (max(below, Fraction(0)) if signal.name == "v_lon" else below), high + (high - low)

    return Space({x: wider(x, ends) for x, ends in space.ranges.items()}, space.sizes)
