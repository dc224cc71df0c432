"""A question put in place, and what is said where the clock cuts it off."""

import shutil
from fractions import Fraction

import numpy as np
import pytest

import roadproof as rp
from engine_calls import search_for, search_problem
from roadproof.engines.prove.prover import ProofHeuristic, prove
from roadproof.engines.search import impossible, search, single_claim
from roadproof.engines.search.bounded import check_bounded
from roadproof.engines.search.decide import decide_claim
from roadproof.engines.search.enumeration import short_refuting_drive
from roadproof.engines.search.patterns import spread
from roadproof.engines.search.question import make_grid, usual_model
from roadproof.engines.search.refute import beyond_limits, quick_drive
from roadproof.engines.setting import SearchOptions
from roadproof.errors import UsageError
from roadproof.evidence.judged import judge_file
from roadproof.extensions.catalogue import completing
from roadproof.extensions.catalogue.completing import search_drive_or_unknown
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.library.motion import under_limits
from roadproof.runtime.budget import BudgetExceeded, Effort
from roadproof.runtime.package_data import shipped_folder
from roadproof.semantics.exact.judging import judge
from roadproof.semantics.exact.replay import first_breach, first_overlap
from roadproof.verdict import Verdict
from roadproof.world.models import load_vehicle
from roadproof.world.motion import state_at
from tables import read_table

LIBRARY = bundled_library()
SLOWER = "v_lon(SV) < v_lon(POV)"


def models(**vehicles):
    named = {name.removeprefix("every"): str(model) for name, model in vehicles.items()}
    question = search_problem(search_for(SLOWER, vehicles=named))
    return {name: vehicle.name for name, vehicle in question.vehicles.items()}


def test_vehicles_are_cars_unless_told_otherwise(tmp_path):
    van = tmp_path / "van.toml"
    shutil.copy(shipped_folder("models") / "vehicles/car.toml", van)
    assert models() == {"SV": "car", "POV": "car"}
    assert models(SV=van) == {"SV": "van", "POV": "car"}
    assert models(every=van, POV="car") == {"SV": "van", "POV": "car"}


@pytest.mark.parametrize("kind", ["truck", "bus", "motorcycle"])
@pytest.mark.parametrize("role", ["SV", "POV"])
def test_every_kind_of_vehicle_in_every_role(role, kind):
    (judged,) = search_drive_or_unknown(search_for("4", vehicles={role: kind})).drives
    model = load_vehicle(kind)
    motion = judged.file.drive.vehicles[role]
    assert (motion.length, motion.width) == (model.length, model.width)
    assert model.v_lon[0] <= motion.v_lon <= model.v_lon[1]


def test_limits_of_one_vehicle_are_not_those_of_another():
    vehicles = search_problem(search_for(SLOWER, limits={"SV": {"v_lon.max": Fraction(20)}})).vehicles
    assert vehicles["SV"].v_lon[1] == 20 < vehicles["POV"].v_lon[1]


@pytest.mark.parametrize(("horizon", "dt"), [(6, 0), (0, 1), (6, -1), (-6, 1), (-6, -1)])
def test_a_grid_takes_time(horizon, dt):
    with pytest.raises(UsageError, match="must be greater than 0"):
        make_grid(Fraction(horizon), Fraction(dt))


def test_what_the_clock_cuts_off_is_unknown_on_its_road(monkeypatch):
    def late(request):
        raise BudgetExceeded(3.0)

    monkeypatch.setattr(completing, "search_drive", late)
    outcome = search_drive_or_unknown(search_for("4"))
    assert (outcome.verdict, outcome.scenario, outcome.road) == (Verdict.UNKNOWN, 4, "main-2")
    assert outcome.query.text == "scenario_4(SV, POV, L)"
    assert "cut off by the clock after 3 s" in outcome.reason


def test_a_core_costs_no_more_than_is_left(monkeypatch):
    asked = []

    def heard(prove):
        def asks(specification, claim, effort):
            asked.append(effort.units)
            return prove(specification, claim, effort)

        return asks

    for name in ("prove", "prove_via_opaque_driver"):
        monkeypatch.setattr(impossible, name, heard(getattr(impossible, name)))
    clash = "v_lon(SV) > 3 m/s and F v_lon(POV) > 3 m/s and v_lon(SV) < 2 m/s"
    found = impossible.show_impossible(LIBRARY.select(), read_claim(LIBRARY.select(), clash), Effort(5))
    assert found.core_texts == ("v_lon(SV) > 3 m/s", "v_lon(SV) < 2 m/s")
    assert found.minimal
    assert asked[0] == 5
    assert all(units <= impossible.SHORTER for units in asked[1:])


@pytest.mark.parametrize("hunch", [True, False])
def test_a_core_does_not_rest_on_hunches(hunch, monkeypatch):
    clash = "v_lon(SV) > 3 m/s and F v_lon(POV) > 3 m/s and v_lon(SV) < 2 m/s and d(SV) > 1 m"
    query = read_claim(LIBRARY.select(), clash)
    right = impossible.show_impossible(LIBRARY.select(), query, Effort(5))
    assert right.core_texts == ("v_lon(SV) > 3 m/s", "v_lon(SV) < 2 m/s")
    monkeypatch.setattr(impossible.ProofHeuristic, "has_proof", lambda self, claim, effort: (hunch, 0.0))
    found = impossible.show_impossible(LIBRARY.select(), query, Effort(5))
    assert found.certificate == right.certificate
    assert found.core_texts == (right.core_texts if hunch else tuple(clash.split(" and ")))


def test_what_is_learnt_of_one_claim_does_not_change_the_next():
    """Claims with atoms of the same names, or of other vehicles, one after the other."""
    specification = LIBRARY.select()
    texts = [
        "not (v_lon(SV) > 3 m/s and v_lon(SV) < 2 m/s)",
        "not (v_lon(SV) > 3 m/s and v_lon(SV) < 4 m/s)",
        "not (v_lon(SV) > 3 m/s and v_lon(SV) < 2 m/s and F v_lon(POV) > 3 m/s)",
        "given A: vehicle: not (s(A) > 3 m and s(A) < 3 m)",
        "not (danger(SV, POV) and not danger(POV, SV))",
        "not (danger(SV, POV) and initSafe(SV, POV))",
        "not danger(SV, POV)",
    ]
    together = ProofHeuristic(specification)
    for text in texts:
        claim = read_claim(specification, text)
        alone = prove(specification, claim, Effort(5)).holds
        assert (together.has_proof(claim, Effort(5))[0], text) == (alone, text)


def test_drives_that_were_found_stand_where_a_later_search_is_cut_off(monkeypatch):
    true_find, calls = search.find_witness, []

    def find(question, means, unlike=()):
        calls.append(len(unlike))
        if unlike:
            raise BudgetExceeded(3.0)
        return true_find(question, means, unlike)

    monkeypatch.setattr(search, "find_witness", find)
    found = rp.witness(SLOWER, count=3, jobs=1).outcomes[0]
    assert (found.verdict, len(found.drives), calls) == (Verdict.WITNESSED, 1, [0, 1])
    assert "1 of 3 drives" in found.reason
    assert "after 3 s" in found.reason


def test_durations_without_a_common_step_are_named():
    wrong = "3000 steps of dt=1/500 s, and at most 400 .* multiples of dt \\(71/500 s, 3/5 s\\)"
    with pytest.raises(UsageError, match=wrong):
        search_problem(search_for("F[0, 0.142 s] danger(SV,POV) and F[0, 0.6 s] danger(SV,POV)"))


# --- Which of two formulas implies the other: a proof or a drive for each direction -----------------

FAST, FASTER = "v_lon(SV) > 20 m/s", "v_lon(SV) > 30 m/s"


def compared(first, second, set_name="base"):
    sets = dict.fromkeys(("base", set_name))
    return rp.compare(first, second, rp.load(*sets), horizon="6/5", effort=30, jobs=1).view


@pytest.mark.parametrize(
    ("first", "second", "relation"),
    [
        (FASTER, FAST, "stronger"),
        (FAST, FASTER, "weaker"),
        (FAST, f"not not {FAST}", "equivalent"),
        (FAST, "v_lon(SV) < 25 m/s", "incomparable"),
    ],
)
def test_relations_and_their_evidence(first, second, relation):
    found = compared(first, second)
    assert found.relation == relation
    for direction in (found.forward, found.backward):
        if direction.verdict is Verdict.PROVED:
            assert direction.certificate is not None
            assert direction.drive is None
        else:
            assert direction.verdict is Verdict.REFUTED
            assert direction.certificate is None
            assert judge_file(direction.drive.file, LIBRARY).accepted


def test_what_is_proved_only_where_no_drive_is_found_is_bounded():
    found = compared("v_lon(SV) <= 40 m/s", "F[0, 1.2 s] v_lon(SV) <= 41 m/s")
    assert found.forward.verdict is Verdict.PROVED
    assert found.backward.verdict is Verdict.PROVED_BOUNDED
    assert found.relation == "unknown"


def test_what_the_clock_cuts_off_is_unknown(monkeypatch):
    def late(*_):
        raise BudgetExceeded(7.0)

    monkeypatch.setattr(single_claim, "_decide_without_search", late)
    found = compared(FAST, FASTER)
    assert found.forward.verdict is found.backward.verdict is Verdict.UNKNOWN
    assert "after 7 s" in found.forward.reason
    assert found.relation == "unknown"


def test_the_second_formula_may_be_of_another_set():
    found = compared("4", "4", "extA")
    assert (found.first.text, found.second.text) == ("scenario_4(SV, POV, L)", "scenario_4@extA(SV, POV, L)")
    assert found.backward.claim.text == f"{found.second.text} -> {found.first.text}"


# --- Bounded checks: limits are printed, counterexamples are judged, engines agree ------------------


def check(claim, engine):
    search_options = SearchOptions(engine=engine, effort=Effort(30))
    return check_bounded(search_for(claim, search_options=search_options, horizon=Fraction(6, 5)))


@pytest.mark.parametrize("engine", ["milp", "smt"])
def test_limits_of_vehicles_bound_what_can_happen(engine):
    # From at most 40 m/s at -6 m/s², 1.2 s later it is at most 40 and at least 15 m/s.
    held = check(
        "F[0, 1.2 s] v_lon(SV) <= 40 m/s and not (v_lon(SV) > 39 m/s and F[1.2 s, 1.2 s] v_lon(SV) < 31 m/s)",
        engine,
    )
    assert held.verdict is Verdict.PROVED_BOUNDED
    assert "main-2" in held.reason
    broken = check("not (v_lon(SV) > 39 m/s and F[1.2 s, 1.2 s] v_lon(SV) < 33 m/s)", engine)
    assert broken.verdict is Verdict.REFUTED
    assert judge_file(broken.drive.file, LIBRARY).accepted


def test_what_holds_for_all_time_is_proved_so():
    assert check("danger(SV,POV) -> F danger(SV,POV)", "milp").verdict is Verdict.PROVED


# --- Short drives against claims: found without a solver, judged, and inside the limits that were asked for

HOME = bundled_library().select()
# Drives refute it only outside the limits of the shipped car.
SLOW = tuple(read_table(__file__, "slow"))
WITHIN = (
    "a_lon(SV) <= 2 m/s^2",
    "scenario_1(SV,POV,L) -> v_lon(SV) < 30 m/s",
    "v_lon(SV) > 20 m/s -> G[0, 1 s] v_lon(SV) > 20 m/s",
)


def claim(text):
    return read_claim(HOME, text)


@pytest.mark.parametrize("text", SLOW)
def test_beyond_the_limits_of_the_shipped_car(text):
    assert short_refuting_drive(HOME, claim(text), "model") is None
    drive = quick_drive(HOME, claim(text))
    assert judge(drive.judgement.formula, drive.file.drive).holds
    assert "limits of the shipped car" in beyond_limits(drive)


@pytest.mark.parametrize("text", WITHIN)
def test_within_the_limits_of_the_shipped_car(text):
    query = claim(text)
    found = short_refuting_drive(HOME, query, "model")
    models = {name: usual_model(query.formula, name) for name in query.vehicles}
    assert first_breach(found.file.drive, models, None) is None
    assert first_overlap(found.file.drive, found.file.horizon) is None
    assert beyond_limits(found) == ""


@pytest.mark.parametrize("within", ["model", "forward", "claim"])
@pytest.mark.parametrize("text", ["v_lon(SV) > 3 m/s or v_lon(SV) < 4 m/s", "given x: m: s(SV) > x", "true"])
def test_none_against_what_holds_or_is_not_about_drives(text, within):
    assert short_refuting_drive(HOME, claim(text), within, 2) is None


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
    found = decide_claim(HOME, claim(text), Effort(3), assumed=said)
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
    drive = short_refuting_drive(HOME, claim(text), "claim", 2)
    assert judge(drive.judgement.formula, drive.file.drive).holds
    assert any(x.v_lat for x in drive.file.drive.vehicles.values())


@pytest.mark.parametrize("text", [SLOW[0], "v_lat(SV) <= 1 m/s and d(POV) <= 25 m -> v_lat(POV) > 2 m/s"])
def test_samples_and_drive_are_the_same_motion(text):
    """The monitor sees in floating point what the judge sees in rational numbers."""
    from roadproof.engines.search.enumeration import _short_drive_search

    search = _short_drive_search(HOME, claim(text), "claim")
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
