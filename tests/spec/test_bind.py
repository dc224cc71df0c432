"""Formulas meet a road and values."""

from fractions import Fraction

import pytest

from roadproof.errors import InputError
from roadproof.library.bind import bind, default_values, occupies
from roadproof.library.elaborate import apply_definition, read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.uses import definitions_used, parameters_used
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.formula import Formula
from roadproof.logic.rewrite import parameters_of
from roadproof.world.road import Lanelet, Road, pairs

WIDTH = Fraction(7, 2)
METRES = (1, 0)
BASE = bundled_library().select()


def lanelet(
    name: str, lane: str, row: int, low: int | None = None, high: int | None = None, **kind: str
) -> Lanelet:
    s = tuple(None if end is None else Fraction(end) for end in (low, high))
    zone, attribute = kind.get("zone", "main"), kind.get("attribute", "main")
    return Lanelet(name, lane, zone, attribute, s, (row * WIDTH, (row + 1) * WIDTH))  # type: ignore[arg-type]


MERGE = Road(
    "merge",
    (
        lanelet("m1", "main-1", 1, None, 100),
        lanelet("m1z", "main-1", 1, 100, 300, zone="merge"),
        lanelet("m2", "main-2", 2),
        lanelet("r", "ramp", 0, 100, 300, zone="merge", attribute="merge"),
    ),
    pairs([("main-1", "main-2"), ("ramp", "main-1")]),
)
FAR = Road("far", (lanelet("a", "A", 0), lanelet("b", "B", 5)), pairs([]))


def bound(text: str, road: Road = MERGE, **lanes: str) -> Formula:
    return bind(read_claim(BASE, text).formula, road, lanes or {"L": "main-1"}, default_values(BASE.library))


def test_default_values_are_in_si_units() -> None:
    values = default_values(bundled_library())
    assert values["rho"] == Fraction(3, 5)
    assert values["b_max"] == 8
    assert set(values) >= {"rho", "a_max", "b_min", "b_max", "a_max_lat", "b_min_lat", "minSafe", "minDanger"}


def test_occupying_is_overlapping_with_positive_area() -> None:
    front, left = t.Signal("s", "SV"), t.Signal("d", "SV")
    rear, right = t.subtract(front, t.Size("length", "SV")), t.subtract(left, t.Size("width", "SV"))
    assert occupies("SV", MERGE.lanelets[3]) == f.And(
        (
            f.Compare(front, ">", t.Number(Fraction(100), METRES)),
            f.Compare(rear, "<", t.Number(Fraction(300), METRES)),
            f.Compare(left, ">", t.Number(Fraction(0), METRES)),
            f.Compare(right, "<", t.Number(WIDTH, METRES)),
        )
    )
    assert occupies("SV", MERGE.lanelets[2]) == f.And(
        (
            f.Compare(left, ">", t.Number(2 * WIDTH, METRES)),
            f.Compare(right, "<", t.Number(3 * WIDTH, METRES)),
        )
    )


def test_lanes_become_their_lanelets() -> None:
    made = bound("laneKeep(SV, L)")
    assert made == f.Application(
        "laneKeep",
        ("SV", "main-1"),
        f.Application(
            "atLane",
            ("SV", "main-1"),
            f.Or((occupies("SV", MERGE.lanelets[0]), occupies("SV", MERGE.lanelets[1]))),
        ),
    )


def test_zones_adjacent_lanes_and_all_lanes() -> None:
    in_zone = bound("some l in zone(merge): occ(SV, l)")
    assert in_zone == f.Or((occupies("SV", MERGE.lanelets[1]), occupies("SV", MERGE.lanelets[3])))
    assert bound("some l in zone(depart): occ(SV, l)") == f.FALSE
    assert bound("every l in zone(depart): occ(SV, l)") == f.TRUE
    beside = bound("some K in adjacentLanes(L): laneKeep(SV, K)")
    assert isinstance(beside, f.Or)
    assert [part.arguments for part in beside.parts if isinstance(part, f.Application)] == [
        ("SV", "main-2"),
        ("SV", "ramp"),
    ]
    everywhere = bound("every K in lanes: laneKeep(SV, K)")
    assert isinstance(everywhere, f.And)
    assert len(everywhere.parts) == 3
    assert bound("some K in adjacentLanes(L): laneKeep(SV, K)", FAR, L="A") == f.FALSE


@pytest.mark.parametrize("set_name", ["base", "extA", "ext"])
def test_nothing_symbolic_is_left(set_name: str) -> None:
    specification = bundled_library().select(set_name)
    for number in range(1, 25):
        made = bind(
            apply_definition(specification, f"scenario_{number}").formula,
            MERGE,
            {"L": "main-1"},
            default_values(specification.library),
        )
        assert parameters_of(made) == ()
        assert not any(isinstance(part, f.Some | f.Every | f.Occupies) for part in f.subformulas(made))


def test_values_may_stay_symbolic() -> None:
    formula = read_claim(BASE, "danger(SV, POV)").formula
    assert parameters_of(bind(formula, MERGE, {}, {"rho": Fraction(1)})) == (
        "a_max",
        "a_max_lat",
        "b_max",
        "b_min",
        "b_min_lat",
        "minDanger",
    )


def test_lanes_that_the_road_does_not_have() -> None:
    with pytest.raises(InputError, match="lane L=main-9: road 'merge' has the lanes main-1, main-2, ramp"):
        bound("laneKeep(SV, L)", L="main-9")
    with pytest.raises(InputError, match="lane L=L"):
        bound("laneKeep(SV, L)", K="main-1")


def test_a_bound_variable_hides_a_lane_of_that_name() -> None:
    made = bound("some K in lanes: laneKeep(SV, K)", K="ramp", L="main-1")
    assert isinstance(made, f.Or)
    assert len(made.parts) == 3


def test_uses_come_once_and_in_reading_order() -> None:
    claim = read_claim(BASE, "decel(POV, SV, L)")
    assert claim.vehicles
    from roadproof.logic.parse import parse_claim

    expression = parse_claim("decel(POV, SV, L) and G[0, minDanger] laneKeep(POV, L)").body
    used = definitions_used(BASE, expression)
    assert [d.name for d in used] == ["decel", "fasterThan", "laneKeep", "atLane"]
    assert [p.name for p in parameters_used(BASE.library, expression, used)] == ["minDanger"]
    other = parse_claim("decel@ext(POV, SV, L) and danger@ext(SV, POV)").body
    names = [d.name for d in definitions_used(BASE, other)]
    assert names[:3] == ["decel@ext", "fasterThan", "decelerates"]
    assert "danger" in names
