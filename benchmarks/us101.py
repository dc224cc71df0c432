"""What docs/explanation/us101.md says beyond the results of `roadproof evaluate`.

    python benchmarks/us101.py ../shared/data/us101 out/us101

The first folder holds the recordings, the second what `roadproof evaluate` wrote about them. A trace
without a common lane is one of a pair that is in no lane together while the trace lasts.
"""

import argparse
import csv
import sys
from pathlib import Path
from xml.etree.ElementTree import parse

import numpy as np

from roadproof.extensions.traffic.formats.recording import Recording
from roadproof.extensions.traffic.formats.sources import find_sources


def share_a_lane(recording: Recording, first: int, second: int, begin: int, end: int) -> bool:
    """Whether two vehicles (their ids) occupy one lane in some frame from ``begin`` to ``end``."""
    masks = []
    for number in (first, second):
        k = int(np.flatnonzero(recording.vehicle_id == number)[0])
        at = recording.start[k] - recording.first_frame[k]
        masks.append(recording.occupancy[at + begin : at + end + 1])
    return bool(np.any(masks[0] & masks[1]))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("recordings", type=Path)
    parser.add_argument("results", type=Path)
    args = parser.parse_args()
    recordings = {source.name: source.read() for source in find_sources(args.recordings)}
    with (args.results / "pairs.csv").open(encoding="utf-8", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["min_danger"] == "0" and row["ext"] == "0"]
    apart = sum(
        not share_a_lane(
            recordings[row["recording"]],
            *(int(row[name]) for name in ("first", "second", "start_frame", "end_frame")),
        )
        for row in rows
    )
    print(
        f"{len(rows)} traces match no scenario of ext with minDanger 0, {apart} of them without a common lane"
    )
    kinds = np.concatenate([recording.kind for recording in recordings.values()])
    print(f"{np.sum(kinds == 'Truck')} of {len(kinds)} vehicles are longer than 7 m")
    lengths = sorted((x.last_frame.max() - x.first_frame.min()) / x.rate for x in recordings.values())
    print(f"windows of {lengths[0]:g} to {lengths[-1]:g} s")
    files = (parse(path) for path in sorted(args.recordings.glob("*.xml")))
    told = (x.text or "" for file in files for x in file.iterfind("dynamicObstacle//acceleration/exact"))
    accelerations = np.abs(np.array([float(x) for x in told]))
    limit = float(accelerations.max())
    share = 100 * float(np.mean(accelerations > limit - 0.01))
    print(
        f"accelerations: the greatest is {limit:.3f} m/s², {share:.1f} % of all samples are within 0.01 of it"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
