"""Which definitions and parameters a claim is made of, as elaboration reports it."""

import pytest

from roadproof.extensions.pages.places import places_of
from roadproof.library.elaborate import definitions_below, read_claim
from roadproof.library.loading import load_library
from roadproof.library.specification import Source, Specification
from roadproof.library.uses import PartsOfClaim, parts_of_claim
from roadproof.logic.parse import parse_claim

SPEC = """
param gap = 2 s where gap > 0 "a gap"
def leaf(a: vehicle) "a leaf" := v_lon(a) > 8 m/s
def bar(a: vehicle) "a bar" := leaf(a)
def foo(a: vehicle) "a foo" := bar(a)
def alike(a: vehicle) "the same in both" := v_lon(a) > 3 m/s
def both(a: vehicle) "two readings" := foo@mine(a) and foo(a)
def turned(a: vehicle) "in the other order" := foo(a) and foo@mine(a)
def near(a: vehicle) "near" := (some gap in lanes: atLane(a, gap)) and v_lon(a) > gap*5 m/s^2
def rate(a: vehicle) "a number" := v_lon(a) / gap
set mine extends base "of my own" {
  def bar(a: vehicle) "a bar" := v_lon(a) > 5 m/s
}
"""


def home(*options: str) -> Specification:
    return load_library([Source("mine.spec", SPEC)]).select(*options)


def used(text: str, specification: Specification | None = None) -> PartsOfClaim:
    return parts_of_claim(specification or home(), parse_claim(text))


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("both(SV)", ["both", "foo", "bar@mine", "bar", "leaf"]),
        ("turned(SV)", ["turned", "foo", "bar", "leaf", "bar@mine"]),
        ("foo@mine(SV)", ["foo", "bar@mine"]),
        ("foo@mine(SV) and foo(SV)", ["foo", "bar@mine", "bar", "leaf"]),
        ("alike@mine(SV)", ["alike"]),
        ("rate(SV) > 1 m/s^2", ["rate"]),
    ],
)
def test_every_definition_is_entered_once_under_each_reading(text: str, names: list[str]) -> None:
    specification = home()
    for _ in range(2):  # the second walk knows what the first has read
        assert [x.name for x in used(text, specification).definitions] == names
    assert [x.name for x in used(text).definitions] == names


def test_a_walk_that_has_only_compared_a_definition_enters_it_later() -> None:
    specification = home()
    assert "leaf" not in used("foo@mine(SV)", specification).named
    assert "leaf" in used("foo(SV)", specification).named


def test_the_set_that_is_asked_names_its_own_definitions() -> None:
    found = used("foo(SV) and foo@base(SV)", home("mine"))
    assert {*found.named} == {"foo", "bar", "bar@base", "leaf"}


@pytest.mark.parametrize(
    ("text", "names"),
    [("near(SV)", ["gap"]), ("rate(SV) > 1 m/s^2", ["gap"]), ("F[0, gap] foo(SV)", ["gap"]), ("foo(SV)", [])],
)
def test_parameters_are_those_of_the_elaborated_claim(text: str, names: list[str]) -> None:
    found = {x.name for x in used(text).parameters}
    assert {*names} == found & {"gap"}


def test_a_definition_is_entered_with_all_below_it() -> None:
    assert [name for _, name in definitions_below(home(), "foo")] == ["foo", "bar", "leaf"]
    assert [name for _, name in definitions_below(home(), "rate")] == ["rate"]
    assert [*definitions_below(home("mine"), "foo")] == [("mine", "foo"), ("mine", "bar")]


def test_places_are_in_definitions_that_are_entered() -> None:
    specification = home()
    lines = {x.at.line for x in places_of(specification, read_claim(specification, "foo@mine(SV)"))}
    assert 3 not in lines, "leaf is no part of foo@mine"
    assert {5, 12} <= lines
