"""``roadproof catalogue``: the targets that tests show, missing targets, and drives for these."""

import argparse

from roadproof.errors import UsageError
from roadproof.extensions.catalogue.settings import Catalogue
from roadproof.frontends.cli.basis import deliver, read_definitions, study_keywords
from roadproof.frontends.cli.progress import Counter
from roadproof.frontends.settings.flags import read_flag

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
  roadproof catalogue tests                            which scenarios are tested, and which are not
  roadproof catalogue tests --complete more            drives for the others, as tests in the folder more
  roadproof catalogue tests more --out report          page.html, matrix.csv, junit.xml, evidence
  roadproof catalogue tests --roles any --lanes any --start any
  roadproof catalogue tests --gaps                     and gaps: danger that no scenario covers, in classes
  roadproof catalogue tests --complete more --spread 3 --format openscenario,csv
  roadproof catalogue tests --complete more --objective severe
  roadproof catalogue tests --unpreventable careful    tests whose danger no careful driver could prevent
  roadproof catalogue tests --drivers careful,r157     judge tests by these driver models only
  roadproof check report                               judge all tests again; stale ones are named
  roadproof catalogue tests --set base,ext             base, and figures of how much of ext is tested

A test that cannot be read is a fault of this test; all others are judged.
A drive file fixes roles, lane and start. Samples fix roles if vehicles are called SV and POV; all lanes and
all instants are tried. The class of gap that a test shows is always named; --gaps asks for a test of each
class that is not proved empty, which takes as long as roadproof coverage.
Exit codes: 0 if all is tested and each test shows what it claims, 10 if not, 20 if something is undecided;
with --gaps also if a class of gaps may be empty, with --explore if the range of a class is undecided.
"""
OPTIONS = Catalogue


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("paths", metavar="DIR|FILE", nargs="+", help="folders of tests, or tests")


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.catalogue.cataloguing import catalogue
    from roadproof.extensions.exchange.exporting import names
    from roadproof.frontends.settings.readers import formats_in

    for name in ("objective", "spread", "formats"):
        if getattr(args, name) and args.complete is None:
            raise UsageError(f"--{name.removesuffix('s')} requires --complete DIR")
    formats_in(args.formats or "csv", names())
    home = read_definitions(args, OPTIONS)
    given = study_keywords(args, OPTIONS, beside_json=True)
    answer = catalogue(*args.paths, using=home, **given)
    code = deliver(args, answer, args.pictures)
    if args.complete is not None:
        completed = answer.complete(
            args.complete,
            args.objective or "smooth",
            args.spread or 1,
            args.formats or (),
            args.jobs,
            Counter(),
            specs=read_flag(args, OPTIONS, "specs"),
        )
        if args.json != "-":
            print(completed)
    return code
