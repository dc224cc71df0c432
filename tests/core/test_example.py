"""The package of examples/extension is installed beside roadproof, and all that it adds is there."""

import os
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "examples/extension"


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the package as pip leaves it: its files, and beside them a record of its entry points.

    pip itself would have to fetch what builds packages.
    """
    folder = tmp_path_factory.mktemp("installed")
    site, project = folder / "site", tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    skipped = shutil.ignore_patterns("__pycache__")
    shutil.copytree(EXAMPLE / "roadproof_example", site / "roadproof_example", ignore=skipped)
    about = site / f"{project['name'].replace('-', '_')}-{project['version']}.dist-info"
    about.mkdir()
    head = f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
    (about / "METADATA").write_text(head)
    points = [
        f"[{group}]\n" + "".join(f"{name} = {value}\n" for name, value in named.items())
        for group, named in project["entry-points"].items()
    ]
    (about / "entry_points.txt").write_text("".join(points))
    return folder


def ask(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return run(folder, "-m", "roadproof", *words)


def run(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    paths = os.pathsep.join([str(ROOT / "src"), str(folder / "site")])
    environment = {**os.environ, "PYTHONPATH": paths, "XDG_CACHE_HOME": str(folder / "cache")}
    return subprocess.run(
        [sys.executable, *words], cwd=folder, env=environment, capture_output=True, text=True
    )


def test_what_the_example_adds_is_there(installed: Path) -> None:
    assert (
        "Scenarios that hold while no other one does; traces with tabs; an alert driver"
        in ask(installed, "extensions").stdout
    )
    assert "alone " in ask(installed, "--help").stdout
    told = ask(installed, "alone", "--among", "4,6", "--effort", "3", "--out", "alone", "--jobs", "1")
    assert told.returncode == 0, told.stderr
    assert [x.split()[:2] for x in told.stdout.splitlines()[:2]] == [
        ["WITNESSED", "scenario_4"],
        ["WITNESSED", "scenario_6"],
    ]
    assert "2 of 2 accepted" in ask(installed, "check", "alone", "--jobs", "1").stdout
    assert ask(installed, "report", "alone", "--out", "page.html").returncode == 0
    assert "Which can hold while no other one does?" in (installed / "page.html").read_text("utf-8")


def test_a_trace_with_tabs_is_read_as_one_in_csv(installed: Path) -> None:
    drive = ROOT / "examples/traffic/drives/scenario-04-base.json"
    assert ask(installed, "export", str(drive), "--to", "csv", "--out", "csv").returncode == 0
    [samples] = (installed / "csv").glob("*base.csv")
    (installed / "trace.tsv").write_text(samples.read_text().replace(",", "\t"))
    told, same = (ask(installed, "monitor", "4", x) for x in ("trace.tsv", str(samples)))
    assert told.returncode == same.returncode == 0, told.stderr
    assert told.stdout.splitlines()[0] == same.stdout.splitlines()[0]
    (installed / "short.tsv").write_text("time\tvehicle\n0\tSV\n")
    short = ask(installed, "monitor", "4", "short.tsv")
    assert short.returncode == 3
    assert "short.tsv: line 1: write the columns time, vehicle" in short.stderr


def test_without_the_package_nothing_of_it_is_there(tmp_path: Path) -> None:
    assert "alone" not in ask(tmp_path, "--help").stdout.replace("stand-alone", "")


def test_a_driver_model_of_a_package_is_driven_and_proved(installed: Path) -> None:
    """Its plate has judged drives on both sides and proved lemmas, and it drives SV in a test as it says."""
    words = ("--model", "alert", "--at", "Ve0=60km/h", "--lines", "3", "--jobs", "1", "--out", "alert")
    told = ask(installed, "preventable", "deceleration", *words)
    assert told.returncode == 0, told.stdout + told.stderr
    assert "alert driver" in told.stdout
    assert ask(installed, "check", "alert", "--jobs", "1").returncode == 0
    plates = sorted((installed / "alert").glob("alert-*-unpreventable.json"))
    assert plates
    shown = ask(installed, "monitor", "4", str(plates[0]), "--drivers", "alert,careful")
    assert "alert" in shown.stdout, shown.stdout + shown.stderr


def test_a_driver_model_of_a_package_restricts_questions(installed: Path) -> None:
    """The drive that is found is one in which the model, put in place of SV, prevents the collision."""
    words = ("--preventable", "alert", "--no-pictures", "--jobs", "1", "--out", "alert-drives")
    told = ask(installed, "witness", "4", *words)
    assert told.returncode == 0, told.stdout + told.stderr
    assert "preventable (alert driver): scenarios 4, 12, 20 begin so" in told.stdout
    assert "1 of 1 accepted" in ask(installed, "check", "alert-drives", "--jobs", "1").stdout
    [samples] = (installed / "alert-drives").glob("scenario-04-*.csv")
    shown = ask(installed, "monitor", "4", str(samples), "--drivers", "alert")
    assert "alert, scenario_4: preventable (" in shown.stdout
    other = ask(installed, "witness", "1", "--preventable", "alert")
    assert other.returncode == 2
    assert "alert does not apply to the selected scenarios (1)" in other.stderr


def test_the_restriction_of_a_package_is_the_one_that_is_printed(installed: Path) -> None:
    printed = run(installed, "-m", "roadproof.extensions.drivers.restriction_file", "alert").stdout
    file = "roadproof_example/alert_prevention.spec"
    assert printed == (EXAMPLE / file).read_text()
    wrong = printed.replace("unpreventable_deceleration_alert(a, b)", "not brakesAhead(a, b)")
    (installed / "site" / file).write_text(wrong)
    told = ask(installed, "witness", "4", "--preventable", "alert")
    (installed / "site" / file).write_text(printed)
    assert told.returncode == 3
    assert "alert_prevention.spec: this is not the restriction by alert in its manoeuvres" in told.stderr


def test_a_model_without_a_restriction_says_what_to_add(installed: Path) -> None:
    row = installed / "site/roadproof_example/driver.py"
    text = row.read_text()
    row.write_text(text.replace('restriction="alert_prevention"', "restriction=None"))
    told = ask(installed, "witness", "4", "--preventable", "alert")
    row.write_text(text)
    assert told.returncode == 2
    assert "the law of alert names no restriction; its package must add one" in told.stderr
