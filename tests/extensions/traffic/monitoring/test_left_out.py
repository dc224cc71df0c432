"""Parts that are left out of a file are in every answer, and end a strict reading with an exit code."""

import json
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from roadproof.extensions.assurance.folder_view import folder_data
from roadproof.frontends.cli.main import main

DRIVE = Path(__file__).parents[4] / "examples" / "traffic" / "drives" / "scenario-01-base.json"
SLIP = "<slipAngle><exact>0.3</exact></slipAngle>"
INPUT, UNEXPECTED = 3, 10
"""The exit codes of files that are refused, and of tests with a fault."""


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[Path, str]]:
    """By format a file with a part that is not read, and what notes call it."""
    folder = tmp_path_factory.mktemp("files")
    rp.export([DRIVE], ["openscenario", "commonroad", "csv"], folder)
    csv, xml, xosc = (next(folder.rglob(f"*{x}")) for x in (".csv", ".xml", ".xosc"))
    header, *rows = csv.read_text("utf-8").splitlines()
    csv.write_text("".join(f"{x}\n" for x in (f"{header},j_lon", *(f"{x},0" for x in rows))), "utf-8")
    xml.write_text(xml.read_text("utf-8").replace("</velocity>", f"</velocity>{SLIP}"), "utf-8")
    xodr = next(folder.rglob("*.xodr"))
    for path in folder.rglob("*.xodr"):
        path.write_text(path.read_text("utf-8").replace("<lane id=", '<lane direction="both" id='), "utf-8")
    assert "both" in xodr.read_text("utf-8")
    return {"CSV": (csv, "column j_lon"), "CommonRoad": (xml, "slipAngle"), "map": (xosc, "lane@direction")}


@pytest.mark.parametrize("name", ["CSV", "CommonRoad", "map"])
@pytest.mark.parametrize("command", ["monitor", "evaluate", "catalogue"])
def test_what_is_left_out_is_in_the_answer(
    files: dict[str, tuple[Path, str]], name: str, command: str, tmp_path: Path
) -> None:
    path, part = files[name]
    out = tmp_path / "answer.json"
    match command:
        case "monitor":
            main(["monitor", "1", f"{path}:1,2", "--json", str(out)])
        case "evaluate":
            main(["evaluate", str(path), "--out", str(tmp_path / "out"), "--json", str(out)])
        case _:
            main(["catalogue", str(path), "--no-classes", "--drivers", "none", "--json", str(out)])
    answer: Any = json.loads(out.read_text("utf-8"))
    told = answer["left_out"]
    lines = [x for each in told.values() for x in each] if isinstance(told, dict) else told
    assert any("left out" in x and part in x for x in lines), told
    page = tmp_path / "page.html"
    assert main(["report", str(out), "--out", str(page)]) == 0
    assert part in page.read_text("utf-8")


@pytest.mark.parametrize("name", ["CSV", "CommonRoad", "map"])
@pytest.mark.parametrize("command", ["monitor", "evaluate"])
def test_a_strict_reading_refuses_the_file(
    files: dict[str, tuple[Path, str]],
    name: str,
    command: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path, part = files[name]
    asked = ["1", f"{path}:1,2"] if command == "monitor" else [str(path), "--out", str(tmp_path / "out")]
    assert main([command, *asked, "--strict"]) == INPUT
    assert part in capsys.readouterr().err


@pytest.mark.parametrize("name", ["CSV", "CommonRoad", "map"])
def test_a_strict_catalogue_counts_the_test_as_a_fault(
    files: dict[str, tuple[Path, str]], name: str, tmp_path: Path
) -> None:
    """All other tests are judged; the folder says how it was read, and `check` reads it so again."""
    path, part = files[name]
    out = tmp_path / "out"
    other = tmp_path / "other.json"
    other.write_bytes(DRIVE.read_bytes())
    asked = ["catalogue", str(path), str(other), "--among", "1", "--no-classes", "--drivers", "none"]
    assert main([*asked, "--no-pictures", "--out", str(out)]) == 0
    assert main([*asked, "--no-pictures", "--strict", "--out", str(tmp_path / "strict")]) == UNEXPECTED
    [told] = folder_data(tmp_path / "strict")["faults"]
    assert part in told["told"]
    assert told["told"].startswith("cannot be read")
    assert main(["check", str(out)]) == main(["check", str(tmp_path / "strict")]) == 0
    page = tmp_path / "page.html"
    assert main(["report", str(tmp_path / "strict"), "--out", str(page)]) == 0
    assert part in page.read_text("utf-8")


MOTORWAY = Path(__file__).parents[4] / "examples" / "maps" / "motorway.xodr"
PART = "lane@direction"
FORMULA = "v_lon(SV) > 1 m/s and atLane(SV,L)"
ON_A_MAP = {
    "witness": ["witness", FORMULA],
    "prove": ["prove", f"{FORMULA} -> F v_lon(SV) > 30 m/s", "--engine", "milp", "--horizon", "1.8"],
    "compare": ["compare", "v_lon(SV) > 1 m/s", "v_lon(SV) > 2 m/s"],
    "explore": ["explore", FORMULA, "--least", "v_lon(SV)", "--precision", "5"],
    "coverage": ["coverage", "--set", "complete"],
}
"""A question of each command that takes the road of a map."""


@pytest.fixture(scope="module")
def stretch(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A stretch of a map with a part that is not read."""
    path = tmp_path_factory.mktemp("map") / "map.xodr"
    path.write_text(MOTORWAY.read_text("utf-8").replace("<lane ", '<lane direction="both" ', 30), "utf-8")
    return f"{path}#road=1"


@pytest.mark.parametrize("command", [*ON_A_MAP, "road", "compile"])
def test_what_is_left_out_of_a_map_is_said_of_its_road(
    command: str, stretch: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, monitors = tmp_path / "answer.json", ["--out", str(tmp_path / "c")]
    match command:
        case "road":
            asked = ["road", stretch, "--json", str(out)]
        case "compile":
            asked = ["compile", FORMULA, "--road", stretch, "--lane", "L=main-1", *monitors]
        case _:
            asked = [*ON_A_MAP[command], "--road", stretch, "--json", str(out)]
    plain = main(asked)
    [note] = [x for x in capsys.readouterr().err.splitlines() if PART in x]
    assert note.startswith("note: left out of map.xodr")
    assert plain != INPUT
    if command != "compile":
        [told] = json.loads(out.read_text("utf-8"))["left_out"]
        assert f"note: {told}" == note
        if command != "road":
            page = tmp_path / "page.html"
            assert main(["report", str(out), "--out", str(page)]) in (0, 20)
            assert page.read_text("utf-8").count(PART) >= 1
    assert main([*asked, "--strict"]) == INPUT
    assert PART in capsys.readouterr().err


def test_nothing_is_said_of_a_map_that_is_read_whole(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "answer.json"
    asked = [*ON_A_MAP["witness"], "--road", f"{MOTORWAY}#road=1", "--json", str(out), "--strict"]
    assert main(asked) == 0
    assert "left out" not in capsys.readouterr().err
    assert "left_out" not in json.loads(out.read_text("utf-8"))


def test_a_formula_of_a_catalogue_on_a_map_says_what_is_left_out(stretch: str, tmp_path: Path) -> None:
    (tmp_path / "tests.toml").write_text(
        f'[[test]]\nid = "ON-MAP"\nformula = "{FORMULA}"\nroad = "{stretch}"\n', "utf-8"
    )
    asked = {"among": "4", "classes": False, "drivers": ()}
    found = rp.catalogue(tmp_path / "tests.toml", **asked)
    [told] = found.left_out
    assert told.startswith("ON-MAP: left out of map.xodr")
    assert PART in told
    assert [x.tests for x in found.tested.faults if PART in x.told] == []
    strict = rp.catalogue(tmp_path / "tests.toml", strict=True, **asked)
    assert [x.tests for x in strict.tested.faults if PART in x.told] == [("ON-MAP",)]


def test_samples_in_python_say_what_is_left_out_of_their_road(stretch: str) -> None:
    columns = {x: [0.0, 0.0] for x in ("s", "d", "v_lon", "v_lat", "a_lon", "a_lat")}
    columns |= {"time": [0.0, 0.1], "length": [4.0, 4.0], "width": [2.0, 2.0]}
    found = rp.monitor("v_lon(SV) >= 0 m/s", rp.trace({**columns, "vehicle": ["SV", "SV"]}, stretch))
    assert PART in found.left_out[0]
