"""``roadproof simulate``: recordings in the highD format, made of simulated traffic."""

import argparse
import csv
import io
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.cli.numbers import decimal, whole
from roadproof.cli.progress import note
from roadproof.cli.working import add_working_options, work_in_order
from roadproof.errors import InputError, UsageError
from roadproof.verdict import ExitCode

_NUMBERS = re.compile(r"\d{1,2}(-\d{1,2})?(,\d{1,2}(-\d{1,2})?)*")

if TYPE_CHECKING:
    from roadproof.evidence.drive_file import DriveFile
    from roadproof.traffic.planting import Truth
    from roadproof.traffic.simulate import Traffic

SUMMARY = "make recordings in the highD format from simulated traffic"

_EXAMPLES = """\
Car following is IDM (Treiber et al. 2000), lane changes are MOBIL (Kesting et al. 2007). The same seed
gives the same files. With --plant, planted.csv tells which pair does what, when; its columns are those
of matches.csv.

examples:
  roadproof simulate --out traffic --recordings 2 --seconds 60 --seed 1
  roadproof simulate --out traffic --recordings 60 --jobs 2
  roadproof simulate --out traffic --seconds 120 --plant 1-8
  roadproof witness 1 2 --set ext --out drives; roadproof simulate --out traffic --plant drives
"""


@dataclass(frozen=True)
class Order:
    """One recording to make."""

    traffic: "Traffic"
    seed: int
    number: int
    out: Path
    drives: "tuple[DriveFile, ...]"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("--out", metavar="DIR", type=Path, required=True, help="where the files go")
    parser.add_argument(
        "--recordings", metavar="N", type=whole("--recordings", 1), default=1, help="how many (default: 1)"
    )
    parser.add_argument(
        "--seconds", metavar="S", type=decimal("--seconds"), default=990.0, help="length (default: 990)"
    )
    parser.add_argument("--seed", metavar="K", type=whole("--seed", 0), default=1, help="default: 1")
    parser.add_argument(
        "--lanes", metavar="N", type=whole("--lanes", 1), default=3, help="each way (default: 3)"
    )
    parser.add_argument(
        "--flow",
        metavar="F",
        type=decimal("--flow"),
        default=3350.0,
        help="vehicles an hour and way (default: 3350)",
    )
    parser.add_argument(
        "--truck-share", metavar="P", type=float, default=0.18, help="share of trucks (default: 0.18)"
    )
    parser.add_argument(
        "--section",
        metavar="M",
        type=decimal("--section"),
        default=420.0,
        help="length of the road in m (default: 420)",
    )
    parser.add_argument(
        "--plant",
        metavar="PATH|N,N",
        action="append",
        default=[],
        help="weave in drives: a drive file, a folder of them, or scenarios to find drives for, such as "
        "1-8; may be repeated",
    )
    parser.add_argument(
        "--plant-set", metavar="S", default="base", help="spec set of --plant N,N (default: base)"
    )
    add_working_options(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.files import write_whole
    from roadproof.traffic.planting import PLANTED_COLUMNS, lane_width, rows_of
    from roadproof.traffic.simulate import Traffic

    _check(args)
    drives = tuple(_drives(args.plant, args.plant_set))
    traffic = Traffic(
        seconds=args.seconds,
        lanes=args.lanes,
        flow=args.flow,
        truck_share=args.truck_share,
        section=args.section,
    )
    if args.plant:
        if not drives:
            raise InputError(f"--plant {' '.join(args.plant)}: no drive that can be planted")
        traffic = replace(traffic, lane_width=lane_width(drives))
    orders = [Order(traffic, args.seed, k, args.out, drives) for k in range(1, args.recordings + 1)]
    truths: list[Truth] = []
    left_out: dict[str, None] = {}
    for number, (made, missing) in enumerate(work_in_order(make_one, orders, args.jobs, fresh=True), 1):
        note(f"[{number}/{args.recordings}] recording {number:02d}")
        truths += made
        left_out |= dict.fromkeys(missing)
    if args.plant:
        out = io.StringIO()
        writer = csv.writer(out, lineterminator="\n")
        writer.writerow(PLANTED_COLUMNS)
        writer.writerows(rows_of(truths))
        write_whole(args.out / "planted.csv", out.getvalue().encode())
        for line in left_out:
            _warn(f"not planted: {line}")
        if not truths:
            raise InputError(
                "--plant: no drive could be planted; simulate more seconds, or find other drives"
            )
    planted = f", {len(truths)} drives planted" if args.plant else ""
    print(f"{args.recordings} recordings of {args.seconds:g} s in {args.out}{planted}")
    return ExitCode.AS_EXPECTED


def _check(args: argparse.Namespace) -> None:
    if not 1 <= args.recordings <= 999:
        raise UsageError(f"--recordings {args.recordings}: between 1 and 999 can be made")
    if args.seed < 0:
        raise UsageError(f"--seed {args.seed}: a seed is 0 or more")
    if args.jobs is not None and args.jobs < 1:
        raise UsageError(f"--jobs {args.jobs}: at least one process is needed")


def _drives(texts: Sequence[str], set_name: str) -> "Iterator[DriveFile]":
    """The drives that were asked for and can be planted; of the others it is said why not."""
    for text in texts:
        if _NUMBERS.fullmatch(text):
            yield from _found(text, set_name)
        else:
            yield from _read(Path(text))


def _read(path: Path) -> "Iterator[DriveFile]":
    """The drives of a file or a folder."""
    from roadproof.evidence.drive_file import load_drive
    from roadproof.evidence.judged import judge_file
    from roadproof.spec.library import bundled_library
    from roadproof.traffic.planting import plantable

    files = sorted(path.glob("*.json")) if path.is_dir() else [path]
    if not files:
        raise InputError(f"--plant {path}: the folder holds no drive files (*.json)")
    for name in files:
        file = load_drive(name)
        reason = plantable(file) or judge_file(file, bundled_library()).reason
        if reason:
            _warn(f"not planted: {name}: {reason}")
        else:
            yield file


def _found(text: str, set_name: str) -> "Iterator[DriveFile]":
    """A drive for each scenario of ``text`` (such as 1-3,7), whose danger lasts up to its horizon.

    A recorded trace ends with its last danger, so whatever else the scenario needs has happened then;
    L is the lane of one vehicle's centre at the start, so that vehicle begins in L alone (semantics §7).
    """
    from roadproof.spec import scenarios as s
    from roadproof.spec.bind import default_values
    from roadproof.spec.compose import both
    from roadproof.spec.library import bundled_library
    from roadproof.witness.ask import Search, ask
    from roadproof.witness.question import Setting
    from roadproof.world.models import load_road

    specification = bundled_library().select(set_name)
    for item in text.split(","):
        low, _, high = item.partition("-")
        for number in range(int(low), int(high or low) + 1):
            if not 1 <= number <= 8:
                raise UsageError(f"--plant {text}: recordings show a main road, so scenarios 1 to 8")
            scenario, setting = s.Scenario(number, set_name), Setting(load_road("main-2"))
            claim, vehicles = s.applied(specification, scenario), s.vehicles_of(specification, scenario)
            latest = setting.horizon - default_values(bundled_library())[s.MIN_DANGER]
            alone = s.alone_in_lane(specification, s.lane_owner(specification, scenario))
            lasting = s.danger_at(specification, *s.endangered(vehicles), latest)
            outcome = ask(Search(specification, both(claim, alone, lasting), setting))
            if outcome.drives:
                yield replace(outcome.drives[0].file, scenario=number, formula=claim.text)
            else:
                _warn(f"not planted: scenario {number}, {set_name}: {outcome.verdict}: {outcome.reason}")


def _warn(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


def make_one(order: Order) -> "tuple[list[Truth], list[str]]":
    """Simulate, plant and write one recording; what was planted, and what could not be."""
    from roadproof.spec.library import bundled_library
    from roadproof.traffic.planting import plant_drives
    from roadproof.traffic.synthetic import simulate
    from roadproof.traffic.write_highd import write_highd

    recording = simulate(order.traffic, order.seed, order.number)
    truths: list[Truth] = []
    left_out: list[str] = []
    if order.drives:
        recording, truths, left_out = plant_drives(recording, order.drives, bundled_library())
    write_highd(recording, order.out)
    return truths, left_out
