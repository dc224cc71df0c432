"""``roadproof compile``: formulas as monitors in C, and as problems for other solvers."""

import argparse

from roadproof.extensions.exchange.settings import Compile
from roadproof.frontends.cli.basis import read_definitions
from roadproof.frontends.cli.progress import tell_road
from roadproof.frontends.settings.flags import read_keywords
from roadproof.verdict import ExitCode

SUMMARY = "write monitors in C, or the problem of a search for another solver"

EXAMPLES = """\
FORMULA is a formula or a scenario's number, or a list such as 1,4-8.

--to c: for each the files have a state of fixed size and three functions: reset; step, which takes a
sample; finish, for the end of the trace. Verdicts are FALSE, UNKNOWN or TRUE, as those of roadproof monitor.
If a formula looks ahead for a bounded time, they are about each sample, that time later; otherwise about
the first sample, as soon as it is decided.

--to mps, lp, smt2: the problem that a search for drives solves, a file for each lane that L can be.
NAME.rows.csv says what each row encodes. Solve it elsewhere, and give the solution to witness --solution.
With --drives outer an infeasible problem shows that there is no drive within the limits.

examples:
  roadproof compile 4 --to mps --lane L=right --out problem
  roadproof compile 6 --to smt2 --drives outer --horizon 3 --out problem
  roadproof compile 4 --to c --out monitors
  roadproof compile 1 4 'danger(SV,POV)' --to c --dt 0.02 --name watch --out monitors
  roadproof compile 4 --to c --road main-3 --lane L=main-1 --out monitors
"""
OPTIONS = Compile


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("formulas", metavar="FORMULA", nargs="+", help="a formula, or a scenario's number")


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.exchange.compiling import compile

    home = read_definitions(args, Compile)
    keywords = read_keywords(args, Compile)
    compiled = compile(args.formulas, args.to, args.out, home, **keywords)
    print(compiled)
    tell_road(compiled.road)
    return ExitCode.AS_EXPECTED
