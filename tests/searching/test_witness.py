"""Drives for scenarios and formulas: judged, natural, and a no that is explained."""

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import pytest

from asking import posed, search_for
from roadproof.engines.encode.unroll import Grid
from roadproof.engines.search import search
from roadproof.engines.search.ask import ask
from roadproof.engines.search.question import SearchOptions
from roadproof.engines.search.variety import CLEARLY
from roadproof.errors import UsageError
from roadproof.evidence.judged import judge_file
from roadproof.library.loading import bundled_library
from roadproof.runtime.budget import Effort
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.verdict import Verdict
from roadproof.world.models import load_vehicle
from roadproof.world.motion import starts_of, state_at

LIBRARY = bundled_library()
MEANS = SearchOptions(effort=Effort(30))


def ask_for(what, set_name="base", **changes):
    return ask(search_for(what, set_name, **changes))


def drive_of(outcome, k=0):
    return outcome.drives[k].file


def gap(file, ahead, behind, time):
    first, second = (state_at(file.drive.vehicles[name], time) for name in (ahead, behind))
    return first.s - file.drive.vehicles[ahead].length - second.s


def lateral_spells(motion):
    """How long each movement across the road lasts, in s."""
    spells, begun = [], None
    for state in starts_of(motion):
        if begun is None and (state.v_lat or state.a_lat):
            begun = state.time
        if begun is not None and not state.v_lat and not state.a_lat:
            spells.append(state.time - begun)
            begun = None
    assert begun is None
    return spells


@pytest.mark.parametrize(
    ("scenario", "set_name"),
    [
        *((1, "base"), (2, "base"), (3, "ext"), (4, "extA"), (5, "ext"), (6, "base"), (7, "base")),
        *((8, "extA"), (9, "ext"), (12, "base"), (16, "base"), (20, "extA"), (24, "base")),
    ],
)
def test_scenarios_have_natural_judged_drives(scenario, set_name):
    outcome = ask_for(str(scenario), set_name)
    assert outcome.verdict is Verdict.WITNESSED
    assert outcome.natural
    file = drive_of(outcome)
    assert judge_file(file, LIBRARY).accepted
    assert first_overlap(file.drive, file.horizon) is None
    car = load_vehicle("car")
    assert first_breach(file.drive, dict.fromkeys(file.drive.vehicles, car), None) is None
    for motion in file.drive.vehicles.values():
        pieces = motion.pieces
        assert all(abs(b.a_lon - a.a_lon) <= 3 for a, b in pairwise(pieces))
        assert all(state.v_lon >= 15 for state in starts_of(motion))
        spells = lateral_spells(motion)  # of one lane change, in one direction
        assert not spells or 2 <= sum(spells) <= 6
        for state in starts_of(motion):
            assert abs(state.v_lat) * 10 <= state.v_lon


def test_a_drive_is_rejected_when_it_is_changed():
    file = drive_of(ask_for("4"))
    pov = file.drive.vehicles["POV"]
    gone = replace(file.drive, vehicles={**file.drive.vehicles, "POV": replace(pov, s=pov.s - 500)})
    assert not judge_file(replace(file, drive=gone), LIBRARY).accepted
    touching = {**file.drive.vehicles, "SV": replace(file.drive.vehicles["SV"], s=pov.s - 1)}
    assert not judge_file(replace(file, drive=replace(file.drive, vehicles=touching)), LIBRARY).accepted
    assert not judge_file(replace(file, formula="not (scenario_4(SV, POV, L))"), LIBRARY).accepted
    assert not judge_file(replace(file, lanes={"L": "main-2"}), LIBRARY).accepted


def test_objectives_do_what_they_say():
    nearest = {}
    for objective in ("any", "smooth", "margin", "mild", "severe", "short"):
        outcome = ask_for("4", search_options=replace(MEANS, objective=objective))
        assert outcome.verdict is Verdict.WITNESSED
        file = drive_of(outcome)
        times = [k * Fraction(1, 10) for k in range(int(file.horizon * 10) + 1)]
        nearest[objective] = min(gap(file, "POV", "SV", time) for time in times), file.horizon
    assert nearest["severe"][0] < nearest["mild"][0] - 5
    assert nearest["short"][1] < nearest["smooth"][1]


def test_several_drives_differ_clearly():
    outcome = ask_for("4", count=3)
    assert len(outcome.drives) == 3
    for i in range(3):
        for k in range(i):
            one, other = drive_of(outcome, i).drive.vehicles, drive_of(outcome, k).drive.vehicles
            apart = [
                abs(getattr(state_at(one[name], time), signal) - getattr(state_at(other[name], time), signal))
                >= distance - Fraction(1, 10)
                for name in one
                for time in (Fraction(0), Fraction(6))
                for signal, distance in CLEARLY.items()
            ]
            assert any(apart)


def test_overlapping_scenarios_have_a_drive_and_exclusive_ones_a_proof():
    both = ask_for("scenario_4(SV,POV,L) and scenario_6(SV,POV,L)")
    assert both.verdict is Verdict.WITNESSED
    never = ask_for("scenario_1(SV,POV,L) and scenario_4(SV,POV,L)")
    assert never.verdict is Verdict.IMPOSSIBLE
    assert never.impossibility is not None
    assert "not sameLane(POV, SV, L)" in never.impossibility.told
    assert never.impossibility.minimal


def test_none_within_names_its_limits():
    outcome = ask_for("F v_lon(SV) > 41 m/s")
    assert outcome.verdict is Verdict.NONE_WITHIN
    for part in ("main-2", "0.6 s", "SV=car", "--horizon"):
        assert part in outcome.reason


def test_equalities_and_what_comes_after_the_horizon():
    outcome = ask_for("G v_lon(SV) = 30 m/s")
    assert outcome.verdict is Verdict.WITNESSED
    outcome = ask_for("G (s(POV) - s(SV) > 10 m) and F G v_lon(POV) < v_lon(SV)")
    assert outcome.verdict in (Verdict.NONE_WITHIN, Verdict.UNKNOWN, Verdict.IMPOSSIBLE)
    outcome = ask_for("G (s(POV) - s(SV) > 10 m) and F[0, 3 s] v_lon(POV) < v_lon(SV)")
    assert outcome.verdict is Verdict.WITNESSED


def test_both_engines_answer_alike():
    short = {"horizon": Fraction(9, 5)}
    for what, verdict in (("4", Verdict.WITNESSED), ("F v_lon(SV) > 41 m/s", Verdict.NONE_WITHIN)):
        for engine in ("milp", "smt"):
            search_options = replace(MEANS, engine=engine, effort=Effort(240))
            assert ask_for(what, search_options=search_options, **short).verdict is verdict
    cubic = "F v_lon(SV)^3 > 20000 * 1 m/s * 1 m/s * 1 m/s"
    with pytest.raises(UsageError, match="use the engine smt"):
        ask_for(cubic)
    assert ask_for(cubic, search_options=replace(MEANS, engine="smt"), **short).verdict is Verdict.WITNESSED


def test_a_drive_that_the_judge_rejects_is_never_handed_out(monkeypatch):
    true_judge = search.judge

    class No:
        holds = False

    monkeypatch.setattr(search, "judge", lambda formula, drive: No())
    outcome = ask_for("4", search_options=replace(MEANS, effort=Effort(4), refinements=0))
    assert outcome.verdict is Verdict.UNKNOWN
    assert not outcome.drives
    assert true_judge is not search.judge


def test_what_fails_between_the_samples_is_looked_at_more_closely():
    """On samples of 3 s a short peak of speed goes unseen; finer grids find out."""
    peak = "F[0, 3 s] v_lon(SV) > 32 m/s and not (v_lon(SV) > 30 m/s or F[3 s, 3 s] v_lon(SV) > 30 m/s)"
    outcome = ask_for(peak, dt=Fraction(3), horizon=Fraction(6))
    assert outcome.verdict in (Verdict.WITNESSED, Verdict.UNKNOWN, Verdict.NONE_WITHIN)
    if outcome.drives:
        assert judge_file(drive_of(outcome), LIBRARY).accepted


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"dt": Fraction(1, 7)}, "no multiple of dt"),
        ({"horizon": Fraction(7), "dt": Fraction(3, 5)}, "no multiple of dt"),
        ({"horizon": Fraction(6000)}, "at most"),
        ({"lanes": {"L": "main-9"}}, "has the lanes main-1, main-2"),
        ({"lanes": {"M": "main-1"}}, "the formula mentions L"),
        ({"vehicles": {"POV7": "car"}}, "the formula mentions"),
        ({"values": {"minDanger": Fraction(1, 2)}, "dt": Fraction(3, 5)}, "no multiple of dt"),
    ],
)
def test_requests_that_make_no_sense(changes, message):
    with pytest.raises(UsageError, match=message):
        ask_for("4", **changes)


@pytest.mark.parametrize(
    ("what", "horizon", "dt", "steps"),
    [
        ("v_lon(SV) > 20 m/s", 6, Fraction(3, 5), 10),
        ("F[0, 1 s] v_lon(SV) > 20 m/s", 6, Fraction(1, 2), 12),
        ("F[0, 0.5 s] G[0, 0.6 s] v_lon(SV) > 20 m/s", 6, Fraction(1, 10), 60),
        ("scenario_4(SV, POV, L)", 6, Fraction(3, 5), 10),
        ("scenario_4(SV, POV, L)", 5, Fraction(1, 5), 25),
        ("F[0, 0.6 s] v_lon(SV) > 20 m/s", Fraction(501, 100), Fraction(3, 5), 9),
    ],
)
def test_the_step_is_the_coarsest_that_fits(what, horizon, dt, steps):
    assert posed(search_for(what, horizon=Fraction(horizon))).grid == Grid(dt, steps)


def test_a_formula_without_vehicles_shows_nothing():
    with pytest.raises(UsageError, match="no vehicle"):
        ask_for("true")
