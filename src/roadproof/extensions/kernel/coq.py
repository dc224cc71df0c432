"""``coqc`` as a separate program: the theories compiled once, and files put to it.

Nothing of the evidence that is checked is on Coq's path: it runs in a fresh folder, without settings of the
user or of the environment, and sees its own library and the theories. Compiled theories are kept in a cache
of the user, under a name made of their sources and of Coq's version; they count where only the user can write
there and where they are what was compiled.
"""

import hashlib
import json
import os
import re
import resource
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from roadproof.errors import MissingSolverError, RoadproofError
from roadproof.runtime.cache import is_ours, one_at_a_time, private_folder
from roadproof.runtime.package_data import shipped

THEORIES = (
    *("Meaning", "Text", "Linear", "Tableau", "Products", "Rss", "Instant", "Named", "Values", "Known"),
    *("Drive", "Signs", "Zeros", "Shown", "Guarantee", "Motion", "Integral", "Schemas", "Moves"),
    *("Prescribed", "Braking", "Gained", "Boundary", "Braked", "Following", "Responding"),
    *("Joined", "Aided", "Assisted", "Aeb", "Reading"),
    *("Programs", "Refuted"),
)
APT = "apt-get install -y coq"
PATIENCE = 1800.0  # seconds for one file; a backstop only
SUMS = "sums.json"
COMPLAINTS = "complaints.json"  # warnings of each theory
_LOADED = (".vo", ".vio")  # Coq takes the newer one
_KEPT = ("PATH", "HOME", "TMPDIR", "USER", "LOGNAME")


@dataclass(frozen=True)
class CoqRun:
    """What ``coqc`` answered to a file, which is accepted where ``code`` is 0; seconds of the processor."""

    code: int
    said: str
    complained: str
    seconds: float
    megabytes: float = 0.0


@dataclass(frozen=True)
class Coq:
    """A ``coqc`` and the folder of theories that it has compiled."""

    coqc: str
    version: str
    theories: Path

    def run(self, source: str) -> CoqRun:
        """Put a file to Coq, in a folder of its own."""
        with tempfile.TemporaryDirectory(prefix="roadproof-coq-") as folder:
            file = Path(folder) / "evidence.v"
            file.write_text(source, encoding="ascii")
            return self.in_folder(file.name, Path(folder))

    def in_folder(self, name: str, folder: Path) -> CoqRun:
        """Put a file of a folder to Coq, which writes there."""
        return run_program([self.coqc, *_options(self.theories), name], folder)


def find() -> tuple[str, str]:
    """Path and version of ``coqc``. Raises ``MissingSolverError`` where there is none."""
    coqc = shutil.which("coqc")
    if coqc is None:
        raise MissingSolverError(f"coqc is not on the path: install Coq 8.16 or later, such as by {APT}")
    ran = run_program([coqc, "--print-version"], Path.cwd())
    found = re.match(r"(\d+)\.(\d+)\S*", ran.said)
    if ran.code or found is None:
        raise MissingSolverError(f"{coqc} does not say its version: install Coq again, such as by {APT}")
    if (int(found[1]), int(found[2])) < (8, 16):
        raise MissingSolverError(f"{coqc} is version {found[0]}; 8.16 or later is needed: {APT}")
    return coqc, found[0]


@contextmanager
def ready() -> Iterator[Coq]:
    """Coq with compiled theories.

    Raises ``MissingSolverError``, and ``RoadproofError`` where they do not compile.
    """
    coqc, version = find()
    sources = {name: shipped("proofs") / "kernel" / f"{name}.v" for name in THEORIES}
    texts = {name: path.read_bytes() for name, path in sources.items()}
    key = hashlib.sha256(
        json.dumps([coqc, version, {n: _sum(x) for n, x in texts.items()}]).encode()
    ).hexdigest()
    home = private_folder("coq")
    if home is None:
        with tempfile.TemporaryDirectory(prefix="roadproof-theories-") as folder:
            _compile(coqc, texts, Path(folder))
            yield Coq(coqc, version, Path(folder))
        return
    place = home / key[:32]
    if not _is_sound(place):
        with one_at_a_time(home):
            if not _is_sound(place):
                _compile_into(place, coqc, texts)
    yield Coq(coqc, version, place)


def _compile_into(place: Path, coqc: str, texts: Mapping[str, bytes]) -> None:
    """Compile into a folder of the cache, which is there whole or not at all."""
    making = Path(tempfile.mkdtemp(prefix=".making-", dir=place.parent))
    try:
        _compile(coqc, texts, making)
        shutil.rmtree(place, ignore_errors=True)
        os.rename(making, place)
    except OSError as error:
        raise RoadproofError(f"cannot write {place}: {error.strerror}") from None
    finally:
        shutil.rmtree(making, ignore_errors=True)


def _compile(coqc: str, texts: Mapping[str, bytes], folder: Path) -> None:
    for name, text in texts.items():
        (folder / f"{name}.v").write_bytes(text)
    complaints = {}
    for name in texts:
        ran = run_program([coqc, *_options(folder), f"{name}.v"], folder)
        if ran.code:
            raise RoadproofError(f"proofs/kernel/{name}.v is not accepted by coqc: {ran.complained[:400]}")
        complaints[name] = ran.complained
    (folder / COMPLAINTS).write_text(json.dumps(complaints), encoding="ascii")
    sums = {f"{name}.vo": _sum((folder / f"{name}.vo").read_bytes()) for name in texts}
    (folder / SUMS).write_text(json.dumps(sums), encoding="ascii")


def _options(theories: Path) -> list[str]:
    return ["-q", "-noglob", "-Q", str(theories), "Roadproof"]


def run_program(command: list[str], folder: Path, given: bytes = b"") -> CoqRun:
    """Run in ``folder`` without what the environment says to Coq; ``given`` stands on standard input."""
    begun = _processor_seconds()
    environment = {name: os.environ[name] for name in _KEPT if name in os.environ} | {"LC_ALL": "C"}
    try:
        ran = subprocess.run(
            command,
            cwd=folder,
            env=environment,
            input=given,
            capture_output=True,
            timeout=PATIENCE,
            check=False,
            preexec_fn=_deep_stack,
        )
    except subprocess.TimeoutExpired:
        return CoqRun(-1, "", f"no answer after {PATIENCE:g} s", _processor_seconds() - begun)
    told = [x.decode("utf-8", "replace") for x in (ran.stdout, ran.stderr)]
    held = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024  # of the largest child so far
    return CoqRun(ran.returncode, told[0], told[1], _processor_seconds() - begun, held)


def _processor_seconds() -> float:
    """Of all programs that this process has run and waited for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _deep_stack() -> None:
    """Large formulas are deep terms; Coq reads them by recursion."""
    most = resource.getrlimit(resource.RLIMIT_STACK)[1]
    wanted = 1 << 30
    resource.setrlimit(
        resource.RLIMIT_STACK, (wanted if most == resource.RLIM_INFINITY else min(wanted, most), most)
    )


# --- the cache -----------------------------------------------------------------------------------


def _is_sound(folder: Path) -> bool:
    """Whether all compiled theories are there, as they were compiled, and no others."""
    if not is_ours(folder):
        return False
    try:
        sums = json.loads((folder / SUMS).read_text("ascii"))
        expected = {f"{name}.vo" for name in THEORIES}
        loaded = {str(x.relative_to(folder)) for x in folder.rglob("*") if x.suffix in _LOADED}
        if not set(sums) == loaded == expected or not (folder / COMPLAINTS).is_file():
            return False
        return all(_sum((folder / name).read_bytes()) == sum_ for name, sum_ in sums.items())
    except (OSError, ValueError):
        return False


def _sum(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
