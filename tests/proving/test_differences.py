"""Bounds on differences of two vehicles under motion are proved, and near misses are not."""

import random

import pytest

import roadproof as rp
from roadproof.verdict import Verdict

SIDES = (
    ("s(SV) <= s(POV) - {gap} m", "s(SV) <= s(POV) - {left} m"),
    ("s(POV) - s(SV) >= {gap} m", "s(POV) - s(SV) >= {left} m"),
    ("s(SV) + {gap} m <= s(POV)", "s(SV) - s(POV) <= -{left} m"),
)
RATES = (
    "G[0, 2 s] v_lon(SV) - v_lon(POV) <= {rate} m/s",
    "G[0, 2 s] (v_lon(SV) <= {fast} m/s and v_lon(POV) >= 20 m/s)",
)
TWICE = (
    "v_lon(SV) <= v_lon(POV) and G[0, 2 s] a_lon(SV) - a_lon(POV) <= {rate} m/s^2",
    "v_lon(SV) <= v_lon(POV) and G[0, 2 s] (a_lon(SV) <= {rate} m/s^2 and a_lon(POV) >= 0 m/s^2)",
)


def claims(rates, closer, near):
    """Claims about the gap after 2 s, of which the last figure is the one that just holds, less ``near``."""
    rng = random.Random(5)
    for start, end in SIDES:
        for premise in rates:
            gap, rate = rng.randint(20, 40), rng.randint(1, 6)
            left = gap - closer(rate) + near
            given = premise.format(rate=rate, fast=20 + rate)
            yield f"{start.format(gap=gap)} and {given} -> G[0, 2 s] {end.format(left=left)}"


def once(rate):
    return 2 * rate


def twice(rate):
    return 2 * rate


def decided(claim):
    return rp.prove(claim, assume="motion", jobs=1, effort=8, drive=False)


@pytest.mark.parametrize("claim", [*claims(RATES, once, 0), *claims(TWICE, twice, 0)])
def test_the_bound_that_just_holds_is_proved(claim):
    found = decided(claim)
    assert found.verdict is Verdict.PROVED
    assert found.check().accepted


@pytest.mark.parametrize("claim", [*claims(RATES[:1], once, 1), *claims(TWICE[:1], twice, 1)])
def test_a_metre_more_is_not_proved(claim):
    assert rp.prove(claim, assume="motion", jobs=1, effort=1, drive=False).verdict is Verdict.UNKNOWN
