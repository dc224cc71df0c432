"""PROVED-BOUNDED is given only after drives within its limits were judged in dense time."""

import random
from dataclasses import replace
from fractions import Fraction

import pytest

from engine_calls import search_for, search_problem
from roadproof.engines.search.bounded import check_bounded
from roadproof.engines.search.dense_candidates import keeps_limits
from roadproof.engines.search.shipped_drives import shipped_drives
from roadproof.engines.setting import SearchOptions
from roadproof.evidence.judged import judge_file
from roadproof.library.loading import bundled_library
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict
from roadproof.world.motion import piece_starts

LIBRARY = bundled_library()
OPEN = (
    "atLane(POV,L)",
    "inMergeZone(SV)",
    "inDepartZone(SV)",
    "d(SV) > 3 m",
    "v_lon(SV) > 30 m/s",
    "s(SV) > s(POV)",
    "s(SV) > 10 m and s(SV) < 40 m",
    "atLane(SV,L) and atLane(POV,L)",
)
CLOSED = ("d(SV) >= 3 m", "v_lon(SV) >= 30 m/s", "not atLane(SV,L)", "s(SV) >= s(POV)")
# No sample sees it: each premise asks for an instant between two samples.
BETWEEN = (
    "F[0, 0.6 s] d(SV) < 3 m -> d(SV) < 3 m or F[0.6 s, 0.6 s] d(SV) < 3 m",
    "F[0, 0.6 s] s(POV) - s(SV) > 20 m -> s(POV) - s(SV) > 20 m or F[0.6 s, 0.6 s] s(POV) - s(SV) > 20 m",
)


def asked(claim, engine="smt", **changes):
    search_options = SearchOptions("any", engine, effort=Effort(30))
    return search_for(claim, search_options=search_options, **changes)


def first_instant_claims(conditions, rng, count):
    """Claims that ask for a first instant of a condition, which an open one has not."""
    for _ in range(count):
        p = rng.choice(conditions)
        end = rng.choice(["", "[0, 3 s]", "[0, 6 s]"])
        premise = f"F{end} ({p})" if rng.random() < 0.5 else f"not ({p}) and F{end} ({p})"
        yield f"{premise} -> (not ({p}) U{end} ({p}))"


def assert_refuted_within_limits(result, search):
    assert result.verdict is Verdict.REFUTED
    assert judge_file(result.drive.file, LIBRARY).accepted
    assert keeps_limits(search_problem(search), result.drive.file.drive)


@pytest.mark.parametrize("engine", ["milp", "smt"])
def test_no_open_condition_is_proved_to_have_a_first_instant(engine):
    for claim in dict.fromkeys(first_instant_claims(OPEN, random.Random(39), 10)):
        search = asked(claim, engine)
        assert_refuted_within_limits(check_bounded(search), search)


@pytest.mark.parametrize("claim", CLOSED)
def test_closed_conditions_have_a_first_instant(claim):
    text = next(first_instant_claims((claim,), random.Random(1), 1))
    assert check_bounded(asked(text), shipped_drives()).verdict is Verdict.PROVED_BOUNDED


@pytest.mark.parametrize("claim", BETWEEN)
def test_an_excursion_between_two_samples_refutes(claim):
    search = asked(claim, "milp")
    assert_refuted_within_limits(check_bounded(search), search)


def test_a_shipped_drive_refutes_before_anything_is_solved(monkeypatch):
    from roadproof.engines.search import dense_candidates

    monkeypatch.setattr(dense_candidates, "short_satisfying_drive", lambda *_: None)
    monkeypatch.setattr(dense_candidates, "_weaker_problems", lambda _: ())
    search = asked("F atLane(POV,L) -> (not atLane(POV,L) U atLane(POV,L))", road="main-2")
    assert check_bounded(search).verdict is Verdict.PROVED_BOUNDED
    assert_refuted_within_limits(check_bounded(search, shipped_drives()), search)


@pytest.mark.parametrize("claim", [f"F ({p}) -> (not ({p}) U ({p}))" for p in OPEN[:4]])
def test_solutions_of_weaker_problems_refute_alone(monkeypatch, claim):
    from roadproof.engines.search import dense_candidates

    monkeypatch.setattr(dense_candidates, "short_satisfying_drive", lambda *_: None)
    search = asked(claim)
    assert_refuted_within_limits(check_bounded(search), search)


def test_a_drive_outside_the_limits_is_no_candidate():
    """Each change leaves one limit of the question that the shipped drive of scenario 1 keeps."""
    drive = next(shipped_drives())
    names = tuple(drive.vehicles)
    same = {name: name for name in names}
    search = asked("F atLane(POV,L) and v_lon(SV) > 0 m/s", road="main-2")
    assert keeps_limits(search_problem(search), drive)
    gap = abs(drive.vehicles["SV"].s - drive.vehicles["POV"].s)
    for changes in (
        {"horizon": Fraction(3, 5)},
        {"reach": gap / 2},
        {"vehicles": {"SV": "truck"}},
        {"limits": {"POV": {"v_lon.max": Fraction(16)}}},
    ):
        other = asked(search.query.text, **({"road": "main-2"} | changes))
        assert not keeps_limits(search_problem(other), drive.cast(same))
    last = max(piece_starts(motion)[-1].time for motion in drive.vehicles.values())
    for horizon, kept in ((last, True), (last - Fraction(3, 5), False)):
        within = search_problem(asked(search.query.text, road="main-2", horizon=horizon, dt=Fraction(3, 5)))
        assert keeps_limits(within, drive) == kept
    elsewhere = asked("F atLane(POV,L) and inMergeZone(SV)", road="merge")
    far = drive.vehicles["SV"].s + 10_000
    moved = {name: _moved(motion, far) for name, motion in drive.vehicles.items()}
    assert not keeps_limits(search_problem(elsewhere), type(drive)(moved))


@pytest.mark.parametrize(
    ("claim", "changes"),
    [
        ("v_lon(SV) <= 41 m/s", {"v_lon": Fraction(50)}),
        ("d(SV) <= 8 m", {"d": Fraction(20)}),
        ("length(SV) <= 5 m", {"length": Fraction(9)}),
        ("F[6 s, 6 s] s(SV) - s(POV) >= -500 m", {"s": Fraction(-700)}),
    ],
)
def test_a_given_drive_outside_the_limits_refutes_nothing(claim, changes):
    drive = next(shipped_drives())
    outside = type(drive)({**drive.vehicles, "SV": replace(drive.vehicles["SV"], **changes)})
    search = asked(claim, road="main-2")
    found = check_bounded(search, [drive, outside])
    assert found.verdict in (Verdict.PROVED_BOUNDED, Verdict.PROVED)


def _moved(motion, by):
    return replace(motion, s=motion.s + by, d=motion.d + 100)
