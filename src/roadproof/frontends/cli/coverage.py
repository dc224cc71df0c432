"""``roadproof coverage``: which disturbances a spec set misses, or a proof that it misses none."""

import argparse
from pathlib import Path

from roadproof.frontends.cli.basis import asking, hand_over, read_definitions, restricting
from roadproof.frontends.cli.numbers import add_effort_options, add_sharing_options, add_working_options
from roadproof.frontends.cli.options import (
    add_json_option,
    add_parameter_option,
    add_prevention_options,
    add_specification_options,
)
from roadproof.frontends.cli.progress import Counter, tell
from roadproof.frontends.cli.search_options import add_models_option

SUMMARY = "which disturbances a spec set misses, by drives in classes; or a proof that it misses none"

_EXAMPLES = """\
examples:
  roadproof coverage --set complete --out complete    proved to have no gap between two vehicles
  roadproof coverage --set complete --needed          and which of its definitions it needs for that
  roadproof coverage --set ext --out gaps             the classes of gaps, each with a drive or a proof
  roadproof coverage --set base --jobs 2              what base misses, and which wider set catches it
  roadproof coverage --set ext --on recordings        and how often each class occurs in traffic
  roadproof coverage --set ext --unpreventable careful   drives no careful driver survives, in no scenario

A gap: initSafe at the start, danger later, and no two-vehicle scenario for any lane and either role. Its
classes say why: scenario 4, deceleration ahead, would hold but for its component
behaviourPOV_4, or for one condition of it.
Of each class: a judged drive, or a proof that it is empty, or how far it was looked. Behind a drive's
number: the first wider set that catches it, and the smallest choice of its definitions that does.
Evidence goes to DIR, `roadproof check DIR` checks it; a run that was broken off goes on where it was.
Exit code 0 where coverage is proved, 10 where there are gaps, 20 where neither was found.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser)
    add_parameter_option(parser)
    parser.add_argument(
        "--wider", metavar="S", help="the set that catches all (default: complete, where it extends the set)"
    )
    parser.add_argument(
        "--road",
        dest="roads",
        metavar="R",
        action="append",
        help="where to look for drives; may be repeated (default: main-2, then main-3)",
    )
    add_prevention_options(parser, "drives")
    add_models_option(parser)
    add_effort_options(parser, 10.0, "a search, half of it for one more that another set catches")
    parser.add_argument(
        "--needed", action="store_true", help="of a set that covers: a drive for each definition it needs"
    )
    parser.add_argument(
        "--on", type=Path, metavar="DIR", help="count the classes in recordings, as roadproof simulate makes"
    )
    add_working_options(parser)
    add_sharing_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates, drives and pictures")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no pictures")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.frontends.api.covering import ROADS, coverage

    home = read_definitions(args, [args.set_name])
    more = asking(args, args.out)
    found = coverage(
        home, args.wider, args.roads or ROADS, args.needed, args.on, **restricting(args), **more, tell=tell
    )
    if args.out is not None and not args.no_pictures:
        found.draw_beside(args.jobs, Counter())
    return hand_over(args, found)
