"""Formulas of plates, and places of the controller, against a simulation, at random values of all kinds.

Nothing is claimed of what comes after SV has passed POV. A place counts where the simulation has one verdict
a little nearer and farther, too.
"""

import os
from collections.abc import Iterator, Mapping
from fractions import Fraction as F
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from extensions.drivers.labels import labels
from extensions.drivers.places import RATE, Bools, Floats, braking_leader, cut_in, cut_out
from extensions.drivers.read import values
from extensions.drivers.simulated import Car, Case, Simulation
from roadproof.extensions.drivers.manoeuvres import MANOEUVRES
from roadproof.extensions.drivers.models import unpreventable
from roadproof.extensions.drivers.stepped import course_of
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import load_library
from roadproof.library.specification import Library, Source
from roadproof.world.road import Road

MANY = int(os.environ.get("ROADPROOF_RANDOM_PLACES", "8"))  # sets of parameters of each model and reading
EACH = 60  # places at a set of parameters
NEAR = 0.05  # m
CUT_INS: list[tuple[str, dict[str, str]]] = [
    ("r157", {}),
    ("eu1426", {}),
    ("rss", {}),
    *(
        ("careful", {"cc_perception": x, "cc_gate": y})
        for x in ("time", "distance", "overlap")
        for y in ("none", "before_perception", "before_delay")
    ),
    *(("careful", {"cc_aeb": x}) for x in ("replace", "max", "add")),
]
OLD = """def hits(v, w: m/s, g, r: m, q, y: s, W: unitless, T: s, A: m/s^2)
  := not hasGained(v, w, g + r, q, y, W, T, A)
     and (hasGained(v, w, g, q, y, W, T, A)
          or (stillFaster(v, w, q, y, W, T, A) and gains(v, w, g, q, W, T, A)))
"""
RANGES: Mapping[str, tuple[float, float]] = {
    "cc_wander": (0.1, 1), "cc_evaluation": (0, 0.8), "cc_drift": (0, 1), "cc_delay": (0, 1.5),
    "cc_ramp": (0.1, 1.2), "cc_braking": (2, 9), "cc_ttc": (0.5, 4), "cc_hard": (1, 8),
    "r157_delay": (0, 1), "r157_braking": (2, 9), "r157_past": (0, 0.6),
    "eu1426_ramp": (0, 0.6), "eu1426_delay": (0, 0.5), "eu1426_braking": (2, 9),
    "rho": (0, 1.5), "a_max": (0.5, 5), "b_min": (2, 9),
}  # fmt: skip


@cache
def library(changed: str = "") -> Library:
    return load_library([Path("driver"), *([Source("changed.spec", changed)] if changed else [])])


def parameters(random: np.random.Generator) -> dict[str, F]:
    """Those of all models; AEB brakes at least as hard as the driver."""
    made = {name: F(round(random.uniform(*x) * 1000), 1000) for name, x in RANGES.items()}
    return made | {"aeb_braking": made["cc_braking"] + F(round(random.uniform(0, 3) * 1000), 1000)}


def starts(manoeuvre: str, random: np.random.Generator) -> dict[str, Floats]:
    """Initial values; of cut-ins many have SV beside POV for long."""

    def some(low: float, high: float) -> Floats:
        return np.round(random.uniform(low, high, EACH), 3)

    x = {"length": some(2, 6), "width": some(1.5, 2.6), "Ve0": some(3, 38)}
    match manoeuvre:
        case "cut-in":
            x |= {"dV0": np.minimum(some(0, 14), x["Ve0"]), "Vy": some(0.15, 2), "dy0": some(0, 3)}
            gap = np.where(random.random(EACH) < 0.6, some(0, 18), some(0, 70))
            x["dV0"] = np.where(x["dV0"] < 0.1, 0, x["dV0"])
            return x | {"dx0": np.where(x["dV0"] > 0, np.minimum(gap, 15 * x["dV0"]), gap)}  # over in 25 s
        case "cut-out":
            x |= {"Vf0": np.minimum(some(0, 20), x["Ve0"]), "Vy": some(0.1, 3), "headway": some(0.3, 2.5)}
            return x | {"dx0_f": some(0, 60)}
        case _:
            return x | {"dV0": np.minimum(some(0, 6), x["Ve0"]), "Gx": some(0.5, 10), "dx0": some(0, 70)}


def told(
    manoeuvre: str,
    model: str,
    x: Mapping[str, Floats],
    known: dict[str, F],
    options: dict[str, str],
    old: str = "",
) -> Bools:
    home = library(old).select("base", options)
    text = unpreventable(manoeuvre, model, MANOEUVRES[manoeuvre].vehicles)
    formula = bind(read_claim(home, text).formula, Road("none", (), frozenset()), {}, values() | known)
    return labels(MANOEUVRES[manoeuvre], {"": formula}, x)[""].reshape(-1)


def simulated(
    manoeuvre: str, model: str, x: Mapping[str, Floats], options: dict[str, str]
) -> tuple[Bools, Bools]:
    if manoeuvre == "cut-in":
        return cut_in(model, x, options)
    if manoeuvre == "cut-out":
        return cut_out(x), np.zeros(len(x["Ve0"]), bool)
    hard = options.get("cc_threshold") == "hard"
    perceived = x["Gx"] >= x["cc_hard"] if hard else np.ones(len(x["Ve0"]), bool)
    return braking_leader(model, x, options, perceived), np.zeros(len(x["Ve0"]), bool)


def places(
    manoeuvre: str, model: str, options: dict[str, str], old: str = ""
) -> Iterator[tuple[bool, bool, bool, bool]]:
    """For each place: the formula, the simulation, whether this is sure, and whether POV hits SV later."""
    random = np.random.default_rng(abs(hash_of(manoeuvre, model, options)))
    sets = [(parameters(random), starts(manoeuvre, random)) for _ in range(MANY)]
    found = np.concatenate([told(manoeuvre, model, x, known, options, old) for known, x in sets])
    every = [x | {k: np.full(EACH, float(v)) for k, v in known.items()} for known, x in sets]
    joined = {name: np.concatenate([x[name] for x in every]) for name in every[0]}
    gap = "dx0_f" if manoeuvre == "cut-out" else "dx0"
    variants = [
        joined | {gap: joined[gap] + more} | late(joined, lag)
        for more, lag in ((0, 0), (NEAR, 0), (-NEAR, 0), (0, 1), (0, -1))
    ]
    stacked = {name: np.concatenate([x[name] for x in variants]) for name in joined}
    hits, later = (x.reshape(5, -1) for x in simulated(manoeuvre, model, stacked, options))
    hit, sure, later = hits[0], (hits == hits[0]).all(axis=0), later[0]
    yield from zip(found.tolist(), hit.tolist(), sure.tolist(), later.tolist(), strict=True)


def late(x: Mapping[str, Floats], lag: int) -> dict[str, Floats]:
    """POV is in the way two steps of the simulation later or earlier."""
    if "dy0" not in x:
        return {}
    return {"dy0": np.maximum(x["dy0"] + lag * x["Vy"] * 2 / RATE, 0)}


def case_of(x: Mapping[str, F]) -> Case:
    """A cut-in as the independent simulation has it: POV ends in the middle of SV's lane."""
    lane, wide, long = float(x["width"] + x["dy0"]), float(x["width"]), float(x["length"])
    speed, across = float(x["Ve0"]), float(x["Vy"])
    left = (lane + wide) / 2
    steers = ((lane / across - 0.05, 0.0, 0.0, 0.0), (0.1, 0.0, 0.0, across / 0.1))
    mine = Car(0.0, left, speed, 0.0, (), long, wide)
    place = float(x["dx0"]) + long
    other = Car(place, left + lane, speed - float(x["dV0"]), -across, steers, long, wide)
    return Case("cut-in", (mine, other), (0.0, lane), (lane, 2 * lane), 0.0)


def hash_of(*parts: object) -> int:
    return int.from_bytes(str(parts).encode()[-7:], "big") + len(str(parts))


ALL = [
    *(("cut-in", *x) for x in CUT_INS),
    ("cut-out", "careful", {}),
    ("deceleration", "careful", {}),
    ("deceleration", "careful", {"cc_threshold": "hard"}),
    ("deceleration", "rss", {}),
]


@pytest.mark.parametrize(("manoeuvre", "model", "options"), ALL)
def test_formulas_of_plates_are_what_is_simulated(
    manoeuvre: str, model: str, options: dict[str, str]
) -> None:
    found = list(places(manoeuvre, model, options))
    wrong = [k for k, (formula, hit, sure, _) in enumerate(found) if sure and formula is not hit]
    assert not wrong
    assert sum(sure for _, _, sure, _ in found) > 0.8 * len(found)
    assert {True, False} == {hit for _, hit, sure, _ in found if sure}


def test_places_where_pov_hits_sv_after_it_was_passed_are_among_them() -> None:
    """By the formula that looks at the instant alone at which POV is in the way, some are unpreventable."""
    seen, differ = 0, 0
    for model, options in CUT_INS[:3] + CUT_INS[3:4]:
        now = list(places("cut-in", model, options))
        before = list(places("cut-in", model, options, OLD))
        seen += sum(later for *_, later in now)
        differ += sum(
            a != b and later and not b for (b, _, _, later), (a, *_) in zip(now, before, strict=True)
        )
    assert seen > 10
    assert differ > 0


def test_places_of_the_controller_are_what_is_simulated() -> None:
    """Places of cut-ins in which SV is beside POV for long: nothing is claimed after SV has passed it."""
    random, sure, later = np.random.default_rng(7), 0, 0
    for _ in range(10 * MANY):
        dv, vy = (F(round(random.uniform(*x) * 100), 100) for x in ((0, 12), (0.15, 1.2)))
        given = {"Ve0": F(20), "dV0": dv, "Vy": vy, "dx0": F(round(random.uniform(0, 25) * 100), 100)}
        at = MANOEUVRES["cut-in"].values(given)
        found = course_of(MANOEUVRES["cut-in"], at, False).touches
        words = {Simulation(case_of(at), nearer=x).run("fsm").word for x in (0, NEAR, -NEAR)}
        if len(words) == 1 and not words & {"later"}:
            sure += 1
            later += words == {"undecided"}
            assert found is (words == {"collides"}), (given, words)
    assert sure > 7 * MANY
    assert later > MANY
