"""A robustness with a sign never contradicts the verdict, on drives as on recordings."""

import random
from collections import Counter
from fractions import Fraction

import numpy as np
import pytest

from extensions.exchange.streaming.random_formulas import random_formula
from extensions.traffic.monitoring.cases import random_batch
from roadproof.extensions.traffic.evaluate.observed import observe_drive
from roadproof.extensions.traffic.evaluate.robust import robustness
from roadproof.extensions.traffic.report.one_trace import as_text
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim
from roadproof.semantics.sampled.compiled import compile
from searching.known import BASE, ROADS, VALUES, known

DT = Fraction(3, 25)


@pytest.mark.parametrize("convention", ["truncated", "clip"])
@pytest.mark.parametrize("ties", [True, False])
def test_on_recordings(convention, ties):
    rng, signs = np.random.default_rng(17), Counter()
    for seed in range(60):
        formula, batch = random_formula(rng, 3), random_batch(seed, 12, 9, ties)
        monitor = compile({"it": formula})
        truth = monitor.evaluate(batch, convention).answers["it"]
        margin = monitor.measure(batch, convention).margins["it"]
        above, below = margin.low > 0, margin.high < 0
        assert not (above & ~truth.true).any(), (seed, formula)
        assert not (below & ~truth.false).any(), (seed, formula)
        signs += Counter({"above": int(above.sum()), "below": int(below.sum())})
        signs["none"] += int((~above & ~below).sum())
    assert min(signs["above"], signs["below"], signs["none"]) > 50, signs


def observed(text, case):
    formula = bind(read_claim(BASE, text).formula, ROADS[case.road], case.lanes, VALUES)
    horizon = case.grid.horizon
    sampled = robustness(formula, case.drive, DT, int(horizon / DT) * DT).value
    return observe_drive(text, formula, case.drive, horizon, DT), sampled


def test_on_drives():
    """Formulas of random drives, and untils that have no first instant; samples alone are wrong on some."""
    rng, wrong, kinds = random.Random(3), 0, Counter()
    for seed in range(30):
        case = known(seed)
        name = rng.choice([*case.drive.vehicles])
        place = rng.choice(["d({0}) > {1} m", "s({0}) > {1} m", "v_lon({0}) > {1} m/s"])
        motion = case.drive.vehicles[name]
        value = {"d": motion.d, "s": motion.s + 20, "v": motion.v_lon}[place[0]] + Fraction(
            rng.randint(0, 9), 10
        )
        open_ = place.format(name, float(value))
        for text in (case.text, f"not ({open_}) U ({open_})", f"F ({open_})"):
            found, sampled = observed(text, case)
            (margin, _) = found.margin
            assert margin <= 0 or found.verdict == "true"
            assert margin >= 0 or found.verdict == "false"
            wrong += (sampled > 0) != (found.verdict == "true") and sampled != 0
            kinds[found.decides] += 1
            assert found.decides == (margin != 0)
            assert ("does not decide" in as_text(found)) == (margin == 0)
    assert wrong > 5
    assert min(kinds.values()) > 5
