"""The figures of decision record 23: sizes of layers and repeated readings of text, in several revisions.

    .venv/bin/python benchmarks/front_door.py b754a35 065e57a

Each revision is unpacked into a temporary folder. Lines are those of Python files. Calls are counted by
cProfile in one process, with the cache switched off; the recording is simulated by the same revision.
"""

import io
import pstats
import re
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Iterator, Sequence
from os import environ
from pathlib import Path

ROOT = Path(__file__).parents[1]
LAYERS = ("cli", "api", "report", "analysis")
ANY = re.compile(r"(?:dict|Mapping)\[str, Any\]")


def unpack(revision: str, folder: Path) -> Path:
    """The sources of a revision of this checkout. Raises ``CalledProcessError`` where it is not known."""
    command = ["git", "-C", str(ROOT), "archive", revision, "src", "models", "proofs"]
    packed = subprocess.run(command, check=True, capture_output=True).stdout
    with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
        archive.extractall(folder, filter="data")
    return folder


def texts(home: Path, layer: str = "") -> list[str]:
    """The Python files of a layer, wherever the revision has it; of the whole package without a layer."""
    package = home / "src" / "roadproof"
    places = [x for x in (package / layer, package / "frontends" / layer) if x.is_dir()]
    return [x.read_text("utf-8") for x in places[-1].rglob("*.py")] if places else []


def calls(home: Path, functions: Sequence[str], line: str, work: Path) -> dict[str, int]:
    """How often a command line calls functions of these names."""
    kept = work / "calls.prof"
    where = "frontends.cli" if (home / "src" / "roadproof" / "frontends").is_dir() else "cli"
    asked = f"from roadproof.{where}.main import main; main({line.split()!r})"
    profiled = [sys.executable, "-c", f"import cProfile; cProfile.run({asked!r}, {str(kept)!r})"]
    here = {**environ, "PYTHONPATH": str(home / "src"), "ROADPROOF_CACHE": "off"}
    subprocess.run(profiled, env=here, cwd=work, check=True, capture_output=True)
    found = dict.fromkeys(functions, 0)
    for (_, _, name), (_, count, *_) in pstats.Stats(str(kept)).stats.items():  # type: ignore[attr-defined]
        if name in found:
            found[name] += count
    return found


def figures(home: Path, work: Path) -> Iterator[tuple[str, str]]:
    """The rows of the table for one revision."""
    for layer in LAYERS:
        yield f"lines of {layer}", f"{sum(text.count(chr(10)) for text in texts(home, layer)):,}"
    yield "lines of all Python", f"{sum(text.count(chr(10)) for text in texts(home)):,}"
    for layer in ("cli", "report", "analysis"):
        yield (
            f"`dict/Mapping[str, Any]` in {layer}",
            str(sum(len(ANY.findall(x)) for x in texts(home, layer))),
        )
    reading = ("parse_claim", "load_library")
    for line in ("overlap --among 4,5,8", "classify --among 4,8"):
        found = calls(home, reading, f"{line} --jobs 1", work)
        yield f"`{line}`: claims parsed, libraries loaded", ", ".join(str(found[x]) for x in reading)
    calls(home, (), f"simulate --seconds 20 --seed 3 --out {work}/traffic", work)
    sets = "--scenarios 1-8" if "--scenarios" in "".join(texts(home, "cli")) else "--among 1-8"
    found = calls(home, ("read_claim",), f"evaluate {work}/traffic --jobs 1 {sets} --out {work}/out", work)
    yield "`evaluate` of a recording: calls of `read_claim`", str(found["read_claim"])


def main(revisions: Sequence[str]) -> int:
    columns = []
    for revision in revisions:
        with tempfile.TemporaryDirectory() as folder:
            home, work = unpack(revision, Path(folder) / "home"), Path(folder) / "work"
            work.mkdir()
            columns.append(dict(figures(home, work)))
    print("|", *(f"| {x}" for x in revisions), "|")
    print("|---" * (1 + len(revisions)) + "|")
    for name in columns[0]:
        print(f"| {name} |", " | ".join(x[name] for x in columns), "|")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
