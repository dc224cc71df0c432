"""An independent simulation: drivers stepped at a clock's rate, boxes compared at every step.

It knows nothing of formulas. docs/explanation/preventable.md names the sources of its driver models.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
G = 9.81
FULL, RAMP, DELAY, EVALUATION, WANDER, DRIFT = 0.774 * G, 0.6, 0.75, 0.4, 0.375, 0.72


@dataclass(frozen=True)
class Outcome:
    """Whether boxes overlapped, and how near the least gap (m) was to doing otherwise."""

    collided: NDArray[np.bool_]
    nearest: Floats


def careful(onset: Floats):
    """Braking (m/s^2) as a function of time."""
    return lambda time: np.clip((time - onset) / RAMP, 0, 1) * FULL


def at_once(onset: Floats, full: float):
    return lambda time: np.where(time >= onset, full, 0.0)


def gated_onset(x, gate: str) -> Floats:
    """When braking begins behind a gate of a time to collision of 2 s; infinite where it never opens."""
    with np.errstate(divide="ignore"):
        opens = np.where(x["dV0"] > 0, x["dx0"] / x["dV0"] - 2, np.inf)
    seen = WANDER / x["Vy"]
    if gate == "before_perception":
        return np.maximum(seen, opens) + EVALUATION + DELAY
    return np.maximum(seen + EVALUATION, opens) + DELAY


def step_cut_in(v, w, gap, lengths, beside, lateral, braking, rate, seconds) -> Outcome:
    """POV at constant speed w comes in at ``lateral``; a collision while the boxes overlap across.

    It is otherwise where SV comes as far as POV's rear, or not, once POV is in; or has passed it before, even
    where it is beside it again then.
    """
    arrives = beside / lateral
    speed, gained = v.astype(float).copy(), np.zeros_like(v)
    farthest, past = np.full(len(v), -np.inf), np.full(len(v), -np.inf)
    begun = np.zeros(len(v), bool)
    for step in range(int(seconds * rate)):
        time = step / rate
        across = time >= arrives
        # Having passed it before it came in is no collision with it.
        past = np.where(begun, past, np.maximum(past, gained - gap - lengths))
        begun |= across
        inside = across & (past < 0)
        farthest = np.where(inside, np.maximum(farthest, gained - gap), farthest)
        faster = np.maximum(speed - braking(time + 0.5 / rate) / rate, 0)
        gained += (speed + faster) / 2 / rate - w / rate
        speed = faster
        if begun.all() and not speed.any():
            break  # whoever stands has braked, and stays where it is
    return Outcome(farthest > 0, np.minimum(np.abs(farthest), np.abs(past)))


def step_deceleration(v, w, gap, other_braking, braking, rate, seconds) -> Outcome:
    """POV brakes from w until it stands."""
    speed, other = v.astype(float).copy(), w.astype(float).copy()
    left = gap.astype(float).copy()
    least = left.copy()
    for step in range(int(seconds * rate)):
        time = (step + 0.5) / rate
        slower = np.maximum(other - other_braking / rate, 0)
        faster = np.maximum(speed - braking(time) / rate, 0)
        left += (other + slower - speed - faster) / 2 / rate
        least = np.minimum(least, left)
        speed, other = faster, slower
        if not (speed.any() or other.any()):
            break
    return Outcome(least < 0, np.abs(least))


def stopping_way(v: Floats, braking, rate: int, seconds: float) -> Floats:
    """How far SV goes until it stands."""
    speed, gone = v.astype(float).copy(), np.zeros_like(v)
    for step in range(int(seconds * rate)):
        slower = np.maximum(speed - braking((step + 0.5) / rate) / rate, 0)
        gone += (speed + slower) / 2 / rate
        speed = slower
        if not speed.any():
            break
    return gone
