"""``roadproof export``: drives in the formats of other tools."""

import argparse
from pathlib import Path

from roadproof.frontends.cli.options import add_spec_option
from roadproof.frontends.settings.readers import whole
from roadproof.verdict import ExitCode

SUMMARY = "write drives as OpenSCENARIO, OpenDRIVE, CommonRoad, highD, CSV, or as moving pictures"

_EXAMPLES = """\
formats:
  openscenario   NAME.xosc (XML 1.2: polylines in time, within 1 cm) and NAME.xodr, the road
  opendrive      NAME.xodr (1.7), the road alone
  commonroad     NAME.xml (2020a): lanelets, obstacles, SV's planning problem
  highd          recordings 01, 02, ...: three CSV files each; XX_road.toml where the road has zones
  csv            NAME.csv, a row a time and vehicle; NAME_road.toml
  animation      NAME-moving.svg, which a browser plays: the road, RSS distances of SV, what is true when

Each drive is judged before it is written. One format goes into DIR, several into a folder for each. What is
converted how is in docs/how-to/interop.md.

examples:
  roadproof export drives/scenario-04-base.json --to openscenario --out play
  roadproof export drives/scenario-01-base.json --to animation --out pictures
  roadproof export drives --to commonroad,highd,csv --out exported
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument(
        "drives", metavar="DRIVE", nargs="+", type=Path, help="a drive file, or a folder of drive files"
    )
    parser.add_argument(
        "--to",
        metavar="FORMAT",
        action="append",
        required=True,
        help="openscenario, opendrive, commonroad, highd, csv or animation; may be repeated, or have commas",
    )
    parser.add_argument("--out", metavar="DIR", type=Path, required=True, help="where the files go")
    parser.add_argument(
        "--rate",
        metavar="N",
        type=whole("--rate", 1),
        default=25,
        help="samples a second of commonroad, highd and csv (default: 25)",
    )
    add_spec_option(parser, "a specification file that the drives were made with")


def run(args: argparse.Namespace) -> int:
    from roadproof.frontends.api.exporting import export

    found = export(args.drives, args.to, args.out, args.rate, args.specs)
    print(found)
    return ExitCode.AS_EXPECTED
