"""Random drives with random formulas that hold on their samples: what a NONE-WITHIN must never deny.

Formulas are read by definition (semantics §1) on samples of which the last stands for all later time;
nothing of the encoder is used. Thresholds are values of the drive itself, so that many formulas hold there
and nearly nowhere else.
"""

import random
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import combinations

from definition import of_values
from roadproof.engines.encode.build import Assumptions
from roadproof.engines.encode.unroll import Grid
from roadproof.engines.search.question import SearchProblem, assignments
from roadproof.library.bind import bind, default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.motion import state_at
from roadproof.world.signals import RECORDED

LIBRARY = bundled_library()
BASE = LIBRARY.select("base")
VALUES = default_values(LIBRARY)
CAR = load_vehicle("car")
ROADS = {name: load_road(name) for name in ("main-2", "main-3", "merge", "depart")}
DT = Fraction(3, 5)
REACH = Fraction(80)
NAMES = ("SV", "POV", "POV2")


@dataclass(frozen=True)
class Known:
    """``text`` holds on the samples of ``drive``, with its free lanes as in ``lanes``."""

    text: str
    road: str
    drive: Drive
    grid: Grid
    lanes: dict[str, str]

    def question(self):
        """The question, with every assignment of lanes, whose answer must not be NONE-WITHIN."""
        query = read_claim(BASE, self.text)
        road = ROADS[self.road]
        vehicles = dict.fromkeys(query.vehicles, CAR)
        lanes = assignments(query, road, {})
        return SearchProblem(
            query, road, vehicles, VALUES, lanes, self.grid, Assumptions(reach=REACH).without_comfort()
        )


def known(seed):
    """A drive with a formula, the same for the same seed."""
    dice = random.Random(seed)
    road = dice.choice(list(ROADS))
    grid = Grid(DT, dice.choice((2, 3)))
    count = dice.choice((1, 2, 2, 2, 3))
    drive = None
    while drive is None:
        drive = _drive(dice, road, grid, count)
    lanes = {"L": dice.choice(ROADS[road].lanes)}
    telling = _Telling(dice, road, drive, grid, lanes, _states(drive, grid))
    if dice.random() < 0.3:
        parts = [telling.pinned() for _ in range(dice.choice((4, 8)))]
    else:
        parts = [telling.true_at(0, 2) for _ in range(dice.choice((1, 2, 3)))]
    return Known(" and ".join(f"({part})" for part in parts), road, drive, grid, telling.lanes)


def _drive(dice, road, grid, count):
    """Cars of the class that a NONE-WITHIN speaks of, or None where the dice fell badly."""
    centre = dice.choice((0, 0, -100, 300, -330, 380))
    vehicles = {}
    for name in NAMES[:count]:
        motion = _motion(dice, grid, centre)
        if motion is None or not _on_road(motion, road, grid):
            return None
        vehicles[name] = motion
    for a, b in combinations(vehicles.values(), 2):
        if abs(a.s - b.s) > REACH or any(_overlap(a, b, k * grid.dt) for k in range(grid.steps + 1)):
            return None
    return Drive(vehicles)


def _motion(dice, grid, centre):
    start = Fraction(dice.choice((0, 1, -30, 40, 80, -80)) + dice.randint(-3, 3), dice.choice((1, 3)))
    side = dice.choice(
        (Fraction(9, 5), Fraction(7), Fraction(3), Fraction(10, 3), Fraction(-1), Fraction(-17, 10))
    )
    v = dice.choice((Fraction(15), Fraction(40), Fraction(25), Fraction(dice.randint(46, 119), 3)))
    w = dice.choice((Fraction(0), Fraction(0), Fraction(3, 2), -Fraction(3, 2), v / 10))
    if abs(w) > 2:
        return None
    pieces, now, across = [], v, w
    for _ in range(grid.steps):
        a = dice.choice((Fraction(-6), Fraction(3), Fraction(0), Fraction(dice.randint(-18, 9), 3)))
        b = dice.choice((Fraction(0), Fraction(0), Fraction(3, 2), Fraction(-3, 2), Fraction(1, 3)))
        now, across = now + a * grid.dt, across + b * grid.dt
        if not (15 <= now <= 40 and abs(across) <= min(Fraction(2), now / 10)):
            return None
        pieces.append(Piece(grid.dt, a, b))
    last = Piece(None, Fraction(0), Fraction(0))
    return Motion(CAR.length, CAR.width, centre + start, side, v, w, (*pieces, last))


def _box(motion, time):
    x = state_at(motion, time)
    return (x.s - motion.length, x.s), (x.d - motion.width, x.d)


def _shared(one, other):
    low = max(end for end in (one[0], other[0]) if end is not None)
    return max(Fraction(0), min(end for end in (one[1], other[1]) if end is not None) - low)


def _overlap(a, b, time):
    (along, across), (other_along, other_across) = _box(a, time), _box(b, time)
    return _shared(along, other_along) > 0 and _shared(across, other_across) > 0


def _on_road(motion, road, grid):
    """Whether at every sample lanelets, which do not overlap, cover the whole box."""
    for k in range(grid.steps + 1):
        along, across = _box(motion, k * grid.dt)
        covered = sum(_shared(along, x.s) * _shared(across, x.d) for x in ROADS[road].lanelets)
        if covered != motion.length * motion.width:
            return False
    return True


@dataclass(frozen=True)
class _Telling:
    """Texts that are true of a drive at a sample, most of them by a hair."""

    dice: random.Random
    road: str
    drive: Drive
    grid: Grid
    lanes: dict[str, str]
    states: list[dict]

    def pinned(self):
        """What a comparison is at one sample."""
        k = self.dice.randint(0, self.grid.steps)
        return f"F[{_seconds(k)}, {_seconds(k)}] ({self.true_atom(k)})"

    def true_at(self, k, depth):
        if depth == 0 or self.dice.random() < 0.2:
            return self.true_atom(k)
        j = self.dice.randint(k, self.grid.steps)
        low = self.dice.randint(0, j - k)
        high = self.dice.choice((_seconds(j - k), _seconds(j - k + 1), "inf"))
        window = f"[{_seconds(low)}, {high}]"
        later, now = self.true_at(j, depth - 1), self.true_at(k, depth - 1)
        some = self.some_atom(k)
        text = self.dice.choice(
            (
                f"F[{_seconds(j - k)}, {_seconds(j - k)}] ({later})",
                f"F{window} ({later})",
                f"G[{_seconds(j - k)}, {_seconds(j - k)}] ({later})",
                f"G{window} ({later})",
                f"({some}) U{window} ({later})",
                f"({now}) and ({later})",
                f"({now}) and ({self.true_at(k, depth - 1)})",
                f"({now}) or ({some})",
                f"({some}) -> ({now})",
                f"not (({some}) U{window} ({self.some_atom(k)}))",
            )
        )
        return text if self.holds(text, k) else f"not ({text})"

    def true_atom(self, k):
        text = self.some_atom(k)
        return text if self.holds(text, k) else f"not ({text})"

    def holds(self, text, k):
        return of_values(self.states, DT).holds(_bound(text, self.road, tuple(self.lanes.items())), k)

    def some_atom(self, k):
        """A comparison with a value of the drive, or a state of the library."""
        names = tuple(self.drive.vehicles)
        a, b = self.dice.sample(names * (len(names) == 1) + names, 2)
        if self.dice.random() < 0.2:
            state = [f"atLane({a}, L)", f"inMergeZone({a})", f"inDepartZone({a})", f"s({a}) > 0 m"]
            pairs = [f"danger({a}, {b})", f"aheadOf({a}, {b})", f"sameLane({a}, {b}, L)"]
            return self.dice.choice(state + (pairs if a != b else []))
        signal = self.dice.choice(("s", "s", "d", "v_lon", "v_lat", "a_lon"))
        unit = {"s": "1 m", "d": "1 m", "a_lon": "1 m/s^2"}.get(signal, "1 m/s")
        x, y = (self.states[k][f"{signal}({name})"] for name in (a, b))
        term, value = self.dice.choice(
            (
                (f"{signal}({a})", x),
                (f"{signal}({a}) - {signal}({b})", x - y),
                (f"2 * {signal}({a}) - 3 * {signal}({b})", 2 * x - 3 * y),
                (f"max({signal}({a}), {signal}({b}))", max(x, y)),
                (f"{signal}({a})^2 - {signal}({a}) * {signal}({b})", x * x - x * y),
            )
        )
        unit = f"{unit} * {unit}" if "^2 -" in term else unit
        value += self.dice.choice((0, 0, 0, 0, Fraction(1, 10), Fraction(-1, 3)))
        op = self.dice.choice(("<", "<=", ">", ">=", "=", "=", "="))
        return f"{term} {op} ({value.numerator} / {value.denominator}) * {unit}"


def _seconds(steps):
    return f"{float(steps * DT):g} s"


def holds_on_samples(text, road, drive, grid, lanes, k=0):
    """Truth at sample k by definition."""
    return of_values(_states(drive, grid), DT).holds(_bound(text, road, tuple(lanes.items())), k)


@cache
def _bound(text, road, lanes):
    query = read_claim(BASE, text)
    return bind(query.formula, ROADS[road], {n: lane for n, lane in lanes if n in query.lanes}, VALUES)


def _states(drive, grid):
    """The values of signals and sizes at every sample."""
    return [
        {
            f"{name}({vehicle})": getattr(x, name)
            for vehicle, motion in drive.vehicles.items()
            for state in [state_at(motion, k * grid.dt)]
            for x, names in ((state, RECORDED), (motion, ("length", "width")))
            for name in names
        }
        for k in range(grid.steps + 1)
    ]
