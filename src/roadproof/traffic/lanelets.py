"""Lanelets of a measured road: which form a lane, which lanes lie beside each other, which zone is where.

Paper, appendix *Road Network*: a lane is the closure of a lanelet under predecessors and successors
with the same attribute. A lanelet beside a merge lane is in the merge zone, one beside a departure
lane in the depart zone, every other one on the main road.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from roadproof.traffic.recording import Floats


@dataclass(frozen=True)
class MeasuredLanelet:
    """Bounds (n, 2) with equally many points in driving direction, and the ids of its neighbours."""

    id: str
    left: Floats
    right: Floats
    attribute: str
    successors: tuple[str, ...]
    beside: tuple[str, ...]


@dataclass(frozen=True)
class MeasuredLane:
    """Lanelets in driving direction; ``carriageway`` counts from 1, lanes of one are connected."""

    name: str
    lanelets: tuple[str, ...]
    carriageway: int


def lanes_of(lanelets: Mapping[str, MeasuredLanelet]) -> tuple[MeasuredLane, ...]:
    """The lanes, each named after its first lanelet, in the order of the file."""
    along = _closure(
        lanelets,
        (
            (x.id, other)
            for x in lanelets.values()
            for other in x.successors
            if _continues(lanelets, x, other)
        ),
    )
    connected = _closure(
        lanelets, ((x.id, other) for x in lanelets.values() for other in (*x.successors, *x.beside))
    )
    ways = {members: number for number, members in enumerate(dict.fromkeys(connected.values()), start=1)}
    lanes = []
    for members in dict.fromkeys(along.values()):
        ordered = _in_order(lanelets, members)
        lanes.append(MeasuredLane(ordered[0], ordered, ways[connected[ordered[0]]]))
    return tuple(lanes)


def beside_of(
    lanelets: Mapping[str, MeasuredLanelet], lanes: Iterable[MeasuredLane]
) -> frozenset[frozenset[str]]:
    """Unordered pairs of names of adjacent lanes."""
    lane_of = {x: lane.name for lane in lanes for x in lane.lanelets}
    touching = ((lane_of[x.id], lane_of[other]) for x in lanelets.values() for other in x.beside)
    return frozenset(frozenset(pair) for pair in touching if pair[0] != pair[1])


def zones_of(lanelets: Mapping[str, MeasuredLanelet]) -> dict[str, str]:
    """The zone (main, merge or depart) of every lanelet."""
    across = _closure(lanelets, ((x.id, other) for x in lanelets.values() for other in x.beside))
    zones = {}
    for name, section in across.items():
        attributes = {lanelets[x].attribute for x in section}
        zones[name] = "merge" if "merge" in attributes else "depart" if "departure" in attributes else "main"
    return zones


def _continues(lanelets: Mapping[str, MeasuredLanelet], lanelet: MeasuredLanelet, other: str) -> bool:
    return lanelets[other].attribute == lanelet.attribute


def _closure(names: Iterable[str], links: Iterable[tuple[str, str]]) -> dict[str, tuple[str, ...]]:
    """For each name all those that ``links``, read both ways, connect it to."""
    group = {name: [name] for name in names}
    for one, other in links:
        if group[one] is not group[other]:
            group[one].extend(group[other])
            for name in group[other]:
                group[name] = group[one]
    return {name: tuple(members) for name, members in group.items()}


def _in_order(lanelets: Mapping[str, MeasuredLanelet], members: tuple[str, ...]) -> tuple[str, ...]:
    """From the one without a predecessor on; in the order found where a lane is a ring or branches."""
    followers = {other for name in members for other in lanelets[name].successors}
    current = next((name for name in members if name not in followers), members[0])
    ordered = [current]
    while True:
        following = (x for x in lanelets[current].successors if x in members and x not in ordered)
        found = next(following, None)
        if found is None:
            break
        ordered.append(found)
        current = found
    return (*ordered, *(name for name in members if name not in ordered))
