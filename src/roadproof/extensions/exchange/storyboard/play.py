"""The motions of all objects of a storyboard that was run."""

from bisect import bisect_left, bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import field

from roadproof.extensions.exchange.storyboard.actions import Actor
from roadproof.extensions.exchange.storyboard.conditions import TICKS
from roadproof.extensions.exchange.storyboard.courses import Point
from roadproof.extensions.exchange.storyboard.positions import ObjectState
from roadproof.runtime.records import dataclass

JUMP = 0.5
"""m"""
_SOON = 1e-6
"""Ticks"""
ANYWHERE = Point(0.0, 0.0)


@dataclass(frozen=True)
class Play:
    """States of the objects' reference points at each tick from 0 on, and why it ended.

    ``at_end``: as a vehicle came to the end of the road. ``history``: the objects with their courses, each
    from a tick on. ``controlled``: those that controllers move, and from when on. ``idle``: events that never
    start.
    """

    states: tuple[Mapping[str, ObjectState], ...]
    ending: str
    history: Mapping[str, Sequence[tuple[int, Actor]]]
    at_end: bool = False
    controlled: Mapping[str, str] = field(default_factory=dict)
    idle: tuple[str, ...] = ()

    def state_at(self, name: str, time: float) -> ObjectState:
        """Return the state of an object on the road at any time (s)."""
        return self._state(name, time, bisect_right(self.history[name], time * TICKS + _SOON, key=_tick))

    def state_before(self, name: str, time: float) -> ObjectState:
        """Return the state at a time, without actions that begin then."""
        return self._state(name, time, bisect_left(self.history[name], time * TICKS - _SOON, key=_tick))

    def _state(self, name: str, time: float, later: int) -> ObjectState:
        _, actor = self.history[name][max(later - 1, 0)]
        return state_of(actor, time)

    def jumps(self, name: str, tick: int) -> bool:
        """Return whether an object is put somewhere else at a tick: more than JUMP m from where its speed
        leads.
        """
        if tick == 0 or name not in self.states[tick - 1]:
            return False
        one, other = self.states[tick - 1][name], self.states[tick][name]
        speeds = (max(abs(getattr(x, y)) for x in (one, other)) / TICKS for y in ("v_lon", "v_lat"))
        ways = abs(other.s - one.s), abs(other.d - one.d)
        return any(way > speed + JUMP for way, speed in zip(ways, speeds, strict=True))


def _tick(known: tuple[int, Actor]) -> int:
    return known[0]


def place_along(actor: Actor, time: float) -> Point:
    """Return place, speed and acceleration of an object along the road at a time (s)."""
    return actor.along.at(time, ANYWHERE)


def state_of(actor: Actor, time: float) -> ObjectState:
    """Return the state of an object at a time (s), in coordinates of the road."""
    along = place_along(actor, time)
    across = actor.across.at(time, along)
    state = ObjectState(
        *(along.place, across.place, along.speed, across.speed, along.acceleration, across.acceleration)
    )
    return state if actor.forward else state.in_opposite_direction()
