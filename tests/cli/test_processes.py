"""Signals, and processes that die: every run can be ended, and leaves nothing behind.

No test asserts how long something takes; the waits are bounds after which a run is said to hang.
"""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from roadproof.engines.prove.properties import choose, template_properties
from roadproof.engines.search.batches import Engines
from roadproof.errors import InputError, LostWorkError, MissingSolverError, TextError
from roadproof.evidence.answer import ClaimAnswer
from roadproof.evidence.claim import Claim
from roadproof.frontends.cli import supervising
from roadproof.frontends.cli.main import main
from roadproof.runtime import process_pool
from roadproof.runtime.budget import Cost
from roadproof.runtime.executors import LostJob
from roadproof.runtime.pool import in_order, work
from roadproof.runtime.process_pool import run_jobs

HANGS = 60.0

# A command whose jobs keep z3 busy for ever, in its own process or in those of two workers.
_BUSY = """
import os, sys
from roadproof.frontends.cli import main
from roadproof.runtime.pool import work
from roadproof.engines.solve.smt import Session

HARD = '(declare-const x Int)(declare-const y Int)(declare-const z Int)' \\
    '(assert (= (+ (* x x x) (* y y y) (* z z z)) 42))(check-sat)'

def ask(number):
    session = Session()
    os.write(1, b"%d " % os.getpid() + os.linesep.encode())
    session.tell(HARD)
    print('answered', flush=True)

def run(arguments):
    list(work(ask, range(int(arguments[0])), 2))
    return 0

main._run = run
sys.argv[1:] = {arguments!r}
sys.exit(main.main())
"""


def start(jobs: int) -> tuple[subprocess.Popen[str], list[int]]:
    """A command whose processes all ask z3, and their numbers."""
    process = subprocess.Popen(
        [sys.executable, "-c", _BUSY.replace("{arguments!r}", repr([str(jobs)]))],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert process.stdout is not None
    busy = [int(process.stdout.readline()) for _ in range(jobs)]
    time.sleep(0.5)  # so that z3 has begun
    return process, busy


def is_alive(process: int) -> bool:
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"


def all_end(processes: list[int]) -> bool:
    """Whether all of these end before it must be said that they hang."""
    latest = time.monotonic() + HANGS
    while time.monotonic() < latest:
        if not any(map(is_alive, processes)):
            return True
        time.sleep(0.05)
    return False


@pytest.mark.parametrize("jobs", [1, 2])
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
@pytest.mark.parametrize("whom", ["one", "all"])
def test_a_signal_ends_a_run_that_z3_keeps_busy(
    jobs: int, number: signal.Signals, code: int, whom: str
) -> None:
    """To all processes, as a terminal sends Ctrl-C, or to the one that was started."""
    process, busy = start(jobs)
    assert all(map(is_alive, busy))
    if whom == "all":
        os.killpg(process.pid, number)
    else:
        process.send_signal(number)
    said, complained = process.communicate(timeout=HANGS)
    assert process.returncode == code
    assert "answered" not in said
    assert complained == "roadproof: interrupted\n"
    assert all_end(busy)


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
@pytest.mark.parametrize("jobs", [1, 2])
def test_workers_do_not_outlive_a_killed_parent(jobs: int) -> None:
    process, busy = start(jobs)
    process.kill()
    process.communicate(timeout=HANGS)
    assert all_end(busy)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGKILL, 20), (signal.SIGSEGV, 70)])
def test_a_command_whose_process_dies_says_so(number: signal.Signals, code: int) -> None:
    process, busy = start(1)
    os.kill(busy[0], number)
    _, complained = process.communicate(timeout=HANGS)
    assert process.returncode == code
    assert f"ended by {number.name}" in complained
    assert "Traceback" not in complained


# --- workers that die ------------------------------------------------------------------------------


class Dying:
    """Squares; ``deadly`` jobs kill their process as often as said, counted by files in ``folder``."""

    def __init__(self, folder: Path, deadly: dict[int, int], by: int = signal.SIGKILL) -> None:
        self.folder, self.deadly, self.by = folder, deadly, by

    def __call__(self, job: int) -> int:
        deaths = len(list(self.folder.glob(f"{job}-*")))
        if deaths < self.deadly.get(job, 0):
            self.folder.joinpath(f"{job}-{deaths}").touch()
            os.kill(os.getpid(), self.by)
        return job * job


@pytest.mark.parametrize("processes", [1, 2, 5])
def test_a_job_whose_worker_dies_is_tried_again(processes: int, tmp_path: Path) -> None:
    found = dict(run_jobs(Dying(tmp_path, {1: 1, 3: 1}), range(6), processes))
    assert found == {k: k * k for k in range(6)}
    assert len(list(tmp_path.iterdir())) == 2


@pytest.mark.parametrize("processes", [1, 2, 5])
def test_a_job_that_always_kills_is_left_out_alone(processes: int, tmp_path: Path) -> None:
    found = dict(run_jobs(Dying(tmp_path, {1: 9, 3: 1}), range(6), processes))
    lost = found.pop(1)
    assert isinstance(lost, LostJob)
    assert "SIGKILL" in lost.reason
    assert "ended each time" in lost.reason
    assert found == {k: k * k for k in range(6) if k != 1}
    assert len(list(tmp_path.glob("1-*"))) == 3  # with all, with those that ended, alone


def test_other_deaths_are_named(tmp_path: Path) -> None:
    [(_, lost)] = run_jobs(Dying(tmp_path, {0: 9}, signal.SIGUSR1), [0], 1)
    assert isinstance(lost, LostJob)
    assert "SIGUSR1" in lost.reason
    [(_, lost)] = run_jobs(os._exit, [3], 1)  # type: ignore[type-var]
    assert isinstance(lost, LostJob)
    assert "exited with 3" in lost.reason


def test_what_is_lost_is_a_doubt_or_an_error_at_the_end(tmp_path: Path) -> None:
    dying = Dying(tmp_path, {1: 9})
    doubts = list(in_order(work(dying, range(4), 2, lambda job, reason: -job)))
    assert doubts == [0, -1, 4, 9]
    answers = in_order(work(Dying(tmp_path / "none", {}), range(3), 2))
    assert list(answers) == [0, 1, 4]
    kept: list[int] = []
    tmp_path.joinpath("more").mkdir()
    with pytest.raises(LostWorkError, match="2 of 4 numbers: its process ended each time") as raised:
        kept.extend(in_order(work(Dying(tmp_path / "more", {1: 9}), range(4), 2, what="numbers")))
    assert raised.value.exit_code == 20
    assert kept == [0, 4, 9]


def fail(job: int) -> int:
    raise [
        InputError("job=1"),
        MissingSolverError("solver=x"),
        TextError("'x' cannot stand here").locate("claim", "x"),
        ZeroDivisionError("division by zero"),
    ][job]


@pytest.mark.parametrize("job", range(4))
def test_an_error_in_a_worker_is_raised_as_it_is(job: int) -> None:
    with pytest.raises(Exception, match=r".+") as here:
        fail(job)
    with pytest.raises(type(here.value)) as there:
        list(run_jobs(fail, [job], 1))
    assert str(there.value) == str(here.value)


def give_back(job: int) -> Callable[[], int]:
    return lambda: job


def test_what_cannot_be_sent_is_an_error_and_no_hang() -> None:
    with pytest.raises(RuntimeError, match="pickle"):
        list(run_jobs(give_back, [1, 2], 2))


@dataclass(frozen=True)
class KindredJob:
    affinity: str


def test_a_worker_does_kin_one_after_the_other_and_helps_others_at_last() -> None:
    waiting = process_pool._Waiting([KindredJob(x) for x in "aabbcbc"], range(7))
    given = [(worker, waiting.pop(worker)) for worker in "XYXYYYX"]
    assert given == [("X", 0), ("Y", 2), ("X", 1), ("Y", 3), ("Y", 5), ("Y", 4), ("X", 6)]
    assert not waiting
    plain = process_pool._Waiting("aab", range(3))
    assert [plain.pop(worker) for worker in "XYX"] == [0, 1, 2]


def test_claims_about_a_scenario_and_the_same_on_other_road_sectors_are_kin() -> None:
    tasks = choose(template_properties(), ["P1", "P3"], "base")
    affinity: dict[object, list[int | None]] = {}
    for task in tasks:
        affinity.setdefault(task.affinity, []).append(task.scenario)
    assert [*affinity.values()] == [[n, n + 8, n + 16] * 2 for n in range(1, 9)]


def test_a_claim_whose_process_dies_is_unknown_and_the_others_stand(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    settle = Engines.answer_claim

    def settle_or_die(engines: Engines, claim: Claim, *more: Any) -> tuple[ClaimAnswer, Cost]:
        if claim.text == "false":
            os.kill(os.getpid(), signal.SIGKILL)
        return settle(engines, claim, *more)

    monkeypatch.setattr(Engines, "answer_claim", settle_or_die)
    monkeypatch.setattr("roadproof.questions.decide.is_fork_unsafe", lambda: False)
    claims = ["true", "false", "not false"]
    target = tmp_path / "answer.json"
    assert main(["prove", *claims, "--jobs", "2", "--json", str(target)]) == 20
    said = capsys.readouterr()
    assert "PROVED  true" in said.out
    assert "UNKNOWN  false" in said.out
    assert "ended each time" in said.out
    verdicts = json.loads(target.read_text("utf-8"))["verdicts"]
    assert [x["verdict"] for x in verdicts] == ["PROVED", "UNKNOWN", "PROVED"]


# --- a word about how far it is --------------------------------------------------------------------

_SLOW = """
import sys, time
from roadproof.frontends.cli import main, progress, supervising
supervising.BEAT = 0.2

def run(arguments):
    progress.be_quiet('--quiet' in arguments)
    progress.tell('3 of 7 claims, about 2 min left')
    time.sleep(1.5)
    return 0

main._run = run
sys.exit(main.main())
"""


@pytest.mark.parametrize(
    ("arguments", "environment", "told"),
    [([], {}, True), (["--quiet"], {}, False), ([], {"ROADPROOF_QUIET": "1"}, False)],
)
def test_it_says_now_and_then_how_far_it_is(
    arguments: list[str], environment: dict[str, str], told: bool
) -> None:
    silent = {name: value for name, value in os.environ.items() if name != "ROADPROOF_QUIET"}
    done = subprocess.run(
        [sys.executable, "-c", _SLOW, *arguments],
        capture_output=True,
        text=True,
        env={**silent, **environment},
        timeout=HANGS,
    )
    assert done.returncode == 0
    assert done.stdout == ""
    assert ("roadproof: 3 of 7 claims, about 2 min left (after " in done.stderr) is told
    assert bool(done.stderr) is told
    assert supervising.BEAT == 30.0


def test_the_time_left_is_estimated_of_pieces_that_are_alike_only(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The first claims of a long run took a second each, the last one two minutes."""
    from roadproof.frontends.cli import progress

    lines: list[str] = []
    monkeypatch.setattr(progress, "tell", lambda text, last=False: lines.append(text))
    clock = iter([0.0, *(10.0 * k for k in range(20))])
    monkeypatch.setattr("roadproof.frontends.cli.progress.time.monotonic", lambda: next(clock))
    for what in ("recordings", "claims"):
        told = progress.Counter()
        for done in range(4):
            told(done, 10, what)
    assert [line for line in lines if "left" in line] == [
        x for x in lines if x.startswith(("2 of 10 r", "3 of 10 r"))
    ]
    assert not any("left" in line for line in lines if "claims" in line)


def test_the_time_left_is_told_where_it_is_known() -> None:
    from roadproof.frontends.cli.progress import time_left

    assert time_left(10.0, 0, 4) == ""
    assert time_left(10.0, 4, 4) == ""
    assert time_left(10.0, 1, 4) == ", about 30 s left"
    assert time_left(600.0, 2, 10) == ", about 40 min left"
    assert time_left(6000.0, 1, 2) == ", about 1 h 40 min left"
