"""What roadproof reads of maps and recordings that others made: a table of files, and the refusals by reason.

    python benchmarks/foreign_files.py FOLDER --out out/foreign

FOLDER may have folders for the sources of files, to any depth. Read are CommonRoad (``.xml``), OpenDRIVE
(``.xodr``) and Lanelet2 (``.osm``), each content once. A CommonRoad file counts as a recording where it has
dynamic obstacles, and each file as a map. ``files.csv`` has a row a file and use, ``reasons.csv`` a row a
kind of refusal or omission. Of a recording that is refused the row says how far its vehicles move in the
plane, as a share of what their speeds say: 1 where a file agrees with itself.
"""

import argparse
import csv
import hashlib
import re
import signal
import sys
import time
from collections import Counter
from collections.abc import Iterator
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np

from roadproof.errors import RoadproofError
from roadproof.extensions.exchange.commonroad import read_commonroad
from roadproof.extensions.exchange.commonroad_obstacles import ObstacleRules, read_obstacles
from roadproof.extensions.maps.roads import all_stretches
from roadproof.extensions.maps.xml_reader import read_xml
from roadproof.extensions.traffic.formats.reliable import LEFT_OUT

ENDINGS = (".xml", ".xodr", ".osm")


@dataclass(frozen=True)
class Row:
    """A file in one use. ``parts``: vehicles or stretches that it has, ``read``: how many of them are read.

    ``told``: reasons and places of what is refused, or the omissions.
    """

    source: str
    file: str
    use: str
    result: str
    read: int
    parts: int
    seconds: float
    told: str


def files_of(folder: Path) -> Iterator[Path]:
    """The files below a folder, each content once."""
    seen = set[str]()
    for path in sorted(x for x in folder.rglob("*") if x.is_file() and x.suffix in ENDINGS):
        content = path.read_bytes()
        digest = hashlib.sha256(content).hexdigest()
        if digest not in seen and (path.suffix != ".xml" or b"<commonRoad" in content):
            seen.add(digest)
            yield path


def traffic_row(path: Path) -> tuple[str, int, int, str]:
    """The result for a recording, vehicles read, vehicles there, and omissions."""
    there = path.read_text(encoding="utf-8", errors="replace").count("<dynamicObstacle ")
    recording = read_commonroad(path, strict=False)
    omissions = [x for x in recording.notes if LEFT_OUT in x]
    return ("read in part" if omissions else "read"), recording.vehicles, there, "; ".join(omissions)


def plane_share(path: Path) -> str:
    """How far vehicles of a refused recording move in the plane, as a share of speed by time."""
    root = read_xml(path, "commonRoad")
    rate = round(1 / float(root.get("timeStepSize", "0.1")))
    try:
        obstacles, _ = read_obstacles(path, root, ObstacleRules(rate, 7.0, False))
    except RoadproofError:
        return ""
    shares = []
    for x in obstacles:
        told = float(np.abs(x.states[:-1, 3] + x.states[1:, 3]).sum()) / 2 / rate
        moved = float(np.hypot(*np.diff(x.states[:, :2], axis=0).T).sum())
        if max(told, moved) > 5:
            shares.append(moved / max(told, 1e-3))
    if not shares:
        return ""
    low, middle, high = np.percentile(shares, [10, 50, 90])
    return f"; of the way that speeds say, vehicles move {middle:.2f} in the median ({low:.2f} to {high:.2f})"


def road_row(path: Path) -> tuple[str, int, int, str]:
    """The result for a map, stretches that are usable, stretches there, and why others are not."""
    found = [x for x in all_stretches(path) if "left out as no roads" not in x.refused]
    usable = [x for x in found if not x.refused]
    told = "; ".join(x.refused for x in found if x.refused)
    result = "read" if len(usable) == len(found) else "read in part" if usable else "refused"
    return result, len(usable), len(found), told


def rows_of(folder: Path, path: Path, limit: float) -> Iterator[Row]:
    """A row for each use of a file."""
    uses = {"roads": road_row}
    if path.suffix == ".xml" and b"<dynamicObstacle " in path.read_bytes():
        uses = {"traffic": traffic_row, **uses}
    place = path.relative_to(folder)
    for use, read in uses.items():
        begin = time.monotonic()
        signal.setitimer(signal.ITIMER_REAL, limit)
        try:
            result, done, of, told = read(path)
        except RoadproofError as error:
            more = plane_share(path) if use == "traffic" else ""
            result, done, of, told = "refused", 0, 0, f"{error}{more}"
        except TimeoutError:
            result, done, of, told = "too slow", 0, 0, f"not within {limit:g} s"
        except Exception as error:  # a crash is a row of the table
            result, done, of, told = "crash", 0, 0, f"{type(error).__name__}: {error}"
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
        told = told.replace(f"{path}", path.name)
        spent = round(time.monotonic() - begin, 1)
        yield Row(str(place.parent), place.name, use, result, done, of, spent, told)


def reason_of(told: str) -> str:
    """A refusal without its place: names and numbers are left out.

    >>> reason_of("a.xodr: road 12, lane -3: its width is below 0")
    'road N, lane N: its width is below N'
    """
    text = re.sub(r"\S+\.(xml|xodr|osm)(#\S*)?(, way of lanelet \S+)?[:,] *", "", told)
    text = re.sub(r"\([^)]*\)", "()", text)
    return re.sub(r"(?<!\w)-?\d[\w.+-]*", "N", text)[:160]


def _interrupt(number: int, frame: object) -> None:
    raise TimeoutError


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--limit", type=float, default=60.0, metavar="SECONDS")
    args = parser.parse_args()
    signal.signal(signal.SIGALRM, _interrupt)
    args.out.mkdir(parents=True, exist_ok=True)
    results, reasons = Counter[tuple[str, str, str]](), Counter[tuple[str, str, str, str]]()
    with (args.out / "files.csv").open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(x.name for x in fields(Row))
        for path in files_of(args.folder):
            for row in rows_of(args.folder, path, args.limit):
                table.writerow(astuple(row))
                file.flush()
                results[path.suffix, row.use, row.result] += 1
                for told in {reason_of(x) for x in row.told.split("; ") if x}:
                    reasons[path.suffix, row.use, row.result, told] += 1
    with (args.out / "reasons.csv").open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file)
        table.writerow(("format", "use", "result", "files", "reason"))
        table.writerows((*key[:3], count, key[3]) for key, count in reasons.most_common())
    for (ending, use, result), count in sorted(results.items()):
        print(f"{ending:6} {use:8} {result:13} {count:4}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
