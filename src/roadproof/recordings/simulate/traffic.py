"""What is simulated, and who drives: drawn once, for every vehicle that will ever enter."""

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

import numpy as np

from roadproof.errors import UsageError
from roadproof.recordings.formats.recording import Bools, Floats, Integers

Random: TypeAlias = np.random.Generator
Ramp: TypeAlias = Literal["none", "merge", "depart"]


@dataclass(frozen=True)
class Traffic:
    """What to simulate: SI units, ``flow`` in vehicles per hour and direction.

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


class Drivers:
    """Parameters of every vehicle that will ever enter, drawn once."""

    def __init__(self, lane: Integers, traffic: Traffic, random: Random) -> None:
        count = len(lane)
        preference = np.array([0.75, 0.25] + [0.0] * (traffic.lanes - 2)) * traffic.lanes
        place = np.maximum(
            lane % traffic.tracks - (traffic.tracks - traffic.lanes), 0
        )  # a ramp as its neighbour
        self.truck: Bools = random.random(count) < traffic.truck_share * preference[place]
        truck = self.truck

        def draw(car: tuple[float, float], lorry: tuple[float, float], low: float, high: float) -> Floats:
            mean, spread = (np.where(truck, lorry[k], car[k]) for k in (0, 1))
            drawn: Floats = np.clip(random.normal(mean, spread), low, high)
            return drawn

        self.length = np.where(truck, np.clip(random.normal(14, 3.5, count), 7, 19), 0)
        self.length += np.where(truck, 0, np.clip(random.normal(4.5, 0.4, count), 3.4, 6))
        self.length = np.round(self.length, 2)
        self.width = np.round(draw((1.9, 0.1), (2.5, 0.05), 1.6, 2.6), 2)
        self.desired = draw((36.0, 3.0), (23.8, 0.8), 20, 48) + np.where(truck, 0.0, 1.5 * place)
        self.headway = draw((1.0, 0.3), (1.7, 0.3), 0.5, 3)
        self.acceleration = draw((1.6, 0.3), (0.7, 0.1), 0.4, 2.6)
        self.braking = draw((2.0, 0.3), (1.6, 0.2), 1, 3)
        self.politeness = np.clip(random.normal(0.35, 0.2, count), 0, 1)


def draw_arrivals(traffic: Traffic, seconds: float, random: Random) -> list[Floats]:
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
