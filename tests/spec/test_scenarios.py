"""The template: what Python knows of the scenarios comes from the specification."""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from fractions import Fraction as F
from itertools import pairwise
from pathlib import Path

import pytest

from roadproof.errors import InputError, TextError, UsageError
from roadproof.extensions.catalogue.catalogue_file import claimed_definition
from roadproof.extensions.traffic import scenario_parts
from roadproof.library import scenario_references as references
from roadproof.library import scenarios
from roadproof.library.bind import bind, default_values
from roadproof.library.elaborate import read_claim, signature
from roadproof.library.loading import build_library, bundled_library
from roadproof.library.scenarios import PAIR, TRIPLE, Scenario
from roadproof.library.sector_twins import sector_twins
from roadproof.library.specification import Source, Specification
from roadproof.library.words import words_by_number
from roadproof.logic.parse import parse_claim
from roadproof.logic.rewrite import without_names
from roadproof.semantics.exact import judge
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road
from tables import read_table

BASE = bundled_library().select()


def with_text(text: str, set_name: str = "base") -> Specification:
    return build_library([Source("mine.spec", text)], bundled_library()).select(set_name)


def test_the_paper_has_24_scenarios_in_three_sectors() -> None:
    assert scenarios.numbers_of(BASE) == tuple(range(1, 25))
    assert sector_twins(BASE) == {n: (n - 1) % 8 + 1 for n in range(1, 25)}
    sectors = [without_names(scenario_parts.sector(BASE, n, ("SV", "POV")).formula) for n in range(1, 25)]
    assert [sectors.index(s) + 1 for s in sectors] == [1] * 8 + [9] * 8 + [17] * 8


@pytest.mark.parametrize("number", range(1, 25))
def test_l_is_the_lane_of_sv_but_for_lane_changes_towards_pov(number: int) -> None:
    owner = "POV" if number in (7, 15, 23) else "SV"
    assert scenario_parts.lane_owner(BASE, Scenario(number, "ext")) == owner


def test_a_file_may_say_whose_lane_it_is() -> None:
    mine = with_text('lane of POV2 for 2, 10 "odd"\nlane of SV for 7\n')
    assert scenario_parts.lane_owner(mine, Scenario(10, "base")) == "POV2"
    assert scenario_parts.lane_owner(mine, Scenario(7, "base")) == "SV"
    assert scenario_parts.lane_owner(mine, Scenario(15, "base")) == "POV"
    with pytest.raises(InputError, match="lane of POV2 for 4: the scenario has SV, POV; name one of them"):
        scenario_parts.lane_owner(with_text("lane of POV2 for 4"), Scenario(4, "base"))
    with pytest.raises(TextError, match="lane of scenario '7' is given twice"):
        with_text("lane of SV for 7, 8\nlane of POV for 6..7")


def test_applications_are_what_a_reader_would_write() -> None:
    ext = Scenario(2, "ext")
    written = {
        "scenario_2@ext(SV, POV1, POV2, L)": scenarios.apply_scenario(BASE, ext),
        "scenario_4(POV2, SV, L2)": scenarios.apply_scenario(BASE, Scenario(4, "base"), ("POV2", "SV"), "L2"),
        "initSafe(SV, POV) and F danger(SV, POV)": scenario_parts.danger_comes(BASE, "SV", "POV"),
        "roadSector_9(SV, POV1, POV2)": scenario_parts.sector(BASE, 9, ("SV", "POV1", "POV2")),
        "disturb_4(SV, POV, L)": scenario_parts.disturbance(BASE, 4, ("SV", "POV")),
        "inMergeZone(SV)": scenario_parts.in_zone(BASE, "SV", "merge"),
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
    assert not scenario_parts.follows_template(mine, 30)
    assert scenario_parts.follows_template(mine, 24)


def test_components_come_from_the_template() -> None:
    pair = [q.text for q in scenario_parts.components(BASE, 4, ("SV", "POV"))]
    assert pair == [
        "behaviourSV_4(SV, POV, L)",
        "behaviourPOV_4(POV, SV, L)",
        "initialCondition_4(SV, POV, L)",
    ]
    assert len(scenario_parts.components(BASE, 2, ("SV", "POV1", "POV2"))) == 3
    assert scenario_parts.components(BASE, 2, ("SV", "POV1")) == []


def test_a_moment_of_danger_may_be_any_fraction() -> None:
    found = scenario_parts.danger_at(BASE, "SV", "POV", Fraction(27, 5))
    assert found.formula == read_claim(BASE, "F[5.4 s, 5.4 s] danger(SV, POV)").formula
    alone = scenario_parts.alone_in_lane(BASE, "POV")
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
    with pytest.raises(InputError, match="no scenario 99"):
        references.read_query(BASE, "99")


def test_a_scenario_that_is_applied_is_read_from_a_tree() -> None:
    def read(text: str) -> references.ScenarioApplication | None:
        return references.application_in(BASE, parse_claim(text).body)

    assert read("scenario_4(SV, POV, L)") == references.ScenarioApplication(
        Scenario(4, "base"), ("SV", "POV", "L")
    )
    assert read("scenario_12@ext( A,B , M )") == references.ScenarioApplication(
        Scenario(12, "ext"), ("A", "B", "M")
    )
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
    for name in scenario_parts.COMPARISON:
        assert signature(BASE, name) == (*scenarios.PAIR, scenarios.LANE)
    assert scenario_parts.beside_lane(BASE, "POV", "L1").text == "some M in adjacentLanes(L1): atLane(POV, M)"


def test_a_name_in_the_words_of_iso_34502_stands_for_scenarios() -> None:
    assert references.read_numbers(BASE, "cut-in") == (1, 5, 9, 13, 17, 21)
    assert references.read_numbers(BASE, "Cut-In, lane change, merge zone") == (13,)
    assert references.read_numbers(BASE, "cut-out, lane change (SV leaves its lane), main road") == (6,)
    assert references.read_numbers(BASE, "cut-in,7") == (1, 5, 7, 9, 13, 17, 21)
    assert references.read_query(BASE, "cut-in, lane keep, main road")[0] == 1
    assert claimed_definition(BASE, "deceleration ahead, lane keep, main road", "here") == "scenario_4"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("cut-in, merge", "'merge' is no part of a name; did you mean 'merge zone'?"),
        ("Cut-in, 3", "'3' is no part of a name"),
        ("cut-in, cut-out", "no scenario has all these parts"),
    ],
)
def test_half_a_name_is_refused_with_the_parts_of_names(text: str, reason: str) -> None:
    with pytest.raises(UsageError) as error:
        references.read_query(BASE, text)
    told = f"'{text}' names no scenario: {reason}\nparts of names: cut-in, lane keep, main road, cut-out, "
    assert str(error.value).startswith(told)


def test_every_scenario_is_found_by_its_own_name() -> None:
    for number, words in words_by_number(BASE).items():
        assert references.read_numbers(BASE, words.name) == (number,)


def test_a_name_that_several_scenarios_have_is_refused_with_the_choices() -> None:
    with pytest.raises(UsageError, match="names 6 scenarios") as refused:
        references.read_query(BASE, "cut-in")
    assert "\n  13: cut-in, lane change (SV leaves its lane), merge zone" in str(refused.value)
    with pytest.raises(InputError, match="names 6 scenarios"):
        claimed_definition(BASE, "cut-in", "here")


@pytest.mark.parametrize("text", ["cut", "cutIn", "danger", "cut-in, moon", "", ",", "main"])
def test_what_names_no_scenario_is_left_to_formulas(text: str) -> None:
    assert references.numbers_by_name(BASE, text) == ()


# --- Names of the library's definitions stand in two files and nowhere else in Python
# A string that has such a name followed by ``(``, is one, or has the part of one before its number
# (``scenario_``), is read, matched or put together somewhere; so is one that is the name of a role. Words
# for people are left out: docstrings, ``EXAMPLES`` and the ``help`` of options.

SOURCE = Path(__file__).parents[2] / "src" / "roadproof"
HOMES = ("library/scenarios.py", "extensions/traffic/scenario_parts.py")
ROLES = {*PAIR, *TRIPLE}
WORDS = {
    "core_record.py",
    "library/scenario_names.py",
    "extensions/traffic/evaluating.py",
}  # what is exported from Python is named; so are columns of frames
WRITER = "extensions/drivers/restriction_file.py"
"""It writes a specification, whose text calls definitions of manoeuvres."""
ROWS = 8
"""How many rows the table of formulas has, which other scenarios repeat."""


def said_to_people(tree: ast.Module) -> set[int]:
    """The nodes of strings that are docstrings, examples or help, by identity."""
    found: list[ast.AST] = []
    for node in ast.walk(tree):
        match node:
            case ast.Expr(ast.Constant(str()) as text):
                found.append(text)
            case ast.Assign([ast.Name("EXAMPLES")], value):
                found.append(value)
            case ast.keyword("help", value):
                found.append(value)
            case _:
                pass
    return {id(inner) for node in found for inner in ast.walk(node)}


def is_name(text: str) -> bool:
    return text in ROLES or bool(NAME.search(text)) or text in bundled_library().definitions


def _pattern() -> re.Pattern[str]:
    names = set(bundled_library().definitions)
    stems = {found[1] for name in names if (found := re.fullmatch(r"(.*_)\d+", name))}
    calls = "|".join(sorted(map(re.escape, names)))
    return re.compile(rf"\b(?:(?:{calls})\(|(?:{'|'.join(sorted(map(re.escape, stems)))}))")


NAME = _pattern()


def offences(text: str) -> Iterator[str]:
    """Lines of a module that name a definition, or count rows of the table of formulas."""
    tree = ast.parse(text)
    people = said_to_people(tree)
    for node in ast.walk(tree):
        match node:
            case ast.Constant(str() as value) if id(node) not in people and is_name(value):
                yield f"{node.lineno}: {value[:60]!r}"
            case ast.BinOp(_, ast.Mod(), ast.Constant(value)) if value == ROWS:
                yield f"{node.lineno}: % {ROWS}"
            case _:
                pass


@pytest.mark.parametrize(
    "line",
    read_table(__file__, "names_and_rows_are_found"),
)
def test_names_and_rows_are_found(line: str) -> None:
    assert list(offences(line))


@pytest.mark.parametrize(
    "line",
    read_table(__file__, "words_for_people_are_not"),
)
def test_words_for_people_are_not(line: str) -> None:
    assert not list(offences(line))


def test_words_are_only_roles() -> None:
    for name in WORDS:
        found = [line.partition(": ")[2] for line in offences((SOURCE / name).read_text())]
        assert found
        assert {*found} <= {repr(role) for role in ROLES}, name


def test_no_other_file_knows_a_definition_by_name() -> None:
    found: dict[str, list[str]] = {}
    for path in sorted(SOURCE.rglob("*.py")):
        name = path.relative_to(SOURCE).as_posix()
        if name not in (*HOMES, WRITER, *WORDS):
            found[name] = list(offences(path.read_text()))
    assert {name: lines for name, lines in found.items() if lines} == {}
    assert all(list(offences((SOURCE / x).read_text())) for x in HOMES)


# --- The detectors of earlier works, on drives whose answer follows from what their definitions say in words

LIBRARY = bundled_library()
ROAD = load_road("main-2")
RIGHT, LEFT = F(53, 20), F(123, 20)  # the left side of a car in the middle of a lane


@dataclass(frozen=True)
class Car:
    """``across``: (seconds, lateral speed), one after the other; then straight on. ``brakes`` for so long."""

    s: F | int | str = 0
    d: F = RIGHT
    v: F | int | str = 20
    a: F | int | str = 0
    across: tuple[tuple[str, str], ...] = ()
    brakes: F | None = None

    @property
    def motion(self) -> Motion:
        """Lateral speeds are reached within a hundredth of a second."""
        flick = F(1, 100)
        speeds = [F(v) for _, v in self.across]
        pieces = []
        for (seconds, _), (now, after) in zip(self.across, pairwise([*speeds, F(0)]), strict=True):
            pieces += [Piece(F(seconds), F(self.a), F(0)), Piece(flick, F(self.a), (after - now) / flick)]
        if self.brakes is not None:
            pieces.append(Piece(self.brakes, F(self.a), F(0)))
        end = F(0) if pieces else F(self.a)
        pieces.append(Piece(None, end, F(0)))
        numbers = (F(9, 2), F(9, 5), F(self.s), self.d, F(self.v), speeds[0] if speeds else F(0))
        return Motion(*numbers, tuple(pieces))


def holds(text: str, sv: Car, pov: Car) -> bool:
    drive = Drive({"SV": sv.motion, "POV": pov.motion})
    formula = read_claim(LIBRARY.select(), text).formula
    return judge(bind(formula, ROAD, {"L": "main-1"}, default_values(LIBRARY)), drive).holds


def ahead(gap: str, **more: object) -> Car:
    """A car whose rear is ``gap`` ahead of a front at 0."""
    return Car(s=F(gap) + F(9, 2), **more)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "gap", "expected"),
    [
        *(("nearByTTC", gap, truth) for gap, truth in (("0", 1), ("39.9", 1), ("40", 0), ("-0.1", 0))),
        *(("nearByTHW", gap, truth) for gap, truth in (("0", 1), ("59.9", 1), ("60", 0), ("-0.1", 0))),
        *(("nearByDistance", gap, truth) for gap, truth in (("0", 1), ("100", 1), ("100.1", 0), ("-0.1", 0))),
    ],
)
def test_what_is_near(name: str, gap: str, expected: int) -> None:
    """SV comes closer by 10 m/s; 4 s to a collision, 2 s of headway at 30 m/s, 100 m."""
    assert holds(f"{name}(SV, POV)", Car(v=30), ahead(gap)) == bool(expected)
    assert not holds(f"{name}(POV, SV)", Car(v=30), ahead(gap))


def test_a_slower_vehicle_reaches_nobody() -> None:
    assert not holds("nearByTTC(SV, POV)", Car(v=20), ahead("1"))
    assert not holds("nearByTTC(SV, POV)", Car(v=15), ahead("1"))


@pytest.mark.parametrize(
    ("sv", "pov", "expected"), [(0, 1, True), (1, 0, False), (0, 0, False), (1, 1, False)]
)
def test_outside_the_lane(sv: int, pov: int, expected: bool) -> None:
    cars = (Car(d=(RIGHT, LEFT)[sv]), ahead("30", d=(RIGHT, LEFT)[pov]))
    assert holds("outsideLane(POV, SV, L)", *cars) == expected


@pytest.mark.parametrize(
    ("across", "expected"),
    read_table(__file__, "drifting"),
)
def test_drifting(across: tuple[tuple[str, str], ...], expected: bool) -> None:
    """To one side faster than 0.1 m/s for a second."""
    assert holds("drifts(POV)", Car(), ahead("30", across=across)) == expected


@pytest.mark.parametrize(
    ("sv", "pov", "expected"),
    [
        (Car(v=30), ahead("30", a=-1), True),
        (Car(v=30, a=-1), ahead("30", a=-1), True),
        (Car(v=30, a=1), ahead("30", a=-1), False),
        (Car(v=30), ahead("30"), False),
        (Car(v=20), ahead("30", a=-1), False),
    ],
)
def test_braking_alone(sv: Car, pov: Car, expected: bool) -> None:
    assert holds("brakesAlone(POV, SV)", sv, pov) == expected


CHANGE = (("3.4", "-1"),)
STAYS = (("0.5", "-1"),)
ONCE_NEAR = {"ttc": "40", "thw": "60", "free": "100"}


@pytest.mark.parametrize("kind", ["ttc", "thw", "free"])
def test_a_cut_in_ends_near_within_a_second(kind: str) -> None:
    """POV is in L after 0.85 s, and the gap shrinks by 10 m each second for good."""

    def cut_in(gap: float, across: tuple[tuple[str, str], ...] = CHANGE, **sv: object) -> bool:
        pov = ahead(str(gap), d=LEFT, across=across)
        return holds(f"cutIn_{kind}(SV, POV, L)", Car(v=30, **sv), pov)  # type: ignore[arg-type]

    near = float(ONCE_NEAR[kind])
    assert cut_in(near / 2)
    assert cut_in(near + 15)  # near less than a second after it is still outside
    assert not cut_in(near + 25)  # near only later
    assert not cut_in(near / 2, across=STAYS)
    assert not cut_in(-30)
    assert not cut_in(near / 2, d=LEFT)  # SV is not in L
    leaves = holds(f"cutIn_{kind}(POV, SV, L)", Car(s=40, d=LEFT, v=20, across=CHANGE), Car(v=30))
    assert leaves  # the same with names exchanged


@pytest.mark.parametrize("kind", ["ttc", "thw", "free"])
def test_a_cut_in_may_be_near_at_once_and_for_a_moment_only(kind: str) -> None:
    """POV is in L after 0.2 s, 3 m ahead, and is passed at 0.5 s."""
    pov = ahead("5", d=F(11, 2), across=(("1.5", "-1"),))
    assert holds(f"cutIn_{kind}(SV, POV, L)", Car(v=30), pov)


def test_who_does_not_drift_does_not_cut_in_freely() -> None:
    """Half a second at 1.8 m/s ends in L as well."""
    quick = (("0.6", "-1.8"),)
    assert holds("cutIn_ttc(SV, POV, L)", Car(v=30), ahead("30", d=LEFT, across=quick))
    assert not holds("cutIn_free(SV, POV, L)", Car(v=30), ahead("30", d=LEFT, across=quick))


@pytest.mark.parametrize(("kind", "near"), [("ttc", "30"), ("thw", "50")])
def test_hard_braking_near(kind: str, near: str) -> None:
    def brakes(gap: str, a: str = "-3", d: F = RIGHT) -> bool:
        pov = ahead(gap, a=a, d=d, brakes=F(1, 10))
        return holds(f"decel_{kind}(SV, POV, L)", Car(v=30), pov)

    assert brakes(near)
    assert not brakes(near, a="-2.9")
    assert not brakes(near, d=LEFT)
    assert not brakes("99")


def test_braking_ahead_for_a_second() -> None:
    def brakes(gap: str, seconds: str, d: F = RIGHT, v: int = 30) -> bool:
        pov = ahead(gap, a=-1, d=d, brakes=F(seconds))
        return holds("decel_free(SV, POV, L)", Car(v=v), pov)

    assert brakes("60", "1.1")
    assert not brakes("60", "0.9")
    assert not brakes("120", "1.1")
    assert not brakes("60", "1.1", d=LEFT)
    assert not brakes("60", "1.1", v=15)


def test_parameters_have_their_bounds() -> None:
    bounds = {name: LIBRARY.bounds[name] for name in ("ttcLimit", "thwLimit", "farthest", "hardBraking")}
    assert set(bounds.values()) == {">"}
    assert {LIBRARY.bounds[name] for name in ("leastDrift", "cutInTime", "brakeTime")} == {">="}


# --- The set without gaps: each of its definitions said again in other words ------------------------

SAID = {
    "cutIn(POV, SV, L)": "not (atLane(POV,L) and atLane(SV,L)) and F danger(SV,POV)",
    "cutOut(POV, SV, L)": "(atLane(POV,L) and atLane(SV,L)) and F danger(POV,SV) and F not atLane(POV,L)",
    "decel(POV, SV, L)": "laneKeep(POV,L)",
    "aheadOf(POV, SV)": "s(POV) <= s(SV)",
    "initialCondition_8(SV, POV, L)": "atLane(SV,L) and atLane(POV,L)",
}


@pytest.mark.parametrize("name", SAID)
def test_a_definition_is_what_is_said(name: str) -> None:
    complete, ext = LIBRARY.select("complete"), LIBRARY.select("ext")
    found = without_names(read_claim(complete, name).formula)
    assert found == without_names(read_claim(ext, SAID[name]).formula)
    assert found != without_names(read_claim(ext, name).formula)


def test_nothing_else_differs() -> None:
    complete, ext = (LIBRARY.select(x).definitions for x in ("complete", "ext"))
    assert {f"{n}(" for n in complete if complete[n] is not ext[n]} == {x[: x.index("(") + 1] for x in SAID}
