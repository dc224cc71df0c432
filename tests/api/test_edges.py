"""Ends of calls that other tests pass by: names of folders, lanes of samples, wrong parameters of drivers."""

import json
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.errors import MissingSolverError, UsageError
from roadproof.evidence.drive_file import load_drive
from roadproof.evidence.kernel import coq
from roadproof.frontends.api.completing import _free
from roadproof.frontends.api.kernel import KernelQuestion, write
from roadproof.frontends.api.restricting import drivers_of

EXAMPLE = Path(__file__).parents[2] / "examples" / "catalogue" / "tests"


def test_each_run_of_recordings_has_a_folder_of_its_own(tmp_path: Path) -> None:
    names = []
    for _ in range(3):
        place = _free(tmp_path, "highd")
        place.mkdir()
        names.append(place.name)
    assert names == ["highd", "highd-2", "highd-3"]
    assert _free(tmp_path, "csv") == _free(tmp_path, "csv") == tmp_path / "csv"


def test_lanes_of_samples_are_those_that_are_asked_for() -> None:
    samples = EXAMPLE / "samples" / "braking.csv"
    for lane, holds in ((1, True), (2, False)):
        found = rp.monitor("scenario_4(SV,POV,L)", samples, lanes={"L": f"main-{lane}"})
        assert found.verdict == str(holds).lower()


def test_lanes_of_a_drive_are_those_that_are_asked_for() -> None:
    """As a path, and as a drive that was read."""
    path = EXAMPLE / "drives" / "braking.json"
    for on in (path, load_drive(path)):
        for lane, holds in (("main-1", True), ("main-2", False)):
            found = rp.monitor("scenario_4(SV,POV,L)", on, lanes={"L": lane})
            assert found.verdict == str(holds).lower()


def test_drivers_are_refused_where_aeb_brakes_less_than_the_driver() -> None:
    names = ("careful",)
    for braking, refused in (("9 m/s^2", False), ("1 m/s^2", True)):
        home = rp.load(specs=["driver"], options={"cc_aeb": "max"}, params={"aeb_braking": braking})
        if refused:
            with pytest.raises(UsageError, match="AEB brakes at least as hard as the driver"):
                drivers_of(home, names)
        else:
            assert drivers_of(home, names) is not None


def test_what_cannot_be_put_to_coq_has_a_reason_and_no_file(tmp_path: Path) -> None:
    drive = EXAMPLE / "drives" / "braking.json"
    wrong = json.loads(drive.read_text("utf-8")) | {"formula": "nothing(SV)", "scenario": None}
    (tmp_path / "wrong.json").write_text(json.dumps(wrong), "utf-8")
    asked = [KernelQuestion("wrong", tmp_path / "wrong.json", ()), KernelQuestion("fine", drive, ())]
    reasons = write(asked, tmp_path / "out", 1)
    assert [*reasons] == ["wrong"]
    assert "nothing" in reasons["wrong"]
    assert sorted(x.name for x in (tmp_path / "out").glob("*.v")) == ["fine.v"]


@pytest.mark.parametrize(
    ("said", "code", "told"),
    [
        ("8.18.0", 0, ""),
        ("8.18.0", 1, "does not say its version"),
        ("what?", 0, "does not say its version"),
        ("8.4.6", 0, "8.16 or later is needed"),
    ],
)
def test_the_version_of_coq(
    said: str, code: int, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A version counts only where the program also ends well."""
    program = tmp_path / "coqc"
    program.write_text(f"#!/bin/sh\necho '{said}'\nexit {code}\n", "utf-8")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    if not told:
        assert coq.find() == (str(program), said)
    else:
        with pytest.raises(MissingSolverError, match=told):
            coq.find()


def test_rows_of_an_extreme_number_its_values_from_one() -> None:
    found = rp.explore("v_lon(SV) >= 30 m/s", greatest="v_lon(SV)", jobs=1)
    assert [(x["kind"], x["at 1"], x["verdict"]) for x in found.rows()] == [
        ("greatest v_lon(SV), best", 40.0, "WITNESSED"),
        ("greatest v_lon(SV), missed", 40.1, "NONE-WITHIN"),
    ]
    assert all("at 2" not in x for x in found.rows())


@pytest.mark.parametrize(("chosen", "told"), [("base", ()), ("ext", ("set ext",))])
def test_a_catalogue_names_another_set(chosen: str, told: tuple[str, ...]) -> None:
    drive = EXAMPLE / "drives" / "braking.json"
    using = rp.load(chosen)
    found = rp.catalogue(drive, among="4", using=using, classes=False, drivers=(), jobs=1)
    assert found.in_force == told
