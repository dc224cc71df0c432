"""Whether a recording contradicts itself: motion against positions, sizes against classes and lanes.

Each rule is asked of many samples or vehicles. Above a stated share of broken ones the recording is
refused, below it the rule is a note. The constants are argued for in docs/highd.md.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from roadproof.formats.blockwise import blocks_of, blockwise
from roadproof.formats.recording import Bools, Floats, Integers, Recording
from roadproof.signals import SignalName, SizeName

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
class Implausible:
    """A rule of which ``broken`` of ``asked`` places break it, first at sample ``row``.

    ``signal`` is what the cell there says; ``refused`` where there are too many.
    """

    rule: str
    signal: SignalName | SizeName
    row: int
    broken: int
    asked: int
    unit: str
    refused: bool

    @property
    def told(self) -> str:
        """The rule, and how often it is broken."""
        return f"{self.rule} ({self.broken} of {self.asked} {self.unit})"


def find_doubts(recording: Recording) -> list[Implausible]:
    """Everything in which ``recording`` contradicts itself, the gravest first."""
    if not len(recording.s):
        return []
    found = [*_motion(recording), *_steps(recording), *_sizes(recording), *_places(recording)]
    return sorted(found, key=lambda doubt: not doubt.refused)


@dataclass(frozen=True)
class OffRoad:
    """How many vehicles are on no lane at any time, the first of them, and whether they are too many."""

    vehicle: int
    count: int
    refused: bool


def off_road(recording: Recording) -> OffRoad | None:
    """The vehicles that are never on a lane; None where there are none."""
    on_road = np.logical_or.reduceat(recording.occupancy != 0, recording.start[:-1])
    count = int(np.count_nonzero(~on_road))
    return OffRoad(int(np.argmin(on_road)), count, count > SHARE * len(on_road)) if count else None


@dataclass(frozen=True)
class _Rate:
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
    _Rate("s", "v_lon", 1.0, 0.1, 0.2, "velocities along the road and positions"),
    _Rate("d", "v_lat", 0.3, 0.5, 0.1, "velocities across the road and positions"),
    _Rate("v_lon", "a_lon", 0.5, 0.5, 0.25, "accelerations along the road and velocities"),
)
_FACTORS = ((-1.0, "the sign is turned"), (0.0, "zero"), (3.6, "km/h?"), (2.237, "miles an hour?"))


def _motion(recording: Recording) -> Iterator[Implausible]:
    """What a signal changes by in a second against the sum of its rates, five times a second."""
    begin, end = _seconds(recording)
    for rule in _RATES:
        if not len(begin):
            return
        signal, rate = getattr(recording, rule.signal), getattr(recording, rule.rate)
        total = _sums(rate, recording.rate)
        change, told = signal[end] - signal[begin], total[end] - total[begin]
        greater = np.maximum(np.abs(change), np.abs(told))
        moved = greater > rule.least
        wrong = moved & (np.abs(change - told) > rule.share * greater + rule.slack)
        broken, asked = int(np.count_nonzero(wrong)), int(np.count_nonzero(moved))
        if broken:
            factor = float(np.median(told[wrong] / np.where(change[wrong] == 0, np.inf, change[wrong])))
            row = _worst(signal, total, int(begin[np.argmax(wrong)]), int(end[np.argmax(wrong)]))
            refused = _too_many(broken, asked, SHARE)
            text = f"{rule.what} contradict each other{_hint(factor) if refused else ''}"
            yield Implausible(text, rule.rate, row, broken, asked, "moving seconds", refused)


def _hint(factor: float) -> str:
    """What such a factor between what is told and what is so may come from."""
    if not np.isfinite(factor):
        return ""
    cause = next((f": {name}" for x, name in _FACTORS if abs(factor - x) < 0.05 * max(1, abs(x))), "")
    return f", by a factor of {factor:.3g}{cause}"


def _seconds(recording: Recording) -> tuple[Integers, Integers]:
    """The first and last sample of windows of a second, every fifth of a second, within one vehicle."""
    rows = np.arange(0, len(recording.s) - recording.rate, max(1, recording.rate // 5))
    vehicle = recording.row_vehicle
    rows = rows[vehicle[rows] == vehicle[rows + recording.rate]]
    return rows, rows + recording.rate


def _sums(rate: Floats, frames_a_second: int) -> Floats:
    """The integral of a rate up to each sample, straight between samples; only differences mean something."""
    total = np.zeros(len(rate))
    for part in blocks_of(len(rate), overlap=1):
        values = rate[part]
        steps = values[1:] + values[:-1]
        steps /= 2 * frames_a_second
        if len(steps):
            steps[0] += total[part.start]
            np.cumsum(steps, out=total[part.start + 1 : part.stop])
    return total


def _worst(signal: Floats, total: Floats, begin: int, end: int) -> int:
    """The sample of a window before which the two differ most."""
    apart = np.abs(np.diff(signal[begin : end + 1]) - np.diff(total[begin : end + 1]))
    return begin + 1 + int(np.argmax(apart))


def _steps(recording: Recording) -> Iterator[Implausible]:
    """What no vehicle does from one frame to the next."""
    step = 1 / recording.rate
    inner = np.ones(max(0, len(recording.s) - 1), bool)
    inner[recording.start[1:-1] - 1] = False
    for name, along, most in (("s", "v_lon", 1.0), ("d", "v_lat", 0.5)):
        rules = (
            (f"a vehicle does not move by more than {LARGEST_STEP:g} m from one frame to the next", 0.0),
            (
                f"a position and the velocity differ by more than {most:g} m from one frame to the next",
                SHARE_OF_JUMPS,
            ),
        )
        place, speed = getattr(recording, name), getattr(recording, along)
        jumps = [np.empty(len(inner), bool) for _ in rules]
        for part in blocks_of(len(place), overlap=1):
            steps = slice(part.start, part.stop - 1)
            way, velocity = np.diff(place[part]), speed[part]
            jumps[0][steps] = inner[steps] & (np.abs(way) > LARGEST_STEP)
            way -= (velocity[1:] + velocity[:-1]) * (step / 2)
            jumps[1][steps] = inner[steps] & (np.abs(way) > most)
        for (rule, share), broken in zip(rules, jumps, strict=True):
            yield from _jumps(rule, name, broken, inner, share)
    for name, most in (("v_lon", 30 * step + 0.5), ("v_lat", 10 * step + 0.5)):
        rule = f"a velocity changes by more than {most:.2g} m/s from one frame to the next"
        speed, broken = getattr(recording, name), np.empty(len(inner), bool)
        for part in blocks_of(len(speed), overlap=1):
            steps = slice(part.start, part.stop - 1)
            broken[steps] = inner[steps] & (np.abs(np.diff(speed[part])) > most)
        yield from _jumps(rule, name, broken, inner)
    rule = "an acceleration is above 15 m/s²"
    broken = blockwise(lambda a_lon: np.abs(a_lon) > 15, recording.a_lon[1:])
    yield from _jumps(rule, "a_lon", broken, inner)


def _jumps(
    rule: str, signal: str, broken: Bools, asked: Bools, most: float = SHARE_OF_JUMPS
) -> Iterator[Implausible]:
    count, of = int(np.count_nonzero(broken)), int(np.count_nonzero(asked))
    if count:
        refused = count > most * of and (count >= FEWEST or most == 0)
        row = int(np.argmax(broken)) + 1
        yield Implausible(rule, signal, row, count, of, "steps", refused)  # type: ignore[arg-type]


def _sizes(recording: Recording) -> Iterator[Implausible]:
    """Sizes that do not fit the class, that are wider than long, or wider than any lane."""
    length, width, kind = recording.length, recording.width, recording.kind
    asked = recording.vehicles
    yield from _vehicles(recording, "a vehicle is wider than it is long", "width", width > length)
    widths = [lane.d[1] - lane.d[0] for lane in recording.lanes if lane.d is not None]
    if widths:
        yield from _vehicles(recording, "a vehicle is wider than every lane", "width", width > max(widths))
    for name, (lengths, across) in SIZES.items():
        for signal, value, (low, high) in (("length", length, lengths), ("width", width, across)):
            broken = (kind == name) & ((value < low) | (value > high))
            rule = f"a {name} is usually {low:g} to {high:g} m {'long' if signal == 'length' else 'wide'}"
            yield from _vehicles(recording, rule, signal, broken, asked)


def _vehicles(
    recording: Recording, rule: str, signal: str, broken: Bools, asked: int | None = None
) -> Iterator[Implausible]:
    count, of = int(np.count_nonzero(broken)), recording.vehicles if asked is None else asked
    if count:
        row = int(recording.start[np.argmax(broken)])
        refused = _too_many(count, of, SHARE)
        yield Implausible(rule, signal, row, count, of, "vehicles", refused)  # type: ignore[arg-type]


def _too_many(broken: int, asked: int, share: float) -> bool:
    return broken >= FEWEST and broken > share * asked


def _places(recording: Recording) -> Iterator[Implausible]:
    """Vehicles of one direction that all drive beside the middle of their lanes, so no corner is tracked."""
    bands = [lane.d for lane in recording.lanes]
    if any(band is None for band in bands):
        return
    middle = np.array([(band[0] + band[1]) / 2 for band in bands if band is not None] + [0.0])
    half = np.repeat(recording.width / 2, np.diff(recording.start))
    direction = np.repeat(recording.direction, np.diff(recording.start))
    beside = blockwise(
        lambda d, half, lane: (d - half - middle[lane]) / half, recording.d, half, recording.lane
    )
    for way in np.unique(recording.direction):
        ours = (direction == way) & (recording.lane >= 0)
        many = int(np.count_nonzero(recording.direction == way))
        if many < FEWEST_VEHICLES or not ours.any():
            continue
        median = float(np.median(beside[ours]))
        if abs(median) > OFF_CENTRE[0]:
            side = "left" if median > 0 else "right"
            rule = (
                f"vehicles of direction {way} drive {abs(median):.2f} half widths {side} of the middle of "
                "their lanes: is a position the upper-left corner of the box?"
            )
            row = int(np.argmax(ours & (np.abs(beside) > OFF_CENTRE[0])))
            yield Implausible(rule, "d", row, many, many, "vehicles", abs(median) > OFF_CENTRE[1])
