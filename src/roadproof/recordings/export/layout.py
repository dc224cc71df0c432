"""A straight road as formats with lane sections have it: cut to a finite length, and cut across.

A section reaches from one end or beginning of a lanelet to the next; in it every lanelet is there from its
beginning to its end.
"""

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import ceil, floor

from roadproof.errors import InputError
from roadproof.world.drive import Motion
from roadproof.world.motion import State, advance, monotone_starts, states_at
from roadproof.world.road import Lanelet, Road

MARGIN = 100
"""Metres of road beyond the drive and beyond the ends of lanelets, where lanelets have no end."""
_NEAR = Fraction(1, 2**20)
"""Seconds: so near to where its speed is 0 a vehicle is where it stands by far less than ``MARGIN``."""


@dataclass(frozen=True)
class Section:
    """The lanelets that are there from ``low`` to ``high`` (m along the road), from left to right."""

    low: Fraction
    high: Fraction
    lanelets: tuple[Lanelet, ...]


@dataclass(frozen=True)
class Layout:
    """A road cut to ``low`` ≤ s ≤ ``high`` (m), in sections that follow each other."""

    road: Road
    low: Fraction
    high: Fraction
    sections: tuple[Section, ...]

    @property
    def said(self) -> str:
        """What was cut, for the heading of a file."""
        endless = any(None in x.s for x in self.road.lanelets)
        cut = f"cut to s = {self.low} m to {self.high} m" if endless else "not cut"
        return f"road {self.road.name}, {cut}"


def lay_out(road: Road, span: tuple[Fraction, Fraction]) -> Layout:
    """``road`` as far as ``span`` (least rear, greatest front; m) and its lanelets go, and ``MARGIN`` more.

    Raises ``InputError`` where lanelets overlap, since lanes of other formats lie side by side, and where
    lanelets leave a gap along the road.
    """
    ends = [x for lanelet in road.lanelets for x in lanelet.s if x is not None]
    low = Fraction(floor(min((span[0], *ends))) - MARGIN)
    high = Fraction(ceil(max((span[1], *ends))) + MARGIN)
    begins = [low if x.s[0] is None else x.s[0] for x in road.lanelets]
    stops = [high if x.s[1] is None else x.s[1] for x in road.lanelets]
    places = sorted({*begins, *stops})
    sections = []
    for a, b in pairwise(places):
        there = [
            x for x, begin, stop in zip(road.lanelets, begins, stops, strict=True) if begin <= a and b <= stop
        ]
        sections.append(Section(a, b, _side_by_side(road, a, b, there)))
    return Layout(road, places[0], places[-1], tuple(sections))


def _side_by_side(road: Road, low: Fraction, high: Fraction, lanelets: list[Lanelet]) -> tuple[Lanelet, ...]:
    ordered = sorted(lanelets, key=lambda x: x.d, reverse=True)
    where = f"road {road.name}, s = {low} m to {high} m"
    if not ordered:
        raise InputError(f"{where}: there is no lanelet; other formats have roads without gaps")
    for left, right in pairwise(ordered):
        if right.d[1] > left.d[0]:
            raise InputError(
                f"{where}: lanelets {left.id} and {right.id} overlap; lanes of other formats lie side by side"
            )
    return tuple(ordered)


def span_of(motions: list[Motion], horizon: Fraction) -> tuple[Fraction, Fraction]:
    """The least rear and the greatest front (m) of some vehicles from time 0 to ``horizon`` (s)."""
    rears, fronts = [], []
    for motion in motions:
        for place in (x.s for x in _extremes(motion, horizon)):
            rears.append(place - motion.length)
            fronts.append(place)
    return min(rears), max(fronts)


def _extremes(motion: Motion, horizon: Fraction) -> list[State]:
    """States among which s is least and greatest: both ends, every knot, and where the speed is 0.

    With jerk that may be an irrational time; then it is one within ``_NEAR`` of it.
    """
    starts = [x for x in monotone_starts(motion) if x.time < horizon]
    times = {Fraction(0), horizon, *(x.time for x in starts)}
    ends = [x.time for x in starts[1:]] + [horizon]
    for state, end in zip(starts, ends, strict=True):
        times.add(_still(state, end))
    return list(states_at(motion, sorted(times)))


def _still(state: State, end: Fraction) -> Fraction:
    """When a speed that grows or falls from ``state`` on is 0, or one of both ends where it is so nowhere."""
    begin = state.time
    if state.j_lon == 0:
        still = begin - state.v_lon / state.a_lon if state.a_lon else end
        return still if begin < still < end else end
    if state.v_lon * advance(state, end - begin).v_lon >= 0:
        return end
    while end - begin > _NEAR:
        middle = (begin + end) / 2
        if state.v_lon * advance(state, middle - state.time).v_lon > 0:
            begin = middle
        else:
            end = middle
    return begin


def together(one: Lanelet, other: Lanelet, road: Road) -> bool:
    """Whether two lanelets of a section share a boundary, lie in one zone, and their lanes are adjacent.

    Beyond a zone its ramp is no part of the main road any more, though it may still lie beside it.
    """
    touching = one.d[0] == other.d[1] or one.d[1] == other.d[0]
    return touching and one.zone == other.zone and frozenset((one.lane, other.lane)) in road.adjacent
