"""Controllers by name: a Python file, an FMU, or a command; each with a digest of its files."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Literal, TypeAlias

from roadproof.errors import InputError, UsageError
from roadproof.extensions.closed_loop.protocol import VehicleController
from roadproof.runtime.records import dataclass

Kind: TypeAlias = Literal["python", "fmu", "command"]
_PYTHON = re.compile(r"(?P<file>.+\.py):(?P<name>[A-Za-z_]\w*)")


@dataclass(frozen=True)
class ControllerSource:
    """A controller as it is named, with its kind, and a digest of the files that were found to make it up."""

    text: str
    kind: Kind
    sha256: str


def source_of(text: str) -> ControllerSource:
    """Return the source of a controller: ``FILE.py:NAME``, ``FILE.fmu``, or a command.

    A Python file is run. Raises ``InputError``, ``UsageError``.
    """
    if not text.strip():
        raise UsageError("controller='': write FILE.py:NAME, FILE.fmu or a command")
    if match := _PYTHON.fullmatch(text):
        from roadproof.extensions.closed_loop.controllers.python_file import digest_of

        return ControllerSource(text, "python", digest_of(Path(match["file"]), match["name"]))
    if text.endswith(".py") and Path(text).is_file():
        raise UsageError(f"controller={text}: name the class or function in it, such as {text}:Controller")
    if text.endswith(".fmu"):
        from roadproof.extensions.closed_loop.controllers.fmu import fmu_digest

        return ControllerSource(text, "fmu", fmu_digest(Path(text)))
    from roadproof.extensions.closed_loop.controllers.json_lines import command_digest

    return ControllerSource(text, "command", command_digest(text))


@contextmanager
def opened(source: ControllerSource, seed: int, patience: float) -> Iterator[VehicleController]:
    """Start a controller, and end it. Raises ``InputError`` where its files have changed since.

    ``patience``: seconds within which an external process answers.
    """
    now = source_of(source.text)
    if now != source:
        raise InputError(
            f"{source.text}: its files have changed since the question was asked; begin again with another "
            "--out"
        )
    match source.kind:
        case "python":
            from roadproof.extensions.closed_loop.controllers.python_file import python_controller

            file, _, name = source.text.rpartition(":")
            yield python_controller(Path(file), name, seed)
        case "fmu":
            from roadproof.extensions.closed_loop.controllers.fmu import FmuController

            fmu = FmuController(Path(source.text))
            try:
                yield fmu
            finally:
                fmu.close()
        case "command":
            from roadproof.extensions.closed_loop.controllers.json_lines import JsonLinesController

            process = JsonLinesController(source.text, seed, patience)
            try:
                yield process
            finally:
                process.close()
