"""A worker of the studio: one process, one pipe, one job at a time. Run as ``python -m`` this module.

Jobs come as JSON lines on stdin and are answered on what was stdout; solvers that print reach nobody. The
server ends a worker that is to stop, since solvers do not answer politely.
"""

import json
import os
import resource
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TextIO, TypeAlias

from roadproof.errors import RoadproofError
from roadproof.runtime.parent_watchdog import die_with

Say: TypeAlias = Callable[[str], None]


def main(memory: int, long: bool) -> int:
    """Answer jobs until stdin ends; ``memory``: MiB that jobs may take above what a warm worker has.

    ``long``: whether it is warm for jobs that may take long, too.
    """
    die_with(os.getppid())
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    with open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), 1)
    from roadproof.frontends.studio.jobs import answer, warm_up

    warm_up(long)
    _limit_memory(memory)
    _tell(answers, {"ready": True})
    for line in sys.stdin:
        job = Job(**json.loads(line))

        def say(stage: str) -> None:
            _tell(answers, {"stage": stage})

        before = _processor_time()
        told = _answered(answer, job, say)
        _tell(answers, {**told, "cpu": round(_processor_time() - before, 3)})
    return 0


def _processor_time() -> float:
    """Seconds that this process has had of processors, with those of the processes that it waited for."""
    used = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(x.ru_utime + x.ru_stime for x in used)


@dataclass(frozen=True)
class Job:
    """A line on stdin: what is asked, by the kind of the job."""

    kind: str
    ask: object


def _answered(answer: Callable[[str, object, Say], object], job: Job, say: Say) -> dict[str, object]:
    try:
        return {"answer": answer(job.kind, job.ask, say)}
    except RoadproofError as error:
        return {"error": str(error), "exit_code": error.exit_code}
    except MemoryError:
        return {"error": "the job takes more memory than a job may: ask for less, or on the command line"}
    except RecursionError:
        return {"error": "the formula is nested too deep: give its parts names"}
    except Exception as error:
        return {"error": f"this is our fault: {type(error).__name__}: {error}", "exit_code": 70}


def _limit_memory(memory: int) -> None:
    """Let allocations fail that go beyond; a worker that cannot go on then ends, which the server tells."""
    if sys.platform != "linux":
        return
    with open("/proc/self/statm", encoding="ascii") as file:
        used = int(file.read().split()[0]) * resource.getpagesize()
    most = used + memory * 2**20
    resource.setrlimit(resource.RLIMIT_AS, (most, most))


def _tell(answers: TextIO, message: Mapping[str, object]) -> None:
    answers.write(json.dumps(message) + "\n")
    answers.flush()


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]), sys.argv[2] == "long"))
