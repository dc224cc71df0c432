"""Sampled states: each holds by the judge, none of a formula without one, the same ones every time."""

import random
from fractions import Fraction

import numpy as np
import pytest

from roadproof.engines.search import sampling
from roadproof.engines.search.sampling import Space, holds, states
from roadproof.library.bind import bind
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.logic.terms import Signal, Size
from roadproof.world.models import load_road

HOME = bundled_library().select()
VEHICLES = ("SV", "POV")
RANGES = {"s": 80, "d": 6, "v_lon": 40, "v_lat": 2, "a_lon": 4}
SPACE = Space(
    {Signal(name, v): (Fraction(-most), Fraction(most)) for name, most in RANGES.items() for v in VEHICLES},
    {Size(size, v): x for v in VEHICLES for size, x in (("length", Fraction(4)), ("width", Fraction(2)))},
)


def bound(text):
    return bind(read_claim(HOME, text).formula, load_road("main-2"), {}, {})


STATES = [
    "v_lon(SV)^3 > 100*v_lon(POV)^2*1 m/s and v_lat(SV)*v_lon(POV) < 0*1 m/s*1 m/s",
    "v_lon(SV) = 60 km/h and v_lon(SV)*v_lon(SV)*(s(POV)-s(SV)) > 1000*1 m*1 m/s*1 m/s",
    # thin: 0.2 m of 320 m, where the speeds are within 0.1 m/s of 80 m/s
    "s(POV) - s(SV) > 40 m and s(POV) - s(SV) < 40.2 m"
    " and abs(v_lon(SV) - 20 m/s) < 0.05 m/s and abs(v_lon(POV) - 10 m/s) < 0.05 m/s",
    # equalities, one through the other
    "v_lon(POV) = v_lon(SV) and s(POV) = s(SV) + v_lon(SV)*2 s - 4 m and v_lon(SV)^3 > 8*1 m/s*1 m/s*1 m/s",
    "max(v_lon(SV), v_lon(POV)) = 10 m/s and v_lon(SV) = 10 m/s",
]


@pytest.mark.parametrize("text", STATES)
def test_states_are_found_judged_and_different(text):
    formula = bound(text)
    found = states(formula, SPACE, 8)
    assert found
    assert all(holds(formula, state, SPACE.sizes) for state in found)
    assert len({tuple(sorted((x.name, x.vehicle, v) for x, v in state.items())) for state in found}) == len(
        found
    )
    assert all(SPACE.ranges[x][0] <= v <= SPACE.ranges[x][1] for state in found for x, v in state.items())


def test_the_same_states_every_time():
    formula = bound(STATES[0])
    assert states(formula, SPACE, 8) == states(formula, SPACE, 8)


def test_values_have_few_digits():
    assert all((1000 * v).denominator == 1 for x in states(bound(STATES[0]), SPACE, 8) for v in x.values())


@pytest.mark.parametrize(
    "text",
    [
        "v_lon(SV)^3 > v_lon(SV)^3 + 1*1 m/s*1 m/s*1 m/s",
        "v_lon(SV) = 100 m/s",  # outside the range
        "v_lon(SV) = 10 m/s and v_lon(SV) = 11 m/s",
        "v_lon(SV)^2 < 0*1 m/s*1 m/s",
        "false",
    ],
)
def test_a_formula_without_state_gives_none(text):
    assert states(bound(text), SPACE, 8) == []


def test_what_floating_point_sees_is_not_taken_for_granted(monkeypatch):
    """Where every point is called true, only what the judge accepts comes out."""

    def every_point(self):
        evenly = sampling.spread(0, 64, len(self.axes))
        return np.column_stack([x.values(evenly[:, k]) for k, x in enumerate(self.axes)])

    formula = bound(STATES[0])
    monkeypatch.setattr(sampling._StateSampler, "points", every_point)
    found = states(formula, SPACE, 64)
    assert 0 < len(found) < 64
    assert all(holds(formula, state, SPACE.sizes) for state in found)


def test_random_formulas_against_the_judge():
    """What is handed out holds; where a state chosen at random does, in a large set, some are found."""
    rng = random.Random(16)
    leaves = list(SPACE.ranges)

    def side():
        factors = tuple(rng.choice(leaves) for _ in range(rng.randint(1, 3)))
        return t.Sum((t.Product(factors), t.number(rng.randint(-50, 50))))

    missed = 0
    for _ in range(40):
        parts = [f.Compare(side(), rng.choice(["<", "<=", ">", ">="]), side()) for _ in range(3)]
        formula = f.And((f.Or((parts[0], f.Not(parts[1]))), parts[2]))
        found = states(formula, SPACE, 4)
        assert all(holds(formula, state, SPACE.sizes) for state in found)
        drawn = [{x: Fraction(rng.randint(*map(int, r))) for x, r in SPACE.ranges.items()} for _ in range(20)]
        missed += not found and any(holds(formula, state, SPACE.sizes) for state in drawn)
    assert missed == 0
