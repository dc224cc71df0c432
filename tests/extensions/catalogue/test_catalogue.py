"""Catalogues of tests: what each shows is what the judge says one by one, what is missing is found."""

import json
import shutil
from collections.abc import Callable, Mapping
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as xml

import pytest

import roadproof as rp
from roadproof.engines.search.batches import Engines
from roadproof.errors import InputError
from roadproof.evidence.answer import ClaimAnswer, undecided
from roadproof.evidence.claim import Claim
from roadproof.evidence.drive_file import DriveFile, drive_data, load_drive
from roadproof.extensions.catalogue import drive_targets
from roadproof.extensions.catalogue.cataloguing import CatalogueAnswer, catalogue
from roadproof.extensions.catalogue.entries import AbstractTest, ConcreteTest, Freedom
from roadproof.extensions.catalogue.fact import CatalogueFact
from roadproof.extensions.catalogue.figures import figures
from roadproof.extensions.catalogue.judge_test import judge_test
from roadproof.extensions.catalogue.reading import read_catalogue
from roadproof.extensions.catalogue.report import as_text
from roadproof.extensions.catalogue.target_formulas import ENDANGERED, GAP, NO_CLASS, RowKey, TargetFormulas
from roadproof.extensions.catalogue.targets import find_targets, target_titles
from roadproof.extensions.exchange.export.registry import FORMATS
from roadproof.extensions.surveys.classify.cells import Cell
from roadproof.extensions.surveys.classify.classes import Classes, plan_of
from roadproof.extensions.surveys.classify.division import Division, divide
from roadproof.frontends.api.settings import basis_of
from roadproof.frontends.cli.main import main
from roadproof.frontends.settings.groups import BudgetSettings
from roadproof.library.bind import bind
from roadproof.library.scenarios import Scenario, apply_scenario, name_of, vehicles_of
from roadproof.library.specification import Query
from roadproof.reasons import ReasonKind
from roadproof.runtime.budget import NO_COST, Cost
from roadproof.semantics.exact.algebraic import as_float
from roadproof.semantics.exact.judging import judge

pytestmark = pytest.mark.usefixtures("searched_once")

HOME = rp.load()
EXAMPLE = Path(__file__).parents[3] / "examples" / "catalogue" / "tests"
CLASSES = {
    **{"cut-in": "class_1", "both-change": "class_1_5", "from-behind": "class_3", "braking": "class_4"},
    **{"both-change-alone": "class_5", "change-behind-slower": "class_4_8", "lead": "class_8"},
    **{"class_4_6_8": "class_4_6_8", "class_6_8": "class_6_8", "seven": "class_7", "cut-out": "class_2"},
}
"""A drive of the example for each class of 1 to 8 that it has."""
DRIVES = [EXAMPLE / "drives" / f"{name}.json" for name in CLASSES]
NUMBERS = tuple(range(1, 9))
FIXED, ANY = Freedom(), Freedom(True, True, True)


@pytest.fixture(scope="module")
def division() -> Division:
    return divide(basis_of(HOME, BudgetSettings()), plan_of(HOME.alone, NUMBERS), 1, in_few_words=False)


@pytest.fixture(scope="module")
def asked(division: Division) -> TargetFormulas:
    return TargetFormulas(HOME.alone, NUMBERS, division.classes, HOME.all_values())


def names(asked: TargetFormulas, path: Path, freedom: Freedom = FIXED) -> set[str]:
    answer = judge_test(ConcreteTest("x", str(path)), asked, freedom)
    assert not answer.fault
    return {*answer.names}


@pytest.fixture(scope="module")
def queries(asked: TargetFormulas) -> dict[str, Query]:
    """Each scenario, class and danger by itself."""
    assert asked.classes is not None
    found = {name_of(n): apply_scenario(HOME.alone, Scenario(n, "base")) for n in NUMBERS}
    found |= {x.name: asked.class_query(x.name) for x in asked.classes.all()}
    return found | {ENDANGERED: HOME.read("initSafe(SV,POV) and F danger(SV,POV)")}


def one_by_one(queries: Mapping[str, Query], path: Path) -> set[str]:
    file = load_drive(path)
    drive = file.drive
    if "POV2" in drive.vehicles:
        queries = {**queries, ENDANGERED: HOME.read("initSafe(SV,POV2) and F danger(SV,POV2)")}
    found = set()
    for name, query in queries.items():
        if set(query.vehicles) <= set(drive.vehicles):
            lanes = dict.fromkeys(query.lanes, file.lanes["L"])
            if judge(bind(query.formula, file.road, lanes, HOME.all_values()), drive).holds:
                found.add(name)
    return found


def test_all_at_once_is_one_by_one(asked: TargetFormulas, queries: dict[str, Query]) -> None:
    shown = {path.stem: names(asked, path) for path in DRIVES}
    assert shown == {path.stem: one_by_one(queries, path) for path in DRIVES}
    assert {name: [x for x in those if x.startswith("class_")] for name, those in shown.items()} == {
        name: [one] for name, one in CLASSES.items()
    }


def written(path: Path, file: DriveFile) -> Path:
    path.write_text(json.dumps(drive_data(file, {})), "utf-8")
    return path


def exchanged(file: DriveFile) -> DriveFile:
    """SV is called POV, and POV is called SV."""
    other = {"SV": "POV", "POV": "SV"}
    return replace(
        file, drive=replace(file.drive, vehicles={other[n]: m for n, m in file.drive.vehicles.items()})
    )


def test_roles_are_fixed_or_any(asked: TargetFormulas, tmp_path: Path) -> None:
    path = EXAMPLE / "drives" / "braking.json"
    turned = written(tmp_path / "turned.json", exchanged(load_drive(path)))
    assert names(asked, path) == {"scenario_4", "class_4", ENDANGERED}
    assert "scenario_4" not in names(asked, turned)
    assert "scenario_4" in names(asked, turned, Freedom(roles=True))


def test_lanes_are_fixed_or_any(asked: TargetFormulas, tmp_path: Path) -> None:
    file = load_drive(EXAMPLE / "drives" / "braking.json")
    other = next(lane for lane in file.road.lanes if lane != file.lanes["L"])
    moved = written(tmp_path / "moved.json", replace(file, lanes={"L": other}))
    assert "scenario_4" not in names(asked, moved)
    assert "scenario_4" in names(asked, moved, Freedom(lanes=True))


def test_instants_are_those_of_the_judge(asked: TargetFormulas) -> None:
    """All instants count: each thing is shown from the instant on at which it is true first."""
    more = set()
    for path in (DRIVES[0], DRIVES[4]):
        file = load_drive(path)
        answer = judge_test(ConcreteTest("x", str(path)), asked, Freedom(start=True))
        more |= answer.names - names(asked, path)
        for number in NUMBERS:
            query = apply_scenario(HOME.alone, Scenario(number, "base"))
            if set(query.vehicles) <= set(file.drive.vehicles):
                formula = bind(query.formula, file.road, file.lanes, asked.values)
                spans = judge(formula, file.drive).truth(formula).spans()
                first = [x.at for x in answer.shown if x.what == name_of(number)]
                assert first == [as_float(span.begin.point) for span in spans[:1]]
    assert more >= {"scenario_6", "scenario_8"}  # from just after the start on


@pytest.mark.parametrize("samples", ["braking.csv", "cut-in.xml"])
def test_samples_show_what_their_drive_shows(samples: str, asked: TargetFormulas) -> None:
    path = EXAMPLE / "samples" / samples
    drive = EXAMPLE / "drives" / f"{path.stem}.json"
    answer = judge_test(ConcreteTest("x", str(path)), asked, FIXED)
    assert {x.what for x in answer.shown if x.at == 0} >= names(asked, drive)
    assert not answer.dense


def test_what_is_steady_shows_nothing(asked: TargetFormulas) -> None:
    assert names(asked, EXAMPLE / "samples" / "steady.csv", ANY) == set()


def test_danger_that_no_scenario_covers_is_a_gap(asked: TargetFormulas, tmp_path: Path) -> None:
    """A leader that brakes, among scenarios that know of cut-ins only."""
    braking = load_drive(EXAMPLE / "drives" / "braking.json")
    turned = judge_test(
        ConcreteTest("x", str(written(tmp_path / "a.json", exchanged(braking)))), asked, FIXED
    )
    assert ENDANGERED in turned.names
    assert GAP not in turned.names  # it is a scenario in other roles
    few = TargetFormulas(HOME.alone, (1, 2), None, asked.values)
    gap = judge_test(ConcreteTest("x", str(EXAMPLE / "drives" / "braking.json")), few, FIXED)
    assert gap.names == {ENDANGERED, GAP, "gap_behaviourPOV_1", "gap_behaviourPOV_1_1"}
    samples = judge_test(ConcreteTest("x", str(EXAMPLE / "samples" / "braking.csv")), few, FIXED)
    assert samples.names == gap.names
    (fault,) = find_targets(few, [replace(gap, claims=())], [], [], target_titles(few), 0.5, None).faults
    assert "a gap, which no scenario covers" in fault.told


# --- planted faults: each is noticed by the comparison above, or by the answer itself --------------


def a_row_is_lost(asked: TargetFormulas, monkeypatch: pytest.MonkeyPatch) -> None:
    names_of = TargetFormulas.names_of
    monkeypatch.setattr(
        TargetFormulas, "names_of", lambda s, r, true: names_of(s, r, frozenset(true - {RowKey(4)}))
    )


def scenarios_in_other_lanes(asked: TargetFormulas, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drive_targets, "_lanes", lambda file, free: file.road.lanes[-1:])


def all_instants(asked: TargetFormulas, monkeypatch: pytest.MonkeyPatch) -> None:
    instants = drive_targets._instants
    monkeypatch.setattr(
        drive_targets, "_instants", lambda judge, asked, file, free: instants(judge, asked, file, True)
    )


@pytest.mark.parametrize("plant", [a_row_is_lost, scenarios_in_other_lanes, all_instants])
def test_a_planted_fault_is_noticed(
    plant: Callable[[TargetFormulas, pytest.MonkeyPatch], None],
    asked: TargetFormulas,
    queries: dict[str, Query],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plant(asked, monkeypatch)
    assert any(names(asked, path) != one_by_one(queries, path) for path in reversed(DRIVES[:5]))


def test_a_scenario_that_is_neither_shown_nor_excluded_is_no_doubt_unless_it_is_claimed() -> None:
    query = HOME.read("scenario_4(SV,POV,L)")
    entry = AbstractTest("x", query)
    runs = CatalogueFact("x", "", "runs", query)
    still_open = CatalogueFact(
        "x", "scenario_8", "open", query, HOME.read("scenario_8(SV,POV,L)"), "not on this road"
    )
    few = TargetFormulas(HOME.alone, (8,), None, HOME.all_values())

    def doubts(entry: AbstractTest) -> list[str]:
        found = find_targets(few, [], [entry], [runs, still_open], target_titles(few), 0.5, None)
        assert not [x for x in found.faults if x.told.startswith("claims")]
        return [x.told for x in found.doubts]

    assert doubts(entry) == []
    assert doubts(replace(entry, claims=("scenario_8",))) == [
        "whether it can show scenario_8 is in doubt: not on this road"
    ]


def test_a_drive_in_no_class_is_a_contradiction(asked: TargetFormulas) -> None:
    assert asked.classes is not None
    what = tuple(tuple(c for c in cells if c.holds != (4,)) for cells in asked.classes.what)
    fewer = TargetFormulas(asked.specification, NUMBERS, replace(asked.classes, what=what), asked.values)
    answer = judge_test(ConcreteTest("x", str(EXAMPLE / "drives" / "braking.json")), fewer, FIXED)
    assert NO_CLASS in answer.names
    found = find_targets(fewer, [answer], [], [], target_titles(fewer), 0.5, None)
    assert [x.tests for x in found.contradictions] == [("x",)]


# --- what is asked for as a whole -------------------------------------------------------------------


@pytest.fixture(scope="module")
def few(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A drive for every class of 1 to 8 but four."""
    folder = tmp_path_factory.mktemp("few")
    for path in DRIVES:
        if path.stem not in ("seven", "cut-out"):
            shutil.copy(path, folder)
    return folder


def ask(*paths: Path, **more: Any) -> CatalogueAnswer:
    return catalogue(*paths, among="1-8", jobs=1, **more)


def test_what_is_missing_is_made_and_then_nothing_is_missing(
    few: Path, tmp_path: Path, division: Division, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roadproof.extensions.catalogue.question.divide_surely", lambda *_: division.classes)
    missing = {"class_3_6", "class_6", "class_7", "scenario_7", "class_2", "scenario_2"}
    found = ask(few)
    assert {*found.missing} == missing
    assert found.exit_code == 10
    made = found.complete(tmp_path / "more", jobs=1)
    assert {x.target for x in made.completions if x.drive} == missing - {"scenario_2", "scenario_7"}
    assert "4 drives" in str(made)
    assert main(["check", str(tmp_path / "more"), "--jobs", "1"]) == 0
    whole = ask(few, tmp_path / "more")
    assert (whole.missing, whole.tested.faults, whole.exit_code) == ((), (), 0)
    assert str(whole).endswith("complete")
    (tmp_path / "more" / "class_6.json").unlink()
    (tmp_path / "more" / "catalogue.toml").unlink()
    assert ask(few, tmp_path / "more").missing == ("class_6",)


@pytest.mark.parametrize("name", FORMATS)
def test_what_is_missing_is_written_in_every_format_without_a_specification_of_the_users(
    name: str, few: Path, tmp_path: Path
) -> None:
    """``--spec`` is left out here, so its value is the default of the definition."""
    chosen = ["--among", "3,4", "--no-classes", "--drivers", "none", "--quiet", "--jobs", "1"]
    out = tmp_path / "more"
    assert (
        main(["catalogue", str(few / "braking.json"), *chosen, "--complete", str(out), "--format", name])
        == 10
    )
    assert (out / "scenario_3.json").exists()
    assert any(x.is_file() for x in (out / name).rglob("*"))


def test_a_claim_of_a_scenario_that_is_not_asked_for_is_told_apart_from_one_that_does_not_exist(
    few: Path, tmp_path: Path
) -> None:
    shutil.copy(few / "braking.json", tmp_path)
    text = "".join(
        f'[[test]]\nid = "{n}"\nfile = "braking.json"\nclaims = ["{n}"]\n' for n in ("9", "class_1_2_3")
    )
    text += '[[test]]\nid = "formula"\nformula = "scenario_4(SV,POV,L)"\nclaims = [4, 9]\n'
    (tmp_path / "catalogue.toml").write_text(text, "utf-8")
    found = catalogue(tmp_path, among="1-8", jobs=1, classes=False)
    remarks = {x.tests: x.told for x in found.tested.faults}
    for name in ("9", "formula"):
        assert "scenario_9, which is not among the scenarios of this run" in remarks[(name,)]
    assert "this run is about scenarios only" in remarks[("class_1_2_3",)]
    divided = catalogue(tmp_path / "catalogue.toml", among="4,12,20", jobs=1, drivers=())
    remarks = {x.tests: x.told for x in divided.tested.faults}
    assert "no scenario and no class of that name" in remarks[("class_1_2_3",)]


def test_tables_and_reports(few: Path) -> None:
    found = ask(few, classes=False)
    header, *rows = (line.split(",") for line in found.to_csv().splitlines())
    assert header == ["test", *(f"scenario_{n}" for n in NUMBERS)]
    assert {row[0]: row[4] for row in rows}["braking"] == "x"
    suites = xml.fromstring(found.to_junit())
    failing = [case.get("name") for case in suites.iter("testcase") if case.find("failure") is not None]
    assert failing == ["scenario_2", "scenario_7"]
    assert found.verdicts["scenario_2"] == "GAPS"
    assert found.to_frame().height == 8
    assert found.plot().png.startswith(b"\x89PNG")


def test_road_sectors_are_told_apart(asked: TargetFormulas) -> None:
    numbers = (4, 12)
    plan = plan_of(HOME.alone, numbers)
    what = tuple((Cell((number,), (number,), ()),) for number in (4,))
    where = tuple(Cell((number,), (number,), ()) for number in plan.sectors)
    both = TargetFormulas(HOME.alone, numbers, Classes(plan, what, where), asked.values)
    answer = judge_test(ConcreteTest("x", str(EXAMPLE / "drives" / "braking.json")), both, FIXED)
    found = find_targets(both, [answer], [], [], target_titles(both), 0.5, None)
    assert {x.name: (x.sector, x.tested) for x in found.targets} == {
        "scenario_4": ("main", ("x",)),
        "scenario_12": ("merge", ()),
        "class_4_main": ("main", ("x",)),
        "class_4_merge": ("merge", ()),
    }
    assert "  main: 1 of 1 are tested\n  merge: 0 of 1 are tested" in as_text(
        1, found, [], figures("base", found.targets, found.gaps)
    )


ABSTRACT = """
[[test]]
id = "wide"
formula = "scenario_4(SV,POV,L)"
claims = [4]
[[test]]
id = "narrow"
formula = "scenario_4(SV,POV,L)"
at_start = { "v_lon(SV)" = "20 m/s .. 30 m/s" }
always = { "a_lon(SV)" = "-9 m/s^2 .. 9 m/s^2" }
claims = ["scenario_4"]
[[test]]
id = "other"
formula = "scenario_3(SV,POV,L)"
claims = [4]
[[test]]
id = "never"
formula = "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)"
"""


@pytest.mark.parametrize("road", ["", 'road = "main-2"'])
def test_drives_of_a_test_that_names_its_road_are_on_it(road: str, tmp_path: Path) -> None:
    test = f'[[test]]\nid = "cut-in"\nformula = "scenario_1(SV,POV,L)"\n{road}\n'
    (tmp_path / "catalogue.toml").write_text(test, "utf-8")
    found = catalogue(tmp_path, among="1,9", classes=False, drivers=(), jobs=1)
    facts = {x.other: x for x in found.view.facts}
    assert facts["scenario_1"].relation == "implies"
    assert (facts["scenario_9"].relation == "shows") is not bool(road)
    roads = {x.drive.file.road.name for x in facts.values() if x.drive is not None}
    assert (roads == {"main-2"}) is bool(road)


@pytest.fixture(scope="module")
def meant(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("abstract")
    (folder / "catalogue.toml").write_text(ABSTRACT, "utf-8")
    found = catalogue(folder, among="3-4", classes=False, drivers=(), jobs=1, out=folder / "report")
    relations = {(x.test, x.other): x.relation for x in found.view.facts}
    assert relations == {
        ("wide", ""): "runs",
        ("wide", "scenario_3"): "excludes",
        ("wide", "scenario_4"): "implies",
        ("narrow", ""): "runs",
        ("narrow", "scenario_3"): "excludes",
        ("narrow", "scenario_4"): "implies",
        ("narrow", "wide"): "implies",
        ("other", ""): "runs",
        ("other", "scenario_3"): "implies",
        ("other", "scenario_4"): "excludes",
        ("never", ""): "empty",
    }
    assert [(x.tests, x.told) for x in found.tested.faults] == [
        (("other",), "claims scenario_4, which it excludes: that is proved"),
        (("never",), "can never be run: that is proved"),
    ]
    assert found.missing == ()
    return folder


def test_answers_about_formulas_are_kept_and_checked(meant: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert main(["check", str(meant / "report"), "--jobs", "1"]) == 0
    monkeypatch.setattr(Engines, "answer_claim", lambda *_: pytest.fail("it is kept"))
    again = catalogue(meant, among="3-4", classes=False, drivers=(), jobs=1, out=meant / "report")
    assert len(again.evidence) == 12  # one test does not imply another


def test_a_doubt_is_a_doubt(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "catalogue.toml").write_text("[[test]]\nid='x'\nformula='scenario_4(SV,POV,L)'\n", "utf-8")

    def lost(engines: Engines, claim: Claim, proposed: object) -> tuple[ClaimAnswer, Cost]:
        return undecided(claim, ReasonKind.TOLD("its process was ended")), NO_COST

    monkeypatch.setattr(Engines, "answer_claim", lost)
    found = catalogue(tmp_path, among="4", classes=False, jobs=1)
    assert found.exit_code == 20
    assert "whether it can be run is in doubt: its process was ended" in str(found)


def test_other_values_of_parameters_are_told(asked: TargetFormulas) -> None:
    calm = TargetFormulas(HOME.alone, NUMBERS, None, {**asked.values, "rho": Fraction(3)})
    answer = judge_test(ConcreteTest("x", str(EXAMPLE / "drives" / "braking.json")), calm, FIXED)
    found = find_targets(calm, [answer], [], [], target_titles(calm), 0.5, None)
    (fault,) = found.faults
    assert fault.told.startswith(
        "claims scenario_4, and shows no scenario; its file has other values of rho than are asked for; "
        "nearest is scenario_4(SV, POV, main-1): "
    )


def test_files_of_one_name_are_two_tests(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        shutil.copy(EXAMPLE / "drives" / "braking.json", tmp_path / name)
    found = read_catalogue([tmp_path / "a", tmp_path / "b"], HOME.alone)
    assert [x.id for x in found.entries] == ["braking", (tmp_path / "b" / "braking.json").as_posix()]


# --- mistakes ---------------------------------------------------------------------------------------


def test_a_folder_without_tests_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no test in it"):
        read_catalogue([tmp_path], HOME.alone)


def test_what_is_no_test_is_counted(tmp_path: Path) -> None:
    """Samples beside their drive are no test of their own; indices and certificates are none."""
    drive = EXAMPLE / "drives" / "braking.json"
    shutil.copy(drive, tmp_path / "a.json")
    shutil.copy(EXAMPLE / "samples" / "braking.csv", tmp_path / "a.csv")
    (tmp_path / "index.json").write_text("{}", "utf-8")
    found = read_catalogue([tmp_path], HOME.alone)
    assert [x.id for x in found.entries] == ["a"]
    assert "2 more files" in found.notes[0]


def test_vehicles_of_scenarios_are_known(asked: TargetFormulas) -> None:
    assert {*asked.roles} == {vehicles_of(HOME.alone, Scenario(n, "base")) for n in NUMBERS}


# --- Drive files that are not what they say, or were made with other values than are asked for ------

BRAKING = Path(__file__).parents[3] / "examples" / "catalogue" / "tests" / "drives" / "braking.json"


def with_formula(folder: Path, formula: str) -> Path:
    path = folder / "braking.json"
    data = json.loads(BRAKING.read_text("utf-8"))
    path.write_text(json.dumps({**data, "scenario": None, "formula": formula}), "utf-8")
    return path


def test_a_drive_file_whose_own_formula_is_false_is_a_fault(tmp_path: Path) -> None:
    """Whether it shows what is asked for or not."""
    for formula, faults in (("v_lon(SV) > 0 m/s", 0), ("v_lon(SV) < 0 m/s", 1)):
        path = with_formula(tmp_path, formula)
        found = rp.catalogue(path, among="4", classes=False, jobs=1)
        assert not found.missing
        assert len(found.tested.faults) == faults
        assert found.exit_code == (10 if faults else 0)
    [fault] = found.tested.faults
    assert fault.tests == ("braking",)
    assert "the formula does not hold on the drive: v_lon(SV) < 0 m/s" in fault.told


def test_a_formula_that_cannot_be_read_here_is_noted(tmp_path: Path) -> None:
    path = with_formula(tmp_path, "mine(SV)")
    found = rp.catalogue(path, among="4", classes=False, jobs=1)
    assert not found.tested.faults
    [note] = found.notes
    assert note.startswith("braking: its own formula cannot be read here: ")


def test_drives_made_with_other_values_are_noted() -> None:
    plain = rp.catalogue(BRAKING, among="4", classes=False, jobs=1)
    assert plain.notes == ()
    using = rp.load("ext", params={"minDanger": "0.7 s"})
    [note] = rp.catalogue(BRAKING, among="4", classes=False, using=using, jobs=1).notes
    assert note.startswith("made with set base, minDanger = ")
    assert note.endswith("judged with what is asked for: braking")
