"""How long the highD experiment takes on simulated recordings of highD's size, and beside plain reading.

    python benchmarks/traffic_speed.py --recordings 60 --folder /tmp/highd-shaped --jobs 2

Makes the recordings that the folder does not have yet, then measures in one run: simulating and
writing one recording; reading the needed columns of all tracks with nothing else; the whole
experiment (three sets, minDanger 0 and 0.6, scenario 2 included), in as many processes as asked;
and the peak memory of a process.
"""

import argparse
import multiprocessing
import resource
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from roadproof.extensions.traffic.evaluate.experiment import Experiment, run_experiment
from roadproof.extensions.traffic.evaluate.questions import default_settings
from roadproof.extensions.traffic.formats.highd import SAMPLE_KINDS
from roadproof.extensions.traffic.formats.table import polars_module
from roadproof.extensions.traffic.formats.write_highd import write_highd
from roadproof.extensions.traffic.simulate.simulate import simulate
from roadproof.extensions.traffic.simulate.traffic import TrafficSettings
from roadproof.runtime.executors import Executor


def seconds(work: Callable[[], object]) -> float:
    begun = time.perf_counter()
    work()
    return time.perf_counter() - begun


def make(folder: Path, number: int, length: float) -> float | None:
    """Seconds that simulating and writing took; None where the recording is there already."""
    if (folder / f"{number:02d}_tracks.csv").exists():
        return None
    return seconds(lambda: write_highd(simulate(TrafficSettings(seconds=length), 34502, number), folder))


def processor_seconds() -> float:
    """Of this process and those that it has waited for."""
    who = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return sum(found.ru_utime + found.ru_stime for found in map(resource.getrusage, who))


def read_columns(path: Path, names: list[str]) -> None:
    """Read some columns and check nothing."""
    polars_module().read_csv(path, columns=names)


def read(paths: list[Path]) -> tuple[float, float]:
    """Seconds that plain reading takes, by the wall and of the processor, the files being in memory."""
    read_columns(paths[0], list(SAMPLE_KINDS))  # what is imported and started once
    begun = processor_seconds()
    took = seconds(lambda: [read_columns(path, list(SAMPLE_KINDS)) for path in paths])
    return took, processor_seconds() - begun


def read_apart(paths: list[Path]) -> tuple[float, float]:
    """The same in a process of its own, so that the experiment begins without polars, as elsewhere."""
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        return pool.submit(read, paths).result()


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--recordings", type=int, default=6)
    parser.add_argument("--seconds", type=float, default=990.0, help="length of a recording")
    parser.add_argument("--folder", type=Path, help="keep the recordings here (default: a temporary folder)")
    parser.add_argument("--jobs", type=int, default=2)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = args.folder or Path(temporary) / "recordings"
        made = [make(folder, k, args.seconds) for k in range(1, args.recordings + 1)]
        took = [x for x in made if x is not None]
        if took:
            print(f"simulate and write: mean {sum(took) / len(took):.2f} s, worst {max(took):.2f} s")
        paths = sorted(folder.glob("*_tracks.csv"))[: args.recordings]
        reading = read_apart(paths)
        out = Path(temporary) / "out"
        outcome = None

        def experiment() -> None:
            nonlocal outcome
            outcome = run_experiment(Experiment(folder, out, default_settings(), Executor(args.jobs)))

        begun = processor_seconds()
        running = seconds(experiment)
        worked = processor_seconds() - begun
        again = read_apart(paths)
        assert outcome is not None
        totals = outcome.totals
        print(f"{totals.recordings} recordings, {totals.vehicles} vehicles, {totals.samples} samples")
        for name, plain, took in zip(
            ("wall", "processor"), zip(reading, again, strict=True), (running, worked), strict=True
        ):
            before, after = plain
            print(f"reading the needed columns, {name}: {before:.2f} s before, {after:.2f} s after")
            ratio = 2 * took / (before + after)
            print(f"the whole experiment, {args.jobs} jobs, {name}: {took:.2f} s, {ratio:.2f} times as long")
        who = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
        peaks = [resource.getrusage(x).ru_maxrss / 2**20 for x in who]
        print(f"peak memory: {peaks[0]:.2f} GiB in this process, {peaks[1]:.2f} GiB in the largest worker")
        for row in totals.rows:
            recall = "" if row.recall is None else f"{100 * row.recall:.1f} %"
            counts = " ".join(f"s{i}={row.scenarios[i]}" for i in totals.settings.scenarios)
            name = f"minDanger {row.min_danger}, {row.set_name}"
            print(f"{name}: {row.matching} of {row.traces}, {recall}; {counts}")
        print(f"broken facts: {len(totals.broken)}; s3 and s4 differ on {len(totals.unequal_3_4)} pairs")


if __name__ == "__main__":
    main()
