"""Pins the packages of an installation: versions and digests of their files, as pip resolves them."""

import hashlib
import json
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path

from roadproof.errors import InputError, MissingSolverError

NAME = "roadproof"


@dataclass(frozen=True)
class Pin:
    """A package and the SHA-256 of its file."""

    name: str
    version: str
    sha256: str

    @property
    def line(self) -> str:
        """The line of a requirements file for pip."""
        return f"{self.name}=={self.version} --hash=sha256:{self.sha256}"


def pins_of(additional: Iterable[str] = ()) -> list[Pin]:
    """Return pins of the packages that roadproof needs, in the versions installed here, and of ``additional``
    ones.

    Raises ``MissingSolverError`` where pip fails or finds no such version.
    """
    needed = [x for x in metadata.requires(NAME) or () if "extra ==" not in x]
    installed = (f"{x.name}=={x.version}" for x in metadata.distributions() if x.name != NAME)
    with tempfile.TemporaryDirectory() as folder:
        limits, report = Path(folder) / "constraints.txt", Path(folder) / "report.json"
        limits.write_text("\n".join(sorted(set(installed))), "utf-8")
        options = ["--dry-run", "--ignore-installed", "--only-binary", ":all:", "--report", str(report)]
        run_pip("install", *options, "--constraint", str(limits), *needed, *additional)
        resolution = json.loads(report.read_text("utf-8"))
    pins = (pin_in(x) for x in resolution.get("install", ()))
    return sorted(pins, key=lambda x: x.name.lower())


def pin_in(entry: object) -> Pin:
    """Return the pin of an entry of pip's report (version 1). Raises ``MissingSolverError`` for one without
    digest.
    """
    match entry:
        case {
            "metadata": {"name": str(name), "version": str(version)},
            "download_info": {"archive_info": {"hashes": {"sha256": str(digest)}}},
        }:
            return Pin(name, version, digest)
        case _:  # open: JSON of pip
            raise MissingSolverError(f"pip names no digest of a package: {str(entry)[:120]}; update pip")


def download(pins: Iterable[Pin], folder: Path) -> None:
    """Download the files of packages into a folder. Raises ``MissingSolverError``."""
    with tempfile.TemporaryDirectory() as place:
        requirements = Path(place) / "requirements.txt"
        requirements.write_text("\n".join(x.line for x in pins), "utf-8")
        run_pip("download", "--no-deps", "--require-hashes", "--dest", str(folder), "-r", str(requirements))


def own_wheel(folder: Path) -> Path:
    """Make a wheel of this roadproof in a folder and return its path.

    It is built from the checkout, or else downloaded from the index. Raises ``MissingSolverError``.
    """
    checkout = Path(__file__).parents[4]
    is_checkout = (checkout / "pyproject.toml").is_file()
    source = str(checkout) if is_checkout else f"{NAME}=={metadata.version(NAME)}"
    run_pip("wheel", "--no-deps", "--wheel-dir", str(folder), source)
    (wheel,) = folder.glob(f"{NAME}-*.whl")
    return wheel


def pin_of_wheel(wheel: Path) -> Pin:
    """Return the pin of a wheel of roadproof, from its name and content. Raises ``InputError`` for another
    file.
    """
    match wheel.name.split("-"):
        case [name, version, _, *_, _] if name == NAME and wheel.suffix == ".whl":
            pass
        case _:  # open: names of files
            raise InputError(
                f"{wheel} is no wheel of {NAME}: name a file such as {NAME}-1.0-py3-none-any.whl"
            )
    return Pin(name, version, hashlib.sha256(wheel.read_bytes()).hexdigest())


def run_pip(*arguments: str) -> None:
    """Run pip of this Python. Raises ``MissingSolverError`` with the last line of its error output."""
    command = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check", *arguments]
    process = subprocess.run(command, capture_output=True, text=True, check=False)
    if process.returncode:
        lines = [
            x for x in process.stderr.splitlines() if x.startswith("ERROR")
        ] or process.stderr.splitlines()
        reason = lines[-1] if lines else "it says nothing"
        raise MissingSolverError(
            f"pip {arguments[0]} failed: {reason}; give it a network, or name --wheel FILE"
        )
