"""``roadproof catalogue``: what a catalogue of tests shows, what nobody tests, and drives for that."""

import argparse

from roadproof.errors import UsageError
from roadproof.frontends.cli.basis import hand_over, read_definitions, study_keywords
from roadproof.frontends.cli.progress import Counter
from roadproof.frontends.settings.studies import Catalogue

SUMMARY = "list which scenarios a catalogue of tests covers, and complete it"

EXAMPLES = """\
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
OPTIONS = Catalogue


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("paths", metavar="DIR|FILE", nargs="+", help="folders of tests, or tests")


def run(args: argparse.Namespace) -> int:
    from roadproof.frontends.api.cataloguing import catalogue
    from roadproof.frontends.api.exporting import formats_in

    for name in ("objective", "spread", "formats"):
        if getattr(args, name) and args.complete is None:
            raise UsageError(f"--{name.removesuffix('s')} requires --complete DIR")
    formats_in(args.formats or "csv")
    home = read_definitions(args, OPTIONS)
    given = study_keywords(args, OPTIONS, beside_json=True)
    found = catalogue(*args.paths, using=home, **given)
    code = hand_over(args, found, args.pictures)
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
