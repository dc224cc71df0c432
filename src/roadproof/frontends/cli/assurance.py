"""``roadproof assurance``: an argument in Goal Structuring Notation, with its evidence checked again."""

import argparse
from pathlib import Path

from roadproof.frontends.cli.options import print_answer
from roadproof.frontends.cli.progress import Counter, clear
from roadproof.frontends.settings.flags import read_keywords
from roadproof.frontends.settings.questions import Assurance

SUMMARY = "check an assurance case in GSN against its evidence"

EXAMPLES = """\
examples:
  roadproof assurance case.toml                    check every solution, and tell which goals hold

A case is a TOML file with a table for each element of Goal Structuring Notation: goal, strategy, solution,
context, assumption or justification. Each solution names evidence, a file or folder that another command has
written, and the verdicts that it expects there. Limits of the evidence become assumptions.

Exit code 10 or 3 where the top goal is broken, as of `roadproof check`; 20 where it is open.
"""
OPTIONS = Assurance


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("case", metavar="CASE", type=Path, help="the case, a .toml file")


def run(args: argparse.Namespace) -> int:
    from roadproof.frontends.api.assuring import assurance

    found = assurance(args.case, **read_keywords(args, Assurance) | {"progress": Counter()})
    clear()
    print_answer(found, args.json)
    return found.exit_code
