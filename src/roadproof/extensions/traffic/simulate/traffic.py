"""The settings of a simulation, the drivers of all vehicles, drawn once, and ramps.

The ramp is one more lane to the right of the main lanes of the lower carriageway. A merge lane ends with its
zone, so whoever is on it has to leave it before; a departure lane begins with its zone and goes on, and
whoever leaves has to be on it by the end of the zone, or stays on the main road.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt

from roadproof.errors import UsageError
from roadproof.extensions.traffic.formats.highd_columns import LOWER

if TYPE_CHECKING:
    from roadproof.extensions.traffic.formats.recording import Bools, Floats, Integers

Random: TypeAlias = np.random.Generator
Ramp: TypeAlias = Literal["none", "merge", "depart"]


@dataclass(frozen=True)
class TrafficSettings:
    """The settings of simulated traffic: SI units, ``flow`` in vehicles per hour and direction.

    ``ramp``: the lower carriageway has an on-ramp (merge) or an off-ramp (depart), of ``ramp_flow`` vehicles
    per hour.
    """

    seconds: float = 1020.0
    lanes: int = 3
    flow: float = 3350.0
    truck_share: float = 0.18
    section: float = 420.0
    lane_width: float = 3.75
    rate: int = 25
    ramp: Ramp = "none"
    ramp_flow: float = 400.0

    def __post_init__(self) -> None:
        limits = {
            "seconds": (1, 7200),
            "lanes": (2, 4),
            "flow": (1, 2200 * self.lanes),
            "truck_share": (0, 0.4),
            "section": (100, 5000),
            "lane_width": (3, 5),
            "ramp_flow": (1, 1200),
        }
        for name, (low, high) in limits.items():
            if not low <= getattr(self, name) <= high:
                raise UsageError(f"simulate: {name}={getattr(self, name)} must lie between {low} and {high}")
        if self.ramp not in get_args(Ramp):
            raise UsageError(f"simulate: ramp={self.ramp!r}: write {', '.join(map(repr, get_args(Ramp)))}")
        if self.rate % 5:
            raise UsageError(f"simulate: rate={self.rate} must be a multiple of 5 Hz, the rate of decisions")

    @property
    def tracks(self) -> int:
        """Lanes that a direction has at most, the ramp among them, which is the rightmost."""
        return self.lanes + (self.ramp != "none")


class DriverParameters:
    """Parameters of every vehicle that will ever enter, drawn once."""

    def __init__(self, lane: Integers, traffic: TrafficSettings, random: Random) -> None:
        count = len(lane)
        preference = np.array([0.75, 0.25] + [0.0] * (traffic.lanes - 2)) * traffic.lanes
        place = np.maximum(
            lane % traffic.tracks - (traffic.tracks - traffic.lanes), 0
        )  # a ramp as its neighbour
        self.truck: Bools = random.random(count) < traffic.truck_share * preference[place]
        truck = self.truck

        def draw(car: tuple[float, float], lorry: tuple[float, float], low: float, high: float) -> Floats:
            mean, spread = (np.where(truck, lorry[k], car[k]) for k in (0, 1))
            return np.clip(random.normal(mean, spread), low, high)

        self.length = np.where(truck, np.clip(random.normal(14, 3.5, count), 7, 19), 0)
        self.length += np.where(truck, 0, np.clip(random.normal(4.5, 0.4, count), 3.4, 6))
        self.length = np.round(self.length, 2)
        self.width = np.round(draw((1.9, 0.1), (2.5, 0.05), 1.6, 2.6), 2)
        self.desired = draw((36.0, 3.0), (23.8, 0.8), 20, 48) + np.where(truck, 0.0, 1.5 * place)
        self.headway = draw((1.0, 0.3), (1.7, 0.3), 0.5, 3)
        self.acceleration = draw((1.6, 0.3), (0.7, 0.1), 0.4, 2.6)
        self.braking = draw((2.0, 0.3), (1.6, 0.2), 1, 3)
        self.politeness = np.clip(random.normal(0.35, 0.2, count), 0, 1)


def draw_arrivals(traffic: TrafficSettings, seconds: float, random: Random) -> list[Floats]:
    """Arrival times for each lane of both directions: exponential headways after a least one of 0.8 s."""
    flows = [traffic.flow * share for share in np.linspace(0.9, 1.1, traffic.lanes) / traffic.lanes]
    if traffic.ramp != "none":
        flows.insert(0, 0.0)
    both = [*flows, *flows]
    if traffic.ramp == "merge":
        both[traffic.tracks] = traffic.ramp_flow
    arrivals = []
    for flow in both:
        if not flow:
            arrivals.append(np.zeros(0))
            continue
        mean = 3600 / flow
        gaps = 0.8 + random.exponential(max(mean - 0.8, 0.05), int(3 * seconds / mean) + 20)
        times = np.cumsum(gaps)
        arrivals.append(times[times < seconds])
    return arrivals


WAY = LOWER - 1
"""The direction with the ramp, as a movement counts them."""
URGENT = 10.0
"""m/s²: what a change is worth that has to be made."""
EARLY = 1.0
"""The same for getting to the right before the ramp is there."""
LEAST_SECONDS = 3.0
"""As long as a change from or to a ramp takes at least."""


def zone_of(traffic: TrafficSettings) -> tuple[float, float]:
    """Return where the zone begins and ends, in m along the section (whole metres)."""
    return float(round(0.1 * traffic.section)), float(round(0.9 * traffic.section))


def may_change(
    traffic: TrafficSettings, lane: Integers, side: int, s: Floats, v: Floats, leaves: Bools
) -> Bools:
    """Return which vehicles may change to that side (1 left, -1 right), as far as the ramp is concerned."""
    begin, end = zone_of(traffic)
    inside = (s > begin + 1) & (s < end - LEAST_SECONDS * np.maximum(v, 5.0))
    on_ramp, beside = lane == _ramp(traffic), lane == _ramp(traffic) + 1
    across = on_ramp if side > 0 else beside
    right = traffic.ramp == ("merge" if side > 0 else "depart")
    permitted = inside & (leaves | (traffic.ramp == "merge")) if right else np.zeros(len(lane), bool)
    upper = lane // traffic.tracks != WAY
    no_lane = upper & (side < 0) & (lane % traffic.tracks == 1)
    may: Bools = ~no_lane & (~across | permitted)
    return may


def incentive(traffic: TrafficSettings, lane: Integers, side: int, leaves: Bools) -> Floats:
    """Return the incentive to change to a side in addition to MOBIL's, in m/s²."""
    on_ramp, beside = lane == _ramp(traffic), lane == _ramp(traffic) + 1
    if traffic.ramp == "merge":
        return np.where(on_ramp & (side > 0), URGENT, 0.0)
    left = (lane > _ramp(traffic) + 1) & leaves
    return np.where(leaves & beside & (side < 0), URGENT, np.where(left, -side * EARLY, 0.0))


def room_ahead(traffic: TrafficSettings, lane: Integers, s: Floats, changing: Bools) -> Floats:
    """Metres to the end of the merge lane for those who still have to leave it, infinite for others."""
    waits = (lane == _ramp(traffic)) & ~changing & (traffic.ramp == "merge")
    return np.where(waits, np.maximum(zone_of(traffic)[1] - s, 0.1), np.inf)


def change_seconds(
    traffic: TrafficSettings, lanes: tuple[int, int], seconds: float, s: float, v: float
) -> float:
    """Return how long a change between two lanes takes: one from or to the ramp is done where the zone
    ends.
    """
    if _ramp(traffic) not in lanes:
        return seconds
    return min(seconds, max(LEAST_SECONDS, (zone_of(traffic)[1] - s) / max(v, 5.0)))


def _ramp(traffic: TrafficSettings) -> int:
    """The number of the ramp among the lanes of both directions."""
    return WAY * traffic.tracks


def leaving_vehicles(
    traffic: TrafficSettings, lane: Integers, random: np.random.Generator
) -> npt.NDArray[np.bool_]:
    """Return which vehicles want to leave: on the lower carriageway, as many as the ramp carries."""
    if traffic.ramp != "depart":
        return np.zeros(len(lane), bool)
    drawn = random.random(len(lane)) < traffic.ramp_flow / traffic.flow
    leaving: Bools = drawn & (lane // traffic.tracks == WAY)
    return leaving
