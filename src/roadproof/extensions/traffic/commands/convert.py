"""``roadproof convert``: recordings of any format, kept as Parquet."""

import argparse
from pathlib import Path

from roadproof.extensions.traffic.options import Convert
from roadproof.frontends.cli.progress import Counter
from roadproof.verdict import ExitCode

SUMMARY = "convert recordings to Parquet, checked, for quicker reading"

EXAMPLES = """\
PATH is a folder of recordings in one format, or the file of one. Each is read with all checks, written as
NAME.recording.json and NAME.samples.parquet, read again and compared. Everything that reads recordings reads
DIR with the same answers. Another version of roadproof asks for converting again.

examples:
  roadproof convert highd/data --out highd-parquet --jobs 2
  roadproof evaluate highd-parquet --out results
  roadproof monitor 4 highd-parquet/01.recording.json:12,15
"""
OPTIONS = Convert


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("path", metavar="PATH", type=Path, help="the recordings")


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.traffic.converting import convert

    print(convert(args.path, args.out, args.jobs, Counter(), args.strict, args.road))
    return ExitCode.AS_EXPECTED
