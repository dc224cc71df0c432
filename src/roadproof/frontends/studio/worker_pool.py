"""Workers for the jobs of a page: warm, one job each, ended where they are to stop and replaced at once."""

import asyncio
import contextlib
import json
import os
import signal
import sys
import time
from collections.abc import AsyncGenerator, Mapping
from dataclasses import dataclass, field

from roadproof.errors import RoadproofError
from roadproof.runtime.executors import OUTSIDE, ended_by

BEAT = 0.25  # seconds between two words about a job that runs
LONGEST_LINE = 256 * 2**20
Message = dict[str, object]


@dataclass(frozen=True)
class Limits:
    """``workers`` processes, warm for ``long`` jobs or for those of a moment; at most ``waiting`` jobs that
    none of them has begun; a job may take ``seconds`` of the clock and ``memory`` MiB.
    """

    workers: int = 2
    waiting: int = 8
    seconds: float = 600.0
    memory: int = 3072
    long: bool = True


class FullError(RoadproofError):
    """There is no place for a job."""

    exit_code = 20


@dataclass
class Worker:
    """A process with its pipe; ``warm`` is done once it takes jobs."""

    process: asyncio.subprocess.Process
    warm: "asyncio.Task[None]"

    @classmethod
    async def start(cls, limits: Limits) -> "Worker":
        process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "roadproof.frontends.studio.worker"),
            *(str(limits.memory), "long" if limits.long else "live"),
            stdin=asyncio.subprocess.PIPE,
            stdout=asyncio.subprocess.PIPE,
            limit=LONGEST_LINE,
            start_new_session=True,
            env={**os.environ, "ROADPROOF_QUIET": "1"},
        )
        return cls(process, asyncio.create_task(_until_ready(process)))

    async def end(self) -> None:
        """Kill it, and what it has started."""
        self.warm.cancel()
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGKILL)
        await self.process.wait()


async def _until_ready(process: asyncio.subprocess.Process) -> None:
    assert process.stdout is not None
    await process.stdout.readline()


@dataclass
class WorkerPool:
    """Workers; to be started and ended in one event loop."""

    limits: Limits = field(default_factory=Limits)
    idle: "asyncio.Queue[Worker]" = field(default_factory=asyncio.Queue)
    every: list[Worker] = field(default_factory=list)
    waiting: int = 0
    closed: bool = False

    async def start(self, one_by_one: bool = False) -> None:
        """Start its workers; ``one_by_one``: each when the one before is warm, for others to work."""
        for _ in range(self.limits.workers):
            await self._add()
            if one_by_one and self.every:
                await asyncio.wait({self.every[-1].warm})

    async def _add(self) -> None:
        if self.closed:
            return
        worker = await Worker.start(self.limits)
        self.every.append(worker)
        self.idle.put_nowait(worker)

    async def end(self) -> None:
        """End all workers and their jobs."""
        self.closed = True
        await asyncio.gather(*(worker.end() for worker in self.every))
        self.every.clear()

    async def work(
        self, kind: str, ask: Mapping[str, object], seconds: float | None = None
    ) -> AsyncGenerator[Message, None]:
        """What is told of a job: ``waiting``, ``stage`` and ``seconds`` while it runs, ``answer`` or
        ``error`` at last. A job whose listener goes away (``aclose``) is ended with its worker.
        """
        if self.waiting >= self.limits.waiting:
            raise FullError(
                f"the queue is full: {len(self.every)} jobs run and {self.waiting} wait; stop one, or wait"
            )
        self.waiting += 1
        try:
            getting = asyncio.ensure_future(self._take())
            try:
                while not (await asyncio.wait({getting}, timeout=BEAT))[0]:
                    yield {"waiting": True}
            except BaseException:
                await self._give_back(getting)
                raise
        finally:
            self.waiting -= 1
        async with contextlib.aclosing(self._run(getting.result(), kind, ask, seconds)) as told:
            async for message in told:
                yield message

    async def _take(self) -> Worker:
        """A warm worker that lives."""
        while True:
            worker = await self.idle.get()
            try:
                await asyncio.shield(worker.warm)
            except asyncio.CancelledError:
                if not worker.warm.cancelled():
                    self.idle.put_nowait(worker)
                    raise
            if worker.process.returncode is None:
                return worker
            await self._replace(worker)

    async def _give_back(self, getting: "asyncio.Future[Worker]") -> None:
        getting.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            self.idle.put_nowait(await getting)

    async def _replace(self, worker: Worker) -> None:
        await worker.end()
        if worker in self.every:
            self.every.remove(worker)
        await self._add()

    async def _run(
        self, worker: Worker, kind: str, ask: Mapping[str, object], seconds: float | None
    ) -> AsyncGenerator[Message, None]:
        """One job of a worker. Whatever ends it before it is answered ends the worker too."""
        most = self.limits.seconds if seconds is None else seconds
        begun = time.monotonic()
        stage, done = "", False
        assert worker.process.stdin is not None
        assert worker.process.stdout is not None
        reading: asyncio.Task[bytes] | None = None
        try:
            with contextlib.suppress(ConnectionError):
                worker.process.stdin.write((json.dumps({"kind": kind, "ask": ask}) + "\n").encode())
                await worker.process.stdin.drain()
            while not done:
                if reading is None:
                    reading = asyncio.create_task(worker.process.stdout.readline())
                ready, _ = await asyncio.wait({reading}, timeout=BEAT)
                spent = time.monotonic() - begun
                if not ready:
                    if spent > most:
                        yield {"error": f"ended after {most:g} s, which is the most that a job may take"}
                        return
                    yield {"stage": stage, "seconds": round(spent, 1)}
                    continue
                line, reading = reading.result(), None
                if not line:
                    yield {"error": await _cause_of_death(worker)}
                    return
                message = json.loads(line)
                stage = message.get("stage", stage)
                done = "stage" not in message
                yield {**message, "seconds": round(spent, 3)}
        finally:
            if reading is not None:
                reading.cancel()
            if done and worker.process.returncode is None:
                self.idle.put_nowait(worker)
            else:
                await asyncio.shield(asyncio.ensure_future(self._replace(worker)))


async def _cause_of_death(worker: Worker) -> str:
    by = ended_by(await worker.process.wait())
    return f"its process ended ({by}), {OUTSIDE}; ask again"
