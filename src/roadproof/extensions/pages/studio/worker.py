"""What a worker of the studio does: one job at a time, each a question of the page.

The server ends a worker that is to stop, since solvers do not answer politely.
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
    """The first job of a worker; ``memory``: MiB that jobs may take above what a warm worker has.

    ``long``: whether it is to be warm for jobs that may take long, too.
    """

    memory: int
    long: bool


@dataclass(frozen=True)
class Job:
    """What is asked, by the kind of the job."""

    kind: str
    ask: object


def serve(job: Job | WarmUp) -> dict[str, object]:
    """What the page is told of a job: ``answer`` or ``error``, and the seconds of processors as ``cpu``."""
    if isinstance(job, WarmUp):
        _warm_up(job)
        return {}
    before = _processor_time()
    told = _answered(job)
    return {**told, "cpu": round(_processor_time() - before, 3)}


def words_of(stage: Stage) -> str:
    """A stage of a job in words for the page."""
    return ", ".join(filter(None, (_STAGES.get(stage.name, stage.name), stage.told)))


def _warm_up(job: WarmUp) -> None:
    """Get ready for jobs; solvers that print reach nobody."""
    os.environ["ROADPROOF_QUIET"] = "1"
    with open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), 1)
    from roadproof.extensions.pages.studio.jobs import warm_up

    warm_up(job.long)
    _limit_memory(job.memory)


def _processor_time() -> float:
    """Seconds that this process has had of processors, with those of the processes that it waited for."""
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(x.ru_utime + x.ru_stime for x in used)


def _answered(job: Job) -> dict[str, object]:
    from roadproof.extensions.pages.studio.jobs import answer

    try:
        return {"answer": answer(job.kind, job.ask)}
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
    """Whether this process has had less than 64 MiB left; there, libraries fail in ways of their own."""
    most = resource.getrlimit(resource.RLIMIT_AS)[0]
    if sys.platform != "linux" or most == resource.RLIM_INFINITY:
        return False
    with open("/proc/self/status", encoding="ascii") as file:
        peak = next(int(line.split()[1]) * 1024 for line in file if line.startswith("VmPeak"))
    return peak > most - 64 * 2**20


def _limit_memory(memory: int) -> None:
    """Let allocations fail that go beyond; a worker that cannot go on then ends, which the server tells."""
    if sys.platform != "linux":
        return
    with open("/proc/self/statm", encoding="ascii") as file:
        used = int(file.read().split()[0]) * resource.getpagesize()
    allowed = resource.getrlimit(resource.RLIMIT_AS)[1]
    most = used + memory * 2**20
    most = most if allowed == resource.RLIM_INFINITY else min(most, allowed)
    resource.setrlimit(resource.RLIMIT_AS, (most, most))
