"""Short drives against claims: found without a solver, judged, and inside the limits that were asked for."""

from fractions import Fraction

import numpy as np
import pytest

import roadproof as rp
from roadproof.engines.search.default_vehicles import usual_model
from roadproof.engines.search.enumeration import small_drive
from roadproof.engines.search.patterns import spread
from roadproof.engines.search.refute import beyond_limits, quick_drive
from roadproof.engines.search.settle import settle
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.motion import under_limits
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.exact import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.verdict import Verdict
from roadproof.world.motion import state_at

HOME = bundled_library().select()
# Drives refute it only outside the limits of the shipped car.
SLOW = (
    "scenario_4(SV,POV,L) -> v_lon(SV) > 0 m/s",
    "scenario_4(SV,POV,L) -> v_lon(SV) > 5 m/s",
    "scenario_1(SV,POV,L) -> v_lon(SV) > 0 m/s",
    "scenario_1(SV,POV,L) -> v_lon(SV) > 5 m/s",
    "scenario_3(SV,POV,L) -> v_lon(SV) > 0 m/s",
    "scenario_3(SV,POV,L) -> v_lon(SV) > 5 m/s",
    # False on v = 8 + t: at a left-open boundary, where traces that hold a state refute nothing.
    "v_lon(SV) <= 10 m/s and F v_lon(SV) > 10 m/s -> v_lon(SV) <= 10 m/s U v_lon(SV) > 10 m/s",
)
WITHIN = (
    "a_lon(SV) <= 2 m/s^2",
    "scenario_1(SV,POV,L) -> v_lon(SV) < 30 m/s",
    "v_lon(SV) > 20 m/s -> G[0, 1 s] v_lon(SV) > 20 m/s",
)


def claim(text):
    return read_claim(HOME, text)


@pytest.mark.parametrize("text", SLOW)
def test_beyond_the_limits_of_the_shipped_car(text):
    assert small_drive(HOME, claim(text), "model") is None
    drive = quick_drive(HOME, claim(text))
    assert judge(drive.judgement.formula, drive.file.drive).holds
    assert "limits of the shipped car" in beyond_limits(drive)


@pytest.mark.parametrize("text", WITHIN)
def test_within_the_limits_of_the_shipped_car(text):
    query = claim(text)
    found = small_drive(HOME, query, "model")
    models = {name: usual_model(query.formula, name) for name in query.vehicles}
    assert first_breach(found.file.drive, models, None) is None
    assert first_overlap(found.file.drive, found.file.horizon) is None
    assert beyond_limits(found) == ""


@pytest.mark.parametrize("within", ["model", "forward", "claim"])
@pytest.mark.parametrize("text", ["v_lon(SV) > 3 m/s or v_lon(SV) < 4 m/s", "given x: m: s(SV) > x", "true"])
def test_none_against_what_holds_or_is_not_about_drives(text, within):
    assert small_drive(HOME, claim(text), within, 2) is None


def test_the_same_drive_every_time():
    first, second = (quick_drive(HOME, claim(SLOW[0])) for _ in range(2))
    assert first.file == second.file


def test_nobody_reverses_where_that_is_not_needed():
    drive = quick_drive(HOME, claim("v_lon(SV) > 5 m/s or G v_lon(POV) > v_lon(SV)"))
    assert all(
        state_at(x, Fraction(k)).v_lon >= 0 for x in drive.file.drive.vehicles.values() for k in (0, 9)
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a_lon(SV) <= 2 m/s^2", ("motion", "a_lon(SV) <= 3 m/s^2")),
        ("v_lon(SV) <= 10 m/s -> G[0, 1 s] v_lon(SV) <= 12 m/s", ("motion", "a_lon(SV) <= 3 m/s^2")),
    ],
)
def test_under_motion_within_the_limits_that_are_said(text, said):
    """The limits are part of what is judged: a drive that leaves them refutes nothing."""
    found = settle(HOME, claim(text), Effort(3), said=said)
    assert (found.verdict, found.refuted_by) == (Verdict.REFUTED, "drive")
    limits = under_limits(HOME, claim(text), said)
    assert found.drive.file.formula == quick_drive(HOME, limits).file.formula
    assert all(x.a_lon <= 3 for x in found.drive.file.drive.vehicles["SV"].pieces)


def test_limits_that_make_the_claim_true_leave_no_drive():
    limits = under_limits(HOME, claim("a_lon(SV) <= 4 m/s^2"), ("motion", "a_lon(SV) <= 3 m/s^2"))
    assert quick_drive(HOME, limits) is None


@pytest.mark.parametrize(
    "text",
    [
        "d(SV) <= 25 m and G v_lat(SV) <= 1 m/s -> G[1 s, 1 s] d(SV) <= 25 m",
        "d(SV) <= 38 m and G v_lat(SV) <= 1 m/s -> G[5 s, 5 s] d(SV) <= 42 m",
    ],
)
def test_across_the_road_at_the_numbers_of_the_claim(text):
    drive = small_drive(HOME, claim(text), "claim", 2)
    assert judge(drive.judgement.formula, drive.file.drive).holds
    assert any(x.v_lat for x in drive.file.drive.vehicles.values())


@pytest.mark.parametrize("text", [SLOW[0], "v_lat(SV) <= 1 m/s and d(POV) <= 25 m -> v_lat(POV) > 2 m/s"])
def test_samples_and_drive_are_the_same_motion(text):
    """The monitor sees in floating point what the judge sees in rational numbers."""
    from roadproof.engines.search.enumeration import _search

    search = _search(HOME, claim(text), "claim")
    patterns, dt, steps = search.patterns(), Fraction(1, 2), 20
    rows = spread(0, 40, patterns.columns)
    batch = patterns.batch(rows, dt, steps)
    for k, row in enumerate(rows):
        for name, motion in patterns.drive([float(x) for x in row]).vehicles.items():
            for step in range(steps + 1):
                state = state_at(motion, step * dt)
                for signal in ("s", "d", "v_lon", "v_lat", "a_lon", "a_lat"):
                    exact = float(getattr(state, signal))
                    assert np.isclose(batch.signals[signal, name][step, k], exact, atol=1e-6), (signal, step)


def test_the_answer_says_that_the_drive_lies_outside():
    text = str(rp.prove(SLOW[1], jobs=1))
    assert text.startswith("REFUTED by a drive")
    assert "this drive lies outside the limits of the shipped car" in text
