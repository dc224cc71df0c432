"""Jobs of which some are answered, some fail, some kill their process, and workers of several versions."""

import os
import signal
from collections.abc import Callable
from itertools import product
from pathlib import Path
from typing import Any

import pytest

from roadproof.errors import InputError, LostWorkError, UsageError
from roadproof.reasons import Reason, ReasonKind
from roadproof.runtime import dask_executor, process_pool, worker
from roadproof.runtime.budget import Budget, BudgetExceeded, Effort
from roadproof.runtime.dispatch import run_jobs
from roadproof.runtime.executors import Cluster, Executor, LostJob, Shard, run_with_retries
from roadproof.runtime.pool import in_order, work
from roadproof.runtime.process_pool import run_jobs as in_processes
from roadproof.runtime.progress import Stage, listening, report_stage
from roadproof.runtime.worker import describe_exit

OURS = "1.0.0"


# --- versions of workers ---------------------------------------------------------------------------


@pytest.mark.parametrize("theirs", [{OURS}, {OURS, "0.9.0"}, {"0.9.0"}, {"0.8.0", "0.9.0"}, set()])
def test_one_worker_of_another_version_is_enough_to_be_refused(theirs: set[str]) -> None:
    if theirs <= {OURS}:
        dask_executor._check_version(OURS, theirs)
        return
    with pytest.raises(UsageError, match="install the same on all"):
        dask_executor._check_version(OURS, theirs)


def test_a_worker_that_comes_later_is_asked_for_its_version(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_executor, "_our_version", lambda: "0.9.0")
    with pytest.raises(UsageError, match=r"is 1\.0\.0 here and 0\.9\.0 on workers"):
        dask_executor._serve(OURS, len, [])


class Client:
    """A scheduler whose workers have the versions ``theirs``."""

    dashboard_link = "http://127.0.0.1:1"

    def __init__(self, *_: object, **__: object) -> None:
        pass

    def run(self, *_: object) -> dict[str, str]:
        return {"tcp://one": dask_executor._our_version(), "tcp://two": "0.0.7"}


def test_every_worker_of_a_cluster_is_asked_for_its_version(monkeypatch: pytest.MonkeyPatch) -> None:
    distributed = pytest.importorskip("distributed", reason="dask is not installed")
    monkeypatch.setattr(distributed, "Client", Client)
    with pytest.raises(UsageError, match=r"0\.0\.7"):
        dask_executor._client.__wrapped__(Cluster("tcp://127.0.0.1:9"))


@pytest.mark.parametrize("given", list(product((None, "a"), (None, "b"), (None, "c"))))
def test_files_for_tls_are_all_used_and_then_required(given: tuple[str | None, ...]) -> None:
    made = dask_executor._security(Cluster("tls://host:1", *given), dict)
    names = ("tls_ca_file", "tls_client_cert", "tls_client_key")
    named = {name: x for name, x in zip(names, given, strict=True) if x is not None}
    assert made == ({**named, "require_encryption": True} if named else None)


# --- jobs that die or fail beside others that do not -------------------------------------------------


class Mixed:
    """Squares, but for jobs that kill their process as often as ``deaths`` says, or raise."""

    def __init__(self, folder: Path, deaths: dict[int, int], wrong: int | None = None) -> None:
        self.folder, self.deaths, self.wrong = folder, deaths, wrong

    def __call__(self, job: int) -> int:
        died = len(list(self.folder.glob(f"{job}-*")))
        if died < self.deaths.get(job, 0):
            (self.folder / f"{job}-{died}").touch()
            os.kill(os.getpid(), signal.SIGKILL)
        if job == self.wrong:
            raise InputError(f"job={job}")
        return job * job


@pytest.mark.parametrize("deaths", [{0: 9}, {3: 9}, {0: 9, 3: 9}, {1: 1, 2: 9}, {0: 2, 2: 1}])
def test_each_job_has_its_own_answer_or_is_lost(deaths: dict[int, int], tmp_path: Path) -> None:
    found = list(in_processes(Mixed(tmp_path, deaths), range(4), 2))
    assert sorted(place for place, _ in found) == [0, 1, 2, 3]
    for place, answer in found:
        if deaths.get(place, 0) > 2:
            assert isinstance(answer, LostJob)
            assert "SIGKILL (from outside or for want of memory)" in answer.reason
        else:
            assert answer == place * place


def test_an_error_beside_answers_is_raised_and_no_answer(tmp_path: Path) -> None:
    kept: list[object] = []
    with pytest.raises(InputError, match="job=2"):
        kept.extend(in_processes(Mixed(tmp_path, {}, wrong=2), range(4), 1))
    assert None not in kept


def test_lost_jobs_are_doubts_of_themselves(tmp_path: Path) -> None:
    lost: Callable[[int, Reason], int] = lambda job, reason: -job  # noqa: E731
    dying = Mixed(tmp_path, {2: 9, 3: 9})
    assert list(in_order(work(dying, range(5), 2, lost))) == [0, 1, -2, -3, 16]
    kept: list[int] = []
    (tmp_path / "more").mkdir()
    with pytest.raises(LostWorkError, match=r"3 of 5 jobs: .*; 4 of 5 jobs: ") as raised:
        kept.extend(in_order(work(Mixed(tmp_path / "more", {2: 9, 3: 9}), range(5), 2)))
    assert kept == [0, 1, 16]
    assert raised.value.exit_code == 20


def squares(job: int) -> list[int]:
    """A job that has jobs of its own: they are done in its process."""
    here = os.getpid()
    return [x if pid == here else -1 for _, (x, pid) in work(square_here, range(job), 2)]


def square_here(job: int) -> tuple[int, int]:
    return job * job, os.getpid()


def test_a_worker_does_the_jobs_of_its_job_itself() -> None:
    found = dict(work(squares, [2, 3], 2))
    assert found == {0: [0, 1], 1: [0, 1, 4]}


def staged(job: int) -> int:
    report_stage("solve", f"job {job}")
    return job


@pytest.mark.parametrize("processes", [1, 2])
def test_what_workers_are_at_is_heard_here(processes: int) -> None:
    heard: list[Stage] = []
    with listening(heard.append):
        assert dict(in_processes(staged, range(3), processes)) == {0: 0, 1: 1, 2: 2}
    assert sorted((x.name, x.told) for x in heard) == [("solve", f"job {k}") for k in range(3)]


def test_progress_counts_what_needed_no_work() -> None:
    said: list[tuple[int, int, str]] = []
    list(work(square_here, range(2), 2, progress=lambda *x: said.append(x), what="pieces", known=3))
    assert said == [(3, 5, "pieces"), (4, 5, "pieces"), (5, 5, "pieces")]


def test_answers_come_in_the_order_of_their_jobs() -> None:
    came = ((place, f"answer {place}") for place in (2, 0, 4, 1, 3))
    assert list(in_order(came)) == [f"answer {place}" for place in range(5)]


def test_a_lost_job_has_its_last_attempt_alone() -> None:
    """All at once, those that ended again, and what ends then alone."""
    asked: list[list[int]] = []

    def attempt(places, died):  # type: ignore[no-untyped-def]
        asked.append(list(places))
        for place in places:
            if place in (1, 3):
                died[place] = "SIGKILL"
            else:
                yield place, place

    found = dict(run_with_retries(attempt, 5, ReasonKind.PROCESS))
    assert asked == [[0, 1, 2, 3, 4], [1, 3], [1], [3]]
    assert {place: isinstance(x, LostJob) for place, x in found.items()} == {
        **dict.fromkeys((0, 2, 4), False),
        **dict.fromkeys((1, 3), True),
    }


def test_a_single_lost_job_is_tried_once_more() -> None:
    asked: list[list[int]] = []

    def attempt(places, died):  # type: ignore[no-untyped-def]
        asked.append(list(places))
        died.update((x, "SIGKILL") for x in places if x == 1)
        yield from ((x, x) for x in places if x != 1)

    found = dict(run_with_retries(attempt, 3, ReasonKind.PROCESS))
    assert asked == [[0, 1, 2], [1]]
    assert isinstance(found[1], LostJob)


def test_how_a_process_ended_is_told() -> None:
    assert [describe_exit(x) for x in (0, 3, -9, -11)] == [
        "exited with 0",
        "exited with 3",
        "SIGKILL",
        "SIGSEGV",
    ]
    [(_, lost)] = in_processes(os._exit, [0], 1)  # type: ignore[type-var]
    assert isinstance(lost, LostJob)
    assert "exited with 0" in lost.reason


def test_a_process_that_works_for_another_divides_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(worker, "_ends_here", False)
    assert not worker.is_worker()
    worker.mark_as_worker()
    assert worker.is_worker()


def test_where_no_further_process_can_be_started_the_others_go_on() -> None:
    def start() -> Any:
        raise OSError(11, "Resource temporarily unavailable")

    busy: Any = object()
    assert process_pool._free({busy: 3}, 2, start) is None
    with pytest.raises(UsageError, match="use fewer with --jobs"):
        process_pool._free({}, 2, start)
    assert process_pool._free({busy: 3}, 1, lambda: pytest.fail("one too many")) is None


def test_a_cluster_is_not_this_machine(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_executor, "run_jobs", lambda function, jobs, cluster: iter([(0, cluster)]))
    cluster = Cluster("tcp://host:1")
    assert list(run_jobs(len, [[]], Executor(cluster=cluster))) == [(0, cluster)]


# --- shares ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("of", [1, 2, 3, 7])
def test_every_piece_is_in_exactly_one_share(of: int) -> None:
    names = [f"piece-{k}" for k in range(40)]
    shards = [Shard(k, of) for k in range(1, of + 1)]
    assert all(sum(shard.includes(name) for shard in shards) == 1 for name in names)
    dealt = [name for shard in shards for name in shard.among(names)]
    assert sorted(dealt) == sorted(names)
    for wrong in (0, of + 1, -1):
        with pytest.raises(UsageError, match="write K/N"):
            Shard(wrong, of)


# --- work that is counted ----------------------------------------------------------------------------


def test_a_part_spends_what_the_whole_has() -> None:
    whole = Budget(10.0, 1000.0)
    part = whole.part(8.0)
    part.spend(6.0)
    assert (part.left(), whole.left()) == (2.0, 4.0)
    other = whole.part(8.0)
    assert other.left() == 4.0
    other.spend(4.0)
    assert [x.is_exhausted() for x in (part, other, whole)] == [True, True, True]
    assert (part.reason(), other.reason(), whole.reason()) == (ReasonKind.WORK(10.0),) * 3
    beside = whole.separate(5.0)
    assert (beside.left(), beside.is_exhausted(), beside.reason()) == (5.0, False, ReasonKind.WORK(5.0))


def test_what_is_used_up_exactly_is_used_up() -> None:
    budget = Budget(3.0, 1000.0)
    budget.spend(3.0)
    assert budget.is_exhausted()
    assert budget.left() == 0.0
    budget.spend(3.0)
    assert budget.left() == 0.0
    assert budget.effort() == Effort(1.0, pytest.approx(1000.0, abs=60))  # type: ignore[arg-type]


def test_the_clock_of_a_part_is_that_of_the_whole() -> None:
    started = Budget(10.0, 1000.0).started - 5000.0
    late = Budget(10.0, 1000.0, started=started)
    for meter in (late, late.part(3.0), late.separate(3.0)):
        for ask in (meter.seconds_left, meter.is_exhausted, meter.effort):
            with pytest.raises(BudgetExceeded, match="--timeout") as raised:
                ask()
            assert (raised.value.exit_code, raised.value.seconds) == (20, 1000.0)


@pytest.mark.parametrize(("units", "seconds"), [(1.0, 600.0), (10.0, 600.0), (60.0, 3600.0)])
def test_the_backstop_follows_from_the_work_unless_it_is_said(units: float, seconds: float) -> None:
    assert Effort(units).meter().seconds == seconds
    said = Effort(units, 7.0)
    assert said.meter().seconds == 7.0
    assert said.with_units(3.0) == Effort(3.0, 7.0)
    assert 0 < said.meter().effort().timeout <= 7.0  # type: ignore[operator]
    assert said.meter().effort().units == units
