"""Traffic in the plane on a stretch of a map that was selected, which other traffic crosses or leaves.

Of each vehicle the longest time in a row counts in which its box is on a lanelet of the stretch and turned by
at most 45 degrees from it. Those without a second of it are left out, and those that stand all the time.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np

from roadproof.errors import InputError
from roadproof.extensions.maps.lines import even_line
from roadproof.extensions.maps.network import MeasuredLane, Network
from roadproof.extensions.maps.projections import UtmPoint
from roadproof.extensions.maps.selection import SelectedStretch, Selection, is_map, read_selection
from roadproof.extensions.maps.stretch import select
from roadproof.extensions.maps.topology import MeasuredLanelet
from roadproof.extensions.traffic.formats.clock import samples_in
from roadproof.extensions.traffic.formats.line_coordinates import project
from roadproof.extensions.traffic.formats.measured_roads import (
    MOST_TURNED,
    MeasuredTraffic,
    boxes_of,
    overlap,
    place_traffic,
    triangles_of,
)
from roadproof.extensions.traffic.formats.recording import Bools, Floats, Integers, Recording, offsets
from roadproof.extensions.traffic.formats.reliable import first_names, left_out_note
from roadproof.reasons import ReasonKind
from roadproof.world.lanelet_rules import shared_boundaries
from roadproof.world.not_read import not_read_note
from roadproof.world.reference_line import ReferenceLine
from roadproof.world.road import Lanelet

_SPACING = 2.0
"""Metres between the points of a bound, and of the line that s is measured on."""
_STANDS = 1.0
"""m: a vehicle that is never farther than that from its first place stands all the time."""
_LINE = "reference line"


def chart_of(road: str | None, path: Path, near: Sequence[Path] = ()) -> tuple[Path, Selection]:
    """The map of a road and what is selected of it, for the recording in ``path``; maps that are ``near`` it.

    Raises ``InputError`` where no map is named, ``UsageError`` for a road that is not well said.
    """
    if road is None or not is_map(road):
        shown = f"; maps near are {', '.join(map(str, near))}" if near else ""
        advice = "give a road of a map, as --road MAP#way=ID; roadproof road MAP lists them"
        raise InputError(f"{path}: the files name no lanes: {advice}{shown}")
    return read_selection(road)


def place_on_road(
    traffic: MeasuredTraffic, road: str, origin: UtmPoint | None = None, strict: bool = False
) -> tuple[Recording, Integers]:
    """The recording of the vehicles on a road of a map, and the rows of ``traffic`` that are in it.

    ``origin``: the point in UTM from which places of ``traffic`` count, for maps in degrees. ``strict``:
    nothing of the map may be left out. Raises ``InputError``, which begins with the name of ``traffic`` where
    no vehicle is on the road.
    """
    path, selection = read_selection(road)
    return place_on(traffic, network_on(select(path, selection, origin), road, strict))


def network_on(stretch: SelectedStretch, called: str, strict: bool = False) -> Network:
    """The lanelets of a stretch in the plane; s is measured on its reference line.

    Raises ``InputError`` where it is ``strict`` and parts of the map were not read.
    """
    lanelets = {x.id: _measured(x, stretch.line) for x in stretch.lanelets}
    line = _points(stretch.line, (stretch.line.begin, stretch.line.end), Fraction(0))
    lanelets[_LINE] = MeasuredLanelet(_LINE, line, line, None, (), ())
    lanes = []
    for name in dict.fromkeys(x.lane for x in stretch.lanelets):
        ours = sorted((x for x in stretch.lanelets if x.lane == name), key=lambda x: x.s[0] or Fraction(0))
        lanes.append(MeasuredLane(name, tuple(x.id for x in ours), 1))
    width_note = (
        f"road {called}: edges of its lanes are up to {float(stretch.width_error):.2g} m from the map's"
    )
    return Network(
        lanelets,
        {x.id: x.attribute for x in stretch.lanelets},
        {x.id: x.zone for x in stretch.lanelets},
        tuple(lanes),
        shared_boundaries(stretch.lanelets),
        ((_LINE,),),
        (width_note, *not_read_note(Path(called.partition("#")[0]), stretch.unread, strict)),
    )


def _measured(lanelet: Lanelet, line: ReferenceLine) -> MeasuredLanelet:
    begin, end = lanelet.s
    assert begin is not None
    assert end is not None
    right, left = (_points(line, (begin, end), d) for d in lanelet.d)
    return MeasuredLanelet(lanelet.id, left, right, lanelet.attribute, (), ())


def _points(line: ReferenceLine, span: tuple[Fraction, Fraction], d: Fraction) -> Floats:
    """Points at ``d`` beside a line, evenly along it."""
    begin, end = map(float, span)
    places = np.linspace(begin, end, 1 + math.ceil((end - begin) / _SPACING)).tolist()
    return np.array([line.place(s, float(d)) for s in places])


def place_on(traffic: MeasuredTraffic, network: Network) -> tuple[Recording, Integers]:
    """The recording of the vehicles on a stretch, and the rows of ``traffic`` that are in it.

    Raises ``InputError``, which begins with the name of ``traffic``, where none is on it.
    """
    moving, notes = _moving(traffic)
    there = _along(traffic, network) & np.repeat(moving, np.diff(traffic.start))
    chosen_rows = _longest_runs(there, traffic.start, samples_in(traffic.rate))
    counts = np.add.reduceat(chosen_rows.astype(np.int64), traffic.start[:-1])
    if not counts.any():
        called = network.notes[0].partition(":")[0]
        raise InputError(f"{traffic.name}: no vehicle is on {called} for a second; do map and positions fit?")
    off = traffic.vehicle_id[moving & (counts == 0)].tolist()
    shown = traffic.vehicle_id[(counts > 0) & (counts < np.diff(traffic.start))].tolist()
    notes += [left_out_note(off, len(moving), ReasonKind.NOT_ALONG())] * bool(off)
    if shown:
        notes.append(
            f"{len(shown)} vehicles ({first_names(shown)}) count while they are on the road, along it"
        )
    on_road = replace(_cut(traffic, chosen_rows, counts), notes=(*traffic.notes, *notes))
    return place_traffic(on_road, network), np.flatnonzero(chosen_rows)


def _along(traffic: MeasuredTraffic, network: Network) -> Bools:
    """Return for each sample whether its box is on a lanelet, turned at most 45 degrees from the line."""
    counts = np.diff(traffic.start)
    length, width = (np.repeat(x, counts) for x in (traffic.length, traffic.width))
    boxes = boxes_of(traffic.centre, traffic.heading, length, width)
    along = np.zeros(len(boxes), np.bool_)
    for lane in network.lanes:
        for lanelet in (network.lanelets[x] for x in lane.lanelets):
            left = np.flatnonzero(~along)
            along[left] = overlap(boxes[left], triangles_of(lanelet.left, lanelet.right))
    rows = np.flatnonzero(along)
    way = project(even_line(network.lanelets[_LINE].centre), traffic.centre[rows]).heading
    turned = np.abs(np.remainder(traffic.heading[rows] - way + math.pi, math.tau) - math.pi)
    along[rows] = turned <= MOST_TURNED
    return along


def _moving(traffic: MeasuredTraffic) -> tuple[Bools, list[str]]:
    """Return which vehicles move, with a note on the others."""
    first = np.repeat(traffic.centre[traffic.start[:-1]], np.diff(traffic.start), axis=0)
    away = np.hypot(*(traffic.centre - first).T)
    moving = np.maximum.reduceat(away, traffic.start[:-1]) > _STANDS
    standing = traffic.vehicle_id[~moving].tolist()
    return moving, [left_out_note(standing, len(moving), ReasonKind.STANDING())] if standing else []


def _longest_runs(there: Bools, start: Integers, least: int) -> Bools:
    """Return for each vehicle its longest run of true rows, if it has at least ``least`` rows."""
    longest = np.zeros(len(there), np.bool_)
    for begin, end in pairwise(start.tolist()):
        edges = np.diff(there[begin:end].astype(np.int8), prepend=0, append=0)
        first, last = np.flatnonzero(edges > 0), np.flatnonzero(edges < 0)
        if len(first):
            k = int(np.argmax(last - first))
            if last[k] - first[k] >= least:
                longest[begin + first[k] : begin + last[k]] = True
    return longest


def _cut(traffic: MeasuredTraffic, chosen_rows: Bools, counts: Integers) -> MeasuredTraffic:
    """The rows that are kept, of which each vehicle has so many in a row."""
    some = counts > 0
    begins = np.flatnonzero(chosen_rows)[offsets(counts[some])[:-1]]
    return replace(
        traffic,
        vehicle_id=traffic.vehicle_id[some],
        kind=traffic.kind[some],
        label=traffic.label[some] if len(traffic.label) else traffic.label,
        length=traffic.length[some],
        width=traffic.width[some],
        first_frame=traffic.first_frame[some] + begins - traffic.start[:-1][some],
        start=offsets(counts[some]),
        centre=traffic.centre[chosen_rows],
        heading=traffic.heading[chosen_rows],
        velocity=traffic.velocity[chosen_rows],
        acceleration=traffic.acceleration[chosen_rows],
    )
