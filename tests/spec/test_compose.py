"""Queries put together: what is said reads as what is meant."""

import pytest

from roadproof.errors import UsageError
from roadproof.library import compose
from roadproof.library.compose import (
    always,
    both,
    conjuncts,
    either,
    equivalence,
    eventually,
    implication,
    in_some_lane,
    negation,
    with_lane,
    with_vehicles,
)
from roadproof.library.elaborate import apply_definition, read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.specification import Query
from roadproof.logic import formula as f
from roadproof.logic.rewrite import without_names

BASE = bundled_library().select()


def read(text: str) -> Query:
    return read_claim(BASE, text)


ONE = read("scenario_1(SV, POV, L)")
FOUR = read("given x: m/s: scenario_4(SV, POV, L) and v_lon(SV) > x")
PLAIN = read("danger(SV, POV) or aheadOf(SV, POV)")
LANES = read("some K in lanes: atLane(POV, K) and not (every l in lanelets(K): occ(SV, l))")
NOT = read("not danger(SV, POV)")

TOGETHER = {
    "both": both(ONE, PLAIN, FOUR),
    "both of one": both(ONE),
    "none": both(),
    "either": either(NOT, LANES, ONE),
    "no either": either(),
    "negation": negation(PLAIN),
    "negation of a negation": negation(NOT),
    "implication": implication(both(ONE, NOT), FOUR),
    "equivalence": equivalence(PLAIN, negation(ONE)),
    "eventually": eventually(PLAIN),
    "always": always(implication(PLAIN, ONE)),
    "roles exchanged": with_vehicles(both(FOUR, LANES), {"SV": "POV", "POV": "SV"}),
    "another lane": with_lane(FOUR, "L", "L2"),
    "some lane": in_some_lane(both(ONE, LANES), "L"),
    "some lane, negated": both(PLAIN, negation(in_some_lane(FOUR, "L"))),
}


@pytest.mark.parametrize("name", TOGETHER)
def test_what_is_said_reads_as_what_is_meant(name: str) -> None:
    query = TOGETHER[name]
    again = read(query.text)
    assert without_names(again.formula) == without_names(query.formula)
    assert again.formula == query.formula
    assert again.lanes == query.lanes
    assert set(again.vehicles) == set(query.vehicles)


def test_what_came_out_is_said_as_a_reader_would() -> None:
    assert negation(NOT).text == "danger(SV, POV)"
    assert implication(ONE, PLAIN).text == "scenario_1(SV, POV, L) -> danger(SV, POV) or aheadOf(SV, POV)"
    assert TOGETHER["roles exchanged"].text.startswith(
        "given x: m/s: (scenario_4(POV, SV, L) and v_lon(POV) > x)"
    )
    assert in_some_lane(ONE, "L").text == "some M in lanes: scenario_1(SV, POV, M)"
    assert ONE.text == "scenario_1(SV, POV, L)"


def test_definitions_of_other_sets_keep_their_set() -> None:
    ext = apply_definition(BASE, "scenario_4@ext")
    assert ext.text == "scenario_4@ext(SV, POV, L)"
    assert read(both(ext, PLAIN).text).formula == both(ext, PLAIN).formula
    assert ext.formula != apply_definition(BASE, "scenario_4").formula


def test_names_that_would_mean_two_things_are_refused() -> None:
    with pytest.raises(UsageError, match=r"'x' is a m/s in one formula and a m in another"):
        both(FOUR, read("given x: m: s(SV) > x"))
    with pytest.raises(UsageError, match=r"'K' is a variable of a quantifier inside"):
        with_lane(read("atLane(SV, L) and (some K in lanes: atLane(POV, K) and atLane(SV, L))"), "L", "K")


@pytest.mark.parametrize(
    "text", ["scenario_4(SV, POV, L)", "scenario_2(SV, POV1, POV2, L)", "danger(SV, POV)"]
)
def test_definitions_are_taken_from_another_set(text: str) -> None:
    query = read(text)
    taken = compose.taken_from(BASE, query, "ext")
    name, rest = text.split("(")
    assert taken.text == f"{name}@ext({rest}"
    assert taken.formula == read(taken.text).formula
    assert compose.taken_from(BASE, query, "base") == query


def test_parts_of_a_formula_are_said_by_name() -> None:
    query = read("aheadOf(SV, POV) and F danger(SV, POV) and atLane(POV1, L)")
    assert isinstance(query.formula, f.And)
    first, second, third = query.formula.parts
    two = compose.of_parts(query, [first, second])
    assert (two.text, two.vehicles, two.lanes) == (
        "aheadOf(SV, POV) and F danger(SV, POV)",
        ("POV", "SV"),
        (),
    )
    assert read(two.text).formula == two.formula
    assert compose.of_parts(query, [third]).lanes == ("L",)
    assert compose.of_parts(query, []).text == "true"


def test_conjuncts_are_what_is_joined() -> None:
    parts = conjuncts(FOUR)
    assert [part.text for part in parts] == [
        "given x: m/s: scenario_4(SV, POV, L)",
        "given x: m/s: v_lon(SV) > x",
    ]
    assert [(part.vehicles, part.lanes) for part in parts] == [(("POV", "SV"), ("L",)), (("SV",), ())]
    assert both(*parts).formula == FOUR.formula
    assert read(both(ONE, *parts).text).formula == f.conjunction(ONE.formula, *FOUR.formula.parts)  # type: ignore[union-attr]
    assert conjuncts(PLAIN) == (PLAIN,)
