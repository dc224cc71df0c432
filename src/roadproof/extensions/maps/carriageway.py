"""Lanelets of the lanes of a map's road that are driven in one direction.

Lanes of type driving are on the main road, those of ``RAMPS`` are merge and departure lanes; those of
``NO_LANES`` are left out. In a lane section with a merge lane all lanelets are in the merge zone, in one with
a departure lane in the depart zone, unless the ``userData`` of a lane says which zone it is in
(``opendrive.ZONE``). A lane goes on in another one where a link says so, or where no link is there and both
have the same bounds. Where a width changes along the road it is constant in steps, and the greatest
difference is told.
"""

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from itertools import pairwise

from roadproof.errors import InputError
from roadproof.extensions.maps.opendrive import CubicPiece, MapLane, MapRoad, MapSection, Polynomials
from roadproof.extensions.maps.polynomials import extremes, sum_of_cubics
from roadproof.world.curves import Coefficients
from roadproof.world.road import Attribute, Lanelet, Zone

RAMPS: Mapping[str, Attribute] = {
    "entry": "merge",
    "onRamp": "merge",
    "mwyEntry": "merge",
    "merge": "merge",
    "exit": "departure",
    "offRamp": "departure",
    "mwyExit": "departure",
}
DRIVEN = frozenset("driving bidirectional bus taxi HOV slipLane connectingRamp".split())  # noqa: SIM905
"""Types of lanes of the main road."""
NO_LANES = frozenset(
    "shoulder border stop none restricted parking median biking sidewalk walking curb tram rail roadWorks "  # noqa: SIM905
    "special1 special2 special3 shared".split()
)
_ZONES: Mapping[Attribute, Zone] = {"main": "main", "merge": "merge", "departure": "depart"}
_ROUNDED = 1000
_ROUNDING = Fraction(1, 100)
"""Metres: a width that is so little below 0 is 0."""
_TIP = Fraction(1, 2)
"""Metres: the end of a lane that is narrower may be left out."""
_SHORTEST = Fraction(1, 4)
"""Metres: steps of a width are hardly shorter."""


@dataclass(frozen=True)
class DirectedRoad:
    """A road as it is driven: ``forward`` along s of the map. ``base``: s where it begins on the way (m).

    ``shift``: the line of the way is so far to the left of the road's own (m).
    """

    road: MapRoad
    forward: bool
    base: Fraction = Fraction(0)
    shift: Fraction = Fraction(0)

    @property
    def side(self) -> int:
        """The sign of the ids of the lanes that are driven in this direction."""
        return -1 if self.forward == (self.road.rule == "RHT") else 1

    def s(self, s: Fraction) -> Fraction:
        """Return s along the way, from s of the map."""
        return self.base + (s if self.forward else self.road.length - s)

    def d(self, d: Fraction) -> Fraction:
        """Return d to the left of the way, from d of the map."""
        return (d if self.forward else -d) - self.shift


@dataclass(frozen=True)
class _Strip:
    """A lane on a step of the way; ``after`` and ``before`` are ids of lanes where the road goes on."""

    id: int
    d: tuple[Fraction, Fraction]
    attribute: Attribute
    after: int | None
    before: int | None
    zone: Zone | None


@dataclass(frozen=True)
class _Step:
    """Strips from ``s[0]`` to ``s[1]`` of the way, from left to right; ``section`` says which are of one.

    ``error``: how far (m) an edge is at most from that of the lane.
    """

    s: tuple[Fraction, Fraction]
    strips: tuple[_Strip, ...]
    section: tuple[str, int]
    where: str
    error: Fraction


@dataclass(frozen=True)
class Carriageway:
    """``width_error``: how far (m) an edge of a lanelet is at most from that of the lane."""

    lanelets: tuple[Lanelet, ...]
    width_error: Fraction


def carriageway(ways: tuple[DirectedRoad, ...], step: Fraction) -> Carriageway:
    """The lanelets of roads that follow each other, called main-1, main-2, …, merge-1, … from the right.

    ``step``: how much an edge changes at most on a lanelet (m). Raises ``InputError``.
    """
    steps = [x for way in ways for x in _steps(way, step)]
    lanelets = _without_tips(tuple(_lanelets(steps)))
    return Carriageway(lanelets, max((x.error for x in steps), default=Fraction(0)))


def driven_lanes(section: MapSection, side: int) -> list[MapLane]:
    """Lanes on one side that vehicles drive on, from the reference line outwards."""
    lanes = (section.lanes[x] for x in sorted(section.lanes, key=abs) if x * side > 0)
    return [x for x in lanes if x.type in DRIVEN or x.type in RAMPS]


def _steps(way: DirectedRoad, step: Fraction) -> Iterator[_Step]:
    sections = way.road.sections if way.forward else way.road.sections[::-1]
    for section in sections:
        number = way.road.sections.index(section) + 1
        where = f"{way.road.where}, laneSection {number}"
        lanes = [section.lanes[x] for x in sorted(section.lanes, key=abs) if x * way.side > 0]
        _check_types(lanes, where)
        places = _places_of_change(way.road.offset, lanes, section, step)
        if not way.forward:
            places = places[::-1]
        for begin, end in pairwise(places):
            edges, error = _constant_edges(way, lanes, (min(begin, end), max(begin, end)))
            strips = _strips(way, lanes, edges, where)
            s = way.s(begin), way.s(end)
            yield _Step(s, tuple(strips), (way.road.id, number), where, error)


def _check_types(lanes: list[MapLane], where: str) -> None:
    for x in lanes:
        if x.type not in DRIVEN and x.type not in RAMPS and x.type not in NO_LANES:
            known = ", ".join(("driving", *sorted(DRIVEN - {"driving"}), *RAMPS, *sorted(NO_LANES)))
            raise InputError(f"{where}, lane {x.id}: type={x.type!r} is none of {known}")
        if not x.width and not x.border:
            raise InputError(f"{where}, lane {x.id}: 0 widths; at least one is needed")
    ramps = {RAMPS[x.type] for x in lanes if x.type in RAMPS}
    if len(ramps) > 1:
        raise InputError(f"{where}: merge and departure lanes; a section is in one zone, so divide it in two")


def _edges(offset: Polynomials, lanes: list[MapLane], begin: Fraction) -> list[Coefficients]:
    """The reference edge and the outer edge of each lane, by the distance from ``begin``."""
    pieces = [(1, _piece_at(offset, begin))] if offset else []
    edges = [sum_of_cubics(pieces, begin)]
    for lane in lanes:
        if lane.border:
            pieces = [(1, _piece_at(lane.border, begin))]
        else:
            pieces.append((1 if lane.id > 0 else -1, _piece_at(lane.width, begin)))
        edges.append(sum_of_cubics(pieces, begin))
    return edges


def _piece_at(pieces: Polynomials, s: Fraction) -> CubicPiece:
    """The piece that holds from ``s`` on: the last that has begun, or the first."""
    return next((x for x in reversed(pieces) if x.s <= s), pieces[0])


def _places_of_change(
    offset: Polynomials, lanes: list[MapLane], section: MapSection, step: Fraction
) -> list[Fraction]:
    """Places between which no edge changes by more than ``step``."""
    begins = {x.s for pieces in (offset, *(x.width or x.border for x in lanes)) for x in pieces}
    ends = [section.begin, *sorted(x for x in begins if section.begin < x < section.end), section.end]
    places = [section.begin]
    for begin, end in pairwise(ends):
        places += _divide(_edges(offset, lanes, begin), begin, (Fraction(0), end - begin), step)
    return places


def _divide(
    edges: list[Coefficients], begin: Fraction, part: tuple[Fraction, Fraction], step: Fraction
) -> list[Fraction]:
    low, high = part
    moved = [sum_of_cubics([(1, CubicPiece(Fraction(0), x))], low) for x in edges]
    changes = (extremes(x, high - low) for x in moved)
    if high - low <= _SHORTEST or all(most - least <= step for least, most in changes):
        return [begin + high]
    middle = (low + high) / 2
    return [*_divide(edges, begin, (low, middle), step), *_divide(edges, begin, (middle, high), step)]


def _constant_edges(
    way: DirectedRoad, lanes: list[MapLane], part: tuple[Fraction, Fraction]
) -> tuple[list[Fraction], Fraction]:
    """Return d of the edges from the line outwards, and their largest distance (m) to the lanes' edges."""
    places, error = [], Fraction(0)
    for edge in _edges(way.road.offset, lanes, part[0]):
        least, most = extremes(edge, part[1] - part[0])
        middle = least if least == most else Fraction(round((least + most) / 2 * _ROUNDED), _ROUNDED)
        error = max(error, middle - least, most - middle)
        places.append(middle)
    return places, error


def _strips(way: DirectedRoad, lanes: list[MapLane], edges: list[Fraction], where: str) -> list[_Strip]:
    """The lanes that are driven on, from left to right."""
    strips = []
    for lane, (inner, outer) in zip(lanes, pairwise(edges), strict=True):
        width = (outer - inner) * way.side
        if width < -_ROUNDING:
            raise InputError(f"{where}, lane {lane.id}: its width is below 0, {float(width):.2f} m")
        if lane.type not in NO_LANES and width > 0:
            ends = lane.successor, lane.predecessor
            after, before = ends if way.forward else ends[::-1]
            right, left = sorted((way.d(inner), way.d(outer)))
            attribute = RAMPS.get(lane.type, "main")
            strips.append(_Strip(lane.id, (right, left), attribute, after, before, lane.zone))
    return sorted(strips, key=lambda x: x.d, reverse=True)


def _lanelets(steps: list[_Step]) -> Iterator[Lanelet]:
    names: list[dict[int, str]] = [{} for _ in steps]
    counts = Counter[Attribute]()
    for k, step in enumerate(steps):
        before = steps[k - 1] if k else None
        zone: Zone = next((_ZONES[x.attribute] for x in step.strips if x.attribute != "main"), "main")
        for strip in reversed(step.strips):
            ends = [x for x in before.strips if _continues(before, x, step, strip)] if before else []
            ends.sort(key=partial(_doubled_distance, strip))
            known = [name for name in (names[k - 1][x.id] for x in ends) if name not in names[k].values()]
            if not known:
                counts[strip.attribute] += 1
                known = [f"{strip.attribute}-{counts[strip.attribute]}"]
            name = known[0]  # of lanes that join here the one beside which the others end
            names[k][strip.id] = name
            letter = chr(ord("a") + k) if k < 26 else f".{k + 1}"  # of the step
            yield Lanelet(f"{name}{letter}", name, strip.zone or zone, strip.attribute, step.s, strip.d)


def _doubled_distance(one: _Strip, other: _Strip) -> Fraction:
    """Twice the distance (m) between the middles of two strips."""
    return abs(one.d[0] + one.d[1] - other.d[0] - other.d[1])


def _without_tips(lanelets: tuple[Lanelet, ...]) -> tuple[Lanelet, ...]:
    """The lanelets without narrow ends of a lane that do not meet the rest of it across the road.

    Where a lane narrows to nothing while its middle moves, its steps lie beside each other.
    """
    dropped = set[str]()
    for lane in dict.fromkeys(x.lane for x in lanelets):
        chain = [x for x in lanelets if x.lane == lane]
        apart = [k for k, (a, b) in enumerate(pairwise(chain), 1) if a.d[0] >= b.d[1] or b.d[0] >= a.d[1]]
        if not apart:
            continue
        begins, ends = chain[: apart[-1]], chain[apart[0] :]
        for part in (begins, ends):
            if all(x.d[1] - x.d[0] < _TIP for x in part):
                dropped |= {x.id for x in part}
                break
    return tuple(x for x in lanelets if x.id not in dropped)


def _continues(one: _Step, before: _Strip, other: _Step, strip: _Strip) -> bool:
    if before.attribute != strip.attribute:
        return False
    if one.section == other.section:
        return before.id == strip.id
    if before.after is None and (strip.before is None or one.section[0] == other.section[0]):
        return before.d == strip.d
    return strip.id == before.after or (one.section[0] != other.section[0] and before.id == strip.before)
