"""Claims that are kept: a run that was broken off goes on; what has sound evidence is not asked again."""

import json
import re
import signal
import subprocess
import sys
from collections.abc import Sequence
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from roadproof.analysis.claims import Claims, name_of
from roadproof.analysis.witnesses import WitnessStudy

import roadproof as rp
from analysis.heard import Asked
from api.doors import without_seconds
from evidence.folders import check
from roadproof.errors import UsageError
from roadproof.evidence.finding import Acceptance
from roadproof.evidence.journal import ANSWERS, HEAD, seal_of
from roadproof.frontends.api.proofs import claims_of
from roadproof.frontends.cli.main import main
from roadproof.verdict import Verdict

SYMMETRIC = "danger(SV,POV) -> danger(POV,SV)"
JUMPS = "v_lon(SV) > 30 m/s -> G v_lon(SV) > 0 m/s"
SLOW = "v_lon(SV) < 500 km/h"
ALWAYS = "G danger(SV,POV) -> danger(SV,POV)"
FALSE = "fasterThan(SV,POV) -> danger(SV,POV)"
CLAIMS = (SYMMETRIC, FALSE, ALWAYS)


@pytest.fixture
def asked(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Asked:
    return Asked(
        tmp_path_factory.mktemp("log") / "asked", monkeypatch, Claims, lambda piece: str(piece.claim)
    )


def prove(out: Path, *claims: str, more: Sequence[str] = ()) -> int:
    return main(["prove", *claims, "--jobs", "1", "--out", str(out), *more])


def path_of(out: Path, claim: str) -> Path:
    (task,) = claims_of(rp.load(), [claim], None).tasks
    return out / ANSWERS / f"{name_of(task)}.json"


def outcomes(out: Path) -> list[tuple[Acceptance, str, str]]:
    return sorted((x.outcome, x.verdict, x.claim) for x in check(out))


ACCEPTED = sorted(
    [
        (Acceptance.ACCEPTED, "PROVED", SYMMETRIC),
        (Acceptance.ACCEPTED, "REFUTED", FALSE),
        (Acceptance.ACCEPTED, "PROVED", ALWAYS),
    ]
)

_KILLED = """
import os, signal, sys
from roadproof.analysis.claims import Claims
from roadproof.frontends.cli.main import main

settle = Claims.settle

def settle_or_die(claims, piece):
    if piece.claim == {last!r}:
        os.kill(os.getppid(), signal.SIGKILL)
        os.kill(os.getpid(), signal.SIGKILL)
    return settle(claims, piece)

Claims.settle = settle_or_die
main(["prove", *{claims!r}, "--jobs", "1", "--out", {out!r}])
"""


def test_a_killed_run_goes_on_where_it_was(
    tmp_path: Path, asked: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    script = _KILLED.format(last=ALWAYS, claims=CLAIMS, out=str(out))
    killed = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert killed.returncode == -signal.SIGKILL
    assert not (out / "index.json").exists()
    assert outcomes(out) == [x for x in ACCEPTED if x[2] != ALWAYS]
    assert prove(out, *CLAIMS) == 10
    assert asked == [ALWAYS]
    told = [line.split()[0] for line in capsys.readouterr().out.splitlines() if line[:1].isupper()]
    assert told == ["PROVED", "REFUTED", "PROVED"]
    assert outcomes(out) == ACCEPTED
    assert [x["claim"] for x in json.loads((out / "index.json").read_text())["claims"]] == [*CLAIMS]


def test_what_was_taken_up_is_told_as_before(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = count(0, 0.045006)  # 0.05 s, but 0.04 s once it has been rounded to four digits
    monkeypatch.setattr("roadproof.runtime.timing.time", SimpleNamespace(monotonic=lambda: next(clock)))
    told: list[tuple[str, Any]] = []
    for _ in range(2):
        target = tmp_path / "answer.json"
        prove(tmp_path / "out", *CLAIMS, JUMPS, more=["--json", str(target)])
        told.append((capsys.readouterr().out, json.loads(target.read_text())))
    assert without_durations(*told[0]) == told[1]


def without_durations(printed: str, answer: Any) -> tuple[str, Any]:
    """An answer as it is when it is recalled: evidence has no durations."""
    for settled in answer["verdicts"]:
        settled["seconds"] = 0.0
    return re.sub(r", \d+\.\d\d s$", "", printed, flags=re.MULTILINE), answer


def test_a_folder_grows_and_keeps_its_order(tmp_path: Path, asked: Asked) -> None:
    assert prove(tmp_path, ALWAYS) == 0
    assert prove(tmp_path, SYMMETRIC, ALWAYS) == 0
    assert prove(tmp_path, "P2", more=["--set", "base"]) == 0
    assert asked == [ALWAYS, SYMMETRIC, "danger(SV,POV) <-> danger(POV,SV)"]
    entries = json.loads((tmp_path / "index.json").read_text())["claims"]
    assert [(x["property"], x["claim"]) for x in entries] == [
        ("claim", ALWAYS),
        ("claim", SYMMETRIC),
        ("P2", "danger(SV,POV) <-> danger(POV,SV)"),
    ]
    assert {x.outcome for x in check(tmp_path)} == {Acceptance.ACCEPTED}


def test_a_claim_has_one_answer_whatever_it_is_called(tmp_path: Path, asked: Asked) -> None:
    prove(tmp_path, "P2", more=["--set", "base"])
    assert prove(tmp_path, "danger(SV,POV)  <-> danger(POV,SV)") == 0
    assert asked == ["danger(SV,POV) <-> danger(POV,SV)"]
    assert len(json.loads((tmp_path / "index.json").read_text())["claims"]) == 1


def test_a_doubt_is_asked_again(tmp_path: Path, asked: Asked) -> None:
    hard = "scenario_4(SV,POV,L) -> dangerArises(SV,POV)"
    assert prove(tmp_path, hard, more=["--effort", "0.001", "--no-drive"]) == 20
    assert prove(tmp_path, hard) == 0
    assert asked == [hard, hard]
    assert [x.verdict for x in check(tmp_path)] == ["PROVED"]


def test_a_drive_is_looked_for_where_none_was(tmp_path: Path, asked: Asked) -> None:
    assert prove(tmp_path, FALSE, more=["--no-drive"]) == 10
    assert not list(tmp_path.glob("*-drive.json"))
    assert prove(tmp_path, FALSE) == 10
    assert len(list(tmp_path.glob("*-drive.json"))) == 1
    assert prove(tmp_path, FALSE, more=["--no-drive"]) == 10
    assert asked == [FALSE, FALSE]
    assert {x.outcome for x in check(tmp_path)} == {Acceptance.ACCEPTED}


def test_a_trace_that_jumps_does_not_answer_a_claim_about_drives(tmp_path: Path, asked: Asked) -> None:
    """Refuted by a trace over points in time, but by no drive up to a horizon."""
    jump = "v_lon(SV) <= 30 m/s -> G[0, 0.6] v_lon(SV) <= 31.8 m/s"
    within = ["--engine", "milp", "--horizon", "3", "--dt", "1/5"]
    assert prove(tmp_path, jump) == 10
    assert prove(tmp_path, jump, more=within) == 0
    assert asked == [jump, jump]


def test_a_drive_within_limits_answers_no_other_limits(tmp_path: Path, asked: Asked) -> None:
    fast = "v_lon(SV) <= 30 m/s -> G[0, 0.6] v_lon(SV) <= 31.7 m/s"
    three, two = (["--engine", "milp", "--dt", "1/5", "--horizon", s] for s in ("3", "2"))
    for more in (three, three, two):
        assert prove(tmp_path, fast, more=more) == 10
    assert asked == [fast, fast]
    assert prove(tmp_path, fast) == 10, "a drive refutes what is said of all time, too"
    assert asked == [fast, fast]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"PROVED"', '"REFUTED"'),
        ('"base"', '"ext"'),
        ("danger(POV,SV)", "danger(SV,POV)"),
        ('"property": "claim"', '"property": "P2"'),
    ],
)
def test_an_altered_answer_is_asked_again_and_said_so(
    old: str, new: str, tmp_path: Path, asked: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    prove(tmp_path, SYMMETRIC, ALWAYS)
    path = path_of(tmp_path, SYMMETRIC)
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    assert not all(x.outcome is Acceptance.ACCEPTED for x in check(tmp_path))
    capsys.readouterr()
    assert prove(tmp_path, SYMMETRIC, ALWAYS) == 0
    assert asked == [SYMMETRIC, ALWAYS, SYMMETRIC]
    assert "a stored answer is invalid and is computed again" in capsys.readouterr().err
    assert {x.outcome for x in check(tmp_path)} == {Acceptance.ACCEPTED}


@pytest.mark.parametrize("forged", ["another claim", "another name", "another certificate"])
def test_a_foreign_answer_under_a_new_seal_is_asked_again(
    forged: str, tmp_path: Path, asked: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    """As somebody would forge it who computes seals."""
    prove(tmp_path, SYMMETRIC, ALWAYS)
    path, other = path_of(tmp_path, SYMMETRIC), json.loads(path_of(tmp_path, ALWAYS).read_text())
    record = json.loads(path.read_text())
    if forged == "another claim":
        record = other
    elif forged == "another name":
        record["claim"]["property"] = "P2"
    else:
        record["claim"]["evidence"], record["evidence"] = other["claim"]["evidence"], other["evidence"]
    question = json.loads((tmp_path / HEAD).read_text())["question"]
    path.write_text(json.dumps({**record, "seal": seal_of(record, question, tmp_path)}))
    capsys.readouterr()
    assert prove(tmp_path, SYMMETRIC, ALWAYS) == 0
    assert asked == [SYMMETRIC, ALWAYS, SYMMETRIC]
    assert "a stored answer is invalid" in capsys.readouterr().err
    assert {x.outcome for x in check(tmp_path)} == {Acceptance.ACCEPTED}


def test_a_false_claim_that_is_kept_as_proved_is_not_believed(tmp_path: Path, asked: Asked) -> None:
    """With a certificate that was made to say another claim, under a seal that was made anew."""
    prove(tmp_path, SYMMETRIC)
    path = path_of(tmp_path, SYMMETRIC)
    record = json.loads(path.read_text())
    file = tmp_path / record["claim"]["evidence"]
    file.write_text(file.read_text().replace("danger(POV,SV)", "danger(SV,POV)"))
    question = json.loads((tmp_path / HEAD).read_text())["question"]
    path.write_text(json.dumps({**record, "seal": seal_of(record, question, tmp_path)}))
    prove(tmp_path, SYMMETRIC)
    assert asked == [SYMMETRIC, SYMMETRIC]


@pytest.mark.parametrize(
    "more",
    [["--option", "lateral_sign=literal"], ["--spec", "mine.spec"]],
)
def test_other_definitions_need_another_folder(
    more: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine.spec").write_text("def danger(a, b: vehicle) := s(a) > s(b)\n")
    assert prove(Path("out"), SYMMETRIC) == 0
    before = {x: x.read_bytes() for x in Path("out").rglob("*.json")}
    assert prove(Path("out"), SYMMETRIC, more=more) == 2
    assert "name another folder with --out" in capsys.readouterr().err
    assert {x: x.read_bytes() for x in Path("out").rglob("*.json")} == before


def test_a_folder_with_an_index_alone_is_taken_up(tmp_path: Path, asked: Asked) -> None:
    """Its claims stay in the index, with their files, and are asked again when somebody asks."""
    prove(tmp_path, SYMMETRIC, ALWAYS)
    for path in [tmp_path / HEAD, *(tmp_path / ANSWERS).iterdir()]:
        path.unlink()
    (tmp_path / ANSWERS).rmdir()
    assert prove(tmp_path, FALSE, ALWAYS) == 10
    assert asked == [SYMMETRIC, ALWAYS, FALSE, ALWAYS]
    assert outcomes(tmp_path) == ACCEPTED
    assert [x["claim"] for x in json.loads((tmp_path / "index.json").read_text())["claims"]] == [
        SYMMETRIC,
        ALWAYS,
        FALSE,
    ]


def test_a_folder_under_another_library_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    prove(tmp_path, SYMMETRIC)
    path = tmp_path / "index.json"
    path.write_text(json.dumps({**json.loads(path.read_text()), "library": "0" * 16}))
    assert prove(tmp_path, ALWAYS) == 2
    assert "or another library: name another folder" in capsys.readouterr().err


def test_python_takes_up_what_the_command_line_kept(tmp_path: Path, asked: Asked) -> None:
    prove(tmp_path, SYMMETRIC, ALWAYS)
    found = rp.prove(SYMMETRIC, ALWAYS, FALSE, out=tmp_path, jobs=1)
    assert asked == [SYMMETRIC, ALWAYS, FALSE]
    assert [*found.verdicts.values()] == [Verdict.PROVED, Verdict.PROVED, Verdict.REFUTED]
    assert found.check().accepted
    found.save(tmp_path / "copy")
    assert outcomes(tmp_path / "copy") == ACCEPTED
    with pytest.raises(UsageError, match="another question"):
        rp.overlap("3,4", out=tmp_path, jobs=1)


def test_planted_take_up_of_traces_for_drives_is_noticed(
    tmp_path: Path, asked: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the check on what a kept counterexample answers, the claim about drives is not asked."""
    jump = "v_lon(SV) <= 30 m/s -> G[0, 0.6] v_lon(SV) <= 31.8 m/s"
    prove(tmp_path, jump)
    monkeypatch.setattr(Claims, "_check_refuted", lambda *_: None)
    assert prove(tmp_path, jump, more=["--engine", "milp", "--horizon", "3", "--dt", "1/5"]) == 10
    assert asked == [jump]


# --- Drives that are kept: a run that was broken off asks only for what is missing ------------------

IMPOSSIBLE = "given A, B: vehicle: s(A) > s(B) + 5 m and s(B) > s(A)"
NONE = "v_lon(SV) > 500 km/h"
FAST = "F[0, 1] v_lon(SV) > 30 m/s"
A3, A4 = "scenario-03-base", "scenario-04-base"


@pytest.fixture
def searched(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Asked:
    return Asked(tmp_path_factory.mktemp("log") / "asked", monkeypatch, WitnessStudy, "\n".join)


def witness(out: Path, *what: str) -> int:
    return main(["witness", *what, "--jobs", "1", "--no-pictures", "--out", str(out)])


def accepted(out: Path) -> list[str]:
    findings = check(out)
    assert [x for x in findings if x.outcome is not Acceptance.ACCEPTED] == []
    return sorted(f"{x.verdict} {x.label}" for x in findings)


_KILLED_SEARCH = """
import os, signal
from roadproof.analysis.witnesses import WitnessStudy
from roadproof.frontends.cli.main import main

settle = WitnessStudy.settle

def settle_or_die(study, piece):
    if {last!r} in piece:
        os.kill(os.getppid(), signal.SIGKILL)
        os.kill(os.getpid(), signal.SIGKILL)
    return settle(study, piece)

WitnessStudy.settle = settle_or_die
main(["witness", "3", "4", {formula!r}, "--jobs", "1", "--out", {out!r}])
"""


def test_a_killed_run_asks_for_what_is_missing(
    tmp_path: Path, searched: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    out, last = tmp_path / "out", "formula-03-base"
    script = _KILLED_SEARCH.format(last=last, formula=IMPOSSIBLE, out=str(out))
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
        text = re.sub(r"(?m) *([0-9]+[.][0-9]+ s)?$", "", capsys.readouterr().out.rpartition(" in ")[0])
        told.append((text, without_seconds(json.loads(target.read_text()))))
    assert searched.since() == [last]
    assert told[0] == told[1]
    assert (out / f"{A3}.json").read_bytes() == before
    assert (out / f"{A4}.png").exists(), "a picture that is missing is drawn"
    assert accepted(out) == ["IMPOSSIBLE base", "WITNESSED scenario 3 base", "WITNESSED scenario 4 base"]


def test_what_was_not_found_is_asked_again(tmp_path: Path, searched: Asked) -> None:
    for _ in range(2):
        assert witness(tmp_path, NONE) == 10
        assert searched.since() == ["formula-01-base"]
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
    more: list[str], tmp_path: Path, searched: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    what, name = "atLane(SV,L) and F[0, 3/5] v_lon(SV) > 30 m/s", "formula-01-base"
    witness(tmp_path, what)
    searched.since()
    witness(tmp_path, what, *more)
    assert searched.since() == [name]
    assert f"the answer '{name}' is that to another search" in capsys.readouterr().err
    witness(tmp_path, what, *more, "--effort", "70")
    assert searched.since() == []
    accepted(tmp_path)


def test_other_scenarios_and_sets_lie_beside(tmp_path: Path, searched: Asked) -> None:
    witness(tmp_path, "4")
    witness(tmp_path, "3", "4", "--set", "base,ext")
    assert searched.since() == [A4, A3, "scenario-03-ext", "scenario-04-ext"]
    assert len(accepted(tmp_path)) == 4


def test_another_formula_in_the_same_place_is_asked(tmp_path: Path, searched: Asked) -> None:
    witness(tmp_path, FAST)
    witness(tmp_path, FAST.replace("30", "31"))
    assert searched.since() == ["formula-01-base"] * 2
    assert len(accepted(tmp_path)) == 1


def test_several_drives_are_one_answer(tmp_path: Path, searched: Asked) -> None:
    for _ in range(2):
        assert witness(tmp_path, "4", "--count", "2") == 0
    assert searched.since() == [A4]
    assert sorted(x.name for x in tmp_path.glob("scenario*.json")) == [f"{A4}-1.json", f"{A4}-2.json"]
    (tmp_path / f"{A4}-2.json").unlink()
    witness(tmp_path, "4", "--count", "2")
    assert searched.since() == [A4]


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
    file: str, old: str, new: str, tmp_path: Path, searched: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    witness(tmp_path, "3", "4")
    searched.since()
    path = tmp_path / file
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new, 1))
    assert any(x.outcome is not Acceptance.ACCEPTED for x in check(tmp_path))
    capsys.readouterr()
    witness(tmp_path, "3", "4")
    assert searched.since() == [A4]
    assert "a stored answer is invalid and is computed again" in capsys.readouterr().err
    accepted(tmp_path)


@pytest.mark.parametrize("forged", ["drive", "name", "scenario"])
def test_a_foreign_answer_under_a_new_seal_does_not_count(
    forged: str, tmp_path: Path, searched: Asked
) -> None:
    witness(tmp_path, "3", "4")
    searched.since()
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
    assert searched.since() == [A4]


def test_drive_files_of_earlier_runs_stand_for_themselves(tmp_path: Path, searched: Asked) -> None:
    """A folder of an earlier version has drive files alone; they stay, and are accepted beside new ones."""
    witness(tmp_path, "3")
    (tmp_path / HEAD).unlink()
    (tmp_path / ANSWERS / f"{A3}.json").unlink()
    witness(tmp_path, "4")
    assert accepted(tmp_path) == ["WITNESSED scenario 3 base", "WITNESSED scenario 4 base"]
    witness(tmp_path, "3")
    assert searched.since() == [A3, A4, A3]


def test_drives_of_other_definitions_need_another_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
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


def test_python_takes_up_drives_of_the_command_line(tmp_path: Path, searched: Asked) -> None:
    out = tmp_path / "out"
    witness(out, "4")
    found = rp.witness(4, IMPOSSIBLE, out=out, pictures=False, jobs=1)
    assert searched.since() == [A4, "formula-02-base"]
    assert found.check().accepted
    again = rp.witness(4, IMPOSSIBLE, out=out, pictures=False, jobs=1)
    computed = found.as_data()
    for outcome in computed["verdicts"]:  # type: ignore[union-attr]
        outcome["seconds"] = {}  # type: ignore[index, call-overload]
    assert again.as_data() == computed
    assert searched.since() == []
    again.save(tmp_path / "copy", pictures=False)
    assert accepted(tmp_path / "copy") == accepted(out)


def test_planted_neglect_of_how_it_was_asked_is_noticed(
    tmp_path: Path, searched: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("roadproof.analysis.witnesses._asked", lambda search: 16 * "0")
    witness(tmp_path, "4")
    witness(tmp_path, "4", "--horizon", "5")
    assert searched.since() == [A4]
