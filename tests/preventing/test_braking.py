"""Braking as a function of time, the motion that follows, and the places on plates that are looked at."""

from fractions import Fraction
from itertools import pairwise
from random import Random

import pytest

from preventing.read import values
from roadproof.analysis.preventable.sides import far_apart
from roadproof.drivers.boundary import Plane
from roadproof.drivers.braking import AssistedBraking, Ramp
from roadproof.drivers.driving import DriverSettings, _along
from roadproof.drivers.lemmas import lemmas_for
from roadproof.drivers.lines import Line, end_of, sides_in
from roadproof.drivers.manoeuvres import MANOEUVRES
from roadproof.drivers.models import MODELS
from roadproof.drivers.restriction import Restriction, check_drives
from roadproof.errors import UsageError


@pytest.mark.parametrize("joined", ["max", "add"])
@pytest.mark.parametrize("seed", range(30))
def test_braking_is_affine_between_knots(joined: str, seed: int) -> None:
    """AEB brakes at least as hard as the driver, and begins before or after."""
    random = Random(f"{joined} {seed}")
    full = Fraction(random.randint(10, 80), 10)
    duration = Fraction(random.randint(1, 20), 10)
    onset, other = (Fraction(random.randint(0, 30), 10) for _ in range(2))
    harder = full + Fraction(random.randint(0, 40), 10)
    braking = AssistedBraking(Ramp(onset, duration, full), Ramp(other, duration, harder), joined)
    knots = braking.knots
    for begin, end in pairwise(knots):
        middle, near = (begin + end) / 2, end - (end - begin) / 1000
        slope = (braking.at(middle) - braking.at(begin)) / (middle - begin) if end > begin else 0
        assert braking.at(near) == braking.at(begin) + slope * (near - begin)
    assert braking.at(knots[-1]) == braking.at(knots[-1] + 10)


@pytest.mark.parametrize("model", ["rss", "r157", "eu1426"])
@pytest.mark.parametrize("onset", [Fraction(0), Fraction(1, 2), Fraction(3)])
def test_nobody_brakes_before_the_onset(model: str, onset: Fraction) -> None:
    pieces = _along(model, Fraction(20), onset, DriverSettings(values(), {}))
    still = [(onset, Fraction(0), Fraction(0))] if onset else []
    assert pieces[: len(still)] == still
    _, *changes = pieces[len(still)]
    assert any(changes)


def test_lemmas_are_those_of_the_models() -> None:
    careful = {x.name for x in lemmas_for("cut-in", [MODELS["careful"]])}
    both = {x.name for x in lemmas_for("cut-in", [MODELS["careful"], MODELS["rss"]])}
    assert careful < both
    assert all(name.startswith("careful-") for name in careful)
    assert all(name.startswith("rss-") for name in both - careful)
    assert not [x for x in lemmas_for("deceleration", [MODELS["rss"]]) if not x.name.startswith("rss-")]


def test_a_single_place_is_a_side_of_a_controller_only() -> None:
    along = (Fraction(0), Fraction(10))
    place = end_of(Fraction(4))
    lines = [Line(Fraction(1), ((place, place),))]
    assert sides_in(lines, along, is_stepped=True) == {"unpreventable", "preventable"}
    assert sides_in(lines, along, is_stepped=False) == {"preventable"}
    whole = [Line(Fraction(1), ((end_of(along[0]), end_of(along[1])),))]
    assert sides_in(whole, along, is_stepped=False) == {"unpreventable"}


def test_the_first_and_the_last_four_places_of_a_row_are_looked_at() -> None:
    kind = MANOEUVRES["cut-in"]
    plane = Plane(kind, {}, (Fraction(0), Fraction(60)), (Fraction(0), Fraction(20)))
    candidates = [{kind.across: Fraction(row), kind.line: Fraction(k)} for row in range(6) for k in range(7)]
    chosen = far_apart(plane, candidates, 3)
    assert [(int(x[kind.across]), int(x[kind.line])) for x in chosen] == [
        (row, k) for row in (0, 2, 4) for k in (0, 3, 4, 5, 6)
    ]


def test_drives_in_no_scenario_are_asked_for_as_drives() -> None:
    check_drives({})
    check_drives(Restriction("preventable", "careful", "drives").options)
    with pytest.raises(UsageError, match="would all be gaps"):
        check_drives(Restriction("preventable", "careful", "scenarios").options)
