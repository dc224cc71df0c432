"""The state of each goal and strategy, which follows from its solutions, and the open points of a case."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from graphlib import TopologicalSorter

from roadproof.extensions.assurance.case.case import Case


class State(StrEnum):
    """HOLDS: all evidence below is accepted and has the verdicts expected. BROKEN: some is rejected, damaged
    or missing, or has another verdict. UNDECIDED: the check of some, or its verdict, is open. UNDEVELOPED: a
    part of the argument is not written."""

    HOLDS = "holds"
    UNDEVELOPED = "undeveloped"
    UNDECIDED = "undecided"
    BROKEN = "broken"


GRAVITY: tuple[State, ...] = tuple(State)
"""From the best to the worst."""


def worst(states: Mapping[str, State], names: tuple[str, ...]) -> State:
    """The worst state of some elements."""
    return max((states[x] for x in names), key=GRAVITY.index)


def propagate(case: Case, of_solutions: Mapping[str, State]) -> dict[str, State]:
    """The state of each goal, strategy and solution: the worst below it; undeveloped where that is marked."""
    order = TopologicalSorter({x.id: x.supported_by for x in case.elements.values()}).static_order()
    found: dict[str, State] = {}
    for name in order:
        element = case.elements[name]
        if element.kind.is_contextual:
            continue
        if name in of_solutions:
            found[name] = of_solutions[name]
        else:
            found[name] = worst(found, element.supported_by) if element.supported_by else State.UNDEVELOPED
    return found


@dataclass(frozen=True)
class OpenPoint:
    """A solution or undeveloped element that does not hold, and the elements from there to the top goal.

    ``others``: the number of further ways to the top.
    """

    element: str
    state: State
    path: tuple[str, ...]
    others: int = 0


def open_points(case: Case, states: Mapping[str, State]) -> Iterator[OpenPoint]:
    """The elements that keep the top goal from holding, the worst first."""
    leaves = [x for x, state in states.items() if state is not State.HOLDS]
    ends = [x for x in case.elements if x in leaves and not case.elements[x].supported_by]
    ways = _ways(case)
    for name in sorted(ends, key=lambda x: -GRAVITY.index(states[x])):
        yield OpenPoint(name, states[name], _path(case, name), ways[name] - 1)


def _path(case: Case, name: str) -> tuple[str, ...]:
    """A shortest way from an element to the top."""
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


def _ways(case: Case) -> dict[str, int]:
    """The number of ways from each element to the top."""
    order = TopologicalSorter(case.supported).static_order()
    found: dict[str, int] = {}
    for name in order:
        found[name] = 1 if name == case.top else sum(found[x] for x in case.supported[name])
    return found
