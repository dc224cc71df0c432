"""Vehicles with names of their own play the roles of scenarios: as a test says, or by usual names."""

import json
import shutil
from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import roadproof as rp
from roadproof.analysis.catalogue import traces
from roadproof.analysis.catalogue.asked import Questions
from roadproof.analysis.catalogue.entries import Concrete
from roadproof.analysis.catalogue.playing import choices, roles_of
from roadproof.analysis.catalogue.showing import ConcreteAnswer, Freedom, show
from roadproof.analysis.catalogue.traces import courses_of
from roadproof.errors import InputError
from roadproof.frontends.cli.main import main

HOME = rp.load()
EXAMPLE = Path(__file__).parents[2] / "examples" / "catalogue" / "tests"
KNOWN = ("SV", "POV", "POV1", "POV2")
PAIRS, TRIPLES = ("SV", "POV"), ("SV", "POV1", "POV2")


@pytest.fixture(scope="module")
def asked() -> Questions:
    return Questions(HOME.alone, (1, 2, 3, 4), None, HOME.all_values())


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


def looked_at(asked: Questions, path: Path, free: bool = False, **roles: str) -> ConcreteAnswer:
    return show(Concrete("x", str(path), roles=roles), asked, Freedom(roles=free))


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
    assert roles_of(Concrete("x", "x.csv", roles=given), vehicles, KNOWN).by_name == expected


def test_choices_keep_who_is_named() -> None:
    """All roles named, some, none; and any where it is asked for."""
    both = (PAIRS, TRIPLES)
    assert [*choices(both, both, ["SV", "POV", "x"], False)] == [(PAIRS, PAIRS)]
    assert [*choices(both, both, ["a", "SV", "b"], False)] == [
        (PAIRS, ("SV", "a")),
        (PAIRS, ("SV", "b")),
        (TRIPLES, ("SV", "a", "b")),
        (TRIPLES, ("SV", "b", "a")),
    ]
    assert [*choices(both, both, ["a", "b"], False)] == []
    assert [*choices((PAIRS,), both, TRIPLES, False, any_way=True)] == []
    assert [*choices((PAIRS,), both, ["a", "b"], False, any_way=True)] == [
        (PAIRS, ("a", "b")),
        (PAIRS, ("b", "a")),
    ]
    assert [*choices((PAIRS,), both, PAIRS, True)] == [(PAIRS, PAIRS), (PAIRS, PAIRS[::-1])]


@pytest.mark.parametrize("drive", ["braking", "cut-in", "cut-out"])
def test_other_names_show_the_same(drive: str, asked: Questions, tmp_path: Path) -> None:
    """With roles as the test says, all that is told is the same, in the names of the test."""
    original = show(Concrete("x", str(EXAMPLE / "drives" / f"{drive}.json")), asked, Freedom())
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


def test_usual_names_are_told(asked: Questions, tmp_path: Path) -> None:
    names = {"SV": "Ego", "POV": "lead"}
    for path in (renamed(tmp_path / "b.json", "braking", names), sampled(tmp_path, names)):
        found = looked_at(asked, path)
        assert "scenario_4" in found.names
        assert {x.vehicles for x in found.shown} == {("Ego", "lead")}
        assert found.roles == {"SV": "Ego", "POV": "lead"}
        assert "Ego is taken as SV, lead is taken as POV" in found.notes
        courses = courses_of(found.entry)
        assert courses is not None
        assert [*courses.vehicles] == ["SV", "POV"]


def test_roles_decide_what_is_shown(asked: Questions, tmp_path: Path) -> None:
    """Exchanged roles show something else, in drives and in samples, unless any roles are looked at."""
    names = {"SV": "ego", "POV": "lead"}
    for path in (renamed(tmp_path / "b.json", "braking", names), sampled(tmp_path, names)):
        turned = looked_at(asked, path, SV="lead", POV="ego")
        assert "scenario_4" not in turned.names
        free = looked_at(asked, path, True, SV="lead", POV="ego")
        assert ("scenario_4", ("ego", "lead")) in {(x.what, x.vehicles) for x in free.shown}


def test_the_vehicle_under_test_among_several(asked: Questions, tmp_path: Path) -> None:
    """Of three vehicles with one usual name the others may play any role, and it is always SV."""
    names = {"SV": "ego", "POV1": "near", "POV2": "far"}
    found = looked_at(asked, renamed(tmp_path / "a.json", "cut-out", names))
    assert ("scenario_2", ("ego", "near", "far")) in {(x.what, x.vehicles) for x in found.shown}
    assert {x.vehicles[0] for x in found.shown} == {"ego"}


def test_names_that_are_no_roles_are_noted(asked: Questions, tmp_path: Path) -> None:
    found = looked_at(asked, renamed(tmp_path / "a.json", "braking", {"SV": "red", "POV": "blue"}))
    assert found.shown == ()
    assert any("no vehicle is called as a role" in note and "red, blue" in note for note in found.notes)


def test_obstacles_play_roles_by_number(asked: Questions) -> None:
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
def test_unknown_names_are_a_fault(name: str, roles: dict[str, str], told: str, asked: Questions) -> None:
    found = show(Concrete("x", str(EXAMPLE / name), roles=roles), asked, Freedom())
    assert found.shown == ()
    assert found.fault.startswith(f"{EXAMPLE / name}: roles")
    assert told in found.fault


def test_roles_are_in_the_index_and_checked(tmp_path: Path) -> None:
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
    index: dict[str, Any] = json.loads((out / "index.json").read_text("utf-8"))
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
    entry = Concrete("x", "a.xml", roles=given)
    assert [tuple(told.values()) for _, told in traces._all_of(recording, entry, KNOWN)] == expected
    monkeypatch.setattr(traces, "MOST_VEHICLES", 2)
    if len(expected) == 1:
        more = {name: [*values, values[0]] for name, values in frames.items()}
        crowd: Any = SimpleNamespace(vehicles=4, vehicle_id=[11, 12, 13, 14], **more)
        assert len([*traces._all_of(crowd, entry, KNOWN)]) == 1
    else:
        with pytest.raises(InputError, match="3 vehicles, but of at most 2"):
            [*traces._all_of(recording, entry, KNOWN)]
