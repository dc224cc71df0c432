"""What begins with a manoeuvre that a driver prevents, or cannot: definitions, refusals, evidence."""

import json
from functools import cache
from pathlib import Path
from typing import Literal, TypeAlias, get_args

import pytest

import roadproof as rp
from roadproof.engines.prove.induction import prove_via_opaque_driver
from roadproof.engines.search.impossible import show_impossible
from roadproof.errors import InputError, UsageError
from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.catalogue.entries import AbstractTest
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES, Plane, line
from roadproof.extensions.drivers.models import MODELS, SCENARIOS, foreseen, unpreventable
from roadproof.extensions.drivers.options import Prevention
from roadproof.extensions.drivers.restricting import restricted
from roadproof.extensions.drivers.restriction import Restriction, Side, restriction_of
from roadproof.extensions.traffic.scenario_parts import initial_condition
from roadproof.frontends.cli.main import main
from roadproof.library.bind import bind
from roadproof.library.compose import both, negation
from roadproof.library.elaborate import read_claim
from roadproof.library.scenarios import Scenario, vehicles_of
from roadproof.library.specification import Specification
from roadproof.logic.formula import TRUE, Formula
from roadproof.logic.initial_conditions import top_level_conjuncts
from roadproof.logic.rewrite import without_names
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.truth import complement, intersection
from roadproof.verdict import Verdict
from roadproof.world.road import Road

pytestmark = pytest.mark.usefixtures("searched_once")

TESTS = str(Path(__file__).parents[3] / "examples/catalogue/tests")
EXAMPLE = Path(__file__).parents[3] / "examples" / "catalogue" / "tests"
Heard: TypeAlias = pytest.CaptureFixture[str]
WITH_FORMULA = [x.name for x in MODELS.values() if not x.is_stepped]


@cache
def restricted_to(side: Side, model: str, about: str = "scenarios") -> Specification:
    sides = (model, None) if side == "preventable" else (None, model)
    home = restricted(rp.load(), Prevention(preventable=sides[0], unpreventable=sides[1]))
    found = Restriction(side, model, "drives" if about == "drives" else "scenarios")
    return home.library.select("base", {**home.specification.options, **found.options})


def said(formula: Formula) -> set[Formula]:
    return {without_names(x) for x in top_level_conjuncts(formula)} - {TRUE}


def start_of(specification: Specification, number: int) -> set[Formula]:
    vehicles = vehicles_of(specification, Scenario(number, "base"))
    return said(initial_condition(specification, number, vehicles).formula)


def bound(specification: Specification, text: str) -> Formula:
    values = rp.load(specs=["driver"]).all_values()
    return bind(read_claim(specification, text).formula, Road("none", (), frozenset()), {}, values)


@pytest.mark.parametrize("model", WITH_FORMULA)
@pytest.mark.parametrize("side", get_args(Side))
def test_scenarios_begin_as_before_and_in_a_state_of_that_side(side: Side, model: str) -> None:
    here, plain = restricted_to(side, model), rp.load().specification
    for manoeuvre, number in SCENARIOS.items():
        vehicles = vehicles_of(here, Scenario(number, "base"))
        before = initial_condition(plain, number, vehicles)
        state = read_claim(here, foreseen(manoeuvre, vehicles))
        if manoeuvre in MODELS[model].manoeuvres:
            collides = read_claim(here, unpreventable(manoeuvre, model, vehicles))
            state = collides if side == "unpreventable" else both(state, negation(collides))
            before = state if number == 1 else both(before, state)
        assert start_of(here, number) == said(before.formula), (manoeuvre, number)
        assert start_of(here, number + 8) == start_of(here, number) == start_of(here, number + 16)
    for number in (3, 5, 6, 7, 8):
        assert start_of(here, number) == start_of(plain, number)


@pytest.mark.parametrize("side", get_args(Side))
def test_where_drives_begin_so_scenarios_are_as_they_were(side: Side) -> None:
    here, plain = restricted_to(side, "careful", "drives"), rp.load().specification
    assert all(start_of(here, n) == start_of(plain, n) for n in range(1, 25))
    asked = read_claim(here, "asked_between(SV, POV)")
    assert without_names(asked.formula) == without_names(read_claim(here, "begins_between(SV, POV)").formula)


@pytest.mark.parametrize("manoeuvre", MANOEUVRES)
def test_each_state_of_a_manoeuvre_is_on_one_side(manoeuvre: str) -> None:
    """Along a line of initial values the two sides meet in points and leave nothing between them."""
    course = MANOEUVRES[manoeuvre]
    plane = Plane(course, {}, course.along, course.range)
    word = {"cut-in": "begins_cutIn", "cut-out": "begins_cutOut", "deceleration": "begins_deceleration"}
    text = f"{word[manoeuvre]}({', '.join(course.vehicles)})"
    row = plane.rows[40]
    sides = [line(plane, bound(restricted_to(x, "careful"), text), row) for x in get_args(Side)]
    begins = foreseen(manoeuvre, course.vehicles)
    whole = line(plane, bound(restricted_to("preventable", "careful"), begins), row)
    assert all(x.cuts for x in sides)
    assert not intersection(sides).cuts
    assert not intersection([whole, *map(complement, sides)]).cuts


def test_an_unpreventable_collision_begins_with_its_manoeuvre() -> None:
    for manoeuvre, course in MANOEUVRES.items():
        collides = unpreventable(manoeuvre, "careful", course.vehicles)
        claim = f"{collides} -> {foreseen(manoeuvre, course.vehicles)}"
        assert rp.prove(claim, using=rp.load(specs=["driver"])).verdict is Verdict.PROVED


def test_options_tell_the_restriction() -> None:
    for side in get_args(Side):
        for model in WITH_FORMULA:
            wanted = Restriction(side, model)
            assert restriction_of({"speed": "total", **wanted.options}) == wanted
            courses = [SCENARIOS[x] for x in MODELS[model].manoeuvres]
            assert set(wanted.scenarios) == {x + later for x in courses for later in (0, 8, 16)}
    assert restriction_of({"speed": "total"}) is None


def test_what_is_proved_of_scenarios_stays_proved_and_no_more() -> None:
    here = restricted_to("unpreventable", "careful")
    apart = read_claim(here, "not (scenario_1(SV,POV,L) and scenario_4(SV,POV,L))")
    assert prove_via_opaque_driver(here, apart, Effort(3)).certificate is not None
    together = read_claim(here, "not (scenario_1(SV,POV,L) and scenario_5(SV,POV,L))")
    assert prove_via_opaque_driver(here, together, Effort(3)).verdict is Verdict.UNKNOWN
    never = read_claim(here, "scenario_4(SV,POV,L) and scenario_5(SV,POV,L)")
    shown = show_impossible(here, never, Effort(3))
    assert shown is not None
    assert shown.core
    assert "begins" not in " ".join(shown.core_texts)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        (["witness", "3", "--unpreventable", "careful"], "applies to 1, 2, 4, 9, 10, 12, 17, 18, 20"),
        (
            ["witness", "4", "--unpreventable", "r157"],
            "does not apply to the selected scenarios (4)",
        ),
        (["overlap", "--among", "3,5", "--preventable", "rss"], "select one of these"),
        (["witness", "1", "--preventable", "fsm"], "fsm is a controller and has no formula"),
        (["coverage", "--preventable", "fsm"], "fsm is a controller and has no formula"),
        (["classify", "--unpreventable", "carefull"], "did you mean 'careful'"),
        (["witness", "1", "--preventable", "rss", "--unpreventable", "rss"], "no drive satisfies both"),
        (["witness", "G v_lon(SV) > 0 m/s", "--preventable", "rss"], "the selected scenarios (none)"),
        (["coverage", "--spec", "driver", "--spec", "prevention"], "prevention_of=drives"),
        (
            ["catalogue", TESTS, "--gaps", "--preventable", "rss"],
            "coverage asks",
        ),
    ],
)
def test_what_means_nothing_is_refused(given: list[str], told: str, capsys: Heard) -> None:
    assert main(given) == 2
    assert told in capsys.readouterr().err


def test_a_formula_that_was_read_without_a_driver_is_refused() -> None:
    with pytest.raises(UsageError, match="read without a driver model"):
        rp.witness(rp.load().read(1), unpreventable="careful")


def test_an_own_beginning_of_a_scenario_is_not_lost_in_silence() -> None:
    own = 'def initialCondition_1(SV, POV: vehicle, L: lane) "mine" := aheadOf(SV, POV)\n'
    with pytest.raises(InputError, match="initialCondition_1"):
        restricted(rp.load(specs=[own]), Prevention(unpreventable="careful"))
    in_a_set = "set mine extends base {\n" + own + "}\n"
    with pytest.raises(InputError, match="initialCondition_1"):
        restricted(rp.load("mine", specs=[in_a_set]), Prevention(unpreventable="careful"))
    other = 'def mine(a: vehicle) "mine" := v_lon(a) > 0 m/s\n'
    assert (
        "mine"
        in restricted(rp.load(specs=[other]), Prevention(unpreventable="careful")).specification.definitions
    )


def test_evidence_is_about_the_side_that_was_asked(tmp_path: Path, capsys: Heard) -> None:
    found = rp.witness(1, unpreventable="careful", out=tmp_path, pictures=False, jobs=1)
    assert found.verdict is Verdict.WITNESSED
    assert found.as_data()["prevention"]["scenarios"] == [1, 2, 4, 9, 10, 12, 17, 18, 20]
    assert "unpreventable (competent and careful driver): scenarios 1" in found.supposed[0]
    assert main(["check", str(tmp_path)]) == 0
    [drive] = found.drives
    for side, holds in (("preventable", False), ("unpreventable", True)):
        here = restricted_to(side, "careful")
        values = {**rp.load(specs=["driver"]).all_values(), **drive.file.values}
        query = read_claim(here, drive.file.formula)
        assert (
            judge(bind(query.formula, drive.file.road, drive.file.lanes, values), drive.file.drive).holds
            is holds
        )
    file = tmp_path / "scenario-01-base.json"
    file.write_text(file.read_text().replace('"prevention": "unpreventable"', '"prevention": "preventable"'))
    assert main(["check", str(file), "--spec", "driver", "--spec", "prevention"]) == 10
    assert "the formula does not hold on the drive" in capsys.readouterr().out


def test_answers_for_one_side_are_none_for_the_other(tmp_path: Path, capsys: Heard) -> None:
    given = [
        "overlap",
        "--among",
        "1,4",
        "--unpreventable",
        "careful",
        "--out",
        str(tmp_path),
        "--no-pictures",
    ]
    assert main([*given, "--no-pictures", "--jobs", "1"]) == 0
    assert main(["check", str(tmp_path)]) == 0
    path = tmp_path / "question.json"
    data = json.loads(path.read_text())
    assert data["basis"]["options"]["prevention"] == "unpreventable"
    data["basis"]["options"]["prevention"] = "preventable"
    path.write_text(json.dumps(data))
    capsys.readouterr()
    assert main(["check", str(tmp_path)]) == 10
    assert "it was read with other options" in capsys.readouterr().out


def test_without_a_driver_nothing_is_said() -> None:
    found = rp.overlap("1,4", jobs=1)
    assert "prevention" not in found.as_data()
    assert found.supposed == ()
    assert "prevention" not in found.as_data()["options"]


def test_what_tests_claim_is_of_scenarios_as_they_are() -> None:
    """At time 0 nobody comes in yet; the moment at which POV does is one of ``start="any"``."""
    drive = Path(__file__).parents[3] / "examples" / "catalogue" / "tests" / "drives" / "cut-in.json"
    looked: dict[Literal["fixed", "any"], tuple[str, ...]] = {"fixed": (), "any": ("cut-in",)}
    for start, tests in looked.items():
        found = rp.catalogue(drive, among="1", classes=False, start=start, preventable="careful", jobs=1)
        assert [x.tested for x in found.tested.targets] == [tests]
        assert not found.tested.faults
    plain = rp.catalogue(drive, among="1", classes=False, jobs=1)
    assert [x.tested for x in plain.tested.targets] == [("cut-in",)]


@pytest.mark.parametrize("side", ["preventable", "unpreventable"])
def test_a_driver_model_does_not_change_what_a_formula_test_means(side: str, tmp_path: Path) -> None:
    """Under either side the test shows the scenario by some of its drives at most, and by no proof."""
    tests = tmp_path / "catalogue.toml"
    tests.write_text(
        '[[test]]\nid = "range"\nformula = "scenario_1(SV,POV,L)"\nclaims = [1]\n'
        'at_start = { "v_lon(SV)" = "20 m/s .. 30 m/s" }\n'
    )
    found = rp.catalogue(tests, among="1", classes=False, jobs=1, **{side: "careful"})  # type: ignore[arg-type]
    [target] = found.tested.targets
    assert (target.tested, target.possible) == ((), ("range",))
    assert found.exit_code == 10
    [entry] = found.question.abstract
    assert isinstance(entry, AbstractTest)
    file = load_drive(EXAMPLE / "drives" / "cut-in.json")
    claims = {
        "as it is": (rp.load().specification, "scenario_1(SV,POV,L)"),
        "of the test": (found.question.basis.specification, entry.query.text.partition(" and (20 m/s")[0]),
    }
    holds = {
        name: judge(
            bind(read_claim(home, text).formula, file.road, file.lanes, rp.load().all_values()), file.drive
        ).holds
        for name, (home, text) in claims.items()
    }
    assert holds == {"as it is": True, "of the test": True}
    assert "scenario_1" not in entry.query.text
    [in_force] = found.in_force
    assert in_force.startswith(side)
    assert in_force in found.to_csv().splitlines()[0]
    assert found.to_junit().count(f'value="{in_force}"') == 2
    assert not rp.catalogue(tests, among="1", classes=False, jobs=1).in_force
