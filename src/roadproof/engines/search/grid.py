"""On which grid a formula is looked at: the coarsest whose steps divide its durations."""

from collections.abc import Collection, Mapping
from fractions import Fraction
from math import ceil

from roadproof.engines.encode.unroll import Grid, common_step
from roadproof.errors import UsageError
from roadproof.logic.formula import Formula
from roadproof.logic.fragment import intervals_of
from roadproof.logic.rewrite import bounds_of, with_values

COARSEST = Fraction(3, 5)
MOST_STEPS = 400


def make_grid(horizon: Fraction, dt: Fraction) -> Grid:
    """Raises ``UsageError`` unless the horizon is a sensible multiple of dt."""
    if dt <= 0 or horizon <= 0:
        raise UsageError(f"horizon={horizon} s and dt={dt} s must be greater than 0")
    steps = horizon / dt
    if steps.denominator != 1:
        raise UsageError(
            f"horizon={horizon} s is no multiple of dt={dt} s: choose a horizon "
            f"such as {dt * (int(steps) + 1)} s, or another dt"
        )
    if steps > MOST_STEPS:
        raise UsageError(
            f"horizon={horizon} s with dt={dt} s is {steps} steps; at most {MOST_STEPS} are allowed"
        )
    return Grid(dt, int(steps))


def fitting_grid(horizon: Fraction, formula: Formula, values: Mapping[str, Fraction]) -> Grid:
    """The coarsest grid, of at most 3/5 s, of whose step all durations and the horizon are multiples.

    Where only the horizon is in the way, it grows to a multiple. Raises ``UsageError`` where the grid
    would have too many steps.
    """
    step = Fraction(0)
    found = durations(formula, values)
    for duration in found:
        step = common_step(step, duration)
    dt = coarsest(step)
    with_horizon = coarsest(common_step(step, horizon))
    if with_horizon < dt / 4:
        horizon, with_horizon = ceil(horizon / dt) * dt, dt
    if horizon / with_horizon > MOST_STEPS:
        raise UsageError(
            f"horizon={horizon} s is {horizon / with_horizon} steps of dt={with_horizon} s, the coarsest of "
            f"which all durations of the formula are multiples ({_some(found)}); at most {MOST_STEPS} are "
            "allowed: give parameters and windows durations that are multiples of a longer time, or choose a "
            "shorter horizon"
        )
    return make_grid(horizon, with_horizon)


def _some(found: Collection[Fraction]) -> str:
    """Some durations in seconds, the shortest first."""
    shown = [f"{x} s" for x in sorted(x for x in found if x)]
    return ", ".join(shown[:6]) + (", …" if len(shown) > 6 else "")


def coarsest(step: Fraction, most: Fraction = COARSEST) -> Fraction:
    """The greatest part of ``step``, one over a whole number, that is at most ``most``; of 0 it is that."""
    return step / ceil(step / most) if step else most


def durations(formula: Formula, values: Mapping[str, Fraction]) -> set[Fraction]:
    """The finite bounds of all intervals, in s, with parameters at ``values``."""
    bounds = (bounds_of(interval) for interval in intervals_of(with_values(formula, values)))
    return {bound for pair in bounds for bound in pair if bound is not None}
