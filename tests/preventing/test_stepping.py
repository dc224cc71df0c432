"""The formulas of driver.spec against a simulation that steps: they differ within a step's band only."""

import numpy as np
import pytest

from preventing import stepping
from preventing.labels import labels
from preventing.read import bound, boundary
from roadproof.drivers.manoeuvres import CUT_IN, CUT_OUT, DECELERATION

RATE = 1000
CASES = 100_000
RAMP_AND_ROUNDING = 1e-6


def random_cut_ins(cases: int, seed: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    v = rng.uniform(0.5, 40, cases) * rng.choice([1.0, 0.15], cases, p=[0.8, 0.2])
    return {
        "Ve0": v,
        "dV0": v * rng.uniform(0, 1, cases),
        "Vy": rng.uniform(0.2, 3, cases),
        "dx0": rng.uniform(0, 60, cases) * rng.choice([1.0, 0.2], cases),
        "dy0": rng.uniform(0, 2, cases),
    }


def onset_of(reading: str, x: dict[str, np.ndarray]) -> np.ndarray:
    return {
        "time": stepping.WANDER / x["Vy"] + stepping.EVALUATION,
        "distance": (stepping.WANDER + stepping.DRIFT) / x["Vy"],
        "overlap": x["dy0"] / x["Vy"],
    }[reading] + stepping.DELAY


def differing(found: np.ndarray, outcome: stepping.Outcome, band: np.ndarray) -> tuple[int, int]:
    """Labels that differ, and those of them that are farther from the boundary than a step leads."""
    other = found != outcome.collided
    return int(other.sum()), int((other & (outcome.nearest > band)).sum())


def check_cut_ins(reading: str, cases: int, seed: int) -> tuple[int, float]:
    x = random_cut_ins(cases, seed)
    formula = boundary("cut-in", "careful", cc_perception=reading)
    found = labels(CUT_IN, {"it": formula}, x)["it"]
    drive = stepping.careful(onset_of(reading, x))
    w = x["Ve0"] - x["dV0"]
    outcome = stepping.step_cut_in(
        x["Ve0"], w, x["dx0"], np.full(cases, 8.6), x["dy0"], x["Vy"], drive, RATE, 21
    )
    count, outside = differing(found, outcome, 2 * (x["Ve0"] + stepping.FULL) / RATE)
    assert outside == 0
    return count, float(found.mean())


@pytest.mark.parametrize("reading", ["time", "distance", "overlap"])
def test_cut_ins(reading):
    count, share = check_cut_ins(reading, 3_000, 5)
    assert count < 10
    assert 0.1 < share < 0.9


def test_many_cut_ins():
    count, share = check_cut_ins("time", CASES, 6)
    assert count < 0.002 * CASES
    assert 0.1 < share < 0.9


def check_decelerations(cases: int, seed: int) -> tuple[int, float]:
    rng = np.random.default_rng(seed)
    v = rng.uniform(0.1, 40, cases) * rng.choice([1.0, 0.1], cases, p=[0.8, 0.2])
    faster = np.where(rng.random(cases) < 0.5, 0.0, np.minimum(rng.normal(0, 5, cases), v))
    x = {
        "Ve0": v,
        "dV0": faster,
        "Gx": rng.uniform(0.1, 12, cases),
        "dx0": rng.uniform(0, 60, cases) * rng.choice([1.0, 0.1], cases),
    }
    found = labels(DECELERATION, {"it": boundary("deceleration", "careful")}, x)["it"]
    onset = np.full(cases, stepping.EVALUATION + stepping.DELAY)
    outcome = stepping.step_deceleration(v, v - faster, x["dx0"], x["Gx"], stepping.careful(onset), RATE, 12)
    # A POV that still moves after 12 s could be hit later; SV stands by then.
    count, outside = differing(found, outcome, 2 * (v + stepping.FULL) / RATE)
    assert outside == 0
    return count, float(found.mean())


def test_decelerations_with_any_delay():
    """Also where POV brakes harder than SV can, and where one of them stands within the ramp."""
    cases = 400
    for delay, seed in ((0.0, 21), (0.2, 22), (0.6, 23)):
        rng = np.random.default_rng(seed)
        v = rng.uniform(0, 12, cases) * rng.choice([1.0, 0.1, 0.0], cases, p=[0.5, 0.3, 0.2])
        w = rng.uniform(0, 12, cases) * rng.choice([1.0, 0.1], cases)
        braking = rng.uniform(0.5, 20, cases)
        gap = rng.uniform(0, 6, cases) * rng.choice([1.0, 0.02], cases)
        formula = bound(
            "gainsBraking(v_lon(SV), v_lon(POV), -a_lon(POV), gapTo(SV, POV), "
            f"{delay} s, cc_ramp, cc_braking)"
        )
        x = {"Ve0": v, "dV0": v - w, "Gx": braking, "dx0": gap}
        found = labels(DECELERATION, {"it": formula}, x)["it"]
        drive = stepping.careful(np.full(cases, delay))
        outcome = stepping.step_deceleration(v, w, gap, braking, drive, RATE, 26)
        _, outside = differing(found, outcome, 2 * (v + stepping.FULL) / RATE)
        assert outside == 0
        assert 0.1 < found.mean() < 0.9


def test_decelerations():
    count, share = check_decelerations(3_000, 7)
    assert count < 10
    assert 0.1 < share < 0.9


def test_many_decelerations():
    count, share = check_decelerations(CASES, 8)
    assert count < 0.002 * CASES
    assert 0.1 < share < 0.9


def check_cut_outs(cases: int, seed: int) -> tuple[int, float]:
    rng = np.random.default_rng(seed)
    x = {
        "Ve0": rng.uniform(1, 45, cases),
        "Vf0": np.zeros(cases),
        "Vy": rng.uniform(0.1, 3, cases),
        "headway": rng.uniform(0.5, 3, cases),
        "dx0_f": rng.uniform(0, 100, cases),
    }
    found = labels(CUT_OUT, {"it": boundary("cut-out", "careful")}, x)["it"]
    onset = stepping.WANDER / x["Vy"] + stepping.EVALUATION + stepping.DELAY
    way = stepping.stopping_way(x["Ve0"], stepping.careful(onset), RATE, 13)
    left = x["headway"] * x["Ve0"] + 4.3 + x["dx0_f"] - way
    other = found != (left < 0)
    assert not (other & (np.abs(left) > 2 * (x["Ve0"] + stepping.FULL) / RATE)).any()
    return int(other.sum()), float(found.mean())


def test_cut_outs():
    count, share = check_cut_outs(3_000, 9)
    assert count < 10
    assert 0.02 < share < 0.9


def test_many_cut_outs():
    count, share = check_cut_outs(CASES, 10)
    assert count < 0.002 * CASES
    assert 0.02 < share < 0.9


@pytest.mark.parametrize(("model", "full"), [("r157", 6.0), ("eu1426", 6.0)])
def test_regulations(model, full):
    x = random_cut_ins(3_000, 11)
    found = labels(CUT_IN, {"it": boundary("cut-in", model)}, x)["it"]
    later = {"r157": 0.35, "eu1426": 0.25}[model]
    onset = (x["dy0"] / 2 + 0.3) / x["Vy"] + later
    drive = stepping.at_once(onset, full)
    outcome = stepping.step_cut_in(
        x["Ve0"], x["Ve0"] - x["dV0"], x["dx0"], np.full(3_000, 8.6), x["dy0"], x["Vy"], drive, RATE, 21
    )
    _, outside = differing(found, outcome, 3 * (x["Ve0"] + full) / RATE)
    assert outside == 0


@pytest.mark.parametrize("gate", ["before_perception", "before_delay"])
def test_gates(gate):
    x = random_cut_ins(3_000, 12)
    found = labels(CUT_IN, {"it": boundary("cut-in", "careful", cc_gate=gate)}, x)["it"]
    onset = stepping.gated_onset(x, gate)
    onset = np.where(np.isfinite(onset), onset, 1e9)
    outcome = stepping.step_cut_in(
        x["Ve0"],
        x["Ve0"] - x["dV0"],
        x["dx0"],
        np.full(3_000, 8.6),
        x["dy0"],
        x["Vy"],
        stepping.careful(onset),
        RATE,
        40,
    )
    late = onset > 30  # the simulation ends before such a drive does
    other = (found != outcome.collided) & ~late
    assert not (other & (outcome.nearest > 2 * (x["Ve0"] + stepping.FULL) / RATE)).any()


def test_a_planted_fault_shows():
    """With half the ramp the labels differ far from the boundary, too."""
    x = random_cut_ins(3_000, 13)
    found = labels(CUT_IN, {"it": boundary("cut-in", "careful")}, x)["it"]
    drive = stepping.careful(onset_of("time", x) - 0.15)
    outcome = stepping.step_cut_in(
        x["Ve0"], x["Ve0"] - x["dV0"], x["dx0"], np.full(3_000, 8.6), x["dy0"], x["Vy"], drive, RATE, 21
    )
    _, outside = differing(found, outcome, 2 * (x["Ve0"] + stepping.FULL) / RATE)
    assert outside > 20
