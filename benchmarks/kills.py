"""Kill runs and their workers at random instants, and compare what is there in the end.

    python benchmarks/kills.py --kills 100 --seed 1

For each way of working (a local pool, shards, a cluster of dask) and each question (`overlap`, `evaluate`)
runs are started again and again into one folder; SIGKILL strikes a worker, or the whole run, after some time.
At the end the question is asked once more, undisturbed. What it leaves must be the bytes that an undisturbed
run into an empty folder leaves, but for the seconds that searches took. Exit code 1 where they differ.
"""

import argparse
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

WAYS = ("pool", "shards", "cluster")
QUESTIONS = ("overlap --among 1-4 --no-pictures", "evaluate traffic --no-pictures")


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    chance, wrong, made = random.Random(args.seed), 0, 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(folder, "simulate --out traffic --recordings 6 --seconds 60 --seed 5 --quiet")
        for question in QUESTIONS:
            begun = time.monotonic()
            run(folder, f"{question} --out undisturbed --quiet")
            length = time.monotonic() - begun
            wanted = contents(folder / "undisturbed")
            shutil.rmtree(folder / "undisturbed")
            for way in WAYS:
                count = -(-args.kills // (len(WAYS) * len(QUESTIONS)))
                kills = disturb(folder, question, way, count, length, chance)
                run(folder, f"{question} --out disturbed --quiet")
                found = contents(folder / "disturbed")
                same = found == wanted
                differ = [x for x in sorted({*found, *wanted}) if found.get(x) != wanted.get(x)]
                print(f"{question.split()[0]}, {way}: {kills} kills, the same: {same} {differ}", flush=True)
                wrong += not same
                made += sum(kills.values())
                shutil.rmtree(folder / "disturbed")
    print(f"{made} kills, {wrong} differences")
    return 1 if wrong else 0


def disturb(
    folder: Path, question: str, way: str, count: int, length: float, chance: random.Random
) -> dict[str, int]:
    """Start runs into one folder and strike until ``count`` kills are made; how many of what."""
    made = {"worker": 0, "run": 0}
    while sum(made.values()) < count:
        process = start(folder, f"{question} --out disturbed --quiet {more_of(way, chance)}")
        while process.poll() is None and sum(made.values()) < count:
            time.sleep(chance.uniform(0, length / 2 + 5 * (way == "cluster")))
            family = list(below(process.pid))
            if process.poll() is not None:
                break
            if family and chance.random() < 0.7:
                victim, what = chance.choice(family), "worker"
            else:
                victim, what = process.pid, "run"
            try:
                os.kill(victim, signal.SIGKILL)
            except ProcessLookupError:
                continue
            made[what] += 1
        process.kill() if chance.random() < 0.5 else None
        process.wait()
    return made


def more_of(way: str, chance: random.Random) -> str:
    match way:
        case "pool":
            return "--jobs 2"
        case "shards":
            return f"--jobs 1 --shard {chance.randint(1, 3)}/3"
        case _:
            return "--cluster local:2"


def below(pid: int) -> Iterator[int]:
    """All processes that a process started, and those that they did."""
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            parent = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
        except (OSError, IndexError):
            continue
        if parent == pid:
            yield int(folder.name)
            yield from below(int(folder.name))


def contents(folder: Path) -> dict[str, Any]:
    """Every file; of JSON all but seconds, and the seals and digests that are made of them."""
    found: dict[str, Any] = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            name = str(path.relative_to(folder))
            found[name] = (
                timeless(json.loads(path.read_text())) if path.suffix == ".json" else path.read_bytes()
            )
    return found


def timeless(data: Any) -> Any:
    match data:
        case dict():
            return {k: timeless(v) for k, v in data.items() if k not in ("seconds", "seal")}
        case list():
            return [timeless(x) for x in data]
        case _:
            return data


def start(folder: Path, line: str) -> "subprocess.Popen[bytes]":
    command = [sys.executable, "-m", "roadproof", *line.split()]
    return subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def run(folder: Path, line: str) -> None:
    code = start(folder, line).wait()
    if code:
        raise SystemExit(f"roadproof {line}: exit code {code}")


if __name__ == "__main__":
    sys.exit(main())
