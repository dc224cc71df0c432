"""What a search tries: what a model violates, and a road of few lanes where that can help."""

from fractions import Fraction

import pytest

from asking import prove
from proving.claims import settle, specification
from roadproof.engines.prove import countermodel, prover
from roadproof.engines.prove.doubt import Stop
from roadproof.engines.prove.grounding import Grounding
from roadproof.engines.prove.place import place
from roadproof.engines.prove.search import GaveUp, Model
from roadproof.evidence import state
from roadproof.evidence.atoms import Atoms
from roadproof.logic import formula as f
from roadproof.logic import terms as t
from roadproof.runtime.budget import Effort
from roadproof.verdict import Verdict
from roadproof.world.models import load_vehicle


def test_what_holds_anyway_is_not_instantiated(monkeypatch):
    met = []
    true_instantiate = Grounding.instantiate

    def instantiate(self, universal, when):
        met.append(str(when))
        true_instantiate(self, universal, when)

    monkeypatch.setattr(Grounding, "instantiate", instantiate)
    claim = "not (atLane(SV,L) and G atLane(SV,L))"
    assert prove(specification(), claim, Effort(5)).verdict is Verdict.REFUTED
    assert met == []
    claim = "atLane(SV,L) and G not atLane(SV,L) -> false"
    assert prove(specification(), claim, Effort(5)).verdict is Verdict.VACUOUS
    assert "0" in met


@pytest.mark.parametrize(
    ("claim", "few"),
    [
        ("G F p -> F G p", []),
        ("(every K in lanes: some M in lanes: G F atLane(SV,M) and F atLane(SV,K)) -> F G p", [1]),
    ],
)
def test_few_lanes_are_tried_once_where_quantifiers_over_lanes_are_open(claim, few, monkeypatch):
    looked = []
    true_search = prover._Attempt._search

    def search(self, goal, names, wishful, roster=None):
        looked.append((wishful, roster))
        return true_search(self, goal, names, wishful, roster)

    monkeypatch.setattr(prover._Attempt, "_search", search)
    settle(claim, units=2)
    assert [n for n, (_, roster) in enumerate(looked) if roster is not None] == few
    turns = [wishful for wishful, roster in looked if roster is None]
    assert turns == [wishful for wishful, _ in prover.TURNS[: len(turns)]]


def test_a_road_of_few_lanes_proves_nothing(monkeypatch):
    """What holds on it may fail on a larger one."""
    found = []
    true_run = prover._Attempt._run

    def run(self, search, meter):
        made = true_run(self, search, meter)
        if search.grounding.roster is not None:
            found.append(made)
        return made

    monkeypatch.setattr(prover._Attempt, "_run", run)
    monkeypatch.setattr(prover, "TURNS", ((False, 0.0), (True, 0.0)))
    assert settle("(every K in lanes: F atLane(SV,K)) -> F p").verdict is Verdict.UNKNOWN
    assert found == [GaveUp("no countermodel on a road of few lanes", Stop.PLACE)]


def test_where_no_road_is_found_nothing_is_refuted(monkeypatch):
    """Not even where the claim is false without any road: there is none of that kind."""
    claim = "some K in lanes: G atLane(SV,K)"
    assert settle(claim, units=2).verdict is Verdict.REFUTED
    monkeypatch.setattr(countermodel, "lay_road", lambda layout: None)
    assert settle(claim, units=2).verdict is Verdict.UNKNOWN


def test_a_vehicle_of_which_nothing_is_known_is_a_car_that_begins_at_zero():
    values = settle("not atLane(SV,L)").countermodel.instants[0].values
    car = load_vehicle("car")
    assert (values["length(SV)"], values["width(SV)"]) == (car.length, car.width)
    assert values["s(SV)"] == car.length


def test_vehicles_of_which_the_same_is_said_stand_together():
    said = {"|occ(A,l)|": True, "|occ(B,l)|": False, "|occ(C,l)|": True}
    formula = f.And(tuple(f.Occupies(name, "l") for name in "ABC"))
    sizes = {state.symbol(t.Size(size, name)): Fraction(2) for name in "ABC" for size in ("length", "width")}
    model = Model({}, {Fraction(0): {}}, {Fraction(0): said}, {}, {})
    (found,) = place(formula, Atoms(), model, sizes)
    assert sorted("ABC", key=lambda name: found[f"s({name})"]) == ["B", "A", "C"]
