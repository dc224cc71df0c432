"""The template: what Python knows of the scenarios comes from the specification."""

from fractions import Fraction

import pytest

from roadproof.errors import InputError, TextError, UsageError
from roadproof.library import scenario_references as references
from roadproof.library import scenarios
from roadproof.library.elaborate import read_claim, signature
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.scenarios import Scenario
from roadproof.library.specification import Source, Specification
from roadproof.library.words import called
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import without_names

BASE = bundled_library().select()


def with_text(text: str, set_name: str = "base") -> Specification:
    return build_library([Source("mine.spec", text)], bundled_library()).select(set_name)


def test_the_paper_has_24_scenarios_in_three_sectors() -> None:
    assert scenarios.numbers_of(BASE) == tuple(range(1, 25))
    assert scenarios.likes_of(BASE) == {n: (n - 1) % 8 + 1 for n in range(1, 25)}
    sectors = [without_names(scenarios.sector(BASE, n, ("SV", "POV")).formula) for n in range(1, 25)]
    assert [sectors.index(s) + 1 for s in sectors] == [1] * 8 + [9] * 8 + [17] * 8


@pytest.mark.parametrize("number", range(1, 25))
def test_l_is_the_lane_of_sv_but_for_lane_changes_towards_pov(number: int) -> None:
    owner = "POV" if number in (7, 15, 23) else "SV"
    assert scenarios.lane_owner(BASE, Scenario(number, "ext")) == owner


def test_a_file_may_say_whose_lane_it_is() -> None:
    mine = with_text('lane of POV2 for 2, 10 "odd"\nlane of SV for 7\n')
    assert scenarios.lane_owner(mine, Scenario(10, "base")) == "POV2"
    assert scenarios.lane_owner(mine, Scenario(7, "base")) == "SV"
    assert scenarios.lane_owner(mine, Scenario(15, "base")) == "POV"
    with pytest.raises(InputError, match="lane of POV2 for 4: the scenario has SV, POV; name one of them"):
        scenarios.lane_owner(with_text("lane of POV2 for 4"), Scenario(4, "base"))
    with pytest.raises(TextError, match="lane of scenario '7' is given twice"):
        with_text("lane of SV for 7, 8\nlane of POV for 6..7")


def test_applications_are_what_a_reader_would_write() -> None:
    ext = Scenario(2, "ext")
    written = {
        "scenario_2@ext(SV, POV1, POV2, L)": scenarios.applied(BASE, ext),
        "scenario_4(POV2, SV, L2)": scenarios.applied(BASE, Scenario(4, "base"), ("POV2", "SV"), "L2"),
        "initSafe(SV, POV) and F danger(SV, POV)": scenarios.danger_comes(BASE, "SV", "POV"),
        "roadSector_9(SV, POV1, POV2)": scenarios.sector(BASE, 9, ("SV", "POV1", "POV2")),
        "disturb_4(SV, POV, L)": scenarios.disturbance(BASE, 4, ("SV", "POV")),
        "inMergeZone(SV)": scenarios.in_zone(BASE, "SV", "merge"),
    }
    for text, query in written.items():
        assert query.text == text
    for text in written:
        assert read_claim(BASE, text).formula == written[text].formula


def test_a_scenario_of_ones_own_has_to_take_what_scenarios_take() -> None:
    mine = with_text("def scenario_30(SV, POV: vehicle) := danger(SV, POV)")
    assert scenarios.numbers_of(mine)[-1] == 30
    with pytest.raises(InputError, match="scenario_30 takes SV, POV: a scenario takes SV, POVs and L"):
        scenarios.vehicles_of(mine, Scenario(30, "base"))
    assert not scenarios.follows_template(mine, 30)
    assert scenarios.follows_template(mine, 24)


def test_components_come_from_the_template() -> None:
    pair = [q.text for q in scenarios.components(BASE, 4, ("SV", "POV"))]
    assert pair == [
        "behaviourSV_4(SV, POV, L)",
        "behaviourPOV_4(POV, SV, L)",
        "initialCondition_4(SV, POV, L)",
    ]
    assert len(scenarios.components(BASE, 2, ("SV", "POV1", "POV2"))) == 3
    assert scenarios.components(BASE, 2, ("SV", "POV1")) == []


def test_a_moment_of_danger_may_be_any_fraction() -> None:
    found = scenarios.danger_at(BASE, "SV", "POV", Fraction(27, 5))
    assert found.formula == read_claim(BASE, "F[5.4 s, 5.4 s] danger(SV, POV)").formula
    alone = scenarios.alone_in_lane(BASE, "POV")
    assert alone.formula == read_claim(BASE, "every M in adjacentLanes(L): not atLane(POV, M)").formula


@pytest.mark.parametrize(
    ("text", "number", "means"),
    [
        ("4", 4, "scenario_4(SV, POV, L)"),
        (" scenario_2 ", 2, "scenario_2(SV, POV1, POV2, L)"),
        ("scenario_4(POV, SV, L)", None, "scenario_4(POV, SV, L)"),
        ("F danger(SV, POV)", None, "F danger(SV, POV)"),
    ],
)
def test_a_scenario_is_named_by_its_number(text: str, number: int | None, means: str) -> None:
    found, query = references.read_query(BASE, text)
    assert found == number
    assert query.formula == read_claim(BASE, means).formula
    assert query.text == means


def test_a_number_of_no_scenario_is_refused() -> None:
    with pytest.raises(TextError, match="scenario_99"):
        references.read_query(BASE, "99")


def test_a_scenario_that_is_applied_is_read_from_a_tree() -> None:
    def read(text: str) -> references.Application | None:
        return references.application_in(BASE, parse_claim(text).body)

    assert read("scenario_4(SV, POV, L)") == references.Application(Scenario(4, "base"), ("SV", "POV", "L"))
    assert read("scenario_12@ext( A,B , M )") == references.Application(Scenario(12, "ext"), ("A", "B", "M"))
    for other in (
        "scenario_2_initSafe_POV1(SV, POV, POV2, L)",
        "danger(SV, POV)",
        "not scenario_4(SV, POV, L)",
        "scenario_4(SV, POV, s(SV))",
        "true",
    ):
        assert read(other) is None


def test_numbers_are_told_from_formulas() -> None:
    assert all(map(scenarios.are_numbers, ("4", "1-8, 12", "scenario_4", "1--3")))
    assert not any(map(scenarios.are_numbers, ("danger(SV, POV)", "scenario_4(SV, POV, L)", "P4", "")))


def test_what_vehicles_are_called() -> None:
    assert [scenarios.roles(n) for n in (1, 2, 3)] == [("SV",), ("SV", "POV"), ("SV", "POV1", "POV2")]
    for number in scenarios.numbers_of(BASE):
        vehicles = scenarios.vehicles_of(BASE, Scenario(number, "base"))
        assert vehicles == scenarios.roles(len(vehicles))


def test_detectors_are_definitions_about_a_pair_and_a_lane() -> None:
    for name in scenarios.COMPARISON:
        assert signature(BASE, name) == (*scenarios.PAIR, scenarios.LANE)
    assert scenarios.beside_lane(BASE, "POV", "L1").text == "some M in adjacentLanes(L1): atLane(POV, M)"


def test_a_name_in_the_words_of_iso_34502_stands_for_scenarios() -> None:
    assert references.read_numbers(BASE, "cut-in") == (1, 5, 9, 13, 17, 21)
    assert references.read_numbers(BASE, "Cut-In, lane change, merge zone") == (13,)
    assert references.read_numbers(BASE, "cut-out, lane change (SV leaves its lane), main road") == (6,)
    assert references.read_numbers(BASE, "cut-in,7") == (1, 5, 7, 9, 13, 17, 21)
    assert references.read_query(BASE, "cut-in, lane keep, main road")[0] == 1
    assert references.claimed(BASE, "deceleration ahead, lane keep, main road", "here") == "scenario_4"


def test_every_scenario_is_found_by_its_own_name() -> None:
    for number, words in called(BASE).items():
        assert references.read_numbers(BASE, words.name) == (number,)


def test_a_name_that_several_scenarios_have_is_refused_with_the_choices() -> None:
    with pytest.raises(UsageError, match="names 6 scenarios") as refused:
        references.read_query(BASE, "cut-in")
    assert "\n  13: cut-in, lane change (SV leaves its lane), merge zone" in str(refused.value)
    with pytest.raises(InputError, match="names 6 scenarios"):
        references.claimed(BASE, "cut-in", "here")


@pytest.mark.parametrize("text", ["cut", "cutIn", "danger", "cut-in, moon", "", ",", "main"])
def test_what_names_no_scenario_is_left_to_formulas(text: str) -> None:
    assert references.numbers_called(BASE, text) == ()
