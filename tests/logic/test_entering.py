"""Definitions of entering and leaving a lane, against the instants at which a box touches the lane.

The other reader here knows no formulas: it solves for the times at which the sides of the box are on a
marking, and reads positions at these times and between them.
"""

import random
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from math import isqrt
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from examples import some
from roadproof.library.bind import bind, default_values
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import load_library
from roadproof.logic.first_instant import first_instant_warnings
from roadproof.logic.formula import Formula
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.sampled.batch import Batch
from roadproof.semantics.sampled.compiled import compile
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road
from roadproof.world.motion import state_at
from roadproof.world.signals import STARTING

LIBRARY = load_library([Path("entering")])
HOME, VALUES = LIBRARY.select(), default_values(LIBRARY)
ROAD = load_road("main-2")
SIDES = {x.lane: x.d for x in ROAD.lanelets}
RIGHT, LEFT = sorted(SIDES, key=lambda x: SIDES[x])
LENGTH, WIDTH = Fraction(9, 2), Fraction(9, 5)
SPEC = Path(rp.__file__).parent / "library/sets/on_request/entering.spec"


def bound(text: str, lane: str, home=HOME, **values: Fraction) -> Formula:
    lanes = {"L": lane, "M": LEFT if lane == RIGHT else RIGHT}
    return bind(
        read_claim(home, f"given SV, POV: vehicle; L, M: lane: {text}").formula,
        ROAD,
        lanes,
        {**VALUES, **values},
    )


# --- Drives whose instants of entering are rational ---------------------------------------------------


def sideways(rng: random.Random) -> Motion:
    """A vehicle of which one side is on the middle marking at rational times, also as it turns there."""
    middle = SIDES[RIGHT][1]
    side = middle + rng.choice([Fraction(0), WIDTH])
    first, second = (Fraction(rng.randint(-10, 40), 10) for _ in "ab")
    rate = Fraction(rng.choice([-8, -4, -2, 0, 2, 4, 8]), 10)
    if rng.random() < 0.3:
        second = first
    if rate:  # d - side = rate/2 (t - first)(t - second)
        start, speed = side + rate / 2 * first * second, -rate / 2 * (first + second)
    else:
        speed = Fraction(rng.randint(-20, 20), 10)
        start = side - speed * first
    place, along = Fraction(rng.randint(-40, 40)), Fraction(rng.randint(15, 35))
    pieces = (Piece(None, Fraction(0), rate),)
    turn = (first + second) / 2
    if rate and turn > 0 and rng.random() < 0.4:  # it stays where it turns
        pieces = (Piece(turn, Fraction(0), rate), Piece(None, Fraction(0), Fraction(0)))
    return Motion(LENGTH, WIDTH, place, start, along, speed, pieces)


def random_drive(rng: random.Random) -> Drive:
    return Drive({"SV": sideways(rng), "POV": sideways(rng)})


# --- The other reader ---------------------------------------------------------------------------------


def touches(motion: Motion, lane: str) -> set[Fraction | float]:
    """The positive times at which a side of the box is on a marking of a lane, exact where rational."""
    low, high = SIDES[lane]
    lasting, rate = motion.pieces[0].duration, motion.pieces[0].a_lat
    times: set[Fraction | float] = set()
    for place in (low, high + motion.width):
        times |= roots(rate / 2, motion.v_lat, motion.d - place)
    return {x for x in times if x > 0 and (lasting is None or x <= lasting)}


def roots(a: Fraction, b: Fraction, c: Fraction) -> set[Fraction | float]:
    """The real roots of a polynomial of degree 2 at most; no time if it is constant."""
    if not a:
        return {-c / b} if b else set()
    square = b * b - 4 * a * c
    if square < 0:
        return set()
    exact = Fraction(isqrt(square.numerator), isqrt(square.denominator))
    root = exact if exact * exact == square else float(square) ** 0.5
    return {(-b - root) / (2 * a), (-b + root) / (2 * a)}


def is_inside(motion: Motion, lane: str, time: Fraction) -> bool:
    low, high = SIDES[lane]
    d = state_at(motion, time).d
    return low < d and d - motion.width < high


class Reading:
    """What happens to a vehicle at a lane: whether it is inside at first, and the times of its changes."""

    def __init__(self, motion: Motion, lane: str) -> None:
        times = sorted(touches(motion, lane))
        ends = [Fraction(0), *map(Fraction, times), Fraction(max(times, default=0)) + 2]
        between = [is_inside(motion, lane, (one + two) / 2) for one, two in pairwise(ends)]
        self.first = is_inside(motion, lane, Fraction(0))
        around = [*zip(times, pairwise(between), strict=True)]
        # A box that turns on the marking may be outside at one instant: it leaves and enters then.
        turns = [
            x
            for x, sides in around
            if all(sides) and isinstance(x, Fraction) and not is_inside(motion, lane, x)
        ]
        self.entries = [x for x, (one, two) in around if (two and not one) or x in turns]
        self.exits = [x for x, (one, two) in around if (one and not two) or x in turns]
        # At time 0 a box may touch the lane and enter at once.
        if between[0] and not self.first:
            self.entries.insert(0, Fraction(0))

    def soon(self, events: list[Fraction | float], within: Fraction, included: bool) -> bool:
        return any(x < within or (included and x == within) for x in events[:1])


def along(behind: float, ahead: float) -> float:
    """The longitudinal RSS distance for default parameters."""
    late = behind + 5 * 0.6
    return max(0.0, behind * 0.6 + 5 * 0.6**2 / 2 + late**2 / 12 - ahead**2 / 16)


def across(left: float, right: float) -> float:
    """The lateral RSS distance for default parameters; speeds grow to the left."""
    one, two = -left, -right
    return max(0.0, (one - two) * 0.6 + 1.5 * 0.36 + ((one + 0.9) ** 2 + (two - 0.9) ** 2) / 3)


def margin(drive: Drive, time: Fraction) -> float:
    """By how much SV and POV are nearer than the RSS distances, in m; negative where they are not."""
    a, b = (state_at(drive.vehicles[x], time) for x in ("SV", "POV"))
    gap = float(b.s - a.s)
    v, w = float(a.v_lon), float(b.v_lon)
    near = min(float(LENGTH) + along(v, w) - gap, float(LENGTH) + along(w, v) + gap)
    gap, v, w = float(b.d - a.d), float(a.v_lat), float(b.v_lat)
    beside = min(float(WIDTH) + across(w, v) - gap, float(WIDTH) + across(v, w) + gap)
    return min(near, beside)


def is_ahead(drive: Drive, one: str, other: str, time: Fraction) -> bool:
    """Whether ``one`` is ahead of ``other``."""
    a, b = (state_at(drive.vehicles[x], time) for x in (one, other))
    return a.s - LENGTH >= b.s


def changes(drive: Drive, lane: str, other: str) -> bool:
    """Whether SV is in ``lane`` alone, then in one of both, then in ``other`` alone."""
    motion = drive.vehicles["SV"]
    times = sorted({Fraction(0), *map(Fraction, touches(motion, lane) | touches(motion, other))})
    if any(not isinstance(x, Fraction) for x in touches(motion, lane) | touches(motion, other)):
        times = sorted({*times, *(x + Fraction(1, 10**9) for x in times)})  # floats are beside their roots
    points = [x for one, two in pairwise([*times, times[-1] + 2]) for x in (one, (one + two) / 2)]
    places = [(is_inside(motion, lane, x), is_inside(motion, other, x)) for x in points]
    if places[0] != (True, False):
        return False
    for here, there in places:
        if there and not here:
            return True
        if not here and not there:
            return False
    return False


def expected(drive: Drive, lane: str, within: Fraction) -> dict[str, bool]:
    """The truth of each definition, without formulas."""
    reading = Reading(drive.vehicles["SV"], lane)
    entries, exits = reading.entries, reading.exits
    pov = drive.vehicles["POV"]

    def at_entry(condition) -> bool:
        return any(condition(Fraction(x)) for x in entries)

    return {
        "entersLane(SV, L)": not reading.first and bool(entries),
        "leavesLane(SV, L)": reading.first and bool(exits),
        "staysOutside(SV, L)": not reading.first and not entries,
        "crossesLane(SV, L)": not reading.first and bool(entries) and bool(exits),
        "entersSoon(SV, L)": not reading.first and reading.soon(entries, within, False),
        "leavesSoon(SV, L)": reading.first and reading.soon(exits, within, True),
        "entersOnce(SV, L)": not reading.first and bool(entries) and not exits,
        "changesLane(SV, L, M)": changes(drive, lane, LEFT if lane == RIGHT else RIGHT),
        "entersInViolation(SV, POV, L)": at_entry(lambda x: margin(drive, x) >= 0),
        "leavesInViolation(SV, POV, L)": any(margin(drive, Fraction(x)) >= 0 for x in exits),
        "entersAhead(SV, POV, L)": at_entry(
            lambda x: is_inside(pov, lane, x) and is_ahead(drive, "SV", "POV", x)
        ),
        "entersBehind(SV, POV, L)": at_entry(
            lambda x: is_inside(pov, lane, x) and is_ahead(drive, "POV", "SV", x)
        ),
    }


def is_delicate(drive: Drive, lane: str, within: Fraction) -> bool:
    """Whether rounding could decide the other reader: at irrational instants, or near a violation."""
    reading = Reading(drive.vehicles["SV"], lane)
    for x in (*reading.entries, *reading.exits):
        if abs(margin(drive, Fraction(x))) < 1e-6:
            return True
        if not isinstance(x, Fraction):
            sides = (*SIDES[lane], SIDES[lane][0] + WIDTH, SIDES[lane][1] + WIDTH)
            d = state_at(drive.vehicles["POV"], Fraction(x)).d
            s = [state_at(drive.vehicles[y], Fraction(x)).s for y in ("SV", "POV")]
            if min(abs(d - y) for y in sides) < 1e-6 or abs(abs(s[0] - s[1]) - LENGTH) < 1e-6:
                return True
            if abs(Fraction(x) - within) < 1e-6:
                return True
    return False


def cases(count: int, seed: int):
    """Drives with a lane and a time ``within``, which is an instant of entering or leaving at times."""
    rng = random.Random(seed)
    while count:
        drive, lane = random_drive(rng), rng.choice([RIGHT, LEFT])
        exact = [x for x in touches(drive.vehicles["SV"], lane) if isinstance(x, Fraction)]
        within = rng.choice([*exact, Fraction(rng.randint(0, 40), 10)])
        if not is_delicate(drive, lane, within):
            count -= 1
            yield drive, lane, within


def test_definitions_are_true_where_the_box_enters_or_leaves() -> None:
    seen = set()
    for drive, lane, within in cases(some(400), 5):
        for text, holds in expected(drive, lane, within).items():
            assert judge(bound(text, lane, entryTime=within), drive).holds == holds, (text, lane, drive)
            seen.add((text, holds))
    assert len(seen) == 2 * len({text for text, _ in seen}) == 24


PLANTED = {
    "F[0, entryTime] atLane": ("F atLane", "entersSoon(SV, L)"),
    "F[0, entryTime] not atLane(a, L)": ("(atLane(a, L) U[0, entryTime] false)", "leavesSoon(SV, L)"),
    "G (atLane(a, L) -> G atLane(a, L))": ("F atLane(a, L)", "entersOnce(SV, L)"),
    "((atLane(a, L) or atLane(a, M)) U (atLane(a, M)": (
        "((atLane(a, L) and atLane(a, M)) U (atLane(a, M)",
        "changesLane(SV, L, M)",
    ),
    "((rssViolation(a, b) or atLane(a, L)) U atLane(a, L))": (
        "F (atLane(a, L) and rssViolation(a, b))",
        "entersInViolation(SV, POV, L)",
    ),
    "(atLane(a, L) U (not atLane(a, L) and rssViolation(a, b)))": (
        "F (not atLane(a, L) and rssViolation(a, b))",
        "leavesInViolation(SV, POV, L)",
    ),
    "(atLane(b, L) and aheadOf(b, a))": ("aheadOf(b, a)", "entersAhead(SV, POV, L)"),
    "(atLane(b, L) and aheadOf(a, b))": ("(atLane(b, L) and aheadOf_ext(a, b))", "entersBehind(SV, POV, L)"),
}


@pytest.mark.parametrize("right", PLANTED)
def test_a_planted_fault_in_a_definition_is_noticed(tmp_path: Path, right: str) -> None:
    wrong, name = PLANTED[right]
    text = SPEC.read_text("utf-8")
    assert text.count(right) == 1
    path = tmp_path / "planted.spec"
    path.write_text(text.replace(right, wrong), "utf-8")
    home = load_library([path]).select()
    assert any(
        judge(bound(name, lane, home, entryTime=within), drive).holds != expected(drive, lane, within)[name]
        for drive, lane, within in cases(400, 5)
    )


# --- Samples ------------------------------------------------------------------------------------------

DT, COUNT = Fraction(1, 10), 60
SIZES = "length", "width"


def on_samples(drive: Drive, lane: str, within: Fraction) -> dict[str, bool]:
    """The truth of definitions on samples: an entry is a last sample outside, an exit a first one."""
    times = [k * DT for k in range(COUNT)]
    inside = [is_inside(drive.vehicles["SV"], lane, x) for x in times]
    entries = [k for k in range(COUNT - 1) if inside[k + 1] and not inside[k]]
    exits = [k for k in range(1, COUNT) if inside[k - 1] and not inside[k]]
    last = int(within / DT)
    there = [is_inside(drive.vehicles["POV"], lane, x) for x in times]
    return {
        "entersLane(SV, L)": not inside[0] and bool(entries),
        "leavesLane(SV, L)": inside[0] and bool(exits),
        "entersSoon(SV, L)": not inside[0] and any(x < last for x in entries[:1]),
        "leavesSoon(SV, L)": inside[0] and any(x <= last for x in exits[:1]),
        "entersInViolation(SV, POV, L)": any(margin(drive, times[x]) >= 0 for x in entries),
        "leavesInViolation(SV, POV, L)": any(margin(drive, times[x]) >= 0 for x in exits),
        "entersAhead(SV, POV, L)": any(there[x] and is_ahead(drive, "SV", "POV", times[x]) for x in entries),
        "entersBehind(SV, POV, L)": any(there[x] and is_ahead(drive, "POV", "SV", times[x]) for x in entries),
    }


def batch_of(drive: Drive) -> Batch:
    vehicles = drive.vehicles.items()
    states = {x: [state_at(motion, k * DT) for k in range(COUNT)] for x, motion in vehicles}
    signals = {
        (name, x): np.array([[float(getattr(state, name))] for state in states[x]])
        for x in states
        for name in STARTING
    }
    sizes = {(n, x): np.array([float(getattr(motion, n))]) for x, motion in vehicles for n in SIZES}
    return Batch(DT, np.array([COUNT]), signals, sizes)


def is_near_by_rounding(drive: Drive) -> bool:
    """Whether rounding could decide at a sample: a box on a marking or behind another, or a violation."""
    for time in (k * DT for k in range(COUNT)):
        a, b = (state_at(x, time) for x in drive.vehicles.values())
        sides = [x.d - y for x in (a, b) for ends in SIDES.values() for y in (*ends, ends[1] + WIDTH)]
        places = [abs(a.s - b.s) - LENGTH, margin(drive, time)]
        if min(abs(float(x)) for x in (*sides, *places)) < 1e-6:
            return True
    return False


def test_definitions_mean_the_same_on_samples() -> None:
    seen = set()
    rng = random.Random(6)
    for exact, lane, _ in cases(some(120, 40), 6):
        drive = Drive({x: replace(y, d=y.d + Fraction(1, 97)) for x, y in exact.vehicles.items()})
        within = rng.randint(0, 40) * DT
        if is_near_by_rounding(drive):
            continue
        for text, holds in on_samples(drive, lane, within).items():
            formula = bound(text, lane, entryTime=within)
            answers = compile({"it": formula}).evaluate(batch_of(drive), "clip").answers["it"]
            assert bool(answers.true[0]) == holds, text
            seen.add((text, holds))
    assert len(seen) == 16


# --- No formula names the instant ---------------------------------------------------------------------


def random_text(rng: random.Random, depth: int) -> str:
    """A formula over one occupancy, with bounds that are multiples of a tenth of a second."""
    if not depth:
        return "atLane(SV, L)"
    low, more = rng.randint(0, 5), rng.randint(0, 9)
    interval = rng.choice(["", f"[{low * 100} ms, {(low + more) * 100} ms]"])
    one, two = random_text(rng, depth - 1), random_text(rng, rng.randint(0, depth - 1))
    formulas = (f"not {one}", f"({one} and not {two})", f"({one} or {two})", f"F{interval} {one}")
    longer = (f"G{interval} {one}", f"({one} U{interval} {two})", f"({two} U{interval} {one})")
    return rng.choice([*formulas, *longer])


def at(drive: Drive, text: str, time: Fraction) -> bool:
    return judge(bound(f"F[{time * 1000} ms, {time * 1000} ms] ({text})", LEFT), drive).holds


def test_no_formula_is_true_at_the_instant_of_entering_alone() -> None:
    """What holds at that instant holds shortly before, so no definition can be true at it alone."""
    rng, entry = random.Random(7), Fraction(2)
    start = SIDES[LEFT][0] - entry  # the left side is on the marking at 2 s, and the box does not leave again
    motion = Motion(LENGTH, WIDTH, Fraction(0), start, Fraction(30), Fraction(1), (
        Piece(Fraction(2), Fraction(0), Fraction(0)), Piece(Fraction(1), Fraction(0), Fraction(-1)),
        Piece(None, Fraction(0), Fraction(0)),
    ))  # fmt: skip
    drive, seen = Drive({"SV": motion}), set()
    for _ in range(some(400)):
        text = random_text(rng, rng.randint(1, 4))
        holds = at(drive, text, entry)
        assert at(drive, text, entry - Fraction(1, 1000)) == holds, text
        seen.add((holds, at(drive, text, entry + Fraction(1, 1000))))
    assert len(seen) == 4
    assert at(drive, f"d(SV) = {float(SIDES[LEFT][0])} m", entry)  # a position names it


# --- Claims -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("claim", "verdict"),
    [
        ("entersSoon(SV,L) -> entersLane(SV,L)", "PROVED"),
        ("leavesSoon(SV,L) -> leavesLane(SV,L)", "PROVED"),
        ("entersOnce(SV,L) -> not crossesLane(SV,L)", "PROVED"),
        ("changesLane(SV,L1,L2) -> leavesLane(SV,L1) and entersLane(SV,L2)", "PROVED"),
        ("entersInViolation(SV,POV,L) -> F entersLane(SV,L)", "PROVED"),
        ("leavesInViolation(SV,POV,L) -> F leavesLane(SV,L)", "PROVED"),
        ("entersLane(SV,L) and G rssViolation(SV,POV) -> entersInViolation(SV,POV,L)", "PROVED"),
        ("entersAhead(SV,POV,L) -> F (atLane(POV,L) and aheadOf(POV,SV) and entersLane(SV,L))", "PROVED"),
        ("entersLane(SV,L) -> entersSoon(SV,L)", "REFUTED"),
        ("scenario_1(SV,POV,L) -> entersInViolation(POV,SV,L)", "REFUTED"),
    ],
)  # fmt: skip
def test_definitions_relate_as_words_do(claim: str, verdict: str) -> None:
    assert rp.prove(claim, using=rp.load(specs=("entering",)), jobs=1, drive=False).verdict.value == verdict


def test_no_definition_asks_for_a_first_instant() -> None:
    for text in expected(random_drive(random.Random(1)), LEFT, Fraction(1)):
        formula = read_claim(HOME, f"given SV, POV: vehicle; L, M: lane: {text}").formula
        assert not first_instant_warnings(formula)
