"""Work for a cluster of dask, which lives here: jobs of 0.1 s to minutes, on workers that come and go."""

import gc
import importlib.metadata
from collections.abc import Callable, Generator, Sequence
from functools import cache, partial
from itertools import islice
from typing import TYPE_CHECKING, Any, TypeVar

from roadproof.errors import InputError, MissingSolverError, UsageError
from roadproof.reasons import Why
from roadproof.runtime.executors import Cluster, LostJob, try_again
from roadproof.runtime.memory import keep_freed_memory
from roadproof.runtime.worker import end_here

if TYPE_CHECKING:
    from distributed import Client, Future

Job = TypeVar("Job")
Answer = TypeVar("Answer")

_PATIENCE = 30  # seconds for a scheduler to answer
# What kills a worker is not tried again among others; workers neither look at their own stack every 10 ms nor
# give memory back all the time.
_SETTINGS = {
    "distributed.scheduler.allowed-failures": 1,
    "distributed.worker.profile.enabled": False,
    "distributed.nanny.pre-spawn-environ.MALLOC_TRIM_THRESHOLD_": 1 << 30,
}
_AHEAD = 2  # jobs for each worker that the scheduler has at once, so that none waits for its next one


def answers_of(
    function: Callable[[Job], Answer], jobs: Sequence[Job], cluster: Cluster
) -> Generator[tuple[int, Answer | LostJob], None, None]:
    """As ``workers.answers_of``, on a cluster. What a job needs of files has to be where workers see it.

    Raises ``MissingSolverError`` where dask is not installed, ``InputError`` where no scheduler answers,
    ``UsageError`` where workers have another version of roadproof.
    """
    client = _client(cluster)
    shared = client.submit(_same, function, pure=False)  # made again where its worker ends
    yield from try_again(partial(_try_once, client, shared, jobs), len(jobs), Why.WORKERS)


def _try_once(
    client: "Client", shared: "Future", jobs: Sequence[Job], places: Sequence[int], died: dict[int, str]
) -> Generator[tuple[int, Any], None, None]:
    """The answers at ``places``; where workers ended instead, ``died`` has the place, without a reason."""
    from distributed import as_completed
    from distributed.scheduler import KilledWorker

    waiting = iter(places)
    placed: dict[Future, int] = {}
    running = as_completed()

    def submit(count: int) -> None:
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


def _same(function: Answer) -> Answer:
    return function


def _serve(version: str, function: Callable[[Job], Answer], job: Job) -> Answer:
    """A job on a worker, which may have come after the versions were checked."""
    _check_version(version, {_our_version()})
    end_here()
    keep_freed_memory()
    answer = function(job)
    _freeze()
    return answer


@cache
def _freeze() -> None:
    """Once, after the first job: what it has imported stays, and is not walked through at each collection."""
    gc.freeze()


@cache
def _client(cluster: Cluster) -> "Client":
    """A client of the scheduler, which dask closes when this process ends."""
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
        found = client.run(importlib.metadata.version, "roadproof")
    except importlib.metadata.PackageNotFoundError:
        raise UsageError("cluster: a worker has no roadproof; install the same version on all") from None
    _check_version(_our_version(), {str(x) for x in found.values()})
    return client


def _security(cluster: Cluster, kind: Callable[..., Any]) -> Any:
    """How the scheduler is spoken to; None where dask's configuration says it, or nobody does."""
    given = {
        "tls_ca_file": cluster.authority,
        "tls_client_cert": cluster.certificate,
        "tls_client_key": cluster.key,
    }
    named = {name: file for name, file in given.items() if file is not None}
    return kind(**named, require_encryption=True) if named else None


def _our_version() -> str:
    return importlib.metadata.version("roadproof")


def _check_version(ours: str, theirs: set[str]) -> None:
    """Raises ``UsageError`` where there are others than ours."""
    if theirs - {ours}:
        told = ", ".join(sorted(theirs))
        raise UsageError(f"cluster: roadproof is {ours} here and {told} on workers; install the same on all")
