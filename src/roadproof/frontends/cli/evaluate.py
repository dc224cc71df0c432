"""``roadproof evaluate``: the highD experiment on recordings."""

import argparse
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.errors import UsageError
from roadproof.frontends.cli.basis import read_definitions
from roadproof.frontends.cli.numbers import read_hands
from roadproof.frontends.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    chosen_sets,
    write_json,
)
from roadproof.frontends.cli.progress import note
from roadproof.frontends.settings.flags import add_flags
from roadproof.frontends.settings.groups import Sharing
from roadproof.frontends.settings.readers import read_seconds
from roadproof.verdict import ExitCode

if TYPE_CHECKING:
    from roadproof.frontends.api.definitions import Definitions
    from roadproof.recordings.evaluate.totals import Totals

SUMMARY = "find disturbances in recordings and match them with scenarios"

SETS = "base,extA,ext"
MOST_NOTES = 12

_EXAMPLES = """\
PATH is a folder of recordings, or the file of one: highD (XX_recordingMeta.csv, XX_tracksMeta.csv,
XX_tracks.csv), exiD (the same, and maps in .osm), CommonRoad 2020a (NAME.xml), or samples (NAME.csv or
NAME.parquet, with NAME_road.toml).
A run that was killed goes on where it was.

examples:
  roadproof evaluate highd/data --out out --jobs 2
  roadproof evaluate highd/data --out out --set base,ext --among 1,3-8 --min-danger 0
  roadproof evaluate highd/data --out out --class Car --class Truck --end clip --keep-going
  roadproof evaluate highd/data --out out --option lateral_rss=signed --check
  roadproof evaluate highd/data --out out --drivers careful,r157 --option cc_gate=before_delay
  roadproof evaluate us101/window.xml --list      lanes and zones, and which of them were inferred
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("path", metavar="PATH", type=Path, help="the recordings")
    parser.add_argument("--out", metavar="DIR", type=Path, help="where results go")
    parser.add_argument(
        "--list", action="store_true", help="only say which lanes and zones there are, and what was inferred"
    )
    add_specification_options(parser, SETS, several=True)
    parser.add_argument("--among", metavar="N-M", help="the scenarios (default: all of two or three cars)")
    parser.add_argument("--min-danger", metavar="S,S", default="0,0.6", help="seconds (default: 0,0.6)")
    parser.add_argument("--min-safe", metavar="S", help="seconds (default: the library's 0.6)")
    parser.add_argument(
        "--class",
        dest="classes",
        metavar="C",
        action="append",
        help="vehicle class that is looked at; may be repeated (default: Car)",
    )
    parser.add_argument(
        "--end",
        choices=("truncated", "clip"),
        default="truncated",
        help="what the end of a trace means (default: truncated)",
    )
    parser.add_argument(
        "--drivers",
        metavar="NAME,…",
        help="whether driver models (careful, r157, eu1426, rss) prevent a collision from where the "
        "manoeuvre of a match begins: of scenarios 1, 2, 4 and the like on other road sectors",
    )
    add_parameter_option(parser)
    add_flags(parser, Sharing)
    parser.add_argument("--keep-going", action="store_true", help="leave out recordings that cannot be used")
    parser.add_argument("--check", action="store_true", help="ask the plain recursive evaluator again (slow)")
    parser.add_argument("--no-detectors", action="store_true", help="leave out those of earlier works")
    parser.add_argument(
        "--no-pictures", action="store_true", help="no figures, for which matplotlib is needed"
    )
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.frontends.api.recordings import evaluate
    from roadproof.frontends.api.roads import roads

    if args.list:
        if args.out or args.json:
            raise UsageError("--list: nothing is evaluated, so leave --out and --json out")
        print("\n".join(map(str, roads(args.path))))
        return ExitCode.AS_EXPECTED
    if not args.out:
        raise UsageError("--out is missing: name the folder where results go, or ask for --list")
    drivers = _drivers(args)
    found = evaluate(
        args.path,
        args.out,
        _definitions(args),
        args.among,
        _seconds("--min-danger", args.min_danger),
        args.classes or ("Car",),
        args.end,
        detectors=not args.no_detectors,
        check=args.check,
        keep_going=args.keep_going,
        pictures=not args.no_pictures,
        jobs=read_hands(args),
        tell=note,
        drivers=drivers,
    )
    if args.json:
        write_json(found.as_data(), args.json)
    if args.json != "-":
        print(found)
    _tell_notes(args.out, found.totals)
    for name, reason in found.failed.items():
        print(f"left out: recording {name}: {reason}", file=sys.stderr)
    note(f"written to {args.out}: " + ", ".join(sorted(x.name for x in args.out.iterdir())))
    return found.exit_code


def _tell_notes(out: Path, totals: "Totals") -> None:
    """What is odd in the recordings, on the screen; all of it is in the results."""
    remarks = [(name, remark) for name, each in totals.notes.items() for remark in each]
    for name, remark in remarks[:MOST_NOTES]:
        print(f"note: recording {name}: {remark}", file=sys.stderr)
    if len(remarks) > MOST_NOTES:
        print(f"… {len(remarks) - MOST_NOTES} more notes in {out / 'results.json'}", file=sys.stderr)


def _drivers(args: argparse.Namespace) -> list[str]:
    """The driver models, whose definitions are then read too. Raises ``UsageError``."""
    from roadproof.drivers.models import DRIVERS

    if args.drivers is None:
        return []
    names = [name.strip() for name in args.drivers.split(",")]
    if not all(names):
        raise UsageError(f"--drivers {args.drivers}: write names separated by commas, such as careful,r157")
    if Path(DRIVERS) not in args.specs:
        args.specs = [Path(DRIVERS), *args.specs]
    return names


def _definitions(args: argparse.Namespace) -> "Definitions":
    from roadproof.library.scenarios import MIN_DANGER, MIN_SAFE

    home = read_definitions(args, chosen_sets(args, SETS))
    if MIN_DANGER in home.values:
        raise UsageError(f"--param {MIN_DANGER}: evaluate takes several values of it; use --min-danger 0,0.6")
    if args.min_safe is None:
        return home
    return replace(home, values={**home.values, MIN_SAFE: read_seconds("--min-safe", args.min_safe, True)})


def _seconds(option: str, text: str) -> list[Fraction]:
    items = [item.strip() for item in text.split(",")]
    if not all(items):
        raise UsageError(f"{option} {text}: write values separated by commas")
    return [read_seconds(option, item, or_zero=True) for item in items]
