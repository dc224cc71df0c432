"""Parts that are left out of a file are in every answer, and end a strict reading with an exit code."""

import json
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from roadproof.frontends.cli.main import main

DRIVE = Path(__file__).parents[2] / "examples" / "traffic" / "drives" / "scenario-01-base.json"
SLIP = "<slipAngle><exact>0.3</exact></slipAngle>"
INPUT = 3
"""The exit code of files that are refused."""


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
