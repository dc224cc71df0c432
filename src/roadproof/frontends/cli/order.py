"""``roadproof order``: which scenarios imply which, with a certificate or a drive for every answer."""

import argparse
from pathlib import Path

from roadproof.frontends.cli.basis import asking, hand_over, read_definitions
from roadproof.frontends.cli.numbers import add_effort_options, add_sharing_options, add_working_options
from roadproof.frontends.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    chosen_sets,
)
from roadproof.frontends.cli.search_options import add_models_option

SUMMARY = "which scenarios imply which: proofs for the implications, drives against the others"

_EXAMPLES = """\
examples:
  roadproof order --out order                    all scenarios of base, extA and ext; DOT, SVG, evidence
  roadproof order --set base --set ext --among 1-8

a -> b: whenever a holds, so does b, with the same roles and the same L. Scenario 2 implies one with two
vehicles if it does so for one of its POVs. `roadproof check DIR` checks the evidence again.
A run with --out that was broken off goes on where it was.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser, "base, extA, ext", several=True)
    add_parameter_option(parser)
    parser.add_argument("--among", metavar="N-M", help="only these scenarios, such as 1,3-8")
    add_models_option(parser)
    add_effort_options(parser, 120.0, "a drive")
    add_working_options(parser)
    add_sharing_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates, drives, DOT and SVG")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no picture")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.frontends.api.studies import order

    sets = list(dict.fromkeys(chosen_sets(args, "base,extA,ext")))
    return hand_over(args, order(args.among, read_definitions(args, sets), **asking(args, args.out)))
