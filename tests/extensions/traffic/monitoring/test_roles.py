"""Vehicles with names of their own play the roles of a formula, in every kind of file of one trace."""

import json
import re
from collections.abc import Mapping
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import InputError, TextError, UsageError
from roadproof.evidence.drive_file import load_drive
from roadproof.extensions.traffic.simulate.planting import with_roles
from roadproof.frontends.cli.main import main
from roadproof.library.loading import bundled_library
from roadproof.library.roles import assign_roles, vehicle_order, with_vehicles
from roadproof.verdict import ExitCode

DRIVES = Path(__file__).parents[4] / "examples" / "catalogue" / "tests" / "drives"
PAIR = {"SV": "Ego", "POV": "Target"}
TRIPLE = {"SV": "hero", "POV1": "near", "POV2": "far"}


def renamed(path: Path, drive: str, names: Mapping[str, str]) -> Path:
    """A drive file whose vehicles, and those of its formula, have other names; the last comes first."""
    content = json.loads((DRIVES / f"{drive}.json").read_text("utf-8"))
    content["vehicles"] = {names[x]: y for x, y in reversed(content["vehicles"].items())}
    content["formula"] = re.sub(r"SV|POV\d?", lambda x: names[x[0]], content["formula"])
    path.write_text(json.dumps(content), "utf-8")
    return path


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The drive of a cut-in with vehicles Ego and Target, in every format that has names."""
    folder = tmp_path_factory.mktemp("files")
    drive = renamed(folder / "cut-in.json", "cut-in", PAIR)
    assert main(["export", str(drive), *(["--to", "openscenario", "--to", "csv"]), "--out", str(folder)]) == 0
    return {
        ".json": drive,
        ".xosc": folder / "openscenario" / "cut-in.xosc",
        ".csv": folder / "csv" / "cut-in.csv",
    }


@pytest.mark.parametrize("ending", [".json", ".xosc", ".csv"])
def test_the_usual_name_is_the_vehicle_under_test(files: dict[str, Path], ending: str) -> None:
    """Ego is SV and the other one POV; the answer says so, and is that of the drive with the usual names."""
    found = rp.monitor(1, files[ending])
    assert found.verdict == "true"
    assert dict(found.place.roles) == PAIR
    assert "SV: vehicle Ego; POV: vehicle Target" in str(found)
    assert found.as_data()["roles"] == PAIR
    turned = rp.monitor(1, files[ending], roles={"SV": "Target", "POV": "Ego"})
    assert turned.verdict != "true"
    assert dict(turned.place.roles) == {"SV": "Target", "POV": "Ego"}


@pytest.mark.parametrize("ending", [".json", ".xosc", ".csv"])
def test_a_formula_may_use_the_names_of_the_file(files: dict[str, Path], ending: str) -> None:
    found = rp.monitor("scenario_1(Ego, Target, L) and v_lon(Ego) > 0", files[ending])
    assert (found.verdict, dict(found.place.roles)) == ("true", {})
    assert "roles" not in found.as_data()
    with pytest.raises(TextError, match="there is no vehicle 'Eho'"):
        rp.monitor("scenario_1(Eho, Target, L)", files[ending])


def test_the_drive_with_usual_names_says_nothing_of_roles() -> None:
    found = rp.monitor(1, DRIVES / "cut-in.json")
    assert "roles" not in found.as_data()
    assert "vehicle" not in str(found.place)


def test_the_lane_of_a_vehicle_by_either_name(files: dict[str, Path]) -> None:
    by_role, by_name = (rp.monitor(1, files[".csv"], lanes={"L": x}) for x in ("POV", "Target"))
    assert by_role.place.lanes == by_name.place.lanes != rp.monitor(1, files[".csv"]).place.lanes


def test_vehicles_of_recordings_by_role(tmp_path: Path) -> None:
    drive = renamed(tmp_path / "cut-in.json", "cut-in", PAIR)
    assert main(["export", str(drive), "--to", "highd", "--out", str(tmp_path)]) == 0
    tracks = tmp_path / "01_tracks.csv"
    named = rp.monitor(1, tracks, roles={"POV": "2", "SV": "1"})
    assert (named.verdict, dict(named.place.roles)) == ("true", {"SV": "1", "POV": "2"})
    ordered = rp.monitor(1, f"{tracks}:1,2")
    assert (ordered.verdict, ordered.place.roles) == (named.verdict, named.place.roles)
    with pytest.raises(UsageError, match="the order of the vehicles"):
        rp.monitor(1, f"{tracks}:1,2", roles={"SV": "2"})
    with pytest.raises(UsageError, match="vehicles of recordings have numbers"):
        rp.monitor(1, tracks, roles=PAIR)


@pytest.mark.parametrize(
    ("vehicles", "wanted", "given", "expected"),
    [
        (["SV", "POV"], ["POV", "SV"], {}, {}),
        (["b", "Ego"], ["POV", "SV"], {}, {"Ego": "SV", "b": "POV"}),
        (["b", "ego", "a"], ["POV1", "POV2", "SV"], {}, {"ego": "SV", "b": "POV1", "a": "POV2"}),
        (["b", "ego", "a"], ["POV1", "POV2", "SV"], {"POV1": "a"}, {"ego": "SV", "a": "POV1", "b": "POV2"}),
        (["b", "ego", "a"], ["POV", "SV"], {"POV": "a"}, {"ego": "SV", "a": "POV"}),
        (["Ego", "x"], ["Ego", "POV"], {}, {"x": "POV"}),
        (["ego"], ["POV", "SV"], {}, {"ego": "SV"}),
        (["SV", "POV"], ["POV", "SV"], {"SV": "POV", "POV": "SV"}, {"SV": "POV", "POV": "SV"}),
    ],
)
def test_the_rule(
    vehicles: list[str], wanted: list[str], given: dict[str, str], expected: dict[str, str]
) -> None:
    assert dict(assign_roles(vehicles, wanted, given, "here").by_name) == expected


@pytest.mark.parametrize(
    ("vehicles", "wanted", "given", "told"),
    [
        (["hero", "a", "b"], ["POV", "SV"], {}, "called as POV; vehicles are hero, a, b; .*SV=hero,POV=a"),
        (["a", "b"], ["POV", "SV"], {}, "called as POV, SV; .*SV=a,POV=b"),
        (["ego", "hero"], ["POV", "SV"], {}, "called as POV, SV"),
        (["ego", "car"], ["POV", "SV"], {"SV": "cat"}, "no vehicle 'cat'; did you mean 'car'"),
        (["ego", "car"], ["POV", "SV"], {"POV2": "car"}, "no role 'POV2'; did you mean 'POV'"),
        (["ego", "car"], ["POV", "SV"], {"SV": "car", "POV": "car"}, "car is SV and POV"),
    ],
)
def test_unclear_roles_are_refused(
    vehicles: list[str], wanted: list[str], given: dict[str, str], told: str
) -> None:
    with pytest.raises(InputError, match=f"^here.*{told}"):
        assign_roles(vehicles, wanted, given, "here")


def test_three_vehicles_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = str(renamed(tmp_path / "cut-out.json", "cut-out", TRIPLE))
    by_name = {"SV": "hero", "POV1": "far", "POV2": "near"}  # the file has them in this order
    assert main(["monitor", "2", path, "--json", str(tmp_path / "a.json")]) == ExitCode.UNEXPECTED
    assert json.loads((tmp_path / "a.json").read_text("utf-8"))["roles"] == by_name
    assert main(["monitor", "2", path, "--roles", "POV1=near,POV2=far"]) == ExitCode.AS_EXPECTED
    assert "SV: vehicle hero; POV1: vehicle near; POV2: vehicle far" in capsys.readouterr().out
    for wrong in ("SV", "SV=a,SV=b", "SV=,POV=a", ""):
        assert main(["monitor", "2", path, "--roles", wrong]) == ExitCode.USAGE
        assert "write NAME=VALUE with commas" in capsys.readouterr().err


def test_drives_in_python_keep_their_names(tmp_path: Path) -> None:
    """A drive of a scenario by number, out of vehicles with names of their own, is judged and checked."""
    original = load_drive(DRIVES / "cut-in.json")
    vehicles = {PAIR[x]: y for x, y in original.drive.vehicles.items()}
    made = rp.drive(1, vehicles, road=original.road, horizon=original.horizon)
    assert made.file.scenario == 1
    assert made.file.formula == "given Ego, Target: vehicle: scenario_1(Ego, Target, L)"
    (tmp_path / "made.json").write_text(json.dumps(made.as_data()), "utf-8")
    assert rp.check(tmp_path / "made.json").accepted
    with pytest.raises(InputError, match="SV=a,POV=b"):
        rp.drive(1, dict(zip("ab", vehicles.values(), strict=True)))


def test_other_formulas_with_the_number_of_a_scenario_are_rejected(tmp_path: Path) -> None:
    """The names may be others; the order of the vehicles and the number may not."""
    original = load_drive(DRIVES / "cut-in.json")
    vehicles = {PAIR[x]: y for x, y in original.drive.vehicles.items()}
    data = rp.drive(1, vehicles, road=original.road, horizon=original.horizon).as_data()
    for number, accepted in ((1, True), (3, False)):
        (tmp_path / "a.json").write_text(json.dumps({**data, "scenario": number}), "utf-8")
        [finding] = rp.check(tmp_path / "a.json").findings
        assert ("its formula is another" in finding.reason) is not accepted


def test_drives_are_planted_by_role(tmp_path: Path) -> None:
    library = bundled_library()
    file = load_drive(renamed(tmp_path / "cut-in.json", "cut-in", PAIR))
    planted, usual = with_roles(file, library), load_drive(DRIVES / "cut-in.json")
    assert planted.formula == usual.formula
    assert planted.drive.vehicles == usual.drive.vehicles
    assert with_roles(usual, library) is usual


def test_formulas_declare_the_vehicles_of_their_file() -> None:
    names = ["Ego", "POV", "bus"]
    assert with_vehicles("danger(Ego, POV)", names) == "given Ego: vehicle: danger(Ego, POV)"
    assert with_vehicles("danger(SV, POV)", names) == "danger(SV, POV)"
    given = "given Ego: vehicle: danger(Ego, POV)"
    assert with_vehicles(given, names) == given
    both = with_vehicles("given Ego: vehicle: danger(Ego, bus)", names)
    assert rp.load().read(both).vehicles == ("bus", "Ego")
    assert with_vehicles("danger(Ego,", names) == "danger(Ego,"


def test_the_vehicle_under_test_is_numbered_first() -> None:
    assert vehicle_order(["b", "Ego", "a"]) == ["Ego", "a", "b"]
    assert vehicle_order(["ego", "hero", "a"]) == ["a", "ego", "hero"]
    assert vehicle_order(["ego", "SV"]) == ["SV", "ego"]
