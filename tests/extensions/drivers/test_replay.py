"""Driver models put into random tests, drives and samples, against a simulation that shares nothing.

A verdict may differ only where a step decides: where the simulation itself has another one after SV is a
little nearer or farther, or responds a step later.
"""

import math
import os
from fractions import Fraction as F
from random import Random

import numpy as np
import pytest

from extensions.drivers.read import specification, values
from extensions.drivers.simulated import Car, Case, Found, Simulation
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.models import MODELS
from roadproof.extensions.drivers.outcome import Outcome
from roadproof.extensions.drivers.replay import replay
from roadproof.extensions.drivers.sampled_replay import SampledScene, Track, replay_samples
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.motion import piece_starts
from roadproof.world.road import Lanelet, Road, adjacency

LANES = ((F(0), F("3.5")), (F("3.5"), F(7)))
ROAD = Road(
    "two",
    tuple(Lanelet(x, x, "main", "main", (None, None), lane) for x, lane in zip("RL", LANES, strict=True)),
    adjacency([("R", "L")]),
)
SEVERAL, FEW = 12, 4  # tests of a manoeuvre; of the fuzzy safety model, whose simulation takes longer
MANY = int(os.environ.get("ROADPROOF_RANDOM_TESTS", "200"))  # of a model as drives, and as samples
RATE = 25
LOOKED = 0.61  # m/s: what the fuzzy safety model brakes from look to look
OPTIONS: tuple[dict[str, str], ...] = (
    {},
    {"cc_perception": "distance"},
    {"cc_perception": "overlap"},
    {"cc_gate": "before_perception"},
    {"cc_gate": "before_delay"},
    {"cc_threshold": "hard"},
    {"cc_aeb": "max"},
    {"cc_aeb": "add"},
    {"cc_aeb": "replace"},
)
_NONE = F(0)
Rows = list[tuple[F, F, F, F]]


class Maker:
    """Random tests; all durations are whole milliseconds."""

    def __init__(self, seed: object) -> None:
        self.random = Random(str(seed))

    def between(self, low: float, high: float, places: int = 2) -> F:
        return F(round(self.random.uniform(low, high) * 10**places), 10**places)

    def seconds(self, low: float, high: float) -> F:
        return self.between(low, high, 3)

    def sideways(self, way: F) -> Rows:
        """A lane change by ``way`` m: smooth, or at a steady speed."""
        if self.random.random() < 0.5:
            half = self.seconds(0.8, 3)
            return [(half, _NONE, _NONE, way / half**2), (half, _NONE, _NONE, -way / half**2)]
        steer, steady = self.seconds(0.05, 0.5), self.seconds(0.5, 6)
        speed = way / (steer + steady)
        return [
            (steer, _NONE, _NONE, speed / steer),
            (steady, _NONE, _NONE, _NONE),
            (steer, _NONE, _NONE, -speed / steer),
        ]

    def braking(self, speed: F) -> Rows:
        """At once or with a jerk; to a stand, or for some time."""
        if speed < 2:
            return []
        if self.random.random() < 0.5:
            lasts = self.seconds(float(speed) / 10, float(speed) / 1.5)
            rows = [(lasts, -speed / lasts, _NONE, _NONE)]
            if self.random.random() < 0.3:
                rows = [(min(lasts, F(1)), -speed / lasts, _NONE, _NONE)]
            return rows
        ramp = self.seconds(0.2, 1)
        steady = self.seconds(float(speed) / 9, float(speed) / 2)
        full = speed / (ramp / 2 + steady)
        return [(ramp, _NONE, -full / ramp, _NONE), (steady, -full, _NONE, _NONE)]

    def own(self, speed: F) -> Rows:
        """What SV does in the test."""
        kind = self.random.random()
        before = [(self.seconds(0.1, 3), _NONE, _NONE, _NONE)]
        if kind < 0.5:
            return []
        if kind < 0.8:
            return before + self.braking(speed)
        return [*before, (self.seconds(0.2, 1), self.between(0.1, 1.5), _NONE, _NONE)]

    def test(self, manoeuvre: str) -> tuple[Drive, dict[str, tuple[F, F]]]:
        speed, wait = self.between(8, 38), [(self.seconds(0.05, 1.5), _NONE, _NONE, _NONE)]
        mine, its = self.random.sample(LANES, 2)
        width, length = self.between(1.6, 2.2), self.between(3.8, 5)
        widths, lengths = self.between(1.6, 2.2), self.between(3.8, 5)
        vehicles = {"SV": motion(F(0), mid(mine, width), speed, self.own(speed), length, width)}
        other = max(F(1), speed - self.between(-2, 14))
        match manoeuvre:
            case "cut-in":
                rows = wait + self.sideways(mid(mine, widths) - mid(its, widths))
                if self.random.random() < 0.3:
                    rows += self.braking(other)
                gap = self.between(2, 60)
                vehicles["POV"] = motion(gap + lengths, mid(its, widths), other, rows, lengths, widths)
                return Drive(vehicles), {"own": mine, "its": its}
            case "deceleration":
                gap = self.between(5, 80)
                rows = wait + self.braking(other)
                vehicles["POV"] = motion(gap + lengths, mid(mine, widths), other, rows, lengths, widths)
            case _:
                rows = wait + self.sideways(mid(its, widths) - mid(mine, widths))
                gap, more = self.between(10, 60), self.between(10, 120)
                vehicles["POV1"] = motion(gap + lengths, mid(mine, widths), speed, rows, lengths, widths)
                slow = self.between(0, max(0.0, float(speed) - 4))
                place = gap + lengths + more + length
                vehicles["POV2"] = motion(place, mid(mine, width), slow, [], length, width)
        return Drive(vehicles), {"own": mine, "its": mine}


def mid(lane: tuple[F, F], width: F) -> F:
    return (lane[0] + lane[1] + width) / 2


def motion(s: F, d: F, v: F, rows: Rows, length: F, width: F) -> Motion:
    pieces = tuple(Piece(lasts, a, lateral, jerk) for lasts, a, jerk, lateral in rows)
    return Motion(length, width, s, d, v, _NONE, (*pieces, Piece(None, _NONE, _NONE)))


def case_of(manoeuvre: str, drive: Drive, lanes: dict[str, tuple[F, F]], since: F) -> Case:
    def car(x: Motion) -> Car:
        rows = tuple(
            (float(p.duration), float(p.a_lon), float(p.j_lon), float(p.a_lat))
            for p in x.pieces
            if p.duration is not None
        )
        return Car(*map(float, (x.s, x.d, x.v_lon, x.v_lat)), rows, float(x.length), float(x.width))

    edges = {name: (float(a), float(b)) for name, (a, b) in lanes.items()}
    return Case(manoeuvre, tuple(map(car, drive.vehicles.values())), edges["own"], edges["its"], float(since))


def track_of(x: Motion) -> Track:
    """40 s of samples; pieces are floats from their exact first states on."""
    times = np.arange(40 * RATE) / RATE
    starts = piece_starts(x)
    which = np.searchsorted([float(y.time) for y in starts], times + 1e-12, "right") - 1
    s, d, v, u, a, across, jerk, begin = (
        np.array([float(getattr(y, name)) for y in starts])[which]
        for name in ("s", "d", "v_lon", "v_lat", "a_lon", "a_lat", "j_lon", "time")
    )
    t = times - begin
    return Track(
        s + v * t + a * t**2 / 2 + jerk * t**3 / 6,
        d + u * t + across * t**2 / 2,
        v + a * t + jerk * t**2 / 2,
        u + across * t,
        a + jerk * t,
        float(x.length),
        float(x.width),
    )


def replayed(
    manoeuvre: str, model: str, drive: Drive, since: F, settings: DriverSettings, in_samples: bool
) -> Outcome:
    vehicles = tuple(drive.vehicles)
    if not in_samples:
        return replay(drive, ROAD, vehicles, manoeuvre, model, since, HOME, settings).outcome
    tracks = {name: track_of(x) for name, x in drive.vehicles.items()}
    scene = SampledScene(tracks, ROAD, vehicles, F(1, RATE), math.ceil(since * RATE))
    return replay_samples(scene, manoeuvre, model, settings)


HOME = specification()


def check(manoeuvre: str, model: str, k: int, in_samples: bool = False) -> str:
    """Return the verdict of a random test, which is that of the simulation; or that this is divided."""
    maker = Maker((manoeuvre, model, k))
    drive, lanes = maker.test(manoeuvre)
    since = F(maker.random.randrange(0, 25), 25)
    options = maker.random.choice(OPTIONS) if model == "careful" else {}
    settings = DriverSettings(values(), {**HOME.options, **options})
    case = case_of(manoeuvre, drive, lanes, since)
    step = 1 / RATE if in_samples else 0.002
    near = step * 25 + 0.02
    found: list[Found] = [
        Simulation(case, nearer=x).run(model, options, late)
        for x in (0, near, -near)
        for late in ((0,) if model == "fsm" and manoeuvre != "cut-out" else (0, step, -step))
    ]
    if len({x.word for x in found}) > 1 or found[0].word == "later":
        return "divided"
    made = replayed(manoeuvre, model, drive, since, settings, in_samples)
    place = (manoeuvre, model, k, options, made, found)
    assert made.result == found[0].word, place
    if made.gap is not None or found[0].gap is not None:
        gaps = [x.gap for x in found if x.gap is not None]
        assert made.gap is not None, place
        assert min(gaps) - 0.02 <= made.gap <= max(gaps) + 0.02, place
    if made.instant is not None and made.speed is not None:
        instants = [x.time for x in found if x.time is not None]
        assert min(instants) - step <= made.instant <= max(instants) + step, place
        speeds = [x.faster for x in found if x.faster is not None]
        room = 12 * step + (LOOKED if MODELS[model].is_stepped else 0.01)
        assert min(speeds) - room <= made.speed <= max(speeds) + room, place
    return made.result


EACH = [(x, model.name) for model in MODELS.values() for x in model.manoeuvres]


@pytest.mark.parametrize("in_samples", [False, True])
@pytest.mark.parametrize(("manoeuvre", "model"), EACH)
def test_random_tests(manoeuvre: str, model: str, in_samples: bool) -> None:
    number = FEW if MODELS[model].is_stepped else SEVERAL
    seen = [check(manoeuvre, model, k, in_samples) for k in range(number)]
    assert seen.count("divided") < 0.5 * len(seen)


@pytest.mark.parametrize("in_samples", [False, True])
def test_what_is_in_the_lane_already_is_perceived(in_samples: bool) -> None:
    """POV has its middle in SV's lane when the scenario begins: it comes from the lane beside it."""
    assert check("cut-in", "careful", 574, in_samples) == "prevented"


@pytest.mark.parametrize("in_samples", [False, True])
@pytest.mark.parametrize(("manoeuvre", "model"), EACH)
def test_many_random_tests(manoeuvre: str, model: str, in_samples: bool) -> None:
    spoken = len(MODELS[model].manoeuvres)
    seen = [check(manoeuvre, model, k, in_samples) for k in range(-(-MANY // spoken))]
    assert {"prevented", "collides"} <= {*seen}
