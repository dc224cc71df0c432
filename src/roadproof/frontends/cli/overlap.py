"""``roadproof overlap``: which scenarios can hold together, with a drive or a proof for every pair."""

import argparse
from pathlib import Path

from roadproof.frontends.cli.basis import asking, evidence_folder, hand_over, read_definitions, restricting
from roadproof.frontends.cli.numbers import add_effort_options, add_sharing_options, add_working_options
from roadproof.frontends.cli.options import (
    add_json_option,
    add_parameter_option,
    add_prevention_options,
    add_specification_options,
    chosen_sets,
    read_seconds,
)
from roadproof.frontends.cli.search_options import add_models_option

SUMMARY = "which scenarios can hold together: for every pair a drive, or a proof that there is none"

_EXAMPLES = """\
examples:
  roadproof overlap --out overlap                     all 276 pairs of base: matrix, CSV, heat map, evidence
  roadproof overlap --among 1,3-8                     two-vehicle scenarios of the main road
  roadproof overlap --lanes any --roles any           each scenario with a lane and roles of its own
  roadproof overlap --start any --among 1-8           one at 0, the other then or later
  roadproof overlap --set base --set ext --among 1-8  scenarios of one set against those of another
  roadproof overlap --among 1-8 --preventable careful only scenarios that begin so

# held together on a judged drive, . proved impossible for all time (certificate and core).
Evidence goes to DIR, or with --json FILE alone to FILE-evidence; `roadproof check DIR` checks it.
A run that was broken off goes on where it was.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser, "base", several=True)
    add_parameter_option(parser)
    for name, what in (
        ("lanes", "both speak of one lane, or each of its own (default: same)"),
        ("roles", "vehicles play the same parts in both, or any (default: same)"),
        ("start", "both start at 0, or one then or later (default: same)"),
    ):
        parser.add_argument(f"--{name}", choices=("same", "any"), default="same", help=what)
    parser.add_argument("--among", metavar="N-M", help="only these scenarios, such as 1,3-8")
    add_prevention_options(parser)
    add_models_option(parser)
    add_effort_options(parser, 60.0, "a drive")
    parser.add_argument(
        "--horizon", metavar="S", help="seconds of driving searched (default: 6; 9 with --start any)"
    )
    add_working_options(parser)
    add_sharing_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write evidence, CSV, JSON and heat map")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no heat map")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.frontends.api.studies import overlap

    folder = evidence_folder(args.out, args.json)
    meeting = {"lanes": args.lanes, "roles": args.roles, "start": args.start}
    horizon = None if args.horizon is None else read_seconds("--horizon", args.horizon)
    home = read_definitions(args, chosen_sets(args))
    return hand_over(
        args,
        overlap(args.among, home, **meeting, horizon=horizon, **restricting(args), **asking(args, folder)),
    )
