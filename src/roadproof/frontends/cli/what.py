"""What is searched for: some scenarios and formulas, or all scenarios."""

import argparse

from roadproof.errors import UsageError
from roadproof.frontends.settings.flags import section


def add_what_arguments(parser: argparse.ArgumentParser, every: str) -> None:
    """Scenarios and formulas by position, and ``--all``, of which ``every`` is the help."""
    question = section(parser, "question")
    question.add_argument(
        "what",
        metavar="N|FORMULA",
        nargs="*",
        help="scenarios (4, 1,3-8 or a name) or formulas",
    )
    question.add_argument("--all", action="store_true", help=every)


def some_or_all(args: argparse.Namespace) -> list[str]:
    """What is named; nothing with --all. Raises ``UsageError``."""
    if args.all == bool(args.what):
        raise UsageError("name scenarios or formulas, or use --all, but not both")
    return list(args.what)
