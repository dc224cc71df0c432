"""The RSS guarantee (P9): what is proved holds of drives, and its refuted control is a crash."""

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from asking import prove
from proving.claims import specification
from roadproof.engines.prove.properties import Task, template_properties
from roadproof.library.bind import default_values
from roadproof.library.elaborate import read_claim
from roadproof.logic.rewrite import with_values
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact import judge
from roadproof.verdict import Verdict
from roadproof.world.drive import Drive, Motion, Piece
from roadproof.world.motion import state_at

NONE = Fraction(0)
LENGTH = Fraction(9, 2)


def moving(front: Fraction, speed: Fraction, phases: list[tuple[Fraction, Fraction]]) -> Motion:
    """A car whose front starts at ``front``; after phases of (duration, acceleration) it keeps its speed."""
    pieces = [Piece(duration, a, NONE) for duration, a in phases if duration > 0]
    return Motion(LENGTH, Fraction(9, 5), front, NONE, speed, NONE, (*pieces, Piece(None, NONE, NONE)))


def worst_case(v_r: Fraction, v_f: Fraction, gap: Fraction, p: dict[str, Fraction]) -> Drive:
    """SV accelerates for rho, then brakes by b_min; POV, ``gap`` ahead, brakes by b_max; both to a stand."""
    reached = v_r + p["a_max"] * p["rho"]
    rear = moving(NONE, v_r, [(p["rho"], p["a_max"]), (reached / p["b_min"], -p["b_min"])])
    front = moving(gap + LENGTH, v_f, [(v_f / p["b_max"], -p["b_max"])])
    return Drive({"SV": rear, "POV": front})


def is_true(claim: str, drive: Drive, parameters: dict[str, Fraction]) -> bool:
    return judge(with_values(read_claim(specification(), claim).formula, parameters), drive).holds


GAP = "s(POV) - length(POV) - s(SV)"
FAR_ENOUGH = f"{GAP} > dRSS_lon(v_lon(SV), v_lon(POV))"
TOUCH = f"F {GAP} <= 0 m"


@pytest.mark.parametrize("time", ["0", "0.25", "0.5", "0.75", "2", "60"])
def test_the_envelopes_are_the_distances_of_the_worst_case(time: str):
    parameters = default_values(specification().library) | {"rho": Fraction(1, 2)}
    drive = worst_case(Fraction(20), Fraction(30), Fraction(10), parameters)
    for name, speed, vehicle in (("rearAtMost", "20", "SV"), ("frontAtLeast", "30", "POV")):
        motion = drive.vehicles[vehicle]
        gone = state_at(motion, Fraction(time)).s - motion.s
        told = f"{name}({speed} m/s, {time} s)"
        for low, high, expected in ((-1, 1, True), (1, 2, False), (-2, -1, False)):
            least, most = (f"{float(gone) + end / 10**6:.9f}" for end in (low, high))
            assert is_true(f"{told} >= {least} m and {told} <= {most} m", drive, parameters) == expected


def test_from_a_stand_too_the_distance_is_a_promise():
    """It is not kept where the front may brake less hard than the rear does, and that has to be seen."""
    parameters = default_values(specification().library)
    parameters |= {"a_max": Fraction(3), "rho": Fraction(1), "b_min": Fraction(20), "b_max": Fraction(1, 10)}
    drive = worst_case(Fraction(0), Fraction(1), Fraction(10), parameters)
    assert not is_true("staysApart(0 m/s, 1 m/s, 0.01 m, 1 s)", drive, parameters)
    assert is_true("staysApart(0 m/s, 1 m/s, 0.01 m, 0 s)", drive, parameters)
    assert is_true("staysApart(0 m/s, 1 m/s, 2 m, 1 s)", drive, parameters)


def task(name: str) -> Task:
    (found,) = [task for task in template_properties() if task.id == name]
    return found


def test_the_refuted_control_is_a_crash():
    result = prove(specification(), task("C5").claim, Effort(30))
    assert result.verdict is Verdict.REFUTED, result.reason
    assert result.countermodel is not None
    parameters = dict(result.countermodel.parameters)
    values = result.countermodel.instants[0].values
    assert parameters["b_min"] > parameters["b_max"] > 0
    drive = worst_case(values["v_r"], values["v_f"], values["gap"], parameters)
    assert is_true(FAR_ENOUGH, drive, parameters)
    assert is_true(f"{GAP} > 0 m", drive, parameters)
    assert is_true(TOUCH, drive, parameters)


@pytest.mark.parametrize("b_min", [Fraction(3), Fraction(6), Fraction(8)])
@pytest.mark.parametrize("rho", [NONE, Fraction(3, 5), Fraction(2)])
@settings(max_examples=12, deadline=None, derandomize=True, database=None)
@given(st.integers(0, 40), st.integers(0, 40), st.fractions(Fraction(1, 100), 20))
def test_a_gap_above_the_distance_is_never_used_up(b_min, rho, v_r, v_f, more):
    """What P9 says, and that it says it of the very drive that comes nearest."""
    parameters = default_values(specification().library) | {"b_min": b_min, "rho": rho}
    reached = v_r + parameters["a_max"] * rho
    responding = v_r * rho + parameters["a_max"] * rho**2 / 2
    braking = reached**2 / (2 * b_min) - Fraction(v_f) ** 2 / (2 * parameters["b_max"])
    nearest = max(NONE, responding + braking)
    drive = worst_case(Fraction(v_r), Fraction(v_f), nearest + more, parameters)
    assert is_true(FAR_ENOUGH, drive, parameters)
    assert not is_true(TOUCH, drive, parameters)
    if nearest > 0:
        tight = worst_case(Fraction(v_r), Fraction(v_f), nearest, parameters)
        assert not is_true(FAR_ENOUGH, tight, parameters)
        assert is_true(TOUCH, tight, parameters)


def test_the_guarantee_is_not_vacuous():
    """Its premise has models: else it would say nothing."""
    premise = "b_min <= b_max and 0 <= v_r and 0 <= v_f and 0 <= t and gap > dRSS_lon(v_r, v_f)"
    result = prove(specification(), f"given v_r, v_f: m/s; gap: m; t: s: not ({premise})", Effort(10))
    assert result.verdict is Verdict.REFUTED, result.reason
