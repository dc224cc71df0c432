"""States of goals against an independent definition, on random arguments."""

import random
from collections.abc import Mapping

import pytest

from extensions.assurance.cases import random_case
from roadproof.extensions.assurance.case.case import AssuranceCase, ElementKind
from roadproof.extensions.assurance.case.states import ElementState, open_points, propagate

SEEDS = range(200)


def leaves_below(case: AssuranceCase, name: str) -> set[str]:
    """All elements without support that an element reaches, itself where it has none."""
    below = case.elements[name].supported_by
    return {name} if not below else set().union(*(leaves_below(case, x) for x in below))


def expected(case: AssuranceCase, given: Mapping[str, ElementState], name: str) -> ElementState:
    """By sets: broken where some leaf is, else undecided, else undeveloped."""
    found = {given.get(x, ElementState.UNDEVELOPED) for x in leaves_below(case, name)}
    for state in (ElementState.BROKEN, ElementState.UNDECIDED, ElementState.UNDEVELOPED):
        if state in found:
            return state
    return ElementState.HOLDS


def given(case: AssuranceCase, seed: int) -> dict[str, ElementState]:
    chance = random.Random(-seed)
    solved = (
        ElementState.HOLDS,
        ElementState.HOLDS,
        ElementState.HOLDS,
        ElementState.UNDECIDED,
        ElementState.BROKEN,
    )
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
    leaves = {x for x in leaves_below(case, case.top) if found[x] is not ElementState.HOLDS}
    assert {x.element for x in points} == leaves
    assert bool(points) == (found[case.top] is not ElementState.HOLDS)
    worst_first = (ElementState.BROKEN, ElementState.UNDECIDED, ElementState.UNDEVELOPED)
    assert [x.state for x in points] == sorted((x.state for x in points), key=worst_first.index)
    for x in points:
        assert (x.path[0], x.path[-1]) == (x.element, case.top)
        assert all(
            one in case.elements[two].supported_by for one, two in zip(x.path, x.path[1:], strict=False)
        )
        assert x.others + 1 == ways(case, case.top, x.element)


def ways(case: AssuranceCase, name: str, end: str) -> int:
    if name == end:
        return 1
    return sum(ways(case, x, end) for x in case.elements[name].supported_by)


def test_random_cases_have_all_kinds_and_shared_solutions() -> None:
    cases = [random_case(seed) for seed in SEEDS]
    assert {x.kind for case in cases for x in case.elements.values()} == {*ElementKind}
    assert any(len(above) > 1 for case in cases for above in case.supported.values())
