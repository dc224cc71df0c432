"""Where a vehicle is at any time of a drive, exactly (semantics §2).

Along the road the jerk is constant on each piece, so that the acceleration is linear in time, the speed
quadratic and the place cubic; across it the acceleration is constant, the speed linear, the place quadratic.
A piece holds from its start on: at a knot acceleration and jerk are those of the piece which begins there.
"""

from bisect import bisect_right
from collections.abc import Iterable
from fractions import Fraction

from roadproof.errors import UsageError
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Motion


@dataclass(frozen=True)
class State:
    """One instant of one vehicle, in m, m/s, m/s² and m/s³; ``time`` in s. Front-left corner of the box."""

    time: Fraction
    s: Fraction
    d: Fraction
    v_lon: Fraction
    v_lat: Fraction
    a_lon: Fraction
    a_lat: Fraction
    j_lon: Fraction


def starts_of(motion: Motion) -> tuple[State, ...]:
    """The state at the start of every piece, in order; the first is at time 0."""
    states: list[State] = []
    time, s, d, v_lon, v_lat = Fraction(0), motion.s, motion.d, motion.v_lon, motion.v_lat
    for piece in motion.pieces:
        state = State(time, s, d, v_lon, v_lat, piece.a_lon, piece.a_lat, piece.j_lon)
        states.append(state)
        if piece.duration is not None:
            time = time + piece.duration
            moved = advance(state, piece.duration)
            s, d, v_lon, v_lat = moved.s, moved.d, moved.v_lon, moved.v_lat
    return tuple(states)


def monotone_starts(motion: Motion) -> tuple[State, ...]:
    """As ``starts_of``, and the states inside pieces where the acceleration along the road passes through 0.

    So from one to the next, and after the last, the speed along grows all the time, falls or stays. The state
    at a start says the acceleration of the piece that begins there.
    """
    found: list[State] = []
    for state, piece in zip(starts_of(motion), motion.pieces, strict=True):
        found.append(state)
        if piece.duration is not None and state.j_lon != 0:
            turn = -state.a_lon / state.j_lon
            if 0 < turn < piece.duration:
                found.append(advance(state, turn))
    return tuple(found)


def advance(state: State, duration: Fraction) -> State:
    """``state`` after ``duration`` seconds under its own accelerations and jerk."""
    # What a constant acceleration would have to be for the same change of speed, and of place.
    more = state.j_lon * duration
    faster = state.a_lon + more / 2 if more else state.a_lon
    farther = state.a_lon + more / 3 if more else state.a_lon
    return State(
        state.time + duration,
        state.s + duration * (state.v_lon + farther * duration / 2),
        state.d + duration * (state.v_lat + state.a_lat * duration / 2),
        state.v_lon + faster * duration,
        state.v_lat + state.a_lat * duration,
        state.a_lon + more,
        state.a_lat,
        state.j_lon,
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
