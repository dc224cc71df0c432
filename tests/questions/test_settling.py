"""The one loop: a run that was broken off goes on; what has sound evidence is not asked again."""

import json
import os
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

import roadproof as rp
from api.both_interfaces import without_seconds
from questions.decided_claims import Asked
from roadproof.engines.search.batches import Engines
from roadproof.errors import SharedError, UsageError
from roadproof.evidence.finding import Acceptance, Finding
from roadproof.frontends.api.proofs import claims_question
from roadproof.frontends.cli.main import main
from roadproof.questions.decide import decide_claims
from roadproof.questions.prove import ProveQuestion
from roadproof.questions.question import QUESTION
from roadproof.runtime.executors import Executor, Shard
from roadproof.verdict import Verdict

SYMMETRIC = "danger(SV,POV) -> danger(POV,SV)"
JUMPS = "v_lon(SV) > 30 m/s -> G v_lon(SV) > 0 m/s"
SLOW = "v_lon(SV) < 500 km/h"
ALWAYS = "G danger(SV,POV) -> danger(SV,POV)"
FALSE = "fasterThan(SV,POV) -> danger(SV,POV)"
CLAIMS = (SYMMETRIC, FALSE, ALWAYS)


@pytest.fixture
def asked(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Asked:
    """The claims that engines are asked."""
    log = tmp_path_factory.mktemp("log") / "asked"
    return Asked(log, monkeypatch, Engines, lambda claim: " ".join(claim.text.split()))


def prove(out: Path, *claims: str, more: Sequence[str] = ()) -> int:
    return main(["prove", *claims, "--jobs", "1", "--out", str(out), *more])


def path_of(out: Path, claim: str) -> Path:
    (name,) = claims_question(rp.load(), [claim], None).named
    return out / f"{name}.json"


def check(out: Path) -> tuple[Finding, ...]:
    return rp.check(out, jobs=1).findings


def claims_in(out: Path) -> list[str]:
    """The claims of a folder in order."""
    return [x["claim"] for x in json.loads((out / QUESTION).read_text())["asked"]["claims"]]


def outcomes(out: Path) -> list[tuple[Acceptance, str, str]]:
    return sorted((x.outcome, x.verdict, x.claim) for x in check(out) if x.claim)


ACCEPTED = sorted(
    [
        (Acceptance.ACCEPTED, "PROVED", SYMMETRIC),
        (Acceptance.ACCEPTED, "REFUTED", FALSE),
        (Acceptance.ACCEPTED, "PROVED", ALWAYS),
    ]
)

_KILLED = """
import os, signal, sys
from roadproof.engines.search.batches import Engines
from roadproof.frontends.cli.main import main

settle = Engines.answer_claim

def settle_or_die(engines, claim, *more):
    if claim.text == {last!r}:
        os.kill(os.getppid(), signal.SIGKILL)
        os.kill(os.getpid(), signal.SIGKILL)
    return settle(engines, claim, *more)

Engines.answer_claim = settle_or_die
main(["prove", *{claims!r}, "--jobs", "1", "--out", {out!r}])
"""


def test_a_killed_run_goes_on_where_it_was(
    tmp_path: Path, asked: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    script = _KILLED.format(last=ALWAYS, claims=CLAIMS, out=str(out))
    killed = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert killed.returncode == -signal.SIGKILL
    assert outcomes(out) == sorted(
        [*(x for x in ACCEPTED if x[2] != ALWAYS), (Acceptance.ACCEPTED, "UNKNOWN", ALWAYS)]
    ), "what is not settled is in doubt"
    assert prove(out, *CLAIMS) == 10
    assert asked == [ALWAYS]
    told = [line.split()[0] for line in capsys.readouterr().out.splitlines() if line[:1].isupper()]
    assert told == ["PROVED", "REFUTED", "PROVED"]
    assert outcomes(out) == ACCEPTED
    assert claims_in(out) == [*CLAIMS]


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
    assert claims_in(tmp_path) == [ALWAYS, SYMMETRIC, "danger(SV,POV) <-> danger(POV,SV)"]
    assert [x.label for x in check(tmp_path)] == ["base", "base", "P2 base"]
    assert {x.outcome for x in check(tmp_path)} == {Acceptance.ACCEPTED}


def test_a_claim_has_one_answer_whatever_it_is_called(tmp_path: Path, asked: Asked) -> None:
    prove(tmp_path, "P2", more=["--set", "base"])
    assert prove(tmp_path, "danger(SV,POV)  <-> danger(POV,SV)") == 0
    assert asked == ["danger(SV,POV) <-> danger(POV,SV)"]
    assert len(claims_in(tmp_path)) == 1


def test_a_doubt_is_asked_again(tmp_path: Path, asked: Asked) -> None:
    hard = "scenario_4(SV,POV,L) -> dangerArises(SV,POV)"
    assert prove(tmp_path, hard, more=["--effort", "0.001", "--no-drive"]) == 20
    assert prove(tmp_path, hard) == 0
    assert asked == [hard, hard]
    assert [x.verdict for x in check(tmp_path)] == ["PROVED"]


def test_a_drive_is_looked_for_where_none_was(tmp_path: Path, asked: Asked) -> None:
    assert prove(tmp_path, FALSE, more=["--no-drive"]) == 10
    assert "refutation" in path_of(tmp_path, FALSE).read_text()
    assert prove(tmp_path, FALSE) == 10
    assert "roadproof/drive" in path_of(tmp_path, FALSE).read_text()
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
    assert prove(tmp_path, fast) == 10
    assert asked == [fast, fast, fast]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('"base"', '"ext"'),
        ("danger(POV,SV)", "danger(SV,POV)"),
        ("roadproof/certificate", "roadproof/drive"),
        ('"assumptions": [', '"assumptions": ["rho > 0", '),
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


def test_an_answer_to_another_claim_is_asked_again_and_said_so(
    tmp_path: Path, asked: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    prove(tmp_path, SYMMETRIC, ALWAYS)
    path_of(tmp_path, SYMMETRIC).write_bytes(path_of(tmp_path, ALWAYS).read_bytes())
    capsys.readouterr()
    assert prove(tmp_path, SYMMETRIC, ALWAYS) == 0
    assert asked == [SYMMETRIC, ALWAYS, SYMMETRIC]
    assert "a stored answer is invalid" in capsys.readouterr().err
    assert {x.outcome for x in check(tmp_path)} == {Acceptance.ACCEPTED}


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


def test_a_folder_goes_on_with_claims_that_nobody_asks_now(tmp_path: Path, asked: Asked) -> None:
    prove(tmp_path, SYMMETRIC, ALWAYS)
    assert prove(tmp_path, FALSE, ALWAYS) == 10
    assert asked == [SYMMETRIC, ALWAYS, FALSE]
    assert outcomes(tmp_path) == ACCEPTED
    assert claims_in(tmp_path) == [SYMMETRIC, ALWAYS, FALSE]


def test_a_folder_under_another_library_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    prove(tmp_path, SYMMETRIC)
    path = tmp_path / QUESTION
    path.write_text(json.dumps({**json.loads(path.read_text()), "library": "0" * 16}))
    assert prove(tmp_path, ALWAYS) == 2
    assert "under another library: name another folder" in capsys.readouterr().err


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


def test_two_runs_write_the_same_bytes(tmp_path: Path) -> None:
    for name in ("one", "two"):
        prove(tmp_path / name, *CLAIMS, JUMPS)
    one, two = ({x.name: x.read_bytes() for x in (tmp_path / name).iterdir()} for name in ("one", "two"))
    assert one == two


def test_every_answer_is_computed_anew_where_that_is_asked(tmp_path: Path, asked: Asked) -> None:
    for more in ([], [], ["--fresh"]):
        prove(tmp_path, SYMMETRIC, more=more)
    assert asked == [SYMMETRIC], "a folder goes on, whatever others know"


def test_shards_settle_each_claim_once_and_one_run_merges_them(tmp_path: Path, asked: Asked) -> None:
    question: ProveQuestion = claims_question(rp.load(), [*CLAIMS, JUMPS], None)
    for index in (1, 2):
        with pytest.raises(
            SharedError, match=r"other runs process \d claims" if index == 1 else "other runs"
        ):
            decide_claims(question, tmp_path / "out", Executor(1, shard=Shard(index, 3)))
    decide_claims(question, tmp_path / "out", Executor(1, shard=Shard(3, 3)))
    assert sorted(asked.since()) == sorted([*CLAIMS, JUMPS])
    assert decide_claims(question, tmp_path / "out", 1).answers.keys() == question.named.keys()
    assert asked.since() == []
    with pytest.raises(UsageError, match="--shard 1/3 requires --out"):
        decide_claims(question, None, Executor(1, shard=Shard(1, 3)))


def test_a_lost_process_puts_one_claim_in_doubt(
    tmp_path: Path, asked: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    true_settle = Engines.answer_claim

    def settle_or_die(engines: Engines, claim: Any, *more: Any) -> Any:
        if claim.text == SYMMETRIC:
            os.kill(os.getpid(), signal.SIGKILL)
        return true_settle(engines, claim, *more)

    with monkeypatch.context() as patch:
        patch.setattr(Engines, "answer_claim", settle_or_die)
        patch.setattr("roadproof.questions.decide.is_fork_unsafe", lambda: False)
        found = decide_claims(claims_question(rp.load(), CLAIMS, None), tmp_path, 2).answers
    verdicts = {x.claim.text: x.verdict for x in found.values()}
    assert verdicts == {SYMMETRIC: Verdict.UNKNOWN, FALSE: Verdict.REFUTED, ALWAYS: Verdict.PROVED}
    asked.since()
    assert prove(tmp_path, *CLAIMS) == 10
    assert asked.since() == [SYMMETRIC], "what is in doubt is asked again"


# --- Drives that are kept: a run that was broken off asks only for what is missing ------------------

IMPOSSIBLE = "given A, B: vehicle: s(A) > s(B) + 5 m and s(B) > s(A)"
NONE = "v_lon(SV) > 500 km/h"
FAST = "F[0, 1] v_lon(SV) > 30 m/s"
THIRD, FOURTH = "scenario_3(SV, POV, L)@base", "scenario_4(SV, POV, L)@base"
A3, A4 = "scenario-03-base", "scenario-04-base"


@pytest.fixture
def searched(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Asked:
    """The claims that engines are asked, as words of their formulas and the sets."""
    log = tmp_path_factory.mktemp("log") / "asked"
    return Asked(log, monkeypatch, Engines, lambda x: f"{' '.join(x.text.split())}@{x.home.set_name}")


def witness(out: Path, *what: str) -> int:
    return main(["witness", *what, "--jobs", "1", "--no-pictures", "--out", str(out)])


def accepted(out: Path) -> list[str]:
    findings = check(out)
    assert [x for x in findings if x.outcome is not Acceptance.ACCEPTED] == []
    return sorted(f"{x.verdict} {x.label}" for x in findings)


_KILLED_SEARCH = """
import os, signal
from roadproof.engines.search.batches import Engines
from roadproof.frontends.cli.main import main

settle = Engines.answer_claim

def settle_or_die(engines, claim, *more):
    if claim.text.endswith({last!r}):
        os.kill(os.getppid(), signal.SIGKILL)
        os.kill(os.getpid(), signal.SIGKILL)
    return settle(engines, claim, *more)

Engines.answer_claim = settle_or_die
main(["witness", "3", "4", {formula!r}, "--jobs", "1", "--out", {out!r}])
"""


def test_a_killed_run_asks_for_what_is_missing(
    tmp_path: Path, searched: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    out, last = tmp_path / "out", "s(B) > s(A)"
    script = _KILLED_SEARCH.format(last=last, formula=IMPOSSIBLE, out=str(out))
    killed = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert killed.returncode == -signal.SIGKILL
    assert accepted(out) == ["UNKNOWN base", "WITNESSED scenario 3 base", "WITNESSED scenario 4 base"]
    before = (out / f"{A3}.json").read_bytes()
    target = tmp_path / "answer.json"
    arguments = ["witness", "3", "4", IMPOSSIBLE, "--jobs", "1", "--out", str(out), "--json", str(target)]
    told: list[Any] = []
    for _ in range(2):
        assert main(arguments) == 10
        text = re.sub(r"(?m) *([0-9]+[.][0-9]+ s)?$", "", capsys.readouterr().out.rpartition(" in ")[0])
        data = without_seconds(json.loads(target.read_text()))
        told.append((text, [{**x, "sizes": {}} for x in data["verdicts"]]))
    assert [x.endswith(f"{last}@base") for x in searched.since()] == [True]
    assert told[0] == told[1]
    assert (out / f"{A3}.json").read_bytes() == before
    assert (out / f"{A4}.svg").exists(), "pictures are drawn at the end"
    assert accepted(out) == ["IMPOSSIBLE base", "WITNESSED scenario 3 base", "WITNESSED scenario 4 base"]


def test_what_was_not_found_is_not_asked_again(tmp_path: Path, searched: Asked) -> None:
    for times in (2, 0):
        assert witness(tmp_path, NONE) == 10
        assert len(searched.since()) == times, "a drive, and once trees that show that there is none"
    assert [x.verdict for x in check(tmp_path)] == ["NONE-WITHIN"]


@pytest.mark.parametrize(
    "more",
    [
        ["--objective", "any"],
        ["--horizon", "5"],
        ["--dt", "3/10"],
        ["--road", "main-3"],
        ["--reach", "60"],
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
    assert len(searched.since()) == (2 if "--count" in more else 1)
    assert f"the answer '{name}' is that to another search" in capsys.readouterr().err
    witness(tmp_path, what, *more, "--effort", "70")
    assert searched.since() == []
    accepted(tmp_path)


def test_other_scenarios_and_sets_lie_beside(tmp_path: Path, searched: Asked) -> None:
    witness(tmp_path, "4")
    witness(tmp_path, "3", "4", "--set", "base,ext")
    ext = [x.replace("base", "ext") for x in (THIRD, FOURTH)]
    assert sorted(searched.since()) == sorted([THIRD, FOURTH, *ext])
    assert len(accepted(tmp_path)) == 4


def test_another_formula_in_the_same_place_is_asked(tmp_path: Path, searched: Asked) -> None:
    witness(tmp_path, FAST)
    witness(tmp_path, FAST.replace("30", "31"))
    assert len(searched.since()) == 2
    assert len(accepted(tmp_path)) == 1


def test_each_of_several_drives_is_kept(tmp_path: Path, searched: Asked) -> None:
    for _ in range(2):
        assert witness(tmp_path, "4", "--count", "2") == 0
    assert searched.since() == [FOURTH] * 2
    assert sorted(x.name for x in tmp_path.glob("scenario*.json")) == [f"{A4}-1.json", f"{A4}-2.json"]
    (tmp_path / f"{A4}-2.json").unlink()
    witness(tmp_path, "4", "--count", "2")
    assert searched.since() == [FOURTH]
    accepted(tmp_path)


def test_a_drive_from_which_another_differs_is_not_that_other(tmp_path: Path, searched: Asked) -> None:
    witness(tmp_path, "4", "--count", "2")
    (tmp_path / f"{A4}-2.json").write_bytes((tmp_path / f"{A4}-1.json").read_bytes())
    assert [x.outcome for x in check(tmp_path)].count(Acceptance.REJECTED) == 1
    searched.since()
    witness(tmp_path, "4", "--count", "2")
    assert searched.since() == [FOURTH]
    accepted(tmp_path)


def test_no_file_of_a_displaced_answer_stays(tmp_path: Path) -> None:
    other = f"{A4}2.json"
    witness(tmp_path, FAST, "4")
    (tmp_path / other).write_bytes(b"")
    witness(tmp_path, IMPOSSIBLE, "4", "--horizon", "5")
    assert (tmp_path / other).exists(), "it is called otherwise"
    (tmp_path / other).unlink()
    names = {x.name for x in tmp_path.iterdir()}
    assert names == {QUESTION, "formula-01-base.json", f"{A4}.json", f"{A4}.csv"}
    accepted(tmp_path)


@pytest.mark.parametrize(("old", "new"), [('"rho": "3/5"', '"rho": "1/5"'), ('"scenario_4(', '"scenario_3(')])
def test_what_was_altered_is_asked_again_and_said_so(
    old: str, new: str, tmp_path: Path, searched: Asked, capsys: pytest.CaptureFixture[str]
) -> None:
    witness(tmp_path, "3", "4")
    searched.since()
    path = tmp_path / f"{A4}.json"
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new, 1))
    assert any(x.outcome is not Acceptance.ACCEPTED for x in check(tmp_path))
    capsys.readouterr()
    witness(tmp_path, "3", "4")
    assert searched.since() == [FOURTH]
    assert "a stored answer is invalid and is computed again" in capsys.readouterr().err
    accepted(tmp_path)


def test_a_drive_of_another_scenario_does_not_count(tmp_path: Path, searched: Asked) -> None:
    witness(tmp_path, "3", "4")
    searched.since()
    (tmp_path / f"{A4}.json").write_bytes((tmp_path / f"{A3}.json").read_bytes())
    assert any(x.outcome is Acceptance.REJECTED for x in check(tmp_path))
    witness(tmp_path, "3", "4")
    assert searched.since() == [FOURTH]


def test_other_values_need_another_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    witness(tmp_path, FAST)
    assert witness(tmp_path, FAST, "--param", "rho=1/2") == 2
    assert "name another folder with --out" in capsys.readouterr().err


def test_drives_of_other_definitions_need_another_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    witness(tmp_path, "4")
    assert witness(tmp_path, "4", "--option", "lateral_sign=literal") == 2
    assert "name another folder with --out" in capsys.readouterr().err


def test_definitions_of_ones_own_lie_beside_the_drives(tmp_path: Path) -> None:
    mine = tmp_path / "mine.spec"
    mine.write_text("def fast(a: vehicle) := v_lon(a) > 30 m/s\n")
    line = ["witness", "fast(SV)", "--spec", str(mine), "--out", str(tmp_path / "out"), "--no-pictures"]
    assert main([*line, "--jobs", "1"]) == 0
    assert main(["check", str(tmp_path / "out")]) == 0
    assert main(["check", str(tmp_path / "out"), "--spec", str(mine)]) == 0


def test_python_takes_up_drives_of_the_command_line(tmp_path: Path, searched: Asked) -> None:
    out = tmp_path / "out"
    witness(out, "4")
    found = rp.witness(4, IMPOSSIBLE, out=out, pictures=False, jobs=1)
    assert len(searched.since()) == 2
    assert found.check().accepted
    again = rp.witness(4, IMPOSSIBLE, out=out, pictures=False, jobs=1)
    computed = found.as_data()
    for outcome in computed["verdicts"]:  # type: ignore[union-attr]
        outcome |= {"seconds": {}, "sizes": {}}  # type: ignore[operator, call-overload]
    assert again.as_data() == computed
    assert searched.since() == []
    again.save(tmp_path / "copy", pictures=False)
    assert accepted(tmp_path / "copy") == accepted(out)
