"""The protocol of a vehicle under test: what it observes, and what it demands.

A controller is reset at the start of every simulation, and asked once in every step. It has to be
deterministic: after ``reset`` with the same observation, the same observations give the same demands.
"""

from dataclasses import dataclass
from typing import Protocol, TypeAlias

from roadproof.world.signals import RECORDED

OBSERVED: tuple[str, ...] = tuple(x for x in RECORDED if x != "a_lat")
"""The signals of a vehicle that a controller sees."""


@dataclass(slots=True)
class ObservedVehicle:
    """A vehicle as a controller sees it: SI units, front-left corner of the box.

    ``s``: front along the road; ``d``: left side, growing to the left; speeds along and across the road;
    acceleration along it; box.
    """

    name: str
    s: float
    d: float
    v_lon: float
    v_lat: float
    a_lon: float
    length: float
    width: float


@dataclass(frozen=True, slots=True)
class ObservedLane:
    """A lane: its name, and its right and left edge (d, m)."""

    name: str
    right: float
    left: float


@dataclass(slots=True)
class ControllerInput:
    """All that a controller sees at an instant.

    ``time``: seconds since the start. ``me``: the vehicle under test. ``others``: all other vehicles.
    ``lanes``: from the right. ``plan``: the velocity across the road (m/s) that the route asks for, such as
    in a scenario in which SV changes lanes. The objects are used again in the next step.
    """

    time: float
    me: ObservedVehicle
    others: tuple[ObservedVehicle, ...]
    lanes: tuple[ObservedLane, ...]
    plan: float = 0.0

    def ahead(self, margin: float = 0.0) -> tuple[float, ObservedVehicle] | None:
        """Return the nearest vehicle ahead in the way, with the gap to it (m); None where there is none.

        In the way: the boxes overlap across the road, or are less than ``margin`` (m) apart.
        """
        me, nearest, least = self.me, None, 0.0
        for x in self.others:
            if x.s < me.s or x.d - x.width > me.d + margin or me.d - me.width > x.d + margin:
                continue
            gap = x.s - x.length - me.s
            if nearest is None or gap < least:
                nearest, least = x, gap
        return None if nearest is None else (least, nearest)


Answer: TypeAlias = "float | tuple[float, float | str | None]"
"""An acceleration along the road (m/s²); or that with a velocity across it (m/s, to the left), or a lane.

Without the second, or with None, the vehicle follows the plan across the road.
"""


class VehicleController(Protocol):
    """A vehicle under test."""

    def reset(self, observation: ControllerInput) -> None:
        """Begin a simulation in this state."""

    def step(self, observation: ControllerInput, dt: float) -> Answer:
        """Return the demand for the next ``dt`` seconds."""
