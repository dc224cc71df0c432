"""``roadproof order``: which scenarios imply which, with a certificate or a drive for every answer."""

import argparse
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.cli.basis import among, read_basis
from roadproof.cli.numbers import add_effort_options
from roadproof.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    write_json,
    write_text,
)
from roadproof.cli.progress import Counter, warn
from roadproof.cli.working import add_working_options
from roadproof.verdict import ExitCode

if TYPE_CHECKING:
    from roadproof.analysis.order.study import Order, Ordering

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
    add_effort_options(parser, 120.0, "a drive")
    add_working_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates, drives, DOT and SVG")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no picture")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.report.order import as_text
    from roadproof.study.frame import conduct
    from roadproof.study.shelf import write_index

    begun = time.monotonic()
    study = _study(args)
    found = conduct(study, args.out, args.jobs, Counter(), "families of scenarios", warn)
    order, seconds = study.order(found.answers), round(time.monotonic() - begun, 1)
    data = {**study.as_data(order, found.records), "seconds": seconds}
    if args.json:
        write_json(data, args.json)
    if args.out is not None:
        write_index(args.out, data)
        _draw(order, study.basis.set_names, args.out, not args.no_pictures)
    if args.json != "-":
        print(as_text(order, seconds))
    return ExitCode.UNKNOWN if order.doubts else ExitCode.AS_EXPECTED


def _study(args: argparse.Namespace) -> "Ordering":
    from roadproof.analysis.order.kinds import kinds_of
    from roadproof.analysis.order.study import Ordering

    basis = read_basis(args, list(dict.fromkeys(args.set_names or ["base", "extA", "ext"])))
    numbers = among(args, basis.specification)
    return Ordering(basis, kinds_of(basis.specification, basis.set_names, numbers))


def _draw(order: "Order", sets: "Sequence[str]", folder: Path, pictures: bool) -> None:
    from roadproof.files import write_whole
    from roadproof.report.order import as_dot, draw_order

    write_text(folder / "order.dot", as_dot(order))
    if pictures:
        title = f"implications in {', '.join(sets)}; an arrow leads to what is implied"
        for kind, content in draw_order(order, title).items():
            write_whole(folder / f"order.{kind}", content)
