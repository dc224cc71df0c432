"""The extracted checkers as a program: compiled once by ``ocamlopt``, and run on forms.

The sources come with roadproof (proofs/kernel/ocaml). Coq generated ``checker.ml`` from theories that it had
proved. The program is cached like the theories (``coq.py``).
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
from roadproof.runtime.cache import evict_old, load_bytes, store_bytes
from roadproof.runtime.package_data import shipped_folder

SOURCES = ("checker", "reader", "certificates", "main")
APT = "apt-get install -y ocaml-nox"
_OLDEST = (4, 8)


@dataclass(frozen=True)
class ExtractedProgram:
    """The compiled program, and the version of the compiler."""

    path: Path
    version: str

    def run(self, text: str) -> CoqRun:
        """Run the program on forms; it prints one line for each."""
        return run_program([str(self.path)], self.path.parent, text.encode("ascii"))


def find_ocamlopt() -> tuple[str, str]:
    """Return path and version of ``ocamlopt``. Raises ``MissingSolverError`` if there is none."""
    compiler = shutil.which("ocamlopt")
    if compiler is None:
        raise MissingSolverError(f"ocamlopt is not on the path: install OCaml, such as by {APT}")
    run = run_program([compiler, "-version"], Path.cwd())
    match = re.match(r"(\d+)\.(\d+)\S*", run.output)
    if run.code or match is None or (int(match[1]), int(match[2])) < _OLDEST:
        oldest = ".".join(map(str, _OLDEST))
        raise MissingSolverError(f"{compiler} is not OCaml {oldest} or later: install it, such as by {APT}")
    return compiler, match[0]


@contextmanager
def ready() -> Iterator[ExtractedProgram]:
    """Yield the program in a fresh folder.

    Raises ``MissingSolverError``, and ``RoadproofError`` if it does not compile.
    """
    compiler, version = find_ocamlopt()
    home = shipped_folder("proofs") / "kernel" / "ocaml"
    texts = {f"{name}.ml": (home / f"{name}.ml").read_bytes() for name in SOURCES}
    sums = {name: hashlib.sha256(text).hexdigest() for name, text in texts.items()}
    made_of = json.dumps([compiler, version, sums]).encode()
    key = f"program-{hashlib.sha256(made_of).hexdigest()[:32]}"
    with tempfile.TemporaryDirectory(prefix="roadproof-kernel-") as folder:
        path = Path(folder) / "kernel"
        content = load_bytes("ocaml", key, made_of)
        if content is None:
            content = build(compiler, texts, Path(folder))
            store_bytes("ocaml", key, content, made_of)
            evict_old("ocaml")
        path.write_bytes(content)
        path.chmod(0o700)
        yield ExtractedProgram(path, version)


def build(compiler: str, texts: Mapping[str, bytes], folder: Path) -> bytes:
    """Return the program compiled from these sources, in this order."""
    for name, text in texts.items():
        (folder / name).write_bytes(text)
    run = run_program([compiler, "-w", "-a", "-o", "program", *texts], folder)
    if run.code:
        raise RoadproofError(f"the extracted program does not compile: {run.errors[:400]}")
    return (folder / "program").read_bytes()
