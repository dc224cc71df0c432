"""``roadproof export``: drives in the formats of other tools."""

import argparse
from pathlib import Path

from roadproof.extensions.exchange.settings import Export
from roadproof.frontends.settings.flags import read_keywords
from roadproof.verdict import ExitCode

SUMMARY = "write drives for other tools, or as moving pictures"

EXAMPLES = """\
formats:
  openscenario   NAME.xosc (XML 1.2: polylines in time, within 1 cm) and NAME.xodr, the road
  opendrive      NAME.xodr (1.7), the road alone
  commonroad     NAME.xml (2020a): lanelets, obstacles, SV's planning problem
  highd          recordings 01, 02, ...: three CSV files each; XX_road.toml where the road has zones
  csv            NAME.csv, a row a time and vehicle; NAME_road.toml
  animation      NAME-moving.svg, which a browser plays: the road, RSS distances of SV, what is true when
  gif, mp4       NAME.gif, NAME.mp4: the same as frames; mp4 needs the program ffmpeg

Each drive is judged before it is written. One format goes into DIR, several into a folder for each. What is
converted how is in docs/how-to/interop.md.

examples:
  roadproof export drives/scenario-04-base.json --to openscenario --out play
  roadproof export drives/scenario-01-base.json --to animation --out pictures
  roadproof export drives --to commonroad,highd,csv --out exported
"""
OPTIONS = Export


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "drives", metavar="DRIVE", nargs="+", type=Path, help="a drive file, or a folder of drive files"
    )


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.exchange.exporting import export

    print(export(args.drives, args.to, args.out, **read_keywords(args, Export)))
    return ExitCode.AS_EXPECTED
