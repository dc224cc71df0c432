"""Drives out of given pieces: what comes out of the judge is what any evidence is."""

import json
from fractions import Fraction as F
from pathlib import Path

import pytest

import roadproof as rp
from roadproof.evidence.judged import JudgedDrive
from roadproof.frontends.api.driving import drive, motion
from roadproof.world.drive import Motion

BRAKING = [(1, 0, -4), (2, -4, 0), (1, -4, 4)]
"""Braking that builds up to 4 m/s², is held for 2 s and goes away again, which takes 12 m/s."""


def pair() -> dict[str, Motion]:
    return {"SV": motion(0, 2.6, 29), "POV": motion(80, 2.8, 28, along=BRAKING)}


def test_a_given_drive_is_judged_and_can_be_checked(tmp_path: Path) -> None:
    made = drive(4, pair(), using=rp.load("ext", params={"minDanger": 1}))
    assert (made.file.scenario, made.file.set_name, made.file.lanes) == (4, "ext", {"L": "main-1"})
    assert made.file.values["minDanger"] == 1
    assert made.judgement.holds
    path = tmp_path / "drive.json"
    path.write_text(json.dumps(made.as_data()), "utf-8")
    assert json.loads(path.read_text("utf-8"))["schema"] == "roadproof/drive/2"
    assert rp.check(path).accepted
    assert rp.monitor("F[4 s, 4 s] (v_lon(POV) = 16 m/s and a_lon(POV) = 0)", path).verdict == "true"
    assert rp.monitor("decelerates(POV)", path, rp.load("ext")).observed.strips[0].true == ((0.0, 4.0),)


def test_numbers_are_exact_and_may_have_units() -> None:
    made = motion("1/3", 2.6, "108 km/h", 0.1, [("500 ms", 0.1, -0.3)], [(1, "1/10")], kind="truck")
    assert (made.s, made.d, made.v_lon, made.v_lat, made.kind) == (F(1, 3), F(13, 5), 30, F(1, 10), "truck")
    assert [(x.duration, x.a_lon, x.a_lat, x.j_lon) for x in made.pieces] == [
        (F(1, 2), F(1, 10), F(1, 10), F(-3, 10)),
        (F(1, 2), 0, F(1, 10), 0),
        (None, 0, 0, 0),
    ]


def test_the_first_lane_on_which_it_holds_is_taken() -> None:
    left = {"SV": motion(0, 6, 29), "POV": motion(80, 6.2, 28, along=BRAKING)}
    assert drive(4, left).file.lanes == {"L": "main-2"}
    with pytest.raises(rp.InputError, match="the formula does not hold on the drive: scenario_4"):
        drive(4, left, lanes={"L": "main-1"})


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: motion(0, 3, 30, along=[(0, 1, 1)]), "duration=0 s: every duration is above 0"),
        (lambda: motion(0, 3, 30, along=[(1, 1)]), r"along: \(1, 1\) is not an entry: each has 3 numbers"),
        (lambda: motion(0, 3, 30, across=["12"]), "across: '12' is not an entry: each has 2 numbers"),
        (lambda: motion(0, 3, 30, along=[(1, 1, "2 m")]), "along=2 m"),
        (lambda: motion(0, 3, 30, length=0), "a box needs length=0 > 0"),
        (lambda: motion(0, 3, 30, kind="lorry"), "kind='lorry': write car, truck"),
        (lambda: drive("v_lon(SV) > 30 m/s", {"SV": motion(0, 3, 30)}), "does not hold on the drive"),
        (lambda: drive(4, {"SV": motion(0, 3, 30)}), "has no vehicle POV"),
        (lambda: drive(4, pair(), lanes={"L": "main-9"}), "lane L=main-9"),
        (lambda: drive("true", pair(), horizon=0), "horizon=0"),
        (lambda: drive("true", pair() | {"POV": motion(4, 3, 30)}), "overlap from 0 s on"),
    ],
)
def test_mistakes_are_told(ask: object, message: str) -> None:
    with pytest.raises(rp.RoadproofError, match=message):
        ask()  # type: ignore[operator]


def test_boxes_may_overlap_where_that_is_said() -> None:
    made = drive("true", pair() | {"POV": motion(4, 3, 30)}, collisions=True)
    assert isinstance(made, JudgedDrive)
    assert made.file.overlaps_allowed
