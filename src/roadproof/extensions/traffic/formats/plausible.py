"""Finds contradictions in a recording: motion against positions, sizes against classes and lanes.

Each rule is asked of many samples or vehicles. Above a stated share of broken ones the recording is
refused, below it the rule is a note. The constants are argued for in docs/how-to/highd.md.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from roadproof.extensions.traffic.formats.clock import Rate, samples_in
from roadproof.extensions.traffic.formats.factors import common_factor, hint_on
from roadproof.extensions.traffic.formats.median import Median, SpeedScale, integrate
from roadproof.extensions.traffic.formats.recording import (
    Bools,
    Floats,
    Integers,
    Lane,
    Recording,
    blocks_of,
    blockwise,
)
from roadproof.extensions.traffic.formats.windows import MOST_SAMPLES
from roadproof.world.signals import SignalName, SizeName

LARGEST_SPEED = 250.0
LARGEST_ACCELERATION = 100.0
LARGEST_SIZE = 50.0
LARGEST_STEP = 100.0
"""m/s, m/s², m, and m from one frame to the next: beyond that there is no vehicle; one cell is refused."""

SHARE = 0.1
"""Above this share of broken seconds of motion, or of vehicles, a recording is refused."""
SHARE_OF_JUMPS = 0.05
"""Above this share of steps between frames that jump a recording is refused."""
FEWEST = 5
"""So many must break a rule before a recording is refused for their share."""
FEWEST_VEHICLES = 10
"""So many of one direction are needed to say where in their lanes vehicles drive."""
OFF_CENTRE = (0.3, 0.5)
"""Half vehicle widths beside the middle of the lane, in the median, that are noted, and refused."""
SIZES = {"Car": ((2.0, 8.0), (1.0, 3.0)), "Truck": ((4.0, 30.0), (1.4, 3.5))}
"""Usual lengths and widths of the classes (m)."""


@dataclass(frozen=True)
class Contradiction:
    """A rule of which ``broken`` of ``asked`` places break it, first at sample ``row``.

    ``signal`` is what the cell there says; ``refused`` where there are too many; ``hint``: what may be wrong
    in all of them. ``factor``: that of a known fault, such as a turned sign, or another one that more than
    half of all places agree on; so it holds for the whole recording.
    """

    rule: str
    signal: SignalName | SizeName
    row: int
    broken: int
    asked: int
    unit: str
    refused: bool
    hint: str = ""
    factor: float | None = None

    @property
    def text(self) -> str:
        """The rule, and how often it is broken."""
        return f"{self.rule}{self.hint} ({self.broken} of {self.asked} {self.unit})"


def contradiction_checks(recording: Recording) -> "ContradictionChecks":
    """The checks of a whole recording."""
    checks = ContradictionChecks(recording.rate, recording.lanes)
    checks.add(recording)
    return checks


@dataclass(frozen=True)
class OffRoad:
    """The number of vehicles that are never on a lane, and the first of them, with its first sample.

    ``refused`` where they are too many.
    """

    vehicle: int
    row: int
    count: int
    refused: bool


@dataclass(frozen=True)
class _RateRule:
    """A signal and what its rate of change is said to be; a window moves where either changes by ``least``.

    The two may differ by ``share`` of the greater and ``slack``.
    """

    signal: SignalName
    rate: SignalName
    least: float
    share: float
    slack: float
    what: str


_RATES = (
    _RateRule("s", "v_lon", 1.0, 0.1, 0.2, "velocities along the road and positions"),
    _RateRule("d", "v_lat", 0.3, 0.5, 0.1, "velocities across the road and positions"),
    _RateRule("v_lon", "a_lon", 0.5, 0.5, 0.25, "accelerations along the road and velocities"),
)


@dataclass
class _MotionCheck:
    """A comparison of a signal's change in a second with the sum of its rate, five times a second.

    The sum goes on from vehicle to vehicle, so that parts of a recording come to what the whole does.
    """

    rule: _RateRule
    broken: int = 0
    asked: int = 0
    row: int = 0
    factors: list[Floats] = field(default_factory=list)
    last: tuple[float, float] | None = None

    def add(self, recording: Recording, before: int, seconds: "_Seconds") -> Floats:
        """Add vehicles, before which there were so many rows, and return the sum of the rate."""
        signal, rate = getattr(recording, self.rule.signal), getattr(recording, self.rule.rate)
        total = integrate(rate, recording.rate, self.last)
        self.last = float(total[-1]), float(rate[-1])
        begin, end = seconds.begin, seconds.end
        change, integral = signal[end] - signal[begin], total[end] - total[begin]
        greater = np.maximum(np.abs(change), np.abs(integral))
        moved = seconds.whole & (greater > self.rule.least)
        wrong = np.flatnonzero(
            moved & (np.abs(change - integral) > self.rule.share * greater + self.rule.slack)
        )
        if len(wrong) and not self.broken:
            first = begin.start + int(wrong[0]) * begin.step
            self.row = before + _worst(signal, total, first, first + samples_in(recording.rate))
        self.broken += len(wrong)
        self.asked += int(np.count_nonzero(moved))
        self.factors.append(integral[wrong] / np.where(change[wrong] == 0, np.inf, change[wrong]))
        return total

    def contradictions(self) -> Iterator[Contradiction]:
        if self.broken:
            factors = np.concatenate(self.factors)
            factor = float(np.median(factors))
            refused = _too_many(self.broken, self.asked, SHARE)
            head = f"{self.rule.what} contradict each other", self.rule.rate, self.row
            counts = self.broken, self.asked, "moving seconds"
            most = refused and 2 * self.broken > self.asked
            common = common_factor(factors, factor, self.asked) if most else None
            yield Contradiction(*head, *counts, refused, hint_on(factor) if refused else "", common)


@dataclass(frozen=True)
class _Seconds:
    """The first and last samples of windows of a second, and whether each is ``whole``: of one vehicle."""

    begin: slice
    end: slice
    whole: Bools


def _seconds(recording: Recording, before: int) -> _Seconds:
    """Windows every fifth of a second of the whole, in which there are so many rows ``before``."""
    every, rows = max(1, samples_in(recording.rate) // 5), len(recording.s)
    first, second = -before % every, samples_in(recording.rate)
    begin = slice(first, max(0, rows - second), every)
    end = slice(first + second, rows, every)
    vehicle = recording.row_vehicle
    return _Seconds(begin, end, vehicle[begin] == vehicle[end])


def _worst(signal: Floats, total: Floats, begin: int, end: int) -> int:
    """The sample of a window before which the two differ most."""
    apart = np.abs(np.diff(signal[begin : end + 1]) - np.diff(total[begin : end + 1]))
    return begin + 1 + int(np.argmax(apart))


@dataclass
class _JumpCheck:
    """A check that no signal changes by more than ``limit`` from one frame to the next.

    With a ``rate``, by more than that beside its integral. The share ``most`` of all steps may.
    """

    rule: str
    signal: SignalName
    limit: float
    rate: SignalName | None = None
    most: float = SHARE_OF_JUMPS
    broken: int = 0
    asked: int = 0
    row: int = 0

    def compare(self, recording: Recording, inner: Bools, before: int) -> None:
        """Look at the steps that are ``inner``: within a vehicle; ``before``: how many rows there were."""
        signal, broken = getattr(recording, self.signal), np.empty(len(inner), bool)
        for part in blocks_of(len(signal), overlap=1):
            steps = slice(part.start, part.stop - 1)
            change = np.diff(signal[part])
            if self.rate is not None:
                rate = getattr(recording, self.rate)[part]
                change -= (rate[1:] + rate[:-1]) * (1 / float(recording.rate) / 2)
            broken[steps] = inner[steps] & (np.abs(change) > self.limit)
        self.add(broken, before + 1, int(np.count_nonzero(inner)))

    def add(self, broken: Bools, first: int, steps: int) -> None:
        """``broken`` has an entry a row from row ``first`` on; of ``steps`` steps."""
        if broken.any() and not self.broken:
            self.row = first + int(np.argmax(broken))
        self.broken += int(np.count_nonzero(broken))
        self.asked += steps

    def contradictions(self) -> Iterator[Contradiction]:
        if self.broken:
            refused = self.broken > self.most * self.asked and (self.broken >= FEWEST or self.most == 0)
            yield Contradiction(self.rule, self.signal, self.row, self.broken, self.asked, "steps", refused)


def _steps(rate: Rate) -> tuple[_JumpCheck, ...]:
    moves = f"a vehicle does not move by more than {LARGEST_STEP:g} m from one frame to the next"
    differ = "a position and the velocity differ by more than {:g} m from one frame to the next"
    changes = "a velocity changes by more than {:.2g} m/s from one frame to the next"
    along, across = 30 * (1 / float(rate)) + 0.5, 10 * (1 / float(rate)) + 0.5
    return (
        _JumpCheck(moves, "s", LARGEST_STEP, most=0),
        _JumpCheck(differ.format(1.0), "s", 1.0, "v_lon"),
        _JumpCheck(moves, "d", LARGEST_STEP, most=0),
        _JumpCheck(differ.format(0.5), "d", 0.5, "v_lat"),
        _JumpCheck(changes.format(along), "v_lon", along),
        _JumpCheck(changes.format(across), "v_lat", across),
        _JumpCheck("an acceleration is above 15 m/s²", "a_lon", 15),
    )


@dataclass(frozen=True)
class _Vehicles:
    """The columns with one entry a vehicle; ``start`` is the first row of each."""

    length: Floats
    width: Floats
    kind: npt.NDArray[np.str_]
    direction: Integers
    start: Integers


def _sizes(vehicles: _Vehicles, lanes: tuple[Lane, ...]) -> Iterator[Contradiction]:
    """Sizes that do not fit the class, that are wider than long, or wider than any lane."""
    length, width, kind = vehicles.length, vehicles.width, vehicles.kind
    yield from _vehicles(vehicles, "a vehicle is wider than it is long", "width", width > length)
    widths = [lane.d[1] - lane.d[0] for lane in lanes if lane.d is not None]
    if widths:
        yield from _vehicles(vehicles, "a vehicle is wider than every lane", "width", width > max(widths))
    for name, (lengths, across) in SIZES.items():
        sizes: tuple[tuple[SizeName, Floats, tuple[float, float]], ...] = (
            ("length", length, lengths),
            ("width", width, across),
        )
        for signal, value, (low, high) in sizes:
            broken = (kind == name) & ((value < low) | (value > high))
            rule = f"a {name} is usually {low:g} to {high:g} m {'long' if signal == 'length' else 'wide'}"
            yield from _vehicles(vehicles, rule, signal, broken)


def _vehicles(vehicles: _Vehicles, rule: str, signal: SizeName, broken: Bools) -> Iterator[Contradiction]:
    count, of = int(np.count_nonzero(broken)), len(vehicles.length)
    if count:
        row, refused = int(vehicles.start[np.argmax(broken)]), _too_many(count, of, SHARE)
        yield Contradiction(rule, signal, row, count, of, "vehicles", refused)


def _too_many(broken: int, places: int, share: float) -> bool:
    return broken >= FEWEST and broken > share * places


class _LanePositions:
    """Vehicles of one direction that all drive beside the middle of their lanes, so no corner is tracked."""

    def __init__(self, lanes: tuple[Lane, ...]) -> None:
        bands = [lane.d for lane in lanes if lane.d is not None]
        self.straight = len(bands) == len(lanes)
        self.middle = np.array([(right + left) / 2 for right, left in bands] + [0.0])
        self.beside: dict[int, Median] = {}
        self.rows: dict[int, int] = {}
        self.off: dict[int, Integers] = {}

    def add(self, recording: Recording, before: int) -> None:
        if not self.straight:
            return
        half = np.repeat(recording.width / 2, np.diff(recording.start))
        beside = blockwise(
            lambda d, half, lane: (d - half - self.middle[lane]) / half, recording.d, half, recording.lane
        )
        direction = np.repeat(recording.direction, np.diff(recording.start))
        for way in np.unique(recording.direction).tolist():
            ours = np.flatnonzero((direction == way) & (recording.lane >= 0))
            there = beside[ours]
            self.beside.setdefault(way, Median(MOST_SAMPLES)).add(there)
            off: list[Integers] = [
                np.flatnonzero(there > OFF_CENTRE[0]),
                np.flatnonzero(there < -OFF_CENTRE[0]),
            ]
            if first := [int(ours[x[0]]) for x in off if len(x)]:
                self.rows.setdefault(way, before + min(first))
            self.off[way] = self.off.get(way, np.zeros(2, np.int64)) + np.array([len(x) for x in off])

    def contradictions(self, vehicles: _Vehicles) -> Iterator[Contradiction]:
        for way, beside in sorted(self.beside.items()):
            many = int(np.count_nonzero(vehicles.direction == way))
            if many < FEWEST_VEHICLES or not beside.count:
                continue
            if 2 * self.off[way].max() + 2 < beside.count:
                continue  # more than half are in the middle, and so is the median
            median = beside.value()
            if abs(median) > OFF_CENTRE[0]:
                side = "left" if median > 0 else "right"
                rule = (
                    f"vehicles of direction {way} drive {abs(median):.2f} half widths {side} of the middle "
                    "of their lanes: is a position the upper-left corner of the box?"
                )
                refused = abs(median) > OFF_CENTRE[1]
                yield Contradiction(rule, "d", self.rows[way], many, many, "vehicles", refused)


class ContradictionChecks:
    """The contradictions within a recording, whose vehicles are added one after the other, each whole."""

    def __init__(self, rate: Rate, lanes: tuple[Lane, ...]) -> None:
        self.lanes = lanes
        self.motion = [_MotionCheck(rule) for rule in _RATES]
        self.scale = SpeedScale()
        *self.steps, self.hard = _steps(rate)
        self.places = _LanePositions(lanes)
        self.vehicles: list[_Vehicles] = []
        self.on_road: list[Bools] = []
        self.rows = 0

    def add(self, recording: Recording) -> None:
        """The vehicles that follow those that were added, in the order of the whole."""
        if not len(recording.s):
            return
        if not recording.computed and recording.rate >= 1:
            self._add_motion(recording)
        self.places.add(recording, self.rows)
        of = (recording.length, recording.width, recording.kind, recording.direction)
        self.vehicles.append(_Vehicles(*of, recording.start[:-1] + self.rows))
        self.on_road.append(np.logical_or.reduceat(recording.occupancy != 0, recording.start[:-1]))
        self.rows += len(recording.s)

    def _add_motion(self, recording: Recording) -> None:
        """Compare places, speeds and accelerations with each other."""
        seconds = _seconds(recording, self.rows)
        way, *_ = [rule.add(recording, self.rows, seconds) for rule in self.motion]
        self.scale.add(recording, self.rows, way)
        inner = np.ones(max(0, len(recording.s) - 1), bool)
        inner[recording.start[1:-1] - 1] = False
        for step in self.steps:
            step.compare(recording, inner, self.rows)
        first = 0 if self.rows else 1  # the first of all is no step
        hard = blockwise(lambda a_lon: np.abs(a_lon) > self.hard.limit, recording.a_lon[first:])
        self.hard.add(hard, self.rows + first, int(np.count_nonzero(inner)))

    def contradictions(self) -> list[Contradiction]:
        """Return all contradictions, the gravest first."""
        if not self.rows:
            return []
        names = _Vehicles.__dataclass_fields__
        whole = _Vehicles(*(np.concatenate([getattr(x, name) for x in self.vehicles]) for name in names))
        contradictions = [contradiction for rule in self.motion for contradiction in rule.contradictions()]
        scale = self.scale.text()
        if scale is not None:
            counts = self.scale.vehicles, len(whole.length)
            contradictions.append(Contradiction(scale, "v_lon", self.scale.row, *counts, "vehicles", False))
        contradictions += [
            contradiction for step in (*self.steps, self.hard) for contradiction in step.contradictions()
        ]
        contradictions += [*_sizes(whole, self.lanes), *self.places.contradictions(whole)]
        return sorted(contradictions, key=lambda contradiction: not contradiction.refused)

    def off_road(self) -> OffRoad | None:
        """The vehicles that are never on a lane; None where there are none."""
        on_road = np.concatenate(self.on_road)
        count, first = int(np.count_nonzero(~on_road)), int(np.argmin(on_road))
        if not count:
            return None
        row = int(np.concatenate([x.start for x in self.vehicles])[first])
        return OffRoad(first, row, count, count > SHARE * len(on_road))
