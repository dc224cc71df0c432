"""An environment for each client under out/interop, made once; the versions are in pins.toml."""

import shutil
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parent
OUT = HERE.parents[1] / "out" / "interop"


@dataclass(frozen=True)
class Client:
    """A program that reads files of a format; ``script`` runs it in its environment."""

    name: str
    about: str
    format: str
    files: str
    script: str
    packages: tuple[str, ...]


def clients() -> list[Client]:
    pins = tomllib.loads((HERE / "pins.toml").read_text("utf-8"))
    return [Client(name, **{**x, "packages": tuple(x["packages"])}) for name, x in pins.items()]


def python_of(client: Client, folder: Path = OUT / "environments") -> Path | str:
    """The Python of the client's environment, or why there is none."""
    home = folder / client.name
    python, mark = home / "bin" / "python", home / "pins"
    pins = "\n".join(client.packages)
    if mark.is_file() and mark.read_text("utf-8") == pins:
        return python
    shutil.rmtree(home, ignore_errors=True)
    made = subprocess.run([sys.executable, "-m", "venv", str(home)], capture_output=True, text=True)
    if made.returncode:
        return f"no environment: {_last(made.stderr or made.stdout)}"
    pip = [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    found = subprocess.run([*pip, *client.packages], capture_output=True, text=True)
    if found.returncode:
        shutil.rmtree(home, ignore_errors=True)
        return f"{', '.join(client.packages)} cannot be installed: {_last(found.stderr)}"
    mark.write_text(pins, "utf-8")
    return python


def _last(text: str) -> str:
    lines = [x.strip() for x in text.splitlines() if x.strip()]
    return lines[-1] if lines else "no reason is given"
