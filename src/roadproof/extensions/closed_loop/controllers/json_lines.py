"""A controller in any language: a command that reads and writes a line of JSON for each step.

A message ``{"reset": {...}}`` begins a simulation; its reply may be any JSON. A message ``{"step": {...}}``
is answered with ``{"acceleration": m/s^2}``, and perhaps ``"lateral": m/s`` or ``"lane": NAME``.
"""

import contextlib
import hashlib
import json
import os
import selectors
import shlex
import shutil
import subprocess
import tempfile
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

from roadproof.errors import InputError
from roadproof.extensions.closed_loop.errors import ControllerError
from roadproof.extensions.closed_loop.protocol import Answer, ControllerInput

_MOST = 1_000_000  # bytes of a reply
_GRACE = 1.0  # s in which a process may end by itself


def words_of(text: str) -> list[str]:
    """Return the words of a command. Raises ``InputError`` where it cannot be run."""
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise InputError(f"controller={text}: {error}; write a command as for a shell") from None
    if not words or shutil.which(words[0]) is None:
        name = words[0] if words else text
        raise InputError(
            f"controller={text}: there is no program '{name}'; write FILE.py:NAME, FILE.fmu or a command"
        )
    return words


def command_digest(text: str) -> str:
    """Return a digest of a command, of its program and of the files among its words."""
    words = words_of(text)
    total = hashlib.sha256(json.dumps(words).encode())
    for word in (shutil.which(words[0]) or "", *words[1:]):
        path = Path(word)
        if path.is_file():
            total.update(hashlib.sha256(path.read_bytes()).digest())
    return total.hexdigest()


class JsonLinesController:
    """A process that is asked over its standard streams; each reply has ``patience`` seconds."""

    def __init__(self, text: str, seed: int, patience: float) -> None:
        self.text, self.patience = text, patience
        self._errors = tempfile.TemporaryFile()  # noqa: SIM115 (it is closed by close)
        try:
            self._process = subprocess.Popen(
                words_of(text), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._errors
            )
        except OSError as error:
            raise ControllerError(f"{text} cannot be started: {error.strerror}") from None
        assert self._process.stdout is not None
        self._buffer = b""
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._process.stdout, selectors.EVENT_READ)
        self._seed = seed

    def reset(self, observation: ControllerInput) -> None:
        """Begin a simulation in this state."""
        self._ask({"reset": {**asdict(observation), "seed": self._seed}})

    def step(self, observation: ControllerInput, dt: float) -> Answer:
        """Return the demand of the process for the next step."""
        state = asdict(observation)
        del state["lanes"]
        reply = self._ask({"step": {**state, "dt": dt}})
        if isinstance(reply, int | float) and not isinstance(reply, bool):
            return float(reply)
        if not isinstance(reply, dict) or "acceleration" not in reply:
            raise ControllerError(f'its reply {json.dumps(reply)[:80]} has no number "acceleration"')
        unknown = {*reply} - {"acceleration", "lateral", "lane"}
        if unknown or {"lateral", "lane"} <= {*reply}:
            raise ControllerError(
                f"its reply has {', '.join(sorted(map(str, reply)))}: write acceleration, and lateral or lane"
            )
        demand: Any = reply["acceleration"]
        return demand, reply.get("lateral", reply.get("lane"))

    def _ask(self, message: object) -> Any:
        data = json.dumps(message).encode() + b"\n"
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(data)
            self._process.stdin.flush()
        except (BrokenPipeError, OSError):
            raise self._ended() from None
        line = self._line()
        try:
            return json.loads(line)
        except ValueError:
            raise ControllerError(f"its reply is no JSON: {line[:80]!r}") from None

    def _line(self) -> bytes:
        """Return the next line of the process. Raises ``ControllerError`` where there is none in time."""
        latest = time.monotonic() + self.patience
        assert self._process.stdout is not None
        while b"\n" not in self._buffer:
            left = latest - time.monotonic()
            if left <= 0 or not self._selector.select(left):
                raise ControllerError(
                    f"no reply within {self.patience:g} s: it has to answer each line that it reads with a "
                    "line, and to flush it; raise --patience if it is slow by design"
                )
            data = os.read(self._process.stdout.fileno(), 65536)
            if not data:
                raise self._ended()
            self._buffer += data
            if len(self._buffer) > _MOST:
                raise ControllerError(f"its reply has more than {_MOST} bytes and no end of line")
        line, _, self._buffer = self._buffer.partition(b"\n")
        return line

    def _ended(self) -> ControllerError:
        """Return the error that says how the process ended, with its last words."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(_GRACE)
        self._errors.seek(0)
        words = self._errors.read()[-2000:].decode(errors="replace").strip().splitlines()
        last = f": {words[-1][:200]}" if words else ""
        return ControllerError(f"its process ended with code {self._process.poll()}{last}")

    def close(self) -> None:
        """End the process: first its standard input ends, then the process is killed."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        with contextlib.suppress(OSError):
            self._process.stdin.close()
        try:
            self._process.wait(_GRACE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._selector.close()
        self._process.stdout.close()
        self._errors.close()
