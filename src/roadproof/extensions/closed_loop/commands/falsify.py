"""``roadproof falsify``: the scenarios in which a vehicle under test fails."""

import argparse

from roadproof.errors import UsageError
from roadproof.extensions.closed_loop.settings import Falsify
from roadproof.frontends.cli.basis import deliver, read_definitions, study_keywords

SUMMARY = "search for the scenarios in which your controller fails"

EXAMPLES = """\
The search needs the package cmaes: pip install '.[closed-loop]' in a checkout.

controllers:
  FILE.py:NAME   a class with step(observation, dt) and perhaps reset(observation), or a function
  FILE.fmu       a co-simulation FMU of FMI 2.0 or 3.0 (needs fmpy)
  COMMAND        a program that answers each line of JSON on its standard input with one

examples:
  roadproof falsify aeb.py:Aeb --among 1-8 --out failures      in which scenarios does it collide?
  roadproof falsify aeb.py:Aeb --among 4 --failures preventable --drivers careful,r157
  roadproof falsify aeb.py:Aeb --require 'G not collision(SV, POV)' --require 'G a_lon(SV) >= -8 m/s^2'
  roadproof falsify './my-controller --fast' --among 1 --simulations 5000 --seed 3
  roadproof check failures                                     judge all drives again
  roadproof falsify aeb.py:Aeb --tests regression --format openscenario,commonroad
  roadproof export failures/fails-scenario_4.json --spec closed_loop --to openscenario

findings:
  FAILS       a judged drive of the scenario on which a requirement is broken while the controller drives
  SHOWN       a judged drive of the scenario; no failure was found
  NOT SHOWN   no simulation shows it
  IMPOSSIBLE  it is proved that no drive shows it, whoever drives SV
  ERROR       the controller gave no answer: the reason says why

POV follows a course that the search varies. SV does what the controller demands, and brakes by 9.81 m/s^2
at most. Driver models are then put in the place of SV, in the same course of POV. Work is counted in
simulations, so the same seed gives the same answer. Python controllers run in processes of this program: run
only code that you trust. Exit codes: 10 if a failure was found, 20 if a scenario was not shown or the
controller gave no answer, else 0, which shows nothing about other drives.
"""
OPTIONS = Falsify


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("controller", metavar="CONTROLLER", help="FILE.py:NAME, FILE.fmu, or a command")


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.closed_loop.falsifying import falsify
    from roadproof.extensions.exchange.exporting import names
    from roadproof.frontends.settings.readers import formats_in

    if args.formats and args.tests is None:
        raise UsageError("--format requires --tests DIR")
    formats_in(args.formats or "csv", names())
    home = read_definitions(args, OPTIONS)
    answer = falsify(args.controller, home, **study_keywords(args, OPTIONS, beside_json=True))
    code = deliver(args, answer, args.pictures)
    if args.tests is not None and answer.view.failures:
        written = answer.write_tests(args.tests, args.formats or ())
        if args.json != "-":
            print(written)
    return code
