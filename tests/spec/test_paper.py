"""The library against the paper, and faults in the library that this comparison has to find."""

import re
from functools import cache

import pytest

from roadproof.errors import RoadproofError
from roadproof.library.elaborate import apply_definition, read_claim
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.specification import Library, Source, source_of
from roadproof.logic import formula as f
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import without_names
from spec import paper

SETS = ("base", "extA", "ext")
LIBRARY = bundled_library()


def plain(formula: Formula) -> Formula:
    """Without names and without constants inside."""

    def settle(part: Formula) -> Formula:
        match part:
            case f.And(parts):
                return f.conjunction(*parts)
            case f.Or(parts):
                return f.disjunction(*parts)
            case _:
                return part

    return f.transform(without_names(formula), settle)


def differing(library: Library) -> list[tuple[str, int]]:
    """The scenarios that are not the paper's."""
    selected = {set_name: library.select(set_name) for set_name in SETS}
    return [
        (set_name, number)
        for set_name, specification in selected.items()
        for number in range(1, 25)
        if plain(apply_definition(specification, f"scenario_{number}").formula) != of_paper(set_name, number)
    ]


@cache
def of_paper(set_name: str, number: int) -> Formula:
    return paper.Table(set_name).scenario(number)


def test_all_scenarios_are_the_papers() -> None:
    assert differing(LIBRARY) == []


def test_danger_arises() -> None:
    formula = read_claim(LIBRARY.select(), "dangerArises(SV, POV)").formula
    assert plain(formula) == paper.danger_arises("SV", "POV")


@pytest.mark.parametrize("number", range(1, 25))
def test_scenarios_have_their_roles(number: int) -> None:
    query = apply_definition(LIBRARY.select(), f"scenario_{number}")
    assert set(query.vehicles) == ({"SV", "POV1", "POV2"} if number in (2, 10, 18) else {"SV", "POV"})
    assert query.lanes == ("L",)


ROWS = {row: [row, row + 8, row + 16] for row in range(1, 9)}


def rows(*wanted: int, sets: tuple[str, ...] = SETS) -> list[tuple[str, int]]:
    found = sorted(number for row in wanted for number in ROWS[row])
    return [(set_name, number) for set_name in sets for number in found]


def numbers(first: int, last: int) -> list[tuple[str, int]]:
    return [(set_name, number) for set_name in SETS for number in range(first, last + 1)]


EVERYWHERE = numbers(1, 24)
# Name of the fault: what to replace in the library, by what, and exactly which scenarios then differ.
MUTANTS = {
    "aheadOf with its arguments swapped": (
        "front(a) <= rear(b)",
        "front(b) <= rear(a)",
        rows(1, 2, 3, 4, 5, 7, 8, sets=("base", "extA")),
    ),
    "aheadOf strict": ("front(a) <= rear(b)", "front(a) < rear(b)", rows(1, 2, 3, 4, 5, 7, 8, sets=("base", "extA"))),
    "rear without the length": ("s(a) - length(a)", "s(a)", rows(1, 2, 3, 4, 5, 7, 8, sets=("base", "extA"))),
    "fasterThan swapped": ("v_lon(a) < v_lon(b)", "v_lon(b) < v_lon(a)", rows(3, 4, 7, 8)),
    "danger without minDanger": ("G[0, minDanger] rssViolation", "G[0, 0] rssViolation", EVERYWHERE),
    "initSafe for minDanger": ("G[0, minSafe]", "G[0, minDanger]", EVERYWHERE),
    "initSafe without not": ('"no violation now" := not ', '"no violation now" := ', EVERYWHERE),
    "RSS without the response": ("v_r*rho + a_max", "a_max", EVERYWHERE),
    "RSS with b_max for b_min": ("/(2*b_min)", "/(2*b_max)", EVERYWHERE),
    "lateral velocities as the paper prints them": ("dRSS_lat(-v_lat(left), -v_lat(right))", "dRSS_lat(v_lat(left), v_lat(right))", EVERYWHERE),
    "dangerAhead with the wrong length": ("length(b) + dRSS_lon", "length(a) + dRSS_lon", EVERYWHERE),
    "dangerLeft the wrong way round": ("width(b) + lateralDistance(b, a)", "width(b) + lateralDistance(a, b)", EVERYWHERE),
    "rssViolation with or": ("rssViolation_lon(a, b) and rssViolation_lat", "rssViolation_lon(a, b) or rssViolation_lat", EVERYWHERE),
    "mainRoad of some": ("every x in a: onMainRoad(x)", "some x in a: onMainRoad(x)", numbers(1, 8)),
    "mergeZone of all": ("some x in a: inMergeZone(x)", "every x in a: inMergeZone(x)", numbers(9, 16)),
    "initSafe towards one vehicle": ("(every x in POV: initSafe(SV, x))", "(some x in POV: initSafe(SV, x))", rows(2)),
    "leavingLane stays": ("atLane(a, L) and F not atLane(a, L)", "atLane(a, L) and F atLane(a, L)", rows(2, 5, 6, 8)),
    "enteringLane starts inside": ("not atLane(a, L) and F atLane", "atLane(a, L) and F atLane", rows(7)),
    "until the wrong way round": (
        'behaviourSV_4(SV, POV: vehicle, L: lane) "SV keeps its lane"\n  := laneKeep(SV, L) U danger(SV, POV)',
        "behaviourSV_4(SV, POV: vehicle, L: lane) := danger(SV, POV) U laneKeep(SV, L)",
        rows(4),
    ),
    "decel for accel": (
        'behaviourPOV_3(POV, SV: vehicle, L: lane) "POV behind is faster"\n  := accel',
        "behaviourPOV_3(POV, SV: vehicle, L: lane) := decel",
        rows(3),
    ),
    "scenario 2 in danger from POV1": ("L) and danger(SV, POV2)", "L) and danger(SV, POV1)", rows(2)),
    "shifted rows": ("initialCondition_{i-8}", "initialCondition_{i-7}", None),
    "cutIn without its window": ("F[0, minDanger] (sameLane(SV, POV, L) and aheadOf", "F (sameLane(SV, POV, L) and aheadOf", rows(1, 5, sets=("base", "extA"))),
    "accel by braking in extA": ("or accelerates(POV)", "or decelerates(POV)", rows(3, 7, sets=("extA", "ext"))),
    "ext from base": ("set ext extends extA", "set ext extends base", rows(3, 4, 7, 8, sets=("ext",))),
    "ext keeps the order": (":= aheadOf_ext(a, b)", ":= front(a) <= rear(b)", rows(2, 3, 4, 7, 8, sets=("ext",))),
}  # fmt: skip


@pytest.mark.parametrize("name", MUTANTS)
def test_a_fault_in_the_library_is_found(name: str) -> None:
    right, wrong, expected = MUTANTS[name]
    text = source_of(LIBRARY, LIBRARY.definitions["danger"]).text
    assert right in text, "the mutant must change something"
    mutant = build_library([Source("mutant.spec", text.replace(right, wrong))])
    if expected is None:
        with pytest.raises((AssertionError, RoadproofError)):
            assert differing(mutant) == []
    else:
        assert differing(mutant) == expected


@pytest.mark.parametrize(
    ("option", "value"),
    [("lateral_sign", "literal"), ("lateral_rss", "signed"), ("speed", "total"), ("rss_form", "robust")],
)
def test_an_option_changes_what_it_says_and_nothing_else(option: str, value: str) -> None:
    ours, changed = LIBRARY.select("base"), LIBRARY.select("base", {option: value})
    differ = {n for n in ours.definitions if ours.definitions[n] is not changed.definitions[n]}
    assert (
        differ
        == {
            "lateral_sign": {"lateralDistance"},
            "lateral_rss": {"dRSS_lat"},
            "speed": {"fasterThan"},
            "rss_form": {"rssViolation_lon", "rssViolation_lat"},
        }[option]
    )


def test_sets_override_what_they_say_and_nothing_else() -> None:
    definitions = {name: LIBRARY.select(name).definitions for name in SETS}

    def differ(a: str, b: str) -> set[str]:
        return {n for n in definitions[a] if definitions[a][n] is not definitions[b][n]}

    assert differ("base", "extA") == {"accel", "decel"}
    assert differ("extA", "ext") == {"cutIn", "aheadOf"}


def test_no_formula_is_written_twice() -> None:
    """Two definitions with one body and one signature would be copies."""
    seen: dict[object, str] = {}
    allowed = re.compile(r"(roadSector|initialCondition|behaviour(SV|POV))_\d+|initialCondition_\d+")
    for name, definition in LIBRARY.definitions.items():
        if allowed.fullmatch(name):
            continue  # rows of the paper's table may agree, and 9..24 refer to 1..8
        key = (definition.parameters, definition.body)
        assert key not in seen, f"{name} repeats {seen.get(key)}"
        seen[key] = name
