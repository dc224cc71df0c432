"""Parts of scenarios: what they are, and that leaving one out weakens the scenario."""

import pytest

from asking import prove
from roadproof.analysis.coverage.claims import two_vehicle_numbers
from roadproof.analysis.coverage.parts import Part, parts_of
from roadproof.library.loading import bundled_library
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict

LIBRARY = bundled_library()


def keys(set_name: str, number: int) -> list[str]:
    return [part.key for part in parts_of(LIBRARY.select(set_name), number)]


def test_components_come_with_their_conditions() -> None:
    assert keys("base", 4) == [
        "initialCondition_4",
        "initialCondition_4: aheadOf(SV, POV)",
        "initialCondition_4: sameLane(SV, POV, L) or inAdjLanes(SV, POV, L)",
        "behaviourSV_4",
        "behaviourPOV_4",
        "behaviourPOV_4: fasterThan(POV, SV) U danger(SV, POV) in decel",
        "behaviourPOV_4: laneKeep(POV, L) U danger(SV, POV) in decel",
    ]
    assert keys("base", 1)[1:] == [
        "behaviourPOV_1",
        "behaviourPOV_1: not sameLane(POV, SV, L) in cutIn",
        "behaviourPOV_1: danger(SV, POV) in cutIn",
        "behaviourPOV_1: sameLane(SV, POV, L) in cutIn",
        "behaviourPOV_1: aheadOf(SV, POV) in cutIn",
    ]


def test_a_component_that_is_true_is_no_part() -> None:
    assert not [key for key in keys("base", 1) if key.startswith("initialCondition")]


def test_a_disjunction_is_one_condition() -> None:
    wanted = "behaviourPOV_4: (fasterThan(POV, SV) or decelerates(POV)) U danger(SV, POV) in decel"
    assert wanted in keys("ext", 4)


def test_parts_of_other_sectors_are_those_of_the_first() -> None:
    for number in (12, 20):
        conditions = [part.condition for part in parts_of(LIBRARY.select("ext"), number)]
        mine = [part.condition for part in parts_of(LIBRARY.select("ext"), 4)]
        assert [x.partition(" in ")[0] for x in conditions] == [x.partition(" in ")[0] for x in mine]


@pytest.mark.parametrize("set_name", ["base", "complete"])
def test_no_two_parts_have_one_key(set_name: str) -> None:
    specification = LIBRARY.select(set_name)
    found = [p.key for n in two_vehicle_numbers(specification) for p in parts_of(specification, n)]
    assert len(found) == len(set(found))


def weakens(set_name: str, part: Part) -> bool:
    claim = f"scenario_{part.scenario}(SV,POV,L) -> ({part.without.text})"
    return prove(LIBRARY.select(set_name), claim, Effort(5.0)).verdict is Verdict.PROVED


@pytest.mark.parametrize("number", [1, 4, 6])
def test_leaving_a_part_out_weakens_the_scenario(number: int) -> None:
    assert all(weakens("ext", part) for part in parts_of(LIBRARY.select("ext"), number))


def test_a_part_left_out_of_the_wrong_scenario_does_not() -> None:
    (first, *_) = parts_of(LIBRARY.select("ext"), 4)
    wrong = Part(3, first.component, first.description, first.condition, first.without, first.finest)
    assert not weakens("ext", wrong)
