"""The worker process of the studio: it runs one job at a time.

To stop a job the server kills the worker, since solvers do not react to requests to stop.
"""

import os
import resource
import sys
from dataclasses import dataclass

from roadproof.errors import RoadproofError
from roadproof.runtime.progress import Stage

_STAGES = {
    "prove": "looking for a proof",
    "encode": "encoding the formula",
    "solve": "looking for a drive",
    "shape": "shaping the drive",
    "judge": "judging the drive",
    "refute": "proving that no drive exists on the grid",
    "explain": "looking for a proof that no drive exists",
}


@dataclass(frozen=True)
class WarmUp:
    """The first job of a worker; ``memory``: MiB that jobs may take beyond a warm worker.

    ``long``: whether to warm up for jobs that may take long, too.
    """

    memory: int
    long: bool


@dataclass(frozen=True)
class Job:
    """A question of the page with the kind of its job."""

    kind: str
    question: object


def serve(job: Job | WarmUp) -> dict[str, object]:
    """Run a job; return ``answer`` or ``error`` for the page, and the processor seconds as ``cpu``."""
    if isinstance(job, WarmUp):
        _warm_up(job)
        return {}
    before = _processor_time()
    reply = _answer_or_error(job)
    return {**reply, "cpu": round(_processor_time() - before, 3)}


def words_of(stage: Stage) -> str:
    """Return a stage of a job in words for the page."""
    return ", ".join(filter(None, (_STAGES.get(stage.name, stage.name), stage.told)))


def _warm_up(job: WarmUp) -> None:
    """Prepare for jobs; output of solvers to stdout is discarded."""
    os.environ["ROADPROOF_QUIET"] = "1"
    with open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), 1)
    from roadproof.extensions.pages.studio.jobs import warm_up

    warm_up(job.long)
    _limit_memory(job.memory)


def _processor_time() -> float:
    """Return the processor seconds of this process and of the processes that it waited for."""
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(x.ru_utime + x.ru_stime for x in used)


def _answer_or_error(job: Job) -> dict[str, object]:
    from roadproof.extensions.pages.studio.jobs import answer

    try:
        return {"answer": answer(job.kind, job.question)}
    except RoadproofError as error:
        return {"error": str(error), "exit_code": error.exit_code}
    except MemoryError:
        return {"error": "the job takes more memory than a job may: ask for less, or on the command line"}
    except RecursionError:
        return {"error": "the formula is nested too deep: give its parts names"}
    except Exception as error:
        fault = f"{type(error).__name__}: {error}"
        if _came_near_the_limit():
            return {
                "error": f"the job failed at the limit of the memory that a job may take ({fault}): "
                "ask for less, or on the command line"
            }
        return {"error": f"this is our fault: {fault}", "exit_code": 70}


def _came_near_the_limit() -> bool:
    """Return whether this process had less than 64 MiB left, where libraries fail in ways of their own."""
    most = resource.getrlimit(resource.RLIMIT_AS)[0]
    if sys.platform != "linux" or most == resource.RLIM_INFINITY:
        return False
    with open("/proc/self/status", encoding="ascii") as file:
        peak = next(int(line.split()[1]) * 1024 for line in file if line.startswith("VmPeak"))
    return peak > most - 64 * 2**20


def _limit_memory(memory: int) -> None:
    """Make allocations beyond ``memory`` MiB fail; a worker that cannot go on ends, which the
    server reports.
    """
    if sys.platform != "linux":
        return
    with open("/proc/self/statm", encoding="ascii") as file:
        used = int(file.read().split()[0]) * resource.getpagesize()
    allowed = resource.getrlimit(resource.RLIMIT_AS)[1]
    most = used + memory * 2**20
    most = most if allowed == resource.RLIM_INFINITY else min(most, allowed)
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
