"""A server of the studio to be asked by tests: raw requests, so that anything can be sent."""

import json
import os
import re
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from roadproof.extensions.pages.studio.pages import StartContent
from roadproof.extensions.pages.studio.server import StudioServer, application, listen
from roadproof.extensions.pages.studio.worker_pool import PoolLimits

NOBODY = PoolLimits(workers=0)
DRAFT = {"base": "base", "text": "", "before": None, "options": {}, "params": {}}


@dataclass(frozen=True)
class Served:
    """Where a server is, and its token."""

    port: int
    token: str

    @property
    def origin(self) -> str:
        return f"http://127.0.0.1:{self.port}"

    def headers(self, **other: str | None) -> dict[str, str]:
        """What the page sends; ``other`` replaces a header, or leaves it out where it is None."""
        usual = {
            "host": f"127.0.0.1:{self.port}",
            "origin": self.origin,
            "content-type": "application/json",
            "x-roadproof-token": self.token,
        }
        changed = {**usual, **{name.replace("_", "-"): x for name, x in other.items()}}
        return {name: x for name, x in changed.items() if x is not None}

    def send(self, head: str, headers: dict[str, str], body: bytes = b"") -> tuple[int, str, bytes]:
        """One request as it stands: status, headers and body of the answer."""
        lines = [head, *(f"{name}: {value}" for name, value in headers.items()), "connection: close", "", ""]
        with socket.create_connection(("127.0.0.1", self.port), timeout=30) as connection:
            connection.sendall("\r\n".join(lines).encode() + body)
            answer = b""
            while piece := connection.recv(65536):
                answer += piece
        above, _, below = answer.partition(b"\r\n\r\n")
        return int(above.split()[1]), above.decode("latin-1").lower(), below

    def post(self, path: str, data: object, **other: str | None) -> tuple[int, str, bytes]:
        body = json.dumps(data).encode()
        headers = self.headers(**{"content_length": str(len(body)), **other})
        return self.send(f"POST {path} HTTP/1.1", headers, body)

    def get(self, path: str, **other: str | None) -> tuple[int, str, bytes]:
        headers = self.headers(**{"origin": None, "content_type": None, "x_roadproof_token": None, **other})
        return self.send(f"GET {path} HTTP/1.1", headers)


@contextmanager
def serving(largest_body: int = 100_000, limits: PoolLimits = NOBODY) -> Iterator[Served]:
    """A server in a thread of this process, by default without workers."""
    import uvicorn

    listening = listen(0)
    port = listening.getsockname()[1]
    studio = StudioServer(StartContent("def mine(a: vehicle) := true"), limits, limits)
    app = application(studio, port, "the-token", largest_body)
    server = uvicorn.Server(uvicorn.Config(app, log_level="error", timeout_graceful_shutdown=1))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
    thread.start()
    while not server.started:
        time.sleep(0.01)
    try:
        yield Served(port, "the-token")
    finally:
        server.should_exit = True
        thread.join()


@contextmanager
def running(*arguments: str, known: bool = False) -> Iterator[tuple[str, "subprocess.Popen[str]"]]:
    """The address that the command prints, and its process; ``known``: whether it takes known answers."""
    env = {**os.environ, "ROADPROOF_KNOWN": "on" if known else "off"}
    words = [sys.executable, "-m", "roadproof", "studio", "--no-browser", "--port", "0", *arguments]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=env)
    try:
        assert process.stdout is not None
        found = re.search(r"http://\S+", process.stdout.readline())
        assert found is not None
        yield found[0], process
    finally:
        process.terminate()
        process.wait()


def question(formula: str = "scenario_1(SV,POV,L)", text: str = "", **other: Any) -> dict[str, Any]:
    """What the page asks with every job."""
    return {
        "draft": {**DRAFT, "text": text},
        "set": "edit",
        "formula": formula,
        "settings": {"objective": "smooth"},
        **other,
    }


def workers_of(process: int) -> set[int]:
    """The processes below a process that are workers of the studio."""
    asked = ["ps", "-wweo", "pid,ppid,args"]  # -ww: whole lines, however wide the terminal is
    found = subprocess.run(asked, capture_output=True, text=True, check=True).stdout
    rows = [line.split(None, 2) for line in found.splitlines()[1:]]
    children = {int(pid): (int(parent), words) for pid, parent, words in rows}

    def is_below(pid: int) -> bool:
        while pid in children and pid != process:
            pid = children[pid][0]
        return pid == process

    return {pid for pid, (_, words) in children.items() if "multiprocessing.spawn" in words and is_below(pid)}
