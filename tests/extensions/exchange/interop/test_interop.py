"""The job of ``make interop`` without its clients: reports, damage, environments, and what is expected."""

import json
from pathlib import Path

import pytest

from extensions.exchange.exporting.shipped_drives import motion, shipped_drives, subject, subjects
from extensions.exchange.exporting.test_opendrive import boxes
from extensions.exchange.exporting.test_opendrive import openscenario_root as root_of
from extensions.exchange.interop.clients.asam_report import issues_in
from extensions.exchange.interop.damage import DAMAGES
from extensions.exchange.interop.environments import Client, clients, python_of
from extensions.exchange.interop.expected import expected
from roadproof.extensions.exchange.export.registry import FORMATS

REPORT = """<CheckerResults><CheckerBundle>{}</CheckerBundle></CheckerResults>"""
FINE = '<Checker status="completed" checkerId="c" summary="0 issue(s) are found."/>'
LATER = '<Checker status="skipped" checkerId="d" summary="1.7 is not valid according to definition setting"/>'


def report(path: Path, *checkers: str) -> list[str]:
    path.write_text(REPORT.format("".join(checkers)), "utf-8")
    return issues_in(path)


def test_issues_are_counted_in_reports(tmp_path: Path) -> None:
    path = tmp_path / "x.xqar"
    assert report(path, *[FINE] * 12, LATER) == []
    found = '<Checker status="completed" checkerId="e"><Issue description="bad"/></Checker>'
    assert report(path, *[FINE] * 12, found) == ["e: bad"]
    skipped = '<Checker status="skipped" checkerId="f" summary="Preconditions are not satisfied."/>'
    assert report(path, *[FINE] * 12, skipped) == ["f: skipped"]
    assert report(path, FINE) == ["only 1 checkers are in the report"]


def test_every_client_has_damage_that_changes_its_files() -> None:
    assert [*DAMAGES] == [x.name for x in clients()]
    for client in clients():
        made = next(x for x in subjects() if x.name == "scenario-12-base")
        (text,) = [
            content.decode()
            for name, content in FORMATS[client.format](made).items()
            if Path(name).match(client.files)
        ]
        for what, damage in DAMAGES[client.name].items():
            assert damage(text) != text, what


def test_what_cannot_be_installed_is_skipped_with_a_reason(tmp_path: Path) -> None:
    none = Client("none", "", "csv", "*.csv", "x.py", ("./no-such-folder-of-a-package",))
    told = python_of(none, tmp_path)
    assert isinstance(told, str)
    assert told.startswith("./no-such-folder-of-a-package cannot be installed: ")
    assert not (tmp_path / "none").exists()


def test_an_environment_is_made_once_for_its_pins(tmp_path: Path) -> None:
    client = Client("kept", "", "csv", "*.csv", "x.py", ("a==1",))
    (tmp_path / "kept").mkdir()
    (tmp_path / "kept" / "pins").write_text("a==1", "utf-8")
    assert python_of(client, tmp_path) == tmp_path / "kept" / "bin" / "python"


def test_metrics_by_hand() -> None:
    """SV at 30 m/s, 45.5 m behind the rear of POV at 20 m/s: 4.55 s, and 38 samples to where POV is now."""
    ahead = motion((None, "0", "0"), start=("60", "2.6", "20", "0"))
    told = expected(subject(SV=motion((None, "0", "0")), POV=ahead).file)
    first = told["metrics"][0]
    assert (first["step"], first["ego"], first["other"]) == (1, 1, 2)
    assert first["headway"] == pytest.approx(60.8 - 4.5 - 11.2)
    assert first["time to collision"] == pytest.approx((60.8 - 4.5 - 11.2) / 10)
    assert first["time headway"] == pytest.approx(38 / 25)


def test_expected_boxes_are_those_of_the_file() -> None:
    """By two ways: what clients are told, and a player of the file."""
    file = shipped_drives()["scenario-01-base"]
    (made,) = [x for x in subjects() if x.name == "scenario-01-base"]
    for name, told in expected(file)["vehicles"].items():
        played = boxes(root_of(made), name, told["times"])
        for (x, y), (px, py, _) in zip(told["centres"], played, strict=True):
            assert abs(x - px) + abs(y - py) < 0.02


def test_scripts_are_there_and_speak_json() -> None:
    folder = Path(__file__).parent / "clients"
    assert {x.script for x in clients()} == {x.name for x in folder.glob("*.py")} - {"asam_report.py"}
    assert json.loads(json.dumps(expected(shipped_drives()["scenario-02-base"])))["metrics"]
