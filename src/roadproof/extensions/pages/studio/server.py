"""The web server of the studio: one page, and jobs over JSON lines; the only module with starlette and
uvicorn.
"""

import asyncio
import contextlib
import json
import secrets
import socket
import webbrowser
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from roadproof.errors import MissingSolverError, UsageError
from roadproof.extensions.pages.studio.pages import StartContent, page_of, static_files
from roadproof.extensions.pages.studio.request_validation import (
    LARGEST_BODY,
    Guard,
    Message,
    Receive,
    RefusedError,
    Send,
    headers_of,
    read_json,
    refuse,
    safe_headers,
)
from roadproof.extensions.pages.studio.worker_pool import PoolLimits, WorkerPool

if TYPE_CHECKING:
    from starlette.applications import Starlette

# Jobs that answer while somebody types; one worker, which the others cannot keep.
LIVE = PoolLimits(workers=1, waiting=32, seconds=20.0, long=False)
"""The limits of jobs that take a moment."""


@dataclass
class StudioServer:
    """The state of the server; it keeps nothing of a page, so tabs are independent."""

    start_content: StartContent
    long: PoolLimits = field(default_factory=PoolLimits)
    live: PoolLimits = LIVE
    pools: dict[str, WorkerPool] = field(default_factory=dict)

    @contextlib.asynccontextmanager
    async def run(self, app: object) -> AsyncIterator[None]:
        """Keep workers for as long as the server runs; they warm up while the page loads."""
        self.pools = {"live": WorkerPool(self.live), "long": WorkerPool(self.long)}
        starting = asyncio.create_task(self._start())
        try:
            yield
        finally:
            starting.cancel()
            await asyncio.gather(
                starting, *(pool.end() for pool in self.pools.values()), return_exceptions=True
            )

    async def _start(self) -> None:
        for pool in self.pools.values():
            await pool.start()

    async def ask(self, scope: Message, receive: Receive, send: Send, most: int) -> None:
        """Answer one question with JSON lines; the job ends when the request is closed."""
        try:
            question = await read_json(receive, headers_of(scope).get("content-length", ""), most)
            pool, kind = self._pool_for(question.get("kind"))
        except RefusedError as refused:
            await refuse(send, refused)
            return
        headers = [(b"content-type", b"application/x-ndjson")]
        await send({"type": "http.response.start", "status": 200, "headers": headers})
        gone = asyncio.create_task(_until_gone(receive))
        try:
            async with contextlib.aclosing(pool.work(kind, question)) as messages:
                async for message in messages:
                    if gone.done():
                        return
                    line = (json.dumps(message) + "\n").encode()
                    await send({"type": "http.response.body", "body": line, "more_body": True})
            await send({"type": "http.response.body", "body": b""})
        finally:
            gone.cancel()

    def _pool_for(self, kind: object) -> tuple[WorkerPool, str]:
        from roadproof.extensions.pages.studio.jobs import LIVE as quick
        from roadproof.extensions.pages.studio.jobs import LONG as long

        for name, kinds in (("live", quick), ("long", long)):
            if isinstance(kind, str) and kind in kinds:
                return self.pools[name], kind
        raise RefusedError(400, "unknown kind of request")


async def _until_gone(receive: Receive) -> None:
    while True:
        match await receive():
            case {"type": "http.disconnect"}:
                return


def application(studio: StudioServer, port: int, token: str, largest_body: int = LARGEST_BODY) -> Guard:
    """Return the ASGI application. Raises ``MissingSolverError`` without starlette."""
    return Guard(_routes(studio, largest_body), port, token)


def _routes(studio: StudioServer, largest_body: int) -> "Starlette":
    try:
        from starlette.applications import Starlette
        from starlette.requests import Request
        from starlette.responses import Response
        from starlette.routing import Route
    except ImportError:
        raise missing() from None

    async def page(request: Request) -> Response:
        nonce = secrets.token_urlsafe(16)
        headers = {name.decode(): value.decode() for name, value in safe_headers(nonce)}
        return Response(page_of(nonce), media_type="text/html; charset=utf-8", headers=headers)

    async def file(request: Request) -> Response:
        static_file = static_files().get(request.path_params["name"])
        if static_file is None:
            return Response("there is no such file", 404)
        return Response(static_file.text, media_type=static_file.kind)

    class AskEndpoint:
        """An ASGI endpoint, because answers are streams that end when the client disconnects."""

        async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
            await studio.ask(scope, receive, send, largest_body)

    async def start(request: Request) -> Response:
        return Response(json.dumps(studio.start_content.as_data()), media_type="application/json")

    return Starlette(
        routes=[
            Route("/", page),
            Route("/page/{name:path}", file),
            Route("/start", start, methods=("POST",)),
            Route("/ask", AskEndpoint(), methods=("POST",)),
        ],
        lifespan=studio.run,
    )


def missing() -> MissingSolverError:
    """Return the error for a missing extra."""
    return MissingSolverError(
        "the studio needs starlette and uvicorn, which are not installed: pip install starlette uvicorn"
    )


def serve(
    studio: StudioServer,
    port: int | None,
    browser: bool,
    say: Callable[[str], None],
    largest_body: int = LARGEST_BODY,
) -> None:
    """Serve on the loopback interface until interrupted; ``port`` as in ``listen``.

    Raises ``UsageError`` where the port is taken, ``MissingSolverError`` without the extra.
    """
    try:
        import uvicorn
    except ImportError:
        raise missing() from None
    listening = listen(port)
    number = int(listening.getsockname()[1])
    token = secrets.token_urlsafe(24)
    address = f"http://127.0.0.1:{number}/#token={token}"
    app = application(studio, number, token, largest_body)
    config = uvicorn.Config(
        app, log_level="warning", access_log=False, server_header=False, timeout_graceful_shutdown=1
    )
    say(address)
    if browser:
        webbrowser.open(address)
    uvicorn.Server(config).run(sockets=[listening])


USUAL_PORT = 8642


def listen(port: int | None) -> socket.socket:
    """Return a socket on 127.0.0.1, at ``port``; None stands for the usual port, or else any free one.

    Raises ``UsageError`` where the port is taken.
    """
    ports = [USUAL_PORT, 0] if port is None else [port]
    for number in ports:
        listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listening.bind(("127.0.0.1", number))
            listening.listen(64)  # so that a browser which is quicker than the server waits
            return listening
        except OSError as error:
            listening.close()
            failure = error
    raise UsageError(f"--port {port}: cannot listen there: {failure.strerror}; name another, or none")
