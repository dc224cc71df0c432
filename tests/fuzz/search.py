"""Drives that exist, asked for: the engines must not say that there is none.

A drive of the class that a NONE-WITHIN speaks of is made first, then a formula that is true on it. A drive
that the search finds is judged again from its file, and by a reading in floats.
"""

import random
from collections import Counter
from dataclasses import replace
from fractions import Fraction

from hypothesis import strategies as st
from judge.pinning import disagreement_on_drive

from fuzz.case import Disagreement
from roadproof.encode.place import rectangles
from roadproof.errors import UsageError
from roadproof.evidence.witness import from_json, judge_file
from roadproof.judge import judge
from roadproof.judge.replay import first_breach, first_overlap
from roadproof.spec.bind import bind, default_values
from roadproof.spec.elaborate import read_claim
from roadproof.spec.library import bundled_library
from roadproof.verdict import Verdict
from roadproof.witness.ask import Request, ask
from roadproof.witness.question import Means
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.models import load_road, load_vehicle
from roadproof.world.motion import state_at

DT, STEPS, REACH = Fraction(3, 5), 2, Fraction(80)
CHUNK = 10
SECONDS = 10.0
ROADS = ("main-2", "merge", "depart")
LIBRARY = bundled_library()
VALUES = default_values(LIBRARY)

notes: Counter[str] = Counter()

_vehicles = st.sampled_from(["SV", "POV"])
_ops = st.sampled_from(["<", "<=", ">", ">="])
_numbers = st.integers(-10, 60)
_atoms = st.one_of(
    st.builds("s({}) {} {} m".format, _vehicles, _ops, _numbers),
    st.builds("v_lon({}) {} {} m/s".format, _vehicles, _ops, st.integers(14, 41)),
    st.builds("d({}) {} {} m".format, _vehicles, _ops, st.integers(1, 8)),
    st.builds("a_lon({}) {} {} m/s^2".format, _vehicles, _ops, st.integers(-6, 3)),
    st.builds("s(SV) - s(POV) {} {} m".format, _ops, _numbers),
    st.sampled_from(["inMergeZone(SV)", "inDepartZone(POV)", "onMainRoad(SV)", "atLane(POV,L)", "sameLane(SV,POV,L)"]),
    st.sampled_from(["aheadOf(SV,POV)", "fasterThan(SV,POV)", "rssViolation(SV,POV)", "decelerates(POV)"]),
)
_windows = st.sampled_from(["", "[0, 0.6 s]", "[0.6 s, 1.2 s]", "[0.6 s, inf]", "[1.2 s, 1.2 s]"])
_formulas = st.recursive(
    _atoms,
    lambda inner: st.one_of(
        st.builds("not ({})".format, inner),
        st.builds("({}) and ({})".format, inner, inner),
        st.builds("({}) or ({})".format, inner, inner),
        st.builds("F{} ({})".format, _windows, inner),
        st.builds("G{} ({})".format, _windows, inner),
        st.builds("({}) U{} ({})".format, inner, _windows, inner),
    ),
    max_leaves=4,
)
cases = st.tuples(_formulas, st.sampled_from(ROADS), st.integers(0, 10**6), st.sampled_from(["milp", "smt"]))
"""(formula, road, seed of a drive, engine)."""


def check(case: tuple[str, str, int, str]) -> int:
    """1 where the engine answered about a formula that is true on a drive of its class."""
    words, road, seed, engine = case
    drive = random_drive(road, seed)
    specification = LIBRARY.select("base")
    lane = load_road(road).lanes[0]
    query = read_claim(specification, f"({words}) and v_lon(SV) > 0 m/s and v_lon(POV) > 0 m/s")
    lanes = {"L": lane} if "L" in query.lanes else {}
    if not judge(bind(query.formula, load_road(road), lanes, VALUES), drive).holds:
        words = f"not ({words})"
    text = f"({words}) and v_lon(SV) > 0 m/s and v_lon(POV) > 0 m/s"
    means = Means("any", engine=engine, time_limit=SECONDS, refinements=0)
    request = Request(text, values=VALUES, road=road, lanes=lanes, horizon=DT * STEPS, dt=DT, reach=REACH)
    try:
        outcome = ask(replace(request, natural=False, means=means))
    except UsageError:
        return 0
    notes[str(outcome.verdict)] += 1
    if outcome.verdict in (Verdict.NONE_WITHIN, Verdict.IMPOSSIBLE):
        raise Disagreement(f"{outcome.verdict}, but {shown(drive)} is one: {text}", case)
    if outcome.verdict is not Verdict.WITNESSED:
        return 0
    file = from_json(outcome.drives[0], "drive")
    if not judge_file(file, LIBRARY).accepted:
        raise Disagreement(f"a drive is handed out that is judged none: {text}", case)
    bound = bind(read_claim(specification, text).formula, load_road(road), file.lanes, VALUES)
    if disagreement_on_drive(bound, file.drive) not in (None, "doubtful"):
        raise Disagreement(f"a drive is handed out that floats say is none: {text}", case)
    return 1


def random_drive(road: str, seed: int) -> Drive:
    """A drive of the class: on the road all the time, apart, within limits, settled after the last sample."""
    rng = random.Random(f"{road} {seed}")
    while True:
        ahead = Fraction(rng.randint(-60, 320))
        gap = Fraction(rng.randint(-79, 79))
        drive = Drive({"SV": _motion(rng, ahead), "POV": _motion(rng, ahead + gap)})
        if keeps_the_rules(drive, road):
            return drive


def _motion(rng: random.Random, front: Fraction) -> Motion:
    car = load_vehicle("car")
    side = rng.choice([Fraction(rng.randint(19, 69), 10), Fraction(rng.randint(1, 7) * 35, 10) - Fraction(1, 2)])
    across = [Fraction(rng.randint(-2, 2), 2) for _ in range(STEPS)] if rng.random() < 0.5 else [Fraction(0)] * STEPS
    along = [Fraction(rng.randint(-12, 6), 2) for _ in range(STEPS)]
    pieces = [Piece(DT, a, b) for a, b in zip(along, across, strict=True)]
    drift = -sum(across, Fraction(0)) * DT
    speed = Fraction(rng.randint(16, 39))
    return Motion(car.length, car.width, front, side, speed, drift, (*pieces, Piece(None, Fraction(0), Fraction(0))))


def keeps_the_rules(drive: Drive, road: str) -> bool:
    """Within the limits of cars, apart up to the horizon, and in one rectangle of the road in each step."""
    limits = dict.fromkeys(drive.vehicles, load_vehicle("car"))
    if first_breach(drive, limits, None) is not None or first_overlap(drive, DT * STEPS) is not None:
        return False
    return all(stays_on(road, motion) for motion in drive.vehicles.values())


def stays_on(road: str, motion: Motion) -> bool:
    corners = [state_at(motion, k * DT) for k in range(STEPS + 1)]

    def inside(state, place, for_ever=False):
        (low, high), (right, left) = place
        along = (low is None or state.s - motion.length >= low) and (high is None or state.s <= high)
        across = right + motion.width <= state.d <= left
        return along and across and (not for_ever or (high is None and state.v_lat == 0))

    places = rectangles(load_road(road).lanelets)
    steps = all(
        any(inside(corners[k], place) and inside(corners[k + 1], place) for place in places) for k in range(STEPS)
    )
    return steps and any(inside(corners[-1], place, for_ever=True) for place in places)


def shown(drive: Drive) -> str:
    return "; ".join(
        f"{name}: s={m.s} d={m.d} v=({m.v_lon}, {m.v_lat}) a="
        + " ".join(f"({p.a_lon}, {p.a_lat})" for p in m.pieces[:-1])
        for name, m in drive.vehicles.items()
    )
