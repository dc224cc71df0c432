"""``roadproof resimulate``: a vehicle under test in place of SV in recordings and drives."""

import argparse
from pathlib import Path

from roadproof.extensions.closed_loop.settings import Resimulate
from roadproof.frontends.cli.basis import deliver, read_definitions, study_keywords

SUMMARY = "put your controller in place of SV in recordings and tests"

EXAMPLES = """\
PATH is a folder of recordings, or the file of one, as in 'roadproof evaluate --help'; or a drive file, or a
folder of these, such as regression tests. CONTROLLER is as in 'roadproof falsify --help'.

examples:
  roadproof resimulate aeb.py:Aeb highd/data --among 1-8 --out drives
  roadproof resimulate aeb.py:Aeb regression                   the failures that falsify --tests wrote
  roadproof resimulate aeb.py:Aeb highd/data --require 'G a_lon(SV) >= -6 m/s^2' --drivers careful
  roadproof check drives                                       judge all drives again

findings:
  FAILS   a judged drive on which a requirement is broken while the controller drives
  KEPT    a judged drive on which all requirements are kept
  ERROR   the controller gave no drive: the reason says why

Wherever a scenario occurs, SV begins as it did, and the controller drives it for --seconds, or as long as all
vehicles of the scenario are recorded. Its route across the road is the former one unless the controller
demands another. All others move as before and do not react to it, so a vehicle behind may run into it. In
recordings, vehicles within 100 m along the road are seen; requirements are about POVs of the scenario.
Exit codes: 10 if a failure was found, 20 if the controller gave no drive, else 0, which shows nothing about
other drives.
"""
OPTIONS = Resimulate


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("controller", metavar="CONTROLLER", help="FILE.py:NAME, FILE.fmu, or a command")
    parser.add_argument("recordings", metavar="PATH", type=Path, help="recordings or drive files")


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.closed_loop.resimulation.resimulating import resimulate

    home = read_definitions(args, OPTIONS)
    keywords = study_keywords(args, OPTIONS, beside_json=True)
    return deliver(args, resimulate(args.controller, args.recordings, home, **keywords), args.pictures)
