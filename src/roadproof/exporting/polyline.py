"""Vertices of a drive so dense that straight lines between them stay within a bound of it.

On a piece the accelerations are constant, so the box's centre c has c'' = a, and a line between two of its
points, h seconds apart, is nowhere further from it than |a|·h²/8. The vertices are of the rear axle,
r = c - l·e(θ) with the heading θ of the motion, v = |c'|, and n = v_lon·a_lat - v_lat·a_lon, which does not
change on a piece: θ' = n/v², |θ''| ≤ 2·|n|·|a|/v³, so |r''| ≤ |a| + l·(|θ''| + θ'²). The heading between
vertices is interpolated too, which moves the centre by l·|θ''|·h²/8 at most. All together:
h²/8·(|a| + l·(2·|θ''| + θ'²)), for the axle and for the centre.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from roadproof.errors import InputError
from roadproof.exporting.points import axle_to_centre, heading
from roadproof.world.drive import Motion
from roadproof.world.motion import State, advance, starts_of

WITHIN = 0.0099
"""Metres: a centimetre, with room for the rounding of floats, which ``ROUNDING`` is above."""
ROUNDING = 1e-6
_SHORTEST = Fraction(1, 1024)
_SAME = 1e-9


@dataclass(frozen=True)
class Polyline:
    """States and headings (rad) at the vertices, and how far (m) lines between them are from the drive."""

    vertices: tuple[State, ...]
    headings: tuple[float, ...]
    bound: float


def polyline_of(motion: Motion, horizon: Fraction, within: float = WITHIN) -> Polyline:
    """Vertices from time 0 to ``horizon``, at every change of acceleration and as many between as needed.

    Raises ``InputError`` for a vehicle that does not drive forwards, or turns where it all but stands: its
    heading has no bound.
    """
    starts = [x for x in starts_of(motion) if x.time < horizon]
    ends = [x.time for x in starts[1:]] + [horizon]
    vertices: list[State] = []
    worst = 0.0
    for start, end in zip(starts, ends, strict=True):
        for begin, bound in _halved(start, end - start.time, motion.length, within):
            vertices.append(begin)
            worst = max(worst, bound)
    last = starts[-1]
    vertices.append(advance(last, horizon - last.time))
    return Polyline(tuple(vertices), tuple(_headings(vertices)), worst)


def _headings(vertices: list[State]) -> list[float]:
    """At rest the heading is the one before, or after where there is none. Raises ``InputError``."""
    for state in vertices:
        if state.v_lon < 0 or (state.v_lon == 0 and state.v_lat != 0):
            raise InputError(
                f"at {float(state.time):g} s a vehicle has v_lon={float(state.v_lon):g} m/s: other tools "
                "want vehicles that drive forwards; end the drive before"
            )
    found = [heading(x) for x in vertices]
    first = next((x for x in found if x is not None), 0.0)
    made: list[float] = []
    for state, turned, following in zip(vertices, found, [*found[1:], None], strict=True):
        made.append(turned if turned is not None else made[-1] if made else first)
        if turned is None and following is not None and abs(following - made[-1]) > _SAME:
            raise _turns(state)
    return made


def _turns(state: State) -> InputError:
    return InputError(
        f"a vehicle turns where it all but stands, at {float(state.time):g} s: it has no heading there; "
        "end the drive before"
    )


def _halved(
    state: State, duration: Fraction, length: Fraction, within: float
) -> Iterator[tuple[State, float]]:
    """The beginnings of parts of a piece with the bound of each, halved until it is small enough."""
    bound = deviation(state, duration, length)
    if bound <= within:
        yield state, bound
        return
    if duration <= _SHORTEST:
        raise _turns(state)
    yield from _halved(state, duration / 2, length, within)
    yield from _halved(advance(state, duration / 2), duration / 2, length, within)


def deviation(state: State, duration: Fraction, length: Fraction) -> float:
    """The bound above (m) for ``duration`` seconds from ``state`` on, infinite where the heading has none."""
    pull = math.hypot(state.a_lon, state.a_lat)
    turning = abs(float(state.v_lon * state.a_lat - state.v_lat * state.a_lon))
    arm, turn = float(axle_to_centre(length)), 0.0
    if turning:
        slowest = _slowest(state, duration)
        if slowest <= 0:
            return math.inf
        turn = 4 * turning * pull / slowest**3 + (turning / slowest**2) ** 2
    return float(duration) ** 2 / 8 * (pull + arm * turn)


def _slowest(state: State, duration: Fraction) -> float:
    """The least speed (m/s) from ``state`` on."""
    square = state.a_lon**2 + state.a_lat**2
    along = state.v_lon * state.a_lon + state.v_lat * state.a_lat
    time = min(max(-along / square, Fraction(0)), duration)
    there = advance(state, time)
    return math.hypot(there.v_lon, there.v_lat)
