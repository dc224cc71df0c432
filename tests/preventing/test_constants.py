"""Driver models with other constants than the declared ones, against the simulation that steps."""

import random
from fractions import Fraction

import numpy as np
import pytest

from preventing import stepping
from preventing.labels import labels
from preventing.read import boundary
from preventing.test_stepping import RATE, random_cut_ins
from roadproof.drivers.manoeuvres import CUT_IN, CUT_OUT, DECELERATION

CASES = 600
LENGTHS = 8.6
# How far constants go; speeds, gaps and angles as in the other tests.
RANGES = {
    "cc_wander": (0.05, 1.5),
    "cc_evaluation": (0, 1),
    "cc_drift": (0, 1.5),
    "cc_delay": (0, 1.5),
    "cc_ramp": (0.05, 2),
    "cc_braking": (2, 12),
    "cc_ttc": (0.5, 4),
    "cc_hard": (0, 8),
    "r157_delay": (0, 1),
    "r157_braking": (2, 10),
    "r157_past": (0, 0.6),
    "eu1426_ramp": (0, 1),
    "eu1426_delay": (0, 0.5),
    "eu1426_braking": (2, 9),
    "rho": (0, 1.5),
    "a_max": (0.5, 6),
    "b_min": (2, 9),
}


def constants(seed: int) -> dict[str, Fraction]:
    dice = random.Random(seed)
    return {
        x: Fraction(dice.randint(int(100 * low), int(100 * high)), 100) for x, (low, high) in RANGES.items()
    }


def motion(model: str, known: dict[str, float], onset: np.ndarray):
    """SV's braking over time, below 0 where it accelerates."""
    if model == "careful":
        return lambda time: np.clip((time - onset) / known["cc_ramp"], 0, 1) * known["cc_braking"]
    if model == "rss":
        late = onset + known["rho"]
        return lambda time: np.where(time < onset, 0, np.where(time < late, -known["a_max"], known["b_min"]))
    return stepping.at_once(onset, known[f"{model}_braking"])


def onsets(model: str, known: dict[str, float], x: dict[str, np.ndarray], perception: str, gate: str):
    """When SV begins to brake, or to respond, in a cut-in."""
    intrusion = (x["dy0"] / 2 + known["r157_past"]) / x["Vy"]
    match model:
        case "rss":
            return x["dy0"] / x["Vy"]
        case "r157":
            return intrusion + known["r157_delay"]
        case "eu1426":
            return intrusion + known["eu1426_delay"] + known["eu1426_ramp"] / 2
    wander, drift = known["cc_wander"] / x["Vy"], known["cc_drift"] / x["Vy"]
    seen, weighed = {
        "time": (wander, known["cc_evaluation"]),
        "distance": (wander + drift, 0),  # so a gate is before the delay, whichever it is
        "overlap": (x["dy0"] / x["Vy"], 0),
    }[perception]
    with np.errstate(divide="ignore"):
        opens = np.where(x["dV0"] > 0, x["dx0"] / x["dV0"] - known["cc_ttc"], 1e9)
    match gate:
        case "before_perception":
            return np.maximum(seen, opens) + weighed + known["cc_delay"]
        case "before_delay":
            return np.maximum(seen + weighed, opens) + known["cc_delay"]
    return seen + weighed + known["cc_delay"]


def far_off(found: np.ndarray, outcome: stepping.Outcome, speed: np.ndarray) -> np.ndarray:
    """Labels that differ farther from the boundary than a step leads: SV may be faster by a_max·rho."""
    return (found != outcome.collided) & (outcome.nearest > 3 * (speed + 21) / RATE)


def cut_ins(model: str, seed: int, off: float = 1.0, **options: str) -> tuple[int, float]:
    """Labels that are off where SV acts ``off`` times as late as it is told; the share that is hit."""
    said = constants(seed)
    x = random_cut_ins(CASES, seed)
    found = labels(CUT_IN, {"it": boundary("cut-in", model, said, **options)}, x)["it"]
    known = {name: float(value) for name, value in said.items()}
    perception, gate = options.get("cc_perception", "time"), options.get("cc_gate", "none")
    onset = onsets(model, known, x, perception, gate) * off
    soon = onset < 8  # a drive that begins to brake later is not over when the simulation is
    x, onset, found = {name: value[soon] for name, value in x.items()}, onset[soon], found[soon]
    speed = x["Ve0"]
    outcome = stepping.step_cut_in(
        speed, speed - x["dV0"], x["dx0"], np.full(len(speed), LENGTHS), x["dy0"], x["Vy"],
        motion(model, known, onset), RATE, 40,
    )  # fmt: skip
    return int(far_off(found, outcome, speed).sum()), float(found.mean())


READINGS = [
    (p, g) for p in ("time", "distance", "overlap") for g in ("none", "before_perception", "before_delay")
]


@pytest.mark.parametrize("number", range(len(READINGS)))
def test_cut_ins_of_a_careful_driver(number):
    perception, gate = READINGS[number]
    off, share = cut_ins("careful", 40 + number, cc_perception=perception, cc_gate=gate)
    assert off == 0
    assert 0.1 < share < 0.9


@pytest.mark.parametrize("model", ["r157", "eu1426", "rss"])
@pytest.mark.parametrize("seed", [51, 52, 53])
def test_cut_ins_of_other_models(model, seed):
    off, share = cut_ins(model, seed)
    assert off == 0
    assert 0.1 < share < 0.95


@pytest.mark.parametrize("model", ["careful", "r157", "eu1426", "rss"])
def test_another_delay_shows(model):
    """As would a response of RSS that does not last from when POV is beside SV."""
    assert cut_ins(model, 54, off=1.3)[0] > 3


@pytest.mark.parametrize(("model", "threshold"), [("careful", "any"), ("careful", "hard"), ("rss", "any")])
@pytest.mark.parametrize("seed", [61, 62, 63])
def test_decelerations(model, threshold, seed):
    said, rng = constants(seed), np.random.default_rng(seed)
    known = {name: float(value) for name, value in said.items()}
    speed = rng.uniform(0.5, 40, CASES)
    faster = np.where(rng.random(CASES) < 0.5, 0.0, np.minimum(rng.normal(0, 5, CASES), speed))
    x = {"Ve0": speed, "dV0": faster, "Gx": rng.uniform(0.1, 12, CASES), "dx0": rng.uniform(0, 80, CASES)}
    found = labels(DECELERATION, {"it": boundary("deceleration", model, said, cc_threshold=threshold)}, x)[
        "it"
    ]
    onset = np.full(CASES, 0.0 if model == "rss" else known["cc_evaluation"] + known["cc_delay"])
    unseen = x["Gx"] < known["cc_hard"] if threshold == "hard" else np.zeros(CASES, bool)
    assert found[unseen].all()  # SV never brakes
    outcome = stepping.step_deceleration(
        speed, speed - faster, x["dx0"], x["Gx"], motion(model, known, onset), RATE, 30
    )
    assert not far_off(found, outcome, speed)[~unseen].any()
    assert 0.05 < found.mean() < 0.98


@pytest.mark.parametrize("seed", [71, 72, 73])
def test_cut_outs(seed):
    said, rng = constants(seed), np.random.default_rng(seed)
    known = {name: float(value) for name, value in said.items()}
    x = {
        "Ve0": rng.uniform(1, 45, CASES),
        "Vf0": np.zeros(CASES),
        "Vy": rng.uniform(0.1, 3, CASES),
        "headway": rng.uniform(0.5, 3, CASES),
        "dx0_f": rng.uniform(0, 100, CASES),
    }
    found = labels(CUT_OUT, {"it": boundary("cut-out", "careful", said)}, x)["it"]
    onset = known["cc_wander"] / x["Vy"] + known["cc_evaluation"] + known["cc_delay"]
    way = stepping.stopping_way(x["Ve0"], motion("careful", known, onset), RATE, 45)
    left = x["headway"] * x["Ve0"] + LENGTHS / 2 + x["dx0_f"] - way
    assert not ((found != (left < 0)) & (np.abs(left) > 3 * (x["Ve0"] + 12) / RATE)).any()
    assert 0.02 < found.mean() < 0.98
