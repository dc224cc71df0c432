"""Admits requests to the studio: from this machine, from this page, with the token of this start, and small
enough.

A page of another site can make a browser send requests to 127.0.0.1, and can make a name of its own point
there (DNS rebinding). It can neither read the token, which stands in the fragment of the printed address, nor
forge the headers Host and Origin.
"""

import hmac
import json
from collections.abc import Awaitable, Callable, Mapping, MutableMapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from roadproof.evidence.strict import JsonObject

Message: TypeAlias = MutableMapping[str, Any]
Receive: TypeAlias = Callable[[], Awaitable[Message]]
Send: TypeAlias = Callable[[Message], Awaitable[None]]
App: TypeAlias = Callable[[Message, Receive, Send], Awaitable[None]]

TOKEN = "x-roadproof-token"
LARGEST_BODY = 64_000_000
POLICY = (
    "default-src 'none'; script-src 'self' 'nonce-{nonce}'; style-src 'self' 'nonce-{nonce}'; "
    "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)


class RefusedError(Exception):
    """A refused request: the HTTP status and the reason."""

    def __init__(self, status: int, reason: str) -> None:
        super().__init__(reason)
        self.status = status
        self.reason = reason


@dataclass(frozen=True)
class Guard:
    """An ASGI application that protects ``app``; ``port`` and ``token`` are those of this start."""

    app: App
    port: int
    token: str
    largest_body: int = LARGEST_BODY

    async def __call__(self, scope: Message, receive: Receive, send: Send) -> None:
        match scope:
            case {"type": "lifespan"}:
                await self.app(scope, receive, send)
            case {"type": "http", "method": str(method)}:
                try:
                    self.admit(method, headers_of(scope))
                except RefusedError as refused:
                    await refuse(send, refused)
                    return
                await self.app(scope, receive, _with_safe_headers(send))

    def admit(self, method: str, headers: Mapping[str, str]) -> None:
        """Raise ``RefusedError`` for a request that is not from the page of this start."""
        hosts = {f"127.0.0.1:{self.port}", f"localhost:{self.port}"}
        if headers.get("host") not in hosts:
            raise RefusedError(403, "this server answers to its own address only")
        origin = headers.get("origin")
        if origin is not None and origin not in {f"http://{host}" for host in hosts}:
            raise RefusedError(403, "pages of other origins are not answered")
        if headers.get("sec-fetch-site", "same-origin") not in ("same-origin", "none"):
            raise RefusedError(403, "pages of other sites are not answered")
        if method in ("GET", "HEAD"):
            return
        if method != "POST":
            raise RefusedError(405, "use GET or POST")
        if origin != f"http://{headers['host']}":
            raise RefusedError(403, "requests must come from the page of this server")
        if headers.get("content-type", "").partition(";")[0].strip() != "application/json":
            raise RefusedError(415, "a request must have the content type application/json")
        if not hmac.compare_digest(headers.get(TOKEN, "").encode(), self.token.encode()):
            raise RefusedError(401, "invalid token: open the address that this start of the studio printed")


def headers_of(scope: Message) -> dict[str, str]:
    """Return the headers by name; a repeated header, as in smuggled requests, counts as empty."""
    headers: dict[str, str] = {}
    match scope:
        case {"headers": pairs}:
            for name, value in pairs:
                key = name.decode("latin-1").lower()
                headers[key] = "" if key in headers else value.decode("latin-1")
    return headers


def _with_safe_headers(send: Send) -> Send:
    """Return ``send`` with ``safe_headers`` added to each response that does not set them."""

    async def safe_send(message: Message) -> None:
        match message:
            case {"type": "http.response.start"}:
                headers = list(message.get("headers", []))
                names = {name.lower() for name, _ in headers}
                headers += [(name, value) for name, value in safe_headers() if name not in names]
                message = {**message, "headers": headers}
        await send(message)

    return safe_send


async def refuse(send: Send, refused: RefusedError) -> None:
    """Respond with the status and the reason."""
    body = json.dumps({"error": refused.reason}).encode()
    size = str(len(body)).encode()
    headers = [(b"content-type", b"application/json"), (b"content-length", size), (b"connection", b"close")]
    headers += safe_headers()
    await send({"type": "http.response.start", "status": refused.status, "headers": headers})
    await send({"type": "http.response.body", "body": body})


def safe_headers(nonce: str = "") -> list[tuple[bytes, bytes]]:
    """Return the security headers of every response; ``nonce``: that of the page's scripts."""
    policy = POLICY.format(nonce=nonce) if nonce else "default-src 'none'; frame-ancestors 'none'"
    return [
        (b"content-security-policy", policy.encode()),
        (b"x-content-type-options", b"nosniff"),
        (b"referrer-policy", b"no-referrer"),
        (b"cross-origin-resource-policy", b"same-origin"),
        (b"cross-origin-opener-policy", b"same-origin"),
        (b"cache-control", b"no-store"),
    ]


async def read_json(receive: Receive, announced: str, most: int) -> JsonObject:
    """Return the body as a JSON object; its size is counted while it arrives, whatever was ``announced``.

    Raises ``RefusedError``.
    """
    if announced.isdecimal() and int(announced) > most:
        raise RefusedError(413, f"the request is larger than {most} bytes")
    body = bytearray()
    while True:
        match message := await receive():
            case {"type": "http.disconnect"}:
                raise RefusedError(400, "the request ended too early")
        body += message.get("body", b"")
        if len(body) > most:
            raise RefusedError(413, f"the request is larger than {most} bytes")
        if not message.get("more_body", False):
            break
    try:
        data = json.loads(body)
    except (ValueError, RecursionError):
        raise RefusedError(400, "the request is not JSON") from None
    if not isinstance(data, dict):
        raise RefusedError(400, "the request is not a JSON object")
    return data
