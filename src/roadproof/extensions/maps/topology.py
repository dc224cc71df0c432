"""Finds the lanelets of ramps from successors and neighbours, where a map has no type for them.

Lanelets are put into chains along the road: of several successors the one with most neighbours is
followed, then the one that goes on straightest, and of several predecessors likewise. The chain with most
lanelets beside it, metre by metre, is on the main road (``main_way``). Another chain

- merges where it leads into another one, where it ends beside lanelets that go on, or where it begins
  away from the main way and is beside it later;
- departs where it leaves another one, where it begins beside lanelets that were there before, or where it
  is beside the main way first and away from it at its end;
- does both where both hold: it then merges up to the middle of what is beside the main way.
"""

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from roadproof.world.road import Attribute

Floats: TypeAlias = npt.NDArray[np.float64]

EQUAL = 0.9
"""Chains that have this share of what the best one has beside them are lanes of the main road alike."""

ALONE = 0.01
"""What a lanelet with nothing beside it counts for, so that among such roads the longest is the main one."""


@dataclass(frozen=True)
class MeasuredLanelet:
    """Bounds (n, 2) with equally many points in driving direction, and the ids of its neighbours.

    ``attribute`` where its type says it, else None. ``by_bound``: the neighbours that are known by a common
    bound alone.
    """

    id: str
    left: Floats
    right: Floats
    attribute: Attribute | None
    successors: tuple[str, ...]
    beside: tuple[str, ...]
    by_bound: tuple[str, ...] = ()

    @property
    def centre(self) -> Floats:
        """The line in the middle of the bounds."""
        return (self.left + self.right) / 2

    @property
    def length(self) -> float:
        """The length (m) of the middle line."""
        return float(np.hypot(*np.diff(self.centre, axis=0).T).sum())


@dataclass(frozen=True)
class _Links:
    """Lanelets, what each follows on, and those that are across the road from it."""

    lanelets: Mapping[str, MeasuredLanelet]
    predecessors: Mapping[str, tuple[str, ...]]
    across: Mapping[str, tuple[str, ...]]


def attributes_of(lanelets: Mapping[str, MeasuredLanelet]) -> dict[str, tuple[Attribute, str]]:
    """The attribute of every lanelet, and where it is inferred and not main, why.

    Where a type says it of any lanelet of a carriageway, the others of that carriageway are main.
    """
    links, chains = _links(lanelets), chains_of(lanelets)
    attributes: dict[str, tuple[Attribute, str]] = {
        name: (x.attribute or "main", "") for name, x in lanelets.items()
    }
    for way in carriageways_of(lanelets):
        if not any(lanelets[name].attribute for name in way):
            attributes |= _infer(links, [chain for chain in chains if chain[0] in way])
    return attributes


def carriageways_of(lanelets: Mapping[str, MeasuredLanelet]) -> tuple[tuple[str, ...], ...]:
    """The lanelets that follow or neighbour each other, in the order of the file."""
    links = ((x.id, other) for x in lanelets.values() for other in (*x.successors, *x.beside))
    return tuple(dict.fromkeys(closure(lanelets, links).values()))


def chains_of(lanelets: Mapping[str, MeasuredLanelet]) -> tuple[tuple[str, ...], ...]:
    """All lanelets, in chains along which each is the straightest successor and predecessor of the next."""
    links = _links(lanelets)
    after = {}
    for name, x in lanelets.items():
        following = min(x.successors, key=partial(_turn, links, name), default=None)
        if following is not None and _straightest_before(links, following) == name:
            after[name] = following
    firsts = [x for x in lanelets if x not in after.values()]
    chains, seen = [], set[str]()
    for first in (*firsts, *lanelets):  # what is left is a ring, begun anywhere
        chain: list[str] = []
        current: str | None = first
        while current is not None and current not in seen:
            seen.add(current)
            chain.append(current)
            current = after.get(current)
        if chain:
            chains.append(tuple(chain))
    return tuple(chains)


def main_way(lanelets: Mapping[str, MeasuredLanelet], chains: Iterable[tuple[str, ...]]) -> tuple[str, ...]:
    """The chain of a carriageway with most lanelets beside it, in the middle of those that have as many.

    What is beside it counts by its length, so that a long ramp is no main road.
    """
    across = _links(lanelets).across
    weight = {
        chain: sum(lanelets[name].length * (len(across[name]) - 1 + ALONE) for name in chain)
        for chain in chains
    }
    best = max(weight.values())
    equals = [chain for chain, value in weight.items() if value >= EQUAL * best]
    middles = [np.concatenate([lanelets[name].centre for name in chain]).mean(axis=0) for chain in equals]
    apart = [sum(float(np.hypot(*(one - other))) for other in middles) for one in middles]
    return equals[int(np.argmin(apart))]


def length_of(lanelets: Mapping[str, MeasuredLanelet], chain: Iterable[str]) -> float:
    """Return the sum of the lengths (m) of the lanelets' middle lines."""
    return sum(lanelets[name].length for name in chain)


def closure(names: Iterable[str], links: Iterable[tuple[str, str]]) -> dict[str, tuple[str, ...]]:
    """Return for each name all names that ``links``, read both ways, connect it to."""
    group = {name: [name] for name in names}
    for one, other in links:
        if group[one] is not group[other]:
            group[one].extend(group[other])
            for name in group[other]:
                group[name] = group[one]
    return {name: tuple(members) for name, members in group.items()}


def _infer(links: _Links, chains: list[tuple[str, ...]]) -> dict[str, tuple[Attribute, str]]:
    """Attributes of the lanelets of one carriageway that are not of its main road, with the reason."""
    main = main_way(links.lanelets, chains)
    attributes: dict[str, tuple[Attribute, str]] = {}
    for chain in chains:
        if chain == main:
            continue
        with_main = [bool(set(links.across[name]) & set(main)) for name in chain]
        merging, departing = _merges(links, chain, with_main), _departs(links, chain, with_main)
        if merging and departing:
            half = _middle(links, chain, with_main)
            reason = f"{merging}, and it {departing}"
            attributes |= dict.fromkeys(chain[:half], ("merge", reason))
            attributes |= dict.fromkeys(chain[half:], ("departure", reason))
        elif merging:
            attributes |= dict.fromkeys(chain, ("merge", merging))
        elif departing:
            attributes |= dict.fromkeys(chain, ("departure", departing))
    return attributes


def _merges(links: _Links, chain: tuple[str, ...], with_main: list[bool]) -> str:
    """Return why a chain merges; "" where it does not."""
    last = chain[-1]
    if links.lanelets[last].successors:
        return f"leads into {links.lanelets[last].successors[0]}"
    if any(links.lanelets[other].successors for other in links.across[last]):
        return f"ends at {last} beside lanelets that go on"
    if not with_main[0] and True in with_main:
        return f"comes to the side of the main road at {chain[with_main.index(True)]}"
    return ""


def _departs(links: _Links, chain: tuple[str, ...], with_main: list[bool]) -> str:
    """Return why a chain departs; "" where it does not."""
    first = chain[0]
    if links.predecessors[first]:
        return f"leaves {links.predecessors[first][0]}"
    if any(links.predecessors[other] for other in links.across[first]):
        return f"begins at {first} beside lanelets that were there before"
    if not with_main[-1] and True in with_main:
        last = [name for name, beside in zip(chain, with_main, strict=True) if beside][-1]
        return f"goes away from the side of the main road after {last}"
    return ""


def _middle(links: _Links, chain: tuple[str, ...], with_main: list[bool]) -> int:
    """Return how many lanelets of a chain merge before the others depart."""
    begin = with_main.index(True) if True in with_main else 0
    end = len(chain) - (with_main[::-1].index(True) if True in with_main else 0)
    half = length_of(links.lanelets, chain[begin:end]) / 2
    count = begin + 1
    while count < end - 1 and length_of(links.lanelets, chain[begin : count + 1]) <= half:
        count += 1
    return count


def _links(lanelets: Mapping[str, MeasuredLanelet]) -> _Links:
    predecessors: dict[str, list[str]] = defaultdict(list)
    for x in lanelets.values():
        for other in x.successors:
            predecessors[other].append(x.id)
    return _Links(
        lanelets,
        {name: tuple(predecessors[name]) for name in lanelets},
        closure(lanelets, ((x.id, other) for x in lanelets.values() for other in x.beside)),
    )


def _straightest_before(links: _Links, name: str) -> str:
    return min(links.predecessors[name], key=lambda other: _turn(links, other, name))


def _turn(links: _Links, one: str, other: str) -> tuple[int, float]:
    """Return how unlikely it is that the way goes on here: by other neighbours first, then by the angle."""
    fewer = -min(len(links.across[one]), len(links.across[other]))
    before, after = (links.lanelets[x].centre for x in (one, other))
    # The way of a branch shows some metres on, and what comes in shows some metres before.
    heading = _heading(before[0], before[-1]), _heading(after[0], after[-1])
    return fewer, abs(math.remainder(heading[1] - heading[0], math.tau))


def _heading(begin: Floats, end: Floats) -> float:
    return math.atan2(end[1] - begin[1], end[0] - begin[0])
