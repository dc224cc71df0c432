"""What a catalogue says of driver models, ranges, roles and notes, on answers that are put together here."""

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from extensions.catalogue.test_catalogue_verdicts import FOUR, HOME, ONE, concrete, decision, fact
from roadproof.evidence.subject import TestedSide
from roadproof.extensions.catalogue.driver_sides import read_side_name, side_name
from roadproof.extensions.catalogue.fact import CatalogueFact
from roadproof.extensions.catalogue.judge_test import _confirmed
from roadproof.extensions.catalogue.ranges import InitialValueRange, ranges_of
from roadproof.extensions.catalogue.role_choices import role_choices, vehicle_choices
from roadproof.extensions.catalogue.target_formulas import ENDANGERED, TargetFormulas
from roadproof.extensions.catalogue.view import CatalogueView
from roadproof.extensions.traffic.evaluate.decisions import Decision, decide_formula
from roadproof.reasons import NO_REASON, ReasonKind

# --- driver models ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("sides", "side"),
    [
        (("preventable", "unpreventable"), "partly"),
        (("preventable",), "undecided"),
        (("unpreventable", "unpreventable"), "undecided"),
        (("preventable", "undecided"), "undecided"),
        (("unpreventable", "not covered", "preventable"), "partly"),
    ],
)
def test_drives_on_one_side_decide_nothing_of_a_formula(
    sides: tuple[TestedSide, ...], side: TestedSide
) -> None:
    [made] = decide_formula([decision(x) for x in sides])
    assert made.side == side
    assert (made.at, made.gap, made.instant, made.speed, made.start) == (None, None, None, None, {})
    looked = {x.reason.kind for x in decide_formula([decision(x) for x in sides], {(ONE, "careful")})}
    others = {x.reason.kind for x in decide_formula([decision(x) for x in sides], {(FOUR, "careful")})}
    assert others == {ReasonKind.BOTH_SIDES if side == "partly" else ReasonKind.ONE_SIDE}
    assert looked == {ReasonKind.BOTH_SIDES if side == "partly" else ReasonKind.ONE_SIDE_SOUGHT}


def test_scenarios_and_models_are_decided_by_themselves() -> None:
    found = [decision("preventable"), decision("unpreventable", FOUR), decision("unpreventable", ONE, "rss")]
    assert [x.side for x in decide_formula(found)] == ["undecided"] * 3


@pytest.mark.parametrize(
    ("decided", "left"),
    [
        ([decision("preventable")], {ONE, "class_4", ENDANGERED}),
        ([decision("unpreventable")], {ENDANGERED}),
        ([decision("undecided")], {ENDANGERED}),
        ([], {ENDANGERED}),
        ([decision("preventable", driver="rss")], {ENDANGERED}),
        ([decision("preventable", vehicles=("POV", "SV"))], {ENDANGERED}),
    ],
)
def test_a_scenario_counts_under_a_restriction_where_its_driver_bears_it_out(
    decided: list[Decision], left: set[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    wanted = SimpleNamespace(model="careful", side="preventable", scenarios=(1,))
    monkeypatch.setattr("roadproof.extensions.catalogue.judge_test.restriction_of", lambda _: wanted)
    asked = TargetFormulas(HOME, (1,), None, {})
    found = _confirmed(concrete("t", ONE, "class_4", ENDANGERED, decisions=tuple(decided)), asked)
    assert {x.what for x in found.shown} == left
    assert bool(found.notes) is (ONE not in left)


@pytest.mark.parametrize("name", [side_name(ONE, "unpreventable", "careful"), f"{ONE} preventable (rss)"])
def test_a_side_is_read_as_it_is_written(name: str) -> None:
    read = read_side_name(name)
    assert read is not None
    assert side_name(*read) == name


@pytest.mark.parametrize(
    "name",
    [
        *(ONE, "class_4 preventable (careful)", f"{ONE} partly (careful)", f"{ONE} preventable (nobody)"),
        *(f"{ONE} preventable (careful", f"{ONE} preventable careful)"),
    ],
)
def test_other_names_are_no_sides(name: str) -> None:
    assert read_side_name(name) is None


# --- ranges, roles ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("tests", "drives", "untested", "share"),
    [
        ((2, 4), (0, 10), ((0, 2), (4, 10)), 0.8),
        ((0, 10), (0, 10), (), 0.0),
        ((0, 4), (0, 10), ((4, 10),), 0.6),
        ((3, 3), (3, 3), (), 0.0),
    ],
)
def test_the_share_of_a_range_that_no_test_is_in(
    tests: tuple[float, float], drives: tuple[float, float], untested: object, share: float
) -> None:
    found = InitialValueRange(ONE, "v_lon(SV)", "m/s", tests, drives, ("", ""))
    assert (found.untested, found.share) == (untested, pytest.approx(share))


def test_a_range_needs_both_ends_and_reaches_as_far_as_tests() -> None:
    term = "v_lon(SV)"

    def end(sense: Any, at: int, target: str = ONE) -> CatalogueFact:
        return fact("", target, "reaches", term=term, sense=sense, at=Fraction(at), reason=NO_REASON)

    tests = {ONE: {term: (5.0, 30.0)}, FOUR: {term: (5.0, 6.0)}}
    facts = [end("least", 7), end("greatest", 20), end("least", 0, FOUR)]
    [found] = ranges_of(HOME, tests, facts)
    assert (found.target, found.tested, found.reached) == (ONE, (5, 30), (5, 30))
    [found] = ranges_of(HOME, {ONE: {term: (8.0, 9.0)}}, facts)
    assert found.reached == (7, 20)
    still_open = fact("", FOUR, "open", term=term, sense="greatest")
    assert len(ranges_of(HOME, tests, [*facts, still_open])) == 1


PAIR, TRIPLE = ("SV", "POV"), ("SV", "POV1", "POV2")


@pytest.mark.parametrize(
    ("names", "free", "any_way", "found"),
    [
        (("SV", "POV"), False, False, {(PAIR, PAIR)}),
        (("SV", "POV", "x"), False, False, {(PAIR, PAIR)}),
        (("SV", "POV1", "POV2", "x"), False, False, set()),
        (("a", "b"), False, False, set()),
        (("SV", "POV1"), False, False, set()),
        (("a", "b"), False, True, {(PAIR, ("a", "b")), (PAIR, ("b", "a"))}),
        (("SV", "b"), False, False, {(PAIR, ("SV", "b"))}),
        (("SV", "POV"), True, False, {(PAIR, PAIR), (PAIR, ("POV", "SV"))}),
    ],
)
def test_vehicles_play_the_roles_that_they_are_called(
    names: tuple[str, ...], free: bool, any_way: bool, found: set[object]
) -> None:
    assert {*role_choices([PAIR], [PAIR, TRIPLE], names, free, any_way)} == found


def test_who_is_given_a_role_plays_it_and_no_other() -> None:
    assert [*vehicle_choices(("7", "8", "9"), {"SV": "8"}, PAIR)] == [(1, 0), (1, 2)]
    assert [*vehicle_choices(("7", "8", "9"), {"SV": "8", "POV1": "7"}, PAIR)] == [(1, 2)]
    assert len([*vehicle_choices(("7", "8", "9"), {}, PAIR)]) == 6


def test_notes_say_with_what_drives_were_made() -> None:
    made = object.__new__(CatalogueView)
    tests = (
        concrete("a", made_with=("rho = 1",)),
        concrete("b", notes=("odd",)),
        concrete("c", notes=("odd",)),
    )
    freedom = SimpleNamespace(lanes=False, start=False)
    vars(made).update(
        shown=(tests,),
        catalogue=SimpleNamespace(notes=("first",), entries=()),
        request=SimpleNamespace(freedom=freedom),
    )
    assert made.notes == ("first", "b, c: odd", "made with rho = 1, and judged with what is asked for: a")
