"""The checkers without Coq: their extracted program, compiled once by ``ocamlopt``, and texts put to it.

The sources come with roadproof (proofs/kernel/ocaml): Coq wrote ``checker.ml`` from the theories that it has
proved right. The compiled program is kept as the theories are (``coq.py``).
"""

import hashlib
import json
import re
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from roadproof.errors import MissingSolverError, RoadproofError
from roadproof.extensions.kernel.coq import CoqRun, run_program
from roadproof.runtime.cache import keep_bytes, kept_bytes, make_room
from roadproof.runtime.package_data import shipped

SOURCES = ("checker", "reader", "certificates", "main")
APT = "apt-get install -y ocaml-nox"
_OLDEST = (4, 8)


@dataclass(frozen=True)
class Program:
    """The compiled program, and the version of the compiler."""

    path: Path
    version: str

    def run(self, text: str) -> CoqRun:
        """Put forms to the program, which answers in a line each."""
        return run_program([str(self.path)], self.path.parent, text.encode("ascii"))


def find() -> tuple[str, str]:
    """Path and version of ``ocamlopt``. Raises ``MissingSolverError`` where there is none."""
    compiler = shutil.which("ocamlopt")
    if compiler is None:
        raise MissingSolverError(f"ocamlopt is not on the path: install OCaml, such as by {APT}")
    ran = run_program([compiler, "-version"], Path.cwd())
    found = re.match(r"(\d+)\.(\d+)\S*", ran.said)
    if ran.code or found is None or (int(found[1]), int(found[2])) < _OLDEST:
        oldest = ".".join(map(str, _OLDEST))
        raise MissingSolverError(f"{compiler} is not OCaml {oldest} or later: install it, such as by {APT}")
    return compiler, found[0]


@contextmanager
def ready() -> Iterator[Program]:
    """The program, in a fresh folder.

    Raises ``MissingSolverError``, and ``RoadproofError`` where it does not compile.
    """
    compiler, version = find()
    home = shipped("proofs") / "kernel" / "ocaml"
    texts = {f"{name}.ml": (home / f"{name}.ml").read_bytes() for name in SOURCES}
    sums = {name: hashlib.sha256(text).hexdigest() for name, text in texts.items()}
    made_of = json.dumps([compiler, version, sums]).encode()
    key = f"program-{hashlib.sha256(made_of).hexdigest()[:32]}"
    with tempfile.TemporaryDirectory(prefix="roadproof-kernel-") as folder:
        path = Path(folder) / "kernel"
        kept = kept_bytes("ocaml", key, made_of)
        if kept is None:
            kept = build(compiler, texts, Path(folder))
            keep_bytes("ocaml", key, kept, made_of)
            make_room("ocaml")
        path.write_bytes(kept)
        path.chmod(0o700)
        yield Program(path, version)


def build(compiler: str, texts: Mapping[str, bytes], folder: Path) -> bytes:
    """The program that these sources make, in the order in which they stand."""
    for name, text in texts.items():
        (folder / name).write_bytes(text)
    ran = run_program([compiler, "-w", "-a", "-o", "program", *texts], folder)
    if ran.code:
        raise RoadproofError(f"the extracted program does not compile: {ran.complained[:400]}")
    return (folder / "program").read_bytes()
