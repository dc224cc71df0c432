"""roadproof witness and compare from the command line."""

import json

import pytest

from roadproof.evidence.drive_file import SCHEMA, load_drive
from roadproof.frontends.cli.main import main


def run(capsys, *arguments):
    code = main(list(arguments))
    captured = capsys.readouterr()
    return code, captured.out, captured.err


def test_a_drive_is_written_and_accepted(tmp_path, capsys):
    code, out, _ = run(capsys, "witness", "4", "--out", str(tmp_path))
    assert code == 0
    assert "WITNESSED" in out
    assert {p.suffix for p in tmp_path.iterdir() if p.is_file()} == {".json", ".csv", ".png", ".svg"}
    file = load_drive(tmp_path / "scenario-04-base.json")
    assert file.scenario == 4
    rows = (tmp_path / "scenario-04-base.csv").read_text("utf-8").splitlines()
    assert rows[0] == "time,vehicle,s,d,v_lon,v_lat,a_lon,a_lat,length,width"
    assert len(rows) == 1 + 2 * 151
    assert (tmp_path / "scenario-04-base.png").read_bytes().startswith(b"\x89PNG")
    assert b"<svg" in (tmp_path / "scenario-04-base.svg").read_bytes()
    assert run(capsys, "check", str(tmp_path))[0] == 0


def test_json_has_verdicts_and_drives(tmp_path, capsys):
    target = tmp_path / "answer.json"
    sets = ("--set", "base", "--set", "ext")
    code, _, _ = run(capsys, "witness", "3", *sets, "--jobs", "1", "--json", str(target))
    assert code == 0
    data = json.loads(target.read_text("utf-8"))
    assert data["schema"] == "roadproof/witness/1"
    assert [(v["scenario"], v["set"], v["verdict"]) for v in data["verdicts"]] == [
        (3, "base", "WITNESSED"),
        (3, "ext", "WITNESSED"),
    ]
    assert all(v["drives"][0]["schema"] == SCHEMA for v in data["verdicts"])
    assert all(v["seconds"]["all"] > 0 and v["sizes"]["inequalities"] > 0 for v in data["verdicts"])


def test_a_list_of_scenarios_gives_a_drive_for_each(capsys):
    code, out, _ = run(capsys, "witness", "3-4,7", "--jobs", "1")
    assert code == 0
    assert [line.split()[:2] for line in out.splitlines() if line.startswith("scenario")] == [
        ["scenario", "3"],
        ["scenario", "4"],
        ["scenario", "7"],
    ]
    assert out.endswith("3 of 3 witnessed in " + out.rpartition("witnessed in ")[2])
    assert run(capsys, "witness", "1,99")[::2] == (
        3,
        "roadproof: there is no scenario '99'; did you mean '9'?\n",
    )
    assert run(capsys, "witness", "1-")[::2] == (
        2,
        "roadproof: '1-' is not a range of scenarios; write 1-8 or 1,3-8\n",
    )


def test_impossible_names_its_core_and_is_unexpected(capsys):
    code, out, _ = run(capsys, "witness", "scenario_1(SV,POV,L) and scenario_4(SV,POV,L)")
    assert code == 10
    assert "IMPOSSIBLE" in out
    assert "minimal core" in out
    assert "not sameLane(POV, SV, L)" in out


def test_none_within_prints_its_limits(capsys):
    code, out, _ = run(capsys, "witness", "F v_lon(SV) > 41 m/s", "--road", "main-3")
    assert code == 10
    assert "NONE-WITHIN" in out
    assert "road main-3" in out


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (("witness",), 2, "name scenarios or formulas"),
        (("witness", "4", "--all"), 2, "but not both"),
        (("witness", "4", "--solver", "magic"), 2, "unknown solver; choose one of"),
        (("witness", "4", "--solver", "gurobi"), 4, "gurobipy"),
        (("witness", "4", "--dt", "0"), 2, "greater than 0"),
        (("witness", "4", "--dt", "1e9"), 2, "greater than 0"),
        (("witness", "4", "--horizon", "7", "--dt", "3/5"), 2, "no multiple of dt"),
        (("witness", "4", "--param", "minDanger=0.5", "--dt", "3/5"), 2, "dt=1/10"),
        (("witness", "4", "--count", "0"), 2, "--count"),
        (("witness", "4", "--timeout", "-1"), 2, "--timeout"),
        (("witness", "4", "--lane", "main-7"), 2, "has the lanes"),
        (("witness", "4", "--road", "nowhere"), 3, "there is no road"),
        (("witness", "4", "--vehicle", "SV=tank"), 3, "there is no vehicle"),
        (("witness", "4", "--out", "/proc/none"), 3, "cannot write into /proc/none"),
        (("witness", "99"), 3, "scenario_99"),
        (("witness", "scenario_4(SV,POV"), 3, "ends too early"),
        (("witness", "4", "--set", "extB"), 3, "extB"),
        (("compare", "3", "4", "--set", "a", "--set", "b", "--set", "c"), 2, "at most two"),
    ],
)
def test_mistakes_are_explained(capsys, arguments, code, message):
    found, _, err = run(capsys, *arguments)
    assert found == code
    assert message in err
    assert "Traceback" not in err


@pytest.mark.parametrize(
    ("arguments", "relation"),
    [
        (("scenario_3(SV,POV,L)", "scenario_4(POV,SV,L)"), "equivalent"),
        (("scenario_3(SV,POV,L)", "scenario_4(POV,SV,L)", "--set", "extA"), "incomparable"),
        (("4", "4", "--set", "base", "--set", "ext"), "stronger"),
        (("dangerArises(SV,POV)", "scenario_3(SV,POV,L)"), "weaker"),
    ],
)
def test_comparisons_come_with_evidence(capsys, tmp_path, arguments, relation):
    target, folder = tmp_path / "answer.json", tmp_path / "out"
    code, out, _ = run(capsys, "compare", *arguments, "--json", str(target), "--out", str(folder))
    assert code == 0
    assert relation in out
    data = json.loads(target.read_text("utf-8"))
    assert data["relation"] == relation
    for direction in (data["forward"], data["backward"]):
        assert (direction["certificate"] is None) != (direction["drive"] is None)
    assert len(list(folder.iterdir())) == 2
    assert run(capsys, "check", str(folder))[0] == 0
