"""Workers for the jobs of a page: warm, one job each, ended where they are to stop and replaced at once."""

import asyncio
import contextlib
import time
from collections.abc import AsyncGenerator, Mapping
from dataclasses import dataclass, field

from roadproof.extensions.pages.studio.worker import Job, WarmUp, serve, words_of
from roadproof.runtime.progress import Stage
from roadproof.runtime.worker import DeadWorkerError, Reply, Worker
from roadproof.verdict import ExitCode

BEAT = 0.25  # seconds between two words about a job that runs
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


class StudioWorker(Worker):
    """A worker that is heard without blocking; ``warm`` is done once it takes jobs."""

    def __init__(self, limits: Limits) -> None:
        super().__init__(serve, fresh=True)
        self.ask(WarmUp(limits.memory, limits.long))
        self.warm = asyncio.create_task(self._until_warm())

    async def _until_warm(self) -> None:
        said: Stage | Reply | None = None
        with contextlib.suppress(DeadWorkerError):
            while not isinstance(said, Reply):
                said = await self.hear_within(None)
            if said.error is not None:
                self.process.kill()

    async def hear_within(self, seconds: float | None) -> Stage | Reply | None:
        """Its next word; None where it says none for so long. Raises ``DeadWorkerError``."""
        said = asyncio.Event()
        loop = asyncio.get_running_loop()
        loop.add_reader(self.connection.fileno(), said.set)
        try:
            await asyncio.wait_for(said.wait(), seconds)
        except TimeoutError:
            return None
        finally:
            loop.remove_reader(self.connection.fileno())
        return self.hear()

    async def end(self) -> None:
        """Kill it."""
        self.warm.cancel()
        self.process.kill()
        await asyncio.to_thread(self.process.join)


@dataclass
class WorkerPool:
    """Workers; to be started and ended in one event loop."""

    limits: Limits = field(default_factory=Limits)
    idle: "asyncio.Queue[StudioWorker]" = field(default_factory=asyncio.Queue)
    every: list[StudioWorker] = field(default_factory=list)
    waiting: int = 0
    closed: bool = False

    async def start(self) -> None:
        """Start its workers, each when the one before is warm, so that others can work meanwhile."""
        for _ in range(self.limits.workers):
            self._add()
            if self.every:
                await asyncio.wait({self.every[-1].warm})

    def _add(self) -> None:
        if not self.closed:
            self.every.append(StudioWorker(self.limits))
            self.idle.put_nowait(self.every[-1])

    async def end(self) -> None:
        """End all workers and their jobs."""
        self.closed = True
        await asyncio.gather(*(worker.end() for worker in self.every))
        self.every.clear()

    async def work(
        self, kind: str, ask: Mapping[str, object], seconds: float | None = None
    ) -> AsyncGenerator[Message, None]:
        """What is told of a job: ``waiting``, ``stage`` and ``seconds`` while it runs, ``answer`` or
        ``error`` at last, which is ``full`` where the queue is. A job whose listener goes away (``aclose``)
        is ended with its worker.
        """
        if self.waiting >= self.limits.waiting:
            busy = f"{len(self.every)} jobs run and {self.waiting} wait; stop one, or wait"
            yield {"error": f"the queue is full: {busy}", "full": True}
            return
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

    async def _take(self) -> StudioWorker:
        """A warm worker that lives."""
        while True:
            worker = await self.idle.get()
            try:
                await asyncio.shield(worker.warm)
            except asyncio.CancelledError:
                if not worker.warm.cancelled():
                    self.idle.put_nowait(worker)
                    raise
            if worker.process.is_alive():
                return worker
            await self._replace(worker)

    async def _give_back(self, getting: "asyncio.Future[StudioWorker]") -> None:
        getting.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            self.idle.put_nowait(await getting)

    async def _replace(self, worker: StudioWorker) -> None:
        await worker.end()
        if worker in self.every:
            self.every.remove(worker)
        self._add()

    async def _run(
        self, worker: StudioWorker, kind: str, ask: Mapping[str, object], seconds: float | None
    ) -> AsyncGenerator[Message, None]:
        """One job of a worker. Whatever ends it before it is answered ends the worker too."""
        most = self.limits.seconds if seconds is None else seconds
        begun = time.monotonic()
        stage, done = "", False
        try:
            worker.ask(Job(kind, ask))
            while not done:
                said = await worker.hear_within(BEAT)
                spent = time.monotonic() - begun
                if isinstance(said, Reply):
                    done = True
                    fault = {"error": f"this is our fault: {said.error}", "exit_code": ExitCode.OUR_FAULT}
                    yield {**(said.answer or fault), "seconds": round(spent, 3)}
                elif spent > most:
                    yield {"error": f"ended after {most:g} s, which is the most that a job may take"}
                    return
                else:
                    stage = stage if said is None else words_of(said)
                    yield {"stage": stage, "seconds": round(spent, 1)}
        except DeadWorkerError as death:
            yield {"error": f"its process ended: {death}; it may have run out of memory; ask again"}
        finally:
            if done and worker.process.is_alive():
                self.idle.put_nowait(worker)
            else:
                await asyncio.shield(asyncio.ensure_future(self._replace(worker)))
