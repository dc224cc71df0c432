"""``roadproof catalogue``: what a catalogue of tests shows, what nobody tests, and drives for that."""

import argparse
from pathlib import Path

from roadproof.errors import UsageError
from roadproof.frontends.cli.basis import asking, evidence_folder, hand_over, read_definitions, restricting
from roadproof.frontends.cli.numbers import add_effort_options
from roadproof.frontends.cli.options import (
    add_json_option,
    add_parameter_option,
    add_prevention_options,
    add_specification_options,
    chosen_sets,
)
from roadproof.frontends.cli.progress import Counter
from roadproof.frontends.settings.flags import add_flags
from roadproof.frontends.settings.groups import Models, Workers
from roadproof.frontends.settings.readers import whole

SUMMARY = "list which scenarios a catalogue of tests covers, and complete it"

_EXAMPLES = """\
tests:
  drive files (.json), samples (.csv, .parquet), scenarios of CommonRoad (.xml) and OpenSCENARIO (.xosc),
  vehicles of a recording (01_tracks.csv:12,15), and what a catalogue.toml names, in a folder or by
  themselves. A catalogue.toml has
    [[test]]
    id = "CUT-IN-7"
    title = "cut-in at high speed"
    file = "cut-in-7.json"               a concrete test; or an abstract one, a formula:
    formula = "scenario_4(SV,POV,L)"
    at_start = { "v_lon(SV)" = "20 m/s .. 30 m/s" }       ranges at the start, and at all times
    always = { "a_lon(POV)" = "-4 m/s^2 .. 0 m/s^2" }
    road = "main-2"
    vehicles = { POV = "truck" }
    claims = [4, "class_4_main"]         what it is meant to show
    roles = { SV = "ego", POV = "car1" } with a file: vehicles by role; without it ego, hero, host and the
                                         like are SV, and of two vehicles the other one is POV

examples:
  roadproof catalogue tests                            what is tested, and what is not
  roadproof catalogue tests --complete more            drives for what is not, as tests in the folder more
  roadproof catalogue tests more --out report          matrix.csv, junit.xml, a picture, evidence
  roadproof catalogue tests --roles any --lanes any --start any
  roadproof catalogue tests --gaps                     and gaps: danger that no scenario covers, in classes
  roadproof catalogue tests --complete more --spread 3 --format openscenario,csv
  roadproof catalogue tests --complete more --objective severe
  roadproof catalogue tests --unpreventable careful    which tests begin with what nobody could prevent
  roadproof catalogue tests --drivers careful,r157     what becomes of tests under these driver models only
  roadproof check report                               judge all tests again; stale ones are named
  roadproof catalogue tests --set base,ext             base, and figures of how much of ext is tested

A test that cannot be read is a fault of this test; all others are judged.
A drive file fixes roles, lane and start; samples fix roles where vehicles are called SV and POV, and are
looked at in all lanes from all instants on. Which class of gap a test shows is told in any case; --gaps asks
for a test of each class that is not proved empty, which takes as long as roadproof coverage.
Exit code 0 where all is tested and each test is what it claims, 10 where not, 20 where something is in doubt,
with --gaps also whether a class of gaps is empty, with --explore how far drives of a class go.
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = _EXAMPLES
    parser.add_argument("paths", metavar="DIR|FILE", nargs="+", help="folders of tests, or tests")
    add_specification_options(parser, several=True)
    add_parameter_option(parser)
    parser.add_argument("--among", metavar="N-M", help="only these scenarios, such as 1-8")
    parser.add_argument("--no-classes", action="store_true", help="scenarios only")
    parser.add_argument(
        "--gaps", action="store_true", help="each class of gaps is to be tested too, or is proved empty"
    )
    parser.add_argument(
        "--explore",
        action="store_true",
        help="also how drives of each class can begin, and what of it nobody tests",
    )
    for name, what in (("roles", "choices of roles"), ("lanes", "lanes"), ("start", "instants")):
        text = f"look at all {what}, not only at what a test fixes"
        parser.add_argument(f"--{name}", choices=("fixed", "any"), default="fixed", help=text)
    parser.add_argument(
        "--near",
        type=float,
        default=0.5,
        metavar="X",
        help="tests that show the same and begin within X m and m/s say the same (default: 0.5)",
    )
    parser.add_argument("--complete", type=Path, metavar="DIR", help="write drives for what nobody tests")
    parser.add_argument(
        "--objective",
        choices=("any", "smooth", "margin", "mild", "severe", "short"),
        help="with --complete: what the drives should be like (default: smooth)",
    )
    parser.add_argument(
        "--spread",
        type=whole("--spread", 1),
        metavar="K",
        help="with --complete: until each class has K tests, drives that begin far from those it has",
    )
    parser.add_argument(
        "--format",
        dest="formats",
        metavar="FORMAT",
        action="append",
        help="with --complete: write the drives as openscenario, commonroad, highd, csv or opendrive too",
    )
    add_prevention_options(parser)
    parser.add_argument(
        "--drivers",
        metavar="MODELS",
        help="driver models that are asked what becomes of tests: careful,r157, or none (default: all)",
    )
    add_flags(parser, Models)
    add_effort_options(parser, 60.0, "a drive")
    add_flags(parser, Workers)
    parser.add_argument("--out", type=Path, metavar="DIR", help="write matrix, JUnit, picture, evidence")
    parser.add_argument("--no-pictures", action="store_true", help="with --out: no picture")
    add_json_option(parser)


def run(args: argparse.Namespace) -> int:
    from roadproof.frontends.api.cataloguing import catalogue
    from roadproof.frontends.api.exporting import formats_in

    for name in ("objective", "spread", "formats"):
        if getattr(args, name) and args.complete is None:
            raise UsageError(f"--{name.removesuffix('s')} is for drives that are made: add --complete DIR")
    formats_in(args.formats or "csv")
    home = read_definitions(args, chosen_sets(args))
    found = catalogue(
        *args.paths,
        among=args.among,
        using=home,
        classes=not args.no_classes,
        gaps=args.gaps,
        explore=args.explore,
        roles=args.roles,
        lanes=args.lanes,
        start=args.start,
        near=args.near,
        drivers=_drivers(args.drivers),
        **restricting(args),
        **asking(args, evidence_folder(args.out, args.json)),
    )
    code = hand_over(args, found)
    if args.complete is not None:
        completed = found.complete(
            args.complete,
            args.objective or "smooth",
            args.spread or 1,
            args.formats or (),
            args.jobs,
            Counter(),
            args.specs,
        )
        if args.json != "-":
            print(completed)
    return code


def _drivers(text: str | None) -> list[str] | None:
    """The driver models; None for all. Raises ``UsageError``."""
    if text is None or text == "none":
        return None if text is None else []
    names = [name.strip() for name in text.split(",")]
    if not all(names):
        raise UsageError(f"--drivers {text}: write names separated by commas, such as careful,r157, or none")
    return names
