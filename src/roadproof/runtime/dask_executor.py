"""Execution of jobs of 0.1 s to minutes on a dask cluster, whose workers may come and go."""

import gc
import importlib.metadata
from collections.abc import Callable, Generator, Sequence
from functools import cache, partial
from itertools import islice
from typing import TYPE_CHECKING, Any, TypeVar

from roadproof.errors import InputError, MissingSolverError, UsageError
from roadproof.reasons import ReasonKind
from roadproof.runtime.executors import Cluster, LostJob, run_with_retries
from roadproof.runtime.memory import keep_freed_memory
from roadproof.runtime.worker import mark_as_worker

if TYPE_CHECKING:
    from distributed import Client, Future

Job = TypeVar("Job")
Answer = TypeVar("Answer")

_PATIENCE = 30  # seconds for a scheduler to answer
# Dask itself retries no job that kills a worker. Workers neither profile themselves every 10 ms nor return
# memory to the system after each job.
_SETTINGS = {
    "distributed.scheduler.allowed-failures": 1,
    "distributed.worker.profile.enabled": False,
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 1 << 30,
}
_AHEAD = 2  # jobs for each worker that the scheduler holds, so that no worker is idle


def run_jobs(
    function: Callable[[Job], Answer], jobs: Sequence[Job], cluster: Cluster
) -> Generator[tuple[int, Answer | LostJob], None, None]:
    """Yield the index and the answer of every job on a cluster, as jobs finish.

    Files that a job reads must be visible to the workers. Raises ``MissingSolverError`` if dask is not
    installed, ``InputError`` if no scheduler answers, ``UsageError`` if workers have another version of
    roadproof.
    """
    client = _client(cluster)
    shared = client.submit(_identity, function, pure=False)  # dask recomputes it if its worker dies
    yield from run_with_retries(partial(_run_once, client, shared, jobs), len(jobs), ReasonKind.WORKERS)


def _run_once(
    client: "Client", shared: "Future", jobs: Sequence[Job], places: Sequence[int], died: dict[int, str]
) -> Generator[tuple[int, Any], None, None]:
    """Yield the answers at ``places``; if workers die, ``died`` gets the index, without a reason."""
    from distributed import as_completed
    from distributed.scheduler import KilledWorker

    waiting = iter(places)
    placed: dict[Future, int] = {}
    running = as_completed()

    def submit(count: int) -> None:
        """Send the next jobs to the scheduler."""
        for place in islice(waiting, count):
            future = client.submit(_serve, _our_version(), shared, jobs[place], pure=False)
            placed[future] = place
            running.add(future)

    try:
        submit(1)
        for future in running:
            workers = len(client.scheduler_info(n_workers=-1)["workers"])
            submit(max(1, _AHEAD * workers - len(placed) + 1))
            place, error = placed.pop(future), future.exception()
            if isinstance(error, KilledWorker):
                died[place] = ""
            elif error is not None:
                raise error
            else:
                yield place, future.result()
            future.release()
    finally:
        client.cancel(list(placed), force=True)


def _identity(function: Answer) -> Answer:
    return function


def _serve(version: str, function: Callable[[Job], Answer], job: Job) -> Answer:
    """Run a job on a worker, which may have joined after the versions were checked."""
    _check_version(version, {_our_version()})
    mark_as_worker()
    keep_freed_memory()
    answer = function(job)
    _freeze_objects()
    return answer


@cache
def _freeze_objects() -> None:
    """Exclude imported objects from garbage collection after the first job."""
    gc.freeze()


@cache
def _client(cluster: Cluster) -> "Client":
    """Return a client of the scheduler, which dask closes when this process ends."""
    try:
        import dask
        from distributed import Client, LocalCluster, Security
    except ImportError:
        raise MissingSolverError(
            "a cluster needs dask, which is not installed: pip install distributed"
        ) from None
    dask.config.set(_SETTINGS)
    if cluster.local:
        here = LocalCluster(
            n_workers=cluster.local, threads_per_worker=1, dashboard_address=":0", silence_logs=50
        )
        client = Client(here)
    else:
        try:
            client = Client(cluster.address, timeout=_PATIENCE, security=_security(cluster, Security))
        except (OSError, TimeoutError, ValueError) as error:
            raise InputError(
                f"cluster={cluster.address}: no scheduler answers within {_PATIENCE} s ({error}); start one "
                "with 'dask scheduler', or ask for local:N"
            ) from None
    if cluster.tell is not None:
        cluster.tell(f"dashboard at {client.dashboard_link}")
    try:
        versions = client.run(importlib.metadata.version, "roadproof")
    except importlib.metadata.PackageNotFoundError:
        raise UsageError("cluster: a worker has no roadproof; install the same version on all") from None
    _check_version(_our_version(), {str(x) for x in versions.values()})
    return client


def _security(cluster: Cluster, kind: Callable[..., Any]) -> Any:
    """Return the TLS settings; None if dask's configuration has them, or there are none."""
    files = {
        "tls_ca_file": cluster.authority,
        "tls_client_cert": cluster.certificate,
        "tls_client_key": cluster.key,
    }
    named = {name: file for name, file in files.items() if file is not None}
    return kind(**named, require_encryption=True) if named else None


def _our_version() -> str:
    return importlib.metadata.version("roadproof")


def _check_version(ours: str, theirs: set[str]) -> None:
    """Raise ``UsageError`` if workers have another version than ours."""
    if theirs - {ours}:
        listing = ", ".join(sorted(theirs))
        raise UsageError(
            f"cluster: roadproof is {ours} here and {listing} on workers; install the same on all"
        )
