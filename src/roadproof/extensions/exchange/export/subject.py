"""A drive to be exported, with its name, sampling rate and a road cut to a finite length.

A section of a road reaches from one end or beginning of a lanelet to the next; in it every lanelet is there
from its beginning to its end.
"""

import re
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import ceil, floor

from roadproof.errors import InputError, UsageError
from roadproof.evidence.drive_file import DriveFile
from roadproof.extensions.traffic.evaluate.robust import MOST_SAMPLES
from roadproof.library.roles import vehicle_order
from roadproof.world.drive import Motion
from roadproof.world.motion import State, advance, piece_starts, states_at
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
class RoadCut:
    """A road cut to ``low`` ≤ s ≤ ``high`` (m), in sections that follow each other."""

    road: Road
    low: Fraction
    high: Fraction
    sections: tuple[Section, ...]

    @property
    def cut_note(self) -> str:
        """The note on the cut of the road, for the heading of a file."""
        endless = any(None in x.s for x in self.road.lanelets)
        cut = f"cut to s = {self.low} m to {self.high} m" if endless else "not cut"
        return f"road {self.road.name}, {cut}"


def lay_out(road: Road, span: tuple[Fraction, Fraction]) -> RoadCut:
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
    return RoadCut(road, places[0], places[-1], tuple(sections))


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
        times.add(_standstill_time(state, end))
    return list(states_at(motion, sorted(times)))


def _standstill_time(state: State, end: Fraction) -> Fraction:
    """Return when the speed from ``state`` on is 0; if never, the nearer end."""
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


def are_adjacent(one: Lanelet, other: Lanelet, road: Road) -> bool:
    """Return whether two lanelets of a section share a boundary, and their lanes are adjacent."""
    touching = one.d[0] == other.d[1] or one.d[1] == other.d[0]
    return touching and frozenset((one.lane, other.lane)) in road.adjacent


def allow_lane_change(one: Lanelet, other: Lanelet, road: Road) -> bool:
    """Return whether vehicles may change between two lanelets; beyond the zone of a ramp they may not."""
    return one.zone == other.zone and are_adjacent(one, other, road)


WRITTEN = "1970-01-01"
"""The date in files that must have one: a drive has none, and the same drive gives the same file."""
_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")


@dataclass(frozen=True)
class ExportSubject:
    """The drive of ``file``; ``name`` is that of its files, ``number`` its place among the exported.

    ``rate``: samples a second.
    """

    name: str
    number: int
    file: DriveFile
    rate: int = 25

    @cached_property
    def vehicles(self) -> dict[str, Motion]:
        """The motions by name, SV first."""
        return {name: self.file.drive.vehicles[name] for name in vehicle_order(self.file.drive.vehicles)}

    @cached_property
    def ids(self) -> dict[str, int]:
        """The ids of vehicles where names are numbers."""
        return {name: number for number, name in enumerate(self.vehicles, 1)}

    @cached_property
    def layout(self) -> RoadCut:
        """The road, cut to where the drive goes. Raises ``InputError``."""
        return lay_out(self.file.road, span_of([*self.vehicles.values()], self.file.horizon))

    @cached_property
    def times(self) -> list[Fraction]:
        """The times (s) of the samples, from 0 up to the horizon."""
        return [Fraction(k, self.rate) for k in range(int(self.file.horizon * self.rate) + 1)]

    @cached_property
    def samples(self) -> dict[str, list[State]]:
        """The states of each vehicle at the times of the samples."""
        return {name: [*states_at(motion, self.times)] for name, motion in self.vehicles.items()}

    @property
    def formula_note(self) -> str:
        """The formula of the drive, for the heading of a file."""
        what = self.file.formula if self.file.scenario is None else f"scenario {self.file.scenario}"
        return f"{what} ({self.file.set_name}), {self.file.horizon} s, {self.layout.cut_note}"


def subject_of(name: str, number: int, file: DriveFile, rate: int) -> ExportSubject:
    """A subject that every format can have.

    Raises ``InputError`` where there is no vehicle, or one whose name is no plain word, ``UsageError`` for a
    rate whose steps are no decimals or longer than the drive, or that makes too many samples.
    """
    if not file.drive.vehicles:
        raise InputError(f"{name}: the drive has no vehicle, so there is nothing to export")
    for vehicle in file.drive.vehicles:
        if not _NAME.fullmatch(vehicle):
            raise InputError(f"{name}: vehicle {vehicle[:40]!r}: other tools want letters, digits and _ only")
    if not 1 <= rate <= 1000 or 10**9 % rate:
        raise UsageError(f"rate={rate}: write samples a second up to 1000, such as 10, 25, 50 or 100")
    if file.horizon * rate < 1:
        raise UsageError(
            f"rate={rate}: {name} lasts {file.horizon} s, less than a step; write a greater rate"
        )
    if file.horizon * rate >= MOST_SAMPLES:
        raise UsageError(
            f"rate={rate}: {name} lasts {file.horizon} s, which makes more than {MOST_SAMPLES:,} samples"
        )
    return ExportSubject(name, number, file, rate)


def monotone_starts(motion: Motion) -> tuple[State, ...]:
    """Return the starts of all intervals on which the speed along the road is monotone.

    They are the starts of pieces, and the zeros of the acceleration along the road inside pieces. At the
    start of a piece the state has the acceleration of that piece.
    """
    states: list[State] = []
    for state, piece in zip(piece_starts(motion), motion.pieces, strict=True):
        states.append(state)
        if piece.duration is not None and state.j_lon != 0:
            turn = -state.a_lon / state.j_lon
            if 0 < turn < piece.duration:
                states.append(advance(state, turn))
    return tuple(states)
