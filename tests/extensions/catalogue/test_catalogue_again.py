"""Answers about catalogues, judged again: a field that is changed is rejected, and so are stale tests."""

import csv
import json
import shutil
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import roadproof as rp
from roadproof.errors import InputError
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.subject import SubjectKind
from roadproof.extensions.assurance.folder_view import folder_data
from roadproof.extensions.catalogue import traces
from roadproof.extensions.catalogue.catalogue_data import RequestData
from roadproof.extensions.catalogue.concrete_answer import ConcreteAnswer
from roadproof.extensions.catalogue.curves import curves_of
from roadproof.extensions.catalogue.entries import ConcreteTest, Freedom
from roadproof.extensions.catalogue.judge_test import judge_test
from roadproof.extensions.catalogue.role_choices import role_choices
from roadproof.extensions.catalogue.target_formulas import TargetFormulas
from roadproof.extensions.catalogue.traces import digest_of, roles_in
from roadproof.extensions.pages.command_lines import command_line
from roadproof.extensions.pages.page.catalogues import as_settings
from roadproof.extensions.traffic.evaluate.one_trace import read_pair, read_samples
from roadproof.frontends.cli.main import main
from roadproof.reasons import ReasonKind
from roadproof.verdict import ExitCode

pytestmark = pytest.mark.usefixtures("searched_once")

EXAMPLE = Path(__file__).parents[3] / "examples" / "catalogue" / "tests"
TOML = """\
[[test]]
id = "wide"
formula = "scenario_4(SV,POV,L)"
claims = [4]

[[test]]
id = "LEAD"
file = "braking.json"
"""


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A drive, samples and a formula, with their answer in a folder of its own."""
    home = tmp_path_factory.mktemp("kept")
    tests = home / "tests"
    tests.mkdir()
    shutil.copy(EXAMPLE / "drives" / "braking.json", tests)
    shutil.copy(EXAMPLE / "samples" / "braking.csv", tests / "samples.csv")
    shutil.copy(EXAMPLE / "samples" / "braking_road.toml", tests / "samples_road.toml")
    shutil.copy(EXAMPLE / "drives" / "from-behind.json", tests)
    (tests / "catalogue.toml").write_text(TOML, "utf-8")
    models = ["careful", "rss"]
    found = rp.catalogue(tests, among="1,3,4", classes=False, drivers=models, out=home / "report", jobs=1)
    found.add_files(False)
    return home


@pytest.fixture
def home(kept: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The same folder, put right again after each test."""
    saved = kept.with_name(f"{kept.name}-saved")
    shutil.copytree(kept, saved)
    yield kept
    shutil.rmtree(kept)
    shutil.move(saved, kept)


def reasons(folder: Path) -> list[str]:
    return [x.reason for x in rp.check(folder, jobs=1).findings if x.outcome is not Acceptance.ACCEPTED]


def test_the_answer_is_accepted_and_says_what_was_judged(home: Path) -> None:
    checked = rp.check(home / "report", jobs=1)
    assert checked.exit_code is ExitCode.AS_EXPECTED
    told = str(checked)
    assert "JUDGED    test LEAD  shows dangerArises, scenario_4  [judged again in dense time" in told
    assert "WITNESSED wide runs  scenario_4(SV, POV, L)" in told
    assert "PROVED    wide implies scenario_4  scenario_4(SV, POV, L) -> scenario_4(SV, POV, L)" in told
    assert not checked.not_checked


@pytest.mark.parametrize("name", ["matrix.csv", "figures.csv", "drivers.csv", "junit.xml"])
def test_tables_are_compared(home: Path, name: str) -> None:
    path = home / "report" / name
    path.write_text(path.read_text("utf-8") + "\n", "utf-8")
    assert reasons(home / "report") == ["it is not the table that these answers make"]


def test_specifications_for_other_evidence_change_nothing(home: Path) -> None:
    own = home / "own.spec"
    own.write_text("def slow(a: vehicle) := v_lon(a) < 3 m/s\n", "utf-8")
    assert main(["check", str(home / "report"), "--spec", str(own), "--jobs", "1"]) == 0


def test_stale_tests_are_named(home: Path, capsys: pytest.CaptureFixture[str]) -> None:
    drive = home / "tests" / "braking.json"
    drive.write_bytes((home / "tests" / "from-behind.json").read_bytes())
    assert main(["check", str(home / "report"), "--jobs", "1"]) == ExitCode.UNEXPECTED
    told = capsys.readouterr().out
    assert "test LEAD has changed since it was judged: the answer is stale; ask again" in told
    [stale] = [x for x in rp.check(home / "report", jobs=1).findings if x.name == "LEAD"]
    assert (stale.subject, stale.reason.kind, stale.outcome) == (
        SubjectKind.TEST,
        ReasonKind.FILE_CHANGED,
        Acceptance.REJECTED,
    )


def test_tests_that_are_gone_or_new_are_named(home: Path) -> None:
    (home / "tests" / "samples.csv").unlink()
    shutil.copy(EXAMPLE / "drives" / "seven.json", home / "tests")
    checked = rp.check(home / "report", jobs=1)
    rejected = {Path(x.where).name for x in checked.findings if x.outcome is Acceptance.REJECTED}
    assert {"matrix.csv", "junit.xml", "drivers.csv"} < rejected
    assert any(x.startswith("judged-test-samples-") for x in rejected), "no test has this name now"
    assert {x.label for x in checked.findings if x.verdict == "UNKNOWN"} >= {"test seven"}


def test_a_formula_that_was_changed_is_no_longer_that_of_its_answers(home: Path) -> None:
    toml = home / "tests" / "catalogue.toml"
    toml.write_text(TOML.replace("scenario_4(", "scenario_3(").replace("[4]", "[3]"), "utf-8")
    assert any("is no answer to its claim: its drive is one of" in x for x in reasons(home / "report"))


def test_without_its_tests_nothing_is_accepted_in_silence(home: Path) -> None:
    shutil.rmtree(home / "tests")
    checked = rp.check(home / "report", jobs=1)
    assert checked.exit_code is ExitCode.UNEXPECTED
    assert not checked.accepted


def test_answers_among_the_tests_are_no_tests(home: Path) -> None:
    """A catalogue that is asked for again would else count the drives of its own evidence as tests."""
    inside = home / "tests" / "report"
    first = rp.catalogue(home / "tests", among="1,3,4", classes=False, out=inside, jobs=1)
    again = rp.catalogue(home / "tests", among="1,3,4", classes=False, out=inside, jobs=1)
    assert again.tests == first.tests
    assert rp.check(inside, jobs=1).accepted
    next(inside.glob("judged-*.json")).unlink()  # a run that was broken off
    assert rp.catalogue(home / "tests", among="1,3,4", classes=False, jobs=1).tests == first.tests


def test_the_command_asks_the_same(home: Path) -> None:
    request = folder_data(home / "report")["request"]
    assert request["paths"] == [str(home / "tests")]
    asked = RequestData(**{k: tuple(x) if isinstance(x, list) else x for k, x in request.items()})
    command = command_line("catalogue", asked.paths, as_settings(asked))
    assert command == f"roadproof catalogue {home / 'tests'} --no-classes --drivers careful,rss"


# --- Samples that contradict themselves are no coverage: refused or noted as recordings are ---------

SAMPLES = Path(__file__).parents[3] / "examples" / "catalogue" / "tests" / "samples"
Row = dict[str, str]


def in_kmh(row: Row, subject: Row) -> Row:
    return {**row, "v_lon": str(3.6 * float(row["v_lon"]))}


def with_a_jump(row: Row, subject: Row) -> Row:
    return {**row, "s": str(float(row["s"]) + 75 * (float(row["time"]) > 1))}


def within(row: Row, subject: Row) -> Row:
    """Whoever is not SV drives 2 m ahead of it, so that their boxes overlap."""
    if row["vehicle"] == "SV":
        return row
    return {**subject, "vehicle": row["vehicle"], "s": str(float(subject["s"]) + 2)}


def through(row: Row, subject: Row) -> Row:
    """Whoever is not SV falls back through it."""
    if row["vehicle"] == "SV":
        return row
    time = float(row["time"])
    place, speed = float(subject["s"]) + 30 - 20 * time, float(subject["v_lon"]) - 20
    return {**subject, "vehicle": row["vehicle"], "s": str(place), "v_lon": str(speed)}


def changed(folder: Path, change: Callable[[Row, Row], Row] | None) -> Path:
    """The samples ``braking.csv`` with each row changed, and the road beside them."""
    rows = list(csv.DictReader((SAMPLES / "braking.csv").open()))
    subject: Mapping[str, Row] = {x["time"]: x for x in rows if x["vehicle"] == "SV"}
    path = folder / "braking.csv"
    with path.open("w") as file:
        writer = csv.DictWriter(file, list(rows[0]))
        writer.writeheader()
        writer.writerows(x if change is None else change(x, subject[x["time"]]) for x in rows)
    shutil.copy(SAMPLES / "braking_road.toml", folder)
    return path


@pytest.mark.parametrize("change", [in_kmh, with_a_jump])
def test_samples_that_contradict_themselves_are_refused_as_in_an_evaluation(
    change: Callable[[Row, Row], Row], tmp_path: Path
) -> None:
    path = changed(tmp_path, change)
    found = rp.catalogue(path, among="4", classes=False, jobs=1)
    assert found.missing == ("scenario_4",)
    assert found.exit_code == 10
    [fault] = found.tested.faults
    for reader in (lambda: read_samples(path), lambda: rp.evaluate(tmp_path, jobs=1)):
        with pytest.raises(InputError) as refused:
            reader()
        assert fault.told == f"cannot be read: {refused.value}"


def test_vehicles_in_one_place_are_noted(tmp_path: Path) -> None:
    path = changed(tmp_path, within)
    found = rp.catalogue(path, among="4", classes=False, jobs=1)
    [note] = found.notes
    assert note.startswith("braking: vehicles SV and POV overlap in ")
    assert note in str(found)
    assert found.as_data()["notes"] == [note]
    told = note.partition(" overlap in ")[2]
    for trace in (read_samples(path), read_pair(f"{path}:1,2")):
        assert [x.partition(" overlap in ")[2] for x in trace.notes if " overlap in " in x] == [told]


def test_samples_in_which_a_vehicle_drives_through_another_show_nothing(tmp_path: Path) -> None:
    found = rp.catalogue(changed(tmp_path, through), among="4", classes=False, jobs=1)
    [fault] = found.tested.faults
    assert "the samples are no motion: vehicle SV drives through POV 1.4 s after" in fault.told
    assert found.exit_code == 10


def test_samples_without_contradictions_have_no_notes(tmp_path: Path) -> None:
    path = changed(tmp_path, None)
    found = rp.catalogue(path, among="4", classes=False, jobs=1)
    assert (found.missing, found.notes) == ((), ())


def test_samples_begin_as_their_first_sample_does() -> None:
    path = SAMPLES / "braking.csv"
    first = {x["vehicle"]: x for x in reversed([*csv.DictReader(path.open())])}
    found = rp.catalogue(path, among="4", classes=False, jobs=1)
    [answer] = found.concrete
    assert answer.begins["v_lon(SV)"] == pytest.approx(float(first["SV"]["v_lon"]))
    assert answer.begins["v_lon(POV)"] == pytest.approx(float(first["POV"]["v_lon"]))
    apart = float(first["POV"]["s"]) - float(first["SV"]["s"])
    assert answer.begins["s(POV) - s(SV)"] == pytest.approx(apart)


def test_the_digest_of_samples_is_that_of_both_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is empty where one of the files cannot be read."""
    path = changed(tmp_path, None)
    whole = digest_of(str(path))
    assert len(whole) == 64
    road = tmp_path / "braking_road.toml"
    road.write_text(road.read_text() + "\n")
    assert digest_of(str(path)) not in ("", whole)
    assert digest_of(str(tmp_path / "none.json")) == ""
    monkeypatch.setattr(traces, "files_of", lambda place: (path, tmp_path / "none.toml"))
    assert digest_of(str(path)) == ""


# --- Vehicles with names of their own play the roles of scenarios: as a test says, or by usual names

HOME = rp.load()
KNOWN = ("SV", "POV", "POV1", "POV2")
PAIRS, TRIPLES = ("SV", "POV"), ("SV", "POV1", "POV2")


@pytest.fixture(scope="module")
def asked() -> TargetFormulas:
    return TargetFormulas(HOME.alone, (1, 2, 3, 4), None, HOME.all_values())


def renamed(path: Path, drive: str, names: Mapping[str, str]) -> Path:
    """A drive of the example with other names of vehicles, and a formula without any."""
    data = json.loads((EXAMPLE / "drives" / f"{drive}.json").read_text("utf-8"))
    data["vehicles"] = {names[x]: data["vehicles"][x] for x in reversed(data["vehicles"])}
    path.write_text(json.dumps({**data, "scenario": None, "formula": "true"}), "utf-8")
    return path


def sampled(folder: Path, names: Mapping[str, str]) -> Path:
    text = (EXAMPLE / "samples" / "braking.csv").read_text("utf-8")
    for old, new in names.items():
        text = text.replace(f",{old},", f",{new},")
    (folder / "a.csv").write_text(text, "utf-8")
    shutil.copy(EXAMPLE / "samples" / "braking_road.toml", folder / "a_road.toml")
    return folder / "a.csv"


def looked_at(asked: TargetFormulas, path: Path, free: bool = False, **roles: str) -> ConcreteAnswer:
    return judge_test(ConcreteTest("x", str(path), roles=roles), asked, Freedom(roles=free))


@pytest.mark.parametrize(
    ("vehicles", "given", "expected"),
    [
        (["SV", "POV"], {}, {}),
        (["ego", "car"], {}, {"ego": "SV", "car": "POV"}),
        (["car", "EGO"], {}, {"EGO": "SV", "car": "POV"}),
        (["Ego_Vehicle", "t"], {}, {"Ego_Vehicle": "SV", "t": "POV"}),
        (["hero", "t"], {}, {"hero": "SV", "t": "POV"}),
        (["host", "SV"], {}, {"host": "POV"}),
        (["sv", "pov"], {}, {"sv": "SV", "pov": "POV"}),
        (["pov2", "ego", "pov1"], {}, {"ego": "SV", "pov1": "POV1", "pov2": "POV2"}),
        (["ego", "a", "b"], {}, {"ego": "SV"}),
        (["ego", "hero"], {}, {}),
        (["ego"], {}, {"ego": "SV"}),
        (["a", "b"], {}, {}),
        (["a", "b"], {"SV": "b"}, {"b": "SV", "a": "POV"}),
        (["a", "b"], {"POV": "b"}, {"a": "SV", "b": "POV"}),
        (["ego", "b"], {"POV": "ego"}, {"ego": "POV", "b": "SV"}),
        (["SV", "POV"], {"SV": "POV", "POV": "SV"}, {"SV": "POV", "POV": "SV"}),
        (["SV", "ego", "c"], {"SV": "ego"}, {"ego": "SV", "SV": "SV_1"}),
    ],
)
def test_names_and_roles(vehicles: list[str], given: dict[str, str], expected: dict[str, str]) -> None:
    assert roles_in(ConcreteTest("x", "x.csv", roles=given), vehicles, KNOWN).by_name == expected


def test_choices_keep_who_is_named() -> None:
    """All roles named, some, none; and any where it is asked for."""
    both = (PAIRS, TRIPLES)
    assert [*role_choices(both, both, ["SV", "POV", "x"], False)] == [(PAIRS, PAIRS)]
    assert [*role_choices(both, both, ["a", "SV", "b"], False)] == [
        (PAIRS, ("SV", "a")),
        (PAIRS, ("SV", "b")),
        (TRIPLES, ("SV", "a", "b")),
        (TRIPLES, ("SV", "b", "a")),
    ]
    assert [*role_choices(both, both, ["a", "b"], False)] == []
    assert [*role_choices((PAIRS,), both, TRIPLES, False, any_way=True)] == []
    assert [*role_choices((PAIRS,), both, ["a", "b"], False, any_way=True)] == [
        (PAIRS, ("a", "b")),
        (PAIRS, ("b", "a")),
    ]
    assert [*role_choices((PAIRS,), both, PAIRS, True)] == [(PAIRS, PAIRS), (PAIRS, PAIRS[::-1])]


@pytest.mark.parametrize("drive", ["braking", "cut-in", "cut-out"])
def test_other_names_show_the_same(drive: str, asked: TargetFormulas, tmp_path: Path) -> None:
    """With roles as the test says, all that is told is the same, in the names of the test."""
    original = judge_test(ConcreteTest("x", str(EXAMPLE / "drives" / f"{drive}.json")), asked, Freedom())
    names = {"SV": "ego", "POV": "blue", "POV1": "one", "POV2": "two"}
    given = {
        role: name for role, name in names.items() if (role == "POV") is (drive != "cut-out") or role == "SV"
    }
    found = looked_at(asked, renamed(tmp_path / "a.json", drive, names), **given)
    assert original.shown
    assert found.roles == given
    assert [(x.what, x.vehicles, x.lane, x.at) for x in found.shown] == [
        (x.what, tuple(names[y] for y in x.vehicles), x.lane, x.at) for x in original.shown
    ]
    assert found.begins == original.begins
    assert not any("taken as" in note for note in found.notes)


def test_usual_names_are_told(asked: TargetFormulas, tmp_path: Path) -> None:
    names = {"SV": "Ego", "POV": "lead"}
    for path in (renamed(tmp_path / "b.json", "braking", names), sampled(tmp_path, names)):
        found = looked_at(asked, path)
        assert "scenario_4" in found.names
        assert {x.vehicles for x in found.shown} == {("Ego", "lead")}
        assert found.roles == {"SV": "Ego", "POV": "lead"}
        assert "Ego is taken as SV, lead is taken as POV" in found.notes
        curves = curves_of(found.entry)
        assert curves is not None
        assert [*curves.vehicles] == ["SV", "POV"]


def test_roles_decide_what_is_shown(asked: TargetFormulas, tmp_path: Path) -> None:
    """Exchanged roles show something else, in drives and in samples, unless any roles are looked at."""
    names = {"SV": "ego", "POV": "lead"}
    for path in (renamed(tmp_path / "b.json", "braking", names), sampled(tmp_path, names)):
        turned = looked_at(asked, path, SV="lead", POV="ego")
        assert "scenario_4" not in turned.names
        free = looked_at(asked, path, True, SV="lead", POV="ego")
        assert ("scenario_4", ("ego", "lead")) in {(x.what, x.vehicles) for x in free.shown}


def test_the_vehicle_under_test_among_several(asked: TargetFormulas, tmp_path: Path) -> None:
    """Of three vehicles with one usual name the others may play any role, and it is always SV."""
    names = {"SV": "ego", "POV1": "near", "POV2": "far"}
    found = looked_at(asked, renamed(tmp_path / "a.json", "cut-out", names))
    assert ("scenario_2", ("ego", "near", "far")) in {(x.what, x.vehicles) for x in found.shown}
    assert {x.vehicles[0] for x in found.shown} == {"ego"}


def test_names_that_are_no_roles_are_noted(asked: TargetFormulas, tmp_path: Path) -> None:
    found = looked_at(asked, renamed(tmp_path / "a.json", "braking", {"SV": "red", "POV": "blue"}))
    assert found.shown == ()
    assert any("no vehicle is called as a role" in note and "red, blue" in note for note in found.notes)


def test_obstacles_play_roles_by_number(asked: TargetFormulas) -> None:
    path = EXAMPLE / "samples" / "cut-in.xml"
    right, turned = looked_at(asked, path, SV="1", POV="2"), looked_at(asked, path, SV="2", POV="1")
    assert {x.vehicles for x in right.shown} == {("1", "2")}
    assert "scenario_1" in right.names
    assert {x.vehicles for x in turned.shown} <= {("2", "1")}
    assert "scenario_1" not in turned.names
    assert {x.vehicles for x in looked_at(asked, path, SV="2").shown} <= {("2", "1")}


@pytest.mark.parametrize(
    ("name", "roles", "told"),
    [
        ("drives/braking.json", {"SV": "eggo"}, "there is no vehicle 'eggo'; there are POV, SV"),
        ("drives/braking.json", {"EGO": "SV"}, "there is no role 'EGO'; there are POV, POV1, POV2, SV"),
        ("samples/braking.csv", {"SV": "POVV"}, "there is no vehicle 'POVV'; did you mean 'POV'?"),
        ("samples/cut-in.xml", {"SV": "7"}, "there is no vehicle '7'; there are 1, 2"),
        ("samples/cut-in.xml:1,2", {"SV": "1"}, "the order of the vehicles says their roles"),
    ],
)
def test_unknown_names_are_a_fault(
    name: str, roles: dict[str, str], told: str, asked: TargetFormulas
) -> None:
    found = judge_test(ConcreteTest("x", str(EXAMPLE / name), roles=roles), asked, Freedom())
    assert found.shown == ()
    assert found.fault.startswith(f"{EXAMPLE / name}: roles")
    assert told in found.fault


def test_roles_are_in_the_answer_and_checked(tmp_path: Path) -> None:
    """A changed role is rejected, and so is an answer whose tests have other roles now."""
    tests, out = tmp_path / "tests", tmp_path / "out"
    tests.mkdir()
    renamed(tests / "a.json", "braking", {"SV": "red", "POV": "blue"})
    entry = "[[test]]\nid = 'A'\nfile = 'a.json'\nclaims = [4]\n"
    (tests / "catalogue.toml").write_text(f"{entry}roles = {{ SV = 'red' }}\n", "utf-8")
    found = rp.catalogue(tests, among="4", classes=False, jobs=1, out=out)
    assert found.exit_code == 0
    assert "A: blue is taken as POV" in found.notes
    assert {x.vehicles for _, x in found.decisions} == {("red", "blue")}
    index = folder_data(out)
    assert index["tests"][0]["roles"] == {"SV": "red", "POV": "blue"}
    assert {tuple(x["vehicles"]) for x in index["tests"][0]["shown"]} == {("red", "blue")}
    assert main(["check", str(out), "--jobs", "1"]) == 0
    (tests / "catalogue.toml").write_text(f"{entry}roles = {{ SV = 'blue' }}\n", "utf-8")
    assert main(["check", str(out), "--jobs", "1"]) == 10


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"SV": "11", "POV": "12"}, [("11", "12")]),
        ({"SV": "11", "POV1": "13", "POV2": "12"}, [("11", "13", "12")]),
        ({"SV": "11"}, [("11", "12"), ("11", "13"), ("11", "12", "13"), ("11", "13", "12")]),
        ({"SV": "11", "POV1": "12"}, [("11", "13"), ("11", "12", "13")]),
    ],
)
def test_choices_of_obstacles(
    given: dict[str, str], expected: list[tuple[str, ...]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of three obstacles: those alone that play all roles, or all choices that keep who is named."""
    frames = {"first_frame": [0] * 3, "last_frame": [9] * 3, "direction": [0] * 3}
    recording: Any = SimpleNamespace(vehicles=3, vehicle_id=[11, 12, 13], **frames)
    monkeypatch.setattr(traces, "cut_trace", lambda recording, place, vehicles, frames: vehicles)
    entry = ConcreteTest("x", "a.xml", roles=given)
    assert [tuple(told.values()) for _, told in traces._all_of(recording, entry, KNOWN)] == expected
    monkeypatch.setattr(traces, "MOST_VEHICLES", 2)
    if len(expected) == 1:
        more = {name: [*values, values[0]] for name, values in frames.items()}
        crowd: Any = SimpleNamespace(vehicles=4, vehicle_id=[11, 12, 13, 14], **more)
        assert len([*traces._all_of(crowd, entry, KNOWN)]) == 1
    else:
        with pytest.raises(InputError, match="3 vehicles, but of at most 2"):
            [*traces._all_of(recording, entry, KNOWN)]
