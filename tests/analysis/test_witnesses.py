"""Drives that are kept: a run that was broken off asks only for what is missing."""

import json
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import roadproof as rp
from analysis.heard import Asked
from evidence.folders import check
from roadproof.analysis.witnesses import WitnessStudy
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.journal import ANSWERS, HEAD, seal_of
from roadproof.frontends.cli.main import main

IMPOSSIBLE = "given A, B: vehicle: s(A) > s(B) + 5 m and s(B) > s(A)"
NONE = "v_lon(SV) > 500 km/h"
FAST = "F[0, 1] v_lon(SV) > 30 m/s"
A3, A4 = "scenario-03-base", "scenario-04-base"


@pytest.fixture
def asked(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Asked:
    return Asked(tmp_path_factory.mktemp("log") / "asked", monkeypatch, WitnessStudy)


def witness(out: Path, *what: str) -> int:
    return main(["witness", *what, "--jobs", "1", "--no-pictures", "--out", str(out)])


def accepted(out: Path) -> list[str]:
    findings = check(out)
    assert [x for x in findings if x.outcome is not Acceptance.ACCEPTED] == []
    return sorted(f"{x.verdict} {x.label}" for x in findings)


_KILLED = """
import os, signal
from roadproof.analysis.witnesses import WitnessStudy
from roadproof.frontends.cli.main import main

settle = WitnessStudy.settle

def settle_or_die(study, piece):
    if piece == {last!r}:
        os.kill(os.getppid(), signal.SIGKILL)
        os.kill(os.getpid(), signal.SIGKILL)
    return settle(study, piece)

WitnessStudy.settle = settle_or_die
main(["witness", "3", "4", {formula!r}, "--jobs", "1", "--out", {out!r}])
"""


def test_a_killed_run_asks_for_what_is_missing(
    tmp_path: Path, asked: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    out, last = tmp_path / "out", "formula-03-base"
    script = _KILLED.format(last=last, formula=IMPOSSIBLE, out=str(out))
    killed = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert killed.returncode == -signal.SIGKILL
    assert accepted(out) == ["WITNESSED scenario 3 base", "WITNESSED scenario 4 base"]
    before = (out / f"{A3}.json").read_bytes()
    (out / f"{A4}.png").unlink()
    target = tmp_path / "answer.json"
    arguments = ["witness", "3", "4", IMPOSSIBLE, "--jobs", "1", "--out", str(out), "--json", str(target)]
    told: list[Any] = []
    for _ in range(2):
        assert main(arguments) == 10
        told.append((capsys.readouterr().out.rpartition(" in ")[0], json.loads(target.read_text())))
    assert asked.since() == [last]
    assert told[0] == told[1]
    assert (out / f"{A3}.json").read_bytes() == before
    assert (out / f"{A4}.png").exists(), "a picture that is missing is drawn"
    assert accepted(out) == ["IMPOSSIBLE base", "WITNESSED scenario 3 base", "WITNESSED scenario 4 base"]


def test_what_was_not_found_is_asked_again(tmp_path: Path, asked: Asked) -> None:
    for _ in range(2):
        assert witness(tmp_path, NONE) == 10
        assert asked.since() == ["formula-01-base"]
    assert not list(tmp_path.glob("formula*"))


@pytest.mark.parametrize(
    "more",
    [
        ["--objective", "any"],
        ["--horizon", "5"],
        ["--dt", "3/10"],
        ["--road", "main-3"],
        ["--reach", "60"],
        ["--param", "rho=1/2"],
        ["--lane", "main-2"],
        ["--allow-collisions"],
        ["--engine", "smt"],
        ["--count", "2"],
    ],
)
def test_another_search_for_the_same_formula_is_asked(
    more: list[str], tmp_path: Path, asked: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    what, name = "atLane(SV,L) and F[0, 3/5] v_lon(SV) > 30 m/s", "formula-01-base"
    witness(tmp_path, what)
    asked.since()
    witness(tmp_path, what, *more)
    assert asked.since() == [name]
    assert f"the answer '{name}' is that to another search" in capsys.readouterr().err
    witness(tmp_path, what, *more, "--effort", "70")
    assert asked.since() == []
    accepted(tmp_path)


def test_other_scenarios_and_sets_lie_beside(tmp_path: Path, asked: Asked) -> None:
    witness(tmp_path, "4")
    witness(tmp_path, "3", "4", "--set", "base,ext")
    assert asked.since() == [A4, A3, "scenario-03-ext", "scenario-04-ext"]
    assert len(accepted(tmp_path)) == 4


def test_another_formula_in_the_same_place_is_asked(tmp_path: Path, asked: Asked) -> None:
    witness(tmp_path, FAST)
    witness(tmp_path, FAST.replace("30", "31"))
    assert asked.since() == ["formula-01-base"] * 2
    assert len(accepted(tmp_path)) == 1


def test_several_drives_are_one_answer(tmp_path: Path, asked: Asked) -> None:
    for _ in range(2):
        assert witness(tmp_path, "4", "--count", "2") == 0
    assert asked.since() == [A4]
    assert sorted(x.name for x in tmp_path.glob("scenario*.json")) == [f"{A4}-1.json", f"{A4}-2.json"]
    (tmp_path / f"{A4}-2.json").unlink()
    witness(tmp_path, "4", "--count", "2")
    assert asked.since() == [A4]


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        (f"{ANSWERS}/{A4}.json", '"WITNESSED"', '"IMPOSSIBLE"'),
        (f"{ANSWERS}/{A4}.json", '"scenario": 4', '"scenario": 3'),
        (f"{ANSWERS}/{A4}.json", '"natural": true', '"natural": false'),
        (f"{A4}.json", '"length": "', '"length": "1'),
        (f"{A4}.json", '"rho": "3/5"', '"rho": "1/5"'),
    ],
)
def test_what_was_altered_is_asked_again_and_said_so(
    file: str, old: str, new: str, tmp_path: Path, asked: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    witness(tmp_path, "3", "4")
    asked.since()
    path = tmp_path / file
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new, 1))
    assert any(x.outcome is not Acceptance.ACCEPTED for x in check(tmp_path))
    capsys.readouterr()
    witness(tmp_path, "3", "4")
    assert asked.since() == [A4]
    assert "a stored answer is invalid and is computed again" in capsys.readouterr().err
    accepted(tmp_path)


@pytest.mark.parametrize("forged", ["drive", "name", "scenario"])
def test_a_foreign_answer_under_a_new_seal_does_not_count(forged: str, tmp_path: Path, asked: Asked) -> None:
    witness(tmp_path, "3", "4")
    asked.since()
    path, question = tmp_path / ANSWERS / f"{A4}.json", json.loads((tmp_path / HEAD).read_text())["question"]
    record, other = (json.loads((tmp_path / ANSWERS / f"{x}.json").read_text()) for x in (A4, A3))
    if forged == "drive":
        record["outcome"]["drives"], record["evidence"] = other["outcome"]["drives"], other["evidence"]
    elif forged == "name":
        record = {**other, "name": A4}
    else:
        record["outcome"]["scenario"] = 3
    path.write_text(json.dumps({**record, "seal": seal_of(record, question, tmp_path)}))
    if forged != "name":
        assert any(x.outcome is Acceptance.REJECTED for x in check(tmp_path))
    witness(tmp_path, "3", "4")
    assert asked.since() == [A4]


def test_drive_files_of_earlier_runs_stand_for_themselves(tmp_path: Path, asked: Asked) -> None:
    """A folder of an earlier version has drive files alone; they stay, and are accepted beside new ones."""
    witness(tmp_path, "3")
    (tmp_path / HEAD).unlink()
    (tmp_path / ANSWERS / f"{A3}.json").unlink()
    witness(tmp_path, "4")
    assert accepted(tmp_path) == ["WITNESSED scenario 3 base", "WITNESSED scenario 4 base"]
    witness(tmp_path, "3")
    assert asked.since() == [A3, A4, A3]


def test_other_definitions_need_another_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    witness(tmp_path, "4")
    assert witness(tmp_path, "4", "--option", "lateral_sign=literal") == 2
    assert "name another folder with --out" in capsys.readouterr().err


def test_definitions_of_ones_own_lie_beside_the_drives(tmp_path: Path) -> None:
    mine = tmp_path / "mine.spec"
    mine.write_text("def fast(a: vehicle) := v_lon(a) > 30 m/s\n")
    assert (
        main(["witness", "fast(SV)", "--spec", str(mine), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 0
    )
    assert main(["check", str(tmp_path / "out")]) == 0
    assert main(["check", str(tmp_path / "out"), "--spec", str(mine)]) == 0


def test_python_takes_up_what_the_command_line_kept(tmp_path: Path, asked: Asked) -> None:
    out = tmp_path / "out"
    witness(out, "4")
    found = rp.witness(4, IMPOSSIBLE, out=out, pictures=False, jobs=1)
    assert asked.since() == [A4, "formula-02-base"]
    assert found.check().accepted
    again = rp.witness(4, IMPOSSIBLE, out=out, pictures=False, jobs=1)
    assert again.as_data() == found.as_data()
    assert asked.since() == []
    again.save(tmp_path / "copy", pictures=False)
    assert accepted(tmp_path / "copy") == accepted(out)


def test_planted_neglect_of_how_it_was_asked_is_noticed(
    tmp_path: Path, asked: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roadproof.analysis.witnesses._asked", lambda search: 16 * "0")
    witness(tmp_path, "4")
    witness(tmp_path, "4", "--horizon", "5")
    assert asked.since() == [A4]
