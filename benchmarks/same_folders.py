"""Two checkouts side by side: the text and the files of randomly chosen commands of the documents.

    git worktree add --detach ../before 10af311
    .venv/bin/python benchmarks/same_folders.py ../before . [--count 20] [--seed 1] [--out FOLDER]

The commands are those of ``make findings``, each with the commands before it in the same folder. Text on
stdout, exit code and every file have to be the same. Seconds, which differ from run to run, are replaced
first, and so are digests that seal files with seconds in them, the number of the version, and words that
have changed since. FOLDER keeps what has been run, so a run that was broken off continues. Exit code 1 where
something differs.
"""

import argparse
import hashlib
import os
import random
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
sys.path[:0] = [str(ROOT / "tests")]

from findings.statements import PICTURES, STATEMENTS  # noqa: E402

SECONDS = re.compile(rb'("(?:seconds|seal|work|sha256|digest)": )(?:[\d.e-]+|"[0-9a-f]+")|\b[\d.]+ s\b')
WORDS = re.compile(
    rb" \((?:SV leaves its lane|SV enters that of POV)\)"
    rb"|none within the limits that are printed|no drive within the printed limits"
    rb"|(?<=roadproof )(?:0\.1\.0|1\.0\.0rc1)|(?<=\"version\": \")(?:0\.1\.0|1\.0\.0rc1)"
)
"""Words of reports changed since 10af311: brackets in names, what NONE-WITHIN means, the version."""
DATA = "../shared/data/us101"


def chains() -> list[tuple[str, ...]]:
    """The chains of commands that need no recorded traffic and run roadproof alone."""
    every = {x.commands for x in (*STATEMENTS, *PICTURES)}
    return sorted(x for x in every if all(c.startswith("roadproof ") and DATA not in c for c in x))


def program(home: Path, folder: Path) -> str:
    """A folder for PATH whose ``roadproof`` runs the sources of a checkout."""
    folder.mkdir(parents=True, exist_ok=True)
    script = folder / "roadproof"
    script.write_text(f'#!/bin/sh\nPYTHONPATH={home / "src"} exec {sys.executable} -m roadproof "$@"\n')
    script.chmod(0o755)
    return str(folder)


def run(home: Path, chain: tuple[str, ...], folder: Path) -> None:
    """Run a chain in ``folder``, where each command leaves its text and exit code."""
    for number, command in enumerate(chain, 1):
        kept = folder / f".printed-{number}"
        if kept.exists():
            continue
        folder.mkdir(parents=True, exist_ok=True)
        path = program(home, folder.parent / ".bin") + os.pathsep + os.environ["PATH"]
        here = {**os.environ, "PATH": path, "ROADPROOF_QUIET": "1", "COLUMNS": "100"}
        here["ROADPROOF_KNOWN"] = "off"
        done = subprocess.run(
            ["bash", "-c", command], cwd=folder, env=here, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
        )
        kept.write_bytes(done.stdout + f"exit {done.returncode}\n".encode())


def files(folder: Path) -> dict[str, bytes]:
    """The files below a folder without what differs from run to run."""
    found = sorted(x for x in folder.rglob("*") if x.is_file())
    return {str(x.relative_to(folder)): WORDS.sub(b"", SECONDS.sub(rb"\1-", x.read_bytes())) for x in found}


def differences(one: Path, two: Path) -> Iterator[str]:
    """The names of files that differ or that only one of the folders has."""
    before, after = files(one), files(two)
    yield from (name for name in sorted({*before, *after}) if before.get(name) != after.get(name))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("out/same-folders"))
    args = parser.parse_args()
    every = chains()
    chosen = random.Random(args.seed).sample(every, min(args.count, len(every)))
    wrong = 0
    for chain in chosen:
        name = hashlib.sha256("\n".join(chain).encode()).hexdigest()[:10]
        places = args.out.absolute() / "before" / name, args.out.absolute() / "after" / name
        for home, place in zip((args.before, args.after), places, strict=True):
            run(home.absolute(), chain, place)
        found = list(differences(*places))
        wrong += bool(found)
        print(f"{'DIFFERS' if found else 'same':8} {len(files(places[1])):>4} files  {chain[-1]}", flush=True)
        for name in found[:5]:
            print(f"         {name}")
    print(f"{len(chosen)} chains of commands, {wrong} differ")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
