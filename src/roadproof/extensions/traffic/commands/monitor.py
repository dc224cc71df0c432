"""``roadproof monitor``: where a formula holds on one trace."""

import argparse
import sys
from pathlib import Path

from roadproof.errors import UsageError
from roadproof.extensions.drivers.options import add_drivers
from roadproof.extensions.traffic.settings import MonitorSettings
from roadproof.frontends.cli.basis import read_definitions
from roadproof.frontends.cli.options import print_answer
from roadproof.frontends.cli.progress import tell_bends
from roadproof.frontends.settings.flags import read_keywords

SUMMARY = "evaluate a formula on one trace: a drive, samples, a recording"

EXAMPLES = """\
FORMULA is a formula or a scenario's number. TRACE is one of
  drive.json               a drive file of roadproof witness; judged exactly, in dense time, unless
                           --view recorded asks for samples of it; what the file says of parameters,
                           options and set holds unless the command line says otherwise
  samples.csv, .parquet    a row a time and vehicle, with the header
                           time,vehicle,s,d,v_lon,v_lat,a_lon,a_lat,length,width
                           (SI units, s along the road, d to the left, front-left corner of the box)
  highd/01_tracks.csv:12,15     vehicles of a recording: SV, POV (or SV, POV1, POV2); so for files of
                           every format that roadproof evaluate takes, such as us101.xml:503,504

exit codes: 0 true, 10 false, 20 undecided (it depends on what comes after the trace)

examples:
  roadproof monitor 4 drives/scenario-04-base.json
  roadproof monitor 'initSafe(SV,POV)' samples.csv --road main-3
  roadproof monitor 1 ego-and-target.xosc --roles SV=Ego,POV=Target --view dense
  roadproof monitor 1 highd/01_tracks.csv:12,15 --set ext --picture pair.png
  roadproof monitor 1 highd/01_tracks.csv:12,15 --drivers careful,r157
  roadproof monitor 'rssViolation(SV,POV)' drives/scenario-04-base.json --robust-signal
  roadproof monitor 'F danger(SV,POV)' highd/01_tracks.csv:12,15 --frames 100-400 --end clip
"""
OPTIONS = MonitorSettings


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("formula", metavar="FORMULA", help="a formula, or a scenario's number")
    parser.add_argument("trace", metavar="TRACE", help="a drive, samples, or vehicles of a recording")


def run(args: argparse.Namespace) -> int:
    from roadproof.evidence.drive_file import load_drive
    from roadproof.extensions.traffic.monitoring import monitor, specifications_of

    if args.picture is not None and args.picture.suffix not in (".png", ".svg"):
        raise UsageError(f"--picture {args.picture}: name a file that ends in .png or .svg")
    file = load_drive(Path(args.trace)) if args.trace.endswith(".json") else None
    if file is not None:
        args.sets = args.sets or (file.set_name,)
        args.specs = args.specs or specifications_of(file, Path(args.trace).parent)
        args.readings = [*file.options.items(), *(args.readings or ())]
    if args.drivers:
        add_drivers(args)
    definitions = read_definitions(args, MonitorSettings)
    answer = monitor(args.formula, args.trace, definitions, **read_keywords(args, MonitorSettings))
    for note in answer.notes:
        print(f"note: {note}", file=sys.stderr)
    print_answer(answer, args.json)
    if args.picture is not None:
        answer.plot().save(args.picture)
    tell_bends(answer.road)
    return answer.exit_code
