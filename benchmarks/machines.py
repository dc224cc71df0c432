"""How long an evaluation of very many recordings takes on many machines: costs measured here, then simulated.

    python benchmarks/machines.py --recordings 10000 --machines 64 --failing 200

Measured on this machine, in processor seconds, on recordings of highD's length (16.5 min): to start, to take
the digest of the files, to evaluate, to merge what is stored, and what dask adds for each task. Then a
simulation by events: each task reads its files over a disk that all machines share and is evaluated; one task
in ``--failing`` kills its process somewhere on the way. Printed are the seconds of each stage with the
present rules, and with the rules before (the first run reads all files itself, and each lost task waits for
the one before). The first bottleneck is the stage that takes longest beyond an even share of the work.
"""

import argparse
import heapq
import random
import resource
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

MINUTES = 16.5
"""The length of a recording of highD."""


@dataclass(frozen=True)
class Costs:
    """Processor seconds and megabytes for one recording; ``start`` for a process, ``task`` for dask."""

    start: float
    digest: float
    evaluate: float
    merge: float
    task: float
    megabytes: float


@dataclass(frozen=True)
class Farm:
    """Machines with ``cores``, and a disk that all share, of so many megabytes a second."""

    machines: int
    cores: int
    disk: float
    failing: int

    @property
    def workers(self) -> int:
        return self.machines * self.cores


def seconds_of(command: Sequence[str], folder: Path) -> float:
    """Processor seconds of a command of roadproof, with its processes."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(
        [sys.executable, "-m", "roadproof", *command], cwd=folder, check=True, stdout=subprocess.DEVNULL
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def measured(folder: Path, count: int) -> Costs:
    """The costs on this machine, on ``count`` recordings of a simulated motorway."""
    seconds_of(["simulate", "--out", "all", "--recordings", str(count), "--seed", "34502", "--quiet"], folder)
    (folder / "one").mkdir()
    for file in (folder / "all").glob("01_*"):
        (folder / "one" / file.name).write_bytes(file.read_bytes())
    plain = ["--no-pictures", "--quiet", "--jobs", "1"]
    one = seconds_of(["evaluate", "one", "--out", "r1", *plain], folder)
    every = seconds_of(["evaluate", "all", "--out", "r2", *plain], folder)
    again = seconds_of(["evaluate", "all", "--out", "r2", *plain], folder)
    first = seconds_of(["evaluate", "one", "--out", "r1", *plain], folder)
    cluster = ["--no-pictures", "--quiet", "--cluster"]
    spread = seconds_of(["evaluate", "all", "--out", "r3", *cluster, "local:1"], folder)
    few = seconds_of(["evaluate", "one", "--out", "r4", *cluster, "local:1"], folder)
    files = [x for x in (folder / "all").iterdir() if x.suffix == ".csv"]
    digest = seconds_digest(files) / count
    one_more = (every - one) / (count - 1)
    return Costs(
        start=one - one_more,
        digest=digest,
        evaluate=one_more - digest,
        merge=max(0.0, (again - first) / (count - 1) - digest),
        task=max(0.0, (spread - few - (every - one)) / (count - 1)),
        megabytes=sum(x.stat().st_size for x in files) / count / 1e6,
    )


def seconds_digest(files: Sequence[Path]) -> float:
    """Processor seconds to take the SHA-256 of files that have just been read."""
    code = "import hashlib, sys\nfor x in sys.argv[1:]: hashlib.file_digest(open(x, 'rb'), 'sha256')"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, "-c", code, *map(str, files)], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def spread(
    seconds: float, count: int, megabytes: float, farm: Farm, start: float, chance: random.Random
) -> tuple[float, int]:
    """Simulate ``count`` tasks on all workers: seconds until all are done, and how many were lost.

    A task takes its processor ``seconds`` after its files, of which the disk gives each busy worker an even
    share. A lost task has cost a part of its time, and its worker starts anew.
    """
    ready = [start] * min(farm.workers, count)
    heapq.heapify(ready)
    lost, end = 0, 0.0
    read = megabytes * min(farm.workers, count) / farm.disk
    for _ in range(count):
        begun = heapq.heappop(ready)
        takes = read + seconds
        if farm.failing and chance.random() < 1 / farm.failing:
            lost, takes = lost + 1, chance.random() * takes + start
        end = max(end, begun + takes)
        heapq.heappush(ready, begun + takes)
    return end, lost


def stages(costs: Costs, farm: Farm, count: int, scale: float, before: bool) -> dict[str, float]:
    """Seconds of each stage on a cluster; ``scale``: how many times highD's length a recording has."""
    chance = random.Random(1)
    found = {"start": costs.start}
    megabytes, digest = costs.megabytes * scale, costs.digest * scale + costs.task
    if before:
        found["digests, on the first machine"] = count * max(megabytes / farm.disk, digest / farm.cores)
    else:
        whole = Farm(farm.machines, farm.cores, farm.disk, 0)
        found["digests, on all machines"] = spread(digest, count, megabytes, whole, 0, chance)[0]
    work = costs.evaluate * scale + costs.task
    found["evaluation"], lost = spread(work, count, megabytes, farm, costs.start, chance)
    if before:
        found[f"{lost} lost tasks, one by one"] = lost * (work + megabytes / farm.disk + costs.start)
    else:
        found[f"{lost} lost tasks, together"], again = spread(
            work, lost, megabytes, farm, costs.start, chance
        )
        found[f"{again} lost again, one by one"] = again * (work + megabytes / farm.disk + costs.start)
    found["merge"] = costs.start + count * costs.merge * scale
    return found


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--recordings", type=int, default=10_000, help="recordings of an hour")
    parser.add_argument("--machines", type=int, default=64)
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument(
        "--disk", type=float, nargs="+", default=[1000.0, 10_000.0], help="megabytes a second"
    )
    parser.add_argument("--failing", type=int, default=200, help="one task in so many is lost")
    parser.add_argument("--measure", type=int, default=4, help="recordings to measure with")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        costs = measured(Path(name), args.measure)
    print(", ".join(f"{key} {value:.3f}" for key, value in vars(costs).items()))
    scale = 60 / MINUTES
    for disk in args.disk:
        farm = Farm(args.machines, args.cores, disk, args.failing)
        for before in (True, False):
            found = stages(costs, farm, args.recordings, scale, before)
            print(f"\ndisk {disk:.0f} MB/s, {'rules before' if before else 'present rules'}")
            for stage, seconds in found.items():
                print(f"  {seconds:8.0f} s  {stage}")
            print(f"  {sum(found.values()):8.0f} s  in all")


if __name__ == "__main__":
    main()
