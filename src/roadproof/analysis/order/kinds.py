"""The nodes of the order: scenarios of several sets, those with one formula taken together."""

from collections.abc import Sequence
from dataclasses import dataclass

from roadproof.library.scenarios import Scenario, applied, numbers_of, without_sectors
from roadproof.library.specification import Specification
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names


@dataclass(frozen=True)
class Kind:
    """Scenarios with one formula, the first of which stands for all; ``like``: equal but for the sector."""

    nodes: tuple[Scenario, ...]
    like: int

    @property
    def node(self) -> Scenario:
        return self.nodes[0]


def kinds_of(
    specification: Specification, sets: Sequence[str], numbers: Sequence[int] | None = None
) -> tuple[Kind, ...]:
    """The scenarios of all ``sets`` in groups with one formula; ``numbers``: only these."""
    found: dict[Formula, list[Scenario]] = {}
    likes: dict[Formula, int] = {}
    like_of: dict[Scenario, int] = {}
    for set_name in sets:
        for number in numbers_of(specification.in_set(set_name)):
            if numbers is not None and number not in numbers:
                continue
            node = Scenario(number, set_name)
            formula = applied(specification, node).formula
            found.setdefault(without_names(formula), []).append(node)
            like_of[node] = likes.setdefault(without_sectors(formula), len(likes))
    return tuple(Kind(tuple(nodes), like_of[nodes[0]]) for nodes in found.values())


def families_of(kinds: Sequence[Kind]) -> list[tuple[Kind, ...]]:
    """The kinds in groups that differ in their road sectors only."""
    families: dict[int, list[Kind]] = {}
    for kind in kinds:
        families.setdefault(kind.like, []).append(kind)
    return [tuple(family) for family in families.values()]
