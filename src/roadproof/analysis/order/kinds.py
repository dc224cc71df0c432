"""The nodes of the order: scenarios of several sets, those with one formula taken together."""

from collections.abc import Sequence
from dataclasses import dataclass

from roadproof.analysis.requests import Asked, applied
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from roadproof.spec.elaborate import read_claim
from roadproof.spec.scenarios import Scenario, numbers_of, vehicles_of, without_sectors


@dataclass(frozen=True)
class Kind:
    """Scenarios with one formula, the first of which stands for all; ``like``: equal but for the sector."""

    nodes: tuple[Scenario, ...]
    like: int

    @property
    def node(self) -> Scenario:
        return self.nodes[0]


def kinds_of(asked: Asked, numbers: Sequence[int] | None = None) -> tuple[Kind, ...]:
    """The scenarios of all sets of ``asked`` in groups with one formula; ``numbers``: only these."""
    _, specification = asked.load()
    found: dict[Formula, list[Scenario]] = {}
    likes: dict[Formula, int] = {}
    for set_name in asked.sets:
        there = specification.in_set(set_name)
        for number in numbers_of(there):
            if numbers is not None and number not in numbers:
                continue
            node = Scenario(number, set_name)
            formula = read_claim(specification, text_of(asked, node)).formula
            found.setdefault(without_names(formula), []).append(node)
            likes.setdefault(without_sectors(formula), len(likes))
    return tuple(
        Kind(
            tuple(nodes),
            likes[without_sectors(read_claim(specification, text_of(asked, nodes[0])).formula)],
        )
        for nodes in found.values()
    )


def text_of(asked: Asked, node: Scenario) -> str:
    _, specification = asked.load()
    return applied(node, specification, vehicles_of(specification, node))


def families_of(kinds: Sequence[Kind]) -> list[tuple[Kind, ...]]:
    """The kinds in groups that differ in their road sectors only."""
    families: dict[int, list[Kind]] = {}
    for kind in kinds:
        families.setdefault(kind.like, []).append(kind)
    return [tuple(family) for family in families.values()]
