"""``roadproof classify``: classes of scenarios that exclude each other and together cover the same."""

import argparse
from pathlib import Path

from roadproof.errors import UsageError
from roadproof.frontends.cli.basis import asking, evidence_folder, hand_over, read_definitions, restricting
from roadproof.frontends.cli.numbers import add_effort_options, add_sharing_options, add_working_options
from roadproof.frontends.cli.options import (
    add_json_option,
    add_parameter_option,
    add_prevention_options,
    add_specification_options,
)
from roadproof.frontends.cli.search_options import add_models_option

SUMMARY = "classes of scenarios, proved to exclude each other and to cover the same, with their shares"

_EXAMPLES = """\
examples:
  roadproof classify --out classes                    scenarios 1-24 of base: what happens, and where
  roadproof classify --among 1-8 --out classes        those of the main road
  roadproof classify --set ext --on highd/data        shares on recordings of yours
  roadproof prove --spec classes/classes.spec --set classes --claims classes/claims.txt
  roadproof witness 'class_4_8_main(SV,POV,L)' --spec classes/classes.spec --set classes --road main-2
  roadproof classify --among 1-8 --unpreventable careful

A class is a choice of scenarios that hold together on one trace, for the same vehicles and lane, while the
others do not. Choices that are proved impossible are left out. Classes of SV and POV and of SV, POV1, POV2
are kept apart. Evidence goes to DIR, or with --json FILE alone to FILE-evidence; `roadproof check DIR`
checks it. A run that was broken off goes on where it was. Exit code 20 where a claim is not proved or a
class has no drive.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    add_specification_options(parser)
    add_parameter_option(parser)
    parser.add_argument("--among", metavar="N-M", help="only these scenarios, such as 1-8")
    parser.add_argument("--on", type=Path, metavar="DIR", help="recordings (default: simulated for this)")
    parser.add_argument("--no-shares", action="store_true", help="no recordings, so no shares")
    add_prevention_options(parser)
    add_models_option(parser)
    add_effort_options(parser, 60.0, "a drive or a proof")
    add_working_options(parser)
    add_sharing_options(parser)
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="write classes.spec, claims, evidence, picture"
    )
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no picture")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.frontends.api.classifying import classify

    if args.on is not None and args.no_shares:
        raise UsageError("--on and --no-shares: shares are counted on recordings; leave out one of the two")
    folder = evidence_folder(args.out, args.json)
    home = read_definitions(args, [args.set_name])
    return hand_over(
        args,
        classify(args.among, home, args.on, not args.no_shares, **restricting(args), **asking(args, folder)),
    )
