"""Storyboards against esmini: its positions, recorded by ``esmini_record.py``, within 5 cm.

esmini differs on purpose, and its conventions are put into the reader's motion before they are compared:

- A speed is that of the vehicle on its way (ASAM OpenSCENARIO XML 1.3, SpeedAction). The reader takes it
  along the s axis of the road, which is shorter where a vehicle changes lanes, and longer or shorter beside
  the axis of a bend (limits.md, "Bends").
- esmini moves a step with the speed at its end, the reader with the exact integral: half a step times the
  change of speed.
  LaneOffsetActions and trajectories take both alike.
- What is done in no time (steps, teleports, the first point of a trajectory) shows a step of 0.01 s later.
"""

import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from extensions.traffic.storyboards import BOARDS, CURVATURE, files
from roadproof.extensions.exchange.storyboard.conditions import TICKS
from roadproof.extensions.exchange.storyboard.play import Play
from roadproof.extensions.exchange.storyboard.positions import ObjectState, Positions, positions_on
from roadproof.extensions.exchange.storyboard.stage import open_stage, run_stage

NEAR = 0.05
"""m"""
LATER = {"trigger off the road": 0.1, "clothoid after clothoid": 0.22}
"""m, where esmini sees a step of 0.01 s earlier or later that a condition holds."""
ON_BENDS = 0.35
"""m, for triggers on bends: distances there change at other rates where speeds are taken along s."""
FEWEST = 80
SAME = ("LaneOffsetAction", "FollowTrajectoryAction")


@cache
def kept() -> Any:
    return json.loads(Path(__file__).with_name("esmini.json").read_text("utf-8"))


def ways(play: Play, name: str, curvature: float, lags: bool) -> list[tuple[float, float]]:
    """By tick, how far s lags behind with speeds on the way, if it ``lags``, and the change of speed."""
    found, lag, begin = list[tuple[float, float]](), 0.0, 0.0
    for tick, states in enumerate(play.states):
        state = states.get(name)
        if state is None:
            found.append((lag, 0.0))
            continue
        if lags and tick and name in play.states[tick - 1]:
            before = play.states[tick - 1][name]
            v, side = abs(before.v_lon), before.v_lat
            along = math.sqrt(max(v * v - side * side, 0.0)) / (1 - curvature * before.d)
            lag += (v - along) * math.copysign(1 / TICKS, before.v_lon)
        begin = begin or state.v_lon
        found.append((lag, state.v_lon - begin))
    return found


def places(
    positions: Positions, state: ObjectState, way: tuple[float, float], late: float
) -> list[tuple[float, float]]:
    """The reader's place ``late`` s later in esmini's convention, with and without half a step."""
    lag, change = way[0] - late * state.v_lon, way[1]
    found = []
    for more in (change / TICKS / 2, 0.0):
        moved = ObjectState(state.s - lag + more, state.d, 0, 0, 0, 0, state.forward)
        found.append(positions.pose_of(moved)[:2])
    return found


@pytest.mark.parametrize("name", BOARDS)
def test_positions_are_those_of_esmini(name: str, tmp_path: Path) -> None:
    stage, play = run_stage(open_stage(files(tmp_path, name)))
    assert stage.document.left_out() == ()
    positions = positions_on(stage.document, stage.road)
    bend = BOARDS[name][2] == "bend"
    lags = not any(x in y for x in SAME for part in (BOARDS[name][1], BOARDS[name][0].values()) for y in part)
    near = ON_BENDS if bend and name.startswith("trigger") else LATER.get(name, NEAR)
    compared = 0
    for vehicle, rows in kept()["boards"][name].items():
        way = ways(play, vehicle, CURVATURE if bend else 0.0, lags)
        jumped = False
        for k, (x, y, _) in enumerate(rows):
            tick = round(k * kept()["made"]["every"] * TICKS)
            ticks = [t for t in (tick, tick - 1) if 0 <= t < len(play.states) and vehicle in play.states[t]]
            jumps = len(ticks) == 2 and _jumps(play, vehicle, tick)
            jumped = jumped or jumps
            here = [
                math.dist((x, y), place)
                for t in (ticks if jumped else ticks[:1])
                for late in ((tick - t) / TICKS, 0.0)
                for place in places(positions, play.states[t][vehicle], way[t], late)
            ]
            assert here, f"{vehicle} is not on the road at {tick / TICKS} s"
            assert min(here) <= near, (vehicle, tick / TICKS, min(here))
            compared += 1
    assert compared > 20


def _jumps(play: Play, name: str, tick: int) -> bool:
    one, other = play.states[tick - 1][name], play.states[tick][name]
    gone = abs(one.v_lon) / TICKS
    return abs(other.s - one.s) > gone + 0.1 or abs(other.d - one.d) > 0.1


def test_every_storyboard_was_run_by_esmini() -> None:
    assert {*kept()["boards"]} == {*BOARDS}
    assert len(BOARDS) >= FEWEST
    assert kept()["made"]["esmini"] == "3.6.0"


def test_vehicles_of_storyboards_do_something() -> None:
    """Each trigger fires in esmini, and not at once: otherwise its comparison would show nothing."""
    for name, vehicles in kept()["boards"].items():
        if name.startswith("trigger") and name != "trigger headway to one behind":
            speeds = [v for _, _, v in vehicles["Ego"]]
            assert speeds[1] == pytest.approx(20), name
            assert speeds[-1] < 18, name
