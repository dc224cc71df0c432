"""Formulas meet a road and values."""

from fractions import Fraction
from fractions import Fraction as F

import pytest

from roadproof.errors import InputError, TextError, UsageError
from roadproof.extensions.surveys.composition import in_some_lane, split_conjunction, with_lane, with_vehicles
from roadproof.library import compose
from roadproof.library.bind import bind, default_values, occupies
from roadproof.library.compose import always, both, either, equivalence, eventually, implication, negation
from roadproof.library.elaborate import apply_definition, read_claim
from roadproof.library.loading import bundled_library, load_library
from roadproof.library.specification import Query, Source
from roadproof.library.uses import parts_of_claim
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.custom_names import freedom_lines
from roadproof.logic.formula import Formula
from roadproof.logic.restore import as_syntax
from roadproof.logic.rewrite import parameters_of, vehicles_of, with_values, without_names
from roadproof.logic.show import text
from roadproof.semantics.exact import judge
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.road import Lanelet, Road, adjacency
from roadproof.world.signals import KINDS
from tables import read_table

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
    adjacency([("main-1", "main-2"), ("ramp", "main-1")]),
)
FAR = Road("far", (lanelet("a", "A", 0), lanelet("b", "B", 5)), adjacency([]))


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

    used = parts_of_claim(BASE, parse_claim("decel(POV, SV, L) and G[0, minDanger] laneKeep(POV, L)"))
    assert [d.name for d in used.definitions] == ["decel", "fasterThan", "laneKeep", "atLane"]
    assert [p.name for p in used.parameters] == ["minDanger"]
    other = parse_claim("decel@ext(POV, SV, L) and danger@ext(SV, POV)")
    names = [d.name for d in parts_of_claim(BASE, other).definitions]
    assert {"decel@ext", "fasterThan", "decelerates", "danger"} <= {*names}
    assert len({*names}) == len(names)


# --- Queries put together: what is said reads as what is meant --------------------------------------


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
    taken = compose.in_spec_set(BASE, query, "ext")
    name, rest = text.split("(")
    assert taken.text == f"{name}@ext({rest}"
    assert taken.formula == read(taken.text).formula
    assert compose.in_spec_set(BASE, query, "base") == query


def test_parts_of_a_formula_are_said_by_name() -> None:
    query = read("aheadOf(SV, POV) and F danger(SV, POV) and atLane(POV1, L)")
    assert isinstance(query.formula, f.And)
    first, second, third = query.formula.parts
    two = compose.conjunction_of(query, [first, second])
    assert (two.text, two.vehicles, two.lanes) == (
        "aheadOf(SV, POV) and F danger(SV, POV)",
        ("POV", "SV"),
        (),
    )
    assert read(two.text).formula == two.formula
    assert compose.conjunction_of(query, [third]).lanes == ("L",)
    assert compose.conjunction_of(query, []).text == "true"


def test_conjuncts_are_what_is_joined() -> None:
    parts = split_conjunction(FOUR)
    assert [part.text for part in parts] == [
        "given x: m/s: scenario_4(SV, POV, L)",
        "given x: m/s: v_lon(SV) > x",
    ]
    assert [(part.vehicles, part.lanes) for part in parts] == [(("POV", "SV"), ("L",)), (("SV",), ())]
    assert both(*parts).formula == FOUR.formula
    assert read(both(ONE, *parts).text).formula == f.conjunction(ONE.formula, *FOUR.formula.parts)  # type: ignore[union-attr]
    assert split_conjunction(PLAIN) == (PLAIN,)


# --- Custom signals and kinds of vehicles in the language: what is read, what is refused, what is printed

OWN = """
signal jerk(a: vehicle): m/s^3 in [-10, 10 m/s^3] "how fast its acceleration changes"
signal red: bool "the light is red"
signal gap(a: vehicle): m in [0, inf]
signal speed(a: vehicle): km/h in [0, 36]
signal braking: bool derived by red
signal ahead(a: vehicle): m derived by s(a) + gap(a)
"""


def home(more: str = ""):
    return load_library([Source("own.spec", OWN + more)]).select()


@pytest.mark.parametrize(
    ("claim", "expanded"),
    read_table(__file__, "what_is_written_is_printed"),
)
def test_what_is_written_is_printed(claim: str, expanded: str) -> None:
    assert text(as_syntax(read_claim(home(), claim).formula, expand=True)) == expanded


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("op", ["=", "!=", ">=", "<"])
def test_all_that_compares_kinds_reads_back(kind: str, op: str) -> None:
    if kind == KINDS[0] and op in (">=", "<"):
        return  # nothing comes before the first
    made = read_claim(home(), f"kind(SV) {op} {kind}").formula
    for part in (made, *getattr(made, "parts", ())):
        assert read_claim(home(), text(as_syntax(part))).formula == part


def test_bounds_are_in_si_and_said() -> None:
    formula = read_claim(home(), "speed(SV) > 1 m/s and jerk(SV) > 0 and red and gap(SV) < 1 m").formula
    assert freedom_lines(formula) == (
        "gap is any function of time within [0, inf] m",
        "jerk is any function of time within [-10, 10] m/s^3",
        "red is unconstrained: any function of time",
        "speed is any function of time within [0, 10] m/s",
    )
    assert freedom_lines(read_claim(home("signal x: bool derived by true"), "x").formula) == ()


def test_roles_are_exchanged_in_own_signals_and_never_in_kinds() -> None:
    query = read_claim(home(), "given truck: vehicle: jerk(truck) > 1 m/s^3 and red and kind(truck) = truck")
    renamed = with_vehicles(query, {"truck": "POV"})
    assert vehicles_of(renamed.formula) == ("POV",)
    assert without_names(read_claim(home(), renamed.text).formula) == renamed.formula


def test_a_derived_signal_is_shown_with_what_it_is_derived_by() -> None:
    query = read_claim(home(), "F braking and ahead(SV) > 0")
    assert [x.name for x in parts_of_claim(home(), query.claim).definitions] == ["braking", "ahead"]


def test_the_fingerprint_changes_with_signals_only() -> None:
    plain = bundled_library().fingerprint
    assert load_library([Source("x", "")]).fingerprint == plain
    assert len({plain, home().library.fingerprint, home("signal y: m").library.fingerprint}) == 3


@pytest.mark.parametrize(
    ("claim", "column", "told"),
    read_table(__file__, "mistakes_in_claims"),
)
def test_mistakes_in_claims(claim: str, column: int, told: str) -> None:
    with pytest.raises(TextError) as raised:
        read_claim(home(), claim)
    assert told in str(raised.value)
    assert f"line 1, column {column}:" in str(raised.value)


@pytest.mark.parametrize(
    ("declared", "told"),
    read_table(__file__, "mistakes_in_declarations"),
)
def test_mistakes_in_declarations(declared: str, told: str) -> None:
    with pytest.raises(TextError) as raised:
        read_claim(home(declared), "x = 1 m" if "x:" in declared else "red")
    assert told in str(raised.value)


# --- Definitions under their options, judged at one instant -----------------------------------------

LIBRARY = bundled_library()


def going(v_lon: int, v_lat: int) -> Motion:
    return Motion(F(9, 2), F(9, 5), F(0), F(3), F(v_lon), F(v_lat), (Piece(None, F(0), F(0)),))


@pytest.mark.parametrize(
    ("sv", "pov", "along", "total"),
    [
        ((30, 0), (29, 8), False, True),  # 900 and 905
        ((30, 0), (29, -8), False, True),
        ((30, 0), (29, 7), False, False),  # 900 and 890
        ((29, 8), (30, 0), True, False),
        ((30, 4), (30, -4), False, False),
        ((20, 0), (30, 0), True, True),
    ],
)
def test_faster_along_the_road_or_in_all(
    sv: tuple[int, int], pov: tuple[int, int], along: bool, total: bool
) -> None:
    drive = Drive({"SV": going(*sv), "POV": going(*pov)})
    for options, expected in (({}, along), ({"speed": "total"}, total)):
        formula = read_claim(LIBRARY.select("base", options), "fasterThan(SV, POV)").formula
        assert judge(with_values(formula, default_values(LIBRARY)), drive).holds == expected
