"""Exit codes of ended commands, and words of the progress."""

import subprocess
import sys
from pathlib import Path

import pytest

from roadproof.errors import InputError, LostWorkError, MissingSolverError, SharedError, TextError, UsageError
from roadproof.frontends.cli import main as command_line
from roadproof.runtime.budget import BudgetExceeded
from roadproof.runtime.progress import Cancelled, Stage, about, has_listener, listening, report_stage

ROADPROOF = Path(sys.executable).parent / "roadproof"


def test_whose_fault_an_error_is() -> None:
    codes = {
        UsageError: 2,
        InputError: 3,
        TextError: 3,
        MissingSolverError: 4,
        LostWorkError: 20,
        BudgetExceeded: 20,
        SharedError: 0,
        Cancelled: 130,
    }
    assert {kind: kind.exit_code for kind in codes} == codes


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_an_answer_that_cannot_be_written_is_no_answer() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run([ROADPROOF, "list"], stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 3
    assert done.stderr == (
        "roadproof: cannot write the answer: no space left on device; make room there, or write elsewhere\n"
    )


def test_an_answer_that_nobody_reads_is_not_delivered() -> None:
    command = [sys.executable, "-c", "import sys, time; time.sleep(0.2); sys.exit(0)"]
    reader = subprocess.Popen(command, stdin=subprocess.PIPE)
    assert reader.stdin is not None
    reader.wait()
    done = subprocess.run(
        [ROADPROOF, "list", "--json", "-"], stdout=reader.stdin, stderr=subprocess.PIPE, text=True
    )
    reader.stdin.close()
    assert (done.returncode, done.stderr) == (141, "")


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (OSError("a library gave up"), 70),
        (OSError(2, "No such file", "a.json"), 3),
        (PermissionError(13, "denied", "a.json"), 3),
        (ValueError("x"), 70),
        (KeyboardInterrupt(), 130),
        (LostWorkError("left out"), 20),
        (SharedError("done"), 0),
    ],
)
def test_the_exit_code_of_what_ends_a_command(
    error: BaseException, code: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_: object) -> int:
        raise error

    monkeypatch.delenv(command_line.TRACEBACK, raising=False)
    monkeypatch.setattr(command_line, "_run", fail)
    assert command_line.main(["list"]) == code


# --- progress ----------------------------------------------------------------------------------------


def test_stages_are_heard_inside_only_and_say_of_what_they_are() -> None:
    heard: list[Stage] = []
    with listening(heard.append):
        with about("claim 1"), about("its proof"):
            report_stage("prove", "lane 1")
        report_stage("search")
        with listening(None):
            assert has_listener()
            report_stage("judge")
    assert not has_listener()
    report_stage("explain")
    assert [(x.name, x.told, x.of) for x in heard] == [
        ("prove", "lane 1", "claim 1"),
        ("search", "", ""),
        ("judge", "", ""),
    ]
    assert str(heard[0]).startswith("claim 1: prove, lane 1 (after ")
