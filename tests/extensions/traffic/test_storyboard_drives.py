"""Storyboards as drives: exact where the standard's motion has constant jerk, and close to it elsewhere."""

import random
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import roadproof as rp
from examples import some
from extensions.traffic.board import (
    EGO,
    at_time,
    event,
    init,
    lane,
    longitudinal,
    maneuver,
    put,
    to_lane,
    to_speed,
    when,
)
from roadproof.errors import InputError
from roadproof.extensions.exchange.storyboard.drives import StoryboardDrive, read_storyboard_drive
from roadproof.extensions.exchange.storyboard.stage import open_stage, run_stage
from roadproof.extensions.traffic.evaluate.one_trace import OneTrace
from roadproof.world.drive import Piece
from roadproof.world.motion import states_at

END = when(at_time(12), tag="StopTrigger")
NAMES = ("Ego", "Other")


def test_braking_is_a_drive_of_three_pieces(tmp_path: Path) -> None:
    """From 20 m/s at 2 s with 4 m/s² to 8 m/s at 5 s; nothing is approximated."""
    brake = event("brake", to_speed(8, "linear", "rate", 4), when(at_time(2)))
    found = read_storyboard_drive(put(tmp_path, {"Ego": EGO}, maneuver("Ego", brake), stop=END))
    ego = found.drive.vehicles["Ego"]
    merged: list[Piece] = []
    for piece in ego.pieces:
        if merged and merged[-1].a_lon == piece.a_lon and merged[-1].duration and piece.duration:
            merged[-1] = Piece(merged[-1].duration + piece.duration, piece.a_lon, piece.a_lat)
        else:
            merged.append(piece)
    assert [(x.duration, x.a_lon, x.a_lat, x.j_lon) for x in merged[:-1]] == [
        (2, 0, 0, 0),
        (3, -4, 0, 0),
        (7, 0, 0, 0),
    ]
    assert (ego.s, ego.d, ego.v_lon, ego.v_lat) == (102, -5, 20, 0)
    assert found.horizon == 12
    assert found.place_error < 1e-9
    assert found.speed_error < 1e-9


def test_a_speed_that_ends_between_ticks(tmp_path: Path) -> None:
    """From 20 m/s to 15 m/s with 3 m/s² in 5/3 s, known to a microsecond."""
    brake = event("brake", to_speed(15, "linear", "rate", 3), when(at_time(1)))
    found = read_storyboard_drive(put(tmp_path, {"Ego": EGO}, maneuver("Ego", brake), stop=END))
    (state,) = states_at(found.drive.vehicles["Ego"], [Fraction(10)])
    assert float(state.s) == pytest.approx(122 + 17.5 * 5 / 3 + 15 * (9 - 5 / 3), abs=1e-5)
    assert found.place_error < 1e-5


KEEP = longitudinal(
    '<LongitudinalDistanceAction entityRef="Ego" distance="20" freespace="true" continuous="true">'
    '<DynamicConstraints maxAcceleration="2" maxDeceleration="4" maxSpeed="40"/></LongitudinalDistanceAction>'
)
SHAPED = [
    to_speed(30, "cubic", "time", 4),
    to_speed(12, "sinusoidal", "rate", 3),
    to_lane('<AbsoluteTargetLane value="-1"/>', "cubic", "time", 3),
    to_lane('<AbsoluteTargetLane value="-3"/>', "sinusoidal", "distance", 70),
]


@pytest.mark.parametrize("action", SHAPED)
def test_other_shapes_are_close(action: str, tmp_path: Path) -> None:
    """At 997 instants, none of them a knot, against the storyboard's own motion."""
    path = put(tmp_path, {"Ego": EGO}, maneuver("Ego", event("go", action, when(at_time(1)))), stop=END)
    found = read_storyboard_drive(path)
    _, play = run_stage(open_stage(path))
    times = [Fraction(12 * k, 997) for k in range(1, 997)]
    for time, state in zip(times, states_at(found.drive.vehicles["Ego"], times), strict=True):
        there = play.state_at("Ego", float(time))
        assert float(state.s) - 2 == pytest.approx(there.s, abs=2e-4)
        assert float(state.d) - 1 == pytest.approx(there.d, abs=2e-4)
        assert float(state.v_lon) == pytest.approx(there.v_lon, abs=0.05)
        assert float(state.v_lat) == pytest.approx(there.v_lat, abs=0.05)
    assert 0 < found.place_error < 2e-4


@pytest.mark.parametrize(
    ("action", "told"),
    [
        (to_speed(10, "step"), "the speed jumps; in dense time"),
        (to_lane('<AbsoluteTargetLane value="-1"/>', "linear"), "the speed across jumps"),
        (to_lane('<AbsoluteTargetLane value="-1"/>', "step"), "at 3 s: in dense time every vehicle"),
    ],
)
def test_jumps_are_refused(action: str, told: str, tmp_path: Path) -> None:
    go = event("go", action, when(at_time(3)))
    path = put(tmp_path, {"Ego": EGO}, maneuver("Ego", go), stop=END)
    with pytest.raises(InputError) as error:
        read_storyboard_drive(path)
    assert told in str(error.value)
    assert "vehicle Ego at" in str(error.value)


def storyboard(folder: Path, seed: int) -> Path:
    """Two vehicles with up to three random events each."""
    chance = random.Random(seed)
    groups = []
    for name in NAMES:
        events = []
        for k in range(chance.randint(1, 3)):
            shape, by = chance.choice(["linear", "cubic", "sinusoidal"]), chance.choice(["time", "rate"])
            speed = to_speed(chance.randint(8, 32), shape, by, chance.randint(2, 5))
            side = f'<AbsoluteTargetLane value="-{chance.randint(1, 3)}"/>'
            change = to_lane(side, chance.choice(["cubic", "sinusoidal"]), "time", chance.randint(2, 5))
            actions = [speed, change] + [KEEP] * (name == "Other")
            begin = when(at_time(3 * k + chance.randint(0, 2)))
            events.append(event(f"{name} {k}", chance.choice(actions), begin))
        groups.append(maneuver(name, *events))
    ahead, far = chance.randint(40, 160), chance.randint(10, 30)
    placed = {"Ego": EGO, "Other": init("Other", lane(-chance.randint(1, 3), ahead), far)}
    return put(folder, placed, *groups, stop=END, hdg=0)


def refined(path: Path, found: StoryboardDrive) -> OneTrace:
    """The storyboard's own motion, 100 samples a second."""
    _, play = run_stage(open_stage(path))
    columns: dict[str, list[object]] = {}
    for tick, states in enumerate(play.states):
        for name, state in states.items():
            row = {
                "time": tick / 100,
                "vehicle": name,
                "s": state.s + 2,
                "d": state.d + 1,
                **{x: getattr(state, x) for x in ("v_lon", "v_lat", "a_lon", "a_lat")},
                "length": 4.0,
                "width": 2.0,
            }
            for key, value in row.items():
                columns.setdefault(key, []).append(value)
    return rp.trace({x: np.array(y) for x, y in columns.items()}, found.road)


FORMULAS = [
    "F[0, 10 s] (v_lon(Ego) < 15 m/s and v_lon(Other) > 20 m/s)",
    "F[0, 10 s] danger(Ego, Other)",
    "G[0, 5 s] not danger(Other, Ego)",
    "(v_lon(Ego) > 18 m/s) U[0, 8 s] (s(Other) > s(Ego))",
    "F[1 s, 9 s] (d(Ego) > d(Other) + 1 m and v_lat(Ego) <= 0 m/s)",
    "F[0, 4 s] G[0, 3 s] (v_lon(Other) > v_lon(Ego))",
]


def test_exact_verdicts_are_those_of_refined_samples(tmp_path: Path) -> None:
    """Where the samples hold or fail by more than a hundredth, so that the time between them has no say."""
    compared, jumps, tried = {"true": 0, "false": 0}, 0, some(10, least=4)
    for seed in range(tried):
        folder = tmp_path / str(seed)
        folder.mkdir()
        path = storyboard(folder, seed)
        try:
            found = read_storyboard_drive(path)
        except InputError as error:  # a lane change that another one ends
            if "the speed across jumps" not in str(error):
                raise
            jumps += 1
            continue
        samples = refined(path, found)
        for formula in FORMULAS:
            exact = rp.monitor(formula, path, view="dense")
            sampled = rp.monitor(formula, samples)
            if sampled.verdict != "undecided" and min(map(abs, sampled.robustness)) > 0.01:
                assert exact.verdict == sampled.verdict, (seed, formula)
                compared[sampled.verdict] += 1
    assert min(compared.values()) >= tried
    assert jumps < tried / 2


def test_it_says_how_close_it_is_and_what_follows(tmp_path: Path) -> None:
    path = put(tmp_path, {"Ego": EGO, "Other": init("Other", lane(-1, 90), 25)}, stop=END)
    found = rp.monitor("F (s(Other) > s(Ego) + 500 m)", path, view="dense")
    assert found.verdict == "true"
    assert rp.monitor("F (s(Other) > s(Ego) + 500 m)", path).verdict == "undecided"
    assert "in dense time vehicles then go on with constant speeds" in found.notes[-1]
    with pytest.raises(rp.UsageError, match="omit --road"):
        rp.monitor("true", path, view="dense", road="main-2")
