"""Derives the state of each goal and strategy from its solutions, and the open points of a case."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from graphlib import TopologicalSorter

from roadproof.extensions.assurance.case.case import AssuranceCase


class ElementState(StrEnum):
    """The state of a goal, strategy or solution, ordered from best to worst.

    HOLDS: all evidence below is accepted and has the expected verdicts. UNDEVELOPED: a part of the argument
    is not written. UNDECIDED: a check or a verdict is open. BROKEN: evidence is rejected, damaged or missing,
    or has another verdict.
    """

    HOLDS = "holds"
    UNDEVELOPED = "undeveloped"
    UNDECIDED = "undecided"
    BROKEN = "broken"


GRAVITY: tuple[ElementState, ...] = tuple(ElementState)
"""The states from the best to the worst."""


def worst(states: Mapping[str, ElementState], names: tuple[str, ...]) -> ElementState:
    """Return the worst state of the elements ``names``."""
    return max((states[x] for x in names), key=GRAVITY.index)


def propagate(case: AssuranceCase, of_solutions: Mapping[str, ElementState]) -> dict[str, ElementState]:
    """Return the state of each goal, strategy and solution: the worst state below it.

    Elements without support are UNDEVELOPED.
    """
    order = TopologicalSorter({x.id: x.supported_by for x in case.elements.values()}).static_order()
    states: dict[str, ElementState] = {}
    for name in order:
        element = case.elements[name]
        if element.kind.is_contextual:
            continue
        if name in of_solutions:
            states[name] = of_solutions[name]
        else:
            states[name] = (
                worst(states, element.supported_by) if element.supported_by else ElementState.UNDEVELOPED
            )
    return states


@dataclass(frozen=True)
class OpenPoint:
    """A solution or undeveloped element that does not hold, with a path from it to the top goal.

    ``others``: the number of further paths.
    """

    element: str
    state: ElementState
    path: tuple[str, ...]
    others: int = 0


def open_points(case: AssuranceCase, states: Mapping[str, ElementState]) -> Iterator[OpenPoint]:
    """Yield the elements that prevent the top goal from holding, the worst first."""
    leaves = [x for x, state in states.items() if state is not ElementState.HOLDS]
    ends = [x for x in case.elements if x in leaves and not case.elements[x].supported_by]
    ways = _ways(case)
    for name in sorted(ends, key=lambda x: -GRAVITY.index(states[x])):
        yield OpenPoint(name, states[name], _path(case, name), ways[name] - 1)


def _path(case: AssuranceCase, name: str) -> tuple[str, ...]:
    """Return a shortest path from an element up to the top goal."""
    came_from: dict[str, str | None] = {name: None}
    waiting = [name]
    for x in waiting:
        for above in case.supported[x]:
            if above not in came_from:
                came_from[above] = x
                waiting.append(above)
    path: list[str] = []
    at: str | None = case.top
    while at is not None:
        path.append(at)
        at = came_from[at]
    return tuple(reversed(path))


def _ways(case: AssuranceCase) -> dict[str, int]:
    """Return the number of paths from each element up to the top goal."""
    order = TopologicalSorter(case.supported).static_order()
    counts: dict[str, int] = {}
    for name in order:
        counts[name] = 1 if name == case.top else sum(counts[x] for x in case.supported[name])
    return counts
