"""``roadproof alone``: which scenarios can hold while no other one does."""

import argparse

from roadproof.extensions.surveys.settings import Ask
from roadproof.frontends.cli.basis import deliver, read_definitions, study_keywords

SUMMARY = "which scenarios can hold while no other one does: a drive for each, or a proof"

EXAMPLES = """\
examples:
  roadproof alone --among 1,3-8 --out alone     two-vehicle scenarios of the main road, with evidence
"""
OPTIONS = Ask


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.surveys.surveying import ask
    from roadproof_example.question import Alone

    home = read_definitions(args, OPTIONS)
    return deliver(args, ask(Alone, args.among, home, **study_keywords(args, OPTIONS)))
