"""A pool of warm workers for the jobs of a page; a worker that has to stop is killed and replaced."""

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
class PoolLimits:
    """The limits of a pool.

    ``workers``: the number of processes; ``long``: warm them up for long jobs; ``waiting``: the most jobs
    that may wait; ``seconds`` and ``memory`` (MiB): the most that a job may take.
    """

    workers: int = 2
    waiting: int = 8
    seconds: float = 600.0
    memory: int = 3072
    long: bool = True


class StudioWorker(Worker):
    """A worker whose messages are awaited without blocking; the task ``warm`` ends when it is
    ready for jobs.
    """

    def __init__(self, limits: PoolLimits) -> None:
        super().__init__(serve, fresh=True)
        self.send_job(WarmUp(limits.memory, limits.long))
        self.warm = asyncio.create_task(self._until_warm())

    async def _until_warm(self) -> None:
        message: Stage | Reply | None = None
        with contextlib.suppress(DeadWorkerError):
            while not isinstance(message, Reply):
                message = await self.hear_within(None)
            if message.error is not None:
                self.process.kill()

    async def hear_within(self, seconds: float | None) -> Stage | Reply | None:
        """Return its next message, None after ``seconds`` without one. Raises ``DeadWorkerError``."""
        readable = asyncio.Event()
        loop = asyncio.get_running_loop()
        loop.add_reader(self.connection.fileno(), readable.set)
        try:
            await asyncio.wait_for(readable.wait(), seconds)
        except TimeoutError:
            return None
        finally:
            loop.remove_reader(self.connection.fileno())
        return self.receive()

    async def end(self) -> None:
        """Kill the worker."""
        self.warm.cancel()
        self.process.kill()
        await asyncio.to_thread(self.process.join)


@dataclass
class WorkerPool:
    """A pool of workers, to be started and ended in one event loop."""

    limits: PoolLimits = field(default_factory=PoolLimits)
    idle: "asyncio.Queue[StudioWorker]" = field(default_factory=asyncio.Queue)
    every: list[StudioWorker] = field(default_factory=list)
    waiting: int = 0
    closed: bool = False

    async def start(self) -> None:
        """Start the workers, each when the one before is warm, so that others can work meanwhile."""
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
        self, kind: str, question: Mapping[str, object], seconds: float | None = None
    ) -> AsyncGenerator[Message, None]:
        """Yield messages about a job: ``waiting``, ``stage`` and ``seconds`` while it runs, then ``answer``
        or ``error``.

        An error is ``full`` where the queue is full. A job whose listener leaves (``aclose``) is ended with
        its worker.
        """
        if self.waiting >= self.limits.waiting:
            busy = f"{len(self.every)} jobs run and {self.waiting} wait; stop one, or wait"
            yield {"error": f"the queue is full: {busy}", "full": True}
            return
        self.waiting += 1
        try:
            pending_worker = asyncio.ensure_future(self._take())
            try:
                while not (await asyncio.wait({pending_worker}, timeout=BEAT))[0]:
                    yield {"waiting": True}
            except BaseException:
                await self._give_back(pending_worker)
                raise
        finally:
            self.waiting -= 1
        async with contextlib.aclosing(
            self._run(pending_worker.result(), kind, question, seconds)
        ) as messages:
            async for message in messages:
                yield message

    async def _take(self) -> StudioWorker:
        """Return a warm worker that is alive."""
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

    async def _give_back(self, pending_worker: "asyncio.Future[StudioWorker]") -> None:
        pending_worker.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            self.idle.put_nowait(await pending_worker)

    async def _replace(self, worker: StudioWorker) -> None:
        await worker.end()
        if worker in self.every:
            self.every.remove(worker)
        self._add()

    async def _run(
        self, worker: StudioWorker, kind: str, question: Mapping[str, object], seconds: float | None
    ) -> AsyncGenerator[Message, None]:
        """Run one job on a worker; whatever ends it before its answer ends the worker, too."""
        most = self.limits.seconds if seconds is None else seconds
        started = time.monotonic()
        stage, done = "", False
        try:
            worker.send_job(Job(kind, question))
            while not done:
                message = await worker.hear_within(BEAT)
                spent = time.monotonic() - started
                if isinstance(message, Reply):
                    done = True
                    fault = {"error": f"this is our fault: {message.error}", "exit_code": ExitCode.OUR_FAULT}
                    yield {**(message.answer or fault), "seconds": round(spent, 3)}
                elif spent > most:
                    yield {"error": f"ended after {most:g} s, which is the most that a job may take"}
                    return
                else:
                    stage = stage if message is None else words_of(message)
                    yield {"stage": stage, "seconds": round(spent, 1)}
        except DeadWorkerError as death:
            yield {"error": f"its process ended: {death}; it may have run out of memory; ask again"}
        finally:
            if done and worker.process.is_alive():
                self.idle.put_nowait(worker)
            else:
                await asyncio.shield(asyncio.ensure_future(self._replace(worker)))
