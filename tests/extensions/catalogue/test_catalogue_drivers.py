"""Driver models put into the tests of a catalogue, as evaluations put them into matches."""

import csv
import io
import json
import shutil
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from random import Random
from typing import Any
from xml.etree import ElementTree as xml

import pytest

import roadproof as rp
from extensions.drivers.read import specification, values
from extensions.traffic.test_drivers import EACH, drives, questions_with
from roadproof.errors import InputError
from roadproof.evidence.drive_file import DriveFile, drive_data, load_drive
from roadproof.extensions.assurance.folder_view import folder_data
from roadproof.extensions.catalogue.catalogue_file import _fragments_alone
from roadproof.extensions.catalogue.driver_sides import read_side_name
from roadproof.extensions.catalogue.entries import AbstractTest, ConcreteTest
from roadproof.extensions.catalogue.reading import read_catalogue
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.driving import OWN_LANE, drive_of, road_of
from roadproof.extensions.drivers.initial_state import InitialState
from roadproof.extensions.drivers.lines import SIDES, Side
from roadproof.extensions.drivers.manoeuvres import KMH, MANOEUVRES, signals_of
from roadproof.extensions.drivers.models import MODELS, SCENARIOS
from roadproof.extensions.traffic.evaluate import decisions
from roadproof.extensions.traffic.evaluate.decisions import (
    Decision,
    Drivers,
    decide_drive,
    decide_formula,
    decide_trace,
)
from roadproof.extensions.traffic.evaluate.evaluate import evaluate_recording
from roadproof.extensions.traffic.evaluate.one_trace import cut_trace, sample_drive
from roadproof.frontends.cli.main import main
from roadproof.library.bind import bind, values_with
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.semantics.exact.judging import judge
from roadproof.world.drive import Drive, Piece
from tables import read_table

pytestmark = pytest.mark.usefixtures("searched_once")

EXAMPLE = Path(__file__).parents[3] / "examples" / "catalogue" / "tests"
ALL = tuple(MODELS)
DRIVERS = Drivers(specification(), {**values(), "minDanger": Fraction(0)}, ALL)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize(("name", "model"), EACH)
def test_decisions_are_those_of_evaluate(name: str, model: str, side: Side) -> None:
    """Of each match that an evaluation puts to models, in the same frames."""
    asked = questions_with()
    place = asked.settings.drivers.index(model)
    kind, compared = MANOEUVRES[name], 0
    for _, recording in drives(name, model, side)[:2]:
        where = {number: k for k, number in enumerate(recording.vehicle_id.tolist())}
        for match in evaluate_recording(recording, asked).matches:
            if not match.labels or match.scenario != SCENARIOS[name]:
                continue
            ids = [x for x in (match.sv, match.pov, match.pov2) if x is not None]
            vehicles = dict(zip(kind.vehicles, (where[x] for x in ids), strict=True))
            last = min(int(recording.last_frame[x]) for x in vehicles.values())
            frames = match.start_frame, last
            trace = cut_trace(recording, "match", vehicles, frames)
            found = decide_trace(
                trace, DRIVERS, f"scenario_{match.scenario}", kind.vehicles, 0.0, kind.vehicles
            )
            [mine] = [x for x in found if x.driver == model]
            assert mine.side == match.labels[place]
            begun = None if mine.at is None else match.start_frame + round(mine.at * 25)
            assert begun == match.begun
            compared += 1
    assert compared


def state_of(name: str, at: dict[str, Fraction]) -> InitialState:
    kind = MANOEUVRES[name]
    full = kind.values(at)
    sizes = {(x, v): full[x] for x in ("length", "width") for v in kind.vehicles}
    return InitialState(signals_of(kind, full), sizes)


def random_values(name: str, random: Random) -> dict[str, Fraction]:
    def between(low: float, high: float) -> Fraction:
        return Fraction(round(random.uniform(low, high) * 100), 100)

    speed = between(8, 35)
    match name:
        case "cut-in":
            return {"Ve0": speed, "dV0": between(0, 8), "Vy": between(0.3, 3), "dx0": between(0, 60)}
        case "cut-out":
            return {"Ve0": speed, "Vf0": between(0, 8), "Vy": between(0.3, 3), "dx0_f": between(0, 80)}
        case _:
            return {"Ve0": speed, "dV0": between(0, 6), "Gx": between(1, 9), "dx0": between(0, 60)}


@pytest.mark.parametrize("name", MANOEUVRES)
def test_a_state_gives_back_the_values_that_it_was_made_of(name: str) -> None:
    kind = MANOEUVRES[name]
    at = kind.values(random_values(name, Random(7)))
    found = state_of(name, at).values(name, kind.vehicles)
    assert found == {x: at[x] for x in found}


def test_a_vehicle_that_stands_has_no_headway() -> None:
    kind = MANOEUVRES["cut-out"]
    at = {"Ve0": Fraction(0), "Vf0": Fraction(3), "dx0_f": Fraction(20), "headway": Fraction(0)}
    start = {**kind.values({}), **at}
    sizes = {(x, v): start[x] for x in ("length", "width") for v in kind.vehicles}
    found = InitialState(signals_of(kind, start), sizes).values("cut-out", kind.vehicles)
    assert {x: found[x] for x in at} == at


@pytest.mark.parametrize("model", ["careful", "fsm"])
@pytest.mark.parametrize(("gap", "side"), [(8, "unpreventable"), (60, "preventable")])
def test_a_drive_is_decided_when_its_manoeuvre_begins(model: str, gap: int, side: str) -> None:
    kind = MANOEUVRES["cut-in"]
    at = kind.values({"Ve0": 90 * KMH, "dV0": 30 * KMH, "dx0": Fraction(gap)})
    drive = drive_of(kind, "r157", at, DriverSettings(values(), specification().options))
    file = DriveFile(
        None, "base", "true", Fraction(6), {"L": OWN_LANE}, {}, {}, road_of(kind, at), drive, True
    )
    [found] = [x for x in decide_drive(file, DRIVERS, "scenario_1", kind.vehicles, 0.0) if x.driver == model]
    assert (found.side, found.at, found.start["dx0"], found.reason) == (side, 0.0, gap, "")
    late = decide_drive(file, DRIVERS, "scenario_1", kind.vehicles, 5.0)
    assert {x.side for x in late} == {"not covered"}


@pytest.mark.parametrize("said", ["", "not "])
def test_a_formula_about_drivers_is_judged_too(said: str, tmp_path: Path) -> None:
    """A drive file of ``preventable`` is read with the definitions of drivers; a false one is a fault."""
    kind = MANOEUVRES["cut-in"]
    at = kind.values({"Ve0": 90 * KMH, "dV0": 30 * KMH, "dx0": Fraction(8)})
    home = specification()
    drive = drive_of(kind, "r157", at, DriverSettings(values(), home.options))
    formula = f"{said}unpreventable_cutIn_careful(SV, POV)"
    reading = values(), dict(home.options)
    file = DriveFile(
        None, "base", formula, Fraction(6), {"L": OWN_LANE}, *reading, road_of(kind, at), drive, True
    )
    path = tmp_path / "hit.json"
    path.write_text(json.dumps(drive_data(file, {})), "utf-8")
    made = rp.catalogue(path, among="1", classes=False, drivers=["careful"], jobs=1)
    assert [x.told.partition(":")[0] for x in made.tested.faults if "rejected" in x.told] == (
        ["its file is rejected"] if said else []
    )
    assert not made.notes


def braking(gap: int, *pieces: tuple[int, int]) -> DriveFile:
    """POV, ahead by ``gap`` and as fast as SV, brakes as the pieces say: seconds, and m/s^2."""
    kind = MANOEUVRES["deceleration"]
    at = kind.values({"Ve0": Fraction(25), "dx0": Fraction(gap), "Gx": Fraction(1)})
    drive = drive_of(kind, "careful", at, DriverSettings(values(), specification().options))
    steps = [Piece(Fraction(t), Fraction(-a), Fraction(0)) for t, a in pieces]
    last = (Piece(None, Fraction(0), Fraction(0)),)
    motions = {
        "SV": replace(drive.vehicles["SV"], pieces=last),
        "POV": replace(drive.vehicles["POV"], pieces=(*steps, *last)),
    }
    road = road_of(kind, at)
    return DriveFile(None, "base", "true", Fraction(6), {"L": OWN_LANE}, {}, {}, road, Drive(motions), True)


@pytest.mark.parametrize(
    ("gap", "pieces", "since", "begins"),
    [
        (200, ((2, 0), (1, 3)), 0, 2),
        (5, ((2, 0), (1, 3)), 0, 2),  # danger is there from the beginning
        (200, ((1, 3), (2, 0), (1, 3)), 0, 0),
        (200, ((1, 3), (2, 0), (1, 3)), 2, 3),
        (200, ((1, 3), (1, 0)), 2, None),
    ],
)
def test_when_a_manoeuvre_begins(
    gap: int, pieces: tuple[tuple[int, int], ...], since: int, begins: int | None
) -> None:
    """In a drive and in its samples alike: from the start that is asked for."""
    file = braking(gap, *pieces)
    trace = sample_drive(file.drive, file.road, file.horizon, Fraction(1, 25), "drive")
    who = MANOEUVRES["deceleration"].vehicles
    for found in (
        decide_drive(file, DRIVERS, "scenario_4", who, since),
        decide_trace(trace, DRIVERS, "scenario_4", who, since, who),
    ):
        made = list(found)
        assert {x.at for x in made} == {begins}
        assert [x.driver for x in made] == ["careful", "rss", "fsm"]
        assert (begins is None) is ({x.side for x in made} == {"not covered"})


def test_danger_before_a_cut_out_is_that_of_the_vehicle_behind_which_it_opens() -> None:
    """SV follows POV1 too closely from the beginning, and POV2 is far away: the cut-out is still decided."""
    kind = MANOEUVRES["cut-out"]
    at = kind.values(
        {"Ve0": Fraction(25), "Vf0": Fraction(20), "headway": Fraction(1, 5), "dx0_f": Fraction(90)}
    )
    drive = drive_of(kind, "careful", at, DriverSettings(values(), specification().options))
    steps = (
        Piece(Fraction(2), Fraction(0), Fraction(0)),
        Piece(Fraction(1), Fraction(0), Fraction(1)),
        Piece(None, Fraction(0), Fraction(0)),
    )
    motions = {
        "SV": replace(drive.vehicles["SV"], pieces=steps[-1:]),
        "POV1": replace(drive.vehicles["POV1"], v_lat=Fraction(0), pieces=steps),
        "POV2": drive.vehicles["POV2"],
    }
    road = road_of(kind, at)
    file = DriveFile(None, "base", "true", Fraction(6), {"L": OWN_LANE}, {}, {}, road, Drive(motions), True)
    found = [*decide_drive(file, DRIVERS, "scenario_2", kind.vehicles, 0.0)]
    assert {x.at for x in found} == {2.0}
    assert {x.side for x in found} == {"preventable"}


def test_scenarios_without_a_driver_are_not_decided() -> None:
    assert decisions.manoeuvre_of("scenario_3") is None
    assert decisions.manoeuvre_of("class_1") is None
    assert decisions.manoeuvre_of("scenario_9") == "cut-in"


def test_a_formula_is_partly_preventable_only_where_drives_show_both() -> None:
    one = Decision("scenario_1", ("SV", "POV"), "careful", "preventable", gap=1.0)
    other = Decision("scenario_1", ("SV", "POV"), "careful", "unpreventable")
    [both] = decide_formula([one, other])
    [alone] = decide_formula([one])
    [missed] = decide_formula([one, one], {("scenario_1", "careful")})
    assert (both.side, alone.side, alone.gap) == ("partly", "undecided", None)
    assert alone.reason == "drives found: 1 preventable; no other was looked for; nothing is proved"
    assert (
        missed.reason == "drives found: 2 preventable; a search found none on another side; nothing is proved"
    )


WIDE = (
    "scenario_1(SV,POV,L) and v_lon(SV) = 30 m/s and v_lon(POV) >= 15 m/s and v_lon(POV) <= 30 m/s "
    "and s(POV) - s(SV) >= 10 m and s(POV) - s(SV) <= 80 m"
)


@pytest.fixture(scope="module", params=["rss"])
def both_sides(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """A test with a formula, and its answer by one driver model."""
    home = tmp_path_factory.mktemp("sides")
    text = f'[[test]]\nid = "wide"\nformula = "{WIDE}"\n'
    (home / "tests").mkdir()
    (home / "tests" / "catalogue.toml").write_text(text, "utf-8")
    options: dict[str, Any] = {"among": "1", "classes": False, "drivers": [request.param], "jobs": 1}
    made = rp.catalogue(home / "tests", **options, out=home / "report")
    assert [(x, y.driver, y.side) for x, y in made.decisions] == [("wide", request.param, "partly")]
    return request.param, home / "report"


def test_drives_of_a_formula_are_looked_for_on_both_sides(both_sides: tuple[str, Path]) -> None:
    """Each drive that is found is one of the test, and is on the side that its fact names."""
    model, report = both_sides
    sides = set()
    for fact in folder_data(report)["facts"]:
        named = read_side_name(fact["other"])
        if named is None or fact["drive"] is None:
            continue
        scenario, side, driver = named
        assert (scenario, driver, fact["relation"]) == ("scenario_1", model, "shows")
        found_drive = load_drive(report / fact["drive"])
        file = replace(found_drive, options={}, values=values_with(bundled_library(), {}))
        home = bundled_library().select("base", {})
        formula = bind(read_claim(home, WIDE).formula, file.road, file.lanes, values_with(home.library, {}))
        assert judge(formula, file.drive).holds
        found = decide_drive(file, replace(DRIVERS, values=values()), "scenario_1", ("SV", "POV"), 0.0)
        assert [x.side for x in found if x.driver == model] == [side]
        sides.add(side)
    assert sides
    assert rp.check(report, jobs=1).accepted


def test_the_answer_decides_drives_and_samples_and_says_so(tmp_path: Path) -> None:
    drive, samples = EXAMPLE / "drives" / "cut-in-hard.json", EXAMPLE / "samples" / "braking.csv"
    made = rp.catalogue(drive, samples, among="1,4", classes=False, drivers=["careful", "rss"], jobs=1)
    assert [(x, y.driver, y.side) for x, y in made.decisions] == [
        (test, driver, "preventable") for test in ("cut-in-hard", "braking") for driver in ("careful", "rss")
    ]
    rows = list(csv.DictReader(io.StringIO(made.files(False)["drivers.csv"].decode())))
    assert [x["driver"] for x in rows] == [y.driver for _, y in made.decisions]
    assert "careful preventable (" in str(made)


def test_no_models_no_decisions_and_wrong_names_are_refused() -> None:
    path = EXAMPLE / "drives" / "braking.json"
    made = rp.catalogue(path, among="4", classes=False, drivers=[], jobs=1)
    assert made.decisions == ()
    with pytest.raises(rp.UsageError, match="drivers=carefull"):
        rp.catalogue(path, among="4", classes=False, drivers=["carefull"], jobs=1)


# --- Mistakes in a ``catalogue.toml``: the test that has one is a fault, and all others are judged --

HOME = rp.load()
BRAKING = Path(__file__).parents[3] / "examples" / "catalogue" / "tests" / "drives" / "braking.json"
FIRST = "[[test]]\nid = 'FIRST'\nformula = 'scenario_4(SV,POV,L)'\n"
LAST = "[[test]]\nid = 'LAST'\nfile = 'braking.json'\nclaims = [4]\n"


def written(folder: Path, text: str, name: str = "catalogue.toml") -> Path:
    folder.mkdir(exist_ok=True)
    (folder / name).write_text(text, "utf-8")
    shutil.copy(BRAKING, folder)
    return folder


def faults_in(folder: Path) -> dict[str, str]:
    """The faults of the tests of a folder by id."""
    found = read_catalogue([folder], HOME.alone).entries
    return {x.id: x.fault for x in found if isinstance(x, ConcreteTest) and x.fault}


@pytest.mark.parametrize(
    ("text", "told"),
    read_table(__file__, "one_mistake_is_one_fault"),
)
def test_one_mistake_is_one_fault(text: str, told: str, tmp_path: Path) -> None:
    """The message names the file and the test; those before and after it are as they were."""
    folder = written(tmp_path, f"{FIRST}[[test]]\n{text}\n{LAST}")
    first, wrong, last = read_catalogue([folder], HOME.alone).entries
    assert isinstance(first, AbstractTest)
    assert first.query.text == "scenario_4(SV, POV, L)"
    assert last == ConcreteTest("LAST", str(folder / "braking.json"), claims=("scenario_4",))
    assert isinstance(wrong, ConcreteTest)
    assert str(folder / "catalogue.toml") in wrong.fault
    assert told in wrong.fault


@pytest.mark.parametrize(
    ("text", "ids"),
    [
        (f"{FIRST}[[tset]]\nid = 'X'\n{LAST}", ["FIRST", "LAST", "X"]),
        (f"{FIRST}[test]\nid = 'X'\n{LAST}", ["FIRST", "X", "LAST"]),
        (f"{FIRST}[[test]\nid = 'X'\n{LAST}", ["FIRST", "X", "LAST"]),
        (f"name = 'mine'\n{FIRST}{LAST}", ["FIRST", "LAST", "catalogue.toml, test 3"]),
        (f"name 'mine'\n{FIRST}{LAST}", ["catalogue.toml, test 1", "FIRST", "LAST"]),
        (f"# mine\n{FIRST}[test.test]\nx = 1\n{LAST}", ["FIRST", "LAST"]),
    ],
)
def test_headings_that_are_wrong(text: str, ids: list[str], tmp_path: Path) -> None:
    found = read_catalogue([written(tmp_path, text)], HOME.alone).entries
    assert [x.id.replace(f"{tmp_path}/", "") for x in found] == ids
    assert len(faults_in(tmp_path)) == 1


@pytest.mark.parametrize(
    "text", ["", "other = 1", "[[tset]]\nid = 'x'", "[test]\nid = 'x'", "[[test]]\nid ="]
)
def test_a_file_without_tests_is_an_error_where_it_is_alone(text: str, tmp_path: Path) -> None:
    path = tmp_path / "catalogue.toml"
    path.write_text(text, "utf-8")
    with pytest.raises(InputError, match=r"catalogue\.toml"):
        read_catalogue([path], HOME.alone)
    shutil.copy(BRAKING, tmp_path)
    [(name, told)] = faults_in(tmp_path).items()
    assert name == str(path)
    assert told.startswith(name)


def test_a_text_over_several_lines_is_not_read_as_tests(tmp_path: Path) -> None:
    """A test inside of a text is none, even where the file is no TOML."""
    text = f'[[test]]\nid = \'X\ntitle = """\n{FIRST}"""\n'
    assert [*faults_in(written(tmp_path, text))] == [str(tmp_path / "catalogue.toml")]


@pytest.mark.parametrize("quotes", ['"""', "'''"])
def test_tests_inside_of_a_long_text_are_none(quotes: str, tmp_path: Path) -> None:
    text = f"[[test]]\nid = 'X\ntitle = {quotes}\n[[test]]\nid = 'inside'\nfile = 'x.json'\n{quotes}\n"
    path = tmp_path / "catalogue.toml"
    path.write_text(text, "utf-8")
    assert _fragments_alone(path) == ()
    path.write_text(text.replace(quotes, "''"), "utf-8")
    assert any(x.fields.get("id") == "inside" for x in _fragments_alone(path))


def test_a_file_that_a_faulty_test_names_is_no_test_by_itself(tmp_path: Path) -> None:
    for wrong in ("tilte = 'x'", "title = x"):
        text = f"[[test]]\nid = 'X'\nfile = 'braking.json'\n{wrong}\n{FIRST}"
        found = read_catalogue([written(tmp_path, text)], HOME.alone).entries
        assert [x.id for x in found] == ["X", "FIRST"]
        assert [*faults_in(tmp_path)] == ["X"]


def test_ids_are_unique_over_all_files(tmp_path: Path) -> None:
    """The first one is judged; the others are faults, and have ids by which reports tell them apart."""
    for name in ("a", "b"):
        written(tmp_path / name, LAST + LAST)
    found = read_catalogue([tmp_path], HOME.alone).entries
    assert [x.id for x in found] == ["LAST", "LAST (2)", "LAST (3)", "LAST (4)"]
    faults = faults_in(tmp_path)
    assert [*faults] == ["LAST (2)", "LAST (3)", "LAST (4)"]
    assert f"the other one is in {tmp_path / 'a' / 'catalogue.toml'}" in faults["LAST (3)"]
    assert "the other one" not in faults["LAST (2)"]
    twice = read_catalogue([BRAKING, BRAKING], HOME.alone).entries
    assert [x.id for x in twice] == ["braking", "braking (2)"]


def test_a_fault_is_told_everywhere_and_covers_nothing(tmp_path: Path) -> None:
    """In text, JSON, table and JUnit; the test that it is in shows nothing, and the exit code is 10."""
    wrong = "[[test]]\nid = 'WRONG'\nfile = 'braking.json'\nclaims = [3]\nroles = 3\n"
    folder = written(tmp_path / "tests", f"{wrong}[[test]]\nid = 'TEXT'\nformula = 'true and'\n")
    out = tmp_path / "out"
    arguments = ["--among", "4", "--no-classes", "--out", str(out), "--no-pictures", "--jobs", "1"]
    assert main(["catalogue", str(folder), *arguments]) == 10
    index = folder_data(out)
    assert [(x["tests"], x["told"].partition(": ")[0]) for x in index["faults"]] == [
        (["WRONG"], "cannot be read"),
        (["TEXT"], "cannot be read"),
    ]
    assert [(x["id"], x["shown"], x["claims"], bool(x["fault"])) for x in index["tests"]] == [
        ("WRONG", [], [], True),
        ("TEXT", [], [], True),
    ]
    assert index["not_tested"] == ["scenario_4"]
    cases = xml.parse(out / "junit.xml").iter("testcase")
    failing = {x.get("name"): y.get("message") for x in cases if (y := x.find("failure")) is not None}
    assert "test WRONG: roles=3" in str(failing["WRONG"])
    assert "\n  true and\n" in str(failing["TEXT"])
    assert (out / "matrix.csv").read_text("utf-8").splitlines() == ["test,scenario_4", "WRONG,", "TEXT,"]
    assert main(["check", str(out), "--jobs", "1"]) == 0
    found = rp.catalogue(folder, among="4", classes=False, jobs=1)
    assert "  TEXT: cannot be read: " in str(found)
    assert "\n    true and\n" in str(found)
    assert found.exit_code == 10
