"""``coqc`` as a separate program: it compiles the theories once, and checks files.

Coq never sees other files of the evidence: it runs in a fresh folder, without settings of the user or the
environment, with its own library and the theories. Compiled theories are cached for the user, under a digest
of their sources and Coq's version. The cache is used only if nobody else can write there and its files are
those that were compiled.
"""

import contextlib
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
from roadproof.runtime.cache import is_private, private_folder
from roadproof.runtime.package_data import shipped_folder

THEORIES = (
    *("Meaning", "Text", "Linear", "Tableau", "Products", "Rss", "Instant", "Named", "Values", "Known"),
    *("Drive", "Signs", "Zeros", "Shown", "Guarantee", "Motion", "Integral", "Schemas", "Moves"),
    *("Prescribed", "Braking", "Gained", "Boundary", "Braked", "Following", "Responding"),
    *("Joined", "Aided", "Assisted", "Aeb", "Reading"),
    *("Programs", "Refuted"),
)
APT = "apt-get install -y coq"
TIMEOUT = 1800.0  # seconds for one file; a backstop only
SUMS = "sums.json"
WARNINGS = "complaints.json"  # warnings of each theory
_LOADED = (".vo", ".vio")  # Coq takes the newer one
_ENVIRONMENT = ("PATH", "HOME", "TMPDIR", "USER", "LOGNAME")


@dataclass(frozen=True)
class CoqRun:
    """The result of a program run; ``code`` 0 means accepted; processor time in s, memory in MB."""

    code: int
    output: str
    errors: str
    seconds: float
    megabytes: float = 0.0


@dataclass(frozen=True)
class Coq:
    """A ``coqc`` and the folder with the theories that it has compiled."""

    coqc: str
    version: str
    theories: Path

    def run(self, source: str) -> CoqRun:
        """Check a source text in a fresh folder."""
        with tempfile.TemporaryDirectory(prefix="roadproof-coq-") as folder:
            file = Path(folder) / "evidence.v"
            file.write_text(source, encoding="ascii")
            return self.in_folder(file.name, Path(folder))

    def in_folder(self, name: str, folder: Path) -> CoqRun:
        """Check a file in a folder, where Coq writes its output."""
        return run_program([self.coqc, *_options(self.theories), name], folder)


def find_coqc() -> tuple[str, str]:
    """Return path and version of ``coqc``. Raises ``MissingSolverError`` if there is none."""
    coqc = shutil.which("coqc")
    if coqc is None:
        raise MissingSolverError(f"coqc is not on the path: install Coq 8.16 or later, such as by {APT}")
    run = run_program([coqc, "--print-version"], Path.cwd())
    match = re.match(r"(\d+)\.(\d+)\S*", run.output)
    if run.code or match is None:
        raise MissingSolverError(f"{coqc} does not say its version: install Coq again, such as by {APT}")
    if (int(match[1]), int(match[2])) < (8, 16):
        raise MissingSolverError(f"{coqc} is version {match[0]}; 8.16 or later is needed: {APT}")
    return coqc, match[0]


@contextmanager
def ready() -> Iterator[Coq]:
    """Yield Coq with compiled theories.

    Raises ``MissingSolverError``, and ``RoadproofError`` if the theories do not compile.
    """
    coqc, version = find_coqc()
    sources = {name: shipped_folder("proofs") / "kernel" / f"{name}.v" for name in THEORIES}
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
    """Compile into a folder of the cache, atomically."""
    folder = Path(tempfile.mkdtemp(prefix=".making-", dir=place.parent))
    try:
        _compile(coqc, texts, folder)
        shutil.rmtree(place, ignore_errors=True)
        os.rename(folder, place)
    except OSError as error:
        raise RoadproofError(f"cannot write {place}: {error.strerror}") from None
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _compile(coqc: str, texts: Mapping[str, bytes], folder: Path) -> None:
    for name, text in texts.items():
        (folder / f"{name}.v").write_bytes(text)
    complaints = {}
    for name in texts:
        run = run_program([coqc, *_options(folder), f"{name}.v"], folder)
        if run.code:
            raise RoadproofError(f"proofs/kernel/{name}.v is not accepted by coqc: {run.errors[:400]}")
        complaints[name] = run.errors
    (folder / WARNINGS).write_text(json.dumps(complaints), encoding="ascii")
    sums = {f"{name}.vo": _sum((folder / f"{name}.vo").read_bytes()) for name in texts}
    (folder / SUMS).write_text(json.dumps(sums), encoding="ascii")


def _options(theories: Path) -> list[str]:
    return ["-q", "-noglob", "-Q", str(theories), "Roadproof"]


def run_program(command: list[str], folder: Path, stdin: bytes = b"") -> CoqRun:
    """Run a command in ``folder`` with a minimal environment; ``stdin``: its standard input."""
    start = _processor_seconds()
    environment = {name: os.environ[name] for name in _ENVIRONMENT if name in os.environ} | {"LC_ALL": "C"}
    try:
        process = subprocess.run(
            command,
            cwd=folder,
            env=environment,
            input=stdin,
            capture_output=True,
            timeout=TIMEOUT,
            check=False,
            preexec_fn=_deep_stack,
        )
    except subprocess.TimeoutExpired:
        return CoqRun(-1, "", f"no answer after {TIMEOUT:g} s", _processor_seconds() - start)
    streams = [x.decode("utf-8", "replace") for x in (process.stdout, process.stderr)]
    megabytes = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024  # of the largest child so far
    return CoqRun(process.returncode, streams[0], streams[1], _processor_seconds() - start, megabytes)


def _processor_seconds() -> float:
    """Return the processor time of all finished child processes."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _deep_stack() -> None:
    """Raise the stack limit: large formulas are deep terms, which Coq reads recursively."""
    limit = resource.getrlimit(resource.RLIMIT_STACK)[1]
    stack_size = 1 << 30
    resource.setrlimit(
        resource.RLIMIT_STACK,
        (stack_size if limit == resource.RLIM_INFINITY else min(stack_size, limit), limit),
    )


# --- the cache -----------------------------------------------------------------------------------


def _is_sound(folder: Path) -> bool:
    """Return whether the folder has exactly the compiled theories, unchanged."""
    if not is_private(folder):
        return False
    try:
        sums = json.loads((folder / SUMS).read_text("ascii"))
        expected = {f"{name}.vo" for name in THEORIES}
        loaded = {str(x.relative_to(folder)) for x in folder.rglob("*") if x.suffix in _LOADED}
        if not set(sums) == loaded == expected or not (folder / WARNINGS).is_file():
            return False
        return all(_sum((folder / name).read_bytes()) == sum_ for name, sum_ in sums.items())
    except (OSError, ValueError):
        return False


def _sum(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


@contextlib.contextmanager
def one_at_a_time(folder: Path) -> Iterator[None]:
    """Wait until no other process works in a folder of the cache; the system releases the lock if we die."""
    with contextlib.ExitStack() as stack:
        with contextlib.suppress(ImportError, OSError):  # without locks, two processes may do the same work
            import fcntl

            handle = os.open(folder, os.O_RDONLY)
            stack.callback(os.close, handle)
            fcntl.flock(handle, fcntl.LOCK_EX)
        yield
