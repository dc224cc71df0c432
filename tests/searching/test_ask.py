"""A question put in place, and what is said where the clock cuts it off."""

import shutil
from fractions import Fraction

import pytest

from asking import posed, search_for
from roadproof.engines.prove.prover import ProofHeuristic, prove
from roadproof.engines.search import ask, impossible
from roadproof.engines.search.ask import answer
from roadproof.engines.search.grid import make_grid
from roadproof.errors import UsageError
from roadproof.library.elaborate import read_claim
from roadproof.library.loading import bundled_library
from roadproof.runtime.budget import BudgetExceeded, Effort
from roadproof.runtime.package_data import shipped
from roadproof.verdict import Verdict
from roadproof.world.models import load_vehicle

LIBRARY = bundled_library()
SLOWER = "v_lon(SV) < v_lon(POV)"


def models(**vehicles):
    named = {name.removeprefix("every"): str(model) for name, model in vehicles.items()}
    question = posed(search_for(SLOWER, vehicles=named))
    return {name: vehicle.name for name, vehicle in question.vehicles.items()}


def test_vehicles_are_cars_unless_told_otherwise(tmp_path):
    van = tmp_path / "van.toml"
    shutil.copy(shipped("models") / "vehicles/car.toml", van)
    assert models() == {"SV": "car", "POV": "car"}
    assert models(SV=van) == {"SV": "van", "POV": "car"}
    assert models(every=van, POV="car") == {"SV": "van", "POV": "car"}


@pytest.mark.parametrize("kind", ["truck", "bus", "motorcycle"])
@pytest.mark.parametrize("role", ["SV", "POV"])
def test_every_kind_of_vehicle_in_every_role(role, kind):
    (judged,) = answer(search_for("4", vehicles={role: kind})).drives
    model = load_vehicle(kind)
    motion = judged.file.drive.vehicles[role]
    assert (motion.length, motion.width) == (model.length, model.width)
    assert model.v_lon[0] <= motion.v_lon <= model.v_lon[1]


def test_limits_of_one_vehicle_are_not_those_of_another():
    vehicles = posed(search_for(SLOWER, limits={"SV": {"v_lon.max": Fraction(20)}})).vehicles
    assert vehicles["SV"].v_lon[1] == 20 < vehicles["POV"].v_lon[1]


@pytest.mark.parametrize(("horizon", "dt"), [(6, 0), (0, 1), (6, -1), (-6, 1), (-6, -1)])
def test_a_grid_takes_time(horizon, dt):
    with pytest.raises(UsageError, match="must be greater than 0"):
        make_grid(Fraction(horizon), Fraction(dt))


def test_what_the_clock_cuts_off_is_unknown_on_its_road(monkeypatch):
    def late(request):
        raise BudgetExceeded(3.0)

    monkeypatch.setattr(ask, "ask", late)
    outcome = answer(search_for("4"))
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

    for name in ("prove", "prove_of_scenarios"):
        monkeypatch.setattr(impossible, name, heard(getattr(impossible, name)))
    clash = "v_lon(SV) > 3 m/s and F v_lon(POV) > 3 m/s and v_lon(SV) < 2 m/s"
    found = impossible.show_impossible(LIBRARY.select(), read_claim(LIBRARY.select(), clash), Effort(5))
    assert found.told == ("v_lon(SV) > 3 m/s", "v_lon(SV) < 2 m/s")
    assert found.minimal
    assert asked[0] == 5
    assert all(units <= impossible.SHORTER for units in asked[1:])


@pytest.mark.parametrize("hunch", [True, False])
def test_a_core_does_not_rest_on_hunches(hunch, monkeypatch):
    clash = "v_lon(SV) > 3 m/s and F v_lon(POV) > 3 m/s and v_lon(SV) < 2 m/s and d(SV) > 1 m"
    query = read_claim(LIBRARY.select(), clash)
    right = impossible.show_impossible(LIBRARY.select(), query, Effort(5))
    assert right.told == ("v_lon(SV) > 3 m/s", "v_lon(SV) < 2 m/s")
    monkeypatch.setattr(impossible.ProofHeuristic, "has_proof", lambda self, claim, effort: (hunch, 0.0))
    found = impossible.show_impossible(LIBRARY.select(), query, Effort(5))
    assert found.certificate == right.certificate
    assert found.told == (right.told if hunch else tuple(clash.split(" and ")))


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
    true_find, calls = ask.find_witness, []

    def find(question, means, unlike=()):
        calls.append(len(unlike))
        if unlike:
            raise BudgetExceeded(3.0)
        return true_find(question, means, unlike)

    monkeypatch.setattr(ask, "find_witness", find)
    outcome = ask.ask(search_for(SLOWER, count=3))
    assert (outcome.verdict, len(outcome.drives), calls) == (Verdict.WITNESSED, 1, [0, 1])
    assert "1 of 3 drives" in outcome.reason
    assert "after 3 s" in outcome.reason


def test_durations_without_a_common_step_are_named():
    wrong = "3000 steps of dt=1/500 s, .* multiples \\(71/500 s, 3/5 s\\); at most 400"
    with pytest.raises(UsageError, match=wrong):
        posed(search_for("F[0, 0.142 s] danger(SV,POV) and F[0, 0.6 s] danger(SV,POV)"))
