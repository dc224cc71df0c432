"""The exact state of a vehicle at any time of a drive (semantics §2).

Along the road the jerk is constant on each piece: acceleration is linear in time, speed quadratic, position
cubic. Across the road the acceleration is constant: speed is linear, position quadratic. At a knot,
acceleration and jerk are those of the piece that begins there.
"""

from bisect import bisect_right
from collections.abc import Iterable, Iterator
from fractions import Fraction
from functools import lru_cache

from roadproof.errors import UsageError
from roadproof.runtime.records import dataclass
from roadproof.world.drive import Motion


@dataclass(frozen=True)
class State:
    """The state of a vehicle at ``time`` (s), in m, m/s, m/s² and m/s³; front-left corner of the box."""

    time: Fraction
    s: Fraction
    d: Fraction
    v_lon: Fraction
    v_lat: Fraction
    a_lon: Fraction
    a_lat: Fraction
    j_lon: Fraction


@lru_cache(maxsize=64)  # the state at many times is asked for one by one
def piece_starts(motion: Motion) -> tuple[State, ...]:
    """Return the state at the start of every piece, in order; the first is at time 0."""
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


def advance(state: State, duration: Fraction) -> State:
    """Return ``state`` after ``duration`` seconds under its own accelerations and jerk."""
    # The constant accelerations with the same change of speed, and the same change of position.
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
    """Return the state at ``time`` >= 0; the last piece lasts for ever. Raises ``UsageError`` if negative."""
    if time < 0:
        raise UsageError(f"time={time}: a drive starts at 0; ask for a time that is not negative")
    return states_at(motion, (time,))[0]


def states_at(motion: Motion, times: Iterable[Fraction]) -> tuple[State, ...]:
    """Return the states at many times >= 0."""
    return tuple(each_state(motion, times))


def each_state(motion: Motion, times: Iterable[Fraction]) -> Iterator[State]:
    """Yield the state at each of many times >= 0, worked out when it is asked for."""
    starts = piece_starts(motion)
    for time in times:
        state = starts[bisect_right(starts, time, key=lambda x: x.time) - 1]
        yield advance(state, time - state.time)
