"""``roadproof witness``: drives on which scenarios and formulas hold, each judged exactly."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.frontends.cli.basis import in_order, read_definitions, restricting
from roadproof.frontends.cli.numbers import (
    add_sharing_options,
    add_working_options,
    read_effort,
    read_hands,
    whole,
)
from roadproof.frontends.cli.options import add_json_option, add_prevention_options, chosen_sets, write_json
from roadproof.frontends.cli.progress import Counter, clear, tell_stage, warn
from roadproof.frontends.cli.search_options import add_search_options, where_asked
from roadproof.frontends.cli.streams import print_at_once
from roadproof.frontends.cli.what import add_what_arguments, some_or_all
from roadproof.runtime.progress import listening

if TYPE_CHECKING:
    from roadproof.engines.search.ask import Outcome

SUMMARY = "find a drive on which a scenario or a formula holds, and judge it exactly"

_EXAMPLES = """\
examples:
  roadproof witness 4                                 scenario 4, deceleration ahead, on its reference road
  roadproof witness 12 --set ext --out drives         drive file, CSV and picture
  roadproof witness --all --set base --set extA --set ext --out drives
  roadproof witness 'scenario_8(SV,POV,L) and not scenario_6(SV,POV,L)' --lane L=main-2 --road main-3
  roadproof witness 1 --objective severe --count 3
  roadproof witness 1 --unpreventable careful         begins with a cut-in that no careful driver survives
  roadproof witness --spec driver 'scenario_1(SV,POV,L) and unpreventable_cutIn_careful(SV,POV)'

A run with --out that was broken off goes on where it was; what is there for the same search stands.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_what_arguments(parser, "all 24 scenarios, in each --set")
    add_search_options(parser)
    add_prevention_options(parser)
    parser.add_argument(
        "--objective",
        choices=("any", "smooth", "margin", "mild", "severe", "short"),
        default="smooth",
        help="what the drive should be like (default: smooth)",
    )
    parser.add_argument(
        "--count", type=whole("--count", 1), default=1, metavar="K", help="K clearly different drives"
    )
    add_working_options(parser)
    add_sharing_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write drive files, CSV and pictures")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no pictures")
    parser.add_argument("--verbose", action="store_true", help="print sizes and seconds by stage")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.analysis.witnesses import WitnessStudy
    from roadproof.engines.search.question import SearchOptions
    from roadproof.frontends.api.drives import files_written, witness_all
    from roadproof.frontends.api.restricting import restricted
    from roadproof.frontends.api.settings import searches_of, setting
    from roadproof.frontends.report.witness import as_line

    what = some_or_all(args)
    home = restricted(read_definitions(args, chosen_sets(args)), what=what, **restricting(args))
    means = SearchOptions(args.objective, args.engine, args.solver, read_effort(args))
    searches = list(searches_of(home, what, setting(home, **where_asked(args)), means, args.count))
    named = WitnessStudy(tuple(searches)).named
    pictures, plain = not args.no_pictures, args.json != "-"
    written: list[str] = []

    def show(name: str, outcome: "Outcome") -> None:
        files = [] if args.out is None else files_written(name, outcome, pictures)
        written.extend(files)
        clear()
        told = f"\n  written to {args.out}: {', '.join(files)}" if files else ""
        line = as_line(outcome, named[name].specification, args.verbose)
        print_at_once(line + told, args.out is not None)

    each = in_order(tuple(named), show) if plain else None
    with listening(tell_stage if len(named) == 1 else None):
        found = witness_all(searches, args.out, pictures, read_hands(args), Counter(), warn, each)
    if args.out is not None and not written and plain:
        print(f"nothing is written to {args.out}, as there is no drive")
    if args.json:
        write_json(found.as_data(), args.json)
    if plain and len(found.outcomes) > 1:
        print(found.summary)
    if plain:
        print(*found.supposed, sep="\n", end="\n" * bool(found.supposed))
    return found.exit_code
