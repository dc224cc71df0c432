"""Labels of two published grids of cut-ins, by reading of the regulation and by clock: docs/data/labels.csv.

    python benchmarks/preventable.py

The grids are those of the public JRC-FSM repository: gaps, lateral and longitudinal speeds of a cut-in with
cars of 4.3 m by 1.9 m that begin 1.6 m apart across. Only grids are taken from there.
"""

import csv
import sys
from fractions import Fraction
from itertools import product
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from extensions.drivers import stepping
from extensions.drivers.labels import labels
from extensions.drivers.read import boundary
from roadproof.extensions.drivers.manoeuvres import CUT_IN

TABLE = Path(__file__).parents[1] / "docs/data/labels.csv"
KMH = float(Fraction(5, 18))
READINGS = {
    "perception by time": {},
    "perception by distance": {"cc_perception": "distance"},
    "perception by overlap": {"cc_perception": "overlap"},
    "TTC below 2 s before perception": {"cc_gate": "before_perception"},
    "TTC below 2 s before the delay": {"cc_gate": "before_delay"},
    "AEB: replace": {"cc_aeb": "replace"},
    "AEB: max": {"cc_aeb": "max"},
    "AEB: add": {"cc_aeb": "add"},
}
MODELS = {"r157": "UN R157 5.2.5.2", "eu1426": "EU 2022/1426", "rss": "RSS proper response"}


def grid(gaps: range, ego: range, other_step: int) -> dict[str, np.ndarray]:
    """Initial values in SI units; lateral speeds 0.1 to 1.7 m/s."""
    speeds = [(ve, vo) for ve in ego for vo in range(10, ve - 9, other_step)]
    cases = list(product(gaps, range(1, 18), speeds))
    return {
        "dx0": np.array([float(x) for x, _, _ in cases]),
        "Vy": np.array([y / 10 for _, y, _ in cases]),
        "Ve0": np.array([ve * KMH for _, _, (ve, _) in cases]),
        "dV0": np.array([(ve - vo) * KMH for _, _, (ve, vo) in cases]),
        "dy0": np.full(len(cases), 1.6),
    }


def stepped(x: dict[str, np.ndarray], rate: int) -> np.ndarray:
    """The labels of the reading by time from a clock of so many steps a second."""
    onset = stepping.WANDER / x["Vy"] + stepping.EVALUATION + stepping.DELAY
    beginning = np.ceil(onset * rate - 1e-9) / rate if rate < 1000 else onset
    w, lengths = x["Ve0"] - x["dV0"], np.full(len(onset), 8.6)
    drive = stepping.careful(beginning)
    return stepping.step_cut_in(x["Ve0"], w, x["dx0"], lengths, x["dy0"], x["Vy"], drive, rate, 30).collided


def columns(x: dict[str, np.ndarray]) -> dict[str, list[str]]:
    """Three cells for each reading: cases that are unpreventable, their share, other labels than by time."""
    formulas = {what: boundary("cut-in", "careful", **options) for what, options in READINGS.items()}
    formulas |= {what: boundary("cut-in", model) for model, what in MODELS.items()}
    found = labels(CUT_IN, formulas, x)
    for rate in (1000, 100, 10):
        found[f"perception by time, stepped at {rate} Hz"] = stepped(x, rate)
    usual = found["perception by time"]
    return {
        what: [f"{hit.sum():,}", f"{100 * hit.mean():.1f} %", f"{(hit != usual).sum():,}"]
        for what, hit in found.items()
    }


if __name__ == "__main__":
    low = columns(grid(range(1, 60), range(10, 61, 10), 10))
    high = columns(grid(range(1, 120, 2), range(70, 131, 20), 30))
    head = ["reading"]
    for speeds in ("low", "high"):
        head += [f"unpreventable, {speeds} speeds", "share", "other label than by time"]
    with TABLE.open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([head, *([x, *low[x], *high[x]] for x in low)])
