"""Parts of a storyboard's motion that no vehicle can drive, or that exceed a vehicle's own Performance."""

import itertools
from collections.abc import Iterator, Mapping

from roadproof.extensions.exchange.storyboard.box import ObjectBox
from roadproof.extensions.exchange.storyboard.conditions import TICKS
from roadproof.extensions.exchange.storyboard.play import Play
from roadproof.extensions.exchange.storyboard.positions import ObjectState

_STEP = 0.1
"""m/s: a larger change of a speed within a tick, beside that by the acceleration, is a step."""
_MORE = 1e-6


def faults_of(play: Play, boxes: Mapping[str, ObjectBox]) -> tuple[str, ...]:
    """Return the first fault of each kind of each motor vehicle, in words."""
    faults: list[str] = []
    for name, box in boxes.items():
        if box.recorded:
            states = [x.get(name) for x in play.states]
            faults += [f"vehicle {name} {x}" for x in (*_steps(states), *_excesses(states, box.limits))]
    return tuple(faults)


def _steps(states: list[ObjectState | None]) -> Iterator[str]:
    """A line for a step of the speed along the road, and one for a step across it."""
    for speed, rate, direction in (("v_lon", "a_lon", ""), ("v_lat", "a_lat", " across the road")):
        for tick, (before, after) in enumerate(itertools.pairwise(states), start=1):
            if before is None or after is None or before.forward != after.forward:
                continue
            low, high = getattr(before, speed), getattr(after, speed)
            most = max(abs(getattr(x, rate)) for x in (before, after)) / TICKS
            if abs(high - low) > most + _STEP:
                change = f"from {low:.4g} to {high:.4g} m/s"
                yield f"changes its speed{direction} {change} in no time at {tick / TICKS:g} s"
                break


def _excesses(states: list[ObjectState | None], limits: tuple[float, float, float]) -> Iterator[str]:
    """A line for each limit of the Performance that the motion exceeds."""
    fastest, quickest, hardest = limits
    for what, unit, most, value in (
        ("maxSpeed", "m/s", fastest, lambda x: abs(x.v_lon)),
        ("maxAcceleration", "m/s²", quickest, lambda x: _forwards(x)),
        ("maxDeceleration", "m/s²", hardest, lambda x: -_forwards(x)),
    ):
        over = [(k, value(x)) for k, x in enumerate(states) if x is not None and value(x) > most + _MORE]
        if over:
            begin, worst = over[0][0] / TICKS, max(x for _, x in over)
            limit = f"{what}={most:g} {unit} of its Performance"
            yield f"exceeds {limit} from {begin:g} s on: {worst:.4g} {unit}"


def _forwards(state: ObjectState) -> float:
    """The acceleration in the direction in which a vehicle moves (m/s²)."""
    return state.a_lon if state.v_lon >= 0 else -state.a_lon
