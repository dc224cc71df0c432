"""``roadproof road``: the roads of a map, and what can be selected of them."""

import argparse
from collections.abc import Iterator
from typing import TYPE_CHECKING

from roadproof.extensions.maps.options import RoadOptions
from roadproof.frontends.cli.options import write_json
from roadproof.frontends.cli.progress import warn
from roadproof.verdict import ExitCode

if TYPE_CHECKING:
    from roadproof.extensions.maps.overview import MapStretch

SUMMARY = "list and draw the roads of a map"

EXAMPLES = """\
MAP is a file in OpenDRIVE (.xodr), CommonRoad (.xml) or Lanelet2 (.osm). After # stands what is selected of
it, as --road of other commands takes it: from=M and to=M along s; step=M, how much the edge of a lane changes
at most on one lanelet (default: 0.25).
OpenDRIVE: road=ID, or route=ID+ID for roads that follow each other; lanes=left or right, where both sides are
driven on.
CommonRoad, Lanelet2: road=K for the main way of carriageway K; way=ID for the way with lanelet ID. The road
are the lanelets of the way and those beside it. Ring roads and traffic that crosses are not usable: cut a
part.

examples:
  roadproof road town.xodr                                       all roads, in both directions
  roadproof road 'town.xodr#road=12,from=300,to=900' --out a.svg the lanes of a stretch, and a picture
  roadproof witness cut-in --road 'town.xodr#road=12,lanes=left'
  roadproof witness cut-in --road 'USA_US101-3_3_T-1.xml#road=1,to=150'
"""
OPTIONS = RoadOptions


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("map", metavar="MAP", help="the file, and # with a selection")


def run(args: argparse.Namespace) -> int:
    from roadproof.extensions.maps.roads import as_data, omission_notes, stretches

    listed = stretches(args.map, args.out, args.strict)
    for note in omission_notes(args.map, listed):
        warn(f"note: {note}")
    if args.json:
        write_json(as_data(args.map, listed), args.json)
    if args.json != "-":
        print("\n".join(line for stretch in listed for line in _lines(stretch, "#" in args.map)))
        if args.out:
            print(f"drawn to {args.out}")
    return ExitCode.AS_EXPECTED


def _lines(stretch: "MapStretch", in_full: bool) -> Iterator[str]:
    """A stretch in a few lines; ``in_full``: with its lanelets."""
    yield stretch.select
    named = f" ({stretch.name})" if stretch.name else ""
    if stretch.refused:
        yield f"  not usable{named}: {stretch.refused}"
        return
    low, high = stretch.lanes
    count = f"{high} lane{'s' if high > 1 else ''}" if low == high else f"{low} to {high} lanes"
    driven = f", driven {stretch.direction}" if stretch.direction else ""
    yield f"  {float(stretch.length):g} m{named}, {count}{driven}"
    for zone in stretch.zones:
        yield f"  {zone.zone} zone from {float(zone.begin):g} m to {float(zone.end):g} m"
    if low != high and stretch.untyped_ramps:
        yield "  no lane is of a type for ramps (entry, exit, onRamp, offRamp): all are main road"
    if stretch.width_error:
        yield f"  edges of lanelets are within {float(stretch.width_error):.3f} m of the lanes'"
    if stretch.radius is None:
        yield "  straight"
    else:
        yield f"  sharpest bend: radius {float(stretch.radius):.4g} m"
        yield f"  lengths in lanes differ from those in s by up to {stretch.length_error}"
    for x in stretch.lanelets if in_full else ():
        ends, edges = (f"{float(a or 0):g} to {float(b or 0):g}" for a, b in (x.s, x.d))
        yield f"    {x.id:<14} {x.zone:<7} s {ends:<16} d {edges}"
