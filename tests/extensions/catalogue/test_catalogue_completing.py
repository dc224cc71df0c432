"""Catalogues made complete: gaps by class, drives far apart, copies for other tools; ranges nobody tests."""

import random
import tomllib
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import islice
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from cli.test_schemas import validator
from roadproof.errors import UsageError
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.catalogue import abstract_claims, gaps, initial_values, ranges
from roadproof.extensions.catalogue import report_drives as catalogue_drives
from roadproof.extensions.catalogue.catalogue_data import NearestScenario
from roadproof.extensions.catalogue.cataloguing import CatalogueAnswer, catalogue
from roadproof.extensions.catalogue.completing import complete
from roadproof.extensions.catalogue.curves import curves_of
from roadproof.extensions.catalogue.entries import AbstractTest, ConcreteTest, Freedom
from roadproof.extensions.catalogue.fact import CatalogueFact
from roadproof.extensions.catalogue.false_parts import first_false_part
from roadproof.extensions.catalogue.gaps import NO_SINGLE
from roadproof.extensions.catalogue.judge_test import judge_test
from roadproof.extensions.catalogue.nearest_scenario import VehicleMotions, nearest_scenario
from roadproof.extensions.catalogue.ranges import Reach
from roadproof.extensions.catalogue.report_drives import DrivePicture, draw_tests, shorten
from roadproof.extensions.catalogue.target_formulas import ENDANGERED, GAP, ScenarioKey, TargetFormulas
from roadproof.extensions.catalogue.targets import find_targets, target_titles
from roadproof.extensions.surveys.coverage import gap_drives, gap_search
from roadproof.extensions.surveys.coverage import question as coverage_question
from roadproof.extensions.surveys.coverage.answers import ClassAnswer
from roadproof.extensions.surveys.coverage.classes import near_miss
from roadproof.frontends.cli.main import main
from roadproof.frontends.report.figures import as_bytes, make_page
from roadproof.library.bind import bind, values_with
from roadproof.library.scenarios import Scenario, apply_scenario, name_of, vehicles_of
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.questions.basis import Basis
from roadproof.reasons import ReasonKind
from roadproof.semantics.exact.judging import DriveJudge, judge
from roadproof.semantics.exact.signals import DriveSignals
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive, Piece

pytestmark = pytest.mark.usefixtures("searched_once")

HOME = rp.load()
DRIVES = Path(__file__).parents[3] / "examples" / "catalogue" / "tests" / "drives"
CUT_IN, BRAKING, SEVEN = (DRIVES / f"{name}.json" for name in ("cut-in", "braking", "seven"))


NEVER = """
def behaviourPOV_4(POV, SV: vehicle, L: lane) "POV drives away, and stands"
  := v_lon(POV) > v_lon(SV) and v_lon(POV) < v_lon(SV)
"""


def asked_about(*numbers: int) -> TargetFormulas:
    return TargetFormulas(HOME.specification, numbers, None, HOME.all_values())


# --- gaps ---------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def asked() -> TargetFormulas:
    return asked_about(1)


@pytest.mark.parametrize("path", [BRAKING, SEVEN, CUT_IN], ids=lambda path: path.stem)
def test_classes_of_a_gap_are_those_of_the_judge_one_by_one(path: Path, asked: TargetFormulas) -> None:
    """Each part that can be left out so that its scenario holds, asked by itself."""
    assert asked.gaps is not None
    file, expected = load_drive(path), set()
    for name, part in asked.gaps.parts.items():
        if (
            part is not None
            and judge(bind(near_miss(part).formula, file.road, {}, asked.values), file.drive).holds
        ):
            expected.add(name)
    names = judge_test(ConcreteTest("x", str(path)), asked, Freedom()).names
    alone = {NO_SINGLE} if not expected else set()
    shown = {name for name in names if name.startswith(gaps.PREFIX)}
    assert shown == (expected | alone if GAP in names else set())
    missed = bind(asked.gaps.classes.gap_formula((1,)).formula, file.road, {}, asked.values)
    assert (GAP in names) == judge(missed, file.drive).holds


def test_scenarios_that_are_no_rows_have_no_classes_of_gaps() -> None:
    assert asked_about(1, 4, 12).gaps is None
    with pytest.raises(UsageError, match="name whole rows"):
        catalogue(BRAKING, among="1,4,12", classes=False, gaps=True)
    with pytest.raises(UsageError, match="--no-classes"):
        catalogue(BRAKING, among="1,4,12")


@pytest.fixture(scope="module")
def surveyed(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[CatalogueAnswer, Path]]:
    """A cut-in, asked about scenario 4 and its gaps, with few drives to look through and little work."""
    simple, folder = gap_drives.simple_drives, tmp_path_factory.mktemp("gaps")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gap_drives, "simple_drives", lambda road, car: islice(simple(road, car), 0, None, 60))
        patch.setattr(gaps, "ROADS", ("main-2",))
        patch.setattr(coverage_question, "CHUNKS", 1)
        patch.setattr(gap_search, "PROOF", 1.0)
        patch.setattr(gap_search, "LONG_PROOF", 2.0)
        report = folder / "report"
        made = catalogue(CUT_IN, among="4", classes=False, gaps=True, effort=3, jobs=1, out=report)
        made.add_files(False)
        yield made, folder


def test_each_class_of_gaps_is_tested_missing_empty_or_in_doubt(
    surveyed: tuple[CatalogueAnswer, Path],
) -> None:
    made, folder = surveyed
    told = made.tested.gaps
    assert [x.name for x in told.targets if x.tested] == ["gap_behaviourPOV_4", NO_SINGLE]
    assert [x.name for x in told.empty] == ["gap_initialCondition_4_2"]
    assert [*told.open] == ["gap_behaviourSV_4"]
    missing = ("initialCondition_4", "initialCondition_4_1", "behaviourPOV_4_1", "behaviourPOV_4_2")
    assert made.missing == ("scenario_4", *(f"{gaps.PREFIX}{name}" for name in missing))
    assert made.verdicts["gap_initialCondition_4_2"] is Verdict.IMPOSSIBLE
    assert made.verdicts["gap_behaviourSV_4"] is Verdict.UNKNOWN
    assert made.exit_code == 20
    assert "classes of gaps: 2 of 7 are tested\nclasses of gaps that are proved empty: 1" in str(made)
    assert "base,classes of gaps,,2,7" in (folder / "report" / "figures.csv").read_text("utf-8")
    assert main(["check", str(folder / "report"), "--jobs", "1"]) == 0
    data = made.as_data()
    validator("catalogue.json").validate(data)
    shown = {x["component"]: x for x in data["gaps"]["classes"] if not x["condition"] and x["gaps"]}
    assert Path(shown["initialCondition_4"]["gaps"][0]["drive"]).is_file()
    assert made.plot().png.startswith(b"\x89PNG")


def test_gaps_that_nobody_tests_are_made_and_found_again(surveyed: tuple[CatalogueAnswer, Path]) -> None:
    made, folder = surveyed
    completed = made.complete(folder / "more", jobs=1)
    drives = {x.name for x in completed.completions if x.drive}
    assert drives <= {*made.missing}
    again = catalogue(CUT_IN, folder / "more", among="4", classes=False, jobs=1)
    assert again.missing == ()
    shown = {x.name for x in again.tested.gaps.targets if x.tested}
    assert shown >= {x for x in made.missing if x.startswith(gaps.PREFIX)}
    assert not [x for x in again.tested.faults if "cut-in" not in x.tests]
    assert main(["check", str(folder / "more"), "--jobs", "1"]) == 0


def test_a_gap_that_is_proved_empty_and_shown_is_a_contradiction(asked: TargetFormulas) -> None:
    answer = judge_test(ConcreteTest("x", str(BRAKING)), asked, Freedom())
    assert asked.gaps is not None
    name = next(x for x in sorted(answer.names) if x.startswith(gaps.PREFIX))
    empty = {name: ClassAnswer(asked.gaps.parts[name], verdict=Verdict.IMPOSSIBLE)}
    made = find_targets(asked, [answer], [], [], target_titles(asked), 0.5, empty)
    assert [x.told for x in made.contradictions] == [f"shows {name}, though that is proved to be empty"]


# --- figures, drives far apart, copies -----------------------------------------------------------


def test_figures_by_spec_set() -> None:
    """A leader that slows down and is still faster is decelerating in ext only; each set has its own."""
    made = catalogue(BRAKING, among="1,4", using=rp.load("base", "ext"), classes=False, jobs=1)
    counted = {x.set_name: (x.kind, x.tested, x.total) for x in made.figures}
    assert counted == {"base": ("scenarios", 1, 2), "ext": ("scenarios", 1, 2)}
    assert "set ext, scenarios: 1 of 2 are tested" in str(made)
    for other, (answer,) in zip(made.view.formula_sets, made.view.shown, strict=True):
        assert answer.names == judge_test(ConcreteTest("braking", str(BRAKING)), other, Freedom()).names


def test_drives_far_apart_with_copies_for_other_tools(tmp_path: Path) -> None:
    more = tmp_path / "more"
    made = catalogue(BRAKING, among="4", classes=False, jobs=1)
    formats = ["csv,commonroad", "highd", "openscenario", "opendrive"]
    completed = made.complete(more, "mild", spread=2, formats=formats, jobs=1)
    (one,) = completed.completions
    assert (one.name, one.target) == ("scenario_4-2", "scenario_4")
    assert one.apart is not None
    assert one.apart >= float(initial_values.FACTORS[-1])
    entries = tomllib.loads((more / "catalogue.toml").read_text("utf-8"))["test"]
    copies = {"as commonroad", "as csv", "as highd", "as openscenario"}
    assert {x["id"].removeprefix("scenario_4-2").strip() for x in entries} == {"", *copies}
    assert all(x["title"].endswith("mild, far from the others") for x in entries)
    again = catalogue(BRAKING, more, among="4", classes=False, jobs=1)
    assert (again.missing, again.tested.faults, again.tested.alike, again.exit_code) == ((), (), (), 0)
    assert [x.tested for x in again.tested.targets] == [("braking", *(x["id"] for x in entries))]
    assert str(again.complete(more, spread=2, jobs=1)) == "nothing was missing"


def test_a_drive_for_a_class_lists_the_parameters_of_its_formula(tmp_path: Path) -> None:
    home = rp.load(specs=["driver"])
    catalogue(CUT_IN, using=home, among="8", drivers=(), jobs=1).complete(tmp_path / "more", jobs=1)
    [file] = (tmp_path / "more").glob("class_8*.json")
    values = load_drive(file).values
    assert {"rho", "minSafe"} <= {*values}
    assert "cc_delay" not in values


def test_what_is_written_before_is_kept(tmp_path: Path) -> None:
    made = catalogue(BRAKING, among="1,4", classes=False, jobs=1)
    made.complete(tmp_path, jobs=1)
    (tmp_path / "scenario_1.json").write_text("{}", "utf-8")
    made.complete(tmp_path, jobs=1)
    entries = tomllib.loads((tmp_path / "catalogue.toml").read_text("utf-8"))["test"]
    assert [x["id"] for x in entries] == ["scenario_1", "scenario_1-2"]
    assert (tmp_path / "scenario_1.json").read_text("utf-8") == "{}"


def test_distance_is_that_of_the_number_that_differs_most() -> None:
    one = {"v_lon(SV)": 20.0, "s(POV) - s(SV)": 30.0, "d(POV) - d(SV)": 0.0}
    assert initial_values.distance(one, one) == 0
    assert initial_values.distance(one, {**one, "v_lon(SV)": 28.0, "s(POV) - s(SV)": 45.0}) == 2
    query = initial_values.far_from([one], Fraction(2), HOME.specification)
    assert query is not None
    assert query.text.startswith("v_lon(SV) - 28*1 m/s >= 0 m/s or 12*1 m/s - v_lon(SV) >= 0 m/s or ")


# --- ranges ---------------------------------------------------------------------------------------


def test_the_part_of_a_range_that_nobody_tests(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ranges, "_PRECISION", {"s": Fraction(20)})
    reaches = ranges.reaches_of

    def along(*given: object) -> list[Reach]:
        return [x for x in reaches(*given) if x.term == "s(POV) - s(SV)"]  # type: ignore[arg-type]

    monkeypatch.setattr("roadproof.extensions.catalogue.question.reaches_of", along)
    report = tmp_path / "report"
    made = catalogue(BRAKING, among="4", classes=False, explore=True, jobs=1, out=report)
    (span,) = made.spans
    (low, high), (least, greatest) = span.tested, span.reached
    assert (low, high) == pytest.approx((62.18, 62.18), abs=0.1)
    assert least < low == high < greatest <= 80
    assert (span.untested, span.share) == (((least, low), (high, greatest)), pytest.approx(1))
    assert [(x.relation, x.sense) for x in made.view.facts] == [("reaches", "least"), ("reaches", "greatest")]
    assert "scenario_4\n    s(POV) - s(SV): " in str(made)
    assert main(["check", str(report), "--jobs", "1"]) == 0
    validator("catalogue.json").validate(made.as_data())


def test_a_range_that_is_not_known_is_a_doubt() -> None:
    asked = asked_about(4)
    still_open = CatalogueFact(
        "", "scenario_4", "open", asked.query_of("scenario_4"), reason="cut off", term="v_lon(SV)"
    )
    made = find_targets(asked, [], [], [still_open], target_titles(asked), 0.5, None)
    assert [(x.tests, x.told) for x in made.doubts] == [
        (("scenario_4",), "how far its drives go is in doubt: cut off")
    ]
    assert ranges.ranges_of(HOME.specification, {"scenario_4": {"v_lon(SV)": (1, 2)}}, [still_open]) == []


# --- pictures -------------------------------------------------------------------------------------


def test_all_tests_are_drawn_on_pages_and_titles_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(catalogue_drives, "MOST_ON_A_PAGE", 2)
    curves = curves_of(ConcreteTest("x", str(CUT_IN)))
    assert curves is not None
    assert curves_of(ConcreteTest("x", str(DRIVES / "torn.json"))) is None
    pages = list(draw_tests([DrivePicture("W" * 60, "1 cut-in", curves)] * 3))
    assert [as_bytes(page)["png"][:4] for page in pages] == [b"\x89PNG"] * 2
    text = make_page(4, 4).text(0, 0, "W" * 60, fontsize=6.5)
    shorten(text, 1.9)
    assert text.get_window_extent().width <= 1.9 * text.figure.dpi
    assert text.get_text().startswith("WWWWWWW")
    assert "…" in text.get_text()


# --- mistakes -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("test", "told"),
    [
        ("formula='assuming speed: true'", "test x, formula, line 1, column 10: 'speed' cannot be assumed"),
        ("formula='assuming motion, foo: true'", "column 18: 'foo' is no limit"),
        ("formula='assuming motion: true'", "leave 'assuming motion:' out"),
        ("formula='true'\ncopy_of='y'", "copy_of is for tests with a file"),
        ("file='a.json'\ncopy_of=3", "copy_of=3; write a text"),
    ],
)
def test_mistakes_in_entries(test: str, told: str, tmp_path: Path) -> None:
    (tmp_path / "catalogue.toml").write_text(f"[[test]]\nid='x'\n{test}\n", "utf-8")
    made = catalogue(tmp_path, among="1,4", classes=False, drivers=[], jobs=1)
    [fault] = made.tested.faults
    assert fault.tests == ("x",)
    assert told in fault.told


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--spread", "2"], "--spread requires --complete DIR"),
        (["--objective", "mild"], "--objective requires --complete DIR"),
        (["--complete", "more", "--format", "gpx"], "there is no format 'gpx'"),
        (["--complete", "more", "--spread", "0"], "--spread"),
    ],
)
def test_mistakes_in_options(options: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["catalogue", str(BRAKING), *options]) == 2
    assert told in capsys.readouterr().err


def test_a_motorcycle_is_one_for_commonroad(tmp_path: Path) -> None:
    drive = rp.witness(4, vehicles={"POV": "motorcycle"}, jobs=1).drives[0]
    (path,) = rp.export(drive, "commonroad", tmp_path).files
    assert path.read_text("utf-8").count("<type>motorcycle</type>") == 1
    (pair,) = [catalogue(path, among="4", classes=False, jobs=1).concrete]
    assert {"scenario_4", ENDANGERED} <= pair[0].names


def test_only_drives_that_are_of_a_target_from_their_start_seed_its_range() -> None:
    """A test that shows a class later on is none of its drives from the start."""
    asked = asked_about(1, 4)
    lies = judge_test(ConcreteTest("braking", str(BRAKING)), asked, Freedom())
    begins = {"v_lon(SV)": (lies.begins["v_lon(SV)"],) * 2}
    found = {x: [*ranges.reaches_of(asked, {x: begins}, [lies])] for x in ("scenario_1", "scenario_4")}
    assert [len(x.known) for x in found["scenario_4"]] == [1]
    later = replace(lies, shown=(*lies.shown, replace(lies.shown[0], what="scenario_1", at=1.0)))
    assert [x.known for x in ranges.reaches_of(asked, {"scenario_1": begins}, [later])] == [()]


def test_a_scenario_without_drives_has_a_proof(tmp_path: Path) -> None:
    (tmp_path / "never.spec").write_text(NEVER, "utf-8")
    home = rp.load(specs=[tmp_path / "never.spec"]).specification
    [made] = complete(
        Basis(home),
        TargetFormulas(home, (4,), None, values_with(home.library, {})),
        ["scenario_4"],
        executor=1,
    )
    assert made.drive is None
    assert made.empty is not None


@pytest.mark.parametrize(("said", "told"), [("too hard", "too hard"), ("", "no drive was found")])
def test_a_test_without_a_drive_says_why(said: str, told: str) -> None:
    asked = asked_about(1)
    query = asked.query_of("scenario_1")
    batch = abstract_claims.TestBatch(Basis(HOME.specification), asked, AbstractTest("x", query))
    for steps in (batch.facts(), batch._decide_shows("scenario_1", query)):
        name, claim = next(steps)
        found = seen_with(steps, undecided(claim, ReasonKind.TOLD(said)))
        for fact in found if isinstance(found, tuple) else (found,):
            assert (fact.relation, fact.reason, fact.name) == ("open", told, name)


def seen_with(steps: Any, answer: ClaimAnswer) -> Any:
    """What is said after one answer."""
    with pytest.raises(StopIteration) as end:
        steps.send(answer)
    return end.value.value


# --- Why a test shows no scenario: what is said is so, judged again, and the change makes the part true

FILE = load_drive(Path(__file__).parents[3] / "examples" / "catalogue" / "tests" / "drives" / "lead.json")
NUMBERS = tuple(range(1, 9))
ROLES = ((("SV", "POV"), ("SV", "POV")),)
ASKED = TargetFormulas(HOME.alone, NUMBERS, None, HOME.all_values())


def pair(
    speed: Fraction, other: Fraction, gap: Fraction, braking: Fraction, begin: Fraction
) -> VehicleMotions:
    """POV ahead of SV in its lane; it brakes from ``begin`` to a stand."""
    lane = FILE.drive.vehicles["SV"]
    steady = Piece(None, Fraction(0), Fraction(0))
    behind = replace(lane, s=Fraction(0), v_lon=speed, v_lat=Fraction(0), pieces=(steady,))
    pieces = (
        Piece(begin, Fraction(0), Fraction(0)),
        Piece(other / braking, -braking, Fraction(0)),
        steady,
    )
    ahead = replace(behind, s=gap + behind.length, v_lon=other, pieces=pieces)
    drive = Drive({"SV": behind, "POV": ahead})
    return VehicleMotions(DriveSignals(drive), FILE.road, Fraction(10), ROLES, (FILE.lanes["L"],))


def why(*numbers: int | str) -> NearestScenario | None:
    speed, other, gap, braking, begin = map(Fraction, numbers)
    return nearest_scenario(pair(speed, other, gap, braking, begin), ASKED)


def test_equal_speeds_lack_a_slower_vehicle_ahead_and_count_in_another_set() -> None:
    found = why(20, 20, 60, 6, 1)
    assert found is not None
    assert found.nearest == "scenario_4"
    assert found.lacks == "fasterThan(POV, SV)"
    assert found.at == 0
    assert "v_lon(POV) = 20 m/s, v_lon(SV) = 20 m/s" in found.told
    assert "needs v_lon(POV) < v_lon(SV); POV would have to be a little slower then" in found.told


def test_the_sets_that_count_it_are_those_in_which_a_scenario_holds() -> None:
    found = why(20, 20, 60, 6, 1)
    assert found is not None
    home, course = HOME.alone, pair(*map(Fraction, (20, 20, 60, 6, 1)))
    for name in ("extA", "ext", "complete"):
        there = home.in_set(name)
        held = {
            name_of(number)
            for number in NUMBERS
            if vehicles_of(there, Scenario(number, name)) == ("SV", "POV")
            and judge(
                bind(
                    apply_scenario(there, Scenario(number, name)).formula,
                    course.road,
                    FILE.lanes,
                    ASKED.values,
                ),
                course.signals,
            ).holds
        }
        assert {*found.sets.get(name, ())} == held
    assert found.sets == {"complete": ("scenario_4",)}


def test_a_slower_vehicle_ahead_shows_scenario_4() -> None:
    assert why(20, "19.9", 60, 6, 1) is None


@pytest.mark.parametrize("seed", range(15))
def test_the_change_makes_the_part_true_and_less_does_not(seed: int) -> None:
    rng = random.Random(seed)
    limits = ((5, 40), (5, 40), (1, 150), (1, 8), (1, 4))
    course = pair(*(Fraction(rng.randint(4 * low, 4 * high), 4) for low, high in limits))
    formulas = [
        formula
        for key, formula in ASKED.on(course.road, *ROLES[0], course.lanes[0]).items()
        if isinstance(key, ScenarioKey)
    ]
    for formula in formulas:
        part = first_false_part(formula, DriveJudge.on(course.signals), course.horizon)
        if judge(formula, course.signals).holds:
            assert part is None
        if part is None:
            continue
        tiny = Fraction(1, 10**9)
        for by, expected in ((Fraction(0), False), (part.lack - tiny, False), (part.lack + tiny, True)):
            comparison = part.comparison
            grows = (comparison.op in (">", ">=")) is part.needed
            moved = t.Sum((comparison.left, t.Number(by if grows else -by)))
            truth = judge(f.Compare(moved, comparison.op, comparison.right), course.signals)
            assert (truth.truth(truth.formula).at(part.at) is part.needed) is expected


@pytest.mark.parametrize(
    ("text", "at_most", "lack"),
    [
        ("v_lon(SV) >= 0 m/s U v_lon(SV) > 100 m/s", 10, 80),
        ("F[0, 1 s] v_lon(POV) < 5 m/s", 1, 15),
        ("F[0, 1 s] (v_lon(SV) > 9 m/s and v_lon(POV) < 5 m/s and v_lon(POV) < 10 m/s)", 1, 15),
        ("F v_lon(SV) < 5 m/s", 10, 15),
        ("not (F[0, 1 s] v_lon(POV) > 5 m/s)", 0, 15),
    ],
)
def test_the_false_part_is_within_its_window_and_needed_as_it_stands(
    text: str, at_most: int, lack: int
) -> None:
    """POV brakes after the window; SV goes on at 20 m/s."""
    course = pair(*map(Fraction, (20, 20, 60, 6, 2)))
    formula = bind(HOME.read(text).formula, course.road, FILE.lanes, ASKED.values)
    found = first_false_part(formula, DriveJudge.on(course.signals), course.horizon)
    assert found is not None
    assert 0 <= found.at <= at_most
    assert found.lack == lack
    assert found.needed is not text.startswith("not")
