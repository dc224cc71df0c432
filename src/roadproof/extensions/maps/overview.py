"""The overview of a map: the lanes, zones and bends of each road and direction that can be selected."""

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

from roadproof.errors import InputError
from roadproof.extensions.maps.carriageway import DRIVEN, RAMPS
from roadproof.extensions.maps.opendrive import MapRoad, RoadMap
from roadproof.extensions.maps.selection import LANELETS, SelectedStretch, Selection, stretch_of
from roadproof.world.length_error import LengthError, length_error
from roadproof.world.reference_line import ReferenceLine
from roadproof.world.road import Lanelet, Zone

_NO_ERROR = LengthError(Fraction(0), Fraction(0))


@dataclass(frozen=True)
class ZoneSpan:
    """A span (m) of the road where lanelets are in a zone."""

    zone: Zone
    begin: Fraction
    end: Fraction


@dataclass(frozen=True)
class MapStretch:
    """A road in one direction, as ``--road`` takes it.

    ``lanes``: the least and the greatest number side by side. ``radius`` of the sharpest bend (m), None where
    the road is straight. ``refused``: why it cannot be used; then only ``select``, ``name`` and ``length``
    are known. ``unread``: kinds of parts of the map that were not read and may have an effect.
    """

    select: str
    name: str
    length: Fraction
    direction: str = ""
    lanes: tuple[int, int] = (0, 0)
    zones: tuple[ZoneSpan, ...] = ()
    radius: Fraction | None = None
    width_error: Fraction = Fraction(0)
    length_error: LengthError = _NO_ERROR
    lanelets: tuple[Lanelet, ...] = ()
    line: ReferenceLine | None = None
    refused: str = ""
    unread: tuple[str, ...] = ()

    @property
    def untyped_ramps(self) -> bool:
        """Return whether lanes that begin or end are main road as none has a type for ramps, in OpenDRIVE."""
        typed = any(x.attribute != "main" for x in self.lanelets)
        return Path(self.select.partition("#")[0]).suffix not in LANELETS and not typed


def stretches_of(path: Path, roads: RoadMap) -> tuple[MapStretch, ...]:
    """Every road of a map in every direction that lanes are driven in, then those that cannot be read."""
    stretches = []
    for road in roads.roads:
        for side in ("right", "left"):
            numbers = {x for section in road.sections for x in section.lanes}
            if not any(x > 0 if side == "left" else x < 0 for x in numbers):
                continue
            stretch = _stretch(path, roads, road, side)
            if stretch is not None:
                stretches.append(stretch)
    for name, reason in roads.refused.items():
        stretches.append(MapStretch(f"{path}#road={name}", "", Fraction(0), refused=reason))
    return tuple(stretches)


def describe(select: str, name: str, direction: str, stretch: SelectedStretch) -> MapStretch:
    """Return a description of a selected stretch."""
    lanelets, line = stretch.lanelets, stretch.line
    places = sorted({x for lanelet in lanelets for x in lanelet.s if x is not None})
    counts = [sum(_covers(x, a, b) for x in lanelets) for a, b in pairwise(places)]
    bends = (x for x in line.bends() if x.end > places[0] and x.begin < places[-1])
    sharpest = max((x.greatest for x in bends), default=Fraction(0))
    return MapStretch(
        select,
        name,
        places[-1] - places[0],
        direction,
        (min(counts), max(counts)),
        _zones(lanelets),
        1 / sharpest if sharpest else None,
        stretch.width_error,
        length_error(line, lanelets),
        lanelets,
        line,
        unread=stretch.unread,
    )


def _covers(lanelet: Lanelet, begin: Fraction, end: Fraction) -> bool:
    low, high = lanelet.s
    return low is not None and high is not None and low <= begin and end <= high


def _stretch(path: Path, roads: RoadMap, road: MapRoad, side: str) -> MapStretch | None:
    """A road in one direction; None where nothing is driven on in it."""
    select = f"{path}#road={road.id},lanes={side}"
    lanes = (x for section in road.sections for x in section.lanes.values() if (x.id > 0) == (side == "left"))
    if not any(x.type in DRIVEN or x.type in RAMPS for x in lanes):
        return None
    forward = (side == "right") == (road.rule == "RHT")
    try:
        selected = stretch_of(path, roads, Selection((road.id,), side == "left", (None, None)))
    except InputError as error:
        return MapStretch(select, road.name, road.length, refused=str(error))
    direction = "along s" if forward else "against s"
    return describe(select, road.name, direction, selected)


def _zones(lanelets: tuple[Lanelet, ...]) -> tuple[ZoneSpan, ...]:
    """Merge and depart zones, with those that touch as one."""
    zones: list[ZoneSpan] = []
    spans = sorted({(x.s[0], x.s[1], x.zone) for x in lanelets if x.zone != "main"}, key=str)
    for begin, end, zone in sorted(spans, key=lambda x: x[0] or Fraction(0)):
        if begin is None or end is None:
            continue
        if zones and zones[-1].zone == zone and begin <= zones[-1].end:
            zones[-1] = ZoneSpan(zone, zones[-1].begin, max(end, zones[-1].end))
        else:
            zones.append(ZoneSpan(zone, begin, end))
    return tuple(zones)
