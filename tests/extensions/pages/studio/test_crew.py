"""Workers of the studio: warm, one job each, ended where they are to stop, replaced when they die."""

import asyncio
import os
import signal
import subprocess
import sys
from collections.abc import AsyncIterator, Callable, Coroutine
from contextlib import aclosing, asynccontextmanager
from typing import Any

import pytest

from extensions.pages.studio.serving import question
from roadproof.extensions.pages.studio.worker_pool import Message, PoolLimits, WorkerPool

pytestmark = pytest.mark.skipif(os.name != "posix", reason="processes are killed by signals of POSIX")

# Takes a solver about twenty seconds.
LONG = question("scenario_5(SV,POV,L) and not scenario_1(SV,POV,L)")
SHORT = question("v_lon(SV) > 3 m/s")


@asynccontextmanager
async def crew(limits: PoolLimits) -> AsyncIterator[WorkerPool]:
    made = WorkerPool(limits)
    await made.start()
    try:
        yield made
    finally:
        await made.end()


def conducted(test: Callable[[], Coroutine[Any, Any, None]]) -> Callable[[], None]:
    """The test in an event loop of its own."""

    def run() -> None:
        asyncio.run(test())

    run.__name__, run.__doc__ = test.__name__, test.__doc__
    return run


async def answer(made: WorkerPool, ask: dict[str, Any], seconds: float | None = None) -> Message:
    """The last word about a job."""
    async with aclosing(made.work("find", ask, seconds)) as told:
        return [message async for message in told][-1]


async def start_content(told: Any) -> Message:
    """A word that a worker has said of its job."""
    async for message in told:
        if message.get("stage"):
            return dict(message)
    raise AssertionError("the job said nothing")


def is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True


@conducted
async def test_a_job_that_nobody_listens_to_frees_the_processor() -> None:
    async with crew(PoolLimits(workers=1)) as made:
        async with aclosing(made.work("find", LONG)) as told:
            await start_content(told)
            process = made.every[0].process.pid
        assert not is_alive(process)


@conducted
async def test_a_worker_that_is_killed_costs_its_job_alone() -> None:
    async with crew(PoolLimits(workers=1)) as made:
        async with aclosing(made.work("find", LONG)) as told:
            await start_content(told)
            os.kill(made.every[0].process.pid, signal.SIGKILL)
            rest = [message async for message in told]
        assert "SIGKILL" in rest[-1]["error"]
        assert (await answer(made, SHORT))["answer"]["verdict"] == "WITNESSED"


@conducted
async def test_an_idle_worker_that_died_is_not_asked() -> None:
    async with crew(PoolLimits(workers=1)) as made:
        assert "answer" in await answer(made, SHORT)
        os.kill(made.every[0].process.pid, signal.SIGKILL)
        made.every[0].process.join()
        assert "answer" in await answer(made, SHORT)


@conducted
async def test_time_and_memory_of_a_job_have_limits_and_jobs_beyond_the_queue_are_refused() -> None:
    async with crew(PoolLimits(workers=1, waiting=1)) as made:
        assert "ended after 0.5 s" in (await answer(made, LONG, seconds=0.5))["error"]
        async with aclosing(made.work("find", LONG)) as first, aclosing(made.work("find", SHORT)) as second:
            await start_content(first)
            assert await anext(second) == {"waiting": True}
            refused = await anext(made.work("find", SHORT))
            assert (refused["full"], "1 jobs run and 1 wait" in str(refused["error"])) == (True, True)


@conducted
async def test_a_job_that_takes_too_much_memory_is_told_so() -> None:
    async with crew(PoolLimits(workers=1, memory=1)) as made:
        told = await answer(made, LONG)
        assert "memory" in told["error"] or "its process ended" in told["error"]


LIMITED = """
import resource
from roadproof.extensions.pages.studio.worker import _limit_memory
resource.setrlimit(resource.RLIMIT_AS, (2**40, 2**40))
_limit_memory({memory})
print(resource.getrlimit(resource.RLIMIT_AS)[0])
"""


@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
@pytest.mark.parametrize(("memory", "is_lower"), [(2**30, False), (1, True)])
def test_a_worker_keeps_to_the_limit_that_the_studio_was_started_with(memory: int, is_lower: bool) -> None:
    """Such as that of ``ulimit -v``; no process may raise it."""
    script = [sys.executable, "-c", LIMITED.format(memory=memory)]
    limit = int(subprocess.run(script, capture_output=True, text=True, check=True).stdout)
    assert limit < 2**40 if is_lower else limit == 2**40


@conducted
async def test_mistakes_of_a_user_are_words_and_the_worker_goes_on() -> None:
    async with crew(PoolLimits(workers=1)) as made:
        process = made.every[0].process.pid
        for ask in (question("danger(SV)"), question(negated=1, count=99), {}, {"draft": 3}):
            told = await answer(made, ask)
            assert "error" in told
            assert "Traceback" not in told["error"]
            assert "our fault" not in told["error"]
        assert made.every[0].process.pid == process
