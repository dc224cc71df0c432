"""States of goals against an independent definition, on random arguments."""

import random
from collections.abc import Mapping

import pytest

from extensions.assurance.cases import random_case
from roadproof.extensions.assurance.case.case import Case, Kind
from roadproof.extensions.assurance.case.states import State, open_points, propagate

SEEDS = range(200)


def leaves_below(case: Case, name: str) -> set[str]:
    """All elements without support that an element reaches, itself where it has none."""
    below = case.elements[name].supported_by
    return {name} if not below else set().union(*(leaves_below(case, x) for x in below))


def expected(case: Case, given: Mapping[str, State], name: str) -> State:
    """By sets: broken where some leaf is, else undecided, else undeveloped."""
    found = {given.get(x, State.UNDEVELOPED) for x in leaves_below(case, name)}
    for state in (State.BROKEN, State.UNDECIDED, State.UNDEVELOPED):
        if state in found:
            return state
    return State.HOLDS


def given(case: Case, seed: int) -> dict[str, State]:
    chance = random.Random(-seed)
    solved = (State.HOLDS, State.HOLDS, State.HOLDS, State.UNDECIDED, State.BROKEN)
    return {x.id: chance.choice(solved) for x in case.solutions}


@pytest.mark.parametrize("seed", SEEDS)
def test_states_are_those_of_the_definition(seed: int) -> None:
    case = random_case(seed)
    solved = given(case, seed)
    found = propagate(case, solved)
    arguing = [x.id for x in case.elements.values() if not x.kind.is_contextual]
    assert found == {name: expected(case, solved, name) for name in arguing}


@pytest.mark.parametrize("seed", SEEDS)
def test_open_points_lead_to_the_top(seed: int) -> None:
    case = random_case(seed)
    found = propagate(case, given(case, seed))
    points = [*open_points(case, found)]
    leaves = {x for x in leaves_below(case, case.top) if found[x] is not State.HOLDS}
    assert {x.element for x in points} == leaves
    assert bool(points) == (found[case.top] is not State.HOLDS)
    worst_first = (State.BROKEN, State.UNDECIDED, State.UNDEVELOPED)
    assert [x.state for x in points] == sorted((x.state for x in points), key=worst_first.index)
    for x in points:
        assert (x.path[0], x.path[-1]) == (x.element, case.top)
        assert all(
            one in case.elements[two].supported_by for one, two in zip(x.path, x.path[1:], strict=False)
        )
        assert x.others + 1 == ways(case, case.top, x.element)


def ways(case: Case, name: str, end: str) -> int:
    if name == end:
        return 1
    return sum(ways(case, x, end) for x in case.elements[name].supported_by)


def test_random_cases_have_all_kinds_and_shared_solutions() -> None:
    cases = [random_case(seed) for seed in SEEDS]
    assert {x.kind for case in cases for x in case.elements.values()} == {*Kind}
    assert any(len(above) > 1 for case in cases for above in case.supported.values())
