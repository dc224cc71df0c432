"""Two checkouts side by side: what a handful of command lines take in each, and the ratio.

    git worktree add --detach ../before b754a35
    .venv/bin/python benchmarks/before_after.py ../before . [--runs N] [--only PATTERN] [--whole]

Each line is run with the sources of both checkouts in turns, by this same interpreter: minimum and median of
N runs, on the clock and of the processor, children included. The ratio is that of the least processor times:
others may use the machine, and the first run compiles the sources. ``--whole`` runs whole analyses, in two
processes, in place of single questions in one. Known answers are off. Inputs are made once, by the second
checkout. Exit code 1 where a line takes over 5 % more, 2 where one fails.
"""

import argparse
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from os import environ
from pathlib import Path

MOST = 1.05
# {home} is a checkout, {work} a folder with drives and a recording, {new} one that is not there yet.
LINES: Mapping[str, str] = {
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
WHOLE: Mapping[str, str] = {
    "162 claims": "prove --jobs 2 --out {new}",
    "72 witnesses": "witness --all --set base,extA,ext --no-pictures --jobs 2 --out {new}",
    "276 pairs": "overlap --no-pictures --jobs 2 --out {new}",
}


@dataclass
class Times:
    """Seconds of the runs of a line, on the clock and of the processor."""

    wall: list[float] = field(default_factory=list)
    cpu: list[float] = field(default_factory=list)

    def __str__(self) -> str:
        kinds = (self.wall, self.cpu)
        return "  ".join(f"{min(x):6.2f} {statistics.median(x):6.2f}" for x in kinds)


def run(home: Path, line: str, times: Times) -> None:
    """Raises ``CalledProcessError`` where it fails."""
    command = [sys.executable, "-m", "roadproof", *line.split()]
    here = {name: value for name, value in environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    here |= {"PYTHONPATH": str(home / "src"), "ROADPROOF_KNOWN": "off"}
    begun, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, env=here, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 10):
        raise subprocess.CalledProcessError(done.returncode, command, done.stdout, done.stderr)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    times.wall.append(time.perf_counter() - begun)
    times.cpu.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def in_turns(homes: tuple[Path, Path], line: str, work: Path, runs: int) -> tuple[Times, Times]:
    found = Times(), Times()
    for _ in range(runs):
        for times, home in zip(found, homes, strict=True):
            with tempfile.TemporaryDirectory() as folder:
                run(home, line.format(home=home, work=work, new=Path(folder) / "new"), times)
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--only", default="", help="lines that this pattern is found in")
    parser.add_argument("--whole", action="store_true", help="whole analyses, in two processes")
    args = parser.parse_args()
    homes, slower = (args.before.absolute(), args.after.absolute()), False
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        run(homes[1], f"witness 4 --no-pictures --jobs 1 --out {work}/drives", Times())
        run(homes[1], f"simulate --out {work}/traffic --seconds 120 --plant {work}/drives --jobs 1", Times())
        print(f"{'':20} {'before':^30} {'after':^30}  ratio")
        print(f"{'':20}" + f"{' wall: min, median; processor':30} " * 2)
        for name, line in (WHOLE if args.whole else LINES).items():
            if not re.search(args.only, name):
                continue
            try:
                before, after = in_turns(homes, line, work, args.runs)
            except subprocess.CalledProcessError as error:
                print(f"{name}: exit {error.returncode}: {error.stderr.strip()[-500:]}")
                return 2
            ratio = min(after.cpu) / min(before.cpu)
            slower = slower or ratio > MOST
            print(f"{name:20} {before}   {after}   {ratio:5.2f}", flush=True)
    return int(slower)


if __name__ == "__main__":
    sys.exit(main())
