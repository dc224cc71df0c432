"""Two checkouts side by side: the processor time of a handful of command lines in each, and the ratio.

    git worktree add --detach ../before b754a35
    .venv/bin/python benchmarks/before_after.py ../before . [--runs N] [--only PATTERN]

Each line is run with the sources of both checkouts in turns, with one process, by this same interpreter. What
counts is user and system time, children included, the least of N runs: others may use the machine, and the
first run compiles the sources. Known answers are off. Inputs are made once, by the second checkout. Exit
code 1 where a line takes over 5 % more, 2 where one fails.
"""

import argparse
import re
import resource
import subprocess
import sys
import tempfile
from os import environ
from pathlib import Path

MOST = 1.05
# {home} is a checkout, {work} a folder with drives and a recording, {new} one that is not there yet.
LINES: dict[str, str] = {
    "help": "--help",
    "list": "list",
    "prove true": "prove true",
    "prove P1": "prove P1 --set base --jobs 1",
    "prove P1 --out": "prove P1 --set base --jobs 1 --out {new}",
    "prove P4": "prove P4 --set base --jobs 1",
    "witness 4": "witness 4 --jobs 1",
    "witness --all --out": "witness --all --set base --jobs 1 --no-pictures --out {new}",
    "compare 3 4": "compare 3 4",
    "overlap": "overlap --among 4,5,8 --jobs 1",
    "explore": "explore 4 --vary minDanger=0:3 --jobs 1",
    "evaluate": "evaluate {work}/traffic --out {new} --no-pictures --jobs 1",
    "monitor": "monitor 4 {work}/drives/scenario-04-base.json",
    "check": "check {home}/proofs --jobs 1",
}


def run(home: Path, line: str) -> float:
    """Seconds of processor time. Raises ``CalledProcessError`` where it fails."""
    command = [sys.executable, "-m", "roadproof", *line.split()]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    here = {name: value for name, value in environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    here |= {"PYTHONPATH": str(home / "src"), "ROADPROOF_KNOWN": "off"}
    done = subprocess.run(command, env=here, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 10):
        raise subprocess.CalledProcessError(done.returncode, command, done.stdout, done.stderr)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def least(homes: tuple[Path, Path], line: str, work: Path, runs: int) -> list[float]:
    found: list[list[float]] = [[], []]
    for _ in range(runs):
        for times, home in zip(found, homes, strict=True):
            with tempfile.TemporaryDirectory() as folder:
                times.append(run(home, line.format(home=home, work=work, new=Path(folder) / "new")))
    return [min(times) for times in found]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--only", default="", help="lines that this pattern is found in")
    args = parser.parse_args()
    homes, slower = (args.before.absolute(), args.after.absolute()), False
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        run(homes[1], f"witness 4 --no-pictures --jobs 1 --out {work}/drives")
        run(homes[1], f"simulate --out {work}/traffic --seconds 120 --plant {work}/drives --jobs 1")
        print(f"{'':20} {'before':>8} {'after':>8}  ratio")
        for name, line in LINES.items():
            if not re.search(args.only, name):
                continue
            try:
                before, after = least(homes, line, work, args.runs)
            except subprocess.CalledProcessError as error:
                print(f"{name}: exit {error.returncode}: {error.stderr.strip()[-500:]}")
                return 2
            slower = slower or after > MOST * before
            print(f"{name:20} {before:6.2f} s {after:6.2f} s  {after / before:5.2f}", flush=True)
    return int(slower)


if __name__ == "__main__":
    sys.exit(main())
