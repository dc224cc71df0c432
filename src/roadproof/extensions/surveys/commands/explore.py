"""``roadproof explore``: the values for which a scenario has a drive, and extremes of a measure."""

import argparse

from roadproof.errors import UsageError
from roadproof.extensions.surveys.settings import Explore
from roadproof.frontends.cli.basis import deliver, read_definitions, study_keywords
from roadproof.frontends.cli.options import add_what_arguments, some_or_all

SUMMARY = "find the parameter values for which a scenario has a drive"

EXAMPLES = """\
examples:
  roadproof explore 4 --vary minSafe=0:6                     a parameter: 11 values, then the boundary
  roadproof explore 4 --vary minDanger=0:3 --vary rho=0:2    two: a map
  roadproof explore 4 --vary POV.a_lon.min=-6:0              a limit of a vehicle; vehicle.… is that of all
  roadproof explore 1 --least 'v_lon(SV) - v_lon(POV)'       the least value of a measure at the start
  roadproof explore 4 --greatest 's(POV) - s(SV)' --when 'danger(SV,POV)'    at a moment of danger
  roadproof explore --all --vary minDanger=0:30 --out explored
  roadproof explore 1 --unpreventable careful --vary cc_delay=0.3:1.5    a value of the driver model
  roadproof explore --spec driver 'unpreventable_cutIn_careful(SV,POV)' --vary cc_delay=0.3:1.5

Limits are v_lon, v_lat, a_lon and a_lat, each .min and .max. If durations change, dt is the coarsest step
that divides them, and --dt its upper bound. Each drive is judged at all other values, so most values need no
search. A value without a drive costs up to three times the --effort. The answer claims nothing about values
between those examined. An extreme is a bracket: a drive on one side, and on the other the reason why no
better one is known.

A formula about one instant that no engine reads (a driver model) is proved impossible at single values.

# drive judged at this value, . proved impossible, - none within the limits printed, ? not decided.
Exit code 20 where anything is not decided.
A run with --out that was broken off goes on where it was, formula by formula.
"""
OPTIONS = Explore


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_what_arguments(parser, "all scenarios of each --set")


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.surveys.exploring import Explorations, explore_question

    named, ranges = some_or_all(args), [_varied(text) for text in args.vary or ()]
    vary = {name: (low, high) for name, low, high in ranges} or None
    given = Explore.of(study_keywords(args, Explore, beside_json=True) | {"vary": vary})
    home = read_definitions(args, Explore)
    what = home.each(named)
    home = given.modified(home, what=what)
    for name, _, _ in ranges:
        if name in home.values:
            raise UsageError(f"{name} is given by --param and varied by --vary: leave one out")
    question = explore_question(home, what, given, ranges)
    return deliver(args, Explorations.decide(question, given), args.pictures)


def _varied(text: str) -> tuple[str, str, str]:
    """Return the parts of ``NAME=LOW:HIGH``. Raises ``UsageError``."""
    name, equals, ends = (part.strip() for part in text.partition("="))
    low, colon, high = (part.strip() for part in ends.partition(":"))
    if not (name and equals and low and colon and high):
        raise UsageError(f"--vary {text}: write --vary NAME=LOW:HIGH, such as minDanger=0:3")
    return name, low, high
