"""What it means that two scenarios hold together: the conjunctions that count, as text."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, permutations
from typing import Literal

from roadproof.errors import InputError, UsageError
from roadproof.spec.elaborate import signature
from roadproof.spec.library import Specification, unknown

_SCENARIO = re.compile(r"scenario_(\d+)")
_RANGE = re.compile(r"\s*(\d{1,4})\s*(?:-\s*(\d{1,4})\s*)?")


@dataclass(frozen=True)
class Meeting:
    """How two scenarios may meet.

    ``lanes``: both speak of one lane, or each of its own. ``roles``: the vehicles play the same parts
    in both, or any. ``start``: both start at time 0, or one at 0 and the other then or later.
    """

    lanes: Literal["same", "any"] = "same"
    roles: Literal["same", "any"] = "same"
    start: Literal["same", "any"] = "same"


@dataclass(frozen=True)
class Node:
    """A scenario by number, in a spec set."""

    number: int
    set_name: str

    def __str__(self) -> str:
        return f"{self.number}@{self.set_name}"


def scenario_numbers(specification: Specification) -> tuple[int, ...]:
    """The numbers of the scenarios that a specification defines, in order."""
    found = (_SCENARIO.fullmatch(name) for name in specification.definitions)
    return tuple(sorted(int(name[1]) for name in found if name is not None))


def read_numbers(text: str, specification: Specification) -> tuple[int, ...]:
    """``1-8,12`` as numbers. Raises ``UsageError``, ``InputError`` for scenarios that do not exist."""
    numbers: set[int] = set()
    for piece in text.split(","):
        read = _RANGE.fullmatch(piece)
        if read is None:
            raise UsageError(f"'{piece[:40]}' is no range of scenarios; write 1-8 or 1,3-8")
        numbers |= set(range(int(read[1]), int(read[2] or read[1]) + 1))
    known = scenario_numbers(specification)
    for number in sorted(numbers - set(known)):
        raise InputError(unknown("scenario", str(number), map(str, known)))
    return tuple(sorted(numbers))


def conjunctions(specification: Specification, one: Node, other: Node, meeting: Meeting) -> tuple[str, ...]:
    """The formulas of which one has to hold for ``one`` and ``other`` to hold together.

    Names are to be read with ``specification``. The vehicles are those of the scenario that has more of them;
    a two-vehicle scenario meets scenario 2 with SV and either of its POVs.
    """
    mine, theirs = vehicles_of(specification, one), vehicles_of(specification, other)
    swapped = len(theirs) > len(mine)
    most, fewer = (theirs, mine) if swapped else (mine, theirs)
    found: list[str] = []
    for roles in _assignments(most, len(fewer), meeting.roles):
        mine_now, theirs_now = (roles, most) if swapped else (most, roles)
        first = applied(one, specification, mine_now)
        second = applied(other, specification, theirs_now, "L2" if meeting.lanes == "any" else "L")
        if meeting.start == "same":
            found.append(f"{first} and {second}")
        else:
            found += [f"{first} and F {second}", f"{second} and F {first}"]
    return tuple(found)


def vehicles_of(specification: Specification, node: Node) -> tuple[str, ...]:
    """The vehicles among the arguments of a scenario, which are SV, POVs and L. Raises ``InputError``."""
    name = f"scenario_{node.number}"
    *vehicles, lane = signature(specification.in_set(node.set_name), name)
    if lane != "L" or not vehicles or vehicles[0] != "SV":
        raise InputError(f"{name} takes {', '.join((*vehicles, lane))}: a scenario takes SV, POVs and L")
    return tuple(vehicles)


def _assignments(vehicles: Sequence[str], count: int, roles: Literal["same", "any"]) -> list[tuple[str, ...]]:
    """Who may play the ``count`` parts of the smaller scenario."""
    if roles == "any":
        return list(permutations(vehicles, count))
    return [(vehicles[0], *others) for others in combinations(vehicles[1:], count - 1)]


def applied(node: Node, home: Specification, vehicles: Sequence[str], lane: str = "L") -> str:
    """The scenario applied to vehicles and a lane, as text to be read with ``home``."""
    at = "" if node.set_name == home.set_name else f"@{node.set_name}"
    return f"scenario_{node.number}{at}({','.join((*vehicles, lane))})"
