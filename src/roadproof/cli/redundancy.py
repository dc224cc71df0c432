"""``roadproof redundancy``: which parts of scenarios could be left out, and what shows the others needed."""

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from roadproof.cli.basis import among, read_basis
from roadproof.cli.numbers import add_effort_options
from roadproof.cli.options import (
    add_json_option,
    add_parameter_option,
    add_specification_options,
    write_json,
)
from roadproof.cli.progress import Counter, warn
from roadproof.cli.working import add_working_options
from roadproof.verdict import ExitCode, Verdict

if TYPE_CHECKING:
    from roadproof.analysis.redundancy import Redundancy

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
    add_effort_options(parser, 20.0, "a drive")
    add_working_options(parser)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write certificates and drives")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.analysis.redundancy import name_of
    from roadproof.report.redundancy import as_text
    from roadproof.study.frame import conduct
    from roadproof.study.shelf import write_index

    begun = time.monotonic()
    study = _study(args)
    found = conduct(study, args.out, args.jobs, Counter(), "scenarios", warn)
    seconds = time.monotonic() - begun
    names = [name_of(number) for number in study.numbers]
    data = {
        "schema": study.question.schema,
        **study.question.said,
        "view": "dense",
        "seconds": round(seconds, 1),
        "verdicts": [verdict for name in names for verdict in found.records[name]["verdicts"]],
    }
    if args.json:
        write_json(data, args.json)
    if args.out is not None:
        write_index(args.out, data)
    findings = {number: found.answers[name_of(number)] for number in study.numbers}
    if args.json != "-":
        print(as_text(findings, seconds))
    doubt = any(x.verdict is Verdict.UNKNOWN for each in findings.values() for x in each)
    return ExitCode.UNKNOWN if doubt else ExitCode.AS_EXPECTED


def _study(args: argparse.Namespace) -> "Redundancy":
    from roadproof.analysis.redundancy import Redundancy
    from roadproof.spec.scenarios import numbers_of

    basis = read_basis(args, [args.set_name])
    numbers = among(args, basis.specification) or numbers_of(basis.specification)
    return Redundancy(basis, numbers, args.whole)
