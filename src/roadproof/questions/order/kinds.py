"""Scenarios with one formula, and the ways in which two of them can share vehicles."""

from collections.abc import Iterator, Sequence
from itertools import permutations

from roadproof.library.scenarios import Scenario, apply_scenario, numbers_of, vehicles_of, without_sectors
from roadproof.library.specification import Query, Specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.runtime.records import dataclass


@dataclass(frozen=True)
class Kind:
    """Scenarios with one formula, the first of which stands for all.

    ``family``: a number that kinds share which differ in their road sectors only.
    """

    nodes: tuple[Scenario, ...]
    family: int

    @property
    def node(self) -> Scenario:
        """The scenario that stands for all."""
        return self.nodes[0]


def kinds_of(
    specification: Specification, sets: Sequence[str], numbers: Sequence[int] | None = None
) -> tuple[Kind, ...]:
    """Return the scenarios of all ``sets`` in groups with one formula; ``numbers``: only these."""
    groups: dict[Formula, list[Scenario]] = {}
    families: dict[Formula, int] = {}
    family_of: dict[Scenario, int] = {}
    for set_name in sets:
        for number in numbers_of(specification.in_set(set_name)):
            if numbers is not None and number not in numbers:
                continue
            node = Scenario(number, set_name)
            formula = apply_scenario(specification, node).formula
            groups.setdefault(without_names(formula), []).append(node)
            family_of[node] = families.setdefault(without_sectors(formula), len(families))
    return tuple(Kind(tuple(nodes), family_of[nodes[0]]) for nodes in groups.values())


def families_of(kinds: Sequence[Kind]) -> list[tuple[Kind, ...]]:
    """Return the kinds in groups that differ in their road sectors only."""
    families: dict[int, list[Kind]] = {}
    for kind in kinds:
        families.setdefault(kind.family, []).append(kind)
    return [tuple(family) for family in families.values()]


def name_of(node: Scenario) -> str:
    """Return a scenario as a part of names of files."""
    return f"{node.set_name}-{node.number:02}"


@dataclass(frozen=True)
class Cast:
    """A scenario, and the vehicles that play in it."""

    scenario: Scenario
    vehicles: tuple[str, ...]

    def query(self, home: Specification) -> Query:
        """Return the scenario applied to its vehicles."""
        return apply_scenario(home, self.scenario, self.vehicles)


@dataclass(frozen=True)
class Reading:
    """A way to read that one scenario implies another: who plays in each."""

    above: Cast
    below: Cast


def own_cast(home: Specification, kind: Kind) -> Cast:
    """Return a kind with its own vehicles."""
    return Cast(kind.node, vehicles_of(home, kind.node))


def casts_of(
    home: Specification, kinds: Sequence[Kind], kind: Kind
) -> Iterator[tuple[Cast, tuple[Cast, ...]]]:
    """Yield the ways to give vehicles to a kind, each with what else may hold then.

    Where one of two scenarios has more vehicles, the other may have any of its POVs.
    """
    mine = vehicles_of(home, kind.node)
    by_roles: dict[tuple[str, ...], list[Cast]] = {}
    for other in kinds:
        if other == kind:
            continue
        theirs = vehicles_of(home, other.node)
        if len(theirs) == len(mine):
            by_roles.setdefault(mine, []).append(Cast(other.node, mine))
        elif len(theirs) < len(mine):
            for rest in permutations(mine[1:], len(theirs) - 1):
                by_roles.setdefault(mine, []).append(Cast(other.node, (mine[0], *rest)))
        else:
            for rest in permutations(theirs[1:], len(mine) - 1):
                by_roles.setdefault((theirs[0], *rest), []).append(Cast(other.node, theirs))
    for vehicles, others in by_roles.items():
        yield Cast(kind.node, vehicles), tuple(others)
