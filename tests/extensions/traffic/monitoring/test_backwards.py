"""RSS says nothing of vehicles that drive backwards: `monitor` notes them, and what it says if they stand."""

from random import Random

import pytest

import roadproof as rp

RHO, A_MAX, B_MIN, B_MAX, LENGTH = 0.6, 5.0, 6.0, 8.0, 4.5


def columns(gap: float, rear: float, front: float) -> dict[str, list[object]]:
    """SV at ``rear`` m/s, and POV at ``front`` m/s, ``gap`` m before it in its lane, at four samples."""
    rows = [
        (k / 10, name, s + v * k / 10, v)
        for k in range(4)
        for name, s, v in (("SV", 0.0, rear), ("POV", gap + LENGTH, front))
    ]
    still = {x: [0.0] * 8 for x in ("v_lat", "a_lon", "a_lat")}
    sizes = {"length": [LENGTH] * 8, "width": [1.8] * 8, "d": [2.6] * 8}
    names = ("time", "vehicle", "s", "v_lon")
    return {**dict(zip(names, map(list, zip(*rows, strict=True)), strict=True)), **still, **sizes}


def distance(rear: float, front: float) -> float:
    """The distance of the paper's equation."""
    need = rear * RHO + A_MAX * RHO**2 / 2 + (rear + A_MAX * RHO) ** 2 / (2 * B_MIN) - front**2 / (2 * B_MAX)
    return max(0.0, need)


def test_a_vehicle_that_drives_backwards_is_noted_with_the_answer_where_it_stands() -> None:
    random, differ = Random(21), 0
    for _ in range(120):
        rear, front = random.uniform(-2, 6), random.uniform(-8, 4)
        gap = max(0.5, distance(rear, max(front, 0)) - random.uniform(-1, 3))
        answer = rp.monitor("rssViolation(SV,POV)", columns(gap, rear, front))
        assert (answer.verdict == "true") == (gap <= distance(rear, front))
        stands = gap <= distance(max(rear, 0), max(front, 0))
        notes = [x for x in answer.notes if x.startswith("with speeds below 0")]
        backwards = min(rear, front) < -0.5
        assert any("drives backwards" in x for x in answer.notes) == backwards
        if backwards and stands != (gap <= distance(rear, front)):
            differ += 1
            told = str(stands).lower()
            assert notes == [f"with speeds below 0 taken as 0 m/s, rssViolation(SV,POV): {told}"]
        else:
            assert notes == []
    assert differ > 10


@pytest.mark.parametrize("formula", ["v_lon(POV) < 0 m/s", "s(SV) < s(POV) and F v_lon(POV) < -1 m/s"])
def test_formulas_without_squares_of_speeds_are_about_the_motion_itself(formula: str) -> None:
    answer = rp.monitor(formula, columns(9.0, 5, -3))
    assert answer.verdict == "true"
    assert not any(x.startswith("with speeds below 0") for x in answer.notes)


@pytest.mark.parametrize("view", ["dense", "recorded"])
def test_drives_that_go_backwards_are_noted(view: str) -> None:
    moving = {
        "SV": rp.motion(s=0, d=2.6, v_lon=5, length=4.5, width=1.8),
        "POV": rp.motion(s=13.5, d=2.6, v_lon=-3, length=4.5, width=1.8),
    }
    drive = rp.drive("v_lon(POV) < 0 m/s", moving, collisions=True)
    answer = rp.monitor("rssViolation(SV,POV)", drive, view=view)
    assert answer.verdict == "false"
    assert [x.split(",")[0] for x in answer.notes] == [
        "vehicle POV drives backwards",
        "with speeds below 0 taken as 0 m/s",
    ]
