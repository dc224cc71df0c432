"""A cluster of dask, here one of two processes: the same answers, whatever happens to its workers."""

import os
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from roadproof.errors import InputError, LostWorkError, UsageError
from roadproof.runtime import dask_executor
from roadproof.runtime.executors import Cluster, Executor
from roadproof.runtime.pool import work
from roadproof.runtime.worker import is_worker

pytest.importorskip("distributed", reason="dask is not installed: pip install distributed")

TOLD: list[str] = []
HERE = Executor(cluster=Cluster("local:2", tell=TOLD.append))


def end_cluster() -> None:
    """End the cluster; the next question begins another."""
    assert HERE.cluster is not None
    client = dask_executor._client(HERE.cluster)
    cluster = client.cluster
    client.close()
    cluster.close()
    dask_executor._client.cache_clear()
    TOLD.clear()


@pytest.fixture(scope="module", autouse=True)
def ended() -> Iterator[None]:
    """Later tests fork this process, where threads of a cluster could hold locks."""
    yield
    end_cluster()


def square(job: int) -> int:
    assert is_worker()
    return job * job


class Deadly:
    """Squares; job 3 ends its process as often as said, counted by files in ``folder``."""

    def __init__(self, folder: Path, times: int) -> None:
        self.folder, self.times = folder, times

    def __call__(self, job: int) -> int:
        deaths = len(list(self.folder.iterdir()))
        if job == 3 and deaths < self.times:
            self.folder.joinpath(str(deaths)).touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return job * job


def refuse(job: int) -> int:
    if job == 2:
        raise InputError("job=2: it is not wanted")
    time.sleep(0.01)
    return job


def test_answers_of_a_cluster() -> None:
    assert dict(work(square, range(40), HERE)) == {k: k * k for k in range(40)}
    assert dict(work(square, range(2, 5), HERE)) == {0: 4, 1: 9, 2: 16}
    assert len(TOLD) == 1  # one cluster for all questions of a run
    assert TOLD[0].startswith("dashboard at http://127.0.0.1:")


@pytest.mark.parametrize("times", [1, 99])
def test_a_worker_that_ends_costs_at_most_its_own_job(times: int, tmp_path: Path) -> None:
    lost: Callable[[int, str], int] = lambda job, reason: -job  # noqa: E731
    found = dict(work(Deadly(tmp_path, times), range(8), HERE, lost))
    assert found == {k: k * k for k in range(8)} | ({3: -3} if times > 1 else {})
    if times > 1:
        with pytest.raises(LostWorkError, match="4 of 8 jobs: its workers ended each time"):
            list(work(Deadly(tmp_path, times), range(8), HERE))
        end_cluster()  # whether its workers come again depends on how busy the machine is


def test_an_error_is_raised_as_it_is_and_ends_the_others() -> None:
    with pytest.raises(InputError, match="job=2: it is not wanted"):
        list(work(refuse, range(50), HERE))


def test_other_versions_are_refused_before_any_work(monkeypatch: pytest.MonkeyPatch) -> None:
    list(work(square, range(2), HERE))
    monkeypatch.setattr(dask_executor, "_our_version", lambda: "0.0.7")
    with pytest.raises(UsageError, match=r"roadproof is 0\.0\.7 here and .* on workers; install the same"):
        list(work(square, range(2), HERE))


def test_a_scheduler_that_is_not_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dask_executor, "_PATIENCE", 1)
    with pytest.raises(InputError, match="no scheduler answers within 1 s"):
        list(work(square, range(2), Executor(cluster=Cluster("tcp://127.0.0.1:9"))))
