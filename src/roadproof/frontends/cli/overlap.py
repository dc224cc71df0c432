"""``roadproof overlap``: which scenarios can hold together, with a drive or a proof for every pair."""

import argparse

from roadproof.frontends.cli.basis import deliver, read_definitions, study_keywords
from roadproof.frontends.settings.relations import Overlap

SUMMARY = "decide for each pair of scenarios whether both can hold at once"

EXAMPLES = """\
examples:
  roadproof overlap --out overlap                     all 276 pairs of base: matrix, CSV, heat map, evidence
  roadproof overlap --among 1,3-8                     two-vehicle scenarios of the main road
  roadproof overlap --lanes any --roles any           each scenario with a lane and roles of its own
  roadproof overlap --start any --among 1-8           one at 0, the other then or later
  roadproof overlap --set base --set ext --among 1-8  scenarios of one set against those of another
  roadproof overlap --among 1-8 --preventable careful only scenarios that begin so

# held together on a judged drive, . proved impossible for all time (certificate and core).
Evidence goes to DIR, or with --json FILE alone to FILE-evidence; `roadproof check DIR` checks it.
A run that was broken off goes on where it was.
"""
OPTIONS = Overlap


def run(args: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from roadproof.frontends.api.relations import overlap

    home = read_definitions(args, OPTIONS)
    overlaps = overlap(args.among, home, **study_keywords(args, OPTIONS, beside_json=True))
    return deliver(args, overlaps, args.pictures)
