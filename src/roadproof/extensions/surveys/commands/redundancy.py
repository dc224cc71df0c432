"""``roadproof redundancy``: the parts of scenarios that could be left out, and evidence for the others."""

import argparse

from roadproof.extensions.surveys.settings import Redundancy
from roadproof.frontends.cli.basis import deliver, read_definitions, study_keywords

SUMMARY = "find the parts of scenarios that can be left out"

EXAMPLES = """\
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
OPTIONS = Redundancy


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.surveys.redundancies import redundancy

    home = read_definitions(args, OPTIONS)
    return deliver(args, redundancy(args.among, home, **study_keywords(args, OPTIONS)))
