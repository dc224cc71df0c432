"""Questions whose answers come with roadproof: processor time with and without them, and bytes shipped.

    .venv/bin/python benchmarks/known.py [--only PATTERN] [--csv FILE] [--known]

Processor time is user and system time, children included, with an empty cache and two processes. "computed"
runs with --fresh, "known" without. Exit code 1 where a known answer takes 2 s or more of wall time.
"""

import argparse
import csv
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HOME = Path(__file__).parents[1]
MOST = 2.0  # seconds
LINES = (
    "prove",
    "witness --all",
    "witness --all --objective mild",
    "witness --all --objective severe",
    "overlap",
    "overlap --lanes any --roles any",
    "order",
    "redundancy",
    "coverage",
    "classify",
    "preventable cut-in",
    "preventable cut-out",
    "preventable deceleration",
)


def run(line: str, cache: str) -> tuple[float, float]:
    """Wall and processor seconds of a command. Raises ``CalledProcessError`` where it fails."""
    command = [sys.executable, "-m", "roadproof", *line.split()]
    here = {**os.environ, "PYTHONPATH": str(HOME / "src"), "XDG_CACHE_HOME": cache, "ROADPROOF_QUIET": "1"}
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run(command, env=here, capture_output=True, check=False)
    if done.returncode not in (0, 10, 20):
        raise subprocess.CalledProcessError(done.returncode, command, done.stdout, done.stderr)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    worked = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return time.monotonic() - begun, worked


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--only", default="", help="commands that match this")
    parser.add_argument("--csv", type=Path, help="write the table here")
    parser.add_argument("--known", action="store_true", help="without the runs that compute")
    args = parser.parse_args()
    rows = [["command", "computed", "known", "known, wall"]]
    slow = False
    for line in (x for x in LINES if re.search(args.only, x)):
        computed = "-"
        if not args.known:
            with tempfile.TemporaryDirectory() as cache:
                computed = f"{run(f'{line} --fresh --jobs 2', cache)[1]:.1f} s"
        with tempfile.TemporaryDirectory() as cache:
            wall, known = run(line, cache)
        slow = slow or wall >= MOST
        rows.append([f"`roadproof {line}`", computed, f"{known:.1f} s", f"{wall:.1f} s"])
        print("  ".join(rows[-1]), flush=True)
    shipped = sum(x.stat().st_size for x in (HOME / "proofs" / "known").iterdir())
    print(f"{shipped / 1e6:.2f} MB shipped")
    if args.csv is not None:
        with args.csv.open("w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows(rows)
    return int(slow)


if __name__ == "__main__":
    sys.exit(main())
