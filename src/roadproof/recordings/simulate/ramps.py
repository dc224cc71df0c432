"""An on-ramp or an off-ramp of the lower carriageway: who changes lanes where, and the road that says so.

The ramp is one more lane to the right of the main lanes. A merge lane ends with its zone, so whoever is on it
has to leave it before; a departure lane begins with its zone and goes on, and whoever leaves has to be on it
by the end of the zone, or stays on the main road.
"""

from fractions import Fraction
from typing import Any

import numpy as np
import numpy.typing as npt

from roadproof.recordings.formats.highd import LOWER
from roadproof.recordings.formats.recording import Bools, Floats, Integers
from roadproof.recordings.simulate.traffic import Traffic
from roadproof.world.models import shared_boundaries
from roadproof.world.road import Attribute, Lanelet, Road, Zone

WAY = LOWER - 1
"""The direction with the ramp, as a movement counts them."""
URGENT = 10.0
"""m/s²: what a change is worth that has to be made."""
EARLY = 1.0
"""The same for getting to the right before the ramp is there."""
LEAST_SECONDS = 3.0
"""As long as a change from or to a ramp takes at least."""


def zone_of(traffic: Traffic) -> tuple[float, float]:
    """Where the zone begins and ends, in m along the section (whole metres)."""
    return float(round(0.1 * traffic.section)), float(round(0.9 * traffic.section))


def may_change(traffic: Traffic, lane: Integers, side: int, s: Floats, v: Floats, leaves: Bools) -> Bools:
    """Which vehicles may change to that side (1 left, -1 right), as far as the ramp is concerned."""
    begin, end = zone_of(traffic)
    inside = (s > begin + 1) & (s < end - LEAST_SECONDS * np.maximum(v, 5.0))
    on_ramp, beside = lane == _ramp(traffic), lane == _ramp(traffic) + 1
    across = on_ramp if side > 0 else beside
    right = traffic.ramp == ("merge" if side > 0 else "depart")
    wanted = inside & (leaves | (traffic.ramp == "merge")) if right else np.zeros(len(lane), bool)
    upper = lane // traffic.tracks != WAY
    no_lane = upper & (side < 0) & (lane % traffic.tracks == 1)
    may: Bools = ~no_lane & (~across | wanted)
    return may


def wish(traffic: Traffic, lane: Integers, side: int, leaves: Bools) -> Floats:
    """What a change to that side is worth beyond what MOBIL says, in m/s²."""
    on_ramp, beside = lane == _ramp(traffic), lane == _ramp(traffic) + 1
    if traffic.ramp == "merge":
        urgent: Floats = np.where(on_ramp & (side > 0), URGENT, 0.0)
        return urgent
    left = (lane > _ramp(traffic) + 1) & leaves
    worth: Floats = np.where(leaves & beside & (side < 0), URGENT, np.where(left, -side * EARLY, 0.0))
    return worth


def room_ahead(traffic: Traffic, lane: Integers, s: Floats, changing: Bools) -> Floats:
    """Metres to the end of the merge lane for those who still have to leave it, infinite for others."""
    waits = (lane == _ramp(traffic)) & ~changing & (traffic.ramp == "merge")
    room: Floats = np.where(waits, np.maximum(zone_of(traffic)[1] - s, 0.1), np.inf)
    return room


def in_time(traffic: Traffic, lanes: tuple[int, int], seconds: float, s: float, v: float) -> float:
    """How long a change between two lanes takes: one from or to the ramp is done where the zone ends."""
    if _ramp(traffic) not in lanes:
        return seconds
    return min(seconds, max(LEAST_SECONDS, (zone_of(traffic)[1] - s) / max(v, 5.0)))


def _ramp(traffic: Traffic) -> int:
    """The number of the ramp among the lanes of both directions."""
    return WAY * traffic.tracks


def road_of(traffic: Traffic, markings: tuple[float, ...]) -> Road:
    """The lower carriageway with its ramp in a recording's s and d; ``markings`` are y from the left on."""
    begin, end = (Fraction(round(x)) for x in zone_of(traffic))
    edges = [Fraction(str(-y)) for y in reversed(markings)]
    zone: Zone = "merge" if traffic.ramp == "merge" else "depart"
    attribute: Attribute = "merge" if traffic.ramp == "merge" else "departure"
    span = (None, end) if traffic.ramp == "merge" else (begin, None)
    lanelets = [Lanelet("ramp", f"{attribute}-1", zone, attribute, span, (edges[0], edges[1]))]
    for k in range(1, traffic.tracks):
        parts: tuple[tuple[str, Zone, Any], ...] = (
            ("a", "main", (None, begin)),
            ("b", zone, (begin, end)),
            ("c", "main", (end, None)),
        )
        for name, where, s in parts:
            lanelets.append(Lanelet(f"m{k}{name}", f"main-{k}", where, "main", s, (edges[k], edges[k + 1])))
    made = tuple(lanelets)
    return Road(f"{traffic.ramp} in the section", made, shared_boundaries(made))


def leavers(traffic: Traffic, lane: Integers, random: np.random.Generator) -> npt.NDArray[np.bool_]:
    """Who wants to leave: of the lower carriageway, so many as the ramp carries."""
    if traffic.ramp != "depart":
        return np.zeros(len(lane), bool)
    drawn = random.random(len(lane)) < traffic.ramp_flow / traffic.flow
    leaving: Bools = drawn & (lane // traffic.tracks == WAY)
    return leaving
