"""Lets ``roadproof check`` accept an assurance case."""

import argparse

from roadproof.errors import UsageError
from roadproof.frontends.cli.options import print_answer
from roadproof.frontends.cli.progress import Counter
from roadproof.frontends.settings.flags import read_keywords
from roadproof.frontends.settings.questions import Check


def check_case(args: argparse.Namespace) -> int:
    """Check one assurance case with a solver and return the exit code. Raises ``UsageError``,
    ``InputError``.
    """
    from roadproof.extensions.assurance.assuring import assurance

    if len(args.paths) > 1 or args.kernel or args.junit or args.sarif:
        remedy = "name one CASE, and omit --kernel, --junit and --sarif"
        raise UsageError(f"an assurance case is checked alone and with a solver: {remedy}")
    keywords = {name: x for name, x in read_keywords(args, Check).items() if name != "kernel"}
    checked = assurance(args.paths[0], **keywords | {"progress": Counter()})
    print_answer(checked, args.json)
    return checked.exit_code
