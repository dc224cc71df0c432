"""Where a vehicle is at any time of a drive, exactly: two double integrators (semantics §2).

On each piece the accelerations are constant, so speeds are linear and positions quadratic in time.
A piece holds from its start on: at a knot the acceleration is that of the piece which begins there.
"""

from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

from roadproof.errors import UsageError
from roadproof.world.drive import Motion


@dataclass(frozen=True)
class State:
    """One instant of one vehicle, in m, m/s and m/s²; ``time`` in s. Front-left corner of the box."""

    time: Fraction
    s: Fraction
    d: Fraction
    v_lon: Fraction
    v_lat: Fraction
    a_lon: Fraction
    a_lat: Fraction


def starts_of(motion: Motion) -> tuple[State, ...]:
    """The state at the start of every piece, in order; the first is at time 0."""
    states: list[State] = []
    time, s, d, v_lon, v_lat = Fraction(0), motion.s, motion.d, motion.v_lon, motion.v_lat
    for piece in motion.pieces:
        state = State(time, s, d, v_lon, v_lat, piece.a_lon, piece.a_lat)
        states.append(state)
        if piece.duration is not None:
            time = time + piece.duration
            moved = advance(state, piece.duration)
            s, d, v_lon, v_lat = moved.s, moved.d, moved.v_lon, moved.v_lat
    return tuple(states)


def advance(state: State, duration: Fraction) -> State:
    """``state`` after ``duration`` seconds under its own accelerations."""
    return State(
        state.time + duration,
        state.s + duration * (state.v_lon + state.a_lon * duration / 2),
        state.d + duration * (state.v_lat + state.a_lat * duration / 2),
        state.v_lon + state.a_lon * duration,
        state.v_lat + state.a_lat * duration,
        state.a_lon,
        state.a_lat,
    )


def state_at(motion: Motion, time: Fraction) -> State:
    """The state at ``time`` >= 0; past the last knot the last piece goes on. Raises ``UsageError``."""
    if time < 0:
        raise UsageError(f"time={time}: a drive starts at 0; ask for a time that is not negative")
    return states_at(motion, (time,))[0]


def states_at(motion: Motion, times: Iterable[Fraction]) -> tuple[State, ...]:
    """As ``state_at``, at many times >= 0."""
    starts = starts_of(motion)
    begun = ((starts[bisect_right(starts, x, key=lambda state: state.time) - 1], x) for x in times)
    return tuple(advance(state, time - state.time) for state, time in begun)
