"""What it means that two scenarios hold together: the conjunctions that count."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, permutations
from typing import Literal

from roadproof.library.compose import both, eventually
from roadproof.library.query import Query
from roadproof.library.scenarios import LANE, Scenario, applied, vehicles_of
from roadproof.library.specification import Specification

OTHER_LANE = "L2"


@dataclass(frozen=True)
class Meeting:
    """How two scenarios may meet.

    ``lanes``: both speak of one lane, or each of its own. ``roles``: the vehicles play the same parts
    in both, or any. ``start``: both start at time 0, or one at 0 and the other then or later.
    """

    lanes: Literal["same", "any"] = "same"
    roles: Literal["same", "any"] = "same"
    start: Literal["same", "any"] = "same"


def conjunctions(
    specification: Specification, one: Scenario, other: Scenario, meeting: Meeting
) -> tuple[Query, ...]:
    """The formulas of which one has to hold for ``one`` and ``other`` to hold together.

    Names are to be read with ``specification``. The vehicles are those of the scenario that has more of them;
    a two-vehicle scenario meets scenario 2 with SV and either of its POVs.
    """
    mine, theirs = vehicles_of(specification, one), vehicles_of(specification, other)
    swapped = len(theirs) > len(mine)
    most, fewer = (theirs, mine) if swapped else (mine, theirs)
    lane = OTHER_LANE if meeting.lanes == "any" else LANE
    found: list[Query] = []
    for roles in _assignments(most, len(fewer), meeting.roles):
        mine_now, theirs_now = (roles, most) if swapped else (most, roles)
        first = applied(specification, one, mine_now)
        second = applied(specification, other, theirs_now, lane)
        if meeting.start == "same":
            found.append(both(first, second))
        else:
            found += [both(first, eventually(second)), both(second, eventually(first))]
    return tuple(found)


def _assignments(vehicles: Sequence[str], count: int, roles: Literal["same", "any"]) -> list[tuple[str, ...]]:
    """Who may play the ``count`` parts of the smaller scenario."""
    if roles == "any":
        return list(permutations(vehicles, count))
    return [(vehicles[0], *others) for others in combinations(vehicles[1:], count - 1)]
