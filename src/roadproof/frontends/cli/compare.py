"""``roadproof compare``: two scenarios or formulas, and which implies which."""

import argparse
import time
from typing import TYPE_CHECKING

from roadproof.errors import UsageError
from roadproof.frontends.cli.basis import read_definitions
from roadproof.frontends.cli.options import print_answer
from roadproof.frontends.cli.progress import clear, note, tell_road, tell_stage
from roadproof.frontends.settings.flags import read_flag, read_keywords
from roadproof.frontends.settings.questions import CompareSettings
from roadproof.runtime.progress import listening

if TYPE_CHECKING:
    from roadproof.questions.compare import Direction

SUMMARY = "compare two formulas: equivalent, stronger, weaker, incomparable"

EXAMPLES = """\
examples:
  roadproof compare 'scenario_3(SV,POV,L)' 'scenario_4(POV,SV,L)'
  roadproof compare 4 4 --set base --set ext          the same scenario in two spec sets
  roadproof compare 1 4 --out differences             drives that tell the two apart
"""
OPTIONS = CompareSettings


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("first", metavar="F1", help="a scenario's number, or a formula")
    parser.add_argument("second", metavar="F2", help="another; in the second --set where two are given")


def run(args: argparse.Namespace) -> int:
    """Run the command; return its exit code."""
    from roadproof.frontends.api.comparing import compare

    sets = read_flag(args, CompareSettings, "sets")
    if len(sets) > 2:
        raise UsageError(f"--set is given {len(sets)} times: two formulas have at most two spec sets")
    home = read_definitions(args, CompareSettings)
    start = time.monotonic()

    def show(name: str, direction: "Direction") -> None:
        note(f"{name}: {direction.verdict} (after {time.monotonic() - start:.1f} s)")

    with listening(tell_stage):
        comparison = compare(args.first, args.second, home, each=show, **read_keywords(args, CompareSettings))
    clear()
    print_answer(comparison, args.json)
    tell_road(comparison.road)
    return comparison.exit_code
