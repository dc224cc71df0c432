"""``roadproof redundancy``: which parts of scenarios could be left out, and what shows the others needed."""

import argparse
from pathlib import Path

from roadproof.frontends.cli.basis import asking, hand_over, read_definitions
from roadproof.frontends.cli.numbers import add_effort_options, add_sharing_options, add_working_options
from roadproof.frontends.cli.options import add_json_option, add_parameter_option, add_specification_options
from roadproof.frontends.cli.search_options import add_models_option

SUMMARY = "which parts of scenarios are redundant, by proof; drives that show the others needed"

_EXAMPLES = """\
examples:
  roadproof redundancy --among 3                one scenario
  roadproof redundancy --set ext --out red      all of ext, evidence in files
  roadproof redundancy --among 3 --whole        also inside rssViolation, aheadOf, atLane

Every occurrence of a part is replaced by true and by false: redundant where the scenario stays
equivalent (proved for all time), needed where a judged drive, or else a judged trace over points in time,
tells the two apart. Redundant for motion: equivalent on all traces on which a vehicle that leaves L has a
first moment outside it, as every motion without jumps does.
A run with --out that was broken off goes on where it was.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser)
    add_parameter_option(parser)
    parser.add_argument("--among", metavar="N-M", help="only these scenarios, such as 1,3-8")
    parser.add_argument("--whole", action="store_true", help="also the parts of simple predicates")
    add_models_option(parser)
    add_effort_options(parser, 20.0, "a drive")
    add_working_options(parser)
    add_sharing_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates and drives")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.frontends.api.studies import redundancy

    home = read_definitions(args, [args.set_name])
    return hand_over(args, redundancy(args.among, home, args.whole, **asking(args, args.out)))
