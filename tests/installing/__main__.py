"""``make release``: the wheel and the source archive, installed without the source tree and asked questions.

Both are built in ``out/release``, with a list of components (SBOM, CycloneDX) and checksums. The wheel is
installed into a fresh environment of every Python from 3.11 to 3.14 that is found, and the commands of
``COMMANDS`` are run in an empty folder. With --lowest, it is installed once more with the lowest version
that each dependency allows, into the oldest Python. Exit code 0 where every command printed what it should.
"""

import argparse
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
RELEASE, PLACES = ROOT / "out" / "release", ROOT / "out" / "installing"
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
COMMANDS = (
    ("roadproof prove 4", r"9 claims"),
    ("roadproof prove 'danger(SV,POV) -> danger(POV,SV)' --fresh --out proofs", r"^PROVED"),
    ("roadproof witness 4 --fresh --out drives", r"WITNESSED"),
    ("roadproof check proofs drives", r"2 of 2 accepted"),
    ("roadproof list", r"cut-in"),
    ("python -c 'import roadproof as rp; print(rp.prove(4).verdicts)'", r"PROVED"),
)
"""Commands, and a pattern that each prints."""


@dataclass(frozen=True)
class Installation:
    """How one environment came out; seconds of ``pip install``, and until the first answer after it."""

    name: str
    version: str
    install: float
    first: float
    failed: tuple[str, ...]

    def __str__(self) -> str:
        told = "all commands" if not self.failed else "FAILED: " + "; ".join(self.failed)
        return f"| {self.name} | {self.version} | {self.install:.0f} | {self.first:.1f} | {told} |"


def main() -> int:
    parser = argparse.ArgumentParser(prog="make release", description=__doc__.partition("\n")[0])
    parser.add_argument("--lowest", action="store_true", help="also the lowest dependencies")
    args = parser.parse_args()
    wheel = build()
    found = [install(name, python, wheel) for name, python in interpreters()]
    if args.lowest:
        name, python = next(interpreters())
        found.append(install(f"{name}, lowest dependencies", python, wheel, lowest()))
    write_components(PLACES / next(interpreters())[0])
    write_sums()
    print(f"{wheel.name}: {wheel.stat().st_size / 1e6:.1f} MB")
    print("| Python | version | install (s) | first answer (s) | |\n|---|---|---|---|---|")
    print(*found, sep="\n")
    missing = [x for x in PYTHONS if x not in dict(interpreters())]
    if missing:
        print(f"not found here: Python {', '.join(missing)}")
    return int(any(x.failed for x in found))


def build() -> Path:
    """The wheel, which is built from the source archive; whatever was there before is removed."""
    shutil.rmtree(RELEASE, ignore_errors=True)
    run([sys.executable, "-m", "build", "--outdir", str(RELEASE), str(ROOT)])
    (wheel,) = RELEASE.glob("*.whl")
    return wheel


def interpreters() -> Iterator[tuple[str, Path]]:
    """Each Python that is found, on the path or among those of pyenv, and this one, by version."""
    for version in PYTHONS:
        others = sorted(Path.home().glob(f".pyenv/versions/{version}.*/bin/python"))
        on_path = shutil.which(f"python{version}")
        own = version == "{}.{}".format(*sys.version_info)
        named = [Path(x) for x in (on_path, sys.executable if own else None) if x]
        for candidate in [*others, *named]:
            asked = subprocess.run(
                [candidate, "-c", "import venv, ensurepip"], capture_output=True, check=False
            )
            if asked.returncode == 0:
                yield version, candidate
                break


def install(name: str, python: Path, wheel: Path, constraints: str = "") -> Installation:
    """A fresh environment with the wheel, and what the commands say in it."""
    place = PLACES / name.replace(", ", "-").replace(" ", "-")
    shutil.rmtree(place, ignore_errors=True)
    run([str(python), "-m", "venv", str(place)])
    pip = [str(place / "bin" / "python"), "-m", "pip", "install", "--quiet", str(wheel)]
    begun = time.monotonic()
    with tempfile.TemporaryDirectory() as home:
        limits = Path(home) / "constraints.txt"
        limits.write_text(constraints, "utf-8")
        run([*pip, "--constraint", str(limits)])
        seconds = time.monotonic() - begun
        version = run([str(place / "bin" / "python"), "-V"]).split()[1]
        first, failed = ask(place, Path(home))
    return Installation(name, version, seconds, first, failed)


def ask(place: Path, home: Path) -> tuple[float, tuple[str, ...]]:
    """Seconds until the first command is done, and the commands that did not print what they should."""
    kept = {name: x for name, x in os.environ.items() if not name.startswith(("PYTHON", "ROADPROOF"))}
    path = f"{place / 'bin'}{os.pathsep}/usr/bin{os.pathsep}/bin"
    variables = kept | {"PATH": path, "HOME": str(home), "ROADPROOF_QUIET": "1"}
    failed, first = [], 0.0
    for command, pattern in COMMANDS:
        begun = time.monotonic()
        done = subprocess.run(
            command, shell=True, cwd=home, env=variables, capture_output=True, text=True, check=False
        )
        first = first or time.monotonic() - begun
        if done.returncode or not re.search(pattern, done.stdout, re.M):
            failed.append(f"{command}: exit {done.returncode}: {(done.stderr or done.stdout)[-300:]}")
    return first, tuple(failed)


def lowest() -> str:
    """Constraints with the lowest version that ``pyproject.toml`` allows of each dependency."""
    said = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["dependencies"]
    bounds = (re.match(r"([\w-]+)>=([\w.]+)", x) for x in said)
    return "".join(f"{x[1]}=={x[2]}.*\n" for x in bounds if x is not None)


def write_components(place: Path) -> None:
    """The software bill of materials of an installation, as CycloneDX."""
    target = RELEASE / "sbom.cdx.json"
    run(
        [
            sys.executable,
            "-m",
            "cyclonedx_py",
            "environment",
            str(place / "bin" / "python"),
            "-o",
            str(target),
        ]
    )


def write_sums() -> None:
    """SHA-256 of each file, as ``sha256sum`` writes them."""
    lines = (f"{hashlib.sha256(x.read_bytes()).hexdigest()}  {x.name}\n" for x in sorted(RELEASE.iterdir()))
    (RELEASE / "SHA256SUMS").write_text("".join(lines), "utf-8")


def run(command: list[str]) -> str:
    """What a command prints; it must succeed."""
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


if __name__ == "__main__":
    sys.exit(main())
