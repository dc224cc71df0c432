"""``roadproof evaluate``: the highD experiment on recordings."""

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.errors import UsageError
from roadproof.extensions.drivers.options import add_drivers
from roadproof.extensions.traffic.settings import Evaluate
from roadproof.frontends.cli.basis import read_definitions
from roadproof.frontends.cli.options import print_answer, read_executor, write_build_results
from roadproof.frontends.cli.progress import note
from roadproof.frontends.settings.flags import read_keywords
from roadproof.verdict import ExitCode

if TYPE_CHECKING:
    from roadproof.extensions.traffic.evaluate.totals import Totals
    from roadproof.frontends.api.definitions import Definitions

SUMMARY = "find disturbances in recordings and match them with scenarios"

MOST_NOTES = 12

EXAMPLES = """\
PATH is a folder of recordings, or the file of one: highD (XX_recordingMeta.csv, XX_tracksMeta.csv,
XX_tracks.csv), exiD (the same, and maps in .osm), inD, rounD and uniD (the same, and --road), OSI (NAME.osi,
and --road), NGSIM (NAME.csv), CommonRoad 2020a (NAME.xml), or samples (NAME.csv or NAME.parquet, with
NAME_road.toml).
A run that was killed goes on where it was.

examples:
  roadproof evaluate highd/data --out out --jobs 2
  roadproof evaluate highd/data --out out --set base,ext --among 1,3-8 --min-danger 0
  roadproof evaluate highd/data --out out --class Car --class Truck --end clip --keep-going
  roadproof evaluate highd/data --out out --option lateral_rss=signed --check
  roadproof evaluate highd/data --out out --drivers careful,r157 --option cc_gate=before_delay
  roadproof evaluate us101/window.xml --list      lanes and zones, and which of them were inferred
"""
OPTIONS = Evaluate


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("path", metavar="PATH", type=Path, help="the recordings")


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.traffic.evaluating import evaluate, roads

    if args.list_roads:
        if args.out or args.json:
            raise UsageError("--list evaluates nothing: omit --out and --json")
        print("\n".join(map(str, roads(args.path, args.road))))
        return ExitCode.AS_EXPECTED
    if not args.out:
        raise UsageError("--out is missing: name the folder for the results, or use --list")
    keywords = read_keywords(args, Evaluate) | {"jobs": read_executor(args), "tell": note}
    evaluation = evaluate(args.path, args.out, _definitions(args), **keywords)
    write_build_results(args, evaluation)
    print_answer(evaluation, args.json)
    _tell_notes(args.out, evaluation.totals)
    for name, reason in evaluation.failed.items():
        print(f"skipped recording {name}: {reason}", file=sys.stderr)
    note(f"written to {args.out}: " + ", ".join(sorted(x.name for x in args.out.iterdir())))
    return evaluation.exit_code


def _tell_notes(out: Path, totals: "Totals") -> None:
    """Print the first notes on the recordings, omissions first; ``results.json`` has all notes."""
    from roadproof.world.not_read import LEFT_OUT

    remarks = [(name, remark) for name, each in totals.notes.items() for remark in each]
    remarks.sort(key=lambda remark: not remark[1].startswith(LEFT_OUT))
    for name, remark in remarks[:MOST_NOTES]:
        print(f"note: recording {name}: {remark}", file=sys.stderr)
    if len(remarks) > MOST_NOTES:
        print(f"… {len(remarks) - MOST_NOTES} more notes in {out / 'results.json'}", file=sys.stderr)


def _definitions(args: argparse.Namespace) -> "Definitions":
    from roadproof.library.scenarios import MIN_DANGER, MIN_SAFE

    if args.drivers:
        add_drivers(args)
    definitions = read_definitions(args, Evaluate)
    if MIN_DANGER in definitions.values:
        raise UsageError(f"--param {MIN_DANGER}: evaluate takes several values of it; use --min-danger 0,0.6")
    if args.min_safe is None:
        return definitions
    return replace(definitions, values={**definitions.values, MIN_SAFE: args.min_safe})
