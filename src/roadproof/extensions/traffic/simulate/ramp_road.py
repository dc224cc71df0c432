"""The road of a simulated section with a ramp."""

from fractions import Fraction
from typing import Any

from roadproof.extensions.traffic.simulate.traffic import TrafficSettings, zone_of
from roadproof.world.lanelet_rules import shared_boundaries
from roadproof.world.road import Attribute, Lanelet, Road, Zone


def road_of(traffic: TrafficSettings, markings: tuple[float, ...]) -> Road:
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
