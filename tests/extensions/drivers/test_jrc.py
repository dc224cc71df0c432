"""The fuzzy safety model against recorded results of the public implementation, in drives and in samples.

There the leader moves at its new speed from each look on; it does so here, too.
"""

import json
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from extensions.drivers.read import specification, values
from planting import plant
from roadproof.extensions.drivers import fuzzy, fuzzy_looks
from roadproof.extensions.drivers.driver_settings import DriverSettings
from roadproof.extensions.drivers.driving import drive_of, road_of
from roadproof.extensions.drivers.manoeuvres import KMH, MANOEUVRES, Manoeuvre
from roadproof.extensions.drivers.outcome import Outcome, Result
from roadproof.extensions.drivers.replay import replay
from roadproof.extensions.drivers.sampled_replay import SampledScene, Track, replay_samples
from roadproof.extensions.drivers.stepped import course_of
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.motion import states_at

ROWS = json.loads(Path(__file__).with_name("jrc_fsm.json").read_text("utf-8"))["rows"]
ROUNDING = 0.006  # m: gaps are told to a centimetre
HALF = F(1, 20)  # s: so much later a leader stands that brakes steadily, and not in steps
_NONE = F(0)
_LOOK, _JUMP = F(1, 10), F(1, 10**5)  # s
SETTINGS = DriverSettings(values(), specification().options)


def place(row: Mapping[str, Any]) -> tuple[Manoeuvre, dict[str, F]]:
    kind = MANOEUVRES[row["kind"]]
    given = {x: F(str(row[x])) for x in ("Gx", "Vy", "dx0") if x in row}
    return kind, kind.values({**given, **{x: row[x] * KMH for x in ("Ve0", "dV0")}})


def drive(row: Mapping[str, Any]) -> Drive:
    """SV goes straight on; POV does as there."""
    kind, at = place(row)
    made = drive_of(kind, "rss", at, SETTINGS)
    mine, its = made.vehicles["SV"], made.vehicles["POV"]
    if "Gx" in row:
        its = in_steps(its, F(row["Gx"]))
    return Drive({"SV": replace(mine, v_lat=_NONE, pieces=(Piece(None, _NONE, _NONE),)), "POV": its})


def in_steps(motion: Motion, braking: F) -> Motion:
    pieces, speed = list[Piece](), motion.v_lon
    while speed > 0:
        less = min(speed, braking * _LOOK)
        pieces += [Piece(_JUMP, -less / _JUMP, _NONE), Piece(_LOOK - _JUMP, _NONE, _NONE)]
        speed -= less
    return replace(motion, pieces=(*pieces, Piece(None, _NONE, _NONE)))


def outcome_of(row: Mapping[str, Any]) -> Outcome:
    kind, at = place(row)
    road = road_of(kind, at)
    return replay(drive(row), road, kind.vehicles, kind.name, "fsm", _NONE, specification(), SETTINGS).outcome


def in_samples(row: Mapping[str, Any], step: F = F(1, 100), seconds: int = 20) -> Outcome:
    kind, at = place(row)
    times = [k * step for k in range(int(seconds / step) + 1)]
    tracks = {}
    for name, motion in drive(row).vehicles.items():
        states = states_at(motion, times)
        columns = (
            np.array([float(getattr(x, signal)) for x in states])
            for signal in ("s", "d", "v_lon", "v_lat", "a_lon")
        )
        tracks[name] = Track(*columns, float(motion.length), float(motion.width))
    scene = SampledScene(tracks, road_of(kind, at), kind.vehicles, step, 0)
    return replay_samples(scene, kind.name, "fsm", SETTINGS)


def check(rows: list[dict[str, Any]]) -> None:
    for row in rows:
        found = outcome_of(row)
        if row["passed"] and not (row["crash"] or row["hit_beside"]):
            assert found.result is Result.UNDECIDED, row
        elif row["crash"] or row["hit_beside"]:
            assert found.result is Result.COLLIDES, row
        else:
            assert found.result is Result.PREVENTED, row
            assert found.gap is not None, row
            assert abs(found.gap - row["least"]) < ROUNDING, (row, found.gap)


def test_drives_end_as_recorded() -> None:
    check(ROWS[::6])


def test_all_drives_end_as_recorded() -> None:
    check(ROWS)


def test_samples_end_as_recorded() -> None:
    for row in ROWS[::9]:
        found = in_samples(row)
        assert (found.result is Result.COLLIDES) is (row["crash"] or row["hit_beside"]), row
        if row["least"] is not None:
            assert found.gap is not None, row
            assert abs(found.gap - row["least"]) < 0.4, (row, found.gap)


def test_places_of_plates_are_on_the_recorded_side() -> None:
    """Of 366 one is on the other side, by less than half of a look: on plates POV brakes steadily."""
    others = []
    for row in ROWS:
        kind, at = place(row)
        if course_of(kind, at, to_the_end=False).touches is not (row["crash"] or row["hit_beside"]):
            others.append(row)
    assert len(others) <= 1
    for row in others:
        kind, at = place(row)
        nearer = {**at, "dx0": at["dx0"] - at["Ve0"] * HALF}
        assert row["crash"], row
        assert course_of(kind, nearer, to_the_end=False).touches, row


def test_decelerations_to_a_stand_are_prevented() -> None:
    """From 108 km/h, as fast as POV: 18 of 18, with what is left."""
    places = [
        {"kind": "deceleration", "Ve0": 108, "dV0": 0, "Gx": x, "dx0": gap}
        for x in (4, 6, 8)
        for gap in (100, 120, 140, 160, 180, 200)
    ]
    for row in places:
        kind, at = place(row)
        assert not course_of(kind, at, to_the_end=False).touches, row
    left = [outcome_of(row).gap for row in places[::3]]
    assert all(x is not None and 0.3 < x < 4 for x in left), left


def test_a_leader_that_brakes_steadily_leaves_nearly_the_same_gap() -> None:
    seen = 0
    for row in ROWS[:96:7]:
        if row["least"] is None:
            continue
        kind, at = place(row)
        steady = drive_of(kind, "rss", at, SETTINGS).vehicles["POV"]
        made = Drive({**drive(row).vehicles, "POV": steady})
        found = replay(
            made, road_of(kind, at), kind.vehicles, kind.name, "fsm", _NONE, specification(), SETTINGS
        ).outcome
        assert found.gap is not None
        assert abs(found.gap - row["least"]) <= at["Ve0"] * HALF, (row, found.gap)
        seen += 1
    assert seen >= 8


@pytest.mark.parametrize(
    ("owner", "name", "right", "wrong"),
    [
        (fuzzy, "step", "-braking / HERTZ / CHANGE", "-braking / HERTZ / CHANGE / 2"),
        (
            fuzzy_looks._Controlled,
            "look",
            "self._speed / HERTZ +",
            "(self._speed + self._braking / HERTZ) / HERTZ +",
        ),
        (fuzzy_looks._Controlled, "is_over", "now.me.length > now.other.s", "now.me.length < now.other.s"),
        (fuzzy_looks._Controlled, "is_over", "self._speed <= now.its_speed", "self._speed >= now.its_speed"),
    ],
)
def test_planted_faults_are_seen(
    monkeypatch: pytest.MonkeyPatch, owner: object, name: str, right: str, wrong: str
) -> None:
    plant(monkeypatch, owner, name, right, wrong)
    if name == "step":
        monkeypatch.setattr(fuzzy_looks, "step", fuzzy.step)
    with pytest.raises((AssertionError, ValueError)):
        check(ROWS[::6])
