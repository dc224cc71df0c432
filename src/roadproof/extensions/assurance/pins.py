"""The packages of an installation with the digests of their files, as pip resolves them."""

import hashlib
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

from roadproof.errors import MissingSolverError

NAME = "roadproof"


@dataclass(frozen=True)
class Pin:
    """A package and the SHA-256 of the file that is installed."""

    name: str
    version: str
    sha256: str

    @property
    def line(self) -> str:
        """As a file of requirements has it."""
        return f"{self.name}=={self.version} --hash=sha256:{self.sha256}"


def pins_of(more: Iterable[str] = ()) -> list[Pin]:
    """What roadproof needs, in the versions that are installed here, and ``more``, for this Python.

    Raises ``MissingSolverError`` where pip cannot be asked, or finds no such version.
    """
    needed = [x for x in metadata.requires(NAME) or () if "extra ==" not in x]
    installed = (f"{x.name}=={x.version}" for x in metadata.distributions() if x.name != NAME)
    with tempfile.TemporaryDirectory() as folder:
        limits, report = Path(folder) / "constraints.txt", Path(folder) / "report.json"
        limits.write_text("\n".join(sorted(set(installed))), "utf-8")
        asked = ["--dry-run", "--ignore-installed", "--only-binary", ":all:", "--report", str(report)]
        run_pip("install", *asked, "--constraint", str(limits), *needed, *more)
        said = json.loads(report.read_text("utf-8"))
    pins = (pin_in(x) for x in said.get("install", ()))
    return sorted(pins, key=lambda x: x.name.lower())


def pin_in(entry: object) -> Pin:
    """The pin that an entry of pip's report says (version 1). Raises ``MissingSolverError``."""
    match entry:
        case {
            "metadata": {"name": str(name), "version": str(version)},
            "download_info": {"archive_info": {"hashes": {"sha256": str(digest)}}},
        }:
            return Pin(name, version, digest)
        case _:
            raise MissingSolverError(f"pip names no digest of a package: {str(entry)[:120]}; update pip")


def download(pins: Iterable[Pin], folder: Path) -> None:
    """The files of packages, into a folder. Raises ``MissingSolverError``."""
    with tempfile.TemporaryDirectory() as place:
        asked = Path(place) / "requirements.txt"
        asked.write_text("\n".join(x.line for x in pins), "utf-8")
        run_pip("download", "--no-deps", "--require-hashes", "--dest", str(folder), "-r", str(asked))


def own_wheel(folder: Path) -> Path:
    """A wheel of this roadproof: built from its checkout, or that of its version from the index.

    Raises ``MissingSolverError``.
    """
    checkout = Path(__file__).parents[4]
    is_checkout = (checkout / "pyproject.toml").is_file()
    what = str(checkout) if is_checkout else f"{NAME}=={metadata.version(NAME)}"
    run_pip("wheel", "--no-deps", "--wheel-dir", str(folder), what)
    (wheel,) = folder.glob(f"{NAME}-*.whl")
    return wheel


def pin_of_wheel(wheel: Path) -> Pin:
    """The pin of a wheel, by its name and content."""
    name, version, *_ = wheel.name.split("-")
    return Pin(name, version, hashlib.sha256(wheel.read_bytes()).hexdigest())


def run_pip(*arguments: str) -> None:
    """Run pip of this Python. Raises ``MissingSolverError`` with what it complains about."""
    command = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        lines = [x for x in done.stderr.splitlines() if x.startswith("ERROR")] or done.stderr.splitlines()
        told = lines[-1] if lines else "it says nothing"
        raise MissingSolverError(
            f"pip {arguments[0]} failed: {told}; give it a network, or name --wheel FILE"
        )
