"""``roadproof assurance``: check an argument in Goal Structuring Notation against its evidence."""

import argparse
from pathlib import Path

from roadproof.errors import UsageError
from roadproof.extensions.assurance.settings import Assurance
from roadproof.frontends.cli.options import print_answer
from roadproof.frontends.cli.progress import Counter, clear
from roadproof.frontends.settings.flags import read_keywords
from roadproof.runtime.files import write_atomic
from roadproof.verdict import ExitCode

SUMMARY = "check an assurance case in GSN against its evidence"

EXAMPLES = """\
examples:
  roadproof assurance case.toml                             check every solution, and tell which goals hold
  roadproof assurance case.toml --svg a.svg --page a.html   draw the argument
  roadproof assurance --template catalogue-coverage --evidence coverage,tests,plates --out case.toml

A case is a TOML file with a table for each element of Goal Structuring Notation: goal, strategy, solution,
context, assumption or justification. Each solution names evidence, a file or folder that another command has
written, and the verdicts that it expects there. Limits of the evidence become assumptions.

Exit code 10 or 3 where the top goal is broken, as of `roadproof check`; 20 where it is open.
"""
OPTIONS = Assurance


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("case", metavar="CASE", nargs="?", type=Path, help="the case, a .toml file")


def run(args: argparse.Namespace) -> int:
    if args.template is not None:
        return _write(args)
    if args.case is None or args.evidence or args.out:
        raise UsageError("name a CASE, or --template NAME with --evidence DIR,… and --out FILE")
    from roadproof.extensions.assurance.assuring import assurance

    report = assurance(args.case, **read_keywords(args, Assurance) | {"progress": Counter()})
    clear()
    print_answer(report, args.json)
    return report.exit_code


def _write(args: argparse.Namespace) -> int:
    from roadproof.extensions.assurance.case.template import fill_template

    if args.case is not None or args.out is None or args.out.suffix != ".toml":
        raise UsageError("--template requires --out NAME.toml, and no CASE")
    text = fill_template(args.template, [Path(x) for x in args.evidence], args.out.parent)
    write_atomic(args.out, text.encode())
    print(f"written to {args.out}; `roadproof assurance {args.out}` checks it")
    return ExitCode.AS_EXPECTED
