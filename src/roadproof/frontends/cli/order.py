"""``roadproof order``: which scenarios imply which, with a certificate or a drive for every answer."""

import argparse

from roadproof.frontends.cli.basis import deliver, read_definitions, study_keywords
from roadproof.frontends.cli.progress import note
from roadproof.frontends.settings.relations import Order

SUMMARY = "decide which scenarios imply which"

EXAMPLES = """\
examples:
  roadproof order --out order                    all scenarios of base, extA and ext; DOT, SVG, evidence
  roadproof order --set base --set ext --among 1-8

a -> b: whenever a holds, so does b, with the same roles and the same L. Scenario 2 implies one with two
vehicles if it does so for one of its POVs. `roadproof check DIR` checks the evidence again.
A run with --out that was broken off goes on where it was.
"""
OPTIONS = Order


def run(args: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from roadproof.frontends.api.ordering import order

    definitions, keywords = read_definitions(args, OPTIONS), study_keywords(args, OPTIONS)
    if args.among is None:  # it takes minutes, known answers too, whose drives are judged again
        note("expanding all scenarios into families, then looking up known answers of each family")
    orders = order(args.among, definitions, **keywords)
    return deliver(args, orders, args.pictures)
